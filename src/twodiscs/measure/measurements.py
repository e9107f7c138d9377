"""Results of simulations and samples beside the exact values: objects that print themselves.

Their numbers come from rows of the tables, made by the same functions.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from twodiscs.analysis.tables import (
    AreasTable,
    MeanTimesTable,
    VolumeTable,
    row_quantity,
    shortfall,
)
from twodiscs.measure.exact_values import Quantities, as_list
from twodiscs.measure.result import Immutable, Result, data_frame, note_of_number, work
from twodiscs.model.calls import checked_call, warn
from twodiscs.model.checks import (
    THINNEST_SHELL,
    AccuracyWarning,
    InputError,
    check_choice,
    check_count,
    check_error,
    check_fraction,
    check_integer,
    check_length,
)
from twodiscs.model.formats import did_you_mean, quote, round_up, texts_with_error
from twodiscs.model.scene import Scene, check_scene, why_absent
from twodiscs.points.estimates import Estimate, why_no_error
from twodiscs.points.monte_carlo_point import WALL_AREAS, wall_weights

if TYPE_CHECKING:
    import pandas as pd
    from uncertainties import UFloat

    from twodiscs import Event, Quantity


#: The columns that people read.
TEXT_COLUMNS = ("quantity", "estimate", "± error", "exact", "unit", "z", "count", "status")

#: How a measurement ends; docs/glossary.md says what each word means.
STATUSES = (
    *("reached", "budget", "sampled", "counted", "too-few", "none-seen", "impossible"),
    *("exact", "derived", "extrapolated", "not-resolved"),
)


@dataclass(frozen=True)
class Measurement(Immutable):
    """An estimate of one quantity, beside its exact value.

    ``float(m)`` is the value, ``f"{m:.3f}"`` and ``round(m, 3)`` are those of the value. ``m.u`` is
    a number of the package uncertainties, with which you calculate.

    Parameters
    ----------
    quantity : str
        Its name, as it is printed, as a key and as a column.
    value : float or None
        The estimate, None without an event or hit.
    stderr : float or None
        The standard error, None if there are too few events for one.
    exact : float or None
        The exact value, None if none is known or if the ``status`` is impossible.
    z : float or None
        The deviation of the estimate from the exact value in standard errors; for an area, from the
        exact ``expectation`` of its shell. If events or their clusters are few, it is the normal
        deviate of an upper bound on the probability of the deviation; the column ``test`` of
        ``frame()`` marks these rows. A bound of 1 tests nothing: z is None, prints as "–", and is 0
        in the table.
    count : int
        The number of events, or hits.
    status : str
        How the measurement ended, a word of the glossary; "too-few" if it has no error, see Notes.
    unit : str
        The unit of value, stderr, exact, expectation and bound.
    expectation : float, optional
        The exact expectation of a shell, for an area.
    bound : float, optional
        A lower bound on a mean time at 95 %, if no event was counted.
    source : Measurements or UFloat, optional
        The result that has it, whose quantities are correlated, or the number ``u`` itself.

    Attributes
    ----------
    relative_stderr : float or None
        The standard error over the size of the value.
    u : uncertainties.UFloat
        The value with its error.

    Notes
    -----
    A mean time has an error from 100 replicas and 100 effective events on, of which a cluster
    counts once. Rough discs near a threshold have very many events after a few of the initial
    states; there it also needs enough initial states (``theory.exact.replicas_needed``), a number
    that does not depend on the seed. Anything else needs 100 hits and 100 misses: if discs are so
    small that all of 1048576 draws are hits, the volume has no error.

    Examples
    --------
    >>> v, w = (td.sample(scene, 1e6, seed=n)["volume"] for n in (1, 2))
    >>> difference = v.u - w.u
    >>> abs(difference.nominal_value) < 5 * difference.std_dev
    True
    >>> abs(float(v) - v.exact) < 5 * v.stderr
    True
    """

    quantity: str
    value: float | Any
    stderr: float | Any
    exact: float | Any
    z: float | Any
    count: int
    status: str
    unit: str
    expectation: float | Any = None
    bound: float | Any = None
    source: Measurements | UFloat | None = field(default=None, compare=False)

    def __post_init__(self):
        check_choice("status", self.status, STATUSES)

    @property
    def relative_stderr(self) -> float | Any:
        """The standard error over the size of the value, or None."""
        return self.stderr / abs(self.value) if self.stderr and self.value else None

    def interval(self, confidence: float = 0.95) -> tuple[float, float] | None:
        """Return the normal confidence interval.

        Parameters
        ----------
        confidence : float, default 0.95
            The probability that it covers the true value, between 0 and 1.

        Returns
        -------
        (float, float) or None
            Its ends, None without an error.

        Raises
        ------
        InputError
            For a confidence that is not between 0 and 1.

        Examples
        --------
        >>> volume = td.sample(scene, 1e6, seed=1)["volume"]
        >>> low, high = volume.interval(0.99)
        >>> low < volume.value < high
        True
        """
        return Estimate(self.value, self.stderr, self.count).interval(confidence)

    def __float__(self) -> float:
        if self.value is None:
            raise InputError(f"{self.quantity} must have a value, but its status is {self.status}")
        return float(self.value)

    def __format__(self, spec: str) -> str:
        return format(float(self), spec) if spec else str(self)

    def __round__(self, digits: int | None = None) -> float | int:
        return round(float(self), digits)

    @property
    def u(self) -> Any:  # a UFloat, whose operators have no types
        """The value with its error, a number of the package uncertainties.

        Numbers of one result of ``simulate`` are correlated as their counts are, and numbers of one
        result of ``sample`` as far as their samples tell. Numbers of two results are taken as
        independent: give them two seeds. The error is NaN if it is not known.
        """
        from uncertainties import Variable

        independent = Variable(float(self), math.nan if self.stderr is None else self.stderr)
        if isinstance(self.source, Measurements):
            return self.source.correlated.get(self.quantity, independent)
        return independent if self.source is None else self.source

    def cells(self) -> tuple[str, ...]:
        """Return the texts of a printed line.

        Returns
        -------
        tuple of str
            Quantity, estimate, error, exact value, unit, z, count and status.

        Examples
        --------
        >>> td.sample(scene, 1e6, seed=1)["volume"].cells()
        ('volume', '0.23605', '0.00021', '0.23611', 'length⁴', '-0.31', '568219', 'sampled')
        """
        value, error = texts_with_error(self.value, self.stderr)
        if self.value is None and self.bound is not None:
            value = f"> {self.bound:.4g}"
        if self.exact is None:
            exact = "–" if self.status == "impossible" else "not known"
        else:
            exact = texts_with_error(self.exact, self.stderr)[0]
        z = "–" if self.z is None else f"{self.z:+.2f}"
        return self.quantity, value, error, exact, self.unit, z, str(self.count), self.status

    def __str__(self) -> str:
        _, value, error, exact, unit, z, number, status = self.cells()
        compared = f", exact {exact}" + (f", z = {z}" if self.z is not None else "")
        error, unit = f" ± {error}" if error else "", f" {unit}" if unit else ""
        return f"{self.quantity} = {value}{error}{unit}{compared}, {number} counted, {status}"

    __repr__ = __str__


def derived(quantity, u, exact, unit, count):
    """Return the ``Measurement`` of a number ``u`` of uncertainties, beside its ``exact`` value."""
    error = None if math.isnan(u.std_dev) else u.std_dev
    z = (u.nominal_value - exact) / error if error and exact is not None else None
    return Measurement(quantity, u.nominal_value, error, exact, z, count, "derived", unit, source=u)


def text_table(measurements):
    """Return the texts of ``measurements`` as a ``DataFrame``."""
    return data_frame([one.cells() for one in measurements], TEXT_COLUMNS)


class Measurements(Result, Mapping[str, Measurement]):
    """{quantity: ``Measurement``} of one scene; prints as a table.

    ``simulate`` and ``sample`` return one.

    Parameters
    ----------
    kind : str
        The function that made it.
    scene : Scene
        The scene.
    rows : list of dict
        The rows of the table of its kind, as the pipeline writes it.
    settings : dict
        {argument: value} beside the scene, with the seed and the error that was asked for.
    point : DynamicsPoint or MonteCarloPoint
        The sums of its work, from which it goes on.
    note : str, optional
        The difference between the work that was asked for and the work that was done.

    Attributes
    ----------
    version : str
        The version of the package.

    Examples
    --------
    >>> md = td.simulate(scene, error=0.02, seed=1)
    >>> md.frame().index[0], md.settings["seed"]
    ('vertical_hop_time', 1)
    """

    def __init__(self, kind, scene, rows, settings, point, note=None):
        self.kind, self.scene, self.rows, self.settings = kind, scene, rows, settings
        self.point, self.components, self.note = point, point.components, note
        found = (measurement(scene, row, self) for row in rows)
        self._measurements = Quantities((one.quantity, one) for one in found)

    @cached_property
    def correlated(self) -> dict[str, UFloat]:
        """{quantity: number} of uncertainties, of all quantities with errors from the same sums."""
        from uncertainties import correlated_values

        names, means, covariances = self.point.moments()
        known = [k for k, n in enumerate(names) if n in self and self[n].stderr is not None]
        found = {names[k]: self[names[k]].value for k in known}
        if not found:
            return {}
        # Areas are proportional to their means, times inversely: two signs that change together.
        scales = np.array([*found.values()]) / means[known]
        scaled = covariances[np.ix_(known, known)] * np.outer(scales, scales)
        numbers = correlated_values([*found.values()], scaled)
        by_name = dict(zip(found, numbers, strict=True))
        if {*WALL_AREAS} <= by_name.keys() and "any_wall_area" not in names:
            weights = wall_weights(self.scene)
            by_name["any_wall_area"] = sum(n * by_name[wall] for wall, n in weights.items())
        return by_name

    def __getitem__(self, name: str) -> Measurement:
        return self._measurements[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._measurements)

    def __len__(self) -> int:
        return len(self._measurements)

    def _ipython_key_completions_(self) -> list[str]:
        return list(self)

    def _texts(self) -> pd.DataFrame:
        """Return the texts of the printed table, one row for each quantity."""
        return text_table(self.values())

    def frame(self) -> pd.DataFrame:
        """Return a table of all measurements.

        Returns
        -------
        DataFrame
            One row per quantity, which the index names, with the columns of the pipeline's table:
            mean_times.csv, or volume.csv and areas.csv. The estimate and its error come first, the
            exact value and z last, so that a terminal shows them.

        Examples
        --------
        >>> table = td.simulate(scene, duration=1e3, seed=1).frame()
        >>> table.loc["vertical_hop_time", ["estimate", "stderr", "exact"]].round(3).to_list()
        [1.328, 0.008, 1.338]
        """
        rows = [{"quantity": row_quantity(row)} | row for row in self.rows]
        frame = data_frame(rows, index="quantity")
        first, last = ["estimate", "stderr"], ["exact", "z"]
        return frame[first + [name for name in frame if name not in first + last] + last]


def measurement(scene, row, source=None):
    """Return the ``Measurement`` of a row of a table, which a result ``source`` has."""
    quantity = row_quantity(row)
    # A bound of 1 on the probability has z = 0 in the tables, as a perfect match would have.
    z = row["z"] if row["z"] or row.get("test") == "normal" else None
    return Measurement(
        quantity,
        row["estimate"], row["stderr"], row["exact"], z,
        row["count"] if "count" in row else row["hits"], row["status"], scene.unit(quantity),
        row.get("expectation"), row.get("bound"), source,
    )  # fmt: skip


# The calls -------------------------------------------------------------------------------------


def _named(key, what, names, allowed, scene):
    """Return the ``names`` in the order of ``allowed``, or all that are allowed for None."""
    if names is None:
        return list(allowed)
    found = [names] if isinstance(names, str) else as_list(names)
    if not found:
        wrong = quote(names if found is None else found)
        raise InputError(f"{key} must be some of {', '.join(allowed)}, not {wrong}")
    for name in found:
        hint = why_absent(scene, name) or did_you_mean(name, allowed)
        if not isinstance(name, str) or name not in allowed:
            raise InputError(f"{what} must be one of {', '.join(allowed)}, not {quote(name)}{hint}")
    return [name for name in allowed if name in found]


@checked_call
def simulate(
    scene: Scene,
    error: float | str | Mapping[Event, float | str] | None = None,
    *,
    duration: float | None = None,
    budget: float | None = None,
    events: Event | Iterable[Event] | list[str] | None = None,
    method: str | None = None,
    seed: int = 1,
    name: str | None = None,
    cores: int = 1,
    progress: bool | None = None,
) -> Measurements:
    """Measure mean times by molecular dynamics: {quantity: ``Measurement``}, in time.

    Many independent trajectories start in the invariant measure. Each has the same duration T, a
    power of two that depends on the scene, and from 20 discs on also on a small ``budget``, so that
    100 trajectories fit into it unless the discs are crowded. The mean count in T is exactly T
    times the rate, for every T. Trajectories are added until every relative standard error is below
    ``error``, or ``budget`` events are simulated; with a ``duration``, until that time is
    simulated. ``cost`` measures how long an error takes.

    Trajectories are simulated in blocks of 1024, 2.4e5 events each for a radius of 0.2 in a box
    of 1.5 × 1. Without a ``duration`` the minimum is 32 blocks, 7.7e6 events there, or fewer within
    the ``budget``, but at least one block. If this is more than asked for, the ``note`` of the
    result has the number. For quick results with many discs give ``budget=1e6``, or what the
    warning says if it is too small for an error.

    Parameters
    ----------
    scene : Scene
        The box, the discs and their effects.
    error : float, str or dict, optional
        The relative standard error, above 0 and at most 1, or "draft" (1e-2), "paper" (3e-4) or
        "reference" (1e-4): one for all, or {event: error}. It is 1e-3 if neither ``error`` nor
        ``duration`` is given.
    duration : float, optional
        The simulated time of all trajectories together, in time. It is rounded up to whole blocks.
        All events are then counted in the same trajectories, also rare hops.
    budget : float, optional
        The most wall hits and disc collisions, an integer from 1 on. If left out, the error is
        reached unless it takes about a day.
    events : str or iterable of str, optional
        Events to count, some of ``EVENTS``; if left out, all that exist in the scene.
    method : str, optional
        As ``cost`` names it: "strips" for rare hops where it has them, which is the default there,
        or "dynamics" for all events.
    seed, name, cores, progress : optional
        See ``help(twodiscs)``.

    Returns
    -------
    Measurements
        {quantity: ``Measurement``}; ``more(error=…)`` goes on from it.

    Raises
    ------
    InputError
        For an unknown event, for a number out of range, for both ``error`` and ``duration``, and
        for a ``duration`` with more events than the ``budget``.

    Warns
    -----
    AccuracyWarning
        If the budget ended it before the error was reached. The ``note`` has the same sentence.

    Notes
    -----
    The first call compiles for some seconds; compiled code is kept. Ctrl-C stops a call without
    delay, but a script first ends a compilation, which takes some 10 to 30 s.

    Examples
    --------
    >>> md = td.simulate(scene, error=0.02, seed=1, events="vertical_hop")
    >>> abs(md["vertical_hop_time"].z) < 5
    True
    >>> td.simulate(scene, duration=1e4, seed=1)["any_wall_time"].count > 1e4
    True
    """
    if error is None and duration is None:
        error = 1e-3
    settings = error, budget, seed, name, duration, events, method
    return make_simulation(scene, *settings, cores=cores, progress=progress)


def make_simulation(
    scene, error, budget, seed, name, duration=None, events=None, method=None, **how
):
    """Return the ``Measurements`` of the arguments of ``simulate``; ``how`` is for ``work``."""
    possible, timed = check_scene(scene).events, duration is not None
    if timed and error is not None:
        raise InputError("error and duration must not both be given: leave out one of them")
    events, error = _targets(error, "events", "event", events, possible, scene)
    budget = None if budget is None else check_count("budget", budget)
    settings = {"seed": check_integer("seed", seed, 0), "budget": budget, "error": error}
    settings |= {"events": events, "name": name, "method": method}
    if timed:
        settings["duration"] = check_length("duration", duration)
    from twodiscs.dynamics.runs import DynamicsRun

    point = work("simulate", DynamicsRun.of(scene, settings), **how)
    rows = MeanTimesTable.rows([point])
    if timed:
        done, note = point.replicas * point.duration, None
        if done != duration:
            note = (
                f"You asked for a duration of {duration:g} and got {done:g}: {point.replicas} "
                f"trajectories of {point.duration:g} each."
            )
    else:
        named = "wall hits and collisions"
        note = _note_of_error(rows, rows, budget, point.events, "events", named)
    return Measurements("simulate", scene, rows, settings, point, note)


def _targets(error, key, what, names, allowed, scene):
    """Return (the ``names`` that are asked for, the relative error, None without one).

    The ``error`` is one for all or {name: error}; ``key`` is the argument that has the names, and
    ``what`` each of them is.
    """
    if not isinstance(error, Mapping):
        names = _named(key, what, names, allowed, scene)
        return names, None if error is None else check_error("error", error)
    if not error:
        raise InputError(f"error must hold some of {', '.join(allowed)}, not {{}}")
    names = _named(key, what, [*error] if names is None else names, allowed, scene)
    if missing := [name for name in names if name not in error]:
        raise InputError(f"error must have a value for every {what}, but has none for {missing[0]}")
    return names, {name: check_error("error", error[name]) for name in names}


def _note_of_error(rows, short, budget, work, what, named):
    """Return the note of a run to an error, None if there is nothing to say.

    A warning has the error of ``short`` rows that the ``budget`` kept it from. Otherwise the note
    says that the minimum work is far more than was asked for. The run did ``work``, a number of
    ``what``; a note has them ``named`` exactly.
    """
    minimum, note = f"{round_up(work)} {named}", None
    possible = [row for row in rows if row["status"] != "impossible"]
    if budget and work > 2 * budget:
        note = f"You asked for a budget of {budget:g}, but the smallest run has {minimum}."
    elif possible and all(
        row["relative_stderr"] and row["relative_stderr"] < row["target"] / 2 for row in possible
    ):
        reached = max(row["relative_stderr"] for row in possible)
        asked = min(row["target"] for row in possible)
        done = f"You asked for an error of {asked:g} and got {reached:.2g}, because"
        note = f"{done} the smallest run has {minimum}. For a shorter run pass a smaller budget."
    if missed := shortfall(short, budget, work, what=what):
        warn(missed, AccuracyWarning)
    return note or missed


@checked_call
def sample(
    scene: Scene,
    samples: float | None = None,
    *,
    error: float | str | Mapping[Quantity, float | str] | None = None,
    budget: float | None = None,
    quantities: Quantity | Iterable[Quantity] | list[str] | None = None,
    shell: float = 0.02,
    method: str | None = None,
    seed: int = 1,
    name: str | None = None,
    cores: int = 1,
    progress: bool | None = None,
) -> Measurements:
    """Measure volume and areas of configuration space by Monte Carlo: {quantity: ``Measurement``}.

    Areas are estimated by shells: z compares with the exact expectation of the shell. The number of
    ``samples`` is given, or follows from an ``error``, in rounds as in ``simulate``.

    Parameters
    ----------
    scene : Scene
        The box, the discs and their effects.
    samples : float, optional
        Configurations to draw, an integer from 1 on; 1e7 if neither ``samples`` nor ``error`` is
        given. It is rounded up to whole blocks, of 2²⁰ for two plain discs. If these hardly fit,
        conditioned samples take their place, each for 64. ``note`` of the result has the number
        that was drawn.
    error : float, str or dict, optional
        The relative standard error instead, as in ``simulate``: one for all, or {quantity: error}.
        The minimum is 32 blocks, or fewer within the ``budget``.
    budget : float, optional
        With an ``error``, the most samples, an integer from 1 on. If left out, the error is reached
        unless it takes about a day.
    quantities : str or iterable of str, optional
        Some of "volume" and "<event>_area"; all if left out.
    shell : float, default 0.02
        The thickness of a shell, between 1e-6 and 1, as a fraction of the radius or, if that is
        smaller, of the distance to the radius at which the surface vanishes.
    method : str, optional
        As ``cost`` names it: "rejection" or, for plain discs, "conditioned"; "insertions" for more
        than two. If left out, the fastest one. Compare methods with different seeds.
    seed, name, cores, progress : optional
        See ``help(twodiscs)``.

    Returns
    -------
    Measurements
        {quantity: ``Measurement``}, for two discs in length⁴ and length³, for balls in length⁶ and
        length⁵, for N discs in length²ᴺ and length²ᴺ⁻¹; ``more(samples=…)``, or ``more(error=…)``,
        goes on from it.

    Raises
    ------
    InputError
        For an unknown quantity or method, for a number out of range, for both ``samples`` and
        ``error``, and for a ``budget`` without an ``error``.

    Warns
    -----
    AccuracyWarning
        If the budget ended it before the error was reached.

    Examples
    --------
    >>> volume = td.sample(scene, 1e6, seed=1, quantities="volume")["volume"]
    >>> abs(volume.value - td.volume(scene)) < 5 * volume.stderr
    True
    """
    settings = quantities, shell, seed, name, samples, error, budget, method
    return make_sampling(scene, *settings, cores=cores, progress=progress)


def make_sampling(
    scene, quantities, shell, seed, name, samples=None, error=None, budget=None, method=None, **how
):
    """Return the ``Measurements`` of the arguments of ``sample``; ``how`` is for ``work``."""
    if error is not None and samples is not None:
        raise InputError("samples and error must not both be given: leave out one of them")
    if error is None and budget is not None:
        raise InputError("budget must be left out without an error: samples is the number to draw")
    allowed = ("volume", *(f"{event}_area" for event in check_scene(scene).events))
    quantities, error = _targets(error, "quantities", "quantity", quantities, allowed, scene)
    settings = {"seed": check_integer("seed", seed, 0), "quantities": quantities, "name": name}
    settings |= {"method": method, "shell": check_fraction("shell", shell, THINNEST_SHELL)}
    if error is None:
        settings["samples"] = check_count("samples", 10**7 if samples is None else samples)
    else:
        budget = None if budget is None else check_count("budget", budget)
        settings |= {"error": error, "budget": budget}
    from twodiscs.sampling.montecarlo import PROPOSAL_TIME, MonteCarloRun

    run = MonteCarloRun.of(scene, settings)
    point = work("sample", run, **how)
    rows = VolumeTable.rows([point]) + AreasTable.rows([point])
    # Insertions always have the volume.
    rows = [row for row in rows if row["quantity"] in quantities]
    if error is None:
        fewer = f"a conditioned sample is as much work as {PROPOSAL_TIME} ordinary ones"
        note = note_of_number("samples", settings["samples"], point.samples, fewer)
    else:
        for row in rows:
            known = row["stderr"] and row["stderr"] / row["estimate"]
            row["target"], row["relative_stderr"] = run.target[row["quantity"]], known
            if row["status"] == "sampled":
                row["status"] = "reached" if known <= row["target"] else "budget"
        # No budget ended a run with too few misses, whose binomial error is small.
        short = [r for r in rows if r["status"] != "too-few" or why_no_error(r["hits"], "hits")]
        drawn = point.samples * run.weight
        note = _note_of_error(rows, short, budget, drawn, "samples", "samples")
    return Measurements("sample", scene, rows, settings, point, note)


Measurements.makers = {"simulate": make_simulation, "sample": make_sampling}
