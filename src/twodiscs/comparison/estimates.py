"""From counts and samples to estimates with honest errors.

Sums over replicas and samples are integers; variances are taken from them before anything is
rounded.
"""

import math
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain, combinations

import numpy as np

from twodiscs.model.checks import InputError, check_fraction, check_integer, check_length
from twodiscs.model.events import DECLARED, EVENTS
from twodiscs.theory import virial
from twodiscs.theory.flux import constant

#: Fewer independent events, or fewer replicas, than this carry no error bar. At 100 the error is
#: itself known to some 10 %, and ± 1.96 errors cover between 93 and 96 % for clustered counts too.
MIN_EVENTS = 100

#: How well an error must itself be known, relatively, where counts may have a heavy tail.
KNOWN = 0.1

#: Weights of insertions are to be so many times the least one whose square is not rounded to 0.
RESOLVED = 8

#: Allowance for clusters where events are rare: a replica that sees any sees at most so many in the
#: mean. A hop through a narrow gap may be undone soon: just below the thresholds of boxes from
#: 1 × 1 to 3 × 1, replicas of length 10 and 50 gave Σ N²/Σ N between 1.0 and 1.8.
CLUSTER = 4


def check_real(name, value, low=0.0, high=math.inf, *, ends=False):
    """Return ``value`` as a float inside (low, high), or inside [low, high] if ``ends``."""
    text = f"{name} must be a finite number {'from' if ends else 'between'} {low!r} "
    text += f"{'to' if ends else 'and'} {high!r}, not {value!r}"
    if isinstance(value, bool | str | bytes) or not hasattr(value, "__float__"):
        raise InputError(text)
    number = float(value)
    inside = low <= number <= high if ends else low < number < high
    if not (inside and math.isfinite(number)):
        raise InputError(text)
    return number


def moments_of(total, squares, replicas):
    """Check Σ N, Σ N² and the number of replicas against each other."""
    total, squares = check_integer("total", total, 0), check_integer("squares", squares, 0)
    replicas = check_integer("replicas", replicas, 1)
    if squares < total or squares * replicas < total**2:
        raise InputError(
            f"squares must be at least total and total²/replicas, not {squares!r} for total "
            f"{total!r} of {replicas!r} replicas"
        )
    return total, squares, replicas


@dataclass(frozen=True)
class Estimate:
    """A value, its standard error, and the number of independent samples behind both.

    Raises ``InputError`` unless the value is finite, the error finite and not negative, and n ≥ 1.
    """

    value: float
    stderr: float
    n: int

    def __post_init__(self):
        object.__setattr__(self, "value", check_real("value", self.value, low=-math.inf))
        object.__setattr__(self, "stderr", check_real("stderr", self.stderr, ends=True))
        object.__setattr__(self, "n", check_integer("n", self.n, 1))

    @property
    def relative_stderr(self) -> float:
        """The standard error over the size of the value; infinite when the value is zero."""
        return self.stderr / abs(self.value) if self.value else math.inf

    def interval(self, confidence: float = 0.95) -> tuple[float, float]:
        """Return the normal confidence interval (low, high)."""
        half = normal_quantile(confidence) * self.stderr
        return self.value - half, self.value + half

    def covers(self, exact: float, confidence: float = 0.95) -> bool:
        """Say whether the confidence interval contains ``exact``."""
        low, high = self.interval(confidence)
        return low <= exact <= high


def normal_quantile(confidence):
    """Return the half-width, in standard errors, of a two-sided normal interval; 0 < level < 1."""
    from scipy.special import ndtri  # takes long, and few jobs need it

    return float(-ndtri((1 - check_fraction("confidence", confidence)) / 2))


