"""One trajectory of two discs, event by event."""

import math
from dataclasses import replace

import numpy as np

from twodiscs.dynamics import law as codes
from twodiscs.dynamics.ensemble import kick_limit, nearest_power_of_two, open_block_kicks
from twodiscs.dynamics.law import after_event, crosses, crossing_time, next_event, two_disc_law
from twodiscs.dynamics.two.follow import kicked, new_kicks, put_state, relative_motion, state_at
from twodiscs.model.events import HOPS
from twodiscs.sampling.initial_states import components
from twodiscs.sampling.jit import compiled, optional
from twodiscs.theory import exact

#: Wall and disc events that a trajectory lasts at most, on average.
LONGEST_TRAJECTORY = 6000

#: The name of the event that ends a flight, by code, and the discs that it is of.
_NAMES = {
    codes.END_OF_TIME: ("end", None, None),
    codes.WALL_X1: ("wall_x1", 1, None),
    codes.WALL_Y1: ("wall_y1", 1, None),
    codes.WALL_X2: ("wall_x2", 2, None),
    codes.WALL_Y2: ("wall_y2", 2, None),
    codes.DISC: ("disc_collision", 1, 2),
    codes.WALL_Z1: ("wall_z1", 1, None),
    codes.WALL_Z2: ("wall_z2", 2, None),
    codes.KICK: ("kick", None, None),
}

#: The axis of the periodic separation that jumps at the end of a flight, and the places of both
#: centres in a state, by code.
_JUMPS = {codes.WRAP_X: (0, 0, 2), codes.WRAP_Y: (1, 1, 3), codes.WRAP_Z: (2, 8, 9)}


@optional(lambda state, present: 0.0)
def deep_separation(state, present):
    """Return z1 − z2, or 0 in the plane."""
    return state[8] - state[9]


@optional(lambda left, kicks: False)
def is_left(left, kicks):
    """Say whether time is left after a flight that ended without an event."""
    return left > 0.0


@compiled
def advance_states(states, wraps, time, law, kicks):
    """Advance the columns of ``states`` (``COMPONENTS``, n) by a ``time`` > 0.

    Jumps of a periodic separation along x, y, z are added to ``wraps`` (3, n), with the sign of the
    separation before. ``kicks`` are those of the columns, None without friction.
    """
    for i in range(states.shape[1]):
        state, left, code = state_at(states, i, law), time, 1.0
        while code != codes.END_OF_TIME or is_left(left, kicks):
            flight, code = next_event(state, kick_limit(left, i, kicks), law)
            state = after_event(state, flight, code, law)
            state = kicked(state, i, flight, law, kicks)
            left -= flight
            if code == codes.WRAP_X:
                wraps[0, i] -= math.copysign(1.0, state[0] - state[2])
            elif code == codes.WRAP_Y:
                wraps[1, i] -= math.copysign(1.0, state[1] - state[3])
            elif code == codes.WRAP_Z:
                wraps[2, i] -= math.copysign(1.0, deep_separation(state, law.depth))
        put_state(states, i, state, law)


def advance_all(scene, states, wraps, time, kicks):
    """Advance the columns of ``states``, see ``Engine``."""
    advance_states(states, wraps, time, two_disc_law(scene), kicks)


def unwrap(scene, columns, wraps):
    """Undo the jumps of a periodic separation, see ``Engine``."""
    law = two_disc_law(scene)
    for axis, wrap, jumps in zip("xyz", (law.wrap_x, law.wrap_y, law.wrap_z), wraps, strict=True):
        if wrap is not None:
            columns[f"{axis}1"] += wrap[1] * jumps
            columns[f"{axis}2"] -= wrap[2] * jumps


def nearest_image(scene, state):
    """Return ``state`` with the image of disc 2 that is nearest to disc 1, and the way to it.

    That is the number of periods between the image and disc 2, by axis.
    """
    columns, periods = dict(zip(components(scene), state, strict=True)), {}
    for axis in scene.periodic:
        side, apart = scene.side(axis), columns[f"{axis}1"] - columns[f"{axis}2"]
        periods[axis] = round((apart - math.remainder(apart, side)) / side)
        columns[f"{axis}2"] += periods[axis] * side
    return tuple(columns.values()), periods


def unfold(scene, state, wraps, periods):
    """Return ``state`` with centres that go on beyond the cell, from those of the start."""
    columns = dict(zip(components(scene), state, strict=True))
    unwrap(scene, columns, wraps[:, 0])
    for axis, number in periods.items():
        columns[f"{axis}2"] -= number * scene.side(axis)
    return tuple(columns.values())


def path_events(scene, state, duration, seed=0):
    """Yield (time, event, first, second, state) of each event within ``duration``.

    ``state`` of the ``Scene`` is as in ``law``. Hops are events here, at their times within a
    flight. Kicks are events, too, and come from the streams of ``seed``. Walls are named by axis
    and disc. ``first`` and ``second`` are the discs of the event, or None. The first row is the
    start, the last one the end. Along periodic axes centres go on beyond the cell.
    """
    law, time, kicks = two_disc_law(scene), 0.0, open_block_kicks(new_kicks(scene, 1), seed)
    yield time, "start", None, None, state
    wraps, (state, periods) = np.zeros((3, 1)), nearest_image(scene, state)
    while True:
        left = duration - time
        until_kick = kick_limit(left, 0, kicks)
        flight, code = next_event(state, until_kick, law)
        after = after_event(state, flight, code, law)
        hops = []
        for name, horizontal in (("vertical_hop", None), ("horizontal_hop", True)):
            before, rising = relative_motion(state, horizontal)
            if name in scene.events and crosses(before, relative_motion(after, horizontal)[0]):
                hops.append((crossing_time(before, rising), name))
        for until, name in sorted(hops):
            at_hop = after_event(state, until, codes.END_OF_TIME, law)
            yield time + until, name, 1, 2, unfold(scene, at_hop, wraps, periods)
        time, state = time + flight, kicked(after, 0, flight, law, kicks)
        code = codes.KICK if code == codes.END_OF_TIME and until_kick < left else code
        if code in _JUMPS:
            axis, first, second = _JUMPS[code]
            wraps[axis] -= math.copysign(1.0, state[first] - state[second])
        if code in _NAMES:
            yield time, *_NAMES[code], unfold(scene, state, wraps, periods)
        if code == codes.END_OF_TIME:
            return


def trajectory_rate(scene):
    """Return the wall and disc events and kicks per time, and what jumps cost in their unit."""
    work = exact.work_per_event(replace(scene, friction=0.0))
    return exact.event_rate(scene) * work + scene.friction


def usual_duration(scene):
    """Return eight mean times of the rarest hop that is open, as a power of two.

    It is no longer than ``LONGEST_TRAJECTORY`` wall and disc events on average.
    """
    hops = [exact.mean_times(scene)[hop] for hop in HOPS if scene.is_possible(hop)]
    duration = min(8 * max(hops, default=math.inf), LONGEST_TRAJECTORY / trajectory_rate(scene))
    return nearest_power_of_two(duration)
