"""Tables: CSV files whose columns and rows are declared once, as a class.

    class TailsTable(Table):
        '''One row per time t: how probable an interval T longer than t is.'''

        columns = {"radius": RADIUS, "time": TIME("t")}

declares tails.csv. A class has ``columns`` and a function ``rows`` that makes its rows. Floats are
written with all their digits, integers as integers, truth values as ``true`` and ``false``; an
empty cell is a value that does not exist.
"""

import csv
import re
from dataclasses import dataclass
from functools import partial
from numbers import Integral, Real
from typing import ClassVar

from twodiscs.model.checks import InputError


@dataclass(frozen=True)
class Column:
    """A column: the type of its values, their unit ("" for none), and their meaning."""

    type: type
    unit: str
    meaning: str


TEXT, COUNT, TRUTH, NUMBER = (partial(Column, kind, "") for kind in (str, int, bool, float))
LENGTH, TIME, RATE, SECONDS = (
    partial(Column, float, unit) for unit in ("length", "time", "1/time", "s")
)

# Columns that several tables have.
SEE_QUANTITY = partial(Column, float, "see quantity")
SCENE = TEXT("the scene")
WIDTH = LENGTH("side of the box along x")
HEIGHT = LENGTH("side of the box along y")
RADIUS = LENGTH("radius of the discs")
Z = NUMBER("standard normal deviate of the comparison, positive when the estimate is high")
TEST = TEXT(
    "how z was found: normal (1000 or more events expected), exact-tail (binomial tail, doubled), "
    "cluster-bound (Chernoff's bound with an allowance for clusters of events), certain (the "
    "probability is 0 or 1), chi-square (sum of squared scores)"
)
ERGODIC_COMPONENTS = COUNT("disjoint parts of configuration space")

#: The types of pandas that have an empty cell.
PANDAS_TYPES = {float: "float64", int: "Int64", bool: "boolean", str: "string"}

#: The truth values of a file.
TRUTHS = {"true": True, "false": False}

#: The values that a cell of each type takes.
CELL_TYPES = {float: Real, int: Integral, bool: bool, str: str}


class Table:
    """A table; a row is a mapping from the names of its columns to values, None for an empty cell.

    ``columns`` is {name: ``Column``} in the order of the file.
    """

    columns: ClassVar[dict[str, Column]]

    @classmethod
    def name(cls):
        """Return the name of the table, that of its file without the ending."""
        return re.sub(r"(?<!^)(?=[A-Z])", "_", cls.__name__.removesuffix("Table")).lower()

    @classmethod
    def meaning(cls):
        """Return the meaning of a row of the table."""
        return " ".join((cls.__doc__ or "").split())  # none with python -OO

    @classmethod
    def present_columns(cls, names):
        """Return the columns of a file or a row with these ``names``."""
        return cls.columns

    @classmethod
    def write(cls, path, rows):
        """Write ``rows`` as the CSV file ``path``; a cell that a row does not name is empty.

        Raises ``ValueError`` for an unknown column, a value of another type, and NaN, before
        anything is written.
        """
        rows = list(rows)
        columns = cls.present_columns(rows[0] if rows else ())
        for row in rows:
            if odd := sorted(row.keys() - columns.keys()):
                names = ", ".join(odd)
                raise ValueError(f"rows must have the columns of {cls.name()}.csv, but see {names}")
        cells = ([_cell(n, column, row.get(n)) for n, column in columns.items()] for row in rows)
        lines = [[*columns], *cells]
        with open(path, "w", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(lines)

    @classmethod
    def write_and_log(cls, path, rows):
        """Write ``rows`` as ``write`` does, and print the digest, which is then in a job's log."""
        from twodiscs.points.base import digest_line

        cls.write(path, rows)
        print(digest_line(path))

    @classmethod
    def frame(cls, path):
        """Return the CSV file at ``path`` as a ``DataFrame``, see ``read``."""
        import pandas as pd  # which takes long to import, and few jobs need it

        columns, found = cls._columns(path), {}
        for name, (column, values) in columns.items():
            # N! parts of configuration space may be more than 64 bits hold.
            wide = column.type is int and any(n and n.bit_length() > 63 for n in values)
            found[name] = pd.Series(values, dtype=object if wide else PANDAS_TYPES[column.type])
        return pd.DataFrame(found)

    @classmethod
    def read(cls, path):
        """Return the rows of the CSV file at ``path`` as a list of dicts.

        The file may have columns that the table does not know, which are left out. Raises
        ``InputError`` if it lacks a column, a cell is not of its type, or the job that wrote it
        logged another digest.
        """
        columns = cls._columns(path)
        rows = zip(*(values for _, values in columns.values()), strict=True)
        return [dict(zip(columns, row, strict=True)) for row in rows]

    @classmethod
    def _columns(cls, path):
        """Return {name: (``Column``, values)} of the CSV file at ``path``."""
        from twodiscs.points.base import require_logged

        require_logged(path)
        try:
            with open(path, encoding="utf-8-sig", newline="") as file:
                header, *lines = [line for line in csv.reader(file) if line] or [[]]
            for line in lines:
                if len(line) != len(header):
                    raise ValueError(f"a line has {len(line)} cells for {len(header)} columns")
            texts = {name: [line[place] for line in lines] for place, name in enumerate(header)}
            return {
                name: (column, [_value(name, column, text) for text in texts[name]])
                for name, column in cls.present_columns(header).items()
            }
        except KeyError as missing:
            why = f"has no column {missing}"
        except ValueError as error:
            why = " ".join(str(error).split())
        raise InputError(f"{path} must be a table {cls.name()}, but {why}")


def _cell(name, column, value):
    """Return a value of a row as its column has it, or raise ``ValueError``."""
    if value is None:
        return None
    wrong = isinstance(value, bool) and column.type is not bool
    if wrong or not isinstance(value, CELL_TYPES[column.type]) or value != value or value == "":
        raise ValueError(f"{name} must be a {column.type.__name__} or None, not {value!r}")
    return str(value).lower() if column.type is bool else column.type(value)


def _value(name, column, text):
    """Return the value of the ``text`` of a cell; raise ``ValueError`` if it is of another type."""
    if not text:
        return None
    value = TRUTHS.get(text) if column.type is bool else column.type(text)
    if value is None or value != value:
        raise ValueError(f"{name} has {text!r}, which is no {column.type.__name__}")
    return value
