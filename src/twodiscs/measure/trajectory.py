"""One trajectory as a table, which can compute the states between its rows."""

from __future__ import annotations

import gzip
import io
import shlex
from collections.abc import Iterable, Sequence
from contextlib import ExitStack
from os import PathLike

import numpy as np
import pandas as pd

from twodiscs.analysis.tables import trajectory_columns
from twodiscs.dynamics.paths import follow_trajectory
from twodiscs.dynamics.rows import CHUNK_NUMBERS, event_names
from twodiscs.measure.result import progress_bar
from twodiscs.model.calls import checked_call
from twodiscs.model.checks import InputError, check_numbers, make_list, path_text, writing_to
from twodiscs.model.formats import quote
from twodiscs.model.scene import Scene
from twodiscs.model.seeds import job_seed
from twodiscs.model.two_geometry import ENERGY
from twodiscs.sampling.initial_states import components, disc_fields, make_records


class Trajectory(pd.DataFrame):
    """A trajectory: a table with one row per event, its time, its name and the state right after.

    It is a pandas ``DataFrame`` with these columns:

    - time; x1, y1, …, xN, yN: the centres, from the centre of the box; z1, z2 for balls. On
      periodic axes they go on beyond the cell.
    - event; first and second, the discs of the event
    - u1, v1, …, uN, vN: the velocities along x and y; w1, w2 along z for balls; s1, s2: the speeds
      of the surfaces of rough discs

    Parameters
    ----------
    data, index, columns, dtype, copy : optional
        The arguments of ``DataFrame``. The function ``trajectory`` returns one.

    Attributes
    ----------
    scene : Scene
        The scene. ``attrs["scene"]`` has its parameters as plain values, so that every format of
        pandas can write the table.

    Examples
    --------
    >>> path = td.trajectory(scene, 10, seed=1)
    >>> path.positions([0.5, 1, 2]).shape  # time, disc, axis
    (3, 2, 2)
    """

    @property
    def _constructor(self):
        return Trajectory

    @property
    def scene(self) -> Scene:
        """The scene, whose parameters ``attrs`` holds."""
        if "scene" not in self.attrs:
            raise InputError(
                "trajectory must have a scene in its attrs, but has none; two trajectories "
                "together keep it only if it is the same"
            )
        return Scene(**self.attrs["scene"])

    def states_at(self, times: float | Iterable[float]) -> np.ndarray:
        """Return the states at some times, exactly.

        Parameters
        ----------
        times : float or iterable of float
            In any order, from the first to the last one of the trajectory, in time.

        Returns
        -------
        structured array, shape (times,)
            States with the fields of ``starts``.

        Raises
        ------
        InputError
            For other times, and if columns of the trajectory are missing. Also if the discs do not
            move freely from each row to the next one, as in a selection of events.

        Examples
        --------
        >>> states = td.trajectory(scene, 5, seed=1).states_at([0.1, 0.3])
        >>> states["x1"].round(4)
        array([-0.1522, -0.1876])
        """
        scene = self.scene
        require_all_rows(self, scene)
        known = self["time"].to_numpy()
        allowed = f"numbers from {known[0]!s} to {known[-1]!s}"
        at = check_numbers(
            "times", times, allowed, lambda at: np.all((at >= known[0]) & (at <= known[-1]))
        )
        row = np.searchsorted(known, at, side="right") - 1
        rows = np.array([self[name].to_numpy()[row] for name in components(scene)])
        states = make_records(scene, rows)
        _fly(scene, states, at - known[row])
        return states

    def positions(self, times: float | Iterable[float] | None = None) -> np.ndarray:
        """Return the centres of all discs as a plain array.

        Parameters
        ----------
        times : float or iterable of float, optional
            As for ``states_at``; those of the rows if left out.

        Returns
        -------
        array, shape (times, discs, axes)
            In length, from the centre of the box; two axes, three for balls.

        Raises
        ------
        InputError
            As ``states_at``.

        Examples
        --------
        >>> td.trajectory(scene, 5, seed=1).positions([0.1, 0.3, 0.5]).shape  # time, disc, axis
        (3, 2, 2)
        """
        return self._along_axes(times, "xyz")

    def velocities(self, times: float | Iterable[float] | None = None) -> np.ndarray:
        """Return the velocities of all discs as a plain array.

        Parameters
        ----------
        times : float or iterable of float, optional
            As for ``states_at``; those of the rows if left out, right after the event.

        Returns
        -------
        array, shape (times, discs, axes)
            In the speed unit, in which √(v₁² + v₂²) is one for two plain discs.

        Raises
        ------
        InputError
            As ``states_at``.

        Examples
        --------
        >>> v = td.trajectory(scene, 5, seed=1).velocities([0.1, 0.3, 0.5])
        >>> (v**2).sum(axis=(1, 2)).round(12)  # the energy is 1/2
        array([1., 1., 1.])
        """
        return self._along_axes(times, "uvw")

    def _along_axes(self, times, letters):
        # Two events at one time are two rows with different states.
        states = self if times is None else self.states_at(times)
        scene = self.scene
        letters, discs = letters[: len(scene.axes)], range(1, scene.discs + 1)
        names = [f"{letter}{disc}" for disc in discs for letter in letters]
        missing = ", ".join(name for name in names if times is None and name not in self)
        if missing:
            raise InputError(f"trajectory must have all of its columns, but has no {missing}")
        columns = np.stack([np.asarray(states[name], float) for name in names], axis=1)
        return columns.reshape(-1, scene.discs, len(letters))

    def to_xyz(
        self, path: str | PathLike[str], times: float | Iterable[float] | None = None
    ) -> None:
        """Write the trajectory as an extended XYZ file, which ASE and OVITO read.

        MDAnalysis reads the centres only: give it the box and the step of time, ``dt``.

        A frame has the time, the box as its lattice and, for each disc, the species X, its centre,
        mass, momentum, radius and number. Coordinates begin at a corner of the box. Discs in the
        plane are in the middle of a lattice whose thickness is the diameter of the larger disc. On
        periodic axes centres go on beyond the cell.

        Parameters
        ----------
        path : path-like
            The file, which usually ends in .xyz. One that ends in .gz is compressed.
        times : float or iterable of float, optional
            The times of the frames, as for ``states_at``; without them the times of the rows, which
            have no equal steps.

        Raises
        ------
        InputError
            As ``states_at``, and for a path that cannot be written.

        Examples
        --------
        >>> td.trajectory(scene, 5, seed=1).to_xyz("two.xyz", [0, 1, 2])
        >>> len(open("two.xyz").readlines())  # three frames, each of two lines and two discs
        12
        """
        scene, times = self.scene, None if times is None else make_list(times)
        centres, velocities = self.positions(times), self.velocities(times)
        at = self["time"].to_numpy(float) if times is None else np.atleast_1d(times)
        rough, sides = scene.moment_of_inertia is not None, [*scene.sides]
        spins = self._along_axes(times, "s") if rough else np.empty((*centres.shape[:2], 0))
        if len(sides) == 2:
            sides.append(2 * max(scene.radii))
            flat = (0, 0), (0, 0), (0, 1)
            centres, velocities = np.pad(centres, flat), np.pad(velocities, flat)
        masses, radii = (np.array(column)[:, None] for column in (scene.masses, scene.radii))
        lattice = " ".join(repr(float(side)) for side in np.diag(sides).flat)
        periodic = " ".join("T" if axis in scene.periodic else "F" for axis in "xyz")
        properties = "species:S:1:pos:R:3:masses:R:1:momenta:R:3:radius:R:1"
        properties += f"{':spin:R:1' if rough else ''}:id:I:1"
        with ExitStack() as opened:
            raw = opened.enter_context(open(opened.enter_context(writing_to(path)), "wb"))
            if path_text(path).lower().endswith(".gz"):
                # Without a name and a time: always equal bytes.
                raw = gzip.GzipFile("", "wb", fileobj=raw, mtime=0)
            file = opened.enter_context(io.TextIOWrapper(raw, encoding="utf-8", newline="\n"))
            for time, places, speeds, turns in zip(at, centres, velocities, spins, strict=True):
                file.write(
                    f'{scene.discs}\nLattice="{lattice}" Properties={properties} '
                    f'pbc="{periodic}" Time={float(time)!r}\n'
                )
                columns = places + np.array(sides) / 2, masses, masses * speeds, radii, turns
                for disc, numbers in enumerate(np.hstack(columns).tolist(), 1):
                    file.write(f"X {' '.join(map(repr, numbers))} {disc}\n")


