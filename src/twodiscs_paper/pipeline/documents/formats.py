"""A number of the manuscript: the rows of a table that it takes, its rounding and its format.

The error of an estimate decides the number of its digits. The largest of several values is rounded
up and the smallest down, so that the sentence about them is true. Texts are markup of Typst, with
mathematics between dollars.
"""

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_UP, Context
from typing import Any, NamedTuple

from twodiscs.model.checks import InputError

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


def box_markup(width, height):
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


INTEGER, WITH_ERROR, SIDES = map(Format, (integer, with_error, box_markup))
AS_TYPED = Format(lambda x: Printed(x, repr(x)))
NAME = words(lambda name: name.replace("_", " "))
COUNTED = several(lambda values: integer(len(values)))
COUNTED_IN_WORDS = several(lambda values: in_words(len(values)))
DISTINCT_IN_WORDS = several(lambda values: in_words(len({*values})))
RANGE, RANGE_OF_THREE = several(span), several(lambda values: span(values, 3))

# Formats for single numbers or columns ------------------------------------------------------------

#: Words that a narrow table cuts in the names of events.
SHORT = {"vertical": "v.", "horizontal": "h.", "collision": "coll."}

#: A probability below this level is printed as 0.
LEVEL = 1e-3


def _cases(cases):
    parts = []
    for event in ("vertical_hop", "horizontal_hop"):
        radii = [significant(radius, 5).text for hop, radius in cases if hop == event]
        if radii:
            parts.append(f"{event.replace('_', ' ')}s at $r =$ {', '.join(radii)}")
    return Printed(None, "; ".join(parts))


def _step_floors(floors):
    return ", ".join(
        f"{significant(error, 2).text} at $Delta t =$ {significant(step, 2).text}"
        for step, error in sorted(floors, reverse=True)
    )


def _plurals(events):
    return " and ".join(f"{event.replace('_', ' ')}s" for event in events)


def _number_words(numbers):
    return " and ".join(in_words(n).text for n in sorted({*numbers}))


def _share(count, replicas):
    share = count / replicas
    return Printed(share, f"a share of {significant(share, 1).text}" if count else "none")


def _spread(pairs):
    of_radius = {}
    for radius, value in pairs:
        of_radius.setdefault(radius, []).append(value)
    return at_most([100 * (max(values) / min(values) - 1) for values in of_radius.values()])


def _chance(p):
    return significant(p, 1) if p > LEVEL else Printed(p, "$0$")


def _exact_or_measured(measured, error, exact):
    return significant(exact, 5) if exact is not None else with_error(measured, error)


def _list(write):
    return several(lambda values: Printed(None, write(values)))


#: Hops and radii, as part of a sentence.
CASES = several(_cases)
STEP_FLOORS, PLURALS, NUMBER_WORDS = map(_list, (_step_floors, _plurals, _number_words))
#: The largest of several values over the smallest.
QUOTIENT = several(lambda values: significant(max(values) / min(values), 2))
#: By how many per cent values at one radius differ at most, from pairs (radius, value).
SPREAD = several(_spread)
SHARE, CHANCE = Format(_share), Format(_chance)
EXACT_OR_MEASURED = Format(_exact_or_measured, takes_empty=True)
FIRST_LETTER = words(lambda event: event[0])
SHORT_EVENT = words(lambda event: " ".join(SHORT.get(word, word) for word in event.split("_")))
THEORY = words(lambda theory: theory.replace("none", "--"))
#: The second largest size of several values; the depth of an overlap, a negative gap.
OTHERS = several(lambda z: at_most(sorted(map(abs, z))[:-1]) if len(z) > 1 else None)
OVERLAP = several(lambda gaps: at_most([-min(gaps)]))
POWER_OF_TWO = Format(lambda x: Printed(x, f"$2^({round(math.log2(x))})$"))
FAILED = several(lambda passed: Printed(n := passed.count(False), str(n)))

# Corrections --------------------------------------------------------------------------------------


