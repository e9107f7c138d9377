"""Estimates, errors and deviates: against enumeration, mpmath, numpy and seeded simulation."""

import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from scipy.special import ndtr, ndtri, stdtr

from twodiscs.comparison import estimates, scores
from twodiscs.comparison.estimates import Estimate
from twodiscs.model.scene import Scene

DEVIATES = (1.0, 2.0, 3.0, 4.0, 5.0)


def five_sigma(probability, trials):
    """Return the interval of counts that a binomial law leaves once in two million times."""
    width = 5 * math.sqrt(trials * probability * (1 - probability))
    return trials * probability - width, trials * probability + width


# Estimates ------------------------------------------------------------------------------------


def test_estimate_gives_its_interval():
    estimate = Estimate(2.0, 0.5, 10)
    low, high = estimate.interval(0.95)
    assert (low, high) == pytest.approx((2 - 0.98, 2 + 0.98), abs=1e-4)
    assert estimate.covers(2.9)
    assert not estimate.covers(3.0)
    assert estimate.relative_stderr == 0.25
    assert Estimate(0.0, 0.5, 10).relative_stderr == math.inf


def test_coverage_of_normal_estimates_is_the_confidence():
    rng = np.random.default_rng(1)
    estimates = [Estimate(value, 2.0, 9) for value in 3 + 2 * rng.standard_normal(1600)]
    for confidence in (0.5, 0.95):
        low, high = five_sigma(confidence, 1600)
        assert low <= 1600 * estimates.coverage(estimates, 3.0, confidence) <= high


def test_combination_agrees_with_the_replicas_themselves():
    rng = np.random.default_rng(2)
    n = 500
    a = rng.poisson(40, n)
    b = a // 2 + rng.poisson(20, n)
    c = rng.poisson(7, n)
    counts = {"a": a, "b": b, "c": c}
    weights = {"a": -1.5, "b": 2.0, "c": 0.25}
    totals = {x: int(counts[x].sum()) for x in counts}
    products = {f"{x}*{y}": int((counts[x] * counts[y]).sum()) for x in counts for y in counts}
    sample = sum(weights[x] * counts[x] for x in counts)
    found = estimates.combination(weights, totals, products, n)
    assert found.value == pytest.approx(sample.mean(), rel=1e-12)
    assert found.stderr == pytest.approx(sample.std(ddof=1) / math.sqrt(n), rel=1e-12)


def test_combination_keeps_its_digits_where_terms_cancel():
    # b − a is 0, 1 or 2, while the terms are of order 1e9 and their squares of order 1e18.
    rng = np.random.default_rng(3)
    n = 10_000
    a = [int(x) for x in rng.integers(10**6, 2 * 10**6, n)]
    noise = [int(x) for x in rng.integers(0, 3, n)]
    b = [x + y for x, y in zip(a, noise, strict=True)]
    products = {
        "a*a": sum(x * x for x in a),
        "a*b": sum(x * y for x, y in zip(a, b, strict=True)),
        "b*b": sum(y * y for y in b),
    }
    found = estimates.combination({"a": -1e3, "b": 1e3}, {"a": sum(a), "b": sum(b)}, products, n)
    mean = Fraction(sum(noise), n)
    variance = sum((x - mean) ** 2 for x in noise) / (n - 1)
    assert found.value == float(1000 * mean)
    assert found.stderr == pytest.approx(1000 * math.sqrt(variance / n), rel=1e-15)


def test_combination_names_what_is_missing():
    with pytest.raises(ValueError, match=r"'a\*b'"):
        estimates.combination({"a": 1, "b": 1}, {"a": 1, "b": 1}, {"a*a": 1, "b*b": 1}, 10)
    with pytest.raises(ValueError, match="negative"):
        estimates.combination({"a": 1.0}, {"a": 100}, {"a*a": 10}, 10)


