"""Mean times at several radii of one box, in one object."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
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

    def __init__(self, results):
        self.results = sorted(results, key=lambda result: result.scene.radius)
        self.box, self.settings = Box.of(self.results[0].scene), self.results[0].settings

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

    def more(
        self,
        error: float | str | Mapping[str, float | str] | None = None,
        budget: float | None = None,
        cores: int = 1,
        progress: bool | None = None,
        duration: float | None = None,
    ) -> Scan:
        """Return the scan with more work at each radius, which goes on from this one.

        It is the same, bit for bit, as the result of one call with the new arguments.

        Parameters
        ----------
        error : float, str or dict, optional
            A smaller error.
        budget : float, optional
            A larger budget.
        cores : int, default 1
            Cores to work on.
        progress : bool, optional
            Whether to show a progress bar, as in ``simulate``.
        duration : float, optional
            A longer time, for a scan that has one.

        Returns
        -------
        Scan
            The scan, which includes the work of this one.

        Raises
        ------
        InputError
            For an argument that is not among the ``settings`` of this scan.

        Examples
        --------
        >>> some = td.scan(1.5, 1.0, [0.1, 0.2], duration=1e3, events="any_wall")
        >>> [part["any_wall_time"].count > 1e4 for part in some.more(duration=1e4)]
        [True, True]
        """
        asked = {"cores": cores, "progress": progress, "duration": duration}
        return Scan([result.more(error, budget, **asked) for result in self.results])

    def to_dict(self) -> dict[str, object]:
        """Return the scan as ``save`` writes it.

        Returns
        -------
        dict
            Numbers, texts, lists and dicts.

        Examples
        --------
        >>> content = td.scan(1.5, 1.0, [0.1, 0.2], duration=1e3, events="any_wall").to_dict()
        >>> content["kind"], len(content["results"])
        ('scan', 2)
        """
        return {
            "twodiscs": self.version,
            "kind": self.kind,
            "results": [result.to_dict() for result in self.results],
        }

    def frame(self) -> pd.DataFrame:
        """Return a table of all measurements.

        Returns
        -------
        DataFrame
            One row per radius and quantity, the index, with the columns of mean_times.csv.

        Examples
        --------
        >>> td.scan(1.5, 1.0, [0.1, 0.2], duration=1e3, events="any_wall").frame().index.names
        FrozenList(['radius', 'quantity'])
        """
        import pandas as pd

        rows = [row for result in self.results for row in rows_by_quantity(result.rows)]
        return pd.DataFrame(rows).set_index(["radius", "quantity"])

    def __str__(self) -> str:
        return "\n\n".join(str(result) for result in self.results)

    __repr__ = __str__

    def _repr_html_(self) -> str:
        return "".join(result._repr_html_() for result in self.results)


def joined(results):
    """Return the ``Scan`` of loaded results."""
    return Scan(results)


def scan(
    width, height, radii, error, duration, seed, budget, events, name, cores=1, progress=None,
    effects=None,
):  # fmt: skip
    """Return the ``Scan`` of mean times over ``radii`` (see the face)."""
    box = box_with(width, height, {} if effects is None else effects)
    scenes = scenes_of(box, radii)
    if len({scene.radius for scene in scenes}) < len(scenes):
        raise InputError(
            "radii must differ, because one radius has the same random numbers each time, not "
            f"{quote([scene.radius for scene in scenes])}; to repeat a radius, give another seed"
        )
    asked = error, duration, seed, budget, events, name, cores, progress
    return Scan([simulate(scene, *asked, usual=1e-2) for scene in scenes])