#: The largest distance of a row from the end of the free flight that begins at the row before it,
#: over the lengths whose rounding causes it. They agree within 2e-15 in every kind of scene.
FLIGHT_ROUNDING = 1e-10


def _fly(scene, states, since):
    """Let the discs in ``states``, arrays by component, move freely for the times ``since``."""
    for axis, place, velocity in _coordinates(scene):
        falling = scene.field if axis == "y" else 0.0
        states[place] = states[place] + (states[velocity] - falling * since / 2) * since
        states[velocity] = states[velocity] - falling * since


def _coordinates(scene):
    """Return (axis, name of the coordinate, name of its velocity) of all axes and discs."""
    discs, axes = range(1, scene.discs + 1), zip(scene.axes, "uvw", strict=False)
    return [(axis, f"{axis}{n}", f"{velocity}{n}") for axis, velocity in axes for n in discs]


def require_all_rows(trajectory, scene):
    """Raise ``InputError`` unless the discs move freely from each row to the next one.

    Labels of rows do not show that a row is missing, because they may have been renewed. The states
    show it. Rows of hops may be missing, because a hop changes no state.
    """
    names = ["time", *components(scene)]
    missing = [name for name in names if name not in trajectory]
    if missing or trajectory.empty:
        raise InputError(
            "trajectory must have all of its columns and at least one row, but has "
            f"{len(trajectory)} rows and lacks {', '.join(missing) or 'no column'}"
        )
    rows = {name: trajectory[name].to_numpy(float) for name in names}
    time, flown = rows["time"], {name: values[:-1] for name, values in rows.items()}
    free = np.diff(time) >= 0
    _fly(scene, flown, np.diff(time))
    for axis, place, velocity in _coordinates(scene):
        speeds = np.abs(rows[velocity][:-1]) + np.abs(flown[velocity])
        scale = scene.side(axis) + np.abs(rows[place][1:]) + speeds * time[1:]
        free &= np.abs(flown[place] - rows[place][1:]) <= FLIGHT_ROUNDING * scale
    if not free.all():
        first = int(free.argmin())
        raise InputError(
            "trajectory must have all rows from its first to its last, because the discs move "
            f"freely between them, but do not from the time {time[first]!s} to "
            f"{time[first + 1]!s}: rows are missing, in another order or rounded"
        )


