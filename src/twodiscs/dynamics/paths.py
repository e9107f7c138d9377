"""One trajectory, event by event, of two discs or more."""

import math
from itertools import repeat

import numpy as np

from twodiscs.dynamics.engine import find_engine
from twodiscs.dynamics.law import RESTING_SPEED
from twodiscs.dynamics.rows import Rows
from twodiscs.model.checks import InputError, check_length
from twodiscs.model.formats import format_number
from twodiscs.model.two_geometry import ENERGY
from twodiscs.sampling.initial_states import (
    MOST_NUMBERS,
    ROUNDING_OF_STATES,
    components,
    given_state,
    states,
)
from twodiscs.sampling.threads import map_in_threads

#: The most events of a trajectory, because all its rows are kept. Those of many discs have at most
#: ``MOST_NUMBERS``.
MOST_PATH_EVENTS = 1e7


def check_start(scene, start):
    """Return ``start`` as a state of the ``Scene``, in the form that engines take.

    ``start`` is one of ``initial_states.make_records``, or as many numbers. On periodic axes any
    image serves, and it stays. Raises ``InputError`` for anything else, for discs that overlap or
    lie outside, and for another energy than 1/2.
    """
    state = given_state(scene, start)
    check_states(scene, np.array(state)[:, None])
    return tuple(state)


def check_states(scene, states, name="start"):
    """Raise ``InputError`` unless all ``states`` (components, number) are states of the scene."""
    rows = dict(zip(components(scene), states, strict=True))

    def values(letter):
        return np.array([rows[f"{letter}{disc}"] for disc in range(1, scene.discs + 1)])

    radii, masses, centres = np.array(scene.radii), np.array(scene.masses), {}
    for axis in scene.axes:
        side, centres[axis] = scene.side(axis), values(axis)
        most = side / 2 - radii
        outside = np.abs(centres[axis]) > most[:, None] + ROUNDING_OF_STATES * side
        if axis in scene.walled and outside.any():
            disc, state = np.argwhere(outside)[0]
            raise InputError(
                f"{name} must have disc {disc + 1} inside the box, with {axis}{disc + 1} between "
                f"{-float(most[disc])!r} and {float(most[disc])!r}, not "
                f"{float(centres[axis][disc, state])!r}"
            )
    least, contact = math.inf, scene.contact_distance
    for disc in range(1, scene.discs):
        distances = 0.0
        for axis in scene.axes:
            side, apart = scene.side(axis), centres[axis][disc] - centres[axis][:disc]
            if axis in scene.periodic:
                apart -= side * np.round(apart / side)
            distances = np.hypot(distances, apart)
        least = min(least, float(distances.min()))
    if least < contact * (1 - ROUNDING_OF_STATES):
        raise InputError(
            f"{name} must have the discs apart, with {contact!r} or more between their centres, "
            f"not {least!r}"
        )
    energies = masses @ sum(values(letter) ** 2 for letter in "uvw"[: len(scene.axes)]) / 2
    if scene.moment_of_inertia is not None:
        energies += scene.moment_of_inertia * (masses @ values("s") ** 2) / 2
    if scene.field:
        energies += scene.field * (masses @ (values("y") + scene.height / 2 - radii[:, None]))
    wrong = np.abs(energies - ENERGY) > ROUNDING_OF_STATES
    if wrong.any():
        zero = "; in a field the potential energy of a disc on the floor is 0"
        raise InputError(
            f"{name} must have a total energy of {ENERGY}, not {float(energies[wrong][0])!r}"
            f"{zero if scene.field else ''}"
        )


def require_bounces(scene, rows):
    """Raise ``InputError`` if a disc in a field lies on the floor in one of the ``Rows``.

    Its next bounce would come after 0/0. Only a start that is given can lead to this, at the start
    or at a collision. Smaller speeds at the floor than ``RESTING_SPEED`` are rest.
    """
    state = dict(zip(components(scene), rows.states, strict=True))
    for disc, radius in enumerate(scene.radii if scene.field else (), 1):
        height = np.abs(state[f"y{disc}"] + (scene.height / 2 - radius))
        lies = state[f"v{disc}"] ** 2 + 2 * scene.field * height < RESTING_SPEED**2
        if lies.any():
            raise InputError(
                f"start must not bring disc {disc} to rest on the floor, as it does at the time "
                f"{float(rows.times[lies.argmax()])!r}: in a field a disc needs a height or a "
                "vertical velocity there, or it has no next bounce"
            )


def follow_trajectory(scene, seed, start=None, duration=None, progress=None, hops=True):
    """Return the ``Rows`` of one trajectory of a ``Scene``, with or without those of ``hops``.

    It starts from the invariant measure, with the random stream of ``seed``, unless a ``start`` is
    given (see ``check_start``). Without a ``duration`` it has the ``usual_duration``. Raises
    ``InputError`` for anything that is not a ``Scene``, for a seed that is not an integer ≥ 0, and
    for a start that is no state or leads to rest (see ``require_bounces``). The same holds for a
    duration that is no length or has more than ``most_rows``: a mean number for a start that is
    drawn, a count for one that is given. ``progress``, if given, is called now and then with the
    time that it has reached, and the ``duration``.
    """
    engine, most = find_engine(scene), most_rows(scene)
    rate = engine.paths.trajectory_rate(scene, hops)

    def too_long(time, due):
        return InputError(
            f"duration must be below {format_number(time, '.3g')}, where "
            f"{format_number(most, '.3g')} events {due} and fill "
            f"{format_number(most * row_bytes(scene) / 1e9, '.2g')} GB, not {duration!r}"
        )

    if duration is None:
        duration = engine.paths.usual_duration(scene)
    elif check_length("duration", duration) * rate > most and start is None:
        raise too_long(most / rate, "are due")
    if start is None:
        drawn, left = states(scene, 1, seed)[: len(components(scene)), 0], math.inf
        start = tuple(map(float, drawn))
    else:
        start, left = check_start(scene, start), int(most)
    found, rows = [], engine.paths.path_rows(scene, start, float(duration), seed, hops)
    for some in map_in_threads(lambda: next(rows, None), repeat(())):
        if some is None:
            return Rows.joined(found)
        require_bounces(scene, some)
        found.append(Rows(*map(np.copy, some)))  # without the memory of rows that are not filled
        left -= some.times.size
        if left < 0:
            # Rounded down: a user who types the number has fewer rows.
            raise too_long(0.995 * some.times[left], "have happened")
        if progress is not None:
            progress(float(some.times[-1]), float(duration))


def most_rows(scene):
    """Return the most rows of a trajectory of a ``Scene``."""
    return min(MOST_PATH_EVENTS, MOST_NUMBERS / len(components(scene)))


def row_bytes(scene):
    """Return the memory of a row of a trajectory as a table: for N discs 32 N + 34 or more."""
    return 8 * len(components(scene)) + 34
