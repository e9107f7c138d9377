"""What a study is; each declares itself as such in ``studies/<name>/study.py``."""

from collections.abc import Callable
from dataclasses import dataclass, field

from twodiscs.comparison.tables.base import Table


@dataclass(frozen=True)
class Study:
    """An analysis: its ``name``, what its target ``builds``, its ``tables`` and ``figures``.

    The first table is made by its function ``rows``, which takes the ``parameters`` of a
    ``Configuration`` and, as ``tables``, the rows of what it ``reads``: {name: (name of a scene or
    None, table)}. Other tables have rules of their own. If the table takes long it has ``parts``,
    {name: parameters}: jobs of its function ``part``, whose rows are read as tables of these names.

    ``families`` are those of the scenes that it computes.

    ``figures`` are {name: ``Entry``}. ``about_plain`` studies are about scenes without effects.
    ``seconds`` is what the table takes, a round figure or what a ``Configuration`` says. ``timed``
    tables hold seconds, so that they differ from run to run. One that is not ``shared`` is built
    only when asked for; the manuscript brings along all others. The scores z in the first table of
    one that is ``checked`` are part of the check. Pages list studies by their ``order``.
    """

    name: str
    builds: str
    tables: tuple[type[Table], ...]
    seconds: Callable | float
    order: int
    figures: dict = field(default_factory=dict)
    parameters: Callable = lambda configuration: {}
    reads: Callable = lambda configuration: {}
    families: tuple = ("plain", "effects")
    parts: Callable = lambda configuration: {}
    about_plain: bool = True
    timed: tuple = ()
    shared: bool = True
    checked: bool = False


def scaled(budget, divisor, least, most):
    """Return ``budget``/``divisor``, an integer from ``least`` to ``most``."""
    return min(most, max(least, budget // divisor))


def main_box(configuration):
    """Return the parameters "box" and "seed" of a study that is about the first scene."""
    return {"box": configuration.main.box.parameters(), "seed": configuration.seed}
