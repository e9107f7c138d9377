"""Strata: exact shares, means without bias, errors as large as they say."""

import math

import numpy as np
import pytest
from scipy.special import betainc

from twodiscs.points.estimates import (
    LEAST_FRACTION,
    PARTS,
    fraction_below,
    fractions_of_speeds,
    stratified_mean,
)


@pytest.mark.parametrize("components", range(2, 11))
def test_the_share_of_directions_is_that_of_the_beta_law(components):
    """The square of a component is of the beta law (1/2, (n − 1)/2)."""
    for cosine in (0.0, 0.125, 0.5, 0.9, 1.0):
        expected = betainc(0.5, (components - 1) / 2, cosine**2)
        assert fraction_below(cosine, components) == pytest.approx(expected, rel=1e-13)


@pytest.mark.parametrize("components", range(2, 11))
def test_only_the_fastest_starts_are_taken_together(components):
    shares = fractions_of_speeds(components)
    assert math.fsum(shares) == pytest.approx(1, rel=1e-15)
    assert shares[-1] >= LEAST_FRACTION
    below = np.cumsum(shares)[:-1]
    assert below == pytest.approx(
        [fraction_below((part + 1) / PARTS, components) for part in range(below.size)], rel=1e-13
    )
    if len(shares) < PARTS:
        assert 1 - fraction_below(len(shares) / PARTS, components) < LEAST_FRACTION


SHARES = np.outer([0.1, 0.2, 0.3, 0.25, 0.15], [0.5, 0.3, 0.2])
MEANS = np.outer([3.0, 2.0, 1.0, 0.5, 0.0], [0.2, 1.0, 2.0])
TRUE = float(np.sum(SHARES * MEANS))


def filled(rng, starts):
    """Return numbers of starts by strata, as chance fills them."""
    return rng.multinomial(starts, SHARES.ravel()).reshape(SHARES.shape)


@pytest.mark.parametrize(("starts", "number"), [(60, 20_000), (700, 20_000), (3000, 100)])
def test_means_have_no_bias(starts, number):
    """Five sigma of 20,000 means, without scatter within strata: 1/28 of what scatter is left.

    Of 700 starts 14 are expected in the smallest stratum: were strata joined by the starts they
    have, chance would decide there, and the mean be off by 17 sigma.
    """
    rng = np.random.default_rng(starts)
    fillings = [filled(rng, starts) for _ in range(number)]
    off = (
        np.array([stratified_mean(SHARES, n, n * MEANS, n * MEANS**2)[0] for n in fillings]) - TRUE
    )
    # With enough starts to keep all strata, the mean has no variance.
    assert abs(off.mean()) <= 5 * off.std() / math.sqrt(off.size) + 1e-15


@pytest.mark.parametrize("starts", [60, 400, 3000])
def test_errors_are_honest(starts):
    """Five sigma on the spread of 2000 means of Poisson counts."""
    rng = np.random.default_rng(starts)
    off, variances = [], []
    for _ in range(2000):
        n = filled(rng, starts)
        values = [rng.poisson(mean, k) for mean, k in zip(MEANS.flat, n.flat, strict=True)]
        counts, squares = (
            np.reshape([int((v**power).sum()) for v in values], n.shape) for power in (1, 2)
        )
        mean, error = stratified_mean(SHARES, n, counts, squares)
        off.append(mean - TRUE)
        variances.append(error**2)
    spread = np.array(off) ** 2 - variances
    assert abs(spread.mean()) <= 5 * spread.std() / math.sqrt(spread.size)
    # With enough starts only the variance within strata is left; the spread of 2000 means is known
    # to 1.6 %, so that a tenth is six standard errors.
    within = math.sqrt(TRUE / starts)
    between = math.sqrt(float(np.sum(SHARES * (MEANS - TRUE) ** 2)) / starts)
    if starts == 3000:
        assert np.std(off) < 1.1 * within < 0.9 * math.hypot(within, between)


def test_one_stratum_is_the_plain_mean():
    mean, error = stratified_mean([[1.0]], [[50]], [[20]], [[30]])
    values = np.repeat([0, 1, 2], [35, 10, 5])
    assert (values.sum(), (values**2).sum()) == (20, 30)
    assert mean == pytest.approx(values.mean())
    assert error == pytest.approx(values.std(ddof=1) / math.sqrt(50))


def test_strata_of_few_starts_are_taken_together_and_one_start_has_no_error():
    shares, counts = np.full((2, 3), 1 / 6), np.arange(6).reshape(2, 3)
    # 16 are expected in each of 6 strata as soon as there are 96 starts, whatever there were.
    for last, parts in ((21, 6), (20, 2)):
        starts = np.array([[15, 15, 15], [15, 15, last]])
        mean, _ = stratified_mean(shares, starts, counts, counts)
        pairs = 2 / 3 * 8 / 60 + 1 / 3 * 7 / (15 + last)
        assert mean == pytest.approx(pairs if parts == 2 else np.mean(counts / starts))
    # A stratum that is almost empty has no separate mean.
    starts = np.array([[99, 99, 99], [99, 99, 1]])
    mean, _ = stratified_mean(shares, starts, counts, counts)
    assert mean == pytest.approx(2 / 3 * 8 / 396 + 1 / 3 * 7 / 100)
    one = np.zeros((2, 3), int)
    one[1, 1] = 1
    assert stratified_mean(shares, one, 3 * one, 9 * one) == (3.0, math.inf)
