"""The study of distributions: hazards, correlations, first passages.

Without these tests fits of hazards and what they are sorted by could be wrong, or their errors.

Statistical comparisons allow five standard errors. Errors from 128 blocks are known to 6 %, and
their scores are turned into normal deviates; with some 150 comparisons a false alarm comes in fewer
than 1e-4 of the seeds.
"""

from itertools import pairwise

import mpmath
import numpy as np
import pytest
from factory import BOX, empty, of, written
from scipy.stats import chi2, norm

from twodiscs.analysis.scores import student_deviate
from twodiscs.model.events import HOPS
from twodiscs.model.scene import Box, Scene
from twodiscs.theory import laws
from twodiscs_paper.studies.distributions import measure as distributions
from twodiscs_paper.studies.distributions.study import DistributionsTable
from twodiscs_paper.studies.single import tail_constant


def bins_of(edges, chances, intervals):
    """Return bins of intervals that end in each with the ``chances`` given that they last so long.

    Every count is the nearest integer to its mean.
    """
    alive, found = intervals, []
    for first, last, chance in zip(edges, edges[1:], chances, strict=False):
        count = round(alive * chance)
        found.append(distributions.HazardBin(first, last, None, None, count, alive))
        alive -= count
    return found


EDGES = np.concatenate(([0.0], np.cumsum(0.3 * 1.1 ** np.arange(14)))) + 4


def test_the_density_at_zero_has_the_error_of_multinomial_counts():
    """Each interval adds 7/6 in the first bin, −1/6 in the second one."""
    each = np.repeat([7 / 6, -1 / 6, 0], [30, 20, 50])
    found = distributions.density_at_zero([30, 20], 100, 0.25)
    due = each.mean() / 0.25, each.std() / 10 / 0.25
    assert (found.value, found.stderr) == pytest.approx(due)


# Fits ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("rate", [0.01, 0.3, 0.8])
def test_rate_maximizes_the_likelihood(rate):
    """With bins and censored times: the zero of the derivative and the curvature, by mpmath."""
    chances = -np.expm1(-rate * np.diff(EDGES)) * (1 + 0.1 * np.cos(np.arange(14)))
    bins = bins_of(EDGES, chances, 10**6)
    found, _, pearson, degrees = distributions.constant_hazard(bins)
    with mpmath.workdps(40):

        def log_likelihood(x, mean=False):
            total = mpmath.mpf(0)
            for one in bins:
                width = mpmath.mpf(one.last) - mpmath.mpf(one.first)
                due = -one.alive * mpmath.expm1(-found.value * width) if mean else one.count
                total += due * mpmath.log(-mpmath.expm1(-x * width))
                total -= (one.alive - due) * x * width
            return total

        due = mpmath.findroot(lambda x: mpmath.diff(log_likelihood, x), found.value)
        curvature = -mpmath.diff(lambda x: log_likelihood(x, mean=True), found.value, 2)
    assert found.value == pytest.approx(float(due), rel=1e-12)
    assert found.stderr == pytest.approx(float(1 / mpmath.sqrt(curvature)), rel=1e-12)
    assert (found.n, degrees) == (sum(one.count for one in bins), 13)
    count, alive = np.array([one[-2:] for one in bins]).T
    lasting = np.exp(-found.value * np.diff(EDGES))
    due = (count - alive * (1 - lasting)) ** 2 / (alive * lasting * (1 - lasting))
    assert pearson == pytest.approx(due.sum())


def test_a_hazard_that_falls_slowly_shows_in_the_trend():
    chances = -np.expm1(-0.4 * ((EDGES[1:] + EDGES[:-1]) / 12) ** -0.2 * np.diff(EDGES))
    _, trend, _, _ = distributions.constant_hazard(bins_of(EDGES, chances, 10**6))
    assert trend.value == pytest.approx(-0.2, abs=0.02)


def test_bins_of_a_hazard_follow_one_another():
    times = np.random.default_rng(8).exponential(2.0, 10**4)
    counts = np.bincount((times / 0.25).astype(int), minlength=30)
    rows = list(distributions.hazard(counts[:30], 10**4, 0.25))
    assert len(rows) > 10
    for row, after in pairwise(rows):
        assert row.alive == np.count_nonzero(times >= row.first)
        assert abs(row.rate - 0.5) < 5 * row.error < 5 * 0.7 / np.sqrt(row.count)
        assert (row.last, row.alive - row.count) == (after.first, after.alive)
        assert row.last - row.first >= distributions.GROWTH * row.first
        assert row.count >= distributions.FEWEST_IN_BIN


