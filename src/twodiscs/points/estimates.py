"""Estimates with standard errors from counts and samples.

Sums over replicas and samples are integers; variances are computed from them before any rounding.

Strata. Initial states are sorted by quantities whose law is exact, into strata of exact probability
p. Then Σ p ⟨N⟩ with the mean of N in each stratum has a smaller variance than the mean over all of
them. The random numbers of states in the strata matter only to second order (Cochran, Sampling
Techniques, 1977, section 5A.9). The initial states are still independent, from the invariant
measure.
"""

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from itertools import chain, combinations, combinations_with_replacement

import numpy as np

from twodiscs.model.checks import check_fraction
from twodiscs.model.events import EVENTS
from twodiscs.model.formats import texts_with_error
from twodiscs.theory.plain import ARC_RULE

#: The least number of independent events, and of replicas, for an error bar. At 100 the error
#: itself is known to some 10 %, and ± 1.96 errors have a coverage of 93 to 96 %, also for clustered
#: counts.
LEAST_EVENTS = 100

#: The least typical weight of insertions, over the least weight whose square is not rounded to 0.
RESOLVED_WEIGHT = 8

#: Allowance for clusters of rare events: the largest mean number of events in a replica with any. A
#: hop through a narrow gap may be undone soon: just below the thresholds of boxes from 1 × 1 to
#: 3 × 1, replicas of length 10 and 50 gave Σ N²/Σ N between 1.0 and 1.8.
CLUSTER_ALLOWANCE = 4


@dataclass(frozen=True)
class Estimate:
    """A value, its standard error, and the number of independent samples.

    The error is None if too few events are known for one.
    """

    value: float
    stderr: float | None
    n: int

    def __str__(self) -> str:
        value, error = texts_with_error(self.value, self.stderr)
        return f"{value} ± {error}" if error else f"{value}, too few events for an error"

    @property
    def relative_stderr(self) -> float | None:
        """The standard error over the size of the value; infinite if the value is zero."""
        if self.stderr is None:
            return None
        return self.stderr / abs(self.value) if self.value else math.inf

    def interval(self, confidence: float = 0.95) -> tuple[float, float] | None:
        """Return the normal confidence interval (low, high), None without an error."""
        half = normal_quantile(confidence)
        if self.stderr is None:
            return None
        return self.value - half * self.stderr, self.value + half * self.stderr


def normal_quantile(confidence):
    """Return the half-width, in standard errors, of a two-sided normal interval; 0 < level < 1."""
    from scipy.special import ndtri  # a slow import, and few jobs need it

    return float(-ndtri((1 - check_fraction("confidence", confidence)) / 2))


def why_no_error(number, what):
    """Return why an estimate has no error bar, such as "37 of the 100 hits", None if it has one.

    The ``number`` of independent events, such as hits or replicas (``what``), must be
    ``LEAST_EVENTS`` or more.
    """
    if number < LEAST_EVENTS:
        return f"{number:.3g} of the {LEAST_EVENTS} {what} that an error needs"
    return None


def combination(weights, totals, products, n):
    """Return Σ_a w_a ⟨N_a⟩ with its error, from sums over n independent samples.

    ``weights`` and ``totals`` map names to w_a and Σ N_a; ``products`` maps "a*b" to Σ N_a N_b for
    every pair of names, in the order of ``weights``, including squares. The variance is that of the
    combination in each sample, so it includes correlations and cancellations between the terms. It
    is exact for the given integers.
    """
    w = {name: Fraction(weight) for name, weight in weights.items()}
    mean = sum(w[a] * totals[a] for a in w) / n
    spread = sum(
        (1 if a == b else 2) * w[a] * w[b] * (n * products[f"{a}*{b}"] - totals[a] * totals[b])
        for a, b in combinations_with_replacement(w, 2)
    )
    return Estimate(float(mean), math.sqrt(spread / (n * n * (n - 1))), n)


# Monte Carlo ----------------------------------------------------------------------------------


def binomial_estimate(hits, samples, measure):
    """Return measure · hits/samples with its binomial error, or ``None`` without a hit.

    ``measure`` > 0 is the value if every sample is a hit.
    """
    if not hits:
        return None
    fraction = hits / samples
    error = math.sqrt(fraction * ((samples - hits) / samples) / samples)
    return Estimate(measure * fraction, measure * error, samples)


