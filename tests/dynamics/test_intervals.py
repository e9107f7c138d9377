"""Intervals between hops: exact draws, whose mean and density at zero are known."""

import math

import numpy as np
import pytest
from effect_scenes import SCENES

from twodiscs.dynamics import intervals
from twodiscs.dynamics.law import law_of
from twodiscs.model.events import HOPS
from twodiscs.model.scene import Scene
from twodiscs.sampling.starts import origins
from twodiscs.theory.exact import mean_times
from twodiscs.theory.tails import density_at_zero

PAPER = Scene(1.5, 1.0, 0.2)


def check_mean(scene, event, number):
    found = intervals.hop_intervals(scene, event, number, 9)
    assert abs(found["mean"] - mean_times(scene)[event]) <= 5 * found["stderr"]
    assert sum(found["counts"]) + found["overflow"] == found["intervals"] >= number
    assert math.frexp(found["bin_width"])[0] == 0.5  # a power of two


@pytest.mark.parametrize("event", HOPS)
@pytest.mark.parametrize("radius", [0.05, 0.2])
def test_hop_intervals_have_the_exact_mean(event, radius):
    check_mean(PAPER.with_radius(radius), event, 2_000_000)


@pytest.mark.slow
def test_horizontal_hops_in_a_field_have_the_exact_mean():
    """This box cannot be turned by a quarter: its horizontal hops have starts of their own."""
    check_mean(SCENES["field"], "horizontal_hop", 500_000)


@pytest.mark.parametrize(("event", "side"), [("vertical_hop", 1.0), ("horizontal_hop", 1.5)])
def test_hop_intervals_have_the_exact_density_at_zero(event, side):
    """p(0⁺) = 3√2 / (16 (side − 2r))."""
    scene = PAPER.with_radius(0.1)
    found = intervals.hop_intervals(scene, event, 8_000_000, 10)
    width, n = found["bin_width"], found["intervals"]
    counts, squares = (np.array(found[name][:2]) for name in ("counts", "squares"))
    error = np.sqrt(squares - counts**2 / found["chains"]) / (n * width)
    # That of p(0) − at²: the density has no linear term.
    at_zero = np.array([7.0, -1.0]) / 6
    exact = 3 * math.sqrt(2) / (16 * (side - 0.2))
    assert density_at_zero(scene, event) == pytest.approx(exact, rel=1e-15)
    assert abs(counts @ at_zero / (n * width) - exact) <= 5 * np.hypot(*error * at_zero)


def test_hop_chains_do_not_depend_on_lanes():
    results = []
    wide = np.repeat([65, 66], [1, 64])
    for lanes in (5, 64):
        sums = np.zeros((2, 67), np.int64)
        totals = intervals.record_returns(
            np.uint64(1), 0, 2, 64, lanes, 16, law_of(PAPER), *origins(PAPER), None, 0.25, wide,
            sums, np.ones(1, np.bool_),
        )  # fmt: skip
        results.append((totals, sums))
    for few, many in zip(*results, strict=True):
        assert np.array_equal(few, many)


def test_squares_are_those_of_the_counts_of_each_chain():
    """A chain at a time, its counts are known; in wide bins they are sums over those in others."""
    edges, found = np.array(intervals.wide_edges(64)), []
    wide = np.full(65, 65 + edges.size)
    wide[: edges[-1]] = 65 + np.searchsorted(edges, np.arange(edges[-1]), side="right") - 1
    for first, stop in (*((i, i + 1) for i in range(8)), (0, 8)):
        sums = np.zeros((2, 66 + edges.size), np.int64)
        intervals.record_returns(
            np.uint64(3), first, stop, 1, 4, 32, law_of(PAPER), *origins(PAPER), None, 0.25, wide,
            sums, np.ones(1, np.bool_),
        )  # fmt: skip
        found.append(sums)
    chains = np.array([counts for counts, _ in found[:-1]])
    assert np.array_equal(found[-1], [chains.sum(axis=0), (chains**2).sum(axis=0)])
    assert (chains[:, :65].sum(axis=1) == 32).all()
    joined = np.add.reduceat(chains[:, : edges[-1]], edges[:-1], axis=1)
    assert np.array_equal(chains[:, 65 : 64 + edges.size], joined)


def test_wide_bins_widen():
    edges = intervals.wide_edges()
    assert edges[:14] == list(range(14))
    growth = np.diff(edges) / np.maximum(edges[:-1], 1)
    assert (growth >= intervals.GROWTH).all()
    assert edges[-1] <= intervals.BINS < (1 + intervals.GROWTH) * edges[-1]


def test_a_blocked_hop_has_no_intervals():
    with pytest.raises(ValueError, match="blocked"):
        intervals.hop_intervals(PAPER.with_radius(0.3), "horizontal_hop", 1, 1)
