"""Strata: exact shares, means without bias, errors as large as they say."""

import math

import numpy as np
import pytest
from scipy.special import betainc

from twodiscs.sampling.strata import (
    LEAST_SHARE,
    PARTS,
    mean_of,
    share_below,
    shares_of_speeds,
)


@pytest.mark.parametrize("components", range(2, 11))
def test_the_share_of_directions_is_that_of_the_beta_law(components):
    """The square of a component is of the beta law (1/2, (n − 1)/2)."""
    for cosine in (0.0, 0.125, 0.5, 0.9, 1.0):
        expected = betainc(0.5, (components - 1) / 2, cosine**2)
        assert share_below(cosine, components) == pytest.approx(expected, rel=1e-13)


@pytest.mark.parametrize("components", range(2, 11))
def test_only_the_fastest_starts_are_taken_together(components):
    shares = shares_of_speeds(components)
    assert math.fsum(shares) == pytest.approx(1, rel=1e-15)
    assert shares[-1] >= LEAST_SHARE
    below = np.cumsum(shares)[:-1]
    assert below == pytest.approx(
        [share_below((part + 1) / PARTS, components) for part in range(below.size)], rel=1e-13
    )
    if shares.size < PARTS:
        assert 1 - share_below(shares.size / PARTS, components) < LEAST_SHARE


def drawn(rng, shares, means, starts):
    """Return (starts, Σ N, Σ N²) by strata; N has Poisson's law with the mean of its stratum."""
    filled = rng.multinomial(starts, shares.ravel()).reshape(shares.shape)
    counts, squares = np.zeros_like(filled), np.zeros_like(filled)
    for at, n in np.ndenumerate(filled):
        found = rng.poisson(means[at], n)
        counts[at], squares[at] = found.sum(), (found**2).sum()
    return filled, counts, squares


@pytest.mark.parametrize("starts", [60, 300, 3000])
def test_means_have_no_bias_and_errors_are_honest(starts):
    """Five sigma on the mean of 2000 means and on their spread; few starts share their strata."""
    rng = np.random.default_rng(starts)
    shares = np.outer([0.1, 0.2, 0.3, 0.25, 0.15], [0.5, 0.3, 0.2])
    means = np.outer([3.0, 2.0, 1.0, 0.5, 0.0], [0.2, 1.0, 2.0])
    true = float(np.sum(shares * means))
    found = np.array([mean_of(shares, *drawn(rng, shares, means, starts)) for _ in range(2000)])
    off, variances = found[:, 0] - true, found[:, 1] ** 2
    assert abs(off.mean()) <= 5 * off.std() / math.sqrt(off.size)
    spread = off**2 - variances
    assert abs(spread.mean()) <= 5 * spread.std() / math.sqrt(spread.size)
    # Of all scatter, that within strata is left as soon as there are enough starts.
    within = math.sqrt(true / starts)
    between = math.sqrt(float(np.sum(shares * (means - true) ** 2)) / starts)
    if starts == 3000:
        assert off.std() < 1.1 * within < 0.9 * math.hypot(within, between)


def test_one_stratum_is_the_plain_mean():
    mean, error = mean_of([[1.0]], [[50]], [[20]], [[30]])
    values = np.repeat([0, 1, 2], [35, 10, 5])
    assert (values.sum(), (values**2).sum()) == (20, 30)
    assert mean == pytest.approx(values.mean())
    assert error == pytest.approx(values.std(ddof=1) / math.sqrt(50))


def test_strata_of_few_starts_are_taken_together_and_one_start_has_no_error():
    shares = np.full((2, 3), 1 / 6)
    starts, counts = np.array([[7, 9, 9], [9, 9, 9]]), np.arange(6).reshape(2, 3)
    # Two and two of either axis: three columns are a pair and a single one.
    assert mean_of(shares, starts, counts, counts)[0] == pytest.approx(
        2 / 3 * 8 / 34 + 1 / 3 * 7 / 18
    )
    one = np.zeros((2, 3), int)
    one[1, 1] = 1
    assert mean_of(shares, one, 3 * one, 9 * one) == (3.0, math.inf)
