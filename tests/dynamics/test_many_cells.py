"""Many discs: rates of the kernel of few discs and of theory, no lost hop, no overlap."""

import itertools
import math

import numpy as np
import pytest

from twodiscs.dynamics.many import cells as many_cells
from twodiscs.dynamics.many import engine, path
from twodiscs.dynamics.many import lockstep as many
from twodiscs.dynamics.many.engine import mean_interval
from twodiscs.dynamics.runs import relative_errors
from twodiscs.model.events import SHELLS
from twodiscs.model.scene import Scene
from twodiscs.sampling.many import initial
from twodiscs.sampling.many.cells import grid_of
from twodiscs.theory import n_discs
from twodiscs.theory.virial import rates, virial_weights


def counts_of(scene, seed, replicas, events, epochs=7.3):
    """Return (sums, products, duration) of ``many_cells``, whose times begin anew some times."""
    duration = engine.duration_of(scene, events)
    hops_x = None if scene.periodic else True
    sums, products = many_cells.count_events(
        initial.states(scene, replicas, seed), np.uint64(seed), 0, duration, duration / epochs,
        many.law_of(scene), grid_of(scene), True, hops_x, None,
    )  # fmt: skip
    return sums, products, duration


def means(sums, products, duration, replicas):
    """Return (rates, standard errors) of all classes."""
    found = sums / replicas / duration
    return found, found * np.where(sums > 0, relative_errors(sums, products, replicas), 0.0)


THREE = [
    Scene(1.5, 1.0, 0.15, discs=3),
    Scene(1.5, 1.0, 0.26, discs=3),
    Scene(1.0, 1.5, 0.24, discs=3),
]


@pytest.mark.parametrize(
    "scene",
    [
        THREE[0],
        pytest.param(THREE[1], marks=pytest.mark.slow),
        pytest.param(THREE[2], marks=pytest.mark.slow),
        Scene(3.5, 0.6, 0.18, discs=8),
        Scene(7.0, 0.6, 0.18, discs=16),
        pytest.param(
            Scene(7.0, 0.6, 0.18, discs=16, moment_of_inertia=0.5), marks=pytest.mark.slow
        ),
    ],
    ids=repr,
)
def test_rates_are_exact(scene):
    """Five sigma on every class, with as few cells as there may be."""
    found, errors = means(*counts_of(scene, 1, 4096, 256), 4096)
    for event, rate in rates(scene, n_discs.known_derivatives(scene)).items():
        k = [*SHELLS].index(event)
        assert abs(found[k] - rate) <= 5 * errors[k], (event, found[k], rate, errors[k])


#: At the border: where one kernel ends and the other one begins, and on rings.
BORDER = [
    Scene(15.0, 1.0, 0.1, discs=initial.LARGE),
    Scene(4.0, 2.0, 0.2, discs=initial.LARGE),
    Scene(8.0, 0.9, 0.2, discs=initial.LARGE),
    Scene(4.0, 2.0, 0.15, discs=initial.LARGE, periodic="x"),
    Scene(4.0, 2.0, 0.15, discs=initial.LARGE, periodic="x", moment_of_inertia=0.4),
]


#: Rings of three columns of cells, and of two, where both images of a disc are in reach.
SHORT = [
    Scene(0.7, 4.0, 0.1, discs=24, periodic="x"),
    Scene(0.6, 4.0, 0.13, discs=initial.LARGE, periodic="x"),
]


#: Its kernels take seconds to compile.
ROUGH_TOO = pytest.param(BORDER[4], marks=pytest.mark.slow)


@pytest.mark.parametrize(
    "scene",
    [
        BORDER[1],
        *(pytest.param(s, marks=pytest.mark.slow) for s in (BORDER[0], *BORDER[2:4], *SHORT)),
    ],
    ids=repr,
)
def test_both_kernels_have_the_same_rates(scene):
    """Five sigma on every class, beyond the few events that are the same ones."""
    replicas = 1024
    found, errors = means(*counts_of(scene, 2, replicas, 1024), replicas)
    duration = engine.duration_of(scene, 1024)
    hops_x = None if scene.periodic else True
    sums, products = many.count_events(
        initial.states(scene, replicas, 3), np.uint64(3), 0, 64, duration, many.law_of(scene),
        hops_x, None,
    )  # fmt: skip
    other, spread = means(sums, products, duration, replicas)
    assert np.all(np.abs(found - other) <= 5 * np.hypot(errors, spread)), (found, other)


