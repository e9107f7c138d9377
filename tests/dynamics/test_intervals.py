"""Intervals could be cut off at an end, put in another bin or have too small errors."""

import math

import numpy as np
import pytest
from effect_scenes import SCENES
from marks import slow

from twodiscs.dynamics import runs, trajectory
from twodiscs.dynamics.many import engine
from twodiscs.dynamics.two import returns
from twodiscs.model.events import HOPS
from twodiscs.model.scene import Scene
from twodiscs.points.intervals import BINS, GROWTH, wide_edges
from twodiscs.sampling.many import initial, insertions
from twodiscs.theory.exact import mean_times
from twodiscs.theory.laws import density_at_zero
from twodiscs.theory.virial import rates

PAPER = Scene(1.5, 1.0, 0.2)


@pytest.mark.parametrize("event", HOPS)
@pytest.mark.parametrize("scene", [PAPER.with_radius(0.05), PAPER, slow(SCENES["field"])], ids=repr)
def test_hop_intervals_have_the_exact_mean(event, scene):
    """In a field the box cannot be turned by a quarter: horizontal hops have separate starts."""
    found = runs.IntervalRun(scene, event, 1_000_000, 9).run()
    assert abs(found.mean - mean_times(scene)[event]) <= 5 * found.stderr
    assert sum(found.equal.counts) + found.overflow == found.intervals >= 1_000_000
    assert math.frexp(found.bin_width)[0] == 0.5  # a power of two


@pytest.mark.parametrize(("event", "side"), [("vertical_hop", 1.0), ("horizontal_hop", 1.5)])
def test_hop_intervals_have_the_exact_density_at_zero(event, side):
    """p(0⁺) = 3√2 / (16 (side − 2r))."""
    scene = PAPER.with_radius(0.1)
    found = runs.IntervalRun(scene, event, 1_000_000, 10).run()
    width, n = found.bin_width, found.intervals
    counts, squares = np.array(found.equal.counts[:2]), np.array(found.equal.squares[:2])
    error = np.sqrt(squares - counts**2 / found.chains) / (n * width)
    # The law is p(0) − at²: the density has no linear term.
    at_zero = np.array([7.0, -1.0]) / 6
    exact = 3 * math.sqrt(2) / (16 * (side - 0.2))
    assert density_at_zero(scene, event) == pytest.approx(exact, rel=1e-15)
    assert abs(counts @ at_zero / (n * width) - exact) <= 5 * np.hypot(*error * at_zero)


def test_squares_are_those_of_the_counts_of_each_chain():
    """A chain at a time, its counts are known; in wide bins they are sums over those in others.

    They do not depend on the number of lanes.
    """
    edges, found, going = np.array(wide_edges(64)), [], np.ones(1, np.bool_)
    wide = np.full(65, 65 + edges.size)
    wide[: edges[-1]] = 65 + np.searchsorted(edges, np.arange(edges[-1]), side="right") - 1
    for first, stop in (*((i, i + 1) for i in range(8)), (0, 8)):
        sums = np.zeros((2, 66 + edges.size), np.int64)
        how = {"returns": 32, "lanes": 1 if stop - first == 1 else 5}
        returns.record_intervals(
            PAPER, "vertical_hop", 3, first, stop, 1, (0.25, wide), sums, going, **how
        )
        found.append(sums)
    chains = np.array([counts for counts, _ in found[:-1]])
    assert np.array_equal(found[-1], [chains.sum(axis=0), (chains**2).sum(axis=0)])
    assert (chains[:, :65].sum(axis=1) == 32).all()
    joined = np.add.reduceat(chains[:, : edges[-1]], edges[:-1], axis=1)
    assert np.array_equal(chains[:, 65 : 64 + edges.size], joined)


def test_wide_bins_widen():
    edges = wide_edges()
    assert edges[:14] == list(range(14))
    growth = np.diff(edges) / np.maximum(edges[:-1], 1)
    assert (growth >= GROWTH).all()
    assert edges[-1] <= BINS < (1 + GROWTH) * edges[-1]


# More than two discs -----------------------------------------------------------------------------


MANY = {
    "three": (Scene(1.5, 1.0, 0.15, discs=3), "vertical_hop"),
    "three, across": (Scene(1.5, 1.0, 0.15, discs=3), "horizontal_hop"),
    "four in a channel": (Scene(1.6, 0.6, 0.18, discs=4), "vertical_hop"),
    "four": (Scene(1.5, 1.0, 0.12, discs=4), "vertical_hop"),
    "four on a ring": (Scene(1.5, 1.0, 0.15, periodic="x", discs=4), "vertical_hop"),
}


@pytest.mark.parametrize(
    "name", [name if name in ("three", "four") else slow(name) for name in MANY]
)
def test_intervals_of_many_have_the_mean_of_theory_or_monte_carlo(name):
    """Five sigma: the first interval of a replica, or one cut off at an end, would show."""
    scene, event = MANY[name]
    found = runs.IntervalRun(scene, event, 2_000_000, 4).run()
    mean, error = mean_times(scene)[event], 0.0
    if mean is None:
        known, spread = (rates(scene, part) for part in insertions.sample(scene, 10**6, 5))
        mean, error = 1 / known[event], spread[event] / known[event] ** 2
    assert abs(found.mean - mean) <= 5 * math.hypot(found.stderr, error)
    assert found.stderr < 1.5e-3 * mean
    assert sum(found.equal.counts) + found.overflow == found.intervals >= 2_000_000


@pytest.mark.parametrize("name", ["three", slow("three, across"), "four on a ring"])
def test_intervals_of_many_are_those_of_trajectories(name):
    """All that begin within the window, to their end, counted from the rows of each replica."""
    scene, event = MANY[name]
    replicas, window, width = 5, 16.0, 0.125
    wide, sums = np.full(65, 65), np.zeros((3, 66), np.int64)
    going = np.ones(1, np.bool_)
    times, numbers = engine.record_within(
        window, scene, event, 7, 3, 4, replicas, (width, wide), sums, going
    )
    due = np.zeros((3, 66), np.int64)
    for k, state in enumerate(initial.states(scene, replicas, 7, 3).T):
        rows = trajectory.events_of(scene, state, 4 * window)
        at = np.array([time for time, name, *_ in rows if name == event])
        own = np.diff(at)[at[:-1] < window]
        assert (numbers[k], times[k]) == (own.size, pytest.approx(own.sum(), rel=1e-12))
        bins = np.minimum(own / width, 64).astype(int)
        c = np.bincount(np.concatenate([bins, wide[bins]]), minlength=66)
        due += [c, c * c, c * own.size]
    assert np.array_equal(sums, due)
