"""Many trajectories of two discs at a time: one loop, which every experiment shares.

Some tens of independent trajectories are kept as arrays, with one entry for each *lane*. A *sweep*
advances every lane by one event. It has no branch, so it is compiled to vector instructions. A lane
whose trajectory has ended idles for a few sweeps and then takes the next initial state.

**One lane, one event.** In a box of 1.5 × 1 with discs of radius 0.2, a lane has this state: the
discs are next to each other, and disc 1 is lower by 0.05 and rises faster.

>>> from twodiscs.dynamics.law import WALL_Y2, after_event, next_event, two_disc_law
>>> from twodiscs.model.scene import Scene
>>> law = two_disc_law(Scene(1.5, 1.0, 0.2))
>>> before = (-0.5, 0.0, 0.5, 0.05, 0.5, 0.1, -0.5, -0.7)  # x1, y1, x2, y2, u1, v1, u2, v2

``find_events`` asks ``law`` for the end of the flight. Disc 2 falls on the lower wall, where its
centre is at −0.3, after a time of 0.5. ``after_event`` moves both discs and turns v2 around.

>>> time, code = next_event(before, 3.0, law)  # 3.0 is the time that the lane has left
>>> (time, code == WALL_Y2)
(0.5, True)
>>> after = after_event(before, time, code, law)
>>> [round(value, 12) for value in after]
[-0.25, 0.05, 0.25, -0.3, 0.5, 0.1, -0.5, 0.7]

The experiment then takes a note of the flight. The separation y1 − y2 was −0.05 and is 0.35, so the
flight had a vertical hop. An experiment that counts (``event_counts.Counts``) adds 1 for the hop
and 256⁴ for the hit of a wall at an end of y: six counts share one double, and each has eight bits.
Other experiments are strips (``strip.HopsInStrip``), intervals (``returns.Returns``) and passages
(``hop_clusters.NetHops``, ``hop_clusters.Clusters``). The page docs/change-it.md adds one.

In plain Python, one trajectory after the other, the same stands in ``count_replica`` of
twodiscs_paper/studies/accuracy_cost/scalar.py for counts, and in ``follow`` of
tests/scalar_passages.py for passages.
"""

from functools import cache
from types import FunctionType

import numpy as np

from twodiscs.dynamics.ensemble import idle_kicks, kick_limit, open_kicks, renew_kicks
from twodiscs.dynamics.law import (
    after_event,
    first_event,
    kick_sampler,
    meeting,
    redrawn,
    two_disc_law,
)
from twodiscs.sampling.initial_states import STATE_ROWS, draw_states
from twodiscs.sampling.jit import compiled, inlined, optional
from twodiscs.sampling.streams import exponential, open_stream

# An experiment -----------------------------------------------------------------------------------

# An experiment is a NamedTuple of numbers and arrays. It has a field ``both_ways``, True if a path
# also goes backwards from its initial state, else None. Its class has functions of these names,
# which take the place of these four when the loop is compiled. A lane is known by its index ``i``.


def begin(experiment, i, state):
    """Return the time to follow a path that begins in ``state``."""


def note(experiment, i, before, after, code, time, left):
    """Return the time that the lane has left, usually ``left``, after each flight.

    The flight took a ``time`` from the state ``before`` and ended with the event ``code`` in the
    state ``after``. A lane without time left has flights of time 0 until the loop looks for it.
    """


def swept(experiment, sweeps):
    """Do nothing after each sweep; ``sweeps`` counts them. An experiment may leave this out."""


def ended(experiment, i, replica, stretch):
    """Return the time of the next stretch of a path, 0 if there is none.

    Minus a time starts from the reversed initial state. ``replica`` is the number of the initial
    state, counted over all blocks, and ``stretch`` = 0, 1, 2 … the number of the stretch whose time
    is over. A function that returns once, in a line that uses the experiment, saves 0.1 µs: numba
    then counts no references to the arrays.
    """


# The loop ----------------------------------------------------------------------------------------