def _severity(severity, verdict):
    return severity if verdict == "wrong" else f"{severity}, in range"


def _ratio(ratio, radius):
    at = "" if radius is None else f" at {significant(radius, 3).text}"
    return Printed(ratio, significant(ratio, 3).text + at)


def _methods(decided_by):
    letters = {"Monte Carlo": "C", "dynamics": "D"}
    return " ".join(letters[method] for method in letters if method in decided_by) or "--"


def formulas(text):
    """Return a correction as markup; between its backticks is mathematics, as in plain text."""
    parts = text.split("`")
    parts[::2] = [plain(part) for part in parts[::2]]
    parts[1::2] = [_formula(part) for part in parts[1::2]]
    return "".join(parts)


def _formula(text):
    text = text.replace("−", "-")
    text = re.sub(r"√(\d)", r" sqrt(\1)", text).replace("√", " sqrt")
    text = re.sub("[²³⁴]", lambda match: "^" + str("  ²³⁴".index(match[0])), text)

    def letters(match):
        word = match[0]
        return word if word in ("sqrt", "arcsin", "min", "max") else f" {' '.join(word)} "

    text = re.sub("[A-Za-z]+", letters, text).replace(" _", "_")
    text = re.sub(r" *([‖|]) *", r"\1", text).replace("/", r"\/")
    return f"${text.strip()}$"


PLAIN, CORRECTION = (words(write)._replace(empty="") for write in (plain, formulas))
SEVERITY, METHODS = words(_severity), words(_methods)
RATIO = Format(_ratio, takes_empty=True)


# Numbers ------------------------------------------------------------------------------------------

#: In place of a value of a filter: the first scene, which the manuscript is about, and the hop that
#: is blocked first in it.
MAIN, FIRST_HOP = "the first scene", "the hop that is blocked first"


@dataclass(frozen=True)
class Other:
    """In place of a value of a filter: every value except this one."""

    value: Any


class NoRow(InputError):
    """A table has no row for a number."""


@dataclass(frozen=True)
class Number:
    """A number that the manuscript prints by its ``name``.

        Number("hazards", "distributions", {"scene": MAIN, "quantity": "rate"}, "count", COUNTED)

    The number takes those rows of a ``table`` that have the values of ``where``. A value may be a
    tuple of possible values, ``...`` for a cell that is not empty, ``MAIN``, ``FIRST_HOP`` or
    ``Other``. A column may be the ratio or the product of two columns, "time/exact_mean". A row
    counts if none of its ``columns`` is empty. The ``format`` writes the values of one row, or of
    several ones.

    If a format takes one row and several rows count, ``pick`` decides. It names the "first" or the
    "last" row, or the row with the "largest" or "smallest" size of some columns, ("largest",
    "radius"). ``same`` takes only rows that share columns with the row of another number,
    (ODD_DENSITY, "scene", "radius").
    """

    name: str
    table: str
    where: dict
    columns: str | tuple
    format: Format
    pick: tuple = ()
    same: tuple = ()

    def rows(self, tables, given):
        """Return the rows that the number takes; exactly one for a format of one row.

        ``tables`` are {name: rows}, ``given`` are the values of ``MAIN`` and ``FIRST_HOP``. Raises
        ``NoRow`` if there is no row, ``InputError`` for several rows instead of one.
        """
        where = resolved(self.where, given)
        if self.same:
            other, *shared = self.same
            (row,) = other.rows(tables, given)
            where |= {column: row[column] for column in shared}
        rows = [row for row in tables[self.table] if matches(row, where) and self._counts(row)]
        if self.pick and rows:
            rows = [picked(rows, *self.pick)]
        if not rows or (len(rows) > 1 and not self.format.is_of_several):
            rows_wanted = "a row" if self.format.is_of_several else "one row"
            raise (InputError if rows else NoRow)(
                f"the number {self.name} must have {rows_wanted} of {self.table}.csv with "
                f"{as_words(where)}, but there are {len(rows)}"
            )
        return rows

    def printed(self, tables, given):
        """Return the number as ``Printed``; raise the errors of ``rows``."""
        values = [self._values(row) for row in self.rows(tables, given)]
        if self.format.is_of_several:
            return self.format.write([one if len(one) > 1 else one[0] for one in values])
        return self.format.write(*values[0])

    def _values(self, row):
        columns = (self.columns,) if isinstance(self.columns, str) else self.columns
        return tuple(value_of(row, column) for column in columns)

    def _counts(self, row):
        first, *others = self._values(row)
        return first is not None and (self.format.takes_empty or None not in others)