# Tails ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("degrees", [99, 511, 10_000])
@pytest.mark.parametrize("t", [0.0, 0.3, -1.0, 2.5, -5.0, 8.0])
def test_student_deviate_has_the_tail_of_students_law(t, degrees):
    z = scores.student_deviate(t, degrees)
    # Wallace's formula is stated to 1e-3; it is better than that.
    assert z == pytest.approx(-math.copysign(ndtri(stdtr(degrees, -abs(t))), -t), abs=1e-3)


def test_student_deviate_does_not_underflow():
    assert 100 < scores.student_deviate(1e6, 1023) < 1e3


@pytest.mark.parametrize(
    ("hits", "samples", "p"),
    [(0, 1000, 1e-3), (3, 10**6, 1e-6), (12, 10**6, 1e-6), (40, 400, 0.2), (995, 1000, 0.99)],
)
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


@pytest.mark.parametrize(("samples", "p"), [(50, 0.3), (400, 0.01), (2000, 0.45), (1500, 0.999)])
def test_exact_tail_never_rejects_more_often_than_it_says(samples, p):
    assert scores.binomial_z(0, samples, p)[1] == "exact-tail"
    k = np.arange(samples + 1)
    log_choose = np.array(
        [math.lgamma(samples + 1) - math.lgamma(i + 1) - math.lgamma(samples - i + 1) for i in k]
    )
    law = np.exp(log_choose + k * math.log(p) + (samples - k) * math.log1p(-p))
    size = np.abs([scores.binomial_z(int(i), samples, p)[0] for i in k])
    for c in DEVIATES:
        assert law[size >= c].sum() <= 2 * ndtr(-c) * (1 + 1e-9)


def test_binomial_z_is_normal_where_hits_and_misses_are_many():
    z, test = scores.binomial_z(10_400, 10**6, 0.01)
    assert test == "normal"
    assert z == pytest.approx(400 / math.sqrt(1e4 * 0.99), rel=1e-12)
    assert scores.binomial_z(10**6 - 10_400, 10**6, 0.99)[0] == pytest.approx(-z, rel=1e-9)
    assert scores.binomial_z(5, 10**6, 0.000_999)[1] == "exact-tail"
    assert scores.binomial_z(5, 10**6, 0.999_001)[1] == "exact-tail"


def test_binomial_z_stays_finite_far_beyond_the_smallest_double():
    for hits, p in ((900, 1e-9), (10**8, 1e-9), (10**8 - 900, 1 - 1e-9)):
        z, test = scores.binomial_z(hits, 10**8, p)
        assert test == "exact-tail"
        assert math.isfinite(z)
        assert abs(z) > 38
    # Where Chernoff's bound takes over from the exact tail, z falls back a little, not more.
    scores = [scores.binomial_z(hits, 10**6, 1e-4)[0] for hits in range(600, 700)]
    assert scores[0] < 34 < 38 < scores[-1]
    assert (np.abs(np.diff(scores) - 0.05) < 0.15).all()


def test_a_probability_of_zero_or_one_leaves_nothing_to_chance():
    assert scores.binomial_z(0, 100, 0.0) == (0.0, "certain")
    assert scores.binomial_z(1, 100, 0.0) == (math.inf, "certain")
    assert scores.binomial_z(100, 100, 1.0)[0] == 0
    assert scores.binomial_z(99, 100, 1.0) == (-math.inf, "certain")


def test_binomial_estimate():
    assert estimates.binomial_estimate(0, 100, 2.0) is None
    found = estimates.binomial_estimate(25, 100, 2.0)
    assert (found.value, found.n) == (0.5, 100)
    assert found.stderr == pytest.approx(2 * math.sqrt(0.25 * 0.75 / 100))


def test_two_shells_that_overlap_have_a_normal_sum():
    rng = np.random.default_rng(4)
    samples, trials = 10**6, 2000
    measures, both = (3.0, 5.0), 0.01
    only = (0.02, 0.005)
    counts = rng.multinomial(samples, [both, *only, 1 - both - sum(only)], trials)
    scores = [
        scores.shells_z(
            (int(n + a), int(n + b)), int(n), samples, measures, (both + only[0], both + only[1])
        )
        for n, a, b, _ in counts
    ]
    assert {test for _, test in scores} == {"normal"}
    z = [score for score, _ in scores]
    assert abs(scores.z_mean(z)) < 5
    assert abs(scores.z_spread(z)) < 5


