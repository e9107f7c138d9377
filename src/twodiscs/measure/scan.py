"""Results in several scenes, in one object: at several radii, with several effects."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from html import escape
from itertools import product
from typing import TYPE_CHECKING, Any, Unpack

from twodiscs.measure.exact_values import as_list, fitting_scenes
from twodiscs.measure.measurements import make_simulation
from twodiscs.measure.result import Result, data_frame
from twodiscs.model.calls import checked_call
from twodiscs.model.checks import InputError
from twodiscs.model.formats import quote
from twodiscs.model.scene import Box, Scene
from twodiscs.model.seeds import job_seed

if TYPE_CHECKING:
    import pandas as pd

    from twodiscs import Event, Scanned


class Scan(Result, Sequence[Result]):
    """A sequence of results of one function in several scenes, in the order of radii.

    ``scan`` returns one.

    Parameters
    ----------
    results : list of Measurements, or of other results
        One for each scene.
    refused : dict, optional
        {values of the ``parameters``: why it has no result}, of scenes that do not fit.
    parameters : tuple of str, optional
        The names of what is scanned: the radius, and others.

    Attributes
    ----------
    settings : dict
        {argument: value} of the first of them.

    Examples
    --------
    >>> found = td.scan(1.5, 1.0, [0.2, 0.1], error=0.05, events="any_wall")
    >>> found.radii, len(found), found[0].scene.radius
    ([0.1, 0.2], 2, 0.1)
    """

    kind = "scan"

    def __init__(self, results, refused=None, parameters=("radius",)):
        self.results = sorted(results, key=lambda result: result.scene.radius)
        self.settings, self.parameters = self.results[0].settings, tuple(parameters)
        self.refused = dict(refused or {})

    @property
    def radii(self) -> list[float]:
        """The radii of the results, ascending."""
        return [result.scene.radius for result in self.results]

    def __getitem__(self, index: Any) -> Any:
        return self.results[index]

    def __len__(self) -> int:
        return len(self.results)

    def __eq__(self, other):
        return self.results == other.results if isinstance(other, Scan) else NotImplemented

    def _again(self, larger, **how):
        results = [result._again(larger, **how) for result in self]
        return Scan(results, self.refused, self.parameters)

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
            "parameters": [*self.parameters],
            "results": [result.to_dict() for result in self],
            "refused": [[[*values], why] for values, why in self.refused.items()],
        }

    def frame(self) -> pd.DataFrame:
        """Return a table of all results.

        Returns
        -------
        DataFrame
            The rows of ``frame()`` of each result. Its index has the radius, each other parameter
            that is scanned, and the index of a result, such as the quantity; ``reset_index()``
            makes columns of them. A scene that does not fit has one row without numbers; its
            quantity is "does not fit", and its ``status`` says why.

        Examples
        --------
        >>> found = td.scan(1.5, 1.0, 0.2, duration=1e3, events="any_wall", field=[0, 0.5])
        >>> found.frame().index.names
        FrozenList(['radius', 'field', 'quantity'])
        """
        rows, index = [], self[0].frame().index.name
        for result in self:
            known = {name: getattr(result.scene, name) for name in self.parameters}
            rows += [known | row for row in result.frame().reset_index().to_dict("records")]
        for values, why in self.refused.items():
            row = {name: "" for name, value in rows[0].items() if isinstance(value, str)}
            row |= {index: "does not fit" if index == "quantity" else math.nan, "status": why}
            rows.append(dict(zip(self.parameters, values, strict=True)) | row)
        return data_frame(rows, index=[*self.parameters, index])

    def __str__(self) -> str:
        return "\n\n".join([*map(str, self), *self.refused.values()])

    def _repr_html_(self) -> str:
        refused = (f"<p>{escape(why)}</p>" for why in self.refused.values())
        return "".join([*(result._repr_html_() for result in self), *refused])


@checked_call
def scan(
    width: float | Iterable[float],
    height: float | Iterable[float],
    radii: float | Iterable[float],
    error: float | str | Mapping[Event, float | str] | None = None,
    *,
    measure: Callable[[Scene], Result] | None = None,
    duration: float | None = None,
    seed: int = 1,
    budget: float | None = None,
    events: Event | Iterable[Event] | list[str] | None = None,
    name: str | None = None,
    cores: int = 1,
    progress: bool | None = None,
    **effects: Unpack[Scanned],
) -> Scan:
    """Measure mean times, or anything else, in several scenes: radii, sides and effects.

    Each number of a ``Scene`` may be a list: all combinations are measured.

    Parameters
    ----------
    width, height : float or iterable of float
        Sides of the box, in length, from 1e-60 to 1e60.
    radii : float or iterable of float
        Radii of disc 1, in length, all different.
    error : float, str or dict, optional
        As in ``simulate``, but 1e-2 if neither ``error`` nor ``duration`` is given.
    measure : callable, optional
        ``measure(scene)`` returns a result of another function, such as ``lambda scene:
        td.diffusion(scene, [1, 2])``. The arguments from ``error`` to ``progress`` are then left
        out.
    duration : float, optional
        The simulated time in each scene, as in ``simulate``.
    seed : int, default 1
        Seed of the random numbers, from 0 to 2⁶³ − 1. Each scene has different random numbers.
    budget : float, optional
        The most wall hits and disc collisions in each scene, as in ``simulate``.
    events : str or iterable of str, optional
        Events to count, some of ``EVENTS``; if left out, all that exist in the scene.
    name : str, optional
        The name of a scene in a configuration, which has one box.
    cores, progress : optional
        See ``help(twodiscs)``.
    **effects
        The effects and ``discs`` of ``Scene``; each number of them may be a list.

    Returns
    -------
    Scan
        A sequence of ``Measurements``, or of other results, in the order of radii, whose errors are
        independent. ``plot`` draws those of one box beside the exact curves; ``frame()`` is a
        table.

    Raises
    ------
    InputError
        As ``simulate``, for equal values of a parameter, for an unknown effect, and for an average
        of ``observe`` that has the name of a parameter.

    Examples
    --------
    >>> found = td.scan(1.5, 1.0, [0.1, 0.2], error=0.05, events="any_wall")
    >>> [abs(part["any_wall_time"].z) < 5 for part in found]
    [True, True]
    """
    box = {"width": width, "height": height, **effects}
    scanned = {n: found for n in box if n != "periodic" and (found := as_list(box[n])) is not None}
    if empty := [key for key, values in scanned.items() if not values]:
        raise InputError(f"{empty[0]} must have at least one value, but has none")
    boxes = [Box(**box | dict(zip(scanned, v, strict=True))) for v in product(*scanned.values())]
    scenes, refused = fitting_scenes(boxes, radii)
    if len({job_seed(scene, "dynamics", seed, name) for scene in scenes}) < len(scenes):
        values = map(quote, [[scene.radius for scene in scenes], *scanned.values()])
        raise InputError(
            f"{' and '.join(['radii', *scanned])} must differ, because one scene, or one name with "
            f"one radius, has the same random numbers each time, not {' and '.join(values)}; to "
            "repeat one, give another seed"
        )
    names = events if (listed := as_list(events)) is None else listed
    asked = {"error": error, "duration": duration, "budget": budget, "events": names}
    asked |= {"seed": seed, "name": name, "cores": cores, "progress": progress}
    if measure is None:
        asked["error"] = 1e-2 if error is None and duration is None else error
    elif [*asked.values()] != [None, None, None, None, 1, None, 1, None] or not callable(measure):
        raise InputError(
            "measure must be a function of a scene, without error, duration, seed, budget, events, "
            f"name, cores and progress, which it gives to what it calls, not {quote(measure)}"
        )
    results, names = [], ("radius", *scanned)
    for scene in scenes:
        result = measure(scene) if measure else make_simulation(scene, **asked)
        known = isinstance(result, Result) and not isinstance(result, Scan)
        if not known or (result.scene, result.kind) != (scene, (results or [result])[0].kind):
            raise InputError(
                "measure must return a result of its scene, of one function such as diffusion or "
                f"sample, not {quote(result)}"
            )
        if taken := [name for name in getattr(result, "names", ()) if name in names]:
            raise InputError(f"no average may have the name {taken[0]}, which is scanned")
        results.append(result)
    return Scan(results, {tuple(of[n] for n in names): why for of, why in refused}, names)
