"""Mean times at several radii of one box, in one object."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Unpack, overload

from twodiscs.measure.exact_values import fitting_scenes
from twodiscs.measure.measurements import Measurements, rows_by_quantity, run_simulation
from twodiscs.measure.result import Result
from twodiscs.model.calls import checked_call
from twodiscs.model.checks import InputError
from twodiscs.model.formats import quote
from twodiscs.model.scene import Box

if TYPE_CHECKING:
    import pandas as pd

    from twodiscs import Effects, Event


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
        self.box, self.settings = self.results[0].scene.box, self.results[0].settings
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

    def __eq__(self, other):
        return self.results == other.results if isinstance(other, Scan) else NotImplemented

    def __hash__(self):
        return hash((self.box, *self.radii))

    def _again(self, settings, options):
        return Scan([result._again(settings, options) for result in self], self.refused)

    def to_dict(self) -> dict[str, object]:
        """Return the scan as ``save`` writes it.

        Returns
        -------
        dict
            Numbers, texts, lists and dicts.

        Examples
        --------
        >>> td.scan(1.5, 1.0, [0.1], error=0.1).to_dict()["kind"]
        'scan'
        """
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


@checked_call
def scan(
    width: float,
    height: float,
    radii: Iterable[float],
    error: float | str | Mapping[Event, float | str] | None = None,
    *,
    duration: float | None = None,
    seed: int = 1,
    budget: float | None = None,
    events: Event | Iterable[Event] | Iterable[str] | None = None,
    name: str | None = None,
    cores: int = 1,
    progress: bool | None = None,
    **effects: Unpack[Effects],
) -> Scan:
    """Measure mean times by molecular dynamics at several ``radii`` of a box.

    Parameters
    ----------
    width, height : float
        Sides of the box, in length, from 1e-60 to 1e60.
    radii : iterable of float
        Radii of disc 1, in length, all different.
    error : float, str or dict, optional
        As in ``simulate``, but 1e-2 if neither ``error`` nor ``duration`` is given.
    duration : float, optional
        The simulated time at each radius, as in ``simulate``.
    seed : int, default 1
        Seed of the random numbers, from 0 to 2⁶³ − 1. Each radius has different random numbers.
    budget : float, optional
        The most wall hits and disc collisions at each radius, as in ``simulate``.
    events : str or iterable of str, optional
        Events to count, some of ``EVENTS``; if left out, all that exist in the scene.
    name, cores, progress : optional
        See ``help(twodiscs)``.
    **effects
        The effects and ``discs`` of ``Scene``.

    Returns
    -------
    Scan
        A sequence of ``Measurements`` in the order of radii, whose errors are independent. ``plot``
        draws it beside the exact curves, and ``frame()`` is a table.

    Raises
    ------
    InputError
        As ``simulate``, for equal radii, and for an unknown effect.

    Examples
    --------
    >>> found = td.scan(1.5, 1.0, [0.1, 0.2], error=0.05, events="any_wall")
    >>> [abs(part["any_wall_time"].z) < 5 for part in found]
    [True, True]
    """
    box = Box(width, height, **effects)
    scenes, refused = fitting_scenes(box, radii)
    if len({scene.radius for scene in scenes}) < len(scenes):
        raise InputError(
            "radii must differ, because one radius has the same random numbers each time, not "
            f"{quote([scene.radius for scene in scenes])}; to repeat a radius, give another seed"
        )
    if error is None and duration is None:
        error = 1e-2
    asked = error, duration, seed, budget, events, name, cores, progress
    return Scan([run_simulation(scene, *asked) for scene in scenes], refused)
