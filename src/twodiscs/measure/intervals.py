"""The intervals between hops of one kind: their mean, bins, and density at 0."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from twodiscs.analysis.tables import HopHistogramTable
from twodiscs.measure.measurements import Measurement, text_table
from twodiscs.measure.result import Result, data_frame, note_of_number, work
from twodiscs.model.calls import checked_call, warn
from twodiscs.model.checks import (
    AccuracyWarning,
    InputError,
    check_choice,
    check_count,
    check_error,
    check_integer,
    check_numbers,
)
from twodiscs.model.events import HOPS
from twodiscs.model.formats import format_number, round_up
from twodiscs.model.scene import Scene, check_scene
from twodiscs.points.estimates import why_no_error
from twodiscs.points.intervals_point import wide_edges
from twodiscs.theory import laws

if TYPE_CHECKING:
    import pandas as pd

    from twodiscs import Hop

#: Bins resolve how the density of intervals begins if a pair of discs has at most this mean number
#: of wall hits and collisions in one bin. At .23 to .39 events, extrapolations deviate by less than
#: 0.5 % from the exact density; at .43 to .77 by up to 3 %, at 1.6 by 3 %, at 4.2 by 35 %.
RESOLVED_EVENTS = 0.4


class Intervals(Result):
    """The distribution of the intervals between hops of one kind; ``intervals`` returns one.

    Parameters
    ----------
    scene : Scene
        The scene.
    point : IntervalsPoint
        The counts, as the pipeline keeps them.
    settings : dict
        {argument: value} beside the scene.

    Attributes
    ----------
    hop : str
        "vertical_hop" or "horizontal_hop".
    intervals : int
        The number of intervals.
    overflow : int
        The number of intervals outside of the bins.
    edges : list of float, length n + 1
        The ends of the bins, in time.
    counts : list of int, length n
        The intervals in each bin.
    mean : Measurement
        The mean interval, in time.
    at_zero : Measurement
        The density of short intervals, in 1/time.

    Notes
    -----
    The exact density at 0 is known in plain scenes. Its estimate is extrapolated by a parabola
    through the first two bins, so it has no z. For more than two discs it is a straight line,
    because another pair may hop next. It needs two equal bins from 0 on, with ``RESOLVED_EVENTS``
    of the pair or fewer in each. Without them, as in points of a build near a threshold,
    ``at_zero`` has no value and the status "not-resolved". Intervals of one chain are correlated,
    so all errors come from the spread between chains. If discs are tiny or hardly fit, a few long
    intervals make the errors skew. In four such scenes 65536 intervals gave scores with a mean of
    -0.20 and -4.2 as the worst of 1200; 262144 gave -0.08, a mean square of 0.97, and -3.8 as the
    worst of 800. Ask for 262144 intervals there.

    Examples
    --------
    >>> times = td.intervals(scene, "vertical_hop", 1e5, seed=1)
    >>> sum(times.counts) + times.overflow == times.intervals
    True
    """

    hop: str
    intervals: int
    overflow: int
    edges: list[float]
    counts: list[int]
    mean: Measurement
    at_zero: Measurement

    kind = "intervals"

    def __init__(self, scene, point, settings):
        self.scene, self.hop, most = scene, point.event, resolved_width(scene)
        self.settings, self.components = settings, point.components
        self.intervals, self.overflow = point.intervals, point.overflow
        number = settings.get("number", self.intervals)
        self.note = note_of_number("intervals", number, self.intervals)
        reached, asked = point.stderr / point.mean, settings.get("error")
        if asked is not None and reached > asked:
            self.note = (
                f"You asked for an error of {format_number(asked, 'g')} of the mean, but the "
                f"budget of {format_number(settings['budget'], 'g')} events ended the run at "
                f"{round_up(reached)}."
            )
        self.rows = HopHistogramTable.rows([point])
        self.counts = point.equal.counts
        # Wide bins, which points of a build have, follow the others and have the same intervals.
        self._bins = self.rows[: len(self.counts)]
        self.edges = [row["left"] for row in self._bins] + [self._bins[-1]["right"]]
        first, z = self.rows[0], self.rows[0]["z"]
        status = "sampled" if first["mean_stderr"] else "too-few"
        self.mean = Measurement(
            f"{self.hop}_interval", point.mean, first["mean_stderr"], first["exact_mean"], z,
            point.intervals, status, "time",
        )  # fmt: skip
        exact = laws.density_at_zero(scene, self.hop) if scene.is_plain else None
        at_zero, error, status = None, None, "not-resolved"
        width = self.edges[1]
        if self.edges[:3] == [0, width, 2 * width] and width <= most:
            density, status = point.density_at_zero, "extrapolated"
            at_zero, error = density.value, density.stderr
            if why_no_error(min(self.counts[:2]), "intervals"):
                error, status = None, "too-few"
        values = at_zero, error, exact, None, sum(self.counts[:2]), status, "1/time"
        self.at_zero = Measurement("density_at_zero", *values)

    def _texts(self) -> pd.DataFrame:
        """Return the texts of the printed table: the mean and the density at 0."""
        return text_table([self.mean, self.at_zero])

    @property
    def density(self) -> list[float]:
        """The density of each bin, a list, in 1/time."""
        return [row["density"] for row in self._bins]

    def frame(self) -> pd.DataFrame:
        """Return the bins as a table.

        Returns
        -------
        DataFrame
            One row per bin, by its left end, with the columns right, count, density and stderr.

        Examples
        --------
        >>> bins = td.intervals(scene, "vertical_hop", 1e5, seed=1).frame()
        >>> list(bins.columns)
        ['right', 'count', 'density', 'stderr']
        """
        names = "left", "right", "count", "density", "stderr"
        return data_frame([{n: row[n] for n in names} for row in self._bins], index="left")


def resolved_width(scene):
    """Return the width of a bin in which a pair of discs has ``RESOLVED_EVENTS`` on average."""
    from twodiscs.dynamics.engine import find_engine

    return RESOLVED_EVENTS * scene.discs / 2 / find_engine(scene).rates.expected_event_rate(scene)


def resolving_edges(scene, hop):
    """Return edges of bins that resolve the start and widen in proportion to time, to 32 τ."""
    from twodiscs.dynamics.engine import find_engine

    mean = find_engine(scene).intervals.mean_interval(scene, hop)
    width = 2.0 ** math.floor(math.log2(min(mean / 16, resolved_width(scene))))
    return [width * edge for edge in wide_edges(32 * mean / width)]


@checked_call
def intervals(
    scene: Scene,
    hop: Hop,
    number: float | None = None,
    *,
    error: float | str | None = None,
    bins: Iterable[float] | None = None,
    seed: int = 1,
    name: str | None = None,
    cores: int = 1,
    progress: bool | None = None,
) -> Intervals:
    """Draw intervals between hops of one kind: their mean, bins and density at 0.

    Parameters
    ----------
    scene : Scene
        The box, the smooth discs and their effects.
    hop : str
        "vertical_hop" or "horizontal_hop"; for more than two discs a hop of any pair.
    number : float, optional
        Intervals to draw, an integer from 1 on; 1e6 if there is no ``error``. It is rounded up to
        whole blocks of 2¹⁶ (for more than two discs a block has about 2¹⁶ to 2¹⁷), within 1e11
        events; ``note`` of the result has the number that was drawn.
    error : float or str, optional
        The relative standard error of the mean instead, as in ``simulate``.
    bins : iterable of float, optional
        The edges of the bins, ascending from 0 or more, in time. If left out, the first bins
        resolve how the density begins, and later ones are 8 % of their time wide, to 32 mean times.
        Points of a build have 512 equal bins instead, about as wide as 1/16 of the mean.
    seed, name, cores, progress : optional
        See ``help(twodiscs)``.

    Returns
    -------
    Intervals
        Times are in time, densities in 1/time; ``more(number=…)`` goes on from it.

    Raises
    ------
    InputError
        For a blocked hop, for both ``number`` and ``error``, for edges that do not ascend, for
        rough discs without friction, and for more than two discs if it is not known whether they
        can hop.

    Warns
    -----
    AccuracyWarning
        If 1e11 events end the run before it has the ``error``.

    Examples
    --------
    >>> abs(td.intervals(scene, "vertical_hop", 1e5, seed=1).mean.z) < 5
    True
    """
    settings = hop, seed, name, number, error, bins
    return make_intervals(scene, *settings, cores=cores, progress=progress)


#: The bins of a point of a build.
EQUAL_BINS = ("equal",)


def make_intervals(
    scene, hop, seed, name, number=None, error=None, bins=EQUAL_BINS, budget=None, **how
):
    """Return the ``Intervals`` of the arguments of ``intervals``; ``how`` is for ``work``.

    A point of a build also has a ``budget``, the largest number of wall hits and collisions.
    """
    check_choice("hop", hop, HOPS)
    if check_scene(scene).moment_of_inertia is not None and not scene.friction:
        raise InputError(
            "scene must have smooth discs, because rough discs in a box are not ergodic and their "
            f"intervals have no exact mean, but moment_of_inertia is {scene.moment_of_inertia!r}"
        )
    if number is not None and error is not None:
        raise InputError("number and error must not both be given: leave out one of them")
    from twodiscs.dynamics.ensemble import MOST_RUN_EVENTS
    from twodiscs.dynamics.runs import IntervalsRun

    settings = {"hop": hop, "seed": check_integer("seed", seed, 0), "name": name}
    if error is None:
        settings["number"] = check_count("number", 10**6 if number is None else number)
    else:
        settings["error"] = check_error("error", error)
    settings["budget"] = check_count("budget", MOST_RUN_EVENTS if budget is None else budget)
    run = IntervalsRun.of(scene, settings)
    if bins is not EQUAL_BINS:
        bins = resolving_edges(scene, hop) if bins is None else bins
        settings["bins"] = check_numbers(
            "bins", bins, "two or more ascending edges from 0 on",
            lambda t: t.size > 1 and t[0] >= 0 and t[-1] < np.inf and np.all(np.diff(t) > 0),
        ).tolist()  # fmt: skip
        run = replace(run, edges=settings["bins"])
    found = Intervals(scene, work("intervals", run, **how), settings)
    if found.note and error is not None:
        warn(found.note, AccuracyWarning)
    return found


Intervals.makers = {"intervals": make_intervals}
