"""Tables: CSV files whose columns, units, meaning and rows are declared once, as a class.

    class Tails(Table):
        '''One row per time t: how probable an interval T longer than t is.'''

        radius: LENGTH
        '''radius of the discs'''

declares tails.csv. A class has columns and a function ``rows`` that makes its rows. Floats are
written with all their digits, integers as integers, truth values as ``true`` and ``false``; an
empty cell is a value that does not exist. The texts are docstrings, so that no job runs again after
an edit of one.
"""

import csv
import math
import re
from dataclasses import dataclass
from numbers import Integral, Real

from twodiscs.model.checks import InputError


@dataclass(frozen=True)
class Column:
    """A column: the type of its values, and their unit, "" for none."""

    kind: type
    unit: str = ""


TEXT, COUNT, TRUTH, NUMBER = Column(str), Column(int), Column(bool), Column(float)
LENGTH, TIME, RATE, SECONDS = (Column(float, unit) for unit in ("length", "time", "1/time", "s"))


class Table:
    """A table; a row is a mapping from the names of its columns to values, None for an empty cell.

    If a column has no text, the text of the base class applies.
    """

    # Columns that several tables have.
    scene: TEXT
    """the scene"""
    width: LENGTH
    """side of the box along x"""
    height: LENGTH
    """side of the box along y"""
    radius: LENGTH
    """radius of the discs"""
    z: NUMBER
    """standard normal deviate of the comparison, positive when the estimate is high"""
    test: TEXT
    """
    how z was found: normal (1000 or more events expected), exact-tail (binomial tail, doubled),
    cluster-bound (Chernoff's bound with an allowance for clusters of events), certain (the
    probability is 0 or 1), chi-square (sum of squared scores)
    """
    ergodic_components: COUNT
    """disjoint parts of configuration space"""
    chi2: NUMBER
    """Pearson's χ²"""
    degrees: COUNT
    """its degrees of freedom"""

    @classmethod
    def name(cls):
        """Return the name of the table, that of its file without the ending."""
        return re.sub(r"(?<!^)(?=[A-Z])", "_", cls.__name__).lower()

    @classmethod
    def columns(cls):
        """Return {name: ``Column``} in the order of the file."""
        derived = cls.__mro__[: cls.__mro__.index(Table)]
        return {
            n: column for table in reversed(derived) for n, column in table.__annotations__.items()
        }

    @classmethod
    def of(cls, names):
        """Return the table of a file whose columns are ``names``: this class, if not overridden."""
        return cls

    @classmethod
    def write(cls, path, rows):
        """Write ``rows`` as the CSV file ``path``.

        Raises ``ValueError`` for another set of columns, a value of another type, and NaN, before
        anything is written.
        """
        columns = cls.columns()
        lines = [list(columns)]
        for row in rows:
            if row.keys() != columns.keys():
                odd = ", ".join(sorted(row.keys() ^ columns.keys()))
                raise ValueError(f"rows must have the columns of {cls.name()}.csv, but see {odd}")
            lines.append([_text(name, column, row[name]) for name, column in columns.items()])
        with open(path, "w", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(lines)

    @classmethod
    def read(cls, path):
        """Return the rows of the CSV file at ``path`` as dicts, with ``None`` for empty cells.

        The file may have columns that the table does not know, which are left out. Raises
        ``InputError`` if it lacks a column, or a cell is not of its type.
        """
        columns = cls.columns()
        try:
            with open(path, encoding="utf-8", newline="") as file:
                lines = list(csv.reader(file))
        except UnicodeDecodeError:
            raise InputError(f"{path} must be a table {cls.name()}, but is no text") from None
        header = lines[0] if lines else []
        if [name for name in header if name in columns] != list(columns):
            raise InputError(
                f"{path} must be a table {cls.name()} with the columns {list(columns)}"
            )
        rows = []
        for number, line in enumerate(lines[1:], start=2):
            try:
                cells = dict(zip(header, line, strict=True))
                rows.append({name: _value(column, cells[name]) for name, column in columns.items()})
            except (ValueError, KeyError):
                raise InputError(f"{path} has a bad row in line {number}: {line}") from None
        return rows

    @classmethod
    def empty(cls, **values):
        """Return a row in which only these ``values`` are not empty."""
        return dict.fromkeys(cls.columns()) | values

    @classmethod
    def meaning(cls):
        """Return the meaning of a row of the table."""
        return " ".join(cls.__doc__.split())

    @classmethod
    def meanings(cls):
        """Return {name: meaning of the column}."""
        texts = {}
        for table in reversed(cls.__mro__[:-1]):
            texts |= _texts(table)
        return {name: texts[name] for name in cls.columns()}


def _texts(table):
    """Return {column: its text} of a class, without the texts that it inherits."""
    import ast
    import inspect
    from textwrap import dedent

    (statement,) = ast.parse(dedent(inspect.getsource(table))).body
    texts, column = {}, None
    for part in statement.body:
        if isinstance(part, ast.Expr) and isinstance(part.value, ast.Constant) and column:
            texts[column] = " ".join(part.value.value.split())
        column = part.target.id if isinstance(part, ast.AnnAssign) else None
    return texts


def _text(name, column, value):
    """Return the text of a cell, or raise ``ValueError`` for a value of another kind."""
    if value is None:
        return ""
    if column.kind is bool and isinstance(value, bool):
        return "true" if value else "false"
    if column.kind is str and isinstance(value, str) and value:
        return value
    number = isinstance(value, Real) and not isinstance(value, bool) and value == value
    if column.kind is float and number:
        return repr(float(value))
    if column.kind is int and number and isinstance(value, Integral):
        return repr(int(value))
    raise ValueError(f"{name} must be a {column.kind.__name__} or None, not {value!r}")


def _value(column, text):
    if text == "":
        return None
    if column.kind is bool:
        return {"true": True, "false": False}[text]
    value = column.kind(text)
    if column.kind is float and math.isnan(value):
        raise ValueError
    return value