@checked_call
def trajectory(
    scene: Scene,
    duration: float | None = None,
    *,
    seed: int = 1,
    start: Sequence[float | np.ndarray] | np.ndarray | np.void | str | PathLike[str] | None = None,
    hops: bool = True,
    name: str | None = None,
    progress: bool | None = None,
) -> Trajectory:
    """Follow one trajectory: a table with one row per event, its time, name and the state after it.

    Hops also have rows, unless you leave them out. On periodic axes positions go on beyond the
    cell.

    Parameters
    ----------
    scene : Scene
        The box, the discs and their effects.
    duration : float, optional
        The duration, in time, at most 10⁷ events, and for many discs at most 1.2e8 numbers of
        states: 29,000 events of 1024 discs. The table of N discs takes 32 N + 34 bytes a row, and
        at most as much again while it is made. If left out, it is some eight mean times of the
        rarest open hop or some 6000 events, for more than two discs 1500.
    seed : int, default 1
        Seed of the random numbers, from 0 to 2⁶³ − 1. The initial state is the first one of
        ``starts`` with this seed.
    start : state, sequence of float, pair of arrays or path-like, optional
        An initial state in the form of ``starts`` or of ``frames``, or its numbers, in this order
        or by their names (a dict, a ``Series``, a namedtuple): discs inside the box, without
        overlap, with the energy 1/2. Its centres are from the centre of the box. Those of a pair
        (centres, velocities), each (discs, axes), and of an extended XYZ file, whose last frame
        counts, are from the corner. Their velocities are scaled to the energy 1/2, which only
        changes the unit of time; in a field they must have it, if the potential energy of a disc on
        the floor is 0.
    hops : bool, default True
        Whether hops are rows. For many discs most rows are hops, which change no state: a table
        without them is shorter and ``states_at`` gives the same states.
    name, progress : optional
        See ``help(twodiscs)``.

    Returns
    -------
    Trajectory
        A pandas ``DataFrame``; ``states_at(times)`` and ``positions(times)`` give the states
        between its rows.

    Raises
    ------
    InputError
        For a start that is no state, and for a duration of more events: they are counted if a start
        is given. In a field also for a start that brings a disc to rest on the floor, from where it
        has no next bounce.

    Examples
    --------
    >>> path = td.trajectory(scene, 10, seed=1)
    >>> path["time"].iloc[-1]
    np.float64(10.0)
    >>> path.positions([1, 2.5]).shape  # time, disc, axis
    (2, 2, 2)
    """
    if not isinstance(hops, bool):
        raise InputError(f"hops must be True or False, not {quote(hops)}")
    seed = job_seed(scene, "trajectory", seed, name)
    with progress_bar(progress, f"trajectory r = {scene.radius:g}") as progress:
        if start is not None:
            start = from_corner(scene, start)
            start = start[-1] if getattr(start, "ndim", 0) == 3 else start
        rows = follow_trajectory(scene, seed, start, duration, progress, hops)
        return trajectory_table(scene, rows)


