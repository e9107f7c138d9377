"""One trajectory, event by event: for people to look at, and for what is asked of one."""

import math
from itertools import islice, repeat

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
from twodiscs.model.checks import InputError, length, whole
from twodiscs.model.events import HOPS
from twodiscs.model.scene import ENERGY, a_scene
from twodiscs.sampling.blocks.threads import in_threads
from twodiscs.sampling.jit import compiled, optional
from twodiscs.sampling.starts import components, states
from twodiscs.theory import exact

#: Wall and disc events that a trajectory lasts at most, on average.
LONGEST_TRAJECTORY = 6000

#: Events that one may ask for: all of its rows are kept.
MOST_EVENTS = 1e7

#: Rows that are made at a time: some hundredths of a second.
ROWS = 1000

#: What a row of a trajectory holds.
COLUMNS = ("time", "x1", "y1", "x2", "y2", "event", "z1", "z2")

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

    ``columns`` are arrays by name, ``wraps`` those of ``advance_all``.
    """
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


def state_of(scene, start):
    """Return ``start`` as a state of the ``Scene``: a tuple of floats, as ``law`` has it.

    ``start`` is one of ``sampling.starts.records``, or as many numbers. On periodic axes any image
    of disc 2 serves. Raises ``InputError`` for anything else, for discs that overlap or lie
    outside, and for another energy than 1/2.
    """
    names = components(a_scene(scene))
    try:
        state = dict(zip(names, map(float, start), strict=True))
    except (TypeError, ValueError, OverflowError):
        state = {}
    if len(state) != len(names) or not all(map(math.isfinite, state.values())):
        raise InputError(f"start must be the numbers {', '.join(names)}, not {start!r}")
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
    """Return one trajectory of a ``Scene``, as rows of ``follow``.

    Arguments and errors are those of ``followed``.
    """
    return [_row(scene, *row) for row in followed(scene, seed, start, duration)]


def followed(scene, seed, start=None, duration=None, watch=None):
    """Return one trajectory of a ``Scene``, as a list of (time, event, state), of ``events_of``.

    It starts from the invariant measure, with the random stream of ``seed``, unless a ``start`` is
    given (see ``state_of``). Without a ``duration`` it lasts some eight mean times of the rarest
    hop that is open, but no longer than ``LONGEST_TRAJECTORY`` wall and disc events on average.
    Raises ``InputError`` for anything that is not a ``Scene``, for a seed that is not an integer
    ≥ 0, for a start that is no state, and for a duration that is no length or takes
    ``MOST_EVENTS``. ``watch``, if given, is called now and then with the time that it has reached,
    and the ``duration``.
    """
    seed, rate = whole("seed", seed, 0), exact.event_rate(a_scene(scene))
    rate *= exact.work_per_event(scene)
    if duration is None:
        hops = [exact.mean_times(scene)[hop] for hop in HOPS if scene.is_possible(hop)]
        duration = min(8 * max(hops, default=math.inf), LONGEST_TRAJECTORY / rate)
        duration = nearest_power_of_two(duration)
    elif length("duration", duration) * rate > MOST_EVENTS:
        raise InputError(
            f"duration must be below {MOST_EVENTS / rate:.3g}, where {MOST_EVENTS:g} events are "
            f"due, not {duration!r}"
        )
    if start is None:
        start = map(float, states(scene, 1, seed)[: len(components(scene)), 0])
    else:
        start = state_of(scene, start)
    events, rows = events_of(scene, tuple(start), float(duration)), []
    for some in in_threads(lambda: [*islice(events, ROWS)], repeat(())):
        rows += some
        if watch is not None:
            watch(rows[-1][0], float(duration))
        if len(some) < ROWS:
            return rows
