"""The run of averages over replicas of a function of their states, from the invariant measure."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import islice, repeat

import numpy as np

from twodiscs.dynamics.engine import find_engine
from twodiscs.dynamics.ensemble import MOST_RUN_EVENTS, open_block_kicks
from twodiscs.dynamics.paths import MOST_PATH_EVENTS, check_states
from twodiscs.model.checks import InputError, check_numbers, has_units
from twodiscs.model.formats import format_number, quote
from twodiscs.model.many_geometry import CELL_DISCS
from twodiscs.model.scene import Scene
from twodiscs.points.base import reached
from twodiscs.sampling.initial_states import (
    STATE_ROWS,
    components,
    disc_fields,
    make_records,
    move_into_cell,
    states,
)
from twodiscs.sampling.rounds import Run, fixed
from twodiscs.sampling.threads import draw_in_calls, map_in_threads

#: Replicas with one random stream. ``CELL_DISCS`` discs or more have the blocks of ``simulate``.
BLOCK_STATES = 4096

#: The most numbers of the states of a block at several times that are in memory together.
MOST_STATE_NUMBERS = 2**22

#: Values of a function are smaller, so that their squares can be added.
LARGEST_VALUE = 1e140

#: A smaller sum of squares of deviations that are not all 0 has lost digits, and this bound takes
#: its place: the error of values below 1e-145 is an upper bound, which is not 0.
LEAST_SQUARES = 1e-290


def check_times(times):
    """Return ``times`` as an array of doubles; raise ``InputError`` unless they ascend from 0."""

    def ascend(array):
        rising = array.size and array[0] >= 0 and np.all(np.diff(array) > 0)
        return rising and np.isfinite(array[-1])

    return check_numbers("times", times, "ascending numbers from 0 on", ascend)


def _values(function, start, now):
    """Return (names, values) of the ``function``: an array with a row for each replica.

    A dict, a namedtuple and a ``DataFrame`` have names; their values, and those of a tuple or list
    of arrays, are columns.
    """
    # The same start is used for all times. A function that changes it would spoil later times.
    start.flags.writeable = now.flags.writeable = False
    try:
        returned = function(start, now)
    except ValueError as error:
        if not str(error).startswith("no field of name"):
            raise
        fields = ", ".join(start.dtype.names)
        raise InputError(f"function must use the fields {fields}, but there is {error}") from error
    two_axes = getattr(returned, "ndim", 0) == 2
    is_table = isinstance(returned, Mapping) or (two_axes and hasattr(returned, "keys"))
    names = tuple(returned.keys() if is_table else getattr(returned, "_fields", ()))
    columns = [column for _, column in returned.items()] if is_table else returned
    parts = [*columns] if isinstance(columns, list | tuple) else [columns]
    in_units = has_units(parts)
    try:
        if isinstance(columns, list | tuple) and all(np.shape(c) == start.shape for c in columns):
            columns = np.ma.stack(columns, axis=1)
        values = np.ma.asarray(columns)  # a list may hold masked arrays
    except (TypeError, ValueError):  # lists of several lengths
        values = None
    is_real = values is not None and values.dtype.kind in "biuf" and not in_units
    masked = is_real and np.ma.is_masked(values)
    shape = start.shape + ((len(names),) if names else ())
    if not is_real or masked or values.shape[: len(shape)] != shape:
        allowed = (
            "function must return a real number, or the same number of them, for each of the "
            f"{start.size} replicas"
        )
        if returned is None:
            what = "None: is its return missing?"
        elif in_units:
            what = "quantities, whose units would be lost: return plain numbers"
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
    check_names(names)
    return names, values.data.astype(float)


def check_names(names):
    """Raise ``InputError`` unless these are different texts, with their errors and the time too."""
    texts = all(isinstance(name, str) for name in names)
    if not texts or len({"time", *names, *(f"{name}_stderr" for name in names)}) <= 2 * len(names):
        raise InputError(
            "names of what function returns must be texts, none of them time or another one with "
            f"_stderr, not {quote([*names])}"
        )


def _check_finite(values, times, first):
    """Raise ``InputError`` for NaN and large ``values``, from the replica ``first`` on."""
    if not (wrong := ~(np.abs(values) < LARGEST_VALUE)).any():
        return
    replica, time, *_ = np.argwhere(wrong)[0]
    value = values[replica, time][wrong[replica, time]].flat[0]
    raise InputError(
        f"function must return finite numbers, below {format_number(LARGEST_VALUE, 'g')}, not "
        f"{value} at the time {times[time]:g} of the replica {first + replica}"
    )


def join(sums, more):
    """Return (number, mean, Σ squared deviations) of two samples together (Chan et al., 1979)."""
    number, mean, square = sums or (0.0, 0.0, 0.0)
    own_number, own_mean, spread = more
    total, apart = number + own_number, own_mean - mean
    square = square + spread + apart**2 * (number * own_number / total)
    return [total, mean + apart * (own_number / total), square]


@dataclass(frozen=True)
class ObserveRun(Run):
    """Averages of ``function(start, now)`` at the ``times`` over whole blocks of ``replicas``.

    ``over_times(values, before, steps)``, if given, is applied to the values of the replicas of a
    block at some of the times, (replicas, times, …), before they are averaged. ``before`` are the
    values at the last time before these, None if there is none. ``steps`` are the differences of
    successive times. ``names`` are then the names of the averages.

    ``starts`` are states (components, replicas) in place of those of the invariant measure, or True
    for sums of a file, which does not hold them.

    Sums are the number of replicas, the mean and the sum of squared deviations.
    """

    scene: Scene
    seed: int
    times: np.ndarray
    replicas: int
    function: Callable | None
    names: tuple = ()
    over_times: Callable | None = None
    starts: np.ndarray | None = None

    def __post_init__(self):
        if isinstance(self.starts, np.ndarray):
            check_states(self.scene, self.starts, "starts")
        most, last = MOST_PATH_EVENTS / self._rate, self.times[-1]
        if last > most:
            raise InputError(
                f"times must be below {format_number(most, '.3g')}, where "
                f"{format_number(MOST_PATH_EVENTS, 'g')} events are due, not "
                f"{format_number(last, 'g')}"
            )
        if self.replicas * last * self._rate > MOST_RUN_EVENTS:
            most = int(MOST_RUN_EVENTS / last / self._rate)
            raise InputError(
                f"replicas must be at most {most} for times up to {format_number(last, 'g')}, with "
                f"{format_number(MOST_RUN_EVENTS, 'g')} events due in all, not {self.replicas}"
            )

    @property
    def _rate(self):
        return find_engine(self.scene).rates.expected_event_rate(self.scene) + self.scene.friction

    @property
    def _each(self):
        """The number of replicas of a block."""
        few, engine = self.scene.discs < CELL_DISCS, find_engine(self.scene)
        return BLOCK_STATES if few else engine.rates.block_replicas(self.scene)

    @cached_property
    def _forms(self):
        """The different (names, shape) of the values of a replica at a time; there may be one."""
        return set()

    @cached_property
    def components(self):
        """The ``SequentialRun`` of all blocks, {"all": run}."""
        blocks, events = -(-self.replicas // self._each), self._each * self._rate * self.times[-1]
        ratio = find_engine(self.scene).rates.cost_ratio(self.scene)
        return {"all": fixed(self._work, blocks, max(events, 1.0), ratio, join)}

    def _number(self, block):
        """The number of replicas of a block: all of a whole one, or the rest of given starts."""
        left = self.replicas - block * self._each
        return self._each if self.starts is None else min(self._each, left)

    def _states(self, block, number):
        """Yield the first states of a block at time 0 and at all times, (components, number)."""
        scene, engine, first = self.scene, find_engine(self.scene), block * self._each
        names, shifts = components(scene), {}
        if self.starts is None:
            filled = states(scene, number, self.seed, block)
        else:
            filled = np.zeros((max(STATE_ROWS, len(names)), number))
            filled[: len(names)] = self.starts[:, first : first + number]
            shifts = move_into_cell(scene, dict(zip(names, filled, strict=False)))
        wraps = engine.paths.new_wraps(scene, number)
        kicks = open_block_kicks(engine.paths.new_kicks(scene, number), self.seed, first)
        for step in (0.0, *np.diff(self.times, prepend=0.0)):
            if step:
                engine.paths.advance_all(scene, filled, wraps, step, kicks)
            now = filled[: len(names)].copy()
            rows = dict(zip(names, now, strict=True))
            engine.paths.unwrap(scene, rows, wraps)
            for name, shift in shifts.items():
                rows[name] += shift
            yield now

    def _snapshots(self, block):
        """Yield (states at time 0, states at a time) of a block, for all times."""
        every = (make_records(self.scene, now) for now in self._states(block, self._number(block)))
        start = next(every)
        yield from zip(repeat(start), every)

    def frames(self, progress, cores=1):
        """Return the states of all replicas at all times, see ``observe.frames``."""
        names, each = components(self.scene), self._each
        shape = self.replicas, self.times.size, self.scene.discs
        found = np.empty(shape, [(letter, float) for letter in disc_fields(self.scene)])

        def fill(block):
            into = found[block * each : (block + 1) * each]
            for k, now in enumerate(islice(self._states(block, len(into)), 1, None)):
                for name, row in zip(names, now, strict=True):
                    into[name[0]][:, k, int(name[1:]) - 1] = row
            return block * each + len(into)

        calls = ((block,) for block in range(-(-self.replicas // each)))
        draw_in_calls(fill, calls, self.replicas, progress, cores)
        return found

    def _work(self, first, stop, cores, waiting):
        """Yield the sums of the blocks ``first`` … ``stop`` − 1, see ``SequentialRun``.

        If the states of a block at all times are too many, one block a core goes on piece by piece.
        """
        together = max(1, MOST_STATE_NUMBERS // (self._each * len(components(self.scene))))
        in_pieces = self.times.size > together
        abreast = cores if in_pieces else stop - first
        for low in range(first, stop, abreast):
            numbers = range(low, min(low + abreast, stop))
            calls = zip(map(self._snapshots, numbers), strict=True)
            calls, parts = [*calls] if in_pieces else calls, {block: [] for block in numbers}
            for at in range(0, self.times.size, together):
                every = map_in_threads(
                    lambda of_block: [*islice(of_block, together)], calls, cores, waiting
                )
                for block, pairs in zip(numbers, every, strict=True):
                    before = parts[block][-1][0] if at else None
                    parts[block].append(self._moments(pairs, before, at, block))
                    if at + together >= self.times.size:
                        moments = zip(*parts.pop(block), strict=True)
                        _, mean, square = map(np.concatenate, moments)
                        yield self._number(block), mean, square

    def _moments(self, pairs, before, at, block):
        """Return the last values of a block, and means and Σ squared deviations of some times.

        The times are those from the number ``at`` on, ``before`` are the values at the time before.
        """
        found = [_values(self.function, start, now) for start, now in pairs]
        self._forms.update((own, values.shape[1:]) for own, values in found)
        if len(self._forms) > 1:
            raise InputError(
                "function must return as many numbers each time, with the same names, not "
                f"{' and '.join(map(quote, self._forms))}"
            )
        values = np.stack([values for _, values in found], axis=1)
        _check_finite(values, self.times[at:], block * self._each)
        last, steps = values[:, -1], np.diff(self.times, prepend=0.0)[at : at + len(pairs)]
        if self.over_times:
            values = self.over_times(values, before, steps)
        mean, differ = values.mean(axis=0), (values != values[0]).any(axis=0)
        squares = ((values - mean) ** 2).sum(axis=0)
        return last, mean, np.where(differ, np.maximum(squares, LEAST_SQUARES), squares)

    def run(self, progress=None, cores=1, resume_from=None):
        """Return averages; values have the form of those of ``resume_from``."""
        if resume_from is not None and not self.over_times:
            (_, mean, _), _ = reached(resume_from["all"]["sums"])
            self._forms.add((tuple(resume_from["all"]["names"]), mean.shape[1:]))
        return super().run(progress, cores, resume_from)

    def point(self, ranges):
        """Return averages, by their names in ``Observed``, from {"all": ranges of sums}."""
        (number, mean, square), blocks = reached(ranges["all"])
        names = self.names or next(iter(self._forms))[0]
        check_names(names)
        shape = self.times.shape + ((len(names),) if names else mean.shape[1:])
        replicas = blocks * self._each if self.starts is None else self.replicas
        is_right = number == replicas and mean.shape == square.shape == shape
        if not is_right or not np.all(square >= 0):
            raise InputError("sums must be those of all replicas, times and names")
        return {
            "mean": mean,
            "stderr": np.sqrt(square / (number - 1) / number),
            "replicas": int(number),
            "names": names,
            "components": {"all": {"names": [*names], "stream": self.seed, "sums": ranges["all"]}},
        }
