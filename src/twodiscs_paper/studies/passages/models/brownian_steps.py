"""Brownian dynamics of two hard discs in a channel: five programs with steps of equal length.

Two discs of the diameter σ = 1 are in a channel of the height 2σ + ε between hard walls, which is
closed to a ring of the length 2H. Their centres have the heights y₁ and y₂ in [0, B], B = σ + ε,
and the separation u along the ring. The ring is folded: at |u| = H the separation is reflected,
because discs that are farther apart on one side are closer on the other. A pair passes when u
changes its sign, through a neck of the width ε and the length √(εσ).

In a step of the time Δt = 1 each coordinate of a free disc changes by a normal deviate of the
standard deviation s: D = s²/(2Δt) is its coefficient of diffusion, and s/Δt the thermal speed.

* ``REFLECTED``: the velocities are drawn from Maxwell's distribution at the start of each step,
  and kept between elastic collisions (Strating, Phys. Rev. E 59, 2175 (1999); Scala, Voigtmann
  and De Michele, J. Chem. Phys. 126, 134109 (2007)).
* ``KICKED``: the same, but the times between draws are exponential with the mean Δt/2, which
  gives the same D. This is friction of the rate γ = 2/Δt.
* ``TOGETHER``: both discs get their displacements, and the step is rejected if the discs overlap
  (Cichocki and Hinsen, Physica A 166, 473 (1990)). Walls fold the step: a height beyond a wall is
  reflected at it.
* ``CONFINED``: the same, but a step into a wall is rejected as well.
* ``SINGLY``: a step is two moves of one random disc each; a move that leads to an overlap is
  rejected. Walls fold it.

All five keep the uniform distribution of the allowed (u, y₁, y₂) and satisfy detailed balance.
Its density of u is ρ(u) = L², with L = B − √(σ² − u²) for |u| < σ, else L = B.
"""

import math

import numpy as np

from twodiscs.sampling.jit import compiled, inlined
from twodiscs.sampling.streams import exponential, open_stream, signed_uniform, uniform

REFLECTED, KICKED, TOGETHER, CONFINED, SINGLY = range(5)

#: Crossings in a block, which has a stream of random numbers.
STEP_CROSSINGS = 2**6

#: Clusters of more crossings than this are counted as the largest ones.
STEP_CLUSTER = 2**14

#: Rejected steps that cross have lengths up to ``LONGEST_MOVE`` standard deviations: all but 2e-8.
LONGEST_MOVE = 6.0


@inlined
def normal_pair(stream):
    """Return two independent normal deviates."""
    while True:
        x, y = signed_uniform(stream), signed_uniform(stream)
        square = x * x + y * y
        if 0.0 < square < 1.0:
            break
    length = math.sqrt(2 * exponential(stream) / square)
    return x * length, y * length


@inlined
def folded(y, breadth):
    """Return ``y`` reflected at 0 and at ``breadth`` until it is between them."""
    while y < 0.0 or y > breadth:
        y = -y if y < 0.0 else 2 * breadth - y
    return y


@inlined
def moved(y, z, kind, step, breadth, b, c, stream):
    """Return heights after a step of random length, where ``b`` and ``c`` are normal deviates."""
    if kind != SINGLY:
        y, z = y + step * b, z + step * c
        if kind == TOGETHER:
            y, z = folded(y, breadth), folded(z, breadth)
    elif uniform(stream) < 0.5:
        y = folded(y + step * b, breadth)
    else:
        z = folded(z + step * b, breadth)
    return y, z


@inlined
def is_free(u, y, z, breadth):
    """Return whether neither two discs nor a disc and a wall overlap."""
    return u * u + (y - z) ** 2 >= 1.0 and min(y, z) >= 0.0 and max(y, z) <= breadth


@compiled
def fly(state, time, half, breadth):
    """Move a pair for a ``time`` with elastic collisions; return how often u changed its sign.

    ``state`` is u, y₁, y₂, their velocities, and the side of the end at |u| = ``half`` that was met
    last, ±1, which is set if an end is met.
    """
    crossings, ahead = 0, state[0] > 0.0 or (state[0] == 0.0 and state[3] > 0.0)
    while True:
        u, y, z, g, v, w = state[0], state[1], state[2], state[3], state[4], state[5]
        least, event = time, 0
        gap = max(y if v < 0.0 else breadth - y, 0.0)
        if gap < abs(v) * least:
            least, event = gap / abs(v), 1
        gap = max(z if w < 0.0 else breadth - z, 0.0)
        if gap < abs(w) * least:
            least, event = gap / abs(w), 2
        gap = max(half + u if g < 0.0 else half - u, 0.0)
        if gap < abs(g) * least:
            least, event = gap / abs(g), 3
        up, rising = y - z, v - w
        approach = u * g + up * rising
        if approach < 0.0:
            square, cross = g * g + rising * rising, u * rising - up * g
            root = square - cross * cross
            if root > 0.0:
                contact = max(u * u + up * up - 1.0, 0.0) / (math.sqrt(root) - approach)
                if contact < least:
                    least, event = contact, 4
        state[0], state[1], state[2] = u + g * least, y + v * least, z + w * least
        if state[0] != 0.0 and (state[0] > 0.0) != ahead:
            crossings, ahead = crossings + 1, not ahead
        time -= least
        if event == 0:
            return crossings
        if event == 1:
            state[1], state[4] = 0.0 if v < 0.0 else breadth, -v
        elif event == 2:
            state[2], state[5] = 0.0 if w < 0.0 else breadth, -w
        elif event == 3:
            state[0], state[3] = math.copysign(half, g), -g
            state[6] = math.copysign(1.0, g)
        else:
            x, y = state[0], state[1] - state[2]
            share = (x * g + y * rising) / (x * x + y * y)
            state[3] = g - 2 * share * x
            state[4], state[5] = v - share * y, w + share * y