def from_corner(scene, given):
    """Return states that ``start`` and ``starts`` take, which are from the centre of the box.

    The path of an extended XYZ file and a pair (centres, velocities) are from the corner. Without a
    field their velocities get the energy 1/2, which only changes the unit of time. Anything else is
    returned as it is.
    """
    discs, axes = scene.discs, len(scene.axes)
    if isinstance(given, str | PathLike):
        parts = read_xyz(scene, given)
    else:
        try:
            sizes = {np.shape(part)[-2:] for part in given}
            parts = given if len(given) == 2 and sizes <= {(discs, axes), (discs, 3)} else None
        except (TypeError, ValueError):
            parts = None
        if parts is None:
            return given
    centres, velocities = (np.asarray(part, float)[..., :axes] for part in parts[:2])
    moving = [*np.moveaxis(velocities, -1, 0), *parts[2:]]
    weights = [1.0] * axes + [scene.moment_of_inertia] * len(parts[2:])
    if not scene.field:
        squares = sum(weight * part**2 for weight, part in zip(weights, moving, strict=True))
        twice = (squares @ np.array(scene.masses))[..., None]
        moving = [part * np.sqrt(2 * ENERGY / np.where(twice, twice, 1.0)) for part in moving]
    names = ["x", "y", "z"][:axes] + ["u", "v", "w"][:axes] + ["s"] * len(parts[2:])
    places = np.moveaxis(centres - np.array(scene.sides) / 2, -1, 0)
    known = dict(zip(names, [*places, *moving], strict=True))
    if missing := [field for field in disc_fields(scene) if field not in known]:
        raise InputError(f"start must have the spins of rough discs, {missing[0]} of each disc")
    return np.stack([known[field] for field in disc_fields(scene)], axis=-1)


