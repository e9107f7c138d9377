"""Estimates and their standard errors, from sums over replicas.

Without it an error bar could be too small, or be there if a run could not know it.

They are compared with enumeration, numpy, scipy and seeded simulation.
"""

import math
from fractions import Fraction
from statistics import mean, variance

import numpy as np
import pytest
from scipy.special import betainc
from scipy.stats import sem

from twodiscs.analysis import scores
from twodiscs.model.events import EVENTS
from twodiscs.points import estimates
from twodiscs.points.estimates import Estimate
from twodiscs_paper.studies.distributions.measure import density_at_zero
from twodiscs_paper.studies.estimates import sample_mean

# Estimates ------------------------------------------------------------------------------------


def test_combination_keeps_its_digits_where_terms_cancel():
    # b − a is 0, 1 or 2, while the terms are of order 1e9 and their squares of order 1e18.
    rng = np.random.default_rng(3)
    n = 10_000
    a, noise = (rng.integers(*ends, n).astype(object) for ends in ((10**6, 2 * 10**6), (0, 3)))
    b = a + noise
    products = {"a*a": a @ a, "a*b": a @ b, "b*b": b @ b}
    found = estimates.combination({"a": -1e3, "b": 1e3}, {"a": sum(a), "b": sum(b)}, products, n)
    noise = [Fraction(x) for x in noise]
    assert found.value == float(1000 * mean(noise))
    assert found.stderr == pytest.approx(1000 * math.sqrt(variance(noise) / n), rel=1e-15)


def sums_of(counts):
    """Return sums and products of counts by replica, {event: array}, in the order of EVENTS."""
    own = [event for event in EVENTS if event in counts]
    products = {f"{a}*{b}": int(counts[a] @ counts[b]) for i, a in enumerate(own) for b in own[i:]}
    return {event: int(counts[event].sum()) for event in own}, products, 100


def test_a_count_is_a_sum_of_others_if_it_is_so_in_every_replica():
    right, top, hop = np.random.default_rng(8).poisson(9, (3, 100))
    whole = {"right_wall": right, "top_wall": top, "any_wall": right + top}
    sums_of_others = estimates.sums_of_others
    # The last one is of a channel, which has no wall to the right.
    for counts in (whole, whole | {"vertical_hop": hop}, {"top_wall": top, "any_wall": top}):
        assert sums_of_others(*sums_of(counts)) == {"any_wall"}
    assert sums_of_others(*sums_of({"right_wall": right, "top_wall": top})) == set()
    # The same sum over all replicas, randomly.
    moved = np.roll(right + top, 1)
    assert sums_of_others(*sums_of(whole | {"any_wall": moved})) == set()
    assert sums_of_others(sums_of(whole | {"any_wall": moved})[0]) == {"any_wall"}
    # None of either is no sum.
    none = np.zeros(100, int)
    assert sums_of_others(*sums_of({"vertical_hop": none, "horizontal_hop": none})) == set()


# Means ----------------------------------------------------------------------------------------


def test_a_mean_has_the_error_of_its_spread():
    values = np.random.default_rng(10).exponential(3.0, (50, 4))
    for column, found in zip(values.T, sample_mean(values), strict=True):
        for same in (found, sample_mean(column), sample_mean(list(column))):
            pair = same.value, same.stderr
            assert pair == pytest.approx((column.mean(), sem(column)), rel=1e-14)
            assert same.n == 50
    assert sample_mean([1, 2]) == Estimate(1.5, 0.5, 2)
    assert sample_mean([1, -1]).relative_stderr == math.inf


# Counts ---------------------------------------------------------------------------------------


def moments(counts):
    return int(counts.sum()), int((counts**2).sum()), len(counts)