def test_union_never_rejects_more_often_than_it_says():
    rng = np.random.default_rng(5)
    first, noise = rng.standard_normal((2, 20_000))
    for correlation in (-1.0, 0.0, 0.7):
        second = correlation * first + math.sqrt(1 - correlation**2) * noise
        size = np.abs([scores.union_z(pair, 1) for pair in zip(first, second, strict=True)])
        for c in (1.0, 2.0, 3.0):
            assert (size >= c).sum() <= five_sigma(2 * ndtr(-c), size.size)[1]
    assert scores.union_z([0.1, -0.2], -1) == 0
    assert scores.union_z([60.0, 1.0], -3) == pytest.approx(-60, abs=0.1)
    assert scores.union_z([math.inf, 1.0], 1) == math.inf


# Mean times -----------------------------------------------------------------------------------


def moments(counts):
    return int(counts.sum()), int((counts**2).sum()), len(counts)


def test_mean_time_agrees_with_the_replicas_themselves():
    counts = np.random.default_rng(6).poisson(30, 400)
    found = estimates.mean_time(*moments(counts), 60.0)
    relative = counts.std(ddof=1) / math.sqrt(400) / counts.mean()
    assert found.value == pytest.approx(60 / counts.mean(), rel=1e-14)
    assert found.relative_stderr == pytest.approx(relative, rel=1e-12)
    assert estimates.effective_count(*moments(counts)) == pytest.approx(relative**-2, rel=1e-12)
    z, test = scores.mean_time_z(*moments(counts), 60.0, 60 / 30.5)
    t = (30.5 - counts.mean()) / (counts.std(ddof=1) / math.sqrt(400))
    assert test == "normal"
    assert z == pytest.approx(scores.student_deviate(t, 399), rel=1e-12)
    assert z > 0 or counts.mean() > 30.5


def test_no_event_and_no_spread_divide_by_nothing():
    assert estimates.mean_time(0, 0, 1000, 10.0) is None
    assert estimates.effective_count(0, 0, 1000) == 0
    assert estimates.effective_count(3000, 9000, 1000) == 0
    assert not estimates.is_honest(3000, 9000, 1000)
    z, test = scores.mean_time_z(0, 0, 1000, 10.0, 1e6)
    assert test == "cluster-bound"
    assert 0 <= z < 1
    assert scores.mean_time_z(0, 0, 1000, 10.0, 1.0)[0] > 50
    assert math.isfinite(scores.mean_time_z(10**9, 10**15, 1000, 10.0, 1e9)[0])


def test_an_impossible_event_must_not_be_seen():
    assert scores.mean_time_z(0, 0, 10, 1.0, None) == (0.0, "certain")
    assert scores.mean_time_z(1, 1, 10, 1.0, None) == (-math.inf, "certain")


def law_of_total(replica_law, replicas):
    """Return the law of the sum over independent replicas, by repeated convolution."""
    law = np.ones(1)
    for _ in range(replicas):
        law = np.convolve(law, replica_law)
    return law


@pytest.mark.parametrize("sizes", [{1: 1.0}, {1: 0.6, 2: 0.3, 3: 0.1}, {4: 1.0}, {1: 0.5, 4: 0.5}])
@pytest.mark.parametrize("seen", [0.003, 0.05])
def test_cluster_bound_never_rejects_more_often_than_it_says(sizes, seen):
    replicas = 300
    law = np.zeros(5)
    law[0] = 1 - seen
    for size, share in sizes.items():
        law[size] = seen * share
    total = law_of_total(law, replicas)
    exact = 1 / float(law @ np.arange(5))
    # Σ N² = Σ N makes the allowance its smallest, K = 4. Totals of 200 and more count as rejected.
    scores = [scores.mean_time_z(n, n, replicas, 1.0, exact) for n in range(200)]
    assert {test for _, test in scores} == {"cluster-bound"}
    size = np.abs([z for z, _ in scores])
    for c in DEVIATES:
        assert total[:200][size >= c].sum() + total[200:].sum() <= 2 * ndtr(-c)


