"""States of the invariant measure, and averages over it of the values of a user's function."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import islice
from typing import TYPE_CHECKING, Any

import numpy as np

from twodiscs.dynamics.engine import find_engine
from twodiscs.dynamics.ensemble import open_block_kicks
from twodiscs.dynamics.paths import MOST_PATH_EVENTS
from twodiscs.measure.result import Result, note_of_number, progress_bar
from twodiscs.model.calls import checked_call
from twodiscs.model.checks import InputError, check_count, make_list
from twodiscs.model.formats import format_number, quote, texts_with_error
from twodiscs.model.many_geometry import LARGE
from twodiscs.model.scene import Scene, check_scene
from twodiscs.model.seeds import job_seed
from twodiscs.points.base import reached
from twodiscs.sampling.initial_states import MOST_NUMBERS, components, make_records, states
from twodiscs.sampling.rounds import FinishedComponents
from twodiscs.sampling.threads import map_in_threads

if TYPE_CHECKING:
    import pandas as pd

    from twodiscs import Axis

    Function = Callable[[np.ndarray, np.ndarray], Any]

#: Replicas with one random stream. ``LARGE`` numbers of discs have the blocks of ``simulate``.
BLOCK = 4096

#: The most numbers of the states of a block at several times that are in memory together.
KEPT = 2**22

#: Values of a function are smaller, so that their squares can be added.
LARGEST = 1e140


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

    def _again(self, settings, options):
        if self.kind == "diffusion":
            return run_diffusion(self.scene, **settings, **options, resume_from=self.components)
        function = settings.pop("function")
        function = self.function if function == self.settings["function"] else function
        return run_observe(self.scene, function, **settings, **options, resume_from=self.components)

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
        import pandas as pd

        columns = [("time", [format_number(time, ".12g") for time in self.times])]
        for name, mean, stderr in self.series:
            texts = zip(*map(texts_with_error, mean, stderr), strict=True)
            columns += zip((name, "± error"), texts, strict=True)
        names, texts = zip(*columns, strict=True)
        return pd.DataFrame(zip(*texts, strict=True), columns=names)


def _times(times):
    times = make_list(times)
    try:
        checked = np.atleast_1d(np.asarray(times, float))
        ascending = checked.ndim == 1 and checked.size and np.all(np.diff(checked) > 0)
        ascending = ascending and not np.ma.is_masked(times)
        if ascending and checked[0] >= 0 and np.isfinite(checked[-1]):
            return checked
    except (TypeError, ValueError):
        pass
    raise InputError(f"times must be ascending numbers from 0 on, not {quote(times)}")


def _values(function, start, now):
    """Return (names, values) of the ``function``: an array with a row for each replica.

    A dict has names; its values, and those of a tuple or list of arrays, are columns.
    """
    # The same start is used for all times. A function that changes it would spoil later times.
    start.flags.writeable = now.flags.writeable = False
    returned = function(start, now)
    names = tuple(returned) if isinstance(returned, Mapping) else ()
    columns = [*returned.values()] if names else returned
    try:
        if isinstance(columns, list | tuple) and all(np.shape(c) == start.shape for c in columns):
            columns = np.ma.stack(columns, axis=1)
        values = np.ma.asarray(columns)  # a list may hold masked arrays
    except (TypeError, ValueError):  # lists of several lengths
        values = None
    is_real = values is not None and values.dtype.kind in "biuf"
    masked = is_real and np.ma.is_masked(values)
    shape = start.shape + ((len(names),) if names else ())
    if not is_real or masked or values.shape[: len(shape)] != shape:
        allowed = (
            "function must return a real number, or the same number of them, for each of the "
            f"{start.size} replicas"
        )
        if returned is None:
            what = "None: is its return missing?"
        elif masked:
            what = "an array with masked values, which have to be filled or left out of the average"
        elif values is None or not values.shape or names:
            what = quote(returned)
        elif values.dtype.names:
            what = f"an array with the fields {', '.join(values.dtype.names)}: choose one of them"
        elif values.dtype.kind == "c":
            what = (
                f"complex ones of shape {values.shape}: return real and imaginary part as two "
                "columns, np.stack((z.real, z.imag), axis=1)"
            )
        else:
            what = f"an array of shape {values.shape} and kind {values.dtype}"
        raise InputError(f"{allowed}, not {what}")
    _check_names(names)
    return names, values.data.astype(float)


def _check_names(names):
    """Raise ``InputError`` unless these are different texts, with those of their errors too."""
    texts = all(isinstance(name, str) for name in names)
    if not texts or len({*names, *(f"{name}_stderr" for name in names)}) < 2 * len(names):
        raise InputError(
            "names of what function returns must be texts, none of them another one with _stderr, "
            f"not {quote([*names])}"
        )


def _check_finite(values, times, first):
    """Raise ``InputError`` for NaN and large ``values``, from the replica ``first`` on."""
    if not (wrong := ~(np.abs(values) < LARGEST)).any():
        return
    replica, time, *_ = np.argwhere(wrong)[0]
    value = values[replica, time][wrong[replica, time]].flat[0]
    raise InputError(
        f"function must return finite numbers, below {format_number(LARGEST, 'g')}, not {value} at "
        f"the time {times[time]:g} of the replica {first + replica}"
    )


@checked_call
def observe(
    scene: Scene,
    function: Function | Mapping[str, Function],
    times: float | Iterable[float],
    replicas: float = 2**16,
    *,
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
    replicas : float, default 2¹⁶
        Trajectories, an integer from 1 to 1e9. It is rounded up to whole blocks: of 4096, and
        of fewer for 20 discs or more. ``note`` of the result has the number that was followed.
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
        For times of more than 10⁷ events and kicks, and for a function that returns anything else.

    Examples
    --------
    >>> found = td.observe(scene, lambda start, now: start["u1"] * now["u1"], [0, 1], seed=1)
    >>> bool(abs(found.mean[0] - 1 / 4) < 5 * found.stderr[0])  # ⟨u₁²⟩ of four components
    True
    """
    return run_observe(scene, function, times, replicas, seed, name, cores, progress)


