"""One trajectory, event by event: for people to look at, and for what is asked of one."""

import math
from itertools import islice, repeat

import numpy as np

from twodiscs.dynamics.ensemble import across, nearest_power_of_two, put_state, state_at
from twodiscs.dynamics.law import (
    DISC,
    END_OF_TIME,
    WALL_X1,
    WALL_X2,
    WALL_Y1,
    WALL_Y2,
    WALL_Z1,
    WALL_Z2,
    WRAP_X,
    WRAP_Y,
    WRAP_Z,
    after_event,
    crosses,
    crossing_time,
    law_of,
    next_event,
)
from twodiscs.model.checks import InputError, check_integer, check_length, format_number, quote
from twodiscs.model.events import HOPS
from twodiscs.model.scene import ENERGY, check_scene, check_two_discs
from twodiscs.sampling.blocks.threads import in_threads
from twodiscs.sampling.jit import compiled, optional
from twodiscs.sampling.starts import components, states
from twodiscs.theory import exact

#: Wall and disc events that a trajectory lasts at most, on average.
LONGEST_TRAJECTORY = 6000

#: So many of more than two discs, whose rows are longer, and of which some pair often hops.
LONGEST_OF_MANY = 1500

#: Events that one may ask for: all of its rows are kept.
MOST_EVENTS = 1e7

#: Rows that are made at a time: some hundredths of a second.
ROWS = 1000

#: What a row of a trajectory holds.
COLUMNS = ("time", "x1", "y1", "x2", "y2", "event", "z1", "z2")

#: What more than two discs have after their centres: which of them the event is of.
DISCS = ("first", "second")

#: How far rounding may have moved a state that is handed in, over the sides and the energy.
ROUNDING = 1e-9

#: Names of what ends a flight, by code; only disc 1 on the right and on top has a name as an event.
_NAMES = {
    END_OF_TIME: "end",
    WALL_X1: "wall_x1",
    WALL_Y1: "wall_y1",
    WALL_X2: "wall_x2",
    WALL_Y2: "wall_y2",
    DISC: "disc_collision",
    WALL_Z1: "wall_z1",
    WALL_Z2: "wall_z2",
    WRAP_X: "wrap_x",
    WRAP_Y: "wrap_y",
    WRAP_Z: "wrap_z",
}


@compiled
def advance(state, law):
    """Return the state after the next event, and the time and code of that event."""
    time, code = next_event(state, math.inf, law)
    return after_event(state, time, code, law), time, code


@compiled
def time_to_next(state, law, hop, longest):
    """Return the time to the next vertical hop, or to the next disc collision if not ``hop``.

    Where it is more than ``longest``, some such time is returned.
    """
    elapsed = 0.0
    while elapsed <= longest:
        before, rising = across(state, None)
        state, time, code = advance(state, law)
        if hop and crosses(before, across(state, None)[0]):
            return elapsed + crossing_time(before, rising)
        elapsed += time
        if code == DISC and not hop:
            break
    return elapsed


@optional(lambda state, present: 0.0)
def deep_separation(state, present):
    """Return z1 − z2, or 0 in the plane."""
    return state[8] - state[9]


@compiled
def advance_all(states, wraps, time, law):
    """Advance the columns of ``states`` (``COMPONENTS``, n) by a ``time`` > 0.

    Jumps of a periodic separation along x, y, z are added to ``wraps`` (3, n), with the sign of the
    separation before.
    """
    for i in range(states.shape[1]):
        state, left, code = state_at(states, i, law), time, 1.0
        while code != END_OF_TIME:
            flight, code = next_event(state, left, law)
            state = after_event(state, flight, code, law)
            left -= flight
            if code == WRAP_X:
                wraps[0, i] -= math.copysign(1.0, state[0] - state[2])
            elif code == WRAP_Y:
                wraps[1, i] -= math.copysign(1.0, state[1] - state[3])
            elif code == WRAP_Z:
                wraps[2, i] -= math.copysign(1.0, deep_separation(state, law.depth))
        put_state(states, i, state, law)


