"""One trajectory, event by event: for people to look at, and for what is asked of one."""

import math

from twodiscs.dynamics.ensemble import across, nearest_power_of_two
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
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.starts import components, states
from twodiscs.theory import exact

#: Wall and disc events that a trajectory lasts at most, on average.
LONGEST_TRAJECTORY = 6000

#: Events that one may ask for: all of its rows are kept.
MOST_EVENTS = 1e7

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


def _row(time, event, state, scene):
    """Return (time, x1, y1, x2, y2, event, z1, z2), None for z in the plane."""
    return (time, *state[:4], event, *((None, None) if scene.depth is None else state[8:10]))


def follow(scene, state, duration):
    """Yield the ``COLUMNS`` of all that happens within ``duration``.

    ``state`` of the ``Scene`` is as in ``law``; z1 and z2 are None in the plane. Hops are events
    here, reported where they occur in a flight; walls are named by disc and axis, and the places
    after a jump of a periodic separation follow the name of its axis; the first row is the start,
    the last one the end.
    """
    law, time = law_of(scene), 0.0
    yield _row(time, "start", state, scene)
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
            yield _row(time + until, name, after_event(state, until, END_OF_TIME, law), scene)
        time, state = time + flight, after
        yield _row(time, _NAMES[code], state, scene)
        if code == END_OF_TIME:
            return


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

    It starts from the invariant measure, with the random stream of ``seed``, unless a ``start`` is
    given (see ``state_of``). Without a ``duration`` it lasts some eight mean times of the rarest
    hop that is open, but no longer than ``LONGEST_TRAJECTORY`` wall and disc events on average.
    Raises ``InputError`` for anything that is not a ``Scene``, for a seed that is not an integer
    ≥ 0, for a start that is no state, and for a duration that is no length or takes
    ``MOST_EVENTS``.
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
    return list(follow(scene, tuple(start), float(duration)))
