"""The deviation of an estimate from the exact value as z, and the bounds for many comparisons.

A z-score is always a standard normal deviate. If the law of a test is not normal, the test gives a
two-sided p-value that is never too small, and z is the deviate with this p-value. Positive z means
that the estimate is above the exact value.
"""

import math

import scipy  # which imports ``special`` when it is used, because that takes long

from twodiscs.points.estimates import CLUSTER_ALLOWANCE, is_enough

#: Fewer expected (or effective) events than this are not tested with a normal law. Rare counts have
#: skewness 1/√n: at five errors, n = 1000 doubles one tail and n = 100 multiplies it by eight.
NORMAL_EVENTS = 1000

#: Probability that a check of one scene fails although everything is right.
FALSE_ALARM = 1e-3


def two_sided_p(z):
    """Return the probability that the absolute value of a standard normal deviate is ≥ |z|."""
    return float(2 * scipy.special.ndtr(-abs(z)))


def _deviate(log_p):
    """Return |z| of a two-sided p-value, given its logarithm; finite far beyond p = 1e-308."""
    return float(-scipy.special.ndtri_exp(log_p - math.log(2))) if log_p < 0 else 0.0


def _signed(size, sign):
    """Return ``size`` with the sign of ``sign``, but no negative zero."""
    return math.copysign(size, sign) if size else 0.0


def _doubled(low, high, log_bound):
    """Return |z| for twice the smaller tail; if it underflows, ``log_bound`` takes its place."""
    tail = float(min(low, high))
    return _deviate(math.log(2) + (math.log(tail) if tail > 1e-290 else log_bound))


def _entropy(x, mean):
    """Return x ln(x/mean) − x + mean, minus the exponent of Chernoff's bound for a Poisson law."""
    return (x * math.log(x / mean) if x else 0.0) - x + mean


def student_deviate(t, degrees):
    """Return the normal deviate with the same tail probability as ``t`` of Student's law.

    Wallace, Ann. Math. Stat. 30, 1121 (1959): within 1e-3 for |t| ≤ 8 and degrees ≥ 99, and free of
    underflow. The sign is that of ``t``; ``degrees`` ≥ 1.
    """
    size = math.sqrt(degrees * math.log1p(t * t / degrees))
    return math.copysign(size * (8 * degrees + 1) / (8 * degrees + 3), t)


def binomial_z(hits, samples, probability):
    """Return (z, test) of ``hits`` against the exact ``probability`` of one.

    ``test`` is "normal" if at least 1000 hits and 1000 misses are expected, with the variance of
    the exact probability. It is "certain" for a probability of 0 or 1: z is 0 or infinite. It is
    otherwise "exact-tail", twice the smaller tail of the binomial law. Twice a tail, unlike a
    mid-p, never rejects more often than p says. Many tests together then have no more false alarms
    than stated. The price is that z is discrete and narrower than normal. If the tail underflows,
    Chernoff's bound takes its place. ``probability`` is in [0, 1].
    """
    p = probability
    if p in (0.0, 1.0):
        return _signed(0.0 if hits == p * samples else math.inf, 0.5 - p), "certain"
    misses, expected, expected_misses = samples - hits, samples * p, samples * (1 - p)
    if min(expected, expected_misses) >= NORMAL_EVENTS:
        return (hits - expected) / math.sqrt(expected * (1 - p)), "normal"
    low = scipy.special.betainc(misses, hits + 1, 1 - p) if misses else 1.0
    high = scipy.special.betainc(hits, misses + 1, p) if hits else 1.0
    bound = -_entropy(hits, expected) - _entropy(misses, expected_misses)
    return _signed(_doubled(low, high, bound), hits - expected), "exact-tail"


