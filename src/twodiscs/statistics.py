"""From counts to estimates, errors and z-scores.

Sums over replicas and samples are integers; variances are taken from them before anything is
rounded. A z-score is always a standard normal deviate: a test whose own law is not normal gives a
two-sided p-value that is never too small, and z is the deviate with that p-value. Positive z means
that the estimate is above the exact value.
"""

import math
from dataclasses import dataclass
from fractions import Fraction

from scipy.special import betainc, gammainc, gammaincc, log_ndtr, ndtr, ndtri, ndtri_exp

from twodiscs.checks import proportion, whole

#: Fewer independent events, or fewer replicas, than this carry no error bar. At 100 the error is
#: itself known to some 10 %, and ± 1.96 errors cover between 93 and 96 % for clustered counts too.
HONEST = 100

#: Fewer expected (or effective) events than this are not tested with a normal law. Rare counts have
#: skewness 1/√n: five errors out, n = 1000 doubles one tail and n = 100 multiplies it by eight.
NORMAL = 1000

#: Allowance for clusters where events are rare: a replica that sees any sees at most so many in the
#: mean. A hop through a narrow gap may be undone soon: just below the thresholds of boxes from
#: 1 × 1 to 3 × 1, replicas of length 10 and 50 gave Σ N²/Σ N between 1.0 and 1.8.
CLUSTER = 4

#: Probability that a check of one scene fails although everything is right.
FALSE_ALARM = 1e-3


def _real(name, value, low=0.0, high=math.inf, *, ends=False):
    """Return ``value`` as a float inside (low, high), or inside [low, high] if ``ends``."""
    text = f"{name} must be a finite number {'from' if ends else 'between'} {low!r} "
    text += f"{'to' if ends else 'and'} {high!r}, not {value!r}"
    if isinstance(value, bool | str | bytes) or not hasattr(value, "__float__"):
        raise ValueError(text)
    number = float(value)
    inside = low <= number <= high if ends else low < number < high
    if not (inside and math.isfinite(number)):
        raise ValueError(text)
    return number


def _moments(total, squares, replicas):
    """Check Σ N, Σ N² and the number of replicas against each other."""
    total, squares = whole("total", total, 0), whole("squares", squares, 0)
    replicas = whole("replicas", replicas, 1)
    if squares < total or squares * replicas < total**2:
        raise ValueError(
            f"squares must be at least total and total²/replicas, not {squares!r} for total "
            f"{total!r} of {replicas!r} replicas"
        )
    return total, squares, replicas


# Estimates ------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Estimate:
    """A value, its standard error, and the number of independent samples behind both.

    Raises ``ValueError`` unless the value is finite, the error finite and not negative, and n ≥ 1.
    """

    value: float
    stderr: float
    n: int

    def __post_init__(self):
        object.__setattr__(self, "value", _real("value", self.value, low=-math.inf))
        object.__setattr__(self, "stderr", _real("stderr", self.stderr, ends=True))
        object.__setattr__(self, "n", whole("n", self.n, 1))

    @property
    def relative_stderr(self):
        """The standard error over the size of the value; infinite when the value is zero."""
        return self.stderr / abs(self.value) if self.value else math.inf

    def interval(self, confidence=0.95):
        """Return the normal confidence interval (low, high)."""
        half = normal_quantile(confidence) * self.stderr
        return self.value - half, self.value + half

    def covers(self, exact, confidence=0.95):
        """Say whether the confidence interval contains ``exact``."""
        low, high = self.interval(confidence)
        return low <= exact <= high


def normal_quantile(confidence):
    """Return the half-width, in standard errors, of a two-sided normal interval; 0 < level < 1."""
    return float(-ndtri((1 - proportion("confidence", confidence)) / 2))


def coverage(estimates, exact, confidence=0.95):
    """Return the fraction of ``estimates`` whose confidence interval contains ``exact``.

    With honest errors of M independent estimates it is ``confidence`` up to a binomial error,
    √(c(1 − c)/M). Raises ``ValueError`` when there are no estimates.
    """
    covered = [estimate.covers(exact, confidence) for estimate in estimates]
    if not covered:
        raise ValueError("estimates must not be empty")
    return sum(covered) / len(covered)


