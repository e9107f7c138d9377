"""Checks of single values: types, ranges and messages.

Without it an infinite field or a text as a length would reach the physics.

Allowed values are returned in their plain type, others are named in a short sentence.
"""

from fractions import Fraction

import numpy as np
import pytest

from twodiscs import EFFECTS, Box, Scene
from twodiscs.model import checks, formats
from twodiscs.model.seeds import stream_seed


def test_what_is_allowed_is_returned_in_its_plain_type():
    for found, expected in (
        (checks.check_number("x", np.float32(0.5), 0.1, 1), 0.5),
        (checks.check_length("x", Fraction(1, 4)), 0.25),
        (checks.check_fraction("x", np.float64(0.5)), 0.5),
        (checks.check_integer("x", np.int64(3)), 3),
        (checks.check_integer("x", 0, 0), 0),
        (checks.check_integer("x", 2**63 - 1), 2**63 - 1),
        (checks.check_choice("x", "a", ("a", "b")), "a"),
    ):
        assert found == expected
        assert type(found) is type(expected)


class Odd:
    def __repr__(self):
        raise RuntimeError

    def __float__(self):
        raise RuntimeError


#: What Python takes for numbers, compares element by element, or cannot write out.
ODD = [np.True_, np.array(1.0), np.array([1.0, 2.0]), 10**400, -(10**5000), Fraction(10**400, 3),
       1 + 0j, np.complex128(1), np.ma.masked, Odd(), b"1", "x" * 10_000, range(3)]  # fmt: skip


@pytest.mark.parametrize("value", ODD, ids=lambda value: type(value).__name__)
def test_odd_values_are_named_in_a_short_sentence(value):
    box = Box(1.5, 1.0)
    calls = [
        lambda: box.scene(value),
        lambda: Box(value, 1.0),
        lambda: Box(1.5, value),
        *(lambda name=name: Box(1.5, 1.0, **{name: value}) for name in EFFECTS),
        *(lambda name=name: Scene(1.5, 1.0, 0.2, **{name: value}) for name in EFFECTS),
        lambda: box.scene(0.2).is_possible(value),
        lambda: checks.check_fraction("x", value),
        lambda: checks.check_choice("x", value, ["a"]),
        lambda: stream_seed(value, "a", "dynamics", "0.1"),
    ]
    for call in calls:
        with pytest.raises(checks.InputError, match=r"must|does not fit") as caught:
            call()
        assert len(str(caught.value)) < 300


@pytest.mark.parametrize(
    ("value", "error", "texts"),
    [
        (1.33704985, 0.0015016, ("1.3370", "0.0015")), (0.356541, 7.49e-5, ("0.356541", "7.5e-05")),
        (0.3351, 0.0996, ("0.34", "0.10")), (9.9996, 0.0012, ("9.9996", "0.0012")),
        (9.9999, 0.012, ("10.000", "0.012")), (1e-4, 0.053, ("0.000", "0.053")),
        (-0.0018, 0.0037, ("-0.0018", "0.0037")), (1237.0, 120.0, ("1.24e+03", "1.2e+02")),
        (0.4, 12.0, ("0", "12")), (123.4, 12.0, ("123", "12")), (0.5, None, ("0.5", "")),
        (1 / 3, 0.0, ("0.33333333", "")), (None, None, ("–", "")), (0.0, 0.1, ("0.00", "0.10")),
        (1.23456, 0.0996, ("1.23", "0.10")), (-4e-4, 0.02, ("0.000", "0.020")),
        (1 / 3, 1e-20, ("0.33333333333333331", "1.0e-20")),  # all digits of a double
    ],
)  # fmt: skip
def test_a_value_ends_at_the_second_digit_of_its_error_and_a_zero_has_no_sign(value, error, texts):
    assert formats.texts_with_error(value, error) == texts
