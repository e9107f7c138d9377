"""The usual engine, for comparison: one trajectory at a time, with branches and divisions.

It does the same experiment as ``dynamics.two.event_counts``, from the same starts, with the same
law in its most direct form. It serves as an independent check and as the baseline of the
benchmarks. ``count_blocks.py_func`` is the plain Python program.
"""

import math

import numpy as np

from twodiscs.dynamics.law import RESTING_SPEED
from twodiscs.sampling.initial_states import draw_starts
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.streams import open_stream

#: The events that the engines for comparison count, in this order.
COUNTED = ("vertical_hop", "horizontal_hop", "disc_collision", "right_wall", "top_wall", "any_wall")
N = len(COUNTED)
COLLISIONS, ANY_WALLS = COUNTED.index("disc_collision"), COUNTED.index("any_wall")


def simulated_events(counts):
    """Return how many wall hits and disc collisions there are among the counts of ``COUNTED``."""
    return int(counts[COLLISIONS] + counts[ANY_WALLS])


@compiled
def count_blocks(seed, first, stop, replicas, duration, sigma, draw):
    """Return (sums, products) of ``COUNTED`` as ``dynamics.two.event_counts`` does."""
    sums, products = np.zeros(N, np.int64), np.zeros((N, N), np.int64)
    starts = np.zeros((8, replicas))
    for block in range(first, stop):
        draw_starts(open_stream(seed, block), draw, starts)
        for replica in range(replicas):
            start = starts[:, replica]
            counts = count_replica(
                start[0], start[1], start[2], start[3], start[4], start[5], start[6], start[7],
                duration, draw.half_x, draw.half_y, sigma,
            )  # fmt: skip
            for e in range(N):
                sums[e] += counts[e]
                for f in range(e, N):
                    products[e, f] += counts[e] * counts[f]
    return sums, products


@compiled
def count_replica(x1, y1, x2, y2, u1, v1, u2, v2, remaining, half_x, half_y, sigma):
    """Return the counts of one trajectory of length ``remaining``, in the order of ``COUNTED``."""
    vertical, horizontal, collisions, beside, above = 0, 0, 0, 0, 0
    while True:
        time, event = remaining, 0
        if u1 != 0.0:
            until = ((half_x if u1 > 0.0 else -half_x) - x1) / u1
            if until < time:
                time, event = until, 1
        if v1 != 0.0:
            until = ((half_y if v1 > 0.0 else -half_y) - y1) / v1
            if until < time:
                time, event = until, 2
        if u2 != 0.0:
            until = ((half_x if u2 > 0.0 else -half_x) - x2) / u2
            if until < time:
                time, event = until, 3
        if v2 != 0.0:
            until = ((half_y if v2 > 0.0 else -half_y) - y2) / v2
            if until < time:
                time, event = until, 4
        dx, dy, du, dv = x1 - x2, y1 - y2, u1 - u2, v1 - v2
        b = dx * du + dy * dv
        if b < -RESTING_SPEED * sigma:
            cross = dx * dv - dy * du
            discriminant = (du * du + dv * dv) * (sigma * sigma) - cross * cross
            if discriminant > 0.0:
                until = (dx * dx + dy * dy - sigma * sigma) / (math.sqrt(discriminant) - b)
                if until < time:
                    time, event = until, 5

        time = max(time, 0.0)
        remaining -= time
        x1 += u1 * time
        y1 += v1 * time
        x2 += u2 * time
        y2 += v2 * time
        if event == 1:
            x1 = half_x if u1 > 0.0 else -half_x
            u1 = -u1
        elif event == 2:
            y1 = half_y if v1 > 0.0 else -half_y
            v1 = -v1
        elif event == 3:
            x2 = half_x if u2 > 0.0 else -half_x
            u2 = -u2
        elif event == 4:
            y2 = half_y if v2 > 0.0 else -half_y
            v2 = -v2
        after_x, after_y = x1 - x2, y1 - y2
        vertical += (dy < 0.0) != (after_y < 0.0)
        horizontal += (dx < 0.0) != (after_x < 0.0)
        if event == 0:
            return vertical, horizontal, collisions, beside, above, beside + above
        if event == 5:
            collisions += 1
            exchange = (after_x * du + after_y * dv) / (after_x * after_x + after_y * after_y)
            u1 -= exchange * after_x
            v1 -= exchange * after_y
            u2 += exchange * after_x
            v2 += exchange * after_y
        elif event % 2:
            beside += 1
        else:
            above += 1