def mean_of(values):
    """Return the mean of independent ``values`` as an ``Estimate``, along the first axis of them.

    The error is that of their spread. For values in two dimensions it is a list of estimates, one
    for each column. Raises ``InputError`` for fewer than two values.
    """
    values = np.asarray(values, float)
    n = len(values)
    if n < 2:
        raise InputError(f"values must be at least two, not {n}")
    means, errors = values.mean(axis=0), np.std(values, axis=0, ddof=1) / math.sqrt(n)
    if values.ndim == 1:
        return Estimate(float(means), float(errors), n)
    return [Estimate(float(m), float(e), n) for m, e in zip(means, errors, strict=True)]


class LinearFit:
    """The straight line through values ``y`` over ``x``, by least squares.

    ``errors`` are the standard errors of ``y``, one for all or one for each; without them the
    scatter about the line stands for one error for all. ``slope`` is an ``Estimate``, ``constant``
    the value at x = 0, ``chi2`` the sum of squared residuals in units of the errors (None without
    them). The error of the slope is 0.0 where it is not known: without errors, for two points.
    Raises ``InputError`` for fewer than two points.
    """

    def __init__(self, x, y, errors=None):
        x, y = np.asarray(x, float), np.asarray(y, float)
        if x.size < 2 or x.size != y.size:
            raise InputError(f"x and y must be two points at least, not {x.size} and {y.size}")
        weights = np.broadcast_to(1.0 if errors is None else 1 / np.asarray(errors, float), x.shape)
        (slope, self.constant), covariance = np.polyfit(x, y, 1, w=weights, cov="unscaled")
        residuals = weights * (y - self.constant - slope * x)
        self.chi2 = None if errors is None else float(residuals @ residuals)
        scatter = 1.0
        if errors is None:
            scatter = float(residuals @ residuals) / (x.size - 2) if x.size > 2 else 0.0
        self.slope = Estimate(float(slope), math.sqrt(covariance[0, 0] * scatter), x.size)


def combination(weights, totals, products, n):
    """Return Σ_a w_a ⟨N_a⟩ with its error, from sums over n independent samples.

    ``weights`` and ``totals`` map names to w_a and Σ N_a; ``products`` maps "a*b" to Σ N_a N_b for
    every pair of names, written in the order of ``weights``, squares included. The variance is that
    of the combination sample by sample, so that correlations and cancellations between the terms
    are in it; it is exact for the given integers. Raises ``InputError`` for n < 2, for sums that
    are no integers, and for a sum that is missing.
    """
    n = check_integer("n", n, 2)
    names = list(weights)
    w = {a: Fraction(check_real(f"weight of {a}", weights[a], low=-math.inf)) for a in names}
    try:
        total = {a: check_integer(f"total of {a}", totals[a], 0) for a in names}
        product = {
            (a, b): check_integer(f"product {a}*{b}", products[f"{a}*{b}"], 0)
            for i, a in enumerate(names)
            for b in names[i:]
        }
    except KeyError as missing:
        raise InputError(f"the sums have no {missing.args[0]!r}") from None
    mean = sum(w[a] * total[a] for a in names) / n
    spread = sum(
        (1 if a == b else 2) * w[a] * w[b] * (n * value - total[a] * total[b])
        for (a, b), value in product.items()
    )
    if spread < 0:
        raise InputError("products must be those of the same samples: their variance is negative")
    return Estimate(float(mean), math.sqrt(spread / (n * n * (n - 1))), n)


# Monte Carlo ----------------------------------------------------------------------------------


def checked_hits(hits, samples):
    hits, samples = check_integer("hits", hits, 0), check_integer("samples", samples, 1)
    if hits > samples:
        raise InputError(f"hits must not exceed the {samples} samples, not {hits!r}")
    return hits, samples


def binomial_estimate(hits, samples, measure):
    """Return measure · hits/samples with its binomial error, or ``None`` for no hits at all.

    ``measure`` > 0 is the value that every sample being a hit would give.
    """
    hits, samples = checked_hits(hits, samples)
    measure = check_real("measure", measure)
    if not hits:
        return None
    fraction = hits / samples
    error = math.sqrt(fraction * ((samples - hits) / samples) / samples)
    return Estimate(measure * fraction, measure * error, samples)


