"""N discs: what is accepted, where they fit, and what they are called."""

import itertools
import math

import pytest

from twodiscs.model.checks import InputError
from twodiscs.model.many import Gas, largest_radius
from twodiscs.model.scene import Scene


@pytest.mark.parametrize("width", [1.0, 1.3, 1.5, 1.99, 2.0, 5.0])
def test_two_discs_fit_as_in_a_scene(width):
    assert largest_radius(2, width, 1.0) == pytest.approx(
        Scene(width, 1.0, 0.1).largest_radius, rel=1e-14
    )


@pytest.mark.parametrize("width", [1.0, 1.02, 1.05, 1.1, 1.3, 1.5, 2.0, 2.9, 3.0, 4.0])
def test_three_discs_fit_as_far_as_closed_forms_say(width):
    """A zigzag, the largest equilateral triangle, or a row."""
    total, short = width + 4, 1.0
    zigzag = (total - math.sqrt(total**2 - width**2 - 4)) / 2
    c = 7 - 4 * math.sqrt(3)
    b = (4 - 2 * math.sqrt(3)) * (width + 1)
    triangle = (b - math.sqrt(b * b - 4 * c * (width**2 + 1 - math.sqrt(3) * width))) / (2 * c)
    a, height = width - 2 * triangle, 1 - 2 * triangle
    is_triangle = height > a * math.sqrt(3) / 2
    expected = min(triangle if is_triangle else zigzag, short / 2)
    assert largest_radius(3, width, 1.0) == pytest.approx(expected, rel=1e-13)


@pytest.mark.parametrize("discs", [2, 3, 4, 5, 8, 13, 64])
@pytest.mark.parametrize("sides", [(1.5, 1.0), (1.0, 1.0), (1.0, 6.0), (20.0, 1.0)])
@pytest.mark.parametrize("periodic", ["", "x"])
def test_arrangements_fit(discs, sides, periodic):
    largest = largest_radius(discs, *sides, periodic)
    gas = Gas(discs, *sides, largest * (1 - 1e-9), periodic)
    centres = gas.arrangement
    assert len(centres) == discs
    for (x, y), (other_x, other_y) in itertools.combinations(centres, 2):
        dx = abs(x - other_x)
        dx = min(dx, gas.width - dx) if periodic else dx
        assert math.hypot(dx, y - other_y) >= gas.contact_distance
    assert max(abs(x) for x, _ in centres) <= gas.range_x / 2 * (1 + 1e-15)
    assert max(abs(y) for _, y in centres) <= gas.range_y / 2 * (1 + 1e-15)


def test_names():
    gas = Gas(5, 1.5, 1.0, 0.1)
    assert gas.velocity_components == 10
    assert Gas(5, 1.5, 1.0, 0.1, "x").velocity_components == 9
    assert gas.multiplicity("right_wall") == 10
    assert gas.multiplicity("disc_collision") == 1
    assert gas.turned() == Gas(5, 1.0, 1.5, 0.1)
    assert not gas.is_ordered
    assert Gas(5, 3.0, 0.6, 0.18).is_ordered
    assert not Gas(5, 3.0, 0.6, 0.18, "x").is_ordered


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((1, 1.5, 1.0, 0.1), "discs must be an integer from 2 to 64, not 1"),
        ((65, 1.5, 1.0, 0.1), "discs must be an integer from 2 to 64, not 65"),
        ((3.0, 1.5, 1.0, 0.1), "discs must be an integer"),
        ((3, 1.5, 1.0, 0.31), "radius 0.31 does not fit: of 3 discs in a box of 1.5 × 1.0"),
        ((3, 1.5, -1.0, 0.1), "height must be a positive"),
        ((3, 1.5, 1.0, 0.1, "y"), "periodic must be left out or x for more than two discs"),
        ((2, 1.5, 1.0, 0.376, "x"), "radius 0.376 does not fit"),
    ],
)
def test_bad_input_is_one_sentence(arguments, message):
    with pytest.raises(InputError, match=message):
        Gas(*arguments)


def test_a_ring_is_not_turned():
    with pytest.raises(InputError, match="cannot be turned"):
        Gas(3, 1.5, 1.0, 0.1, "x").turned()
