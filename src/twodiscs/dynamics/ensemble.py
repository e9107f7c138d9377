"""An ensemble of trajectories in lock step: what every experiment with it shares.

Some tens of independent trajectories are kept as arrays, with one entry for each lane. Each pass of
the inner loop advances every lane by one event. The loop has no branch, so it is compiled to vector
instructions. A lane whose trajectory has ended idles for a few passes and is then given the next
start.

Starts come from streams keyed by block, and sums are integers or taken in the order of the starts.
A result therefore depends on the scene, the seed and the blocks, not on lanes, processors or
shards.
"""

import math

import numpy as np

from twodiscs.dynamics.kicks import before_kick, idle_kicks
from twodiscs.dynamics.law import first_event, kick_sampler, meeting, redrawn
from twodiscs.sampling.jit import inlined, optional
from twodiscs.sampling.streams import exponential

LANES = 64

#: Passes between two searches for lanes that have ended.
PASSES = 8

#: Replicas with one random stream.
REPLICAS = 1024

#: Successive intervals between hops that a chain records.
RETURNS = 256

#: Replicas with one random stream, if each is a hop that is followed.
FOLLOWED = 64

#: Clusters of this many hops, or more, are in one class. It counts as even, which makes κ too small
#: by less than the fraction of hops in it over their number.
LARGEST = 2**13

#: The sums at each time after a hop: n = Σ s_0 s_k and n², N hops and N².
SUMS = 4


def nearest_power_of_two(value):
    """Return the power of two next to ``value`` > 0 on a logarithmic scale.

    Durations and bin widths come from the exact theory, whose last digit may depend on the math
    library. The power of two is the same on every machine.
    """
    mantissa, exponent = math.frexp(value)
    return math.ldexp(1.0, exponent if mantissa > math.sqrt(0.5) else exponent - 1)


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
            state_at(rows, i, law), before_kick(remaining[i], i, kicks), times[i], codes[i], law
        )


def new_kicks(scene, lanes):
    """Return the ``Kicks`` of some ``lanes``, which ``open_kicks`` begins; None without friction.

    A lane that never begins has no kick.
    """
    if not scene.friction:
        return None
    return idle_kicks(lanes, scene.friction, np.zeros(6), np.zeros(8), kick_sampler(scene))


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
def across(state, horizontal):
    """Return the separation and relative velocity along y, or along x if ``horizontal``."""
    if horizontal is None:
        return state[1] - state[3], state[5] - state[7]
    return state[0] - state[2], state[4] - state[6]


# Errors ------------------------------------------------------------------------------------------


def relative_errors(sums, products, replicas):
    """Return the relative standard error of each mean count (n), inf without a count.

    Replicas are independent, so the error is √(var N / R) / ⟨N⟩.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = sums / replicas
        variance = np.maximum(np.diag(products) / replicas - mean**2, 0.0)
        errors = np.sqrt(variance / replicas) / mean
    return np.where(sums > 0, errors, np.inf)
