"""One trajectory as a table, which knows the states between its rows."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from twodiscs.comparison.measured.measurements import seed_of
from twodiscs.comparison.measured.progress import progress_bar
from twodiscs.dynamics.trajectory import DISCS, columns, followed
from twodiscs.model.checks import InputError, as_list, quote
from twodiscs.sampling.starts import components

if TYPE_CHECKING:
    from twodiscs.model.scene import Scene

#: The velocity along each axis.
VELOCITIES = {"x": "u", "y": "v", "z": "w"}


class Trajectory(pd.DataFrame):
    """A trajectory: a row an event, with its time, its name, and the state right after it.

    Columns are time, x1, y1, …, xN, yN (the centres, from that of the box), event, z1, z2 of balls,
    first and second (the discs that the event is of), and u1, v1, …, uN, vN (velocities); w1, w2 of
    balls and s1, s2, the speeds of the surfaces of rough discs. On periodic axes centres go on
    beyond the cell.
    """

    @property
    def _constructor(self):
        return Trajectory

    @property
    def scene(self) -> Scene:
        """The scene, which ``attrs`` holds."""
        return self.attrs["scene"]

    def states_at(self, times: float | Iterable[float]) -> np.ndarray:
        """Return the states at ``times``, exactly: an array with the named columns of ``starts``.

        ``times`` are numbers in any order, from the first to the last one of the trajectory.
        Raises ``InputError`` for others, and where columns of the trajectory are missing, or rows
        in between, as in a selection of events.
        """
        names = components(self.scene)
        missing = [name for name in ("time", *names) if name not in self]
        if missing or self.empty:
            raise InputError(
                "trajectory must have a row at least and all of its columns for the states at a "
                f"time, not {len(self)} rows without {', '.join(missing) or 'none'}"
            )
        require_consecutive(self)
        known, times = self["time"].to_numpy(), as_list(times)
        try:
            at = np.atleast_1d(np.asarray(times, float))
        except (TypeError, ValueError):
            raise InputError(f"times must be a list of numbers, not {quote(times)}") from None
        if at.ndim > 1 or not np.all((at >= known[0]) & (at <= known[-1])):
            raise InputError(
                f"times must be numbers from {known[0]!s} to {known[-1]!s}, not {quote(times)}"
            )
        row = np.searchsorted(known, at, side="right") - 1
        since, field = at - known[row], self.scene.field
        states = np.empty(at.size, [(name, float) for name in names])
        for name in names:
            states[name] = self[name].to_numpy()[row]
        for place in names:
            if place[0] in VELOCITIES:
                velocity = VELOCITIES[place[0]] + place[1:]
                falling = field if place[0] == "y" else 0.0
                states[place] += (states[velocity] - falling * since / 2) * since
                states[velocity] -= falling * since
        return states


def require_consecutive(trajectory):
    """Raise ``InputError`` where rows of a trajectory, which keep their index, are missing."""
    index = trajectory.index
    if pd.api.types.is_integer_dtype(index) and (gaps := np.diff(index) != 1).any():
        raise InputError(
            "trajectory must have all rows from its first to its last one, for the discs move "
            f"freely between them, but row {index[gaps.argmax()] + 1} is missing"
        )


def trajectory(scene, seed, start, duration, name, progress=None):
    """Return one ``Trajectory`` (see the face)."""
    seed = seed_of(scene, "trajectory", seed, name)
    with progress_bar(progress, f"trajectory r = {scene.radius:g}") as progress:
        rows = followed(scene, seed, start, duration, progress)
    times, events, *discs, states = zip(*rows, strict=True)
    known = dict(zip(components(scene), np.array(states).T, strict=True))
    known |= {"time": times, "event": events}
    known |= {name: pd.array(of, "Int64") for name, of in zip(DISCS, discs, strict=True)}
    names = [name for name in columns(scene.discs) if name in known]
    frame = Trajectory(
        {
            name: known[name]
            for name in [*names, *(n for n in _by_disc(scene, known) if n not in names)]
        }
    )
    frame.attrs["scene"] = scene
    return frame


def _by_disc(scene, names):
    """Return ``names`` of components disc by disc: u1, v1, u2, v2, not u1, u2, v1, v2."""
    numbers = {str(disc): disc for disc in range(1, scene.discs + 1)}
    return sorted((n for n in names if n[1:] in numbers), key=lambda name: numbers[name[1:]])
