"""How results are rounded and written: the one rule of the manuscript.

An estimate with its error has the digits that the error leaves. What is said to be the largest is
rounded up, the smallest down, so that the sentence is true. Texts of a ``Number`` are markup of
Typst, with mathematics between dollars.
"""

import math
import re
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_UP, Context
from typing import NamedTuple

WORDS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")


class Number(NamedTuple):
    """A number of the manuscript: its ``value``, None if it is several, and the ``text`` of it."""

    value: float | None
    text: str


def rounded(x, n, rounding=ROUND_HALF_UP):
    """Return ``x`` as a ``Decimal`` of ``n`` digits that count, n ≥ 1; noise of doubles is none."""
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
    """Return the number ``x`` to ``n`` digits that count."""
    return Number(x, f"${formula(rounded(x, n))}$")


def at_most(values, n=2):
    """Return the largest of ``values``, rounded up to ``n`` digits; None if there are none."""
    return Number(x := max(values), f"${formula(rounded_up(x, n))}$") if values else None


def at_least(values, n=2):
    """Return the smallest of ``values``, rounded down to ``n`` digits; None if there are none."""
    return Number(x := min(values), f"${formula(rounded_down(x, n))}$") if values else None


def percent_at_least(fractions):
    """Return the smallest of ``fractions`` in per cent, rounded down; None if there are none."""
    return at_least([100 * fraction for fraction in fractions], 3)


def percent_at_most(fractions):
    """Return the largest of ``fractions`` in per cent, rounded up; None if there are none."""
    return at_most([100 * fraction for fraction in fractions], 3)


def span(values, n=2):
    """Return from where to where ``values`` go, to ``n`` digits; None if there are none."""
    if not values:
        return None
    least, most = min(values), max(values)
    if least == most:
        return significant(least, n)
    return Number(None, f"{significant(least, n).text} to {significant(most, n).text}")


def with_error(value, error):
    """Return 0.813(2) or 0.81(12): the error is that of the last digit, of two if it begins with 1.

    ``error`` is positive; one that is larger than 1 is written in full, 120(30).
    """
    places = -math.floor(math.log10(error))
    if error * 10.0**places < 1.95:
        places += 1
    places = max(places, 0)
    return Number(value, f"${value:.{places}f} ({error * 10.0**places:.0f})$")


def whole(n):
    """Return an integer in figures."""
    return Number(n, str(n))


def in_words(n):
    """Return an integer in words, as far as ten."""
    return Number(n, WORDS[n] if n < len(WORDS) else str(n))


def plain(text):
    """Return ``text`` as markup that prints it as it is."""
    return re.sub(r"([\\#$*_@<>`~\[\]])", r"\\\1", text)


def sides(width, height):
    """Return the box of these sides."""
    texts = [formula(rounded(side, 6)) for side in (width, height)]
    texts = [f"({text})" if "times" in text else text for text in texts]
    return Number(None, f"${' times '.join(texts)}$")
