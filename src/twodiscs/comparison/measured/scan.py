"""Mean times at several radii of one box, in one object."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, overload

from twodiscs.comparison.measured.measurements import (
    Measurements,
    box_with,
    rows_by_quantity,
    scenes_of,
    simulate,
)
from twodiscs.comparison.measured.result import Result
from twodiscs.model.box import Box
from twodiscs.model.checks import InputError, quote

if TYPE_CHECKING:
    import pandas as pd


class Scan(Result, Sequence[Measurements]):
    """A sequence of the mean times at several radii of one box, in the order of radii.

    ``scan`` returns one.

    Parameters
    ----------
    results : list of Measurements
        One for each radius.
    refused : dict, optional
        {radius: why it has no result}, of radii that do not fit.

    Attributes
    ----------
    box : Box
        The box.
    settings : dict
        {argument: value}, the same for each of them.

    Examples
    --------
    >>> found = td.scan(1.5, 1.0, [0.2, 0.1], error=0.05, events="any_wall")
    >>> found.radii, len(found), found[0].scene.radius
    ([0.1, 0.2], 2, 0.1)
    """

    kind = "scan"

    def __init__(self, results, refused=None):
        self.results = sorted(results, key=lambda result: result.scene.radius)
        self.box, self.settings = Box.of(self.results[0].scene), self.results[0].settings
        self.refused = dict(refused or {})

    @property
    def radii(self) -> list[float]:
        """The radii, ascending."""
        return [result.scene.radius for result in self.results]

    @overload
    def __getitem__(self, index: int) -> Measurements: ...
    @overload
    def __getitem__(self, index: slice) -> list[Measurements]: ...
    def __getitem__(self, index):
        return self.results[index]

    def __len__(self) -> int:
        return len(self.results)

    def __iter__(self) -> Iterator[Measurements]:
        return iter(self.results)

    def __eq__(self, other):
        return self.results == other.results if isinstance(other, Scan) else NotImplemented

    def __hash__(self):
        return hash((self.box, *self.radii))

    def _again(self, settings, options):
        return Scan([result._again(settings, options) for result in self], self.refused)

    def to_dict(self) -> dict[str, object]:
        """Return the scan as ``save`` writes it, as ``Measurements.to_dict`` does."""
        return {
            "twodiscs": self.version,
            "kind": self.kind,
            "results": [result.to_dict() for result in self],
            "refused": [*self.refused.items()],
        }

    def frame(self) -> pd.DataFrame:
        """Return a table of all measurements.

        Returns
        -------
        DataFrame
            One row per radius and quantity, the index, with the columns of mean_times.csv. A radius
            that does not fit has one row, whose ``status`` says why.

        Examples
        --------
        >>> td.scan(1.5, 1.0, [0.1, 0.2], duration=1e3, events="any_wall").frame().index.names
        FrozenList(['radius', 'quantity'])
        """
        import pandas as pd

        rows = [row for result in self for row in rows_by_quantity(result.rows)]
        rows += [{"radius": r, "quantity": "", "status": why} for r, why in self.refused.items()]
        return pd.DataFrame(rows).set_index(["radius", "quantity"])

    def __str__(self) -> str:
        return "\n\n".join([*map(str, self), *self.refused.values()])

    def _repr_html_(self) -> str:
        return "".join(result._repr_html_() for result in self)


def joined(content, results):
    """Return the ``Scan`` of loaded results, given the ``content`` of its file."""
    return Scan(results, content["refused"])


def scan(
    width, height, radii, error, duration, seed, budget, events, name, cores=1, progress=None,
    effects=None,
):  # fmt: skip
    """Return the ``Scan`` of mean times over ``radii`` (see the face)."""
    box = box_with(width, height, {} if effects is None else effects)
    scenes, refused = scenes_of(box, radii)
    if len({scene.radius for scene in scenes}) < len(scenes):
        raise InputError(
            "radii must differ, because one radius has the same random numbers each time, not "
            f"{quote([scene.radius for scene in scenes])}; to repeat a radius, give another seed"
        )
    asked = error, duration, seed, budget, events, name, cores, progress
    return Scan([simulate(scene, *asked, usual=1e-2) for scene in scenes], refused)