def shells_z(hits, both, samples, measures, probabilities):
    """Return (z, test) of Σ_i measure_i · hits_i/samples over two sets that overlap.

    ``hits``, ``measures`` and ``probabilities`` are pairs, as for ``binomial_z``; ``both`` is the
    number of samples in both sets: it replaces their joint probability, which is not known.
    ``test`` is "normal" if both parts are, "certain" if both are, and otherwise "exact-tail", by
    ``union_z``.
    """
    parts = [binomial_z(h, samples, p) for h, p in zip(hits, probabilities, strict=True)]
    (m1, m2), (p1, p2) = measures, probabilities
    deviation = m1 * (hits[0] / samples - p1) + m2 * (hits[1] / samples - p2)
    if all(test == "normal" for _, test in parts):
        overlap = both / samples - p1 * p2
        variance = m1**2 * p1 * (1 - p1) + m2**2 * p2 * (1 - p2) + 2 * m1 * m2 * overlap
        return deviation / math.sqrt(variance / samples), "normal"
    certain = all(test == "certain" for _, test in parts)
    return union_z([z for z, _ in parts], deviation), "certain" if certain else "exact-tail"


def union_z(parts, sign):
    """Return the deviate of a sum of k parts from Bonferroni's bound, p = k · min p_i.

    It is for a sum whose law is unknown, such as the counts in two shells that overlap, and holds
    for any dependence of the parts. ``parts`` are their deviates, and ``sign`` is any number with
    the sign of the sum's deviation.
    """
    largest = max(abs(z) for z in parts)
    log_p = math.log(2 * len(parts)) + float(scipy.special.log_ndtr(-largest))
    return _signed(_deviate(log_p), sign)


def impossible_z(total):
    """Return (z, test) of the count ``total`` ≥ 0 of an impossible event: one event gives −∞."""
    return (-math.inf if total else 0.0), "certain"


def mean_time_z(total, squares, replicas, duration, exact, mean=None):
    """Return (z, test) of a measured mean time against the ``exact`` one.

    The test is about the count, because ⟨N⟩ = T/τ holds for every T while T/⟨N⟩ is biased. The sign
    is changed, because a positive z means a time that is too long. ``test`` is

    - "normal" with at least 100 replicas and 1000 effective events, as expected from the exact
      time: Student's t of the mean count, as a normal deviate. ``mean``, if given, is a better
      estimate (count, error) than these sums give; the other test does not use it.
    - "cluster-bound" for less: Chernoff's bound for independent replicas, P ≤ exp(−(λ/K) h(n/λ))
      with h(x) = x ln x − x + 1 for n counted and λ expected in all. It holds if no replica has
      more than K events; K is Σ N²/Σ N, and at least 4. A Poisson law (K = 1) would be wrong,
      because hops come in clusters.

    If no exact value is known, ``exact`` is None and both results are None. For an impossible event
    call ``impossible_z`` instead.
    """
    if exact is None:
        return None, None
    expected = duration / exact
    if is_enough(total, squares, replicas, expected, NORMAL_EVENTS):
        error = math.sqrt((replicas * squares - total**2) / (replicas - 1)) / replicas
        count, error = mean or (total / replicas, error)
        return student_deviate((expected - count) / error, replicas - 1), "normal"
    cluster = max(CLUSTER_ALLOWANCE, squares / total) if total else CLUSTER_ALLOWANCE
    exponent = _entropy(total / cluster, expected * replicas / cluster)
    size = _deviate(math.log(2) - exponent)
    return _signed(size, expected * replicas - total), "cluster-bound"


def bonferroni_bound(comparisons, alarm):
    """Return the |z| that one of ``comparisons`` exceeds randomly with probability ≤ ``alarm``."""
    return float(-scipy.special.ndtri(alarm / (2 * comparisons)))


def z_mean(z):
    """Return √n times the mean of n scores, a standard normal deviate if the scores are.

    It finds a shift that is too small for a single comparison.
    """
    return math.fsum(z) / math.sqrt(len(z))


def z_spread(z):
    """Return the deviate of the χ² of n scores, positive when they spread too widely.

    The χ² law of n degrees is exact for every n; p is twice the smaller tail. It finds errors that
    are too small, and errors that are too large, which no single comparison can. All zeros: −∞.
    """
    half, half_chi2 = len(z) / 2, math.fsum(score * score for score in z) / 2
    low, high = scipy.special.gammainc(half, half_chi2), scipy.special.gammaincc(half, half_chi2)
    bound = -_entropy(half, half_chi2) if half_chi2 else -math.inf
    return _signed(_doubled(low, high, bound), low - high)