def test_mean_time_agrees_with_the_replicas_themselves():
    counts = np.random.default_rng(6).poisson(30, 400)
    found = estimates.mean_time(*moments(counts), 60.0)
    relative = counts.std(ddof=1) / math.sqrt(400) / counts.mean()
    assert found.value == pytest.approx(60 / counts.mean(), rel=1e-14)
    assert found.relative_stderr == pytest.approx(relative, rel=1e-12)
    assert estimates.effective_count(*moments(counts)) == pytest.approx(relative**-2, rel=1e-12)
    assert estimates.effective_count(*moments(np.array([3, 3]))) == 0
    z, test = scores.mean_time_z(*moments(counts), 60.0, 60 / 30.5)
    t = (30.5 - counts.mean()) / (counts.std(ddof=1) / math.sqrt(400))
    assert test == "normal"
    assert z == pytest.approx(scores.student_deviate(t, 399), rel=1e-12)


def test_the_law_of_a_test_does_not_depend_on_what_was_counted():
    """At the border runs with more events than expected, and with fewer, have the same test."""
    for replicas, due in ((2000, "cluster-bound"), (2200, "normal")):
        for count in (1800, 2100, 2400):  # of 1 expected in a replica
            assert scores.mean_time_z(count, 2 * count, replicas, 1.0, 1.0)[1] == due
    # As precise as exactly 100 events, and as 99.
    assert estimates.is_enough(100, 199, 100) > estimates.is_enough(100, 200, 100)
    assert estimates.is_enough(80, 90, 1000, expected=1.0)
    assert not estimates.is_enough(400, 500, 1000, expected=0.1)


def test_a_score_far_from_what_is_due_is_finite():
    assert 50 < scores.mean_time_z(0, 0, 1000, 10.0, 1.0)[0] < math.inf
    assert math.isfinite(scores.mean_time_z(10**9, 10**15, 1000, 10.0, 1e9)[0])


def test_weights_below_their_resolution_have_no_error():
    """Squares are rounded to units, 2^−20. Weights have an error from eight times 2^−10 on."""
    unit, samples = 2**20, 10**6
    for weight, known in ((2.0**-7, True), (2.0**-8, False)):
        total = round(1000 * weight * unit)
        squares = 1000 * math.floor(weight * weight * unit)
        estimate, effective = estimates.weighted_estimate(total, squares, unit, samples, 2.0)
        assert estimate.value == pytest.approx(2e-3 * weight)
        assert effective == (pytest.approx(1000) if known else 0.0)
        if known:  # a share of 1e-3 of all samples has this weight, the others have none
            spread = weight * math.sqrt(1e-3 * (1 - 1e-3) / samples)
            assert estimate.stderr == pytest.approx(2 * spread)
    # All of one weight, with squares that are rounded down, and none of a hundred without any.
    for squares in (unit * samples, unit * samples - 1):
        assert estimates.effective_misses(unit * samples, squares, unit, samples) == 0
    hits = samples - 90
    assert estimates.effective_misses(unit * hits, unit * hits, unit, samples) == pytest.approx(90)
    assert estimates.effective_misses(5, 0, unit, samples) == 0
    # Half of far more samples than there are units: the squares show half of the units.
    samples = 2**10 * unit
    some = unit * samples // 2
    assert estimates.effective_misses(some, some, unit, samples) == unit / 2


def test_the_density_at_zero_of_chains_is_that_of_counts_with_other_errors():
    counts, intervals, width, errors = [5200, 4900], 10**6, 0.125, [3.0, 4.0]
    independent = density_at_zero(counts, intervals, width)
    densities = [n / intervals / width for n in counts]
    value, error = estimates.density_of_chains_at_zero(densities, errors)
    due = math.sqrt((7 / 6 * 3) ** 2 + (4 / 6) ** 2)
    assert (value, error) == pytest.approx((independent.value, due))
    # As many independent intervals have nearly uncorrelated counts.
    binomial = [math.sqrt(n) / intervals / width for n in counts]
    _, error = estimates.density_of_chains_at_zero(densities, binomial)
    assert error == pytest.approx(independent.stderr, rel=0.01)
    # The straight line through the middles of both bins.
    value, error = estimates.density_of_chains_at_zero(densities, errors, linear=True)
    weights = 1 / np.array(errors)
    (_, constant), covariance = np.polyfit([0.5, 1.5], densities, 1, w=weights, cov="unscaled")
    assert (value, error) == pytest.approx((constant, math.sqrt(covariance[1, 1])))