def unwrapped(scene, columns, wraps):
    """Add to places what jumps of a periodic separation took from them, so that paths go on.

    ``columns`` are arrays by name, ``wraps`` those of ``advance_all``, or of ``many.advance_all``.
    """
    if scene.discs > 2:
        for disc, laps in enumerate(wraps, 1):
            columns[f"x{disc}"] += scene.width * laps
        return
    law = law_of(scene)
    for k, axis in enumerate("xyz"):
        if axis in scene.periodic:
            _, first, second = getattr(law, f"wrap_{axis}")
            columns[f"{axis}1"] += first * wraps[k]
            columns[f"{axis}2"] -= second * wraps[k]


def events_of(scene, state, duration):
    """Yield (time, event, state) of all that happens within ``duration``.

    ``state`` of the ``Scene`` is as in ``law``. Hops are events here, reported where they occur in
    a flight; walls are named by disc and axis, and the places after a jump of a periodic separation
    follow the name of its axis; the first row is the start, the last one the end.
    """
    law, time = law_of(scene), 0.0
    yield time, "start", state
    while True:
        flight, code = next_event(state, duration - time, law)
        after = after_event(state, flight, code, law)
        hops = []
        for name, horizontal in (("vertical_hop", None), ("horizontal_hop", True)):
            before, rising = across(state, horizontal)
            passed = crosses(before, across(after, horizontal)[0])
            if name in scene.events and passed:
                hops.append((crossing_time(before, rising), name))
        for until, name in sorted(hops):
            yield time + until, name, after_event(state, until, END_OF_TIME, law)
        time, state = time + flight, after
        yield time, _NAMES[code], state
        if code == END_OF_TIME:
            return


def _row(scene, time, event, state):
    """Return ``COLUMNS``: (time, x1, y1, x2, y2, event, z1, z2), None for z in the plane."""
    return (time, *state[:4], event, *((None, None) if scene.depth is None else state[8:10]))


def follow(scene, state, duration):
    """Yield the rows of ``COLUMNS`` of ``events_of``, with the same arguments."""
    for time, event, now in events_of(scene, state, duration):
        yield _row(scene, time, event, now)


def columns(scene):
    """Return what a row of a trajectory of a ``Scene`` holds: ``COLUMNS``, or that of N discs.

    These have time, x1, y1, …, xN, yN, event, and the numbers of the disc, or of both of the pair,
    that the event is of: first < second, None where there is none.
    """
    if scene.discs == 2:
        return COLUMNS
    centres = (f"{axis}{disc}" for disc in range(1, scene.discs + 1) for axis in "xy")
    return ("time", *centres, "event", *DISCS)


def events_of_many(scene, state, duration):
    """Yield (time, event, first, second, state) of more than two discs.

    ``state`` is an array of 4N numbers, as a column of ``starts.states``; events are as in
    ``events_of``, but for a wall, which is called by its axis, wall_x or wall_y. ``first`` and
    ``second`` are the numbers of the discs that the event is of, None where there is none. On a
    ring places go on beyond the cell, and there is no event in that.
    """
    from twodiscs.dynamics import many  # a kernel that two discs have no use for

    n, law, time = scene.discs, many.law_of(scene.gas), 0.0
    x, y, u, v = (np.array(part)[:, None] for part in np.reshape(state, (4, n)))
    ring = law.ring[0] if law.ring else None
    # By so much places are beyond the cell that the kernel keeps to.
    beyond = ring * np.round(x / ring) if ring else np.zeros_like(x)
    x -= beyond
    old_x, old_y, counts = np.zeros_like(x), np.zeros_like(y), np.zeros((many.N, 1))
    remaining, times, codes, speeds = (np.full(1, float(duration)) for _ in range(4))
    pairs = [(j, i) for i in range(n) for j in range(i)]
    along = ((n, "vertical_hop"), (0, "horizontal_hop"))
    along = [(start, hop) for start, hop in along if hop in scene.events]
    yield time, "start", None, None, np.ravel([x + beyond, y, u, v])
    while True:
        before, speed = np.ravel([x + beyond, y]), np.ravel([u, v])
        many.find_events(x, y, u, v, remaining, times, codes, speeds, law)
        flight, code = float(times[0]), int(codes[0])
        many.advance(x, y, u, v, old_x, old_y, remaining, times, codes, counts, law, True)
        if ring:
            beyond = ring * np.round(((before + flight * speed)[:n, None] - x) / ring)
        after, hops = np.ravel([x + beyond, y]), []
        for start, name in along:
            for i, j in pairs:
                a, b = start + i, start + j
                apart = before[a] - before[b]
                if crosses(apart, after[a] - after[b]):
                    hops.append((crossing_time(apart, speed[a] - speed[b]), name, i, j))
        for until, name, i, j in sorted(hops):
            then = before + until * speed
            yield time + until, name, i + 1, j + 1, np.concatenate([then, speed])
        time, now = time + flight, np.ravel([x + beyond, y, u, v])
        if code == int(END_OF_TIME):
            yield float(duration), "end", None, None, now
            return
        if code > 2 * n:
            i, j = pairs[code - 2 * n - 1]
            yield time, "disc_collision", i + 1, j + 1, now
        elif code > 0:
            yield time, f"wall_{'xy'[(code - 1) % 2]}", (code - 1) // 2 + 1, None, now


