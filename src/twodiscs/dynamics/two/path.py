"""One trajectory of two discs, event by event."""

import math
from dataclasses import replace

import numpy as np

from twodiscs.dynamics import law as codes
from twodiscs.dynamics import rows as kinds
from twodiscs.dynamics.ensemble import kick_limit, nearest_power_of_two, open_block_kicks
from twodiscs.dynamics.law import after_event, crosses, crossing_time, next_event, two_disc_law
from twodiscs.dynamics.rows import new_rows, put_event, start_row
from twodiscs.dynamics.two.follow import kicked, new_kicks, put_state, relative_motion, state_at
from twodiscs.model.events import HOPS
from twodiscs.sampling.initial_states import STATE_ROWS, components, move_into_cell
from twodiscs.sampling.jit import compiled, inlined, optional
from twodiscs.theory import exact

#: Wall and disc events that a trajectory lasts at most, on average.
TRAJECTORY_EVENTS = 6000

#: The kind of a row, by the code of the end of a flight from 0 on, and the discs of its event.
KIND_OF_CODE = np.array([0, 0, 1, 3, 4, 0, 2, 5]) + kinds.WALL
KIND_OF_CODE[int(codes.END_OF_TIME)], KIND_OF_CODE[int(codes.DISC)] = kinds.END, kinds.COLLISION
FIRST_DISCS, SECOND_DISCS = np.array([0, 1, 1, 2, 2, 1, 1, 2]), np.array([0, 0, 0, 0, 0, 2, 0, 0])


@optional(lambda state, present: 0.0)
def deep_separation(state, present):
    """Return z1 − z2, or 0 in the plane."""
    return state[8] - state[9]


@optional(lambda left, kicks: False)
def is_left(left, kicks):
    """Say whether time is left after a flight that ended without an event."""
    return left > 0.0


@inlined
def count_jump(wraps, i, state, code, law):
    """Add a jump of the periodic separation in ``state`` to ``wraps`` (3, n), if there is one."""
    if code == codes.WRAP_X:
        wraps[0, i] -= math.copysign(1.0, state[0] - state[2])
    elif code == codes.WRAP_Y:
        wraps[1, i] -= math.copysign(1.0, state[1] - state[3])
    elif code == codes.WRAP_Z:
        wraps[2, i] -= math.copysign(1.0, deep_separation(state, law.depth))


@compiled
def advance_states(states, wraps, time, law, kicks):
    """Advance the columns of ``states`` (``STATE_ROWS``, n) by a ``time`` > 0.

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
            count_jump(wraps, i, state, code, law)
        put_state(states, i, state, law)


def new_wraps(scene, number):
    """Return no jumps of the three separations, for a ``number`` of states."""
    return np.zeros((3, number))


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


@inlined
def put_row(rows, jumps, n, time, kind, discs, state, wraps, law):
    """Set row ``n``, and column ``n`` of ``jumps`` (3, n) to the ``wraps`` so far."""
    put_event(rows, n, time, kind, discs[0], discs[1])
    put_state(rows.states, n, state, law)
    for axis in range(3):
        jumps[axis, n] = wraps[axis, 0]


@compiled
def record_rows(now, clock, duration, law, kicks, hops, wraps, jumps, rows):
    """Fill ``rows`` with the next events of the state ``now`` (``STATE_ROWS``, 1) at its time.

    ``clock`` (1,) has this time. ``hops`` say whether vertical and horizontal ones are rows.
    Returns the number of rows; the last one is the end if the ``duration`` is over.
    """
    state, time, n = state_at(now, 0, law), clock[0], 0
    # A flight may have two hops before its end.
    while n + 3 <= rows.times.size and (n == 0 or rows.kinds[n - 1] != kinds.END):
        left = duration - time
        limit = kick_limit(left, 0, kicks)
        flight, code = next_event(state, limit, law)
        after = after_event(state, flight, code, law)
        first_hop = second_hop = kinds.VERTICAL_HOP
        until = later = codes.INFINITE_GAP
        apart, rising = relative_motion(state, None)
        if hops[0] and crosses(apart, relative_motion(after, None)[0]):
            until = crossing_time(apart, rising)
        apart, rising = relative_motion(state, True)
        if hops[1] and crosses(apart, relative_motion(after, True)[0]):
            later, second_hop = crossing_time(apart, rising), kinds.HORIZONTAL_HOP
        if later <= until:
            until, later, first_hop, second_hop = later, until, second_hop, first_hop
        for time_to, hop in ((until, first_hop), (later, second_hop)):
            if time_to < codes.INFINITE_GAP:
                at_hop = after_event(state, time_to, codes.END_OF_TIME, law)
                put_row(rows, jumps, n, time + time_to, hop, (1, 2), at_hop, wraps, law)
                n += 1
        time, state = time + flight, kicked(after, 0, flight, law, kicks)
        count_jump(wraps, 0, state, code, law)
        if code >= codes.END_OF_TIME:
            k = np.int64(code)
            kind = KIND_OF_CODE[k] if k > 0 or limit >= left else kinds.KICK
            put_row(
                rows, jumps, n, time, kind, (FIRST_DISCS[k], SECOND_DISCS[k]), state, wraps, law
            )
            n += 1
    put_state(now, 0, state, law)
    clock[0] = time
    return n


def path_rows(scene, state, duration, seed=0, hops=True):
    """Yield the ``Rows`` of a trajectory, see ``Engine``.

    Hops are at their times within a flight. Along periodic axes centres go on beyond the cell.
    """
    yield start_row(state)
    names, law = components(scene), two_disc_law(scene)
    kicks = open_block_kicks(new_kicks(scene, 1), seed)
    now, clock, wraps = np.zeros((STATE_ROWS, 1)), np.zeros(1), np.zeros((3, 1))
    now[: len(names), 0] = state
    shifts = move_into_cell(scene, dict(zip(names, now, strict=False)))
    hops, rows = tuple(hops and hop in scene.events for hop in HOPS), None
    while rows is None or rows.kinds[-1] != kinds.END:
        rows = new_rows(len(names))
        jumps = np.empty((3, rows.times.size))
        number = record_rows(now, clock, duration, law, kicks, hops, wraps, jumps, rows)
        columns = dict(zip(names, rows.states[:, :number], strict=True))
        unwrap(scene, columns, jumps[:, :number])
        for name, shift in shifts.items():
            columns[name] += shift
        rows = rows.first(number)
        yield rows


def trajectory_rate(scene, hops=True):
    """Return the wall and disc events and kicks per time, and what jumps cost in their unit."""
    work = exact.work_per_event(replace(scene, friction=0.0))
    return exact.event_rate(scene) * work + scene.friction


def usual_duration(scene):
    """Return eight mean times of the rarest hop that is open, as a power of two.

    It is no longer than ``TRAJECTORY_EVENTS`` wall and disc events on average.
    """
    hops = [exact.mean_times(scene)[hop] for hop in HOPS if scene.is_possible(hop)]
    duration = min(8 * max(hops, default=math.inf), TRAJECTORY_EVENTS / trajectory_rate(scene))
    return nearest_power_of_two(duration)
