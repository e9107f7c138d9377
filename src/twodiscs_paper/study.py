"""The declaration of a study; each study has one in ``studies/<name>/study.py``."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

from twodiscs.analysis.columns import Column, Table

# Columns whose unit is that of another column, or follows from the quantity.
AS_ESTIMATE, AS_EXACT, SEE_QUANTITY = (
    partial(Column, float, unit) for unit in ("as estimate", "as exact", "see quantity")
)


@dataclass(frozen=True)
class Study:
    """An analysis: its ``name``, what its target ``builds``, its ``tables`` and ``figures``.

    Each table has a function ``rows`` that makes it. Its arguments are the ``parameters`` that
    follow from a ``Configuration``, by name, and ``tables``: the rows of the tables that the study
    ``reads``, {name: (name of a scene or None, table)}. If the first table takes long, ``parts``
    are {name: parameters} of jobs. Each job calls the function ``part`` of the table, and ``rows``
    gets its rows as the table of this name.

    ``figures`` are {name: ``Figure``}. ``about_plain`` studies are about scenes without effects.
    ``seconds`` is about how long the table takes: a number, or a function of a ``Configuration``.
    ``long_runs`` tables are those of long runs, in ``paper/long_run``, which figures read.
    ``timed`` tables hold seconds, which differ from run to run. Pages list studies by their
    ``order``. The scores z in the first table of a ``checked`` study are part of the check.
    """

    name: str
    builds: str
    tables: tuple[type[Table], ...]
    seconds: Callable | float
    order: int
    long_runs: tuple[type[Table], ...] = ()
    figures: dict = field(default_factory=dict)
    parameters: Callable = lambda configuration: {}
    reads: Callable = lambda configuration: {}
    parts: Callable = lambda configuration: {}
    about_plain: bool = True
    timed: tuple = ()
    checked: bool = False


def scaled(budget, divisor, least, most):
    """Return ``budget``/``divisor`` as an integer, within ``least`` and ``most``."""
    return min(most, max(least, budget // divisor))


def row(start, found=None, **cells):
    """Return a row of ``cells``, and of those in the mapping ``start``; the others are empty.

    An ``Estimate`` that was ``found`` has the cells ``estimate`` and ``stderr``.
    """
    if found is not None:
        cells = {"estimate": found.value, "stderr": found.stderr or None} | cells
    return start | cells


def select(rows, **wanted):
    """Return the ``rows`` that have these values."""
    return [row for row in rows if all(row[name] == value for name, value in wanted.items())]


def main_box(configuration):
    """Return the parameters "box" and "seed" of a study that is about the first scene."""
    return {"box": configuration.main.box.parameters(), "seed": configuration.seed}
