"""One trajectory, event by event: ``two.path`` follows two discs, ``many.path`` more."""

from itertools import islice, repeat

from twodiscs.model.checks import (
    InputError,
    check_integer,
    check_length,
    format_number,
)
from twodiscs.model.scene import check_scene
from twodiscs.sampling.rounds import in_threads
from twodiscs.sampling.starts import MOST_NUMBERS, components, states

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
    if check_scene(scene).discs > 2:
        from twodiscs.dynamics.many import path
    else:
        from twodiscs.dynamics.two import path
    return path


def events_of(scene, state, duration, seed=0):
    """Yield (time, event, first, second, state) of each event within ``duration``.

    ``state`` is one of ``starts.states`` as a tuple or column. The first event is "start", the last
    one "end"; hops are events, walls are named by axis and disc, "wall_x1" say. With friction
    "kick" is an event, because a path turns there; kicks come from the streams of ``seed``.
    """
    return path_of(scene).events_of(scene, state, duration, seed)


def state_of(scene, start):
    """Return ``start`` as a state of the ``Scene``, in the form that ``events_of`` takes.

    ``start`` is one of ``sampling.starts.records``, or as many numbers. On periodic axes any image
    serves. Raises ``InputError`` for anything else, for discs that overlap or lie outside, and for
    another energy than 1/2.
    """
    return path_of(scene).state_of(scene, start)


def followed(scene, seed, start=None, duration=None, progress=None):
    """Return one trajectory of a ``Scene``, as a list of what ``events_of`` yields.

    It starts from the invariant measure, with the random stream of ``seed``, unless a ``start`` is
    given (see ``state_of``). Without a ``duration`` it has the ``usual_duration``. Raises
    ``InputError`` for anything that is not a ``Scene``, for a seed that is not an integer ≥ 0, and
    for a start that is no state. The same holds for a duration that is no length or takes
    ``MOST_EVENTS``. ``progress``, if given, is called now and then with the time that it has
    reached, and the ``duration``.
    """
    seed = check_integer("seed", seed, 0)
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
    for some in in_threads(lambda: [*islice(events, ROWS)], repeat(())):
        rows += some
        if progress is not None:
            progress(rows[-1][0], float(duration))
        if len(some) < ROWS:
            return rows
