"""The same experiment by time steps, as in general physics engines: look for overlaps every Δt.

All discs move for Δt. Then each overlap whose bodies still approach is a collision: a disc beyond a
wall is reflected, and overlapping discs exchange velocities along the line of centres. Events come
late by about Δt/2 and grazing collisions are missed, so every rate has an error ∝ Δt.

The comparison is fair: this engine is compiled, runs in lock step and in vector instructions like
the ensemble, and treats discs, not polygons.
"""

import numpy as np

from twodiscs.dynamics.law import crosses
from twodiscs.sampling.initial_states import draw_starts
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.streams import open_stream
from twodiscs_paper.studies.accuracy_cost.scalar import N

#: A lane counts in one double: a field of eight bits for each of ``COUNTED``. Hits of the walls of
#: one axis are also wall hits.
VERTICAL, HORIZONTAL, COLLISION, RIGHT, TOP, ANY = (256.0**i for i in range(N))
X_WALL, Y_WALL = RIGHT + ANY, TOP + ANY

#: Steps between two readings of the packed counts: a step has four walls at most.
STEPS_PER_READ = 60


@compiled
def unpack(packed, counts, lane):
    """Move the packed counts of a ``lane`` to ``counts`` (n, lanes)."""
    tally = np.int64(packed[lane])
    packed[lane] = 0.0
    for e in range(N):
        counts[e, lane] += (tally >> (8 * e)) & 255


@compiled
def bounced(position, velocity, limit):
    """Return whether a disc is beyond ±``limit`` and still moves outwards."""
    return (abs(position) > limit) & (position * velocity > 0.0)


@compiled
def step_blocks(seed, first, stop, replicas, lanes, steps, step, sigma, draw):
    """Follow the starts of blocks ``first`` … ``stop`` − 1 for ``steps`` times ``step``.

    Returns Σ N_e over all replicas (int64), in the order of ``COUNTED``. ``replicas`` must be a
    multiple of ``lanes``.
    """
    state, starts = np.zeros((8, lanes)), np.zeros((8, replicas))
    x1, y1, x2, y2 = state[0], state[1], state[2], state[3]
    u1, v1, u2, v2 = state[4], state[5], state[6], state[7]
    packed, counts, sums = np.zeros(lanes), np.zeros((N, lanes), np.int64), np.zeros(N, np.int64)
    touching = np.zeros(lanes, np.bool_)
    half_x, half_y, reach = draw.half_x, draw.half_y, sigma * sigma
    for block in range(first, stop):
        draw_starts(open_stream(seed, block), draw, starts)
        for group in range(0, replicas, lanes):
            for k in range(8):
                for i in range(lanes):
                    state[k, i] = starts[k, group + i]
            for now in range(steps):
                for i in range(lanes):
                    before_x, before_y, tally = x1[i] - x2[i], y1[i] - y2[i], packed[i]
                    x1[i], y1[i] = x1[i] + u1[i] * step, y1[i] + v1[i] * step
                    x2[i], y2[i] = x2[i] + u2[i] * step, y2[i] + v2[i] * step
                    wall_x1, wall_y1 = bounced(x1[i], u1[i], half_x), bounced(y1[i], v1[i], half_y)
                    wall_x2, wall_y2 = bounced(x2[i], u2[i], half_x), bounced(y2[i], v2[i], half_y)
                    tally += X_WALL if wall_x1 else 0.0
                    tally += Y_WALL if wall_y1 else 0.0
                    tally += X_WALL if wall_x2 else 0.0
                    tally += Y_WALL if wall_y2 else 0.0
                    u1[i], v1[i] = -u1[i] if wall_x1 else u1[i], -v1[i] if wall_y1 else v1[i]
                    u2[i], v2[i] = -u2[i] if wall_x2 else u2[i], -v2[i] if wall_y2 else v2[i]
                    dx, dy = x1[i] - x2[i], y1[i] - y2[i]
                    tally += VERTICAL if crosses(before_y, dy) else 0.0
                    tally += HORIZONTAL if crosses(before_x, dx) else 0.0
                    packed[i] = tally
                    approach = dx * (u1[i] - u2[i]) + dy * (v1[i] - v2[i]) < 0.0
                    touching[i] = (dx * dx + dy * dy < reach) & approach
                for i in range(lanes):
                    if touching[i]:
                        dx, dy = x1[i] - x2[i], y1[i] - y2[i]
                        exchange = dx * (u1[i] - u2[i]) + dy * (v1[i] - v2[i])
                        exchange /= dx * dx + dy * dy
                        u1[i], v1[i] = u1[i] - exchange * dx, v1[i] - exchange * dy
                        u2[i], v2[i] = u2[i] + exchange * dx, v2[i] + exchange * dy
                        packed[i] += COLLISION
                if (now + 1) % STEPS_PER_READ == 0 or now + 1 == steps:
                    for i in range(lanes):
                        unpack(packed, counts, i)
    for e in range(N):
        sums[e] = counts[e].sum()
    return sums