def weighted_estimate(total, squares, unit, samples, measure):
    """Return (``measure`` × ⟨w⟩ as an ``Estimate`` or ``None``, effective number of samples).

    ``total`` is Σ w and ``squares`` Σ w² over so many ``samples``, both in ``unit``, as points of
    insertions have them. As many samples of equal weight, (Σ w)²/Σ w², would be as precise where
    few have any. It is 0 where squares are too few units each to know the error by. None without
    any weight at all.
    """
    total, squares = check_integer("total", total, 0), check_integer("squares", squares, 0)
    samples, measure = check_integer("samples", samples, 2), check_real("measure", measure)
    if not total:
        return None, 0.0
    mean, second = total / (unit * samples), squares / (unit * samples)
    error = math.sqrt(max(second - mean**2, 0.0) / samples)
    resolved = squares * math.sqrt(unit) >= RESOLVED * total
    effective = total**2 / (squares * unit) if resolved else 0.0
    return Estimate(measure * mean, measure * error, samples), effective


def effective_misses(total, squares, unit, samples):
    """Return how many samples without any weight would spread as much; arguments as above.

    Squares are known to a ``unit``, so that no more samples than that count.
    """
    spread = 1 - total**2 / (squares * unit * samples) if squares else 0.0
    return max(0.0, spread) * min(unit, samples)


def _weights_of(point, weights):
    """Return ⟨w⟩, ⟨w²⟩ and the effective number of samples of Σ_q weight × quantity.

    ``point`` is one of insertions, ``weights`` are {quantity: weight}. The effective number is the
    least of all quantities.
    """
    unit, samples, parts = point["unit"], point["samples"], point["quantities"]
    scale = {name: weight * parts[name]["measure"] for name, weight in weights.items()}

    def joint(a, b):
        if a == b:
            return parts[a]["squares"]
        return point["products"][f"{a}*{b}" if f"{a}*{b}" in point["products"] else f"{b}*{a}"]

    mean = math.fsum(scale[a] * parts[a]["sum"] for a in scale) / (unit * samples)
    second = math.fsum(scale[a] * scale[b] * joint(a, b) for a in scale for b in scale)
    effective = min(
        weighted_estimate(parts[a]["sum"], parts[a]["squares"], unit, samples, 1.0)[1]
        for a in scale
    )
    return mean, second / (unit * samples), effective


def sampled_sum(point, weights):
    """Return (Σ_q weight × estimate of q as an ``Estimate`` or None, effective number of samples).

    ``point`` is one of insertions; arguments and result are those of ``_weights_of`` and
    ``weighted_estimate``, the covariance of the quantities included.
    """
    mean, second, effective = _weights_of(point, weights)
    if not mean:
        return None, 0.0
    error = math.sqrt(max(second - mean**2, 0.0) / point["samples"])
    return Estimate(mean, error, point["samples"]), effective


def sampled_ratio(point, weights):
    """Return (Σ_q weight × estimate of q)/(that of the volume) of a point of insertions.

    An ``Estimate``, whose relative error is that of linear propagation, with the covariance of the
    quantities and the volume. ``None`` where one of them has an effective number of samples below
    ``MIN_EVENTS``.
    """
    volume, _, enough = _weights_of(point, {"volume": 1.0})
    area, _, effective = _weights_of(point, weights)
    if min(enough, effective) < MIN_EVENTS:
        return None
    # The variance of Σ weight × q/area − volume/V, whose mean is 0.
    terms = {name: weight / area for name, weight in weights.items()} | {"volume": -1 / volume}
    variance = max(_weights_of(point, terms)[1], 0.0)
    ratio, samples = area / volume, point["samples"]
    return Estimate(ratio, ratio * math.sqrt(variance / samples), samples)


