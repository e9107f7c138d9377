"""The scores z of estimates, and the bounds for many of them.

Without it a test could reject a right number too often, or a wrong one never.

They are compared with enumeration, mpmath, scipy and seeded simulation.
"""

import math
from functools import reduce

import mpmath
import numpy as np
import pytest
from scipy.special import log_ndtr, ndtr, ndtri, stdtr

from twodiscs.analysis import scores


def five_sigma(probability, trials):
    """Return the interval of counts that a binomial law leaves once in two million times."""
    width = 5 * math.sqrt(trials * probability * (1 - probability))
    return trials * probability - width, trials * probability + width


# Tails ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("degrees", [99, 511, 10_000])
@pytest.mark.parametrize("t", [0.0, 0.3, -1.0, 2.5, -5.0, 8.0])
def test_student_deviate_has_the_tail_of_students_law(t, degrees):
    z = scores.student_deviate(t, degrees)
    # Wallace's formula is stated to 1e-3; it is better than that.
    assert z == pytest.approx(-math.copysign(ndtri(stdtr(degrees, -abs(t))), -t), abs=1e-3)


@pytest.mark.parametrize(
    ("hits", "samples", "p"),
    [(0, 1000, 1e-3), (3, 10**6, 1e-6), (12, 10**6, 1e-6), (40, 400, 0.2), (995, 1000, 0.99),
     (900, 2000, 0.45), (1500, 1500, 0.999)],
)  # fmt: skip
def test_exact_tail_is_the_doubled_binomial_tail(hits, samples, p):
    with mpmath.workdps(40):
        q = mpmath.mpf(p)

        def pmf(k):
            return mpmath.binomial(samples, k) * q**k * (1 - q) ** (samples - k)

        low = mpmath.fsum(pmf(k) for k in range(hits + 1))
        high = 1 - low + pmf(hits)
        doubled = float(min(1, 2 * min(low, high)))
    z, test = scores.binomial_z(hits, samples, p)
    assert test == "exact-tail"
    assert scores.two_sided_p(z) == pytest.approx(doubled, rel=1e-9)
    assert z == 0 or (z > 0) == (hits > samples * p)
    assert repr(scores.binomial_z(0, 10, 0.001)[0]) == "0.0"  # not -0.0


@pytest.mark.parametrize(
    ("hits", "samples", "p"),
    [(1500, 10**6, 1e-4), (10**6 - 1500, 10**6, 1 - 1e-4), (0, 99, 1 - 1e-7)],
)
def test_a_tail_that_underflows_has_the_logarithm_of_its_largest_term(hits, samples, p):
    """Chernoff's bound is above it by √(8 n p q) at most, with the share p = 1 − q of hits."""
    z, test = scores.binomial_z(hits, samples, p)
    rest = samples - hits
    log_term = mpmath.log(mpmath.binomial(samples, hits))
    log_term += hits * mpmath.log(p) + rest * mpmath.log1p(-p)
    above = float(log_ndtr(-abs(z)) - log_term)
    assert -1e-9 < above < 1e-9 + (math.log(8 * hits * rest / samples) / 2 if hits else 0)
    assert (test, z > 0) == ("exact-tail", hits > samples * p)


def test_binomial_z_is_normal_where_hits_and_misses_are_many():
    z, test = scores.binomial_z(10_400, 10**6, 0.01)
    assert test == "normal"
    assert z == pytest.approx(400 / math.sqrt(1e4 * 0.99), rel=1e-12)
    assert scores.binomial_z(10**6 - 10_400, 10**6, 0.99)[0] == pytest.approx(-z, rel=1e-9)
    assert scores.binomial_z(5, 10**6, 0.000_999)[1] == "exact-tail"
    assert scores.binomial_z(5, 10**6, 0.999_001)[1] == "exact-tail"


def test_a_probability_of_zero_or_one_leaves_nothing_to_chance():
    for hits, share, z in ((0, 0.0, 0), (1, 0.0, math.inf), (100, 1.0, 0), (99, 1.0, -math.inf)):
        assert scores.binomial_z(hits, 100, share) == (z, "certain")
    assert scores.impossible_z(1) == (-math.inf, "certain")  # its time is too short


def test_two_shells_that_overlap_have_a_normal_sum():
    rng = np.random.default_rng(4)
    samples, trials = 10**6, 5000
    measures, both, only = (3.0, 5.0), 0.3, (0.05, 0.25)
    counts = rng.multinomial(samples, [both, *only, 1 - both - sum(only)], trials)
    law = samples, measures, (both + only[0], both + only[1])
    found = [scores.shells_z((int(n + a), int(n + b)), int(n), *law) for n, a, b, _ in counts]
    assert {test for _, test in found} == {"normal"}
    z = [score for score, _ in found]
    assert abs(scores.z_mean(z)) < 5
    assert abs(scores.z_spread(z)) < 5