def weighted_estimate(total, squares, unit, samples, measure):
    """Return (``measure`` × ⟨w⟩ as an ``Estimate`` or ``None``, effective number of samples).

    ``total`` is Σ w and ``squares`` Σ w² over a number of ``samples``, both in ``unit``, as in
    points of insertions. The effective number is (Σ w)²/Σ w², the number of samples of equal weight
    with the same precision, if few have a weight. It is 0 if the squares are too few units for an
    error. The estimate is None if all weights are 0.
    """
    if not total:
        return None, 0.0
    mean, second = total / (unit * samples), squares / (unit * samples)
    error = math.sqrt(max(second - mean**2, 0.0) / samples)
    resolved = squares * math.sqrt(unit) >= RESOLVED_WEIGHT * total
    effective = total**2 / (squares * unit) if resolved else 0.0
    return Estimate(measure * mean, measure * error, samples), effective


def effective_misses(total, squares, unit, samples):
    """Return the number of samples of weight 0 that would cause the same spread.

    Arguments are those of ``weighted_estimate``. Squares are known to one ``unit``, which limits
    the number.
    """
    spread = 1 - total**2 / (squares * unit * samples) if squares else 0.0
    return max(0.0, spread) * min(unit, samples)


# Molecular dynamics ---------------------------------------------------------------------------


def effective_count(total, squares, replicas):
    """Return (mean/error)² of the mean count: independent events of this number are as precise.

    ``total`` = Σ N and ``squares`` = Σ N² over ``replicas``. It is zero if the replicas have no
    spread, because the error is then not known.
    """
    spread = replicas * squares - total**2
    return total**2 * (replicas - 1) / spread if spread else 0.0


def relative_variance(count):
    """Return the largest variance to expect of a replica's count over its mean ``count`` squared.

    Random counts have a variance of less than 2⟨N⟩; discs that keep their motion for long add a
    fraction of ⟨N⟩². It is infinite if none is expected. Both numbers hold at all radii of the
    repository's boxes without effects. The fraction is up to 0.16 there, at a hundredth of the
    height and close to the largest radius.
    """
    return 2 / count + 1 / 6 if count else math.inf


def is_enough(total, squares, replicas, expected=None, least=LEAST_EVENTS):
    """Return whether there are 100 replicas and the effective events of an error bar, or ``least``.

    If the ``expected`` count of a replica is known, it decides, not the counts: otherwise runs with
    more events than expected would be judged by another law than those with fewer. Clusters that
    nobody foresaw are seen in the counts: they have far fewer effective events than expected.
    """
    effective = effective_count(total, squares, replicas)
    if why_no_error(replicas, "replicas"):
        return False
    if expected is None:
        return effective >= least
    return (
        replicas >= least * relative_variance(expected) and effective >= least / CLUSTER_ALLOWANCE
    )


def mean_time(total, squares, replicas, duration, mean=None):
    """Return the mean time T/⟨N⟩ as an ``Estimate``, ``None`` if nothing was counted.

    ``total`` and ``squares`` are Σ N and Σ N² over the replicas that can have the event, each of
    length ``duration`` = T. By the delta method the time and the mean count have the same relative
    error. ``mean``, if given, is a better estimate (count, error) than these sums. The caller shows
    the error only if ``is_enough`` is true.
    """
    if not total:
        return None
    if mean is not None:
        time, relative = duration / mean[0], mean[1] / mean[0]
        return Estimate(time, time * relative, replicas)
    time = duration * replicas / total
    relative = math.sqrt((replicas * squares - total**2) / (total**2 * (replicas - 1)))
    return Estimate(time, time * relative, replicas)


def mean_time_bound(replicas, duration):
    """Return the lower bound on the mean time at 95 % if ``replicas`` had no event in ``duration``.

    If a replica with any event has at most K on average, it has one with a probability q of at
    least (T/τ)/K. Then P(none) = (1 − q)^R ≤ exp(−RT/(Kτ)), which is 5 % at τ = RT/(K ln 20). K is
    4, as in the tests. The familiar RT/3 has K = 1, and is too large if events come in clusters.
    """
    return duration * replicas / (CLUSTER_ALLOWANCE * -math.log1p(-0.95))