def combination(weights, totals, products, n):
    """Return Σ_a w_a ⟨N_a⟩ with its error, from sums over n independent samples.

    ``weights`` and ``totals`` map names to w_a and Σ N_a; ``products`` maps "a*b" to Σ N_a N_b for
    every pair of names, written in the order of ``weights``, squares included. The variance is that
    of the combination sample by sample, so that correlations and cancellations between the terms
    are in it; it is exact for the given integers. Raises ``ValueError`` for n < 2, for sums that
    are no integers, and for a sum that is missing.
    """
    n = whole("n", n, 2)
    names = list(weights)
    w = {a: Fraction(_real(f"weight of {a}", weights[a], low=-math.inf)) for a in names}
    try:
        total = {a: whole(f"total of {a}", totals[a], 0) for a in names}
        product = {
            (a, b): whole(f"product {a}*{b}", products[f"{a}*{b}"], 0)
            for i, a in enumerate(names)
            for b in names[i:]
        }
    except KeyError as missing:
        raise ValueError(f"the sums have no {missing.args[0]!r}") from None
    mean = sum(w[a] * total[a] for a in names) / n
    spread = sum(
        (1 if a == b else 2) * w[a] * w[b] * (n * value - total[a] * total[b])
        for (a, b), value in product.items()
    )
    if spread < 0:
        raise ValueError("products must be those of the same samples: their variance is negative")
    return Estimate(float(mean), math.sqrt(spread / (n * n * (n - 1))), n)


# Tails and deviates ---------------------------------------------------------------------------


def two_sided_p(z):
    """Return the probability that a standard normal deviate is at least as far out as ``z``."""
    return float(2 * ndtr(-abs(z)))


def _deviate(log_p):
    """Return |z| of a two-sided p-value, given its logarithm; finite far beyond p = 1e-308."""
    return float(-ndtri_exp(log_p - math.log(2))) if log_p < 0 else 0.0


def _signed(size, sign):
    """Return ``size`` with the sign of ``sign``, but no negative zero."""
    return math.copysign(size, sign) if size else 0.0


def _doubled(low, high, log_bound):
    """Return |z| for the smaller of two tails, doubled; ``log_bound`` serves when it underflows."""
    tail = float(min(low, high))
    return _deviate(math.log(2) + (math.log(tail) if tail > 1e-290 else log_bound))


def _entropy(x, mean):
    """x ln(x/mean) − x + mean: what Chernoff's bound has in the exponent for a Poisson count."""
    return (x * math.log(x / mean) if x else 0.0) - x + mean


def student_deviate(t, degrees):
    """Return the normal deviate as far out as ``t`` is for Student's law, sign kept.

    Wallace, Ann. Math. Stat. 30, 1121 (1959): within 1e-3 for |t| ≤ 8 and degrees ≥ 99, and free of
    underflow. ``degrees`` ≥ 1.
    """
    degrees = whole("degrees", degrees, 1)
    t = _real("t", t, low=-math.inf)
    size = math.sqrt(degrees * math.log1p(t * t / degrees))
    return math.copysign(size * (8 * degrees + 1) / (8 * degrees + 3), t)


# Monte Carlo ----------------------------------------------------------------------------------


def _hits(hits, samples):
    hits, samples = whole("hits", hits, 0), whole("samples", samples, 1)
    if hits > samples:
        raise ValueError(f"hits must not exceed the {samples} samples, not {hits!r}")
    return hits, samples


def binomial_estimate(hits, samples, measure):
    """Return measure · hits/samples with its binomial error, or ``None`` for no hits at all.

    ``measure`` > 0 is the value that every sample being a hit would give.
    """
    hits, samples = _hits(hits, samples)
    measure = _real("measure", measure)
    if not hits:
        return None
    fraction = hits / samples
    error = math.sqrt(fraction * ((samples - hits) / samples) / samples)
    return Estimate(measure * fraction, measure * error, samples)