def followed_many(scene, seed, start=None, duration=None, progress=None):
    """Return the rows of ``events_of_many`` as a list, as ``followed`` does of two discs.

    A ``start`` is one of ``starts.states``, and without a ``duration`` they last some
    ``LONGEST_OF_MANY`` events.
    """
    from twodiscs.dynamics import many

    seed = check_integer("seed", seed, 0)
    rate = many.expected_event_rate(scene)
    if duration is None:
        duration = nearest_power_of_two(LONGEST_OF_MANY / rate)
    elif check_length("duration", duration) * rate > MOST_EVENTS:
        raise InputError(_too_long(duration, rate))
    state = states(scene, 1, seed)[:, 0] if start is None else _state_of_many(scene, start)
    return _listed(events_of_many(scene, state, float(duration)), float(duration), progress)


def _listed(events, duration, progress):
    """Return all ``events`` as a list; ``progress`` is called now and then (see ``followed``)."""
    rows = []
    for some in in_threads(lambda: [*islice(events, ROWS)], repeat(())):
        rows += some
        if progress is not None:
            progress(rows[-1][0], duration)
        if len(some) < ROWS:
            return rows


def _too_long(duration, rate):
    return (
        f"duration must be below {format_number(MOST_EVENTS / rate, '.3g')}, where "
        f"{format_number(MOST_EVENTS, 'g')} events are due, not {duration!r}"
    )


def _no_state(names, start):
    """Return the ``InputError`` for a ``start`` that is not a number for each of the ``names``."""
    hint = ""
    if np.shape(start) and getattr(getattr(start, "dtype", None), "names", None):
        hint = "; start[0] is one of these states"
    elif hasattr(start, "iloc"):
        hint = "; states_at(times)[0] is a state of a trajectory"
    return InputError(f"start must be the numbers {', '.join(names)}, not {quote(start)}{hint}")


def _state_of_many(scene, start):
    """Return ``start`` as an array of 4N numbers, checked as in ``state_of``."""
    names, n = components(scene), scene.discs
    try:
        state = np.array([float(value) for value in start])
    except (TypeError, ValueError, OverflowError):
        state = np.array([])
    if state.size != len(names) or not np.isfinite(state).all():
        raise _no_state(names, start)
    (x, y), velocities = state[: 2 * n].reshape(2, n), state[2 * n :]
    for axis in scene.walled:
        centres = x if axis == "x" else y
        reach = scene.side(axis) / 2 - scene.radius
        if (disc := int(np.argmax(np.abs(centres)))) >= 0 and abs(centres[disc]) > reach + (
            ROUNDING * scene.side(axis)
        ):
            raise InputError(
                f"start must have disc {disc + 1} inside the box, with {axis}{disc + 1} between "
                f"{-reach!r} and {reach!r}, not {float(centres[disc])!r}"
            )
    dx = x[:, None] - x
    if scene.periodic:
        dx -= scene.width * np.round(dx / scene.width)
    apart = np.hypot(dx, y[:, None] - y)[np.triu_indices(n, 1)].min()
    if apart < scene.contact_distance * (1 - ROUNDING):
        raise InputError(
            f"start must have the discs apart, with {scene.contact_distance!r} or more between "
            f"their centres, not {float(apart)!r}"
        )
    if abs((energy := float(velocities @ velocities) / 2) - ENERGY) > ROUNDING:
        raise InputError(f"start must have a total energy of {ENERGY}, not {energy!r}")
    return state