def follow(experiment, scene, sampler, seed, first, stop, replicas, lanes, sweeps, going=None):
    """Follow initial states of the blocks ``first`` … ``stop`` − 1 for an ``experiment``.

    A block has ``replicas`` initial states, which a ``StartSampler`` draws from a stream of
    ``seed``. After every few ``sweeps`` the loop looks for lanes whose time is over. It returns
    early, with half of the work, if the array ``going``, if given, becomes false.
    """
    follow_lanes = compile_loop(type(experiment))
    follow_lanes(
        experiment, np.uint64(seed), first, stop, replicas, lanes, sweeps, sampler,
        two_disc_law(scene), new_kicks(scene, lanes), going,
    )  # fmt: skip


@cache
def compile_loop(experiment):
    """Return ``_follow_lanes``, compiled with the functions of an ``experiment`` (a class)."""
    functions = {
        "begin": inlined(_owned(experiment, experiment.begin)),
        "note": inlined(_owned(experiment, experiment.note)),
        "swept": inlined(_owned(experiment, getattr(experiment, "swept", swept))),
        "ended": inlined(_owned(experiment, experiment.ended)),
    }
    return compiled(_owned(experiment, _follow_lanes, functions))


def _owned(experiment, function, names=()):
    """Return a copy of a ``function``, with these global ``names``, that an ``experiment`` owns.

    Its compiled code is kept with the code of the module of the experiment, or not at all.
    """
    copy = FunctionType(function.__code__, function.__globals__ | dict(names), function.__name__)
    copy.__module__ = experiment.__module__
    copy.__qualname__ = f"{experiment.__qualname__}.{function.__name__}"
    return copy


def _follow_lanes(
    experiment, seed, first, stop, replicas, lanes, sweeps, sampler, law, kicks, going
):
    rows, initial_states = new_rows(lanes, law), np.zeros((STATE_ROWS, replicas))
    reversed_states = np.zeros((STATE_ROWS, lanes))
    remaining, times, codes = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    replica, stretch = np.full(lanes, -1), np.zeros(lanes, np.int64)
    block, used, running, done = first, replicas, 0, 0

    while True:
        for i in range(lanes):
            if remaining[i] > 0.0:
                continue
            if replica[i] >= 0:
                more = ended(experiment, i, replica[i], stretch[i])
                remaining[i] = abs(more)
                stretch[i] += 1
                if more < 0.0:
                    put_state(rows, i, reversed_states[:, i], law)
                    renew_kicks(i, kicks)
                if more != 0.0:
                    continue
                replica[i] = -1
                running -= 1
            if used == replicas and block < stop:
                draw_states(open_stream(seed, block), sampler, initial_states)
                block, used = block + 1, 0
            if used < replicas:
                put_state(rows, i, initial_states[:, used], law)
                keep_reversed(reversed_states, i, initial_states, used, law, experiment.both_ways)
                replica[i], stretch[i] = (block - 1) * replicas + used, 0
                open_kicks(i, seed, replica[i], kicks)
                remaining[i] = begin(experiment, i, state_at(rows, i, law))
                used += 1
                running += 1
        if running == 0 or not goes_on(going):
            return

        for _ in range(sweeps):
            find_events(rows, remaining, times, codes, law, kicks)
            for i in range(lanes):
                # Everything is loaded before anything is stored.
                before, time, code, left = state_at(rows, i, law), times[i], codes[i], remaining[i]
                after = after_event(before, time, code, law)
                remaining[i] = note(experiment, i, before, after, code, time, left - time)
                put_state(rows, i, after, law)
            kick_lanes(rows, times, law, kicks)
            done += 1
            swept(experiment, done)


@optional(lambda reversed_states, i, initial_states, k, law, both_ways: None)
def keep_reversed(reversed_states, i, initial_states, k, law, both_ways):
    """Keep the state in column ``k`` for lane ``i``, with velocities and spins reversed."""
    positions = 10 if law.depth is not None else 8
    for component in range(STATE_ROWS):
        value = initial_states[component, k]
        turned = 4 <= component < 8 or component >= positions
        reversed_states[component, i] = -value if turned else value


@optional(lambda going: True)
def goes_on(going):
    """Return whether anybody waits for the result."""
    return going[0]


# Rows: the states of all lanes, a tuple of as many arrays as a state has components ---------------


@optional(lambda lanes, present: ())
def pair_of_rows(lanes, present):
    """Return two arrays, or nothing if the effect they belong to is absent."""
    return np.zeros(lanes), np.zeros(lanes)


