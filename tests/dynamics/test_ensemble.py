"""Sizes of ensembles, and errors of counts."""

import pytest

from twodiscs.dynamics.ensemble import nearest_power_of_two


@pytest.mark.parametrize(
    ("value", "power"),
    [(1.0, 1.0), (1.41, 1.0), (1.42, 2.0), (3.0, 4.0), (0.7, 0.5), (0.71, 1.0), (1e-9, 2.0**-30)],
)
def test_the_nearest_power_of_two_is_so_on_a_logarithmic_scale(value, power):
    assert nearest_power_of_two(value) == power