@pytest.mark.parametrize("scene", [*BORDER[:4], *SHORT, ROUGH_TOO], ids=repr)
def test_a_few_events_are_the_same_ones(scene):
    """From the same states, before roundings have grown: the same counts, every one of them."""
    replicas, duration = 256, engine.duration_of(scene, 2 * scene.discs)
    hops_x = None if scene.periodic else True
    given, law = (initial.states(scene, replicas, 4), np.uint64(4), 0), many.law_of(scene)
    one = many_cells.count_events(
        *given, duration, duration / 3, law, grid_of(scene), True, hops_x, None
    )
    other = many.count_events(*given, 64, duration, law, hops_x, None)
    assert one[0].sum() > 10 * replicas
    for some, same in zip(one, other, strict=True):
        assert np.array_equal(some, same)


def test_which_kernel_runs():
    """By the number of discs."""
    small, large = (Scene(15.0, 1.0, 0.1, discs=n) for n in (initial.LARGE - 1, initial.LARGE))
    assert initial.large_grid(small) is None
    assert initial.large_grid(large) is not None
    assert [grid_of(scene).x.size for scene in SHORT] == [4, 3]
    sums, _ = engine.run_classes(large, 5, 0, 1, 4.0, replicas=16)
    alone, _ = engine.run_classes(large, 5, 0, 1, 4.0, replicas=16, hops=False)
    assert np.array_equal(sums[2:], alone[2:])
    assert not alone[:2].any()


def test_shards_add_up():
    scene = BORDER[0]
    whole = engine.run_classes(scene, 7, 0, 3, 8.0, replicas=20)
    parts = [engine.run_classes(scene, 7, a, b, 8.0, replicas=20) for a, b in ((0, 1), (1, 3))]
    for one, *pieces in zip(whole, *parts, strict=True):
        assert np.array_equal(one, sum(pieces))


def test_the_virial_theorem_holds_for_many_discs():
    """Five sigma, at a packing fraction of .5 in a box."""
    side = math.sqrt(64 * math.pi * 0.01 / 0.5)
    scene, replicas = Scene(side, side, 0.1, discs=64), 256
    sums, products = engine.run_classes(
        scene, 8, 0, 1, engine.duration_of(scene), replicas=replicas
    )
    duration = engine.duration_of(scene)
    weights = np.array([virial_weights(scene).get(event, 0.0) for event in SHELLS])
    second = np.triu(products) + np.triu(products, 1).T
    covariance = (second / replicas - np.outer(sums, sums) / replicas**2) / replicas / duration**2
    error = math.sqrt(weights @ covariance @ weights)
    assert error < 0.01
    assert abs(weights @ sums / replicas / duration - 1) < 5 * error


@pytest.mark.parametrize(
    "scene", [BORDER[0], BORDER[3], *SHORT, ROUGH_TOO, Scene(48.0, 1.0, 0.1, discs=64)], ids=repr
)
def test_advanced_states_are_those_of_the_other_kernel(scene):
    """After some events of each disc, and there and back again; rounds of a ring as well."""
    start = initial.states(scene, 20, 9)
    duration = engine.duration_of(scene, 4 * scene.discs)
    states, laps = start.copy(), np.zeros((scene.discs, 20))
    counts = scene.periodic and scene.moment_of_inertia is None
    hops, others = (np.zeros(20), np.zeros(20)) if counts else (None, None)
    engine.advance_all(scene, states, laps, duration, None, hops)
    other, rounds = start.copy(), np.zeros((scene.discs, 20))
    many.advance_states(other, rounds, duration, many.law_of(scene), None, others)
    assert np.array_equal(laps, rounds)
    assert np.array_equal(hops, others)
    assert states == pytest.approx(other, abs=1e-7 * scene.width)
    states[2 * scene.discs :] *= -1
    engine.advance_all(scene, states, laps, duration, None)
    states[2 * scene.discs :] *= -1
    assert states == pytest.approx(start, abs=1e-7 * scene.width)


@pytest.mark.parametrize("scene", [BORDER[0], BORDER[3], *SHORT, ROUGH_TOO], ids=repr)
def test_a_trajectory_has_the_events_of_the_other_kernel(scene, monkeypatch):
    """In the same order, hops as well, before roundings have grown; also past a full log."""
    state = initial.states(scene, 1, 1)[:, 0]
    if scene.periodic:
        state[3] += 2 * scene.width
    # The rate that is guessed for short rings is far too high.
    duration = engine.duration_of(scene, (10 if scene in SHORT else 5) * scene.discs)
    monkeypatch.setattr(engine, "ENTRIES", 50)
    found = [*path.events_of(scene, state, duration)]
    monkeypatch.setattr(path, "large_grid", lambda scene: None)
    other = [*path.events_of(scene, state, duration)]
    assert len(found) > (2 if scene in SHORT else 5) * scene.discs
    assert [row[1:4] for row in found] == [row[1:4] for row in other]
    for (time, *_, now), (same, *_, then) in zip(found, other, strict=True):
        assert time == pytest.approx(same, abs=1e-7)
        assert now == pytest.approx(then, abs=1e-7 * scene.width)