def flux_time(scene, event, point):
    """Return the mean time between events as volume and area of a point of insertions give it.

    An ``Estimate``: the rate is c_D/2 × area/volume from each side of the surface, see ``theory``.
    ``None`` where that has no honest error, or the point does not have both.
    """
    events = [event]
    if event == "any_wall":
        events = [wall for wall in ("right_wall", "top_wall") if wall in scene.events]
    weight = float(len(events) and scene.multiplicity(events[0])) if event == "any_wall" else 1.0
    weights = {f"{name}_area": weight for name in events}
    if not {"volume", *weights} <= point["quantities"].keys():
        return None
    ratio = sampled_ratio(point, weights)
    if ratio is None:
        return None
    rate = DECLARED[event].sides / 2 * constant(scene.velocity_components) * ratio.value
    return Estimate(1 / rate, ratio.relative_stderr / rate, ratio.n)


# Molecular dynamics ---------------------------------------------------------------------------


def effective_count(total, squares, replicas):
    """Return (mean/error)² of the mean count: how many independent events would be as precise.

    ``total`` = Σ N and ``squares`` = Σ N² over ``replicas``. Zero when the replicas show no spread,
    for then nothing is known about the error.
    """
    total, squares, replicas = moments_of(total, squares, replicas)
    spread = replicas * squares - total**2
    return total**2 * (replicas - 1) / spread if spread else 0.0


def has_error_bar(total, squares, replicas, octaves=None):
    """Say whether the replicas carry an error bar: 100 of them, and 100 effective events.

    With ``octaves``, as in ``error_of_error``, the error must also be known to 10 %. Counts with a
    heavy tail are not: a few replicas make most of their variance, and larger ones may follow.
    """
    if octaves is not None and error_of_error(total, squares, replicas, octaves) > KNOWN:
        return False
    return effective_count(total, squares, replicas) >= MIN_EVENTS and replicas >= MIN_EVENTS


def error_of_error(total, squares, replicas, octaves):
    """Return the relative standard error of the standard error, √Σ(N − ⟨N⟩)⁴ / 2Σ(N − ⟨N⟩)².

    ``octaves`` are the numbers of replicas, Σ N and Σ N² by the size of N (as
    ``counting.sort_into_octaves`` counts them); within each of them all deviate alike.
    """
    mean, fourth = total / replicas, 0.0
    for n, counts, products in zip(*octaves, strict=True):
        if n:
            fourth += (products - 2 * mean * counts + n * mean * mean) ** 2 / n
    spread = squares - total * mean
    return math.sqrt(fourth) / (2 * spread) if spread > 0 else 0.0


def mean_time(total, squares, replicas, duration, mean=None):
    """Return T/⟨N⟩ with its error by the delta method, or ``None`` when nothing was counted.

    ``total`` and ``squares`` are Σ N and Σ N² over the replicas that can see the event, each of
    length ``duration`` = T. The relative error of the time is that of the mean count; ``mean``, if
    given, is that count and its error as known better than from these sums. The error is to be
    shown only where they have one (``has_error_bar``).
    """
    total, squares, replicas = moments_of(total, squares, check_integer("replicas", replicas, 2))
    duration = check_real("duration", duration)
    if not total:
        return None
    if mean is not None:
        time, relative = duration / mean[0], mean[1] / mean[0]
        return Estimate(time, time * relative, replicas)
    time = duration * replicas / total
    relative = math.sqrt((replicas * squares - total**2) / (total**2 * (replicas - 1)))
    return Estimate(time, time * relative, replicas)