# Measurements -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("box", "radius", "hop"),
    [
        ((1.5, 1.0), 0.24, "vertical_hop"),
        ((1.5, 1.0), 0.2, "horizontal_hop"),
        ((3.0, 1.0), 0.4, "vertical_hop"),
        ((1.0, 1.5), 0.1, "horizontal_hop"),
    ],
)
def test_what_is_measured_meets_what_is_exact(box, radius, hop):
    """The mean interval, the density at 0, and Palm's relation between intervals and passages."""
    scene = Scene(*box, radius)
    rows = distributions.measured({}, scene, hop, 4, 2**20)
    rows = [empty(DistributionsTable, **row) for row in rows]
    by_name = {(row["quantity"], row["last"] is None): row for row in rows}
    assert abs(by_name["mean", True]["z"]) < 5
    room = min(box) - 4 * radius if hop == "horizontal_hop" and box[0] > box[1] else 1
    if room > 0.5:
        zero = by_name["density_at_zero", False]
        assert zero["reference"] == laws.density_at_zero(scene, hop)
        assert abs(zero["z"]) < 5
    passage, cut = by_name["first_passage", True], by_name["first_passage", False]
    off = (cut["estimate"] - cut["reference"]) / np.hypot(cut["stderr"], cut["reference_stderr"])
    assert abs(cut["z"]) < 5
    assert cut["z"] == pytest.approx(student_deviate(off, distributions.INTERVAL_BLOCKS - 1))
    assert cut["estimate"] <= passage["estimate"]
    # Passages take half of (1 + the squared variation) mean intervals.
    square, mean = by_name["squared_cv", True], by_name["mean", True]["reference"]
    assert square["estimate"] == pytest.approx(2 * passage["reference"] / mean - 1)
    assert square["stderr"] == pytest.approx(2 * passage["reference_stderr"] / mean)
    assert (passage["z"] is None) == (tail_constant(scene, hop) > 0)
    # The late hazard against 1/τ, and whether it is constant.
    if rate := by_name.get(("rate", False)):
        mean_rate, trend = 1 / rows[0]["reference"], by_name["trend", False]
        assert rate["z"] * rate["stderr"] == pytest.approx(rate["estimate"] - mean_rate)
        assert rate["p"] == pytest.approx(chi2.sf(rate["chi2"], rate["degrees"]))
        assert trend["p"] == pytest.approx(2 * norm.sf(abs(trend["estimate"]) / trend["stderr"]))


def test_radii_near_the_threshold():
    def near(hop, width=1.5, height=1.0):
        return distributions.near_threshold(Box(width, height), hop)

    assert near("horizontal_hop") == [0.21, 0.23, 0.24, 0.245, 0.2475]
    assert near("vertical_hop")[-1] == 0.37125
    assert near("vertical_hop", 3.0) == []
    assert near("vertical_hop", 1.0, 3.0)[0] == 0.21
    assert near("horizontal_hop", 1e6) == []  # an interval takes more than 1e7 events


# The table and the figure -------------------------------------------------------------------------


def test_the_table_is_written(tmp_path):
    scene = {"name": "paper", "box": BOX.parameters(), "event": "vertical_hop", "radii": [0.2]}
    other = scene | {"name": "other", "box": Box(3.0, 1.0).parameters()}
    rows = written(tmp_path, DistributionsTable, events=2**16, scenes=[scene, other], seed=9)
    cases = dict.fromkeys((row["scene"], row["event"], row["radius"]) for row in rows)
    near = [("paper", hop, r) for hop in HOPS for r in distributions.near_threshold(BOX, hop)]
    assert [*cases] == [("paper", "vertical_hop", 0.2), *near, ("other", "vertical_hop", 0.2)]
    # A case does not depend on the others.
    alone = [empty(DistributionsTable, **row) for row in DistributionsTable.rows([scene], 9, 2**16)]
    assert alone == of(rows, scene="paper")


def case(event, radius, p, trend, counts=(), mean=0.5):
    """Return the rows of one hop: a rate fitted over 20 mean times, bins of 2 mean times."""
    start = {"scene": "main", "width": 3.0, "height": 1.0, "event": event, "radius": radius}
    start |= {"exact_mean": mean}
    rate = {"quantity": "rate", "first": 4 * mean, "last": 20 * mean, "estimate": 0.8 / mean}
    rows = [rate | {"stderr": 0.02, "count": 9, "p": p}, {"quantity": "trend", "p": trend}]
    for i, (count, rate) in enumerate(counts):
        ends = {"quantity": "hazard", "first": 2 * i * mean, "last": 2 * (i + 1) * mean}
        rows.append(ends | {"count": count, "estimate": rate})
    return [start | row for row in rows]


FALLING = [(9999, 9.0)] * 6 + [(100, 2.0), (50, 1.0), (25, 0.5), (0, 0.0)]


@pytest.mark.parametrize(
    ("event", "radius", "p", "trend", "counts", "due"),
    [
        ("vertical_hop", 0.1, 0.5, 0.25, (), ["plateau"]),
        ("vertical_hop", 0.1, 1e-6, 0.25, (), ["falling"]),
        ("vertical_hop", 0.1, 0.5, 1e-6, (), ["falling"]),
        ("vertical_hop", 0.3, 0.5, 1e-6, (), ["falling_without_drift"]),
        ("horizontal_hop", 0.3, 0.5, 1e-6, (), ["falling"]),
        ("vertical_hop", 0.1, 1e-6, 0.5, FALLING, ["falling"]),
        ("vertical_hop", 0.1, 1e-6, 0.5, [(100, 1.3)] * 9, ["falling"]),
        ("vertical_hop", 0.1, 0.5, 0.5, FALLING, ["plateau"]),
    ],
)
def test_hazards_are_sorted_by_whether_they_are_constant(event, radius, p, trend, counts, due):
    rows = case(event, radius, p, trend, counts)
    assert [row["quantity"] for row in distributions.shape(rows)] == due
    assert not [*distributions.shape(rows[1:])]


def test_late_hazards_are_hops_over_their_time_at_risk():
    """Late bins are those from 12 mean times on; the risk of a bin is hops over hazard."""
    (falling,) = distributions.shape(case("vertical_hop", 0.1, 1e-6, 0.5, FALLING))
    hops, risk = 175, 150.0
    assert (falling["first"], falling["last"], falling["count"]) == (6.0, 9.0, hops)
    assert falling["estimate"] == pytest.approx(hops / risk)
    assert falling["stderr"] == pytest.approx(np.sqrt(hops) / risk)
    (plateau,) = distributions.shape(case("vertical_hop", 0.1, 0.5, 0.5, FALLING))
    assert (plateau["estimate"], plateau["last"]) == (1.6, 10.0)
