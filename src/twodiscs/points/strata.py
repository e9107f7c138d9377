"""Strata: the exact laws of random initial states reduce the variance of a mean over them.

Initial states are sorted by quantities whose law is exact, into strata of exact probability p. Then
Σ p ⟨N⟩ with the mean of N in each stratum has a smaller variance than the mean over all of them.
The random numbers of states in the strata matter only to second order (Cochran, Sampling
Techniques, 1977, section 5A.9). The initial states are still independent, from the invariant
measure.
"""

import math
from functools import cache

import numpy as np

from twodiscs.model.checks import InputError
from twodiscs.theory.plain import RULE

#: The number of strata of each quantity.
PARTS = 8

#: The fastest initial states are one stratum, of at least this probability.
LEAST_FRACTION = 1 / 64

#: If the smallest stratum expects fewer initial states than this, neighbours are merged.
FEWEST = 16


def fraction_below(cosine, components):
    """Return the fraction of directions with a component between −``cosine`` and ``cosine``.

    Directions are uniform on the unit sphere in ``components`` ≥ 2 dimensions; 0 ≤ cosine ≤ 1.
    The component is sin t with density ∝ cosⁿ⁻² t.
    """

    def integral(end):
        return end * math.fsum(
            weight * math.cos(end * t) ** (components - 2) for t, _, weight in RULE
        )

    return integral(math.asin(cosine)) / integral(math.pi / 2)


@cache
def fractions_of_speeds(components):
    """Return the fractions of directions by the size of one component: up to 1/8, 2/8 and so on.

    The last ones are merged into a fraction of at least ``LEAST_FRACTION``.
    """
    below = [fraction_below(part / PARTS, components) for part in range(PARTS)]
    below = [share for share in below if share <= 1 - LEAST_FRACTION]
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
    than two of them. The error is infinite for a single initial state. Raises ``InputError`` for
    other arrays.
    """
    try:
        strata = [np.array(part, float) for part in (shares, starts, counts, squares)]
    except (TypeError, ValueError):
        raise InputError("strata must be arrays of numbers") from None
    shapes = {part.shape for part in strata}
    if len(shapes) > 1 or strata[0].ndim != 2 or not strata[1].sum() >= 1:
        raise InputError(f"strata must be in arrays of one shape (n, m), not of {shapes}")
    if not abs(strata[0].sum() - 1) < 1e-9:
        raise InputError(f"shares of strata must add up to 1, not to {strata[0].sum():g}")
    expected = strata[1].sum() * strata[0]
    while strata[0].size > 1 and (expected.min() < FEWEST or strata[1].min() < 2):
        *strata, expected = [_merged(part) for part in (*strata, expected)]
    shares, starts, counts, squares = strata
    means = counts / starts
    if starts.min() < 2:
        return float(means[0, 0]), math.inf
    variances = np.maximum(squares / starts - means**2, 0.0) / (starts - 1)
    return float(np.sum(shares * means)), math.sqrt(np.sum(shares**2 * variances))