def test_bound_from_no_event_holds_for_clusters():
    replicas, duration = 400, 7.0
    bound = estimates.mean_time_bound(replicas, duration)
    for cluster in (1, 2, 4):
        seen = duration / bound / cluster
        assert (1 - seen) ** replicas <= 0.05 + 1e-12
    assert (1 - duration / bound / 4) ** replicas == pytest.approx(0.05, rel=0.02)
    assert estimates.mean_time_bound(replicas, duration, 0.99) < bound


@pytest.mark.parametrize("effective", [130, 1000])
def test_the_interval_of_clustered_counts_covers_as_it_says(effective):
    # Clusters of geometric size (mean 1.5) in few of many replicas, as hops near a threshold.
    rng = np.random.default_rng(7)
    replicas, repetitions, tail = 2000, 1600, 1 / 3
    dispersion = (1 + tail) / (1 - tail)
    mean = effective * dispersion / replicas
    clusters = rng.poisson(mean * (1 - tail), (repetitions, replicas))
    counts = clusters + rng.negative_binomial(np.maximum(clusters, 1), 1 - tail) * (clusters > 0)
    estimates, scores = [], []
    for row in counts:
        sums = moments(row)
        estimates.append(estimates.mean_time(*sums, 5.0))
        scores.append(scores.mean_time_z(*sums, 5.0, 5.0 / mean)[0])
    assert 0.92 <= estimates.coverage(estimates, 5.0 / mean) <= 0.98
    assert np.mean(np.abs(scores) > estimates.normal_quantile(0.95)) <= 0.08


def exact_rates(width, height, radius):
    """Return the rates of the sum rule's events where both hops are open, in 40 digits."""
    with mpmath.workdps(40):
        w, h, r = (mpmath.mpf(x) for x in (width, height, radius))
        a, b = w / 2 - r, h / 2 - r
        pi = mpmath.pi
        volume = 16 * a**2 * b**2 - 16 * pi * a * b * r**2 + 64 * (a + b) * r**3 / 3 - 8 * r**4
        areas = {
            "disc_collision": 16 * mpmath.sqrt(2) * r * (pi * a * b - 2 * (a + b) * r + r**2),
            "right_wall": 8 * a * b**2 - 4 * pi * b * r**2 + 16 * r**3 / 3,
            "top_wall": 8 * a**2 * b - 4 * pi * a * r**2 + 16 * r**3 / 3,
        }
        return {event: area / volume * 2 / (3 * pi) for event, area in areas.items()}


@pytest.mark.parametrize("radius", [0.01, 0.1, 0.2, 0.24])
def test_sum_rule_holds_for_the_exact_rates(radius):
    replicas = 10**9
    counts = {e: int(mpmath.nint(x * replicas)) for e, x in exact_rates(1.5, 1, radius).items()}
    # No two events in one replica: only the squares are not zero.
    products = {f"{x}*{y}": counts[x] * (x == y) for x in counts for y in counts}
    found = estimates.sum_rule(Scene(1.5, 1.0, radius), 1.0, replicas, counts, products)
    assert found.value == pytest.approx(1, abs=1e-8)  # counts are rounded to some 1e-9
    scale = 3 * math.pi / 4
    weights = {"disc_collision": scale * 2 * radius / math.sqrt(8)}
    weights |= {"right_wall": scale * (1.5 - 2 * radius), "top_wall": scale * (1 - 2 * radius)}
    second = sum(weights[e] ** 2 * counts[e] for e in counts) / replicas
    assert found.stderr == pytest.approx(math.sqrt((second - 1) / replicas), rel=1e-7)


# Many comparisons -----------------------------------------------------------------------------


def test_bonferroni_bound():
    assert scores.bonferroni_bound(1, 0.05) == pytest.approx(1.959964, abs=1e-6)
    assert scores.bonferroni_bound(1000, 5e-4) == pytest.approx(-ndtri(2.5e-7))