def sums_of_others(counts, products=None, replicas=None):
    """Return the set of events whose number is the sum of the numbers of others.

    ``counts`` and ``products`` are Σ N_a and Σ N_a N_b by event. The difference must be zero in
    every replica, that is, have mean and variance 0; without ``products`` the sums over all
    replicas decide. The last of the related events in the order of ``EVENTS`` is named: any_wall,
    if right_wall and top_wall count all hits that are equal by symmetry.
    """
    derived = set()
    for event in reversed(EVENTS):
        rest = [e for e in EVENTS if e != event and e not in derived and counts.get(e)]
        terms = chain.from_iterable(combinations(rest, n) for n in range(1, len(rest) + 1))
        for addends in terms if counts.get(event) else ():
            if sum(counts[e] for e in addends) == counts[event]:
                weights = {e: -1 if e in addends else 1 for e in EVENTS if e in (*addends, event)}
                if not products or combination(weights, counts, products, replicas).stderr == 0:
                    derived.add(event)
    return derived


def density_of_chains_at_zero(densities, errors, linear=False):
    """Return (density at 0, its error), from p(0) − a t² through the first two equal bins from 0.

    ``densities`` of the two bins have ``errors``, from the spread between chains of intervals for
    example, which are taken as uncorrelated. A linear term does not exist for two discs: discs that
    touch right after a hop are side by side. They exchange velocities along x, which does not
    change the time of the hop back. If ``linear``, the line through the two bins is straight.
    """
    (first, second), (error, other) = densities, errors
    if linear:
        return (3 * first - second) / 2, math.hypot(3 * error, other) / 2
    return (7 * first - second) / 6, math.hypot(7 * error, other) / 6


# Strata -------------------------------------------------------------------------------------------


#: The number of strata of each quantity.
MOST_STRATA = 8

#: The fastest initial states are one stratum, of at least this probability.
LEAST_STRATUM = 1 / 64

#: If the smallest stratum expects fewer initial states than this, neighbours are merged.
FEWEST_STATES = 16


def fraction_below(cosine, components):
    """Return the fraction of directions with a component between −``cosine`` and ``cosine``.

    Directions are uniform on the unit sphere in ``components`` ≥ 2 dimensions; 0 ≤ cosine ≤ 1.
    The component is sin t with density ∝ cosⁿ⁻² t.
    """

    def integral(end):
        return end * math.fsum(
            weight * math.cos(end * t) ** (components - 2) for t, _, weight in ARC_RULE
        )

    return integral(math.asin(cosine)) / integral(math.pi / 2)


@cache
def fractions_of_speeds(components):
    """Return the fractions of directions by the size of one component: up to 1/8, 2/8 and so on.

    The last ones are merged into a fraction of at least ``LEAST_STRATUM``.
    """
    below = [fraction_below(part / MOST_STRATA, components) for part in range(MOST_STRATA)]
    below = [share for share in below if share <= 1 - LEAST_STRATUM]
    return tuple(np.diff([*below, 1.0]))


def _merged(sums):
    """Return ``sums`` (n, m) with neighbouring strata merged in pairs; an odd last one stays."""
    for axis, size in enumerate(sums.shape):
        sums = np.add.reduceat(sums, np.arange(0, size, 2), axis=axis)
    return sums


def stratified_mean(shares, starts, counts, squares):
    """Return the mean of N and its standard error from strata.

    Arguments are arrays (n, m): their exact ``shares``, which add up to 1, the numbers of initial
    states in ``starts``, Σ N and Σ N². The merging of strata depends only on the number of all
    initial states, so the mean has no bias. An exception is the rare case of a stratum with fewer
    than two of them. The error is infinite for a single initial state.
    """
    strata = [np.array(part, float) for part in (shares, starts, counts, squares)]
    expected = strata[1].sum() * strata[0]
    while strata[0].size > 1 and (expected.min() < FEWEST_STATES or strata[1].min() < 2):
        *strata, expected = [_merged(part) for part in (*strata, expected)]
    shares, starts, counts, squares = strata
    means = counts / starts
    if starts.min() < 2:
        return float(means[0, 0]), math.inf
    variances = np.maximum(squares / starts - means**2, 0.0) / (starts - 1)
    return float(np.sum(shares * means)), math.sqrt(np.sum(shares**2 * variances))