def run_observe(
    scene, function, times, replicas, seed, name, cores=1, progress=None, resume_from=None
):
    """Return the ``Observed`` of ``observe``, which goes on from ``resume_from``.

    For a result from a file the ``function`` is its name, a text.
    """
    settings = {"times": times, "replicas": replicas, "seed": seed, "name": name}
    if isinstance(resume_from, FinishedComponents):
        settings["function"] = function
        return averages("observe", scene, None, settings, cores, progress, resume_from)
    if function is None and resume_from is not None:
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
    taken = called if by_name else function
    found = averages("observe", scene, taken, settings, cores, progress, resume_from)
    return replace(found, function=function)


def averages(
    kind, scene, function, settings, cores, progress, resume_from, names=(), over_times=None
):
    """Return the averages of a user's ``function`` as ``Observed``.

    ``over_times(values, before, steps)``, if given, is applied to the values of the replicas of a
    block at some of the times, (replicas, times, …), before they are averaged. ``before`` are the
    values at the time before these, None at first. ``steps`` are the times since the time before
    each. ``names`` are then the names of the averages. The components ``resume_from`` are not done
    again: their sums are the mean and the sum of squared deviations over the first blocks.
    """
    stream = job_seed(check_scene(scene), "observe", settings["seed"], settings["name"])
    times = _times(settings["times"])
    asked = check_count("replicas", settings["replicas"], most=10**9)
    engine = find_engine(scene)
    each = BLOCK if scene.discs < LARGE else engine.block_replicas(scene)
    blocks = -(-asked // each)
    rate = engine.expected_event_rate(scene) + scene.friction
    if times[-1] * rate > MOST_PATH_EVENTS:
        raise InputError(
            f"times must be below {format_number(MOST_PATH_EVENTS / rate, '.3g')}, where "
            f"{format_number(MOST_PATH_EVENTS, 'g')} events are due, not "
            f"{format_number(times[-1], 'g')}"
        )

    steps = np.diff(times, prepend=0.0)

    def snapshots(block):
        """Yield (states at time 0, states at a time) of a block, for all ``times``."""
        filled, wraps = states(scene, each, stream, block), engine.new_wraps(scene, each)
        kicks = open_block_kicks(engine.new_kicks(scene, each), stream, block)
        start = make_records(scene, filled)
        for step in steps:
            if step:
                engine.advance_all(scene, filled, wraps, step, kicks)
            now = make_records(scene, filled)
            engine.unwrap(scene, now, wraps)
            yield start, now

    def moments(block, first, pairs, before):
        """Return the last values of a block, and the means and sums of squares at some times."""
        found = [_values(function, start, now) for start, now in pairs]
        forms.update((own, values.shape[1:]) for own, values in found)
        if len(forms) > 1:
            raise InputError(
                "function must return as many numbers each time, with the same names, not "
                f"{' and '.join(map(quote, forms))}"
            )
        values = np.stack([values for _, values in found], axis=1)
        _check_finite(values, times[first:], block * each)
        last = values[:, -1]
        if over_times:
            values = over_times(values, before, steps[first : first + len(pairs)])
        return last, values.mean(axis=0), ((values - values.mean(axis=0)) ** 2).sum(axis=0)

    # If the states of a block at all times are too many, one block a core goes on piece by piece.
    together = max(1, KEPT // (each * len(components(scene))))
    in_pieces = times.size > together
    abreast = cores if in_pieces else blocks
    old = {"names": [], "sums": {}} if resume_from is None else resume_from["all"]
    sums, done = reached(old["sums"], blocks)
    mean, square = sums or (0.0, 0.0)
    total = done * each
    forms = {(tuple(old["names"]), mean.shape[1:])} if done and not over_times else set()
    if isinstance(resume_from, FinishedComponents):
        _check_names(old["names"])
        shape = times.shape + (mean.shape[1:] if not old["names"] else (len(old["names"]),))
        if done < blocks or not shape == mean.shape == square.shape or not np.all(square >= 0):
            raise InputError("sums must be those of all replicas, times and names")
    with progress_bar(progress, f"observe r = {scene.radius:g}") as progress:
        for low in range(done, blocks, abreast):
            numbers = range(low, min(low + abreast, blocks))
            series = [*map(snapshots, numbers)] if in_pieces else map(snapshots, numbers)
            parts = {}
            for first in range(0, times.size, together):
                calls = ((of_block,) for of_block in series)
                every = map_in_threads(lambda of_block: [*islice(of_block, together)], calls, cores)
                for block, pairs in zip(numbers, every, strict=True):
                    before = parts[block][-1][0] if first else None
                    part = moments(block, first, pairs, before)
                    parts.setdefault(block, []).append(part)
                    if first + together < times.size:
                        continue
                    _, own, spread = map(np.concatenate, zip(*parts.pop(block), strict=True))
                    # The mean and the sum of squares of two samples together (Chan et al., 1979).
                    n, apart = total + each, own - mean
                    square = square + spread + apart**2 * (total * each / n)
                    mean, total = mean + apart * (each / n), n
                    if progress is not None:
                        progress(block + 1, blocks)
    names = names or next(iter(forms))[0]
    stderr = np.sqrt(square / (total - 1) / total)
    settings |= {"times": times.tolist(), "replicas": asked, "seed": int(settings["seed"])}
    made = {"names": [*names], "stream": stream, "sums": {(0, blocks): [mean, square]}}
    note = note_of_number("replicas", asked, total)
    return Observed(kind, scene, times, mean, stderr, total, settings, {"all": made}, note, names)


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
    replicas : float, default 2¹⁶
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
    return run_diffusion(scene, times, replicas, axis, seed, name, cores, progress)


def run_diffusion(
    scene, times, replicas, axis, seed, name, cores=1, progress=None, resume_from=None
):
    """Return the ``Observed`` of ``diffusion``, which goes on from ``resume_from``."""
    periodic = check_scene(scene).periodic
    if not periodic or (axis is not None and not (isinstance(axis, str) and axis in [*periodic])):
        allowed = f"one of {', '.join(periodic)}" if periodic else "periodic in the scene"
        raise InputError(
            f"axis must be {allowed} for diffusion, not {quote(axis)}: displacements between walls "
            "have a bound"
        )
    axis, times = axis or periodic[0], _times(times)
    if times[0] == 0:
        raise InputError("times must be above 0 for diffusion, not 0")
    discs = range(1, scene.discs + 1 if scene.identical else 2)

    def squared(start, now):
        return sum((now[f"{axis}{n}"] - start[f"{axis}{n}"]) ** 2 for n in discs) / len(discs)

    def with_slopes(values, before, steps):
        before = np.zeros(len(values)) if before is None else before
        slopes = np.diff(values, axis=1, prepend=before[:, None]) / (2 * steps)
        return np.stack([values, slopes], axis=2)

    settings = {"times": times, "replicas": replicas, "axis": axis, "seed": seed, "name": name}
    names, more = ("squared_displacement", "diffusion"), (cores, progress, resume_from)
    return averages("diffusion", scene, squared, settings, *more, names, with_slopes)