def binomial_z(hits, samples, probability):
    """Return (z, test) of ``hits`` against the exact ``probability`` of one.

    ``test`` says how: "normal" where at least 1000 hits and 1000 misses are expected, with the
    variance of the exact probability; "exact-tail" otherwise, the smaller tail of the binomial law
    doubled. Doubling, unlike a mid-p, never rejects more often than p says, so the false alarms of
    a family of tests stay below what is stated; the price is that z is discrete and short of
    normal. Where the tail underflows, Chernoff's bound takes its place. "certain" is a probability
    of 0 or 1: z is 0 or infinite. ``probability`` in [0, 1].
    """
    hits, samples = _hits(hits, samples)
    p = _real("probability", probability, high=1.0, ends=True)
    if p in (0.0, 1.0):
        return _signed(0.0 if hits == p * samples else math.inf, 0.5 - p), "certain"
    misses, expected, expected_misses = samples - hits, samples * p, samples * (1 - p)
    if min(expected, expected_misses) >= NORMAL:
        return (hits - expected) / math.sqrt(expected * (1 - p)), "normal"
    low = betainc(misses, hits + 1, 1 - p) if misses else 1.0
    high = betainc(hits, misses + 1, p) if hits else 1.0
    bound = -_entropy(hits, expected) - _entropy(misses, expected_misses)
    return _signed(_doubled(low, high, bound), hits - expected), "exact-tail"


def shells_z(hits, both, samples, measures, probabilities):
    """Return (z, test) of Σ_i measure_i · hits_i/samples over two sets that overlap.

    ``hits``, ``measures`` and ``probabilities`` are pairs, as for ``binomial_z``; ``both`` is the
    number of samples in both sets, which stands in for the one probability that is not known.
    "normal" if both parts are; otherwise "exact-tail", by ``union_z``, or "certain" if both are.
    """
    parts = [binomial_z(h, samples, p) for h, p in zip(hits, probabilities, strict=True)]
    both, _ = _hits(both, samples)
    (m1, m2), (p1, p2) = measures, probabilities
    deviation = m1 * (hits[0] / samples - p1) + m2 * (hits[1] / samples - p2)
    if all(test == "normal" for _, test in parts):
        overlap = both / samples - p1 * p2
        variance = m1**2 * p1 * (1 - p1) + m2**2 * p2 * (1 - p2) + 2 * m1 * m2 * overlap
        return deviation / math.sqrt(variance / samples), "normal"
    certain = all(test == "certain" for _, test in parts)
    return union_z([z for z, _ in parts], deviation), "certain" if certain else "exact-tail"


def union_z(parts, sign):
    """Return the deviate of a sum of parts, tested by its parts: Bonferroni's p = k · min p_i.

    For a sum whose own law is unknown, as that of counts in two shells that overlap; it holds for
    any dependence of the parts. ``parts`` are their deviates, and ``sign`` is any number with the
    sign of the sum's deviation.
    """
    largest = max((abs(z) for z in parts), default=0.0)
    log_p = math.log(2 * max(len(parts), 1)) + float(log_ndtr(-largest))
    return _signed(_deviate(log_p), sign)


# Molecular dynamics ---------------------------------------------------------------------------


def effective_count(total, squares, replicas):
    """Return (mean/error)² of the mean count: how many independent events would be as precise.

    ``total`` = Σ N and ``squares`` = Σ N² over ``replicas``. Zero when the replicas show no spread,
    for then nothing is known about the error.
    """
    total, squares, replicas = _moments(total, squares, replicas)
    spread = replicas * squares - total**2
    return total**2 * (replicas - 1) / spread if spread else 0.0


def is_honest(total, squares, replicas):
    """Say whether the replicas carry an error bar: 100 of them, and 100 effective events."""
    return effective_count(total, squares, replicas) >= HONEST and replicas >= HONEST


def mean_time(total, squares, replicas, duration):
    """Return T/⟨N⟩ with its error by the delta method, or ``None`` when nothing was counted.

    ``total`` and ``squares`` are Σ N and Σ N² over the replicas that can see the event, each of
    length ``duration`` = T. The relative error of the time is that of the mean count. When
    ``is_honest`` says no, the error is not to be shown.
    """
    total, squares, replicas = _moments(total, squares, whole("replicas", replicas, 2))
    duration = _real("duration", duration)
    if not total:
        return None
    time = duration * replicas / total
    relative = math.sqrt((replicas * squares - total**2) / (total**2 * (replicas - 1)))
    return Estimate(time, time * relative, replicas)


