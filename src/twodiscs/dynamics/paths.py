"""One trajectory, event by event: ``two.path`` follows two discs, ``many.engine`` more."""

from itertools import islice, repeat

import numpy as np

from twodiscs.dynamics.two import path
from twodiscs.model.checks import InputError, check_length, format_number
from twodiscs.model.two_geometry import ENERGY
from twodiscs.sampling.initial_states import MOST_NUMBERS, ROUNDING, components, given_state, states
from twodiscs.sampling.rounds import map_in_threads

#: The most events of a trajectory, because all its rows are kept. Those of many discs have at most
#: ``MOST_NUMBERS``.
MOST_EVENTS = 1e7

#: Rows that are made at a time: some hundredths of a second.
ROWS = 1000


def path_of(scene):
    """Return the module that follows one path of a ``Scene``: of two discs, or of many.

    Its ``advance_all(scene, states, wraps, time, kicks)`` advances the columns of ``states`` by a
    ``time`` > 0; each centre stays in its cell. ``wraps``, from ``new_wraps(scene, number)``, count
    how often a centre was moved back along a periodic axis. ``unwrap(scene, columns, wraps)`` adds
    these moves to the centres in ``columns``, arrays by name. ``kicks_of(scene, number, seed,
    block)`` returns the kicks of the states of a block, from the streams of ``seed``; they go on
    from one call to the next, and are None without friction.
    """
    if scene.discs == 2:
        return path
    from twodiscs.dynamics.many import engine

    return engine


def events_of(scene, state, duration, seed=0):
    """Yield (time, event, first, second, state) of each event within ``duration``.

    ``state`` is one of ``starts.states`` as a tuple or column. The first event is "start", the last
    one "end"; hops are events, walls are named by axis and disc, "wall_x1" say. With friction
    "kick" is an event, because a path turns there; kicks come from the streams of ``seed``.
    """
    return path_of(scene).events_of(scene, state, duration, seed)


def state_of(scene, start):
    """Return ``start`` as a state of the ``Scene``, in the form that ``events_of`` takes.

    ``start`` is one of ``starts.as_records``, or as many numbers. On periodic axes any image
    serves, and it stays. Raises ``InputError`` for anything else, for discs that overlap or lie
    outside, and for another energy than 1/2.
    """
    state = dict(zip(components(scene), given_state(scene, start), strict=True))

    def of_discs(name):
        return np.array([state[f"{name}{disc}"] for disc in range(1, scene.discs + 1)])

    radii, masses, distances = np.array(scene.radii), np.array(scene.masses), 0.0
    for axis in scene.axes:
        side, centres = scene.side(axis), of_discs(axis)
        apart = centres[:, None] - centres
        if axis in scene.periodic:
            apart -= side * np.round(apart / side)
        distances = np.hypot(distances, apart)
        most = side / 2 - radii
        for disc in np.flatnonzero(np.abs(centres) > most + ROUNDING * side):
            if axis in scene.walled:
                raise InputError(
                    f"start must have disc {disc + 1} inside the box, with {axis}{disc + 1} "
                    f"between {-float(most[disc])!r} and {float(most[disc])!r}, not "
                    f"{float(centres[disc])!r}"
                )
    distance, contact = distances[np.triu_indices(scene.discs, 1)].min(), scene.contact_distance
    if distance < contact * (1 - ROUNDING):
        raise InputError(
            f"start must have the discs apart, with {contact!r} or more between their centres, not "
            f"{float(distance)!r}"
        )
    energy = masses @ sum(of_discs(name) ** 2 for name in "uvw"[: len(scene.axes)]) / 2
    if scene.moment_of_inertia is not None:
        energy += scene.moment_of_inertia * (masses @ of_discs("s") ** 2) / 2
    if scene.field:
        energy += scene.field * (masses @ (of_discs("y") + scene.height / 2 - radii))
    if abs(energy - ENERGY) > ROUNDING:
        raise InputError(f"start must have a total energy of {ENERGY}, not {float(energy)!r}")
    return tuple(state.values())


def followed(scene, seed, start=None, duration=None, progress=None):
    """Return one trajectory of a ``Scene``, as a list of what ``events_of`` yields.

    It starts from the invariant measure, with the random stream of ``seed``, unless a ``start`` is
    given (see ``state_of``). Without a ``duration`` it has the ``usual_duration``. Raises
    ``InputError`` for anything that is not a ``Scene``, for a seed that is not an integer ≥ 0, and
    for a start that is no state. The same holds for a duration that is no length or takes
    ``MOST_EVENTS``. ``progress``, if given, is called now and then with the time that it has
    reached, and the ``duration``.
    """
    rate = path_of(scene).trajectory_rate(scene)
    most = min(MOST_EVENTS, MOST_NUMBERS / len(components(scene)))
    if duration is None:
        duration = path_of(scene).usual_duration(scene)
    elif check_length("duration", duration) * rate > most:
        raise InputError(
            f"duration must be below {format_number(most / rate, '.3g')}, where "
            f"{format_number(most, '.3g')} events are due, not {duration!r}"
        )
    if start is None:
        start = tuple(map(float, states(scene, 1, seed)[: len(components(scene)), 0]))
    else:
        start = state_of(scene, start)
    rows, events = [], events_of(scene, start, float(duration), seed)
    for some in map_in_threads(lambda: [*islice(events, ROWS)], repeat(())):
        rows += some
        if progress is not None:
            progress(rows[-1][0], float(duration))
        if len(some) < ROWS:
            return rows
