"""States of the invariant measure, and averages over it of the values of a user's function."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from twodiscs.dynamics.averages import ObserveRun, check_times
from twodiscs.measure.result import Result, data_frame, note_of_number, progress_bar, work
from twodiscs.model.calls import checked_call
from twodiscs.model.checks import InputError, check_count
from twodiscs.model.formats import format_number, quote, texts_with_error
from twodiscs.model.scene import Scene, check_scene
from twodiscs.model.seeds import job_seed
from twodiscs.sampling.initial_states import (
    MOST_NUMBERS,
    components,
    given_states,
    make_records,
    states,
)
from twodiscs.sampling.rounds import FinishedComponents

if TYPE_CHECKING:
    import pandas as pd

    from twodiscs import Axis

    Function = Callable[[np.ndarray, np.ndarray], Any]


@checked_call
def starts(
    scene: Scene,
    number: float,
    *,
    seed: int = 1,
    name: str | None = None,
    progress: bool | None = None,
) -> np.ndarray:
    """Draw independent states of the invariant measure: an array with named columns.

    If N discs are too dense for rejection, each state is the end of a chain of trial moves.

    Parameters
    ----------
    scene : Scene
        The box, the discs and their effects.
    number : float
        The number of states, an integer from 1 to 1.5e7 for two plain discs. All states together
        have at most 1.2e8 numbers.
    seed, name, progress : optional
        See ``help(twodiscs)``.

    Returns
    -------
    structured array, shape (number,)
        Fields x1, y1, x2, y2 are the centres, from the centre of the box; u1, v1, u2, v2 are the
        velocities. Balls also have z1, z2, w1, w2, and rough discs s1, s2, the speeds of their
        surfaces. N discs have x1 … xN, then y, u, v and, if they are rough, s.

    Raises
    ------
    InputError
        For a number out of range, and if initial states cannot be drawn.

    Examples
    --------
    >>> states = td.starts(scene, 1000, seed=1)
    >>> bool(abs(states["x1"].mean()) < 5 * 0.32 / 1000**0.5)  # the centre of the box is the mean
    True
    """
    most = MOST_NUMBERS // len(components(check_scene(scene)))
    number = check_count("number", number, most=most)
    seed = job_seed(scene, "trajectory", seed, name)

    with progress_bar(progress, f"starts r = {scene.radius:g}") as progress:
        return make_records(scene, states(scene, number, seed, progress=progress))


@checked_call
def frames(
    scene: Scene,
    times: float | Iterable[float],
    number: float,
    *,
    seed: int = 1,
    name: str | None = None,
    cores: int = 1,
    progress: bool | None = None,
) -> np.ndarray:
    """Return the states of many replicas at given times: an array with named fields.

    The replicas are those of ``observe`` with the same seed: independent trajectories that start in
    the invariant measure.

    Parameters
    ----------
    scene : Scene
        The box, the discs and their effects.
    times : float or iterable of float
        Ascending, from 0 on, in time.
    number : float
        The number of replicas, an integer from 1 on. All states together have at most 1.2e8
        numbers.
    seed, name, cores, progress : optional
        See ``help(twodiscs)``.

    Returns
    -------
    structured array, shape (number, times, discs)
        Fields x and y are the centres, from the centre of the box and beyond the cell on periodic
        axes; u and v are the velocities. Balls also have z and w, and rough discs s, the speed of
        the surface. ``frames(…).view((float, 4))`` is a plain array (number, times, discs, 4).
        ``numpy.save`` writes it.

    Raises
    ------
    InputError
        For a number out of range, and for times of more than 10⁷ events and kicks.

    Examples
    --------
    >>> found = td.frames(scene, [0, 1, 2], 100, seed=1)
    >>> found.shape, found.dtype.names
    ((100, 3, 2), ('x', 'y', 'u', 'v'))
    >>> found["x"].mean(axis=(0, 2)).shape  # an average at each time
    (3,)
    """
    seed, times = job_seed(scene, "observe", seed, name), check_times(times)
    most = max(1, MOST_NUMBERS // (len(components(scene)) * times.size))
    run = ObserveRun(scene, seed, times, check_count("number", number, most=most), None)

    with progress_bar(progress, f"frames r = {scene.radius:g}") as progress:
        return run.frames(progress, cores)


@dataclass(frozen=True, eq=False, repr=False)
class Observed(Result):
    """Averages over independent replicas of the invariant measure of one scene.

    ``observe`` and ``diffusion`` return one.

    Parameters
    ----------
    kind : str
        "observe" or "diffusion".
    scene : Scene
        The scene.
    times : array, shape (times,)
        The times, ascending, in time.
    mean, stderr : array, shape (times, …)
        Averages and their standard errors in the unit of the function. After the first axis they
        have the shape of its value for one replica.
    replicas : int
        The number of independent trajectories.
    settings : dict
        {argument: value}; of a function its name.
    components : dict
        The sums of its run, from which it goes on.
    note : str, optional
        The number of replicas that was asked for, if more were simulated.
    names : tuple of str, optional
        The names of the averages, in the order of ``mean``.
    function : callable or dict, optional
        The function that was observed; None for a result from a file, which does not hold it.

    Examples
    --------
    >>> found = td.observe(scene, {"x": lambda start, now: now["x1"]}, [0, 1], 4096, seed=1)
    >>> found.frame().columns.to_list()
    ['x', 'x_stderr']
    """

    kind: str
    scene: Scene
    times: np.ndarray
    mean: np.ndarray
    stderr: np.ndarray
    replicas: int
    settings: dict[str, object]
    components: dict[str, dict]
    note: str | None = None
    names: tuple[str, ...] = ()
    function: Callable | Mapping[str, Callable] | None = None

    sums = float

    def _again(self, larger, **how):
        if "function" in self.settings:
            larger = {"function": self.function} | larger
        return super()._again(larger, **how)

    @property
    def rows(self) -> list[dict[str, object]]:
        """The rows of ``frame()``."""
        return self.frame().reset_index().to_dict("records")

    @property
    def series(self) -> list[tuple[str, np.ndarray, np.ndarray]]:
        """(name, averages, errors) of each number over the times; without names it is numbered."""
        mean, stderr = (values.reshape(len(values), -1).T for values in (self.mean, self.stderr))
        numbers = [f"mean_{k}" for k in range(len(mean))] if len(mean) > 1 else ["mean"]
        return [*zip(self.names or numbers, mean, stderr, strict=True)]

    def frame(self) -> pd.DataFrame:
        """Return a table of the averages.

        Returns
        -------
        DataFrame
            One row per time. The columns are <name> and <name>_stderr for each of ``names``;
            without names mean and stderr, numbered if there are several.

        Examples
        --------
        >>> ring = td.Scene(1.5, 1.0, 0.2, periodic="x")
        >>> td.diffusion(ring, [1, 2], 4096, seed=1).frame().columns[:2].to_list()
        ['squared_displacement', 'diffusion']
        """
        import pandas as pd

        columns = {name: mean for name, mean, _ in self.series}
        for name, _, stderr in self.series:
            columns[f"{name}_stderr" if self.names else name.replace("mean", "stderr")] = stderr
        return pd.DataFrame(columns, pd.Index(self.times, name="time"))

    def _texts(self) -> pd.DataFrame:
        """Return the texts of the printed table, one row for each time."""
        columns = [("time", [format_number(time, ".12g") for time in self.times])]
        for name, mean, stderr in self.series:
            texts = zip(*map(texts_with_error, mean, stderr), strict=True)
            columns += zip((name, "± error"), texts, strict=True)
        names, texts = zip(*columns, strict=True)
        return data_frame(zip(*texts, strict=True), names)


@checked_call
def observe(
    scene: Scene,
    function: Function | Mapping[str, Function],
    times: float | Iterable[float],
    replicas: float | None = None,
    *,
    starts: np.ndarray | Sequence[np.ndarray] | str | PathLike[str] | None = None,
    seed: int = 1,
    name: str | None = None,
    cores: int = 1,
    progress: bool | None = None,
) -> Observed:
    """Average your function over trajectories that start in the invariant measure.

    Parameters
    ----------
    scene : Scene
        The box, the discs and their effects.
    function : callable or dict
        ``function(start, now)`` takes two read-only arrays of states in the form of ``starts``, at
        time 0 and at one of the ``times``. It returns an array with a number, or an array, for each
        of the states, or several numbers: a tuple of arrays, or a dict {name: array}. A dict {name:
        function} is the same. On periodic axes positions go on beyond the cell.
    times : float or iterable of float
        Ascending, from 0 on, in time.
    replicas : float, optional
        Trajectories, an integer from 1 to 1e9 and with at most 1e11 events and kicks in all; 2¹⁶ if
        left out. It is rounded up to whole blocks: of 4096, and of fewer for 20 discs or more.
        ``note`` of the result has the number that was followed.
    starts : array, pair of arrays or path-like, optional
        Initial states in place of the invariant measure, two or more: in the form of ``starts``,
        of ``frames`` at one time, as an array (replicas, discs, 4) or as ``start`` of
        ``trajectory``, with all frames of a file. All of them are followed, and ``replicas`` must
        be left out. The error holds if the states are independent, not for origins along one path
        that remember each other.
    seed, name, cores, progress : optional
        See ``help(twodiscs)``.

    Returns
    -------
    Observed
        ``mean`` and ``stderr`` at each time, arrays of shape (times, …). The error comes from the
        spread between the replicas, which are independent. All times have the same replicas, so
        their averages are correlated. ``more(replicas=…)`` goes on from it.

    Raises
    ------
    InputError
        For times of more than 10⁷ events and kicks, for a function that returns anything else, and
        for starts that are no states.

    Examples
    --------
    >>> found = td.observe(scene, lambda start, now: start["u1"] * now["u1"], [0, 1], seed=1)
    >>> bool(abs(found.mean[0] - 1 / 4) < 5 * found.stderr[0])  # ⟨u₁²⟩ of four components
    True
    """
    settings = function, times, replicas, starts, seed, name
    return make_observed(scene, *settings, cores=cores, progress=progress)


def make_observed(scene, function, times, replicas, starts=None, seed=1, name=None, **how):
    """Return the ``Observed`` of the arguments of ``observe``; ``how`` is for ``work``.

    For a result from a file the function is its name, a text, and ``starts`` are true if there
    were some.
    """
    settings = {"times": times, "replicas": replicas, "seed": seed, "name": name}
    settings |= {"starts": True} if starts is not None else {}
    if isinstance(how.get("resume_from"), FinishedComponents):
        return _averages("observe", scene, settings | {"function": function}, how, None, starts)
    if starts is not None and (replicas is not None or "resume_from" in how):
        raise InputError("replicas must be left out with starts, which are all followed")
    if starts is not None:
        from twodiscs.measure.trajectory import from_corner

        starts = given_states(scene, from_corner(check_scene(scene), starts))
        settings["replicas"] = starts.shape[1]
    elif replicas is None:
        settings["replicas"] = 2**16
    if function is None and "resume_from" in how:
        raise InputError(
            "function must be given again to go on from a file, which does not hold it: "
            "more(replicas, function=…)"
        )
    by_name = isinstance(function, Mapping)
    functions = dict(function) if by_name else {getattr(function, "__name__", "function"): function}
    if not functions or not all(map(callable, functions.values())):
        raise InputError(f"function must take two arrays of states, not be {quote(function)}")

    def called(start, now):
        return {name: one(start, now) for name, one in functions.items()}

    settings["function"] = ", ".join(map(str, functions))
    found = _averages("observe", scene, settings, how, called if by_name else function, starts)
    return replace(found, function=function)


def _averages(kind, scene, settings, how, function, starts=None, **given):
    """Return the ``Observed`` of a ``kind``, with its ``settings``; see ``ObserveRun``."""
    seed = job_seed(scene, "observe", settings["seed"], settings["name"])
    times = check_times(settings["times"])
    replicas = check_count("replicas", settings["replicas"], most=10**9)
    if starts is not None and replicas < 2:
        raise InputError("starts must be two states or more, for an error, not 1")
    run = ObserveRun(scene, seed, times, replicas, function, starts=starts, **given)
    found = work(kind, run, **how)
    settings |= {"times": times.tolist(), "replicas": replicas, "seed": int(settings["seed"])}
    note = note_of_number("replicas", replicas, found["replicas"])
    if starts is not None:
        note = f"{replicas} given starts: errors hold if they are independent"
    return Observed(kind, scene, times, **found, settings=settings, note=note)


@checked_call
def diffusion(
    scene: Scene,
    times: float | Iterable[float],
    replicas: float = 2**16,
    *,
    axis: Axis | None = None,
    seed: int = 1,
    name: str | None = None,
    cores: int = 1,
    progress: bool | None = None,
) -> Observed:
    """Measure the diffusion of the discs along a periodic axis, from the invariant measure.

    Displacements are of single discs, averaged over all of them if they are equal, else of disc 1.
    Smooth discs conserve the total momentum along the axis, which is 0: two equal discs then move
    in opposite directions.

    Parameters
    ----------
    scene : Scene
        The box, which is periodic along ``axis``, the discs and their effects.
    times : float or iterable of float
        Ascending, above 0, in time.
    replicas : float, default 2**16
        Trajectories, an integer from 1 to 1e9, rounded up to whole blocks as in ``observe``.
    axis : str, optional
        "x", "y" or "z"; the first periodic one if left out.
    seed, name, cores, progress : optional
        See ``help(twodiscs)``.

    Returns
    -------
    Observed
        ``mean`` and ``stderr``, shape (times, 2), have two columns, which ``frame()`` names:
        squared_displacement ⟨Δx²⟩(t), in length², and diffusion, in length²/time. The latter is
        half of the slope since the previous time, or since 0 for the first. The error of a slope
        includes the correlation of its two ends. ``more(replicas=…)`` goes on from it.

    Raises
    ------
    InputError
        For an axis with walls, between which displacements have a bound, for times of more than
        10⁷ events and kicks, and for a time of 0.

    Notes
    -----
    The diffusion coefficient D is the limit of the second column for long times, if there is one.
    Long free flights along a smooth channel can make it grow like a logarithm, and single discs
    cannot diffuse on a ring if they cannot pass each other.

    Examples
    --------
    >>> ring = td.Scene(1.5, 1.0, 0.2, periodic="x")
    >>> found = td.diffusion(ring, [2, 4, 8], 1e4, seed=1)
    >>> bool(0.02 < found.frame()["diffusion"].iloc[-1] < 0.05)
    True
    """
    settings = times, replicas, axis, seed, name
    return make_diffusion(scene, *settings, cores=cores, progress=progress)


def make_diffusion(scene, times, replicas, axis, seed, name, **how):
    """Return the ``Observed`` of the arguments of ``diffusion``; ``how`` is for ``work``."""
    periodic = check_scene(scene).periodic
    if not periodic or (axis is not None and not (isinstance(axis, str) and axis in [*periodic])):
        allowed = f"one of {', '.join(periodic)}" if periodic else "periodic in the scene"
        raise InputError(
            f"axis must be {allowed} for diffusion, not {quote(axis)}: displacements between walls "
            "have a bound"
        )
    axis = axis or periodic[0]
    times = check_times(times)
    if times[0] == 0:
        raise InputError("times must be above 0 for diffusion, not 0")
    discs = range(1, scene.discs + 1 if scene.identical else 2)

    def squared(start, now):
        return sum((now[f"{axis}{n}"] - start[f"{axis}{n}"]) ** 2 for n in discs) / len(discs)

    def with_slopes(values, before, steps):
        before = np.zeros(len(values)) if before is None else before
        slopes = np.diff(values, axis=1, prepend=before[:, None]) / (2 * steps)
        return np.stack([values, slopes], axis=2)

    settings = {"axis": axis, "times": times, "replicas": replicas, "seed": seed, "name": name}
    given = {"names": ("squared_displacement", "diffusion"), "over_times": with_slopes}
    return _averages("diffusion", scene, settings, how, squared, **given)


Observed.makers = {"observe": make_observed, "diffusion": make_diffusion}
