"""Rounding and formats of results: the one rule of the manuscript.

The error of an estimate decides the number of its digits. The largest of several values is rounded
up and the smallest down, so that the sentence about them is true. Texts are markup of Typst, with
mathematics between dollars.
"""

import math
import re
from collections.abc import Callable
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_UP, Context
from typing import NamedTuple

WORDS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")


class Printed(NamedTuple):
    """A number in print: its ``value``, None for several values or words, and its ``text``."""

    value: float | None
    text: str


def rounded(x, n, rounding=ROUND_HALF_UP):
    """Return ``x`` as a ``Decimal`` of ``n`` ≥ 1 significant digits, after rounding to twelve."""
    return Context(prec=n, rounding=rounding).create_decimal(f"{x:.12g}").normalize()


def rounded_up(x, n=2):
    """Return a number of ``n`` digits that ``x`` does not exceed, as a ``Decimal``."""
    return rounded(x, n, ROUND_CEILING)


def rounded_down(x, n=2):
    """Return a number of ``n`` digits that does not exceed ``x``, as a ``Decimal``."""
    return rounded(x, n, ROUND_FLOOR)


def formula(x):
    """Return a ``Decimal`` as a formula: 0.25, or 4.4 times 10^10 below 0.01 and from 10⁴ on."""
    power = x.adjusted()
    if not x or -2 <= power <= 3:
        return f"{x:f}"
    mantissa = x.scaleb(-power)
    return f"10^({power})" if mantissa == 1 else f"{mantissa:f} times 10^({power})"


def significant(x, n):
    """Return the number ``x`` to ``n`` significant digits."""
    return Printed(x, f"${formula(rounded(x, n))}$")


def at_most(values, n=2):
    """Return the largest of ``values``, rounded up to ``n`` digits."""
    return Printed(x := max(values), f"${formula(rounded_up(x, n))}$")


def at_least(values, n=2):
    """Return the smallest of ``values``, rounded down to ``n`` digits."""
    return Printed(x := min(values), f"${formula(rounded_down(x, n))}$")


def span(values, n=2):
    """Return the smallest and the largest of ``values`` to ``n`` digits."""
    least, most = min(values), max(values)
    if least == most:
        return significant(least, n)
    return Printed(None, f"{significant(least, n).text} to {significant(most, n).text}")


def with_error(value, error):
    """Return 0.813(2) or 0.81(12): the error of the last digit, or of the last two if it begins 1.

    ``error`` is positive; an error larger than 1 is written in full, 120(30).
    """
    places = -math.floor(math.log10(error))
    if error * 10.0**places < 1.95:
        places += 1
    places = max(places, 0)
    return Printed(value, f"${value:.{places}f} ({error * 10.0**places:.0f})$")


def integer(n):
    """Return an integer in figures."""
    return Printed(n, f"{n:.0f}")


def in_words(n):
    """Return an integer in words, as far as ten."""
    return Printed(n, WORDS[n] if n < len(WORDS) else str(n))


def plain(text):
    """Return ``text`` as markup that prints it as it is."""
    return re.sub(r"([\\#$*_@<>`~\[\]])", r"\\\1", text)


def sides(width, height):
    """Return the box of these sides."""
    texts = [formula(rounded(side, 6)) for side in (width, height)]
    texts = [f"({text})" if "times" in text else text for text in texts]
    return Printed(None, f"${' times '.join(texts)}$")


# Formats ------------------------------------------------------------------------------------------


class Format(NamedTuple):
    """A format of the values of a number.

    ``write`` takes the values of the columns of one row. If the format ``is_of_several`` rows, it
    takes a list of values, or of tuples for several columns. A format that ``takes_empty`` cells
    writes a row even if only its first column is not empty. A cell without a row prints ``empty``.
    """

    write: Callable
    is_of_several: bool = False
    takes_empty: bool = False
    empty: str = "--"


def several(write):
    """Return the format of several rows."""
    return Format(write, is_of_several=True)


def digits(n, scale=1):
    """Return the format of a value times ``scale``, to ``n`` significant digits."""
    return Format(lambda x: significant(scale * x, n))


def decimals(n):
    """Return the format of a value with ``n`` digits after the point."""
    return Format(lambda x: Printed(x, f"${x:.{n}f}$"))


def largest(n=2, scale=1):
    """Return the format of the largest size of several values, rounded up to ``n`` digits."""
    return several(lambda values: at_most([scale * abs(x) for x in values], n))


def smallest(n=2, scale=1):
    """Return the format of the smallest size of several values, rounded down to ``n`` digits."""
    return several(lambda values: at_least([scale * abs(x) for x in values], n))


def total(n):
    """Return the format of the sum of several values to ``n`` digits."""
    return several(lambda values: significant(sum(values), n))


def words(write):
    """Return the format of one row as the text that the function ``write`` returns."""
    return Format(lambda *values: Printed(None, write(*values)))


INTEGER, IN_WORDS, WITH_ERROR, SIDES = map(Format, (integer, in_words, with_error, sides))
AS_TYPED = Format(lambda x: Printed(x, repr(x)))
NAME = words(lambda name: name.replace("_", " "))
COUNTED = several(lambda values: integer(len(values)))
COUNTED_IN_WORDS = several(lambda values: in_words(len(values)))
DISTINCT_IN_WORDS = several(lambda values: in_words(len({*values})))
RANGE, RANGE_OF_THREE = several(span), several(lambda values: span(values, 3))