def mean_time_z(total, squares, replicas, duration, exact):
    """Return (z, test) of a measured mean time against the ``exact`` one.

    The count is tested, for ⟨N⟩ = T/τ holds for every T while T/⟨N⟩ is biased; the sign is turned,
    so that positive still means a time that is too long. ``test`` is

    - "normal" with at least 100 replicas and 1000 effective events: Student's t of the mean count,
      as a normal deviate.
    - "cluster-bound" below: Chernoff's bound for independent replicas, P ≤ exp(−(λ/K) h(n/λ)) with
      h(x) = x ln x − x + 1 for n counted and λ expected in all. It holds where a replica that sees
      the event sees at most K; K is Σ N²/Σ N, and at least 4. A Poisson law (K = 1) would be false,
      for hops come in clusters.
    - "certain" for an impossible event, ``exact`` = None: any count at all gives −∞.
    """
    total, squares, replicas = _moments(total, squares, replicas)
    duration = _real("duration", duration)
    if exact is None:
        return (-math.inf if total else 0.0), "certain"
    expected = duration / _real("exact", exact)
    if replicas >= HONEST and effective_count(total, squares, replicas) >= NORMAL:
        error = math.sqrt((replicas * squares - total**2) / (replicas - 1)) / replicas
        return student_deviate((expected - total / replicas) / error, replicas - 1), "normal"
    cluster = max(CLUSTER, squares / total) if total else CLUSTER
    exponent = _entropy(total / cluster, expected * replicas / cluster)
    size = _deviate(math.log(2) - exponent)
    return _signed(size, expected * replicas - total), "cluster-bound"


def mean_time_bound(replicas, duration, confidence=0.95):
    """Return the lower bound on the mean time after ``replicas`` saw no event in ``duration``.

    A replica sees the event with a probability q of at least (T/τ)/K when it sees at most K events
    in the mean if any. Then P(none) = (1 − q)^R ≤ exp(−RT/(Kτ)), and this is 1 − ``confidence`` at
    τ = RT/(K ln 1/(1 − confidence)). K = 4, as for the tests; the familiar RT/3 at 95 % is K = 1
    and claims too much where events come in clusters.
    """
    replicas, duration = whole("replicas", replicas, 1), _real("duration", duration)
    confidence = proportion("confidence", confidence)
    return duration * replicas / (CLUSTER * -math.log1p(-confidence))


def sum_rule(scene, duration, replicas, counts, products):
    """Return the estimate of (3π/4)(A/τ_right + B/τ_top) − (3π/(8√2)) σ/τ_coll, which is 1.

    The wall times are those of the whole ensemble: all ``replicas``, whether they can reach the
    wall or not. ``counts`` and ``products`` are Σ N_a and Σ N_a N_b by event; the rule follows from
    4V = 2A·A_right + 2B·A_top − σA_coll/√2.
    """
    scale = 3 * math.pi / (4 * _real("duration", duration))
    weights = {
        "disc_collision": -scale * scene.contact_distance / math.sqrt(8),
        "right_wall": scale * scene.range_x,
        "top_wall": scale * scene.range_y,
    }
    return combination(weights, counts, products, replicas)


# Many comparisons -----------------------------------------------------------------------------


def bonferroni_bound(comparisons, alarm=FALSE_ALARM):
    """Return the |z| that one of ``comparisons`` passes by chance with probability ≤ ``alarm``."""
    comparisons = whole("comparisons", comparisons, 1)
    return float(-ndtri(proportion("alarm", alarm) / (2 * comparisons)))


def _scores(z):
    scores = [_real("z", value, low=-math.inf) for value in z]
    if not scores:
        raise ValueError("z must not be empty")
    return scores


def z_mean(z):
    """Return √n times the mean of n scores: a standard normal deviate if they are n of them.

    It finds what is shifted by less than a single comparison would notice.
    """
    scores = _scores(z)
    return math.fsum(scores) / math.sqrt(len(scores))


def z_spread(z):
    """Return the deviate of the χ² of n scores, positive when they spread too widely.

    The χ² law of n degrees is exact for every n; the smaller tail is doubled. It finds errors that
    are too small, and those that are too large, which no single comparison can. All zeros: −∞.
    """
    scores = _scores(z)
    half, half_chi2 = len(scores) / 2, math.fsum(z * z for z in scores) / 2
    low, high = gammainc(half, half_chi2), gammaincc(half, half_chi2)
    bound = -_entropy(half, half_chi2) if half_chi2 else -math.inf
    return _signed(_doubled(low, high, bound), low - high)