@pytest.mark.parametrize("components", range(2, 11))
def test_shares_of_directions_and_speeds_are_those_of_the_beta_law(components):
    """The square of a component is of (1/2, (n − 1)/2). Only the fastest starts are together."""
    for cosine in (0.0, 0.125, 0.5, 0.9, 1.0):
        expected = betainc(0.5, (components - 1) / 2, cosine**2)
        assert estimates.fraction_below(cosine, components) == pytest.approx(expected, rel=1e-13)
    shares = estimates.fractions_of_speeds(components)
    assert math.fsum(shares) == pytest.approx(1, rel=1e-15)
    assert shares[-1] >= estimates.LEAST_STRATUM
    parts = [part / estimates.MOST_STRATA for part in range(1, len(shares) + 1)]
    below = [estimates.fraction_below(part, components) for part in parts]
    assert np.cumsum(shares)[:-1] == pytest.approx(below[:-1], rel=1e-13)
    assert 1 - below[-1] < estimates.LEAST_STRATUM


SHARES = np.outer([0.1, 0.2, 0.3, 0.25, 0.15], [0.5, 0.3, 0.2])
MEANS = np.outer([3.0, 2.0, 1.0, 0.5, 0.0], [0.2, 1.0, 2.0])


@pytest.mark.parametrize(("starts", "number"), [(60, 6000), (700, 6000), (3000, 100)])
def test_means_have_no_bias(starts, number):
    """Five sigma of 6000 means, without scatter within strata: 1/15 of what scatter is left.

    Of 700 starts 14 are expected in the smallest stratum: were strata joined by the starts they
    have, chance would decide there, and the mean be off by 9 sigma.
    """
    rng = np.random.default_rng(starts)
    fillings = rng.multinomial(starts, SHARES.ravel(), number).reshape(number, *SHARES.shape)
    found = [estimates.stratified_mean(SHARES, n, n * MEANS, n * MEANS**2)[0] for n in fillings]
    off = np.array(found) - np.sum(SHARES * MEANS)
    # With enough starts to keep all strata, the mean has no variance.
    assert abs(off.mean()) <= 5 * off.std() / math.sqrt(off.size) + 1e-15


def test_strata_of_few_starts_are_taken_together_and_one_start_has_no_error():
    shares, counts = np.full((2, 3), 1 / 6), np.arange(6).reshape(2, 3)
    # 16 are expected in each of 6 strata as soon as there are 96 starts, whatever there were.
    for last, parts in ((21, 6), (20, 2)):
        starts = np.array([[15, 15, 15], [15, 15, last]])
        mean, _ = estimates.stratified_mean(shares, starts, counts, counts)
        pairs = 2 / 3 * 8 / 60 + 1 / 3 * 7 / (15 + last)
        assert mean == pytest.approx(pairs if parts == 2 else np.mean(counts / starts))
    # A stratum that is almost empty has no separate mean.
    starts = np.array([[99, 99, 99], [99, 99, 1]])
    mean, _ = estimates.stratified_mean(shares, starts, counts, counts)
    assert mean == pytest.approx(2 / 3 * 8 / 396 + 1 / 3 * 7 / 100)
    starts[1, 2] = 2
    mean, _ = estimates.stratified_mean(shares, starts, counts, counts)
    assert mean == pytest.approx(np.mean(counts / starts))
    one = np.zeros((2, 3), int)
    one[1, 1] = 1
    assert estimates.stratified_mean(shares, one, 3 * one, 9 * one) == (3.0, math.inf)
    assert estimates.stratified_mean(shares, 2 * one, 6 * one, 20 * one) == (3.0, 1.0)