def mean_time_bound(replicas, duration, confidence=0.95):
    """Return the lower bound on the mean time after ``replicas`` saw no event in ``duration``.

    A replica sees the event with a probability q of at least (T/τ)/K when it sees at most K events
    in the mean if any. Then P(none) = (1 − q)^R ≤ exp(−RT/(Kτ)), and this is 1 − ``confidence`` at
    τ = RT/(K ln 1/(1 − confidence)). K = 4, as for the tests; the familiar RT/3 at 95 % is K = 1
    and claims too much where events come in clusters.
    """
    replicas, duration = check_integer("replicas", replicas, 1), check_real("duration", duration)
    confidence = check_fraction("confidence", confidence)
    return duration * replicas / (CLUSTER * -math.log1p(-confidence))


def sums_of_others(counts, products=None, replicas=None):
    """Return the events whose number is the sum of the numbers of others, a set.

    ``counts`` and ``products`` are Σ N_a and Σ N_a N_b by event. It is so if the difference is zero
    in every replica, that is, if it has no mean and no variance; without ``products`` the sums over
    all replicas decide. Of events that are related in this way the last one in the order of
    ``EVENTS`` is named: any_wall where right_wall and top_wall count all that symmetry makes equal.
    """
    derived = set()
    for event in reversed(EVENTS):
        rest = [e for e in EVENTS if e != event and e not in derived and counts.get(e)]
        terms = chain.from_iterable(combinations(rest, n) for n in range(1, len(rest) + 1))
        for some in terms if counts.get(event) else ():
            if sum(counts[e] for e in some) == counts[event]:
                weights = {e: -1 if e in some else 1 for e in EVENTS if e in (*some, event)}
                if not products or combination(weights, counts, products, replicas).stderr == 0:
                    derived.add(event)
    return derived


def sum_rule(scene, duration, replicas, counts, products):
    """Return the estimate of the sum of virials over 2⟨K⟩, which is 1 (see ``theory.virial``).

    Rates are those of all ``replicas``, whether they can reach a wall or not; of walls everything
    counts that is equal by symmetry. ``counts`` and ``products`` are Σ N_a and Σ N_a N_b by event.
    Raises ``InputError`` for a scene that has no such sum.
    """
    weights = virial.weights(scene)
    if weights is None:
        raise InputError(f"scene must have a sum rule, but has {', '.join(scene.calls_for)}")
    duration = check_real("duration", duration)
    rates = {e: scene.share(e) / scene.multiplicity(e) / duration for e in weights}
    return combination({e: w * rates[e] for e, w in weights.items()}, counts, products, replicas)


def density_at_zero(counts, intervals, width):
    """Return the density at 0 as an ``Estimate``: that of p(0) − a t² with the counts of two bins.

    ``counts`` are those of the first bins of ``width`` from 0, out of so many independent
    ``intervals``; the error is that of multinomial counts. There is no linear term: discs that
    touch right after a hop are side by side and exchange velocities along x, which does not change
    when they hop back. Raises ``InputError`` for fewer than two bins and for counts beyond
    ``intervals``.
    """
    n = np.array([check_integer("count", n, 0) for n in counts[:2]], float)
    if n.size < 2:
        raise InputError(f"counts must be of at least 2 bins, not {n.size}")
    intervals, width = check_integer("intervals", intervals), check_length("width", width)
    if n.sum() > intervals:
        raise InputError(f"intervals must be at least the {int(n.sum())} counts, not {intervals!r}")
    weights = np.array([7, -1]) / 6
    share = weights @ n / intervals
    spread = weights**2 @ n / intervals - share**2
    return Estimate(share / width, math.sqrt(spread / intervals) / width, intervals)


def density_of_chains_at_zero(densities, errors, linear=False):
    """Return the density at 0 as ``density_at_zero`` does, and its error.

    ``densities`` of the first two bins have ``errors`` of their own, such as those of the spread
    between chains of intervals; they are taken as uncorrelated. If ``linear`` it is that of a
    straight line instead.
    """
    (first, second), (error, other) = densities, errors
    if linear:
        return (3 * first - second) / 2, math.hypot(3 * error, other) / 2
    return (7 * first - second) / 6, math.hypot(7 * error, other) / 6