def state_of(scene, start):
    """Return ``start`` as a state of the ``Scene``: a tuple of floats, as ``law`` has it.

    ``start`` is one of ``sampling.starts.records``, or as many numbers. On periodic axes any image
    of disc 2 serves. Raises ``InputError`` for anything else, for discs that overlap or lie
    outside, and for another energy than 1/2.
    """
    names = components(check_scene(scene))
    try:
        state = dict(zip(names, map(float, start), strict=True))
    except (TypeError, ValueError, OverflowError):
        state = {}
    if len(state) != len(names) or not all(map(math.isfinite, state.values())):
        raise _no_state(names, start)
    apart = {}
    for axis in scene.axes:
        side = scene.side(axis)
        if axis in scene.walled:
            for disc, radius in enumerate(scene.radii, 1):
                reach, centre = side / 2 - radius, state[f"{axis}{disc}"]
                if abs(centre) > reach + ROUNDING * side:
                    raise InputError(
                        f"start must have disc {disc} inside the box, with {axis}{disc} between "
                        f"{-reach!r} and {reach!r}, not {centre!r}"
                    )
        apart[axis] = state[f"{axis}1"] - state[f"{axis}2"]
        if axis in scene.periodic:
            apart[axis] = math.remainder(apart[axis], side)
            state[f"{axis}2"] = state[f"{axis}1"] - apart[axis]
    distance, contact = math.hypot(*apart.values()), scene.contact_distance
    if distance < contact * (1 - ROUNDING):
        raise InputError(
            f"start must have the discs apart, with {contact!r} or more between their centres, not "
            f"{distance!r}"
        )
    energy = _energy(scene, state)
    if abs(energy - ENERGY) > ROUNDING:
        raise InputError(f"start must have a total energy of {ENERGY}, not {energy!r}")
    return tuple(state.values())


def _energy(scene, state):
    """Return the total energy of a state, {name: value}, of a ``Scene``."""
    energy = 0.0
    for disc, (mass, radius) in enumerate(zip(scene.masses, scene.radii, strict=True), 1):
        speeds = [state[f"{name}{disc}"] for name in "uvw"[: len(scene.axes)]]
        energy += mass * math.fsum(speed * speed for speed in speeds) / 2
        if scene.moment_of_inertia is not None:
            energy += mass * scene.moment_of_inertia * state[f"s{disc}"] ** 2 / 2
        if scene.field:
            energy += mass * scene.field * (state[f"y{disc}"] + scene.height / 2 - radius)
    return energy


def trajectory(scene, seed, start=None, duration=None):
    """Return one trajectory of a ``Scene``, as rows of ``follow``, or of ``columns``.

    Arguments and errors are those of ``followed``, or of ``followed_many`` for more than two discs.
    """
    if check_scene(scene).discs > 2:
        n, rows = 2 * scene.discs, followed_many(scene, seed, start, duration)
        return [
            (time, *np.reshape(state[:n], (2, -1)).T.ravel().tolist(), event, first, second)
            for time, event, first, second, state in rows
        ]
    return [_row(scene, *row) for row in followed(scene, seed, start, duration)]


def followed(scene, seed, start=None, duration=None, progress=None):
    """Return one trajectory of a ``Scene``, as a list of (time, event, state), of ``events_of``.

    It starts from the invariant measure, with the random stream of ``seed``, unless a ``start`` is
    given (see ``state_of``). Without a ``duration`` it lasts some eight mean times of the rarest
    hop that is open, but no longer than ``LONGEST_TRAJECTORY`` wall and disc events on average.
    Raises ``InputError`` for anything that is not a ``Scene``, for a seed that is not an integer
    ≥ 0, for a start that is no state, and for a duration that is no length or takes
    ``MOST_EVENTS``. ``progress``, if given, is called now and then with the time that it has
    reached, and the ``duration``.
    """
    seed = check_integer("seed", seed, 0)
    rate = exact.event_rate(check_two_discs(scene, "states of two"))
    rate *= exact.work_per_event(scene)
    if duration is None:
        hops = [exact.mean_times(scene)[hop] for hop in HOPS if scene.is_possible(hop)]
        duration = min(8 * max(hops, default=math.inf), LONGEST_TRAJECTORY / rate)
        duration = nearest_power_of_two(duration)
    elif check_length("duration", duration) * rate > MOST_EVENTS:
        raise InputError(_too_long(duration, rate))
    if start is None:
        start = map(float, states(scene, 1, seed)[: len(components(scene)), 0])
    else:
        start = state_of(scene, start)
    return _listed(events_of(scene, tuple(start), float(duration)), float(duration), progress)
