"""Checks of plain arguments: allowed values are returned in their type, others are named."""

import math
import re
from fractions import Fraction

import numpy as np
import pytest

from twodiscs.model.box import Box
from twodiscs.model.checks import (
    InputError,
    check_ascending,
    check_choice,
    check_error,
    check_fraction,
    check_integer,
    check_length,
    check_number,
)
from twodiscs.model.effects import ABSENT
from twodiscs.model.radii import stream_seed
from twodiscs.model.scene import Scene


def test_what_is_allowed_is_returned_in_its_plain_type():
    for found, expected in (
        (check_number("x", np.float32(0.5), 0.1, 1), 0.5),
        (check_length("x", Fraction(1, 4)), 0.25),
        (check_fraction("x", np.float64(0.5)), 0.5),
        (check_integer("x", np.int64(3)), 3),
        (check_integer("x", 0, 0), 0),
        (check_integer("x", 2**63 - 1), 2**63 - 1),
        (check_choice("x", "a", ("a", "b")), "a"),
        (check_ascending("x", np.array([1, 2])), [1.0, 2.0]),
    ):
        assert found == expected
        assert type(found) is type(expected)


@pytest.mark.parametrize(
    ("check", "arguments", "sentence"),
    [
        (check_number, (2.0, 0.1, 1.0), "x must lie between 0.1 and 1.0, not 2.0"),
        (check_number, (0, 0.1, 1.0, "ratio"), "x must be a positive, finite ratio, not 0.0"),
        (check_length, ("1",), "x must be a positive number, not '1'"),
        (
            check_length,
            ("0,3",),
            "x must be a positive number, not '0,3'; decimals follow a point, 0.3",
        ),
        (check_length, (1e61,), "x must lie between 1e-60 and 1e60, not 1e61"),
        (check_integer, (1.0,), "x must be an integer of at least 1, not 1.0"),
        (check_integer, (True,), "x must be an integer of at least 1, not True"),
        (check_integer, (0,), "x must be an integer from 1 to 2^63 - 1, not 0"),
        (check_integer, (2**63,), f"x must be an integer from 1 to 2^63 - 1, not {2**63}"),
        (check_integer, (6, 2, 5), "x must be an integer from 2 to 5, not 6"),
        (check_fraction, ("0.5",), "x must be a number between 0 and 1, not '0.5'"),
        (check_fraction, (True,), "x must be a number between 0 and 1, not True"),
        *(
            (check_fraction, (bad,), f"x must lie between 0 and 1, ends excluded, not {bad!r}")
            for bad in (0, 1.0, -0.5, math.nan, math.inf)
        ),
        *(
            (
                check_error,
                (bad,),
                "x must be a number above 0 and at most 1, or one of draft, paper, reference, not "
                f"{bad!r}",
            )
            for bad in (0, 1.1, -0.5, True, "rough", None, [1])
        ),
        (check_choice, ("c", ("a", "b")), "x must be one of a, b, not 'c'"),
        (check_ascending, ("12",), "x must be a sequence of numbers, not '12'"),
        (check_ascending, (1.0,), "x must be a sequence of numbers, not 1.0"),
        (check_ascending, ([],), "x must ascend and must not be empty, not []"),
        (check_ascending, ([2, 1],), "x must ascend and must not be empty, not [2.0, 1.0]"),
        (check_ascending, ([1, 1],), "x must ascend and must not be empty, not [1.0, 1.0]"),
        (check_ascending, ([0, 1],), "x must be a positive, finite number, not 0.0"),
    ],
)
def test_what_is_not_allowed_is_named_in_one_sentence(check, arguments, sentence):
    with pytest.raises(ValueError, match=f"^{re.escape(sentence)}$"):
        check("x", *arguments)


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
        lambda: Box(1.5, 1.0, value),
        *(lambda name=name: Box(1.5, 1.0, {name: value}) for name in ABSENT),
        *(lambda name=name: Scene(1.5, 1.0, 0.2, **{name: value}) for name in ABSENT),
        lambda: box.scene(0.2).is_possible(value),
        lambda: check_fraction("x", value),
        lambda: check_choice("x", value, ["a"]),
        lambda: stream_seed(value, "a", "dynamics", "0.1"),
    ]
    for call in calls:
        with pytest.raises(InputError, match=r"must|does not fit") as caught:
            call()
        assert len(str(caught.value)) < 300
