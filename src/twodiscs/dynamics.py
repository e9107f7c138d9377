"""Event-driven molecular dynamics of an ensemble in lock step.

Some tens of independent trajectories are kept as arrays, one entry a lane, and each pass of the inner
loop advances every lane by one event. The loop has no branch, so it is compiled to vector instructions.
A lane whose trajectory has ended idles for a few passes and is then given the next start.

Two experiments use it. ``count_events`` starts from the invariant measure and runs for a fixed time T:
the mean count is then rate × T exactly, for every T and without burn-in. ``hop_intervals`` starts on the
surface of a hop, weighted by the flux through it, and records the next returns: each of them is an
exact draw of the interval between hops, with no window that could cut it off.

Starts come from streams keyed by block, and sums are integers or taken in the order of the starts. So a
result depends on the scene, the seed and the blocks, not on lanes, processors or shards.
"""

import math

import numpy as np

from twodiscs.events import DISC, END_OF_TIME, WALL_X1, WALL_Y1
from twodiscs.events import after_event, crosses, crossing_time, next_event
from twodiscs.invariant import draw_configuration, draw_constants, draw_crossing, draw_velocity
from twodiscs.jit import compiled
from twodiscs.scene import EVENTS, Scene
from twodiscs.streams import open_stream

LANES = 64

#: Passes between two looks at which lanes have ended; a packed count must stay below 256.
PASSES = 16

#: Replicas that share a random stream.
REPLICAS = 1024

# A lane counts in one double: six fields of eight bits, in the order of EVENTS. The last one takes
# every event, disc collisions included.
FIELD = tuple(256.0**i for i in range(6))
VERTICAL, HORIZONTAL, COLLISION, RIGHT, TOP, ANY = FIELD


@compiled
def draw_starts(state, draw, side_x, side_y, starts):
    """Fill ``starts`` (8, n) with states of the invariant measure."""
    for i in range(starts.shape[1]):
        x1, y1, x2, y2 = draw_configuration(state, draw, side_x, side_y)
        u1, v1, u2, v2 = draw_velocity(state)
        starts[0, i], starts[1, i], starts[2, i], starts[3, i] = x1, y1, x2, y2
        starts[4, i], starts[5, i], starts[6, i], starts[7, i] = u1, v1, u2, v2


@compiled
def count_blocks(seed, first, stop, replicas, lanes, duration, sigma, draw, sides, blocked, hops, walls):
    """Run the replicas of blocks ``first`` … ``stop`` − 1 for ``duration`` each and add up their counts.

    Returns (sums, products, eligible): Σ N_e (6), Σ N_e N_f (6, 6) over all replicas, and how many
    replicas can see each event (6), all int64, in the order of EVENTS. ``sides`` chooses components
    as in ``draw_configuration``; ``blocked`` says which hops are blocked, so that only starts with disc 1
    on the right (on top) see the right (top) wall. ``hops`` and ``walls`` are True or None: what is
    None is not compiled.
    """
    x1, y1, x2, y2 = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    u1, v1, u2, v2 = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    remaining, times, codes = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    packed, counts = np.zeros(lanes), np.zeros((6, lanes), np.int64)
    sums, products = np.zeros(6, np.int64), np.zeros((6, 6), np.int64)
    eligible = np.zeros(6, np.int64)
    busy = np.zeros(lanes, np.bool_)
    starts = np.zeros((8, replicas))
    one = np.zeros(6, np.int64)
    half_x, half_y = draw.half_x, draw.half_y
    block, used, running = first, replicas, 0

    while True:
        for i in range(lanes):
            if remaining[i] > 0.0:
                continue
            if busy[i]:
                for e in range(6):
                    one[e] = counts[e, i]
                    counts[e, i] = 0
                one[5] -= one[2]
                for e in range(6):
                    sums[e] += one[e]
                    for f in range(6):
                        products[e, f] += one[e] * one[f]
                busy[i] = False
                running -= 1
            if used == replicas and block < stop:
                draw_starts(open_stream(seed, block), draw, sides[0], sides[1], starts)
                block, used = block + 1, 0
            if used < replicas:
                x1[i], y1[i], x2[i], y2[i] = starts[0, used], starts[1, used], starts[2, used], starts[3, used]
                u1[i], v1[i], u2[i], v2[i] = starts[4, used], starts[5, used], starts[6, used], starts[7, used]
                remaining[i] = duration
                used += 1
                busy[i] = True
                running += 1
                for e in range(6):
                    eligible[e] += 1
                if blocked[0] and x1[i] < x2[i]:
                    eligible[3] -= 1
                if blocked[1] and y1[i] < y2[i]:
                    eligible[4] -= 1
        if running == 0:
            return sums, products, eligible

        for _ in range(PASSES):
            for i in range(lanes):
                times[i], codes[i] = next_event(
                    x1[i], y1[i], x2[i], y2[i], u1[i], v1[i], u2[i], v2[i],
                    remaining[i], half_x, half_y, sigma,
                )  # fmt: skip
            for i in range(lanes):
                code, tally = codes[i], packed[i]
                before_x, before_y, u, v = x1[i] - x2[i], y1[i] - y2[i], u1[i], v1[i]
                remaining[i] -= times[i]
                x1[i], y1[i], x2[i], y2[i], u1[i], v1[i], u2[i], v2[i] = after_event(
                    x1[i], y1[i], x2[i], y2[i], u1[i], v1[i], u2[i], v2[i],
                    times[i], code, half_x, half_y,
                )  # fmt: skip
                tally += ANY if code > END_OF_TIME else 0.0
                tally += COLLISION if code == DISC else 0.0
                if hops is not None:
                    tally += VERTICAL if crosses(before_y, y1[i] - y2[i]) else 0.0
                    tally += HORIZONTAL if crosses(before_x, x1[i] - x2[i]) else 0.0
                if walls is not None:
                    tally += RIGHT if (code == WALL_X1) & (u > 0.0) else 0.0
                    tally += TOP if (code == WALL_Y1) & (v > 0.0) else 0.0
                packed[i] = tally
        for i in range(lanes):
            tally = np.int64(packed[i])
            packed[i] = 0.0
            for e in range(6):
                counts[e, i] += (tally >> (8 * e)) & 255


