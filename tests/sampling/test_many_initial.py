"""Initial states of N discs: uniform where that is known, whichever way they are drawn."""

import itertools
import math

import numpy as np
import pytest

from twodiscs.model.scene import Scene
from twodiscs.sampling.many import initial
from twodiscs.sampling.streams import open_stream
from twodiscs.theory import n_discs

GASES = {
    "rejection": Scene(1.5, 1.0, 0.16, discs=5),
    "channel": Scene(1.5, 0.6, 0.18, discs=4),
    "channel, dense": Scene(2.3, 0.6, 0.18, discs=8),
    "channel, upright": Scene(0.6, 2.0, 0.18, discs=5),
    "channel, narrow": Scene(40.0, 0.6, 0.29, discs=64),
    "chain": Scene(1.5, 1.0, 0.2, discs=6),
    "ring": Scene(1.5, 1.0, 0.15, discs=4, periodic="x"),
}


def parts(scene, found):
    """Return x, y, u, v, each (N, number)."""
    return np.split(found, 4)


@pytest.mark.parametrize("name", GASES)
def test_states_are_allowed(name):
    scene = GASES[name]
    assert initial.method(scene) == {"ring": "rejection"}.get(name, name.split(",")[0])
    x, y, u, v = parts(scene, initial.states(scene, 200, 1))
    assert np.max(np.abs(x)) <= scene.range_x / 2
    assert np.max(np.abs(y)) <= scene.range_y / 2
    for i, j in itertools.combinations(range(scene.discs), 2):
        dx = np.abs(x[i] - x[j])
        dx = np.minimum(dx, scene.width - dx) if scene.periodic else dx
        assert np.min(np.hypot(dx, y[i] - y[j])) >= scene.contact_distance * (1 - 1e-14)
    assert np.sum(u**2 + v**2, axis=0) == pytest.approx(1.0, rel=1e-12)
    if scene.periodic:
        assert np.sum(u, axis=0) == pytest.approx(0.0, abs=1e-14)


def moments(scene, found):
    """Return (mean, standard error) of what two ways to draw are to agree on."""
    x, y, u, v = parts(scene, found)
    pairs = list(itertools.combinations(range(scene.discs), 2))
    square = np.array([(x[i] - x[j]) ** 2 + (y[i] - y[j]) ** 2 for i, j in pairs])
    seen = np.array(
        [
            (x**2).mean(0), (y**2).mean(0), (y**4).mean(0), square.mean(0), square.min(0),
            (square < 1.2 * scene.contact_distance**2).sum(0), (u**4).mean(0), (v**4).mean(0),
            np.abs(np.array([y[i] - y[j] for i, j in pairs])).mean(0),
        ]
    )  # fmt: skip
    return seen.mean(1), seen.std(1) / math.sqrt(seen.shape[1])


@pytest.mark.parametrize(
    ("scene", "one", "other"),
    [
        (Scene(2.0, 0.6, 0.18, discs=4), "channel", "rejection"),
        (Scene(1.2, 0.6, 0.18, discs=3), "channel", "rejection"),
        (Scene(1.5, 1.0, 0.19, discs=5), "chain", "rejection"),
        # It takes long until the zigzag that the chain starts from has its defects.
        (Scene(2.5, 0.6, 0.18, discs=8), "chain", "channel"),
    ],
)
def test_ways_to_draw_agree(scene, one, other):
    """Five sigma of both."""
    (mean, error), (same, spread) = (
        moments(scene, initial.states(scene, 500 if way == "chain" else 20_000, seed, by=way))
        for seed, way in ((1, one), (2, other))
    )
    assert np.all(np.abs(mean - same) <= 5 * np.hypot(error, spread))


@pytest.mark.slow
@pytest.mark.parametrize("scene", [Scene(1.5, 1.0, 0.295, discs=3), Scene(2.0, 1.5, 0.24, discs=7)])
def test_longer_chains_are_no_different(scene, monkeypatch):
    """Chains of half and of twice the length have the same law."""
    found = []
    for seed, factor in ((1, 0.5), (2, 2)):
        monkeypatch.setattr(initial, "TRIALS", int(factor * initial.TRIALS))
        found.append(moments(scene, initial.states(scene, 2000, seed, by="chain")))
    (mean, error), (same, spread) = found
    assert np.all(np.abs(mean - same) <= 5 * np.hypot(error, spread))