@pytest.mark.parametrize(
    ("scene", "hop"),
    [
        (BORDER[0], "vertical_hop"),
        pytest.param(BORDER[1], "horizontal_hop", marks=pytest.mark.slow),
        (BORDER[3], "vertical_hop"),
    ],
    ids=repr,
)
def test_intervals_are_those_of_the_other_kernel(scene, hop, monkeypatch):
    """Those of each chain, from the same states, before roundings have grown."""
    mean = mean_interval(scene, hop)
    bins = mean / 16, np.arange(65) // 8 + 65
    given = 8 * mean, scene, hop, 3, 2, 4, 20, bins
    sums, other = np.zeros((2, 3, 74), np.int64)
    monkeypatch.setattr(engine, "ENTRIES", 50)
    found = engine.record_within(*given, sums, np.ones(1, np.bool_))
    monkeypatch.setattr(engine, "large_grid", lambda scene: None)
    same = engine.record_within(*given, other, np.ones(1, np.bool_))
    assert found == pytest.approx(same, rel=1e-6)
    assert np.array_equal(found[1], same[1])
    assert found[1].sum() > 20
    # A rounding may move an interval across the border of a bin.
    assert np.abs(sums - other)[0].sum() <= 2
    assert np.array_equal(sums[0, :65].sum(), found[1].sum())


def test_each_row_of_256_discs_is_where_it_says():
    """The energy stays, discs are level at hops, and touch at collisions."""
    scene = Scene(8.0, 4.0, 0.1, discs=256)
    rows = [*path.events_of(scene, initial.states(scene, 1, 1)[:, 0], path.usual_duration(scene))]
    assert len(rows) > 1500
    for _, name, first, second, state in rows:
        x, y, u, v = np.split(state, 4)
        assert np.sum(u * u + v * v) == pytest.approx(1, abs=1e-12)
        if name == "vertical_hop":
            assert y[first - 1] == pytest.approx(y[second - 1], abs=1e-9)
        if name == "disc_collision":
            i, j = first - 1, second - 1
            assert math.hypot(x[i] - x[j], y[i] - y[j]) == pytest.approx(0.2, abs=1e-9)


#: Roundings of the box that an overlap may be, and |E − 1/2| after 1e8 events.
GAP_BOUND, ENERGY_BOUND = 1e-14, 1e-11


def check_conserved(scene, events):
    """Follow one trajectory in pieces and check distances, ranges and the energy after each."""
    n, states = scene.discs, initial.states(scene, 1, 1)
    law, grid, epoch = (
        many.law_of(scene),
        grid_of(scene),
        engine.duration_of(scene, 64 * scene.discs),
    )
    pieces, laps = 20, np.zeros((n, 1))
    duration = engine.duration_of(scene, events / pieces)
    for _ in range(pieces):
        many_cells.advance_all(states, laps, duration, epoch, law, grid, None, None)
        x, y, u, v = np.split(states[:, 0], 4)
        half = law.ring[1] * (1 + 1e-15) if law.ring else scene.range_x / 2
        assert np.max(np.abs(x)) <= half
        assert np.max(np.abs(y)) <= scene.range_y / 2
        i, j = np.array([*itertools.combinations(range(n), 2)]).T
        dx = np.abs(x[i] - x[j])
        dx = np.minimum(dx, scene.width - dx) if law.ring else dx
        gap = np.min(np.hypot(dx, y[i] - y[j])) - scene.contact_distance
        assert gap >= -GAP_BOUND * max(scene.width, scene.height)
        assert abs(np.sum(u * u + v * v) - 1) / 2 < ENERGY_BOUND
        if law.ring:
            assert abs(np.sum(u)) < 1e-10
    return states


side = math.sqrt(256 * math.pi * 0.01 / 0.6)
DENSE = [
    Scene(side, side, 0.1, discs=256),
    Scene(side, side, 0.1, discs=256, periodic="x"),
    Scene(18.0, 0.6, 0.18, discs=64),
]


@pytest.mark.parametrize("scene", DENSE, ids=repr)
def test_everything_is_conserved(scene):
    check_conserved(scene, 1_000_000)


@pytest.mark.slow
@pytest.mark.parametrize("scene", DENSE[:2], ids=repr)
def test_everything_is_conserved_over_a_hundred_million_events(scene):
    check_conserved(scene, 10**8)
