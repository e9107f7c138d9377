"""A rule of quadrature could be exact for less than it promises."""

import math
from fractions import Fraction

import numpy as np
import pytest

from twodiscs.theory.quadrature import double_exponential, gauss_legendre

EPSILON = 2.0**-52


def integral(rule, function):
    """Return the integral over [0, 1] of a function of t and 1 − t."""
    return math.fsum(weight * function(t, rest) for t, rest, weight in rule)


@pytest.mark.parametrize("order", [2, 3, 8, 16])
def test_gauss_legendre_is_exact_for_polynomials_up_to_its_degree_and_no_further(order):
    rule = gauss_legendre(order)
    assert len(rule) == order
    for degree in range(2 * order):
        found = integral(rule, lambda t, rest, k=degree: t**k)
        assert found == pytest.approx(1 / (degree + 1), rel=8 * EPSILON)
    # The first one that is not: tⁿ(1 − t)ⁿ less its interpolant, n!⁴/((2n + 1) (2n)!²).
    n = order
    missing = Fraction(math.factorial(n) ** 4, (2 * n + 1) * math.factorial(2 * n) ** 2)
    error = 1 / (2 * n + 1) - integral(rule, lambda t, rest: t ** (2 * n))
    assert error == pytest.approx(float(missing), rel=1e-3, abs=2 * EPSILON)


@pytest.mark.parametrize("rule", [gauss_legendre(16), double_exponential(1 / 16)])
def test_a_node_knows_its_distance_from_both_ends(rule):
    for t, rest, weight in rule:
        assert 0 < t < 1 or rest < EPSILON
        assert 0 < rest <= 1
        assert weight > 0
        assert t + rest == pytest.approx(1, rel=2 * EPSILON)
    # From end to end: the rule looks the same.
    mirrored = sorted((rest, weight) for _, rest, weight in rule)
    here = sorted((t, weight) for t, _, weight in rule)
    assert np.array(mirrored) == pytest.approx(np.array(here), rel=1e-11)


@pytest.mark.parametrize("at_end", [0, 0.25, 0.5, 1, 1.5, 3.5])
@pytest.mark.parametrize("at_start", [0, 0.5, 1.5, 2.5])
def test_double_exponential_takes_any_power_at_both_ends(at_start, at_end):
    """Euler's beta function."""
    found = integral(double_exponential(1 / 16), lambda t, rest: t**at_start * rest**at_end)
    expected = math.gamma(at_start + 1) * math.gamma(at_end + 1) / math.gamma(at_start + at_end + 2)
    assert found == pytest.approx(expected, rel=1e-14)
