"""Strata: what is known exactly of random starts takes scatter out of a mean over them.

Starts are sorted by quantities whose law is exact, into strata of exact probability p. Then Σ p ⟨N⟩
with the mean of N in each stratum scatters less than the mean over all starts: how chance filled
the strata matters to second order only (Cochran, Sampling Techniques, 1977, section 5A.9). The
starts stay those of the invariant measure, all independent.
"""

import math
from functools import cache

import numpy as np

from twodiscs.model.checks import InputError
from twodiscs.theory.plain import RULE

#: Strata of each quantity.
PARTS = 8

#: The fastest starts are one stratum, of at least such a share.
LEAST_FRACTION = 1 / 64

#: If the smallest stratum expects fewer initial states than this, neighbours are merged.
FEWEST = 16


def fraction_below(cosine, components):
    """Return the share of directions with a component between −``cosine`` and ``cosine``.

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
    """Return the shares of directions by the size of one component: up to 1/8, to 2/8 and so on.

    The last ones are taken together: they have a share of ``LEAST_FRACTION`` at least.
    """
    below = [fraction_below(part / PARTS, components) for part in range(PARTS)]
    below = [share for share in below if share <= 1 - LEAST_FRACTION]
    return tuple(np.diff([*below, 1.0]))


def _merged(sums):
    """Return ``sums`` (n, m) of strata and their neighbours, two by two; an odd one stays alone."""
    for axis, size in enumerate(sums.shape):
        sums = np.add.reduceat(sums, np.arange(0, size, 2), axis=axis)
    return sums


def mean_of(shares, starts, counts, squares):
    """Return the mean of N and its standard error, from what is known of the strata.

    That is their exact ``shares``, which add up to 1, the numbers of ``starts``, Σ N and Σ N²,
    arrays (n, m). Which strata are taken together depends on the number of all starts, so that the
    mean has no bias, except in the rare case of a stratum with fewer than two of them. The error is
    infinite for a single start. Raises ``InputError`` for arrays that are no such numbers.
    """
    try:
        strata = [np.array(part, float) for part in (shares, starts, counts, squares)]
    except (TypeError, ValueError):
        raise InputError("strata must be arrays of numbers") from None
    shapes = {part.shape for part in strata}
    if len(shapes) > 1 or strata[0].ndim != 2 or not strata[1].sum() >= 1:
        raise InputError(f"strata must be starts in arrays of one shape (n, m), not of {shapes}")
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
