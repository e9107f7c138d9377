"""Strata: what is known exactly of random starts takes scatter out of a mean over them.

Starts are sorted by quantities whose law is exact, into strata of exact probability p. Then Σ p ⟨N⟩
with the mean of N in each stratum scatters less than the mean over all starts: by how chance filled
the strata it does not scatter (Cochran, Sampling Techniques, 1977, section 5A.9). The starts
stay those of the invariant measure, all independent.
"""

import math

import numpy as np

from twodiscs.theory.quadrature import gauss_legendre

#: Strata of each quantity.
PARTS = 8

#: The fastest starts are one stratum, of at least such a share.
LEAST_SHARE = 1 / 64

#: Where a stratum has fewer starts than so many, neighbours are taken together.
FEWEST = 8


def share_below(cosine, components):
    """Return the share of directions with a component of at most ``cosine``, positive or negative.

    They are uniform on the unit sphere in so many dimensions, ``components`` ≥ 2; 0 ≤ cosine ≤ 1.
    The component is sin t with density ∝ cosⁿ⁻² t.
    """

    def integral(end):
        return end * math.fsum(
            weight * math.cos(end * t) ** (components - 2) for t, _, weight in gauss_legendre(16)
        )

    return integral(math.asin(cosine)) / integral(math.pi / 2)


def shares_of_speeds(components):
    """Return the shares of starts whose component along an axis is within 0, 1/8, 2/8 … of speed.

    The last ones are taken together: they have a share of ``LEAST_SHARE`` at least.
    """
    below = [share_below(part / PARTS, components) for part in range(PARTS)]
    below = [share for share in below if share <= 1 - LEAST_SHARE]
    return np.diff([*below, 1.0])


def _merged(sums):
    """Return ``sums`` (n, m) of strata with their neighbours, two by two."""
    for axis, size in enumerate(sums.shape):
        sums = np.add.reduceat(sums, np.arange(0, size, 2), axis=axis)
    return sums


def mean_of(shares, starts, counts, squares):
    """Return the mean of N and its standard error, from what is known of the strata.

    That is their exact ``shares``, which add up to 1, the numbers of ``starts``, Σ N and Σ N²,
    arrays (n, m). Which strata are taken together depends on the numbers of starts alone; so the
    mean has no bias. The error is infinite for a single start.
    """
    found = [np.asarray(part) for part in (shares, starts, counts, squares)]
    while found[1].min() < FEWEST and found[1].size > 1:
        found = [_merged(part) for part in found]
    shares, starts, counts, squares = found
    means = counts / starts
    if starts.min() < 2:
        return float(means[0, 0]), math.inf
    variances = np.maximum(squares / starts - means**2, 0.0) / (starts - 1)
    return float(np.sum(shares * means)), math.sqrt(np.sum(shares**2 * variances))