@inlined
def new_rows(lanes, law):
    """Return the rows of a ``Law``: (lanes,) zeros for each component of a state."""
    plain = (
        np.zeros(lanes), np.zeros(lanes), np.zeros(lanes), np.zeros(lanes),
        np.zeros(lanes), np.zeros(lanes), np.zeros(lanes), np.zeros(lanes),
    )  # fmt: skip
    deep = pair_of_rows(lanes, law.depth) + pair_of_rows(lanes, law.depth)
    return plain + deep + pair_of_rows(lanes, law.rough)


@optional(lambda rows, k, i, present: ())
def pair_at(rows, k, i, present):
    """Return the entries of lane ``i`` in rows ``k`` and ``k`` + 1, or nothing if absent."""
    return rows[k][i], rows[k + 1][i]


@inlined
def state_at(rows, i, law):
    """Return the state of lane ``i``."""
    plain = (
        rows[0][i], rows[1][i], rows[2][i], rows[3][i],
        rows[4][i], rows[5][i], rows[6][i], rows[7][i],
    )  # fmt: skip
    deep = pair_at(rows, 8, i, law.depth) + pair_at(rows, 10, i, law.depth)
    return plain + deep + pair_at(rows, 8, i, law.rough)


@optional(lambda rows, k, i, state, present: None)
def put_pair(rows, k, i, state, present):
    """Set the entries of lane ``i`` in rows ``k`` and ``k`` + 1, unless they are absent."""
    rows[k][i], rows[k + 1][i] = state[k], state[k + 1]


@inlined
def put_state(rows, i, state, law):
    """Set the state of lane ``i``."""
    rows[0][i], rows[1][i], rows[2][i], rows[3][i] = state[0], state[1], state[2], state[3]
    rows[4][i], rows[5][i], rows[6][i], rows[7][i] = state[4], state[5], state[6], state[7]
    put_pair(rows, 8, i, state, law.depth)
    put_pair(rows, 10, i, state, law.depth)
    put_pair(rows, 8, i, state, law.rough)


@inlined
def find_events(rows, remaining, times, codes, law, kicks=None):
    """Fill ``times`` and ``codes`` (lanes,) with the first event of each lane within its time.

    A flight that a kick ends has the code of the end of time, and ``kick_lanes`` has to follow.
    Two loops, so that more of a processor's instructions do not wait for one another. Between them
    ``times`` and ``codes`` hold the quotients of the discs' meetings.
    """
    for i in range(times.size):
        times[i], codes[i] = meeting(state_at(rows, i, law), law)
    for i in range(times.size):
        times[i], codes[i] = first_event(
            state_at(rows, i, law), kick_limit(remaining[i], i, kicks), times[i], codes[i], law
        )


def new_kicks(scene, lanes):
    """Return the ``Kicks`` of some ``lanes``, which ``open_kicks`` begins; None without friction.

    A lane that never begins has no kick.
    """
    return idle_kicks(scene, lanes, np.zeros(6), np.zeros(8), kick_sampler(scene))


@optional(lambda state, i, time, law, kicks: state)
def kicked(state, i, time, law, kicks):
    """Return the ``state`` of lane ``i`` after a flight of ``time``, kicked if that is due."""
    kicks.waits[i] -= time
    if kicks.waits[i] <= 0.0:
        # A copy is cheaper than a view of the row.
        stream = kicks.stream
        for k in range(4):
            stream[k] = kicks.streams[i, k]
        state = redrawn(state, stream, kicks.direction, kicks.velocity, kicks.sampler)
        kicks.waits[i] = exponential(stream) / kicks.rate
        for k in range(4):
            kicks.streams[i, k] = stream[k]
    return state


@optional(lambda rows, times, law, kicks: None)
def kick_lanes(rows, times, law, kicks):
    """Kick the lanes whose kick is due after flights of ``times`` (lanes,)."""
    waits = kicks.waits
    for i in range(times.size):
        if waits[i] <= times[i]:
            put_state(rows, i, kicked(state_at(rows, i, law), i, times[i], law, kicks), law)
        else:
            waits[i] -= times[i]


@inlined
def relative_motion(state, horizontal):
    """Return the separation and relative velocity along y, or along x if ``horizontal``."""
    if horizontal is None:
        return state[1] - state[3], state[5] - state[7]
    return state[0] - state[2], state[4] - state[6]