def test_chains_that_are_too_short_are_seen(monkeypatch):
    scene = Scene(2.5, 0.6, 0.18, discs=8)
    found = []
    for seed, sweeps, number in ((1, 50, 4000), (2, 4000, 400)):
        monkeypatch.setattr(initial, "TRIALS", sweeps)
        found.append(moments(scene, initial.states(scene, number, seed, by="chain")))
    (mean, error), (same, spread) = found
    assert np.max(np.abs(mean - same) / np.hypot(error, spread)) > 10


@pytest.mark.parametrize(
    ("scene", "least"),
    [(Scene(1.18, 0.6, 0.18, discs=4), 0.1), (Scene(2.25, 0.6, 0.18, discs=8), 0.05),
     (Scene(18.0, 0.6, 0.18, discs=64), 0.03), (Scene(17.3, 0.6, 0.18, discs=64), 0.01),
     (Scene(6.0, 0.3600001, 0.18, discs=16), 0.5)],
)  # fmt: skip
def test_heights_in_a_channel_are_accepted_at_every_density(scene, least):
    state, cells = open_stream(np.uint64(1), 0), initial.initial_of(scene, "channel").cells
    heights = np.zeros(scene.discs)
    accepted = sum(
        initial.propose_heights(state, cells, scene.contact_distance, heights) for _ in range(2000)
    )
    assert accepted / 2000 > least


def test_mean_room_in_a_channel():
    """⟨1/(A − S)⟩ = ∂lnV/∂A / N over the drawn heights; five sigma."""
    for scene in (GASES["channel"], GASES["channel, dense"]):
        x, y, _, _ = parts(scene, initial.states(scene, 20_000, 4))
        order = np.argsort(x, axis=0)
        heights = np.take_along_axis(y, order, 0)
        taken = np.sqrt(scene.contact_distance**2 - np.diff(heights, axis=0) ** 2).sum(0)
        seen = 1 / (scene.range_x - taken)
        true = n_discs.known_derivatives(scene, hops=False).per_width / scene.discs
        # The inverse has a finite variance for N ≥ 2.
        assert abs(seen.mean() - true) < 5 * seen.std() / math.sqrt(seen.size)


@pytest.mark.parametrize("name", ["channel", "channel, upright", "chain", "ring"])
def test_each_disc_is_any_of_them(name):
    """Five sigma on how often a disc is in which place of the row; the first states stay."""
    scene, number = GASES[name], 400 if name == "chain" else 4000
    found = initial.labelled(scene, number, 6)
    assert np.array_equal(initial.labelled(scene, 50, 6), found[:, :50])
    x, y, *_ = parts(scene, found)
    ranks = np.argsort(np.argsort(y if scene.height > scene.width else x, axis=0), axis=0)
    counts = np.array([np.bincount(rank, minlength=scene.discs) for rank in ranks])
    share = 1 / scene.discs
    assert np.all(np.abs(counts - number * share) < 5 * math.sqrt(number * share * (1 - share)))
    # Nothing else has changed.
    same = parts(scene, initial.states(scene, number, 6))
    assert np.array_equal(np.sort(x, axis=0), np.sort(same[0], axis=0))
    assert np.array_equal(found[2 * scene.discs :], np.vstack(same[2:]))


def test_who_waits_hears_how_many_states_are_drawn():
    """In several calls, which continue the streams; progress is reported from the second on."""
    scene, told = GASES["chain"], []
    initial.labelled(scene, 200, 6, progress=lambda done, number: told.append((done, number)))
    done = [drawn for drawn, _ in told if drawn is not None]
    assert (done, done[-1]) == (sorted(done), 200)
    assert len(done) > 5
    assert {number for _, number in told} == {200}