@compiled
def record_returns(seed, first, stop, chains, lanes, returns, sigma, draw, beyond_x, width, histogram):
    """Run the chains of blocks ``first`` … ``stop`` − 1 for ``returns`` vertical hops each.

    Adds the intervals to ``histogram`` (int64, bins of ``width`` from 0; the last entry takes what is
    longer) and returns the total time of each chain, (stop − first) × ``chains`` doubles in order.
    """
    x1, y1, x2, y2 = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    u1, v1, u2, v2 = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    times, codes, intervals = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    age, elapsed, left = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    chain, found = np.full(lanes, -1), np.zeros(lanes + 1)
    totals = np.zeros((stop - first) * chains)
    half_x, half_y = draw.half_x, draw.half_y
    per_width, last_bin, wanted = 1.0 / width, histogram.size - 1, np.float64(returns)
    state = open_stream(seed, first)
    started, running = 0, 0

    while True:
        for i in range(lanes):
            if left[i] > 0.0:
                continue
            if chain[i] >= 0:
                totals[chain[i]] = elapsed[i]
                chain[i] = -1
                running -= 1
            if started == totals.size:
                continue
            if started % chains == 0:
                state = open_stream(seed, first + started // chains)
            x1[i], y1[i], x2[i], y2[i], u1[i], v1[i], u2[i], v2[i] = draw_crossing(
                state, half_x, half_y, beyond_x
            )
            chain[i], elapsed[i], age[i] = started, 0.0, 0.0
            # A start that falls through y1 = y2 is seen to cross it at time 0; that is not a return.
            left[i] = wanted + (1.0 if v1[i] < v2[i] else 0.0)
            started += 1
            running += 1
        if running == 0:
            return totals

        for _ in range(PASSES):
            for i in range(lanes):
                times[i], codes[i] = next_event(
                    x1[i], y1[i], x2[i], y2[i], u1[i], v1[i], u2[i], v2[i],
                    np.inf, half_x, half_y, sigma,
                )  # fmt: skip
            for i in range(lanes):
                before, rising, waited = y1[i] - y2[i], v1[i] - v2[i], age[i]
                x1[i], y1[i], x2[i], y2[i], u1[i], v1[i], u2[i], v2[i] = after_event(
                    x1[i], y1[i], x2[i], y2[i], u1[i], v1[i], u2[i], v2[i],
                    times[i], codes[i], half_x, half_y,
                )  # fmt: skip
                hop = crosses(before, y1[i] - y2[i])
                until = crossing_time(before, rising)
                recorded = hop & (left[i] > 0.0) & (left[i] <= wanted)
                intervals[i] = waited + until if recorded else -1.0
                elapsed[i] += waited + until if recorded else 0.0
                age[i] = times[i] - until if hop else waited + times[i]
                left[i] -= 1.0 if hop else 0.0
            n = 0
            for i in range(lanes):
                found[n] = intervals[i]
                n += 1 if intervals[i] >= 0.0 else 0
            for k in range(n):
                histogram[min(np.int64(found[k] * per_width), last_bin)] += 1