@pytest.mark.parametrize("n", [2, 5, 52])
@pytest.mark.parametrize("test", [scores.z_mean, scores.z_spread])
def test_scores_of_scores_are_standard_normal(test, n):
    rng = np.random.default_rng(8)
    trials = 10_000
    found = np.array([test(row) for row in rng.standard_normal((trials, n))])
    for c in (1.0, 2.0, 3.0):
        low, high = five_sigma(2 * ndtr(-c), trials)
        assert low <= (np.abs(found) >= c).sum() <= high


def test_scores_of_scores_see_shift_and_spread():
    z = np.random.default_rng(9).standard_normal(52)
    assert abs(scores.z_mean(z)) < 4
    assert scores.z_mean(z + 1) > 5
    assert scores.z_mean(z - 1) < -5
    assert abs(scores.z_spread(z)) < 4
    assert scores.z_spread(2 * z) > 5
    assert scores.z_spread(z / 3) < -5
    assert scores.z_spread(z * 1e3) > 100
    assert math.isfinite(scores.z_spread(z * 1e3))
    assert scores.z_spread([0.0] * 52) == -math.inf


# Mistakes -------------------------------------------------------------------------------------

WRONG_NUMBERS = [math.nan, math.inf, -1.0, "1", None, True]


@pytest.mark.parametrize("wrong", WRONG_NUMBERS)
@pytest.mark.parametrize(
    ("name", "call"),
    [
        ("stderr", lambda x: Estimate(1.0, x, 1)),
        ("confidence", lambda x: estimates.normal_quantile(x)),
        ("measure", lambda x: estimates.binomial_estimate(1, 2, x)),
        ("probability", lambda x: scores.binomial_z(1, 2, x)),
        ("duration", lambda x: estimates.mean_time(1, 1, 5, x)),
        ("duration", lambda x: scores.mean_time_z(1, 1, 5, x, 1.0)),
        ("duration", lambda x: estimates.mean_time_bound(5, x)),
        ("duration", lambda x: estimates.sum_rule(Scene(1, 1, 0.1), x, 5, {}, {})),
        ("alarm", lambda x: scores.bonferroni_bound(5, x)),
    ],
)
def test_wrong_numbers_are_named(name, call, wrong):
    with pytest.raises(ValueError, match=name):
        call(wrong)


@pytest.mark.parametrize("wrong", [math.nan, math.inf, -1, 1.5, "1", None, True])
@pytest.mark.parametrize(
    ("name", "call"),
    [
        ("n", lambda x: Estimate(1.0, 1.0, x)),
        ("hits", lambda x: scores.binomial_z(x, 20, 0.5)),
        ("samples", lambda x: estimates.binomial_estimate(0, x, 1.0)),
        ("total", lambda x: estimates.mean_time(x, 1, 5, 1.0)),
        ("squares", lambda x: estimates.effective_count(1, x, 5)),
        ("replicas", lambda x: estimates.mean_time(1, 1, x, 1.0)),
        ("replicas", lambda x: estimates.mean_time_bound(x, 1.0)),
        ("degrees", lambda x: scores.student_deviate(1.0, x)),
        ("comparisons", lambda x: scores.bonferroni_bound(x)),
    ],
)
def test_wrong_integers_are_named(name, call, wrong):
    with pytest.raises(ValueError, match=name):
        call(wrong)


def test_sums_must_be_possible():
    with pytest.raises(ValueError, match="hits must not exceed"):
        scores.binomial_z(3, 2, 0.5)
    with pytest.raises(ValueError, match="squares"):
        estimates.mean_time(10, 9, 5, 1.0)
    with pytest.raises(ValueError, match="squares"):
        estimates.mean_time(10, 19, 5, 1.0)
    with pytest.raises(ValueError, match="exact"):
        scores.mean_time_z(1, 1, 5, 1.0, 0.0)
    for empty in (scores.z_mean, scores.z_spread):
        with pytest.raises(ValueError, match="z must not be empty"):
            empty([])
        with pytest.raises(ValueError, match="z must be"):
            empty([1.0, math.nan])
    with pytest.raises(ValueError, match="estimates"):
        estimates.coverage([], 1.0)
