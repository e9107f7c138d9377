"""Initial states of many discs: event chains against chains of single moves, and exact channels."""

import itertools
import math

import numpy as np
import pytest
from scipy.stats import f

from twodiscs.model.many import arrangement, is_ordered
from twodiscs.model.scene import Scene
from twodiscs.sampling.many import chains, initial
from twodiscs.sampling.streams import open_stream


def drawn(scene, number, seed, **changes):
    """Return ``number`` states of a ``Scene``, with some ``changes`` of how they are drawn."""
    how = initial.initial_of(scene)._replace(**changes)
    found = np.zeros((4 * scene.discs, number))
    initial.draw_states(open_stream(np.uint64(seed), 0), how, found)
    return found


def one_by_one(scene, sweeps):
    """Return the ``Chain`` of single moves."""
    chain = initial._chain(scene)
    return initial.Chain(chain.centres, sweeps, chain.scales)


def moments(scene, found):
    """Return (means, standard errors): places, pair distances, and sixfold order."""
    x, y = np.split(found, 4)[:2]
    i, j = np.array([*itertools.combinations(range(scene.discs), 2)]).T
    dx, dy = x[i] - x[j], y[i] - y[j]
    dx -= scene.width * np.round(dx / scene.width) if scene.periodic else 0.0
    apart = np.hypot(dx, dy) / scene.contact_distance
    shells = [((a < apart) & (apart < b)).sum(0) for a, b in itertools.pairwise(EDGES)]
    six = np.exp(6j * np.arctan2(dy, dx)) * (apart < 1.4)
    seen = np.array(
        [(x**2).mean(0), (y**2).mean(0), (y**4).mean(0), apart.min(0), *shells,
         np.abs(six.sum(0)) ** 2, np.cos(2 * math.pi * x / scene.width).mean(0) ** 2]
    )  # fmt: skip
    return seen.mean(1), seen.std(1) / math.sqrt(seen.shape[1])


def free_length(scene, found):
    """Return A − S of discs in an ordered channel."""
    x, y = np.split(found, 4)[:2]
    heights = np.take_along_axis(y, np.argsort(x, axis=0), 0)
    apart = np.sqrt(scene.contact_distance**2 - np.diff(heights, axis=0) ** 2)
    return scene.range_x - apart.sum(0)


EDGES = (1.0, 1.05, 1.2, 1.5, 2.0, 2.5, 3.5)


def box(discs, packing, periodic="", flat=1.0):
    """Return discs of the radius .1 at a packing fraction, in a box wider by a factor."""
    height = math.sqrt(discs * math.pi * 0.01 / packing / flat)
    return Scene(flat * height, height, 0.1, discs=discs, periodic=periodic)


def check(one, other):
    """Five sigma of both."""
    (mean, error), (same, spread) = one, other
    assert np.all(np.abs(mean - same) <= 5 * np.hypot(error, spread)), (mean, same, error)


@pytest.mark.parametrize(
    "scene",
    [
        box(256, 0.6),
        box(256, 0.6, "x"),
        Scene(40.0, 0.6, 0.18, discs=128),
        Scene(0.41, 30.0, 0.1, discs=128, periodic="x"),
    ],
)
def test_states_are_allowed(scene):
    x, y = np.split(drawn(scene, 10, 1), 4)[:2]
    i, j = np.array([*itertools.combinations(range(scene.discs), 2)]).T
    dx = np.abs(x[i] - x[j])
    dx = np.minimum(dx, scene.width - dx) if scene.periodic else dx
    assert np.min(np.hypot(dx, y[i] - y[j])) >= scene.contact_distance * (1 - 1e-14)
    assert np.max(np.abs(x)) <= scene.range_x / 2
    assert np.max(np.abs(y)) <= scene.range_y / 2
    # No disc is left where it began.
    began = np.array(arrangement(scene)).T
    assert not np.any(x == began[0][:, None])
    assert is_ordered(scene) or not np.any(y == began[1][:, None])


@pytest.mark.parametrize(
    "scene",
    [
        box(20, 0.55),
        box(20, 0.5, "x"),
        Scene(9.6, 0.75, 0.18, discs=24),
        *(
            pytest.param(scene, marks=pytest.mark.slow)
            for scene in (
                box(20, 0.1),
                Scene(0.54, 5.0, 0.13, discs=20, periodic="x"),
                Scene(0.7, 3.0, 0.1, discs=24, periodic="x"),
                box(32, 0.6),
            )
        ),
    ],
    ids=repr,
)
def test_chains_of_single_moves_agree(scene):
    one = moments(scene, drawn(scene, 500, 1))
    check(one, moments(scene, drawn(scene, 400, 2, chain=one_by_one(scene, 4000))))


@pytest.mark.slow
@pytest.mark.parametrize(
    "scene", [box(256, 0.6), box(256, 0.6, "x"), box(256, 0.6, "", 8)], ids=repr
)
def test_much_longer_chains_of_single_moves_agree(scene):
    one = moments(scene, drawn(scene, 300, 1))
    check(one, moments(scene, drawn(scene, 24, 2, chain=one_by_one(scene, 16_000))))


@pytest.mark.slow
@pytest.mark.parametrize("scene", [box(20, 0.1), *(box(n, 0.6) for n in (32, 64, 256))], ids=repr)
def test_longer_event_chains_are_no_different(scene, monkeypatch):
    number = 2**14 // scene.discs
    one = moments(scene, drawn(scene, number, 1))
    monkeypatch.setattr(chains, "CONTACTS", 4 * chains.CONTACTS)
    check(one, moments(scene, drawn(scene, number // 2, 2)))


def test_event_chains_that_are_too_short_are_seen(monkeypatch):
    scene = box(32, 0.6)
    one = moments(scene, drawn(scene, 200, 1))
    monkeypatch.setattr(chains, "CONTACTS", 16)
    mean, error = moments(scene, drawn(scene, 200, 2))
    assert np.max(np.abs(mean - one[0]) / np.hypot(error, one[1])) > 10


@pytest.mark.parametrize(
    "scene",
    [
        Scene(28.0, 0.6, 0.18, discs=80),
        pytest.param(Scene(22.0, 0.6, 0.18, discs=80), marks=pytest.mark.slow),
    ],
    ids=repr,
)
def test_long_channels_are_those_of_exact_draws(scene):
    """The variance of the free length is too large in the states that chains begin with."""
    both = drawn(scene, 160, 1), drawn(scene, 250, 2, chain=None)
    check(*(moments(scene, found) for found in both))
    one, other = (free_length(scene, found) for found in both)
    law = f(one.size - 1, other.size - 1)
    ratio = one.var(ddof=1) / other.var(ddof=1)
    assert min(law.sf(ratio), law.cdf(ratio)) > 2.9e-7
