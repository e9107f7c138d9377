"""A number of the manuscript: a table, a filter for its rows, a column, and a format."""

from dataclasses import dataclass, replace
from typing import Any

from twodiscs.model.checks import InputError
from twodiscs_paper.pipeline.documents.numbers.rounding import Format, Printed

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