def read_xyz(scene, path):
    """Return centres and velocities (frames, discs, 3) in an extended XYZ file, maybe spins.

    ASE reads these files, too, but takes a second to import, and only the columns that it knows.
    """
    path, frames = path_text(path), []
    opened = gzip.open if path.lower().endswith(".gz") else open
    try:
        with opened(path, "rt", encoding="utf-8") as file:
            for line in filter(str.strip, file):
                about = dict(part.split("=", 1) for part in shlex.split(file.readline()))
                kinds, columns, at = about["Properties"].split(":"), {}, 0
                lines = [file.readline().split() for _ in range(int(line))]
                widths = map(int, kinds[2::3])
                for name, kind, width in zip(kinds[::3], kinds[1::3], widths, strict=True):
                    if kind in "RI":
                        columns[name] = np.array([row[at : at + width] for row in lines], float)
                    at += width
                frames.append(_frame_of(scene, about, columns))
    except OSError as error:
        why = error.strerror or error
        raise InputError(f"start must be a file to read, not {path!r}: {why}") from None
    except (IndexError, KeyError, EOFError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        frames = []
    if not frames:
        raise InputError(
            "start must be an extended XYZ file with the columns pos and momenta (or velo), not "
            f"{path!r}"
        )
    return [np.array(part) for part in zip(*frames, strict=True)]


def _frame_of(scene, about, columns):
    """Return centres, velocities and maybe spins of a frame, if its box and its discs are right."""
    lattice = np.array(about["Lattice"].split(), float)[::4][: len(scene.sides)]
    if "id" in columns:
        order = np.argsort(columns["id"].ravel())
        columns = {name: column[order] for name, column in columns.items()}
    radii = columns.get("radius", np.array(scene.radii))
    is_right = len(columns["pos"]) == scene.discs and np.allclose(lattice, scene.sides, 1e-9, 0.0)
    if not is_right or not np.allclose(radii.ravel(), scene.radii, 1e-9, 0.0):
        raise InputError(
            f"start must have the box and the discs of the scene, not {len(columns['pos'])} discs "
            f"of the radii {quote(radii.ravel().tolist())} in a box of {lattice.tolist()}"
        )
    if "momenta" in columns:
        masses = columns.get("masses", np.array(scene.masses)[:, None])
        columns["velo"] = columns["momenta"] / masses
    names = ["pos", "velo", "spin"] if scene.moment_of_inertia is not None else ["pos", "velo"]
    centres, velocities, *spins = (columns[name] for name in names)
    return centres, velocities, *(spin[:, 0] for spin in spins)


def trajectory_table(scene, rows):
    """Return the ``Trajectory`` of a ``Scene`` with these ``Rows``, whose memory it takes over."""
    others = {
        "time": rows.times,
        "event": pd.Series(event_names(scene.discs)).array.take(rows.kinds),
    }
    for name, discs in zip(("first", "second"), rows.discs, strict=True):
        others[name] = pd.arrays.IntegerArray(discs, discs == 0)
    row_of = {name: row for row, name in enumerate(components(scene))}
    by_disc = sorted(row_of, key=lambda name: int(name[1:]))
    known = row_of | others
    names = [n for n in dict.fromkeys((*trajectory_columns(scene.discs), *by_disc)) if n in known]
    states = [name for name in names if name in row_of]
    order = [row_of[name] for name in states]
    step = max(1, CHUNK_NUMBERS // len(order))
    for at in range(0, rows.times.size, step):  # not all in one: that would be a copy of the table
        some = rows.states[:, at : at + step]
        some[:] = some[order]
    frame = Trajectory(rows.states.T, columns=states, copy=False)
    for name, column in others.items():
        frame.insert(names.index(name), name, pd.Series(column, copy=False))
    frame.attrs["scene"] = scene.parameters()
    return frame