@dataclass(frozen=True)
class Cells:
    """The cells of a table that the manuscript prints, line by line.

    A line is made of the rows of ``table`` with the same values of the columns ``key``; without a
    key every row is a line. Rows count if they have the values of ``where``. Each of the ``cells``
    is a ``Number`` with the name of a column of the printed table. It takes its rows from the rows
    of the line. If it belongs to another table, it takes the rows with the same key there. Lines
    are in the order of the table, or ``is_sorted`` by the key. The name of a line is its key, or
    its number if it ``is_numbered``.
    """

    name: str
    table: str
    where: dict
    key: tuple
    cells: tuple
    is_sorted: bool = False
    is_numbered: bool = False

    def printed(self, tables, given):
        """Return {table/line/column: ``Printed``}."""
        where, lines, found = resolved(self.where, given), {}, {}
        for number, row in enumerate(tables[self.table]):
            key = tuple(row[column] for column in self.key) or (number,)
            lines.setdefault(key, []).append(row)
        for number, key in enumerate(sorted(lines) if self.is_sorted else lines):
            own = [row for row in lines[key] if matches(row, where)]
            line = f"{number:02}" if self.is_numbered else "_".join(map(str, key))
            same = dict(zip(self.key, key, strict=False))  # without a key, none
            for cell in self.cells if own else ():
                rows = own if cell.table == self.table else tables[cell.table]
                rows = {cell.table: [row for row in rows if matches(row, same)]}
                name = f"{self.name}/{line}/{cell.name}"
                try:
                    printed = replace(cell, name=name).printed(rows, given)
                except NoRow:
                    printed = None
                found[name] = printed or Printed(None, cell.format.empty)
        return found


def resolved(where, given):
    """Return a filter with the values of ``MAIN`` and ``FIRST_HOP``."""

    def value_of(wanted):
        if isinstance(wanted, Other):
            return Other(value_of(wanted.value))
        return given.get(wanted, wanted) if isinstance(wanted, str) else wanted

    return {column: value_of(wanted) for column, wanted in where.items()}


def matches(row, where):
    """Return whether a ``row`` has the values of a filter (see ``Number``)."""

    def fits(value, wanted):
        if wanted is ...:
            return value is not None
        if isinstance(wanted, Other):
            return value != wanted.value
        return value in wanted if isinstance(wanted, tuple) else value == wanted

    return all(fits(row[column], wanted) for column, wanted in where.items())


def value_of(row, column):
    """Return the value of a column, "one/other" or "one*other" in a ``row``; None if empty."""
    for sign in "/*":
        if sign in column:
            one, other = (row[name] for name in column.split(sign))
            if one is None or other is None:
                return None
            return one / other if sign == "/" else one * other
    return row[column]


def picked(rows, which, *columns):
    """Return one of ``rows``, see ``Number``."""
    if which in ("first", "last"):
        return rows[0 if which == "first" else -1]

    def sizes(row):
        return [abs(row[column]) for column in columns]

    return {"largest": max, "smallest": min}[which](rows, key=sizes)


def as_words(where):
    """Return a filter as words."""
    texts = []
    for column, value in where.items():
        if value is ...:
            texts.append(f"any {column}")
        elif isinstance(value, Other):
            texts.append(f"{column} other than {value.value!r}")
        else:
            texts.append(f"{column} {'among' if isinstance(value, tuple) else '='} {value!r}")
    return " and ".join(texts) or "values in its columns"
