"""Averages over the invariant measure of what a user's own function sees, with their errors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from twodiscs.comparison.measured.measurements import seed_of
from twodiscs.comparison.measured.progress import progress_bar
from twodiscs.dynamics.counting import expected_event_rate
from twodiscs.dynamics.trajectory import MOST_EVENTS, advance_all, new_wraps, unwrap
from twodiscs.model.checks import InputError, as_list, check_count, format_number, quote
from twodiscs.model.scene import check_scene
from twodiscs.sampling.blocks.threads import in_threads
from twodiscs.sampling.starts import as_records, states

if TYPE_CHECKING:
    import pandas as pd

    from twodiscs.model.scene import Scene

#: Replicas that share a random stream.
BLOCK = 4096


@dataclass(frozen=True, eq=False)
class Observed:
    """Averages over independent replicas of the invariant measure of one ``scene``.

    ``mean`` and ``stderr``, the standard error, are arrays with an entry for each of the ``times``:
    numbers, or arrays of what the function returns for a replica. ``replicas`` is how many there
    are, ``settings`` has the seed.
    """

    scene: Scene
    times: np.ndarray
    mean: np.ndarray
    stderr: np.ndarray
    replicas: int
    settings: dict[str, object]

    def __eq__(self, other):
        if type(other) is not type(self):
            return NotImplemented
        return (self.scene, self.settings) == (other.scene, other.settings) and all(
            np.array_equal(getattr(self, name), getattr(other, name), equal_nan=True)
            for name in ("times", "mean", "stderr")
        )

    __hash__ = None

    def frame(self) -> pd.DataFrame:
        """Return a pandas ``DataFrame`` by time: mean and stderr, numbered if there are several."""
        import pandas as pd

        columns = {}
        for name, values in (("mean", self.mean), ("stderr", self.stderr)):
            flat = values.reshape(len(values), -1)
            several = flat.shape[1] > 1
            columns |= {f"{name}_{k}" if several else name: c for k, c in enumerate(flat.T)}
        return pd.DataFrame(columns, index=pd.Index(self.times, name="time"))

    def __str__(self) -> str:
        return f"{self.scene}, {self.replicas} replicas\n\n{self.frame()}"

    __repr__ = __str__

    def _repr_html_(self) -> str:
        return self.frame().to_html()


def _times(times):
    times = as_list(times)
    try:
        checked = np.atleast_1d(np.asarray(times, float))
        ascending = checked.ndim == 1 and checked.size and np.all(np.diff(checked) > 0)
        if ascending and checked[0] >= 0 and np.isfinite(checked[-1]):
            return checked
    except (TypeError, ValueError):
        pass
    raise InputError(f"times must be ascending numbers from 0 on, not {quote(times)}")


def _seen(function, start, now):
    """Return what the ``function`` sees of the replicas, an array with a row for each."""
    # One start is for all times: what is written into it would spoil the later ones.
    start.flags.writeable = now.flags.writeable = False
    returned = function(start, now)
    try:
        seen = np.asarray(returned)
    except (TypeError, ValueError):  # lists of several lengths
        seen = None
    if seen is None or seen.dtype.kind not in "biuf" or seen.shape[:1] != start.shape:
        allowed = (
            f"function must return a real number, or as many of them, for each of the {start.size} "
            "replicas"
        )
        if returned is None:
            found = "None: is its return missing?"
        elif seen is None or not seen.shape:
            found = quote(returned)
        elif seen.dtype.names:
            found = f"an array with the fields {', '.join(seen.dtype.names)}: choose one of them"
        elif seen.dtype.kind == "c":
            found = (
                f"complex ones of shape {seen.shape}: return real and imaginary part as two "
                "columns, np.stack((z.real, z.imag), axis=1)"
            )
        else:
            found = f"an array of shape {seen.shape} and kind {seen.dtype}"
        raise InputError(f"{allowed}, not {found}")
    return seen.astype(float)


def _check_finite(seen, times, done):
    """Raise ``InputError`` for NaN and infinity in what was ``seen`` of block ``done``."""
    if not np.isfinite(seen).all():
        replica, time, *_ = np.argwhere(~np.isfinite(seen))[0]
        value = seen[replica, time][~np.isfinite(seen[replica, time])].flat[0]
        raise InputError(
            f"function must return finite numbers, not {value} at the time {times[time]:g} of the "
            f"replica {(done - 1) * BLOCK + replica}"
        )


def observe(scene, function, times, replicas, seed, name, cores=1, progress=None):
    """Return what a user's ``function`` sees on average, as ``Observed`` (see the face)."""
    stream, times = seed_of(check_scene(scene), "observe", seed, name), _times(times)
    if not callable(function):
        raise InputError(f"function must be one of two arrays of states, not {quote(function)}")
    blocks = -(-check_count("replicas", replicas, most=10**9) // BLOCK)
    rate = expected_event_rate(scene)
    if times[-1] * rate > MOST_EVENTS:
        raise InputError(
            f"times must be below {format_number(MOST_EVENTS / rate, '.3g')}, where "
            f"{format_number(MOST_EVENTS, 'g')} events are due, not {format_number(times[-1], 'g')}"
        )

    def snapshots(block):
        """Return the states of a block at time 0, and at all times."""
        filled, wraps = states(scene, BLOCK, stream, block), new_wraps(scene, BLOCK)
        yield as_records(scene, filled)
        for step in np.diff(times, prepend=0.0):
            if step:
                advance_all(scene, filled, wraps, step)
            now = as_records(scene, filled)
            unwrap(scene, now, wraps)
            yield now

    total = mean = square = None
    with progress_bar(progress, f"observe r = {scene.radius:g}") as progress:
        every = in_threads(lambda b: [*snapshots(b)], ((b,) for b in range(blocks)), cores)
        for done, (start, *later) in enumerate(every, 1):
            seen = np.stack([_seen(function, start, now) for now in later], axis=1)
            _check_finite(seen, times, done)
            own, spread = seen.mean(axis=0), ((seen - seen.mean(axis=0)) ** 2).sum(axis=0)
            if mean is None:
                total, mean, square = BLOCK, own, spread
            else:
                # The mean and the sum of squares of two samples together (Chan et al., 1979).
                n, apart = total + BLOCK, own - mean
                square = square + spread + apart**2 * (total * BLOCK / n)
                mean, total = mean + apart * (BLOCK / n), n
            if progress is not None:
                progress(done, blocks)
    stderr = np.sqrt(square / (total - 1) / total)
    settings = {"replicas": total, "seed": int(seed), "name": name}
    return Observed(scene, times, mean, stderr, total, settings)