@compiled
def advance(state, kind, step, half, breadth, stream):
    """Make one step, or one move of a disc, with new random numbers.

    Returns how often u changed its sign.
    """
    a, b = normal_pair(stream)
    c, _ = (0.0, 0.0) if kind == SINGLY else normal_pair(stream)
    length = step if kind == SINGLY else math.sqrt(2.0) * step
    if kind <= KICKED:
        state[3], state[4], state[5] = length * a, step * b, step * c
        time = 1.0 if kind == REFLECTED else exponential(stream) / 2
        return fly(state, time, half, breadth)
    u = state[0] + length * a
    y, z = moved(state[1], state[2], kind, step, breadth, b, c, stream)
    end = 0.0
    while abs(u) > half:
        end = math.copysign(1.0, u)
        u = end * 2 * half - u
    if not is_free(u, y, z, breadth):
        return 0
    crossings = 1 if u * state[0] < 0.0 else 0
    state[0], state[1], state[2] = u, y, z
    if end != 0.0:
        state[6] = end
    return crossings


@compiled
def first_passages(kind, step, room, half, seed, first, stop):
    """Return (steps to the first crossing, steps to the passage, crossings) of each of some pairs.

    A pair starts as far apart as the ring allows, at u = ``half``, with random heights. Its passage
    ends when it is as far apart on the other side. The pairs are ``first`` … ``stop`` − 1, and each
    has its own stream. The result has the shape (pairs, 3); steps of ``SINGLY`` are moves.
    """
    found, state, breadth = np.zeros((stop - first, 3), np.int64), np.zeros(7), 1.0 + room
    for pair in range(first, stop):
        stream = open_stream(seed, pair)
        state[0], state[6] = half, 1.0
        state[1], state[2] = breadth * uniform(stream), breadth * uniform(stream)
        steps, early, crossings = 0, 0, 0
        while state[6] > 0.0:
            crossings += advance(state, kind, step, half, breadth, stream)
            steps += 1
            if crossings and not early:
                early = steps
        found[pair - first, 0], found[pair - first, 1] = early, steps
        found[pair - first, 2] = crossings
    return found


@compiled
def follow(state, kind, step, half, breadth, stream):
    """Make steps until the discs are too far apart to touch; return (crossings, steps)."""
    crossings, steps = 0, 0
    while abs(state[0]) < 1.0:
        crossings += advance(state, kind, step, half, breadth, stream)
        steps += 1
    return crossings, steps


@compiled
def draw_crossing(state, other, kind, step, half, breadth, stream):
    """Draw a crossing u < 0 → u > 0 from equilibrium; return how many were tried.

    ``state`` is its end and ``other`` its beginning, from which time is reversed.
    """
    room, tried = breadth - 1.0, 0
    length = step if kind == SINGLY else math.sqrt(2.0) * step
    farthest = min(LONGEST_MOVE * length, 1.0)
    if kind > KICKED:
        room = breadth - math.sqrt(1.0 - farthest * farthest)
    while True:
        state[6] = other[6] = 0.0
        tried += 1
        forward = length * math.sqrt(2 * exponential(stream))
        phase, a, b = uniform(stream), uniform(stream), uniform(stream)
        if a + b > 1.0:
            a, b = 1.0 - a, 1.0 - b
        other[1], other[2] = a * room, breadth - b * room
        c, d = normal_pair(stream)
        if kind <= KICKED:
            state[0], state[1], state[2] = 0.0, other[1], other[2]
            state[3], state[4], state[5] = forward, step * c, step * d
            for i in range(3):
                other[i], other[i + 3] = state[i], -state[i + 3]
            before, after = phase, 1.0 - phase
            if kind == KICKED:
                before, after = exponential(stream) / 2, exponential(stream) / 2
            state[6] = other[6] = 0.0
            # The crossing itself is not among those that are returned.
            state[7] = fly(state, after, half, breadth) + fly(other, before, half, breadth)
            return tried
        if forward > farthest:
            continue
        other[0] = -phase * forward
        if not is_free(other[0], other[1], other[2], breadth):
            continue
        state[0] = other[0] + forward
        state[1], state[2] = moved(other[1], other[2], kind, step, breadth, c, d, stream)
        if is_free(state[0], state[1], state[2], breadth):
            state[7] = 0.0
            return tried


@compiled
def cluster_sizes(kind, step, room, half, seed, first, stop):
    """Return (how many crossings are in a cluster of n, the crossings tried, steps).

    A cluster are the crossings between two visits to an end of the ring. A random crossing is
    followed forwards and backwards, in the blocks ``first`` … ``stop`` − 1.
    """
    sizes, state, other = np.zeros(STEP_CLUSTER + 1, np.int64), np.zeros(8), np.zeros(8)
    breadth, tried, steps = 1.0 + room, 0, 0
    for block in range(first, stop):
        stream = open_stream(seed, block)
        for _ in range(STEP_CROSSINGS):
            tried += draw_crossing(state, other, kind, step, half, breadth, stream)
            size = 1 + int(state[7])
            later, more = follow(state, kind, step, half, breadth, stream)
            earlier, less = follow(other, kind, step, half, breadth, stream)
            sizes[min(size + later + earlier, STEP_CLUSTER)] += 1
            steps += more + less
    return sizes, tried, steps