@pytest.mark.parametrize("order", [1, -1])
@pytest.mark.parametrize(
    ("probabilities", "due"),
    [((0.01, 0.01), "normal"), ((0.01, 1e-5), "exact-tail"), ((0.01, 0.0), "exact-tail"),
     ((0.0, 0.0), "certain")],
)  # fmt: skip
def test_a_sum_of_two_shells_is_as_normal_as_the_rarer_one(probabilities, due, order):
    hits = [round(10**6 * p) for p in probabilities]
    assert scores.shells_z(hits[::order], 0, 10**6, (3.0, 5.0), probabilities[::order])[1] == due


def test_union_never_rejects_more_often_than_it_says():
    first, noise = np.random.default_rng(5).standard_normal((2, 20_000))
    for correlation in (-1.0, 0.0, 0.7):
        second = correlation * first + math.sqrt(1 - correlation**2) * noise
        size = np.abs([scores.union_z(pair, 1) for pair in zip(first, second, strict=True)])
        for c in (1.0, 2.0, 3.0):
            assert (size >= c).sum() <= five_sigma(2 * ndtr(-c), size.size)[1]
    assert scores.union_z([0.1, -0.2], -1) == 0
    assert scores.union_z([60.0, 1.0], -3) == pytest.approx(math.log(2) / 60 - 60, abs=1e-4)
    assert scores.union_z([math.inf, 1.0], 1) == math.inf


# Mean times -----------------------------------------------------------------------------------


@pytest.mark.parametrize("sizes", [{1: 1.0}, {1: 0.6, 2: 0.3, 3: 0.1}, {4: 1.0}, {1: 0.5, 4: 0.5}])
@pytest.mark.parametrize("seen", [0.003, 0.05])
def test_cluster_bound_never_rejects_more_often_than_it_says(sizes, seen):
    replicas = 300
    law = np.zeros(5)
    law[0] = 1 - seen
    for size, share in sizes.items():
        law[size] = seen * share
    total = reduce(np.convolve, [law] * replicas)  # of the sum over independent replicas
    exact = 1 / float(law @ np.arange(5))
    # Σ N² = Σ N makes the allowance its smallest, K = 4. Totals of 200 and more count as rejected.
    found = [scores.mean_time_z(n, n, replicas, 1.0, exact) for n in range(200)]
    assert {test for _, test in found} == {"cluster-bound"}
    size = np.abs([z for z, _ in found])
    for c in (1.0, 2.0, 3.0, 4.0, 5.0):
        assert total[:200][size >= c].sum() + total[200:].sum() <= 2 * ndtr(-c)


# Many comparisons -----------------------------------------------------------------------------


def test_bonferroni_bound():
    assert scores.bonferroni_bound(1, 0.05) == pytest.approx(1.959964, abs=1e-6)
    assert scores.bonferroni_bound(1000, 5e-4) == pytest.approx(-ndtri(2.5e-7))


@pytest.mark.parametrize("n", [2, 52])
@pytest.mark.parametrize("test", [scores.z_mean, scores.z_spread])
def test_scores_of_scores_are_standard_normal(test, n):
    trials = 10_000
    found = np.array([test(row) for row in np.random.default_rng(8).standard_normal((trials, n))])
    for c in (1.0, 2.0, 3.0):
        low, high = five_sigma(2 * ndtr(-c), trials)
        assert low <= (np.abs(found) >= c).sum() <= high


def test_scores_of_scores_say_on_which_side_they_are():
    z = np.random.default_rng(9).standard_normal(52)
    assert scores.z_mean(z + 1) > 5 > -5 > scores.z_mean(z - 1)
    assert scores.z_spread([0.0] * 52) == -math.inf
    # Far out Chernoff's bound e^(a − y) (y/a)^a takes the place of the tails of the law Γ(a), which
    # are y^a e^(−y)/Γ(a + 1) and, above, a/y times that. Stirling's 1/(12 a) is what is left.
    for scale, sign in ((1e3, 1), (1e-30, -1)):
        found, half_chi2 = scores.z_spread(z * scale), scale**2 * (z @ z) / 2
        ends = (0, half_chi2) if sign < 0 else (half_chi2, mpmath.inf)
        due = mpmath.log(mpmath.gammainc(26, *ends, regularized=True))
        due += mpmath.log(2 * mpmath.pi * 26) / 2 + (mpmath.log(half_chi2 / 26) if sign > 0 else 0)
        assert log_ndtr(-sign * found) == pytest.approx(float(due), abs=1.1 / (12 * 26), rel=0)


@pytest.mark.parametrize("size", [5, 40, 300])
def test_the_cluster_bound_knows_the_clusters_that_were_counted(size):
    """Clusters of one size each: as many clusters are as far out, whatever the size."""
    found, due, replicas = 40, 90, 10**5

    def score(size):
        exact = replicas / (due * size)
        return scores.mean_time_z(found * size, found * size**2, replicas, 1.0, exact)

    z, test = score(size)
    assert test == "cluster-bound"
    assert z == pytest.approx(score(4)[0], rel=1e-9)
    half_of_p = (due / found) ** found * math.exp(found - due)
    assert z == pytest.approx(-ndtri(half_of_p), rel=1e-9)
