"""The limit of smooth discs at the threshold: the number c of 1 − κ = c σ^(2/3) ε^(1/3)/A.

Close to the threshold, one end wall turns one disc round while the pair is next to the neck. At a
separation u along the hop the slacks ξ, η ≥ 0 of the discs at the walls across have the room
ξ + η ≤ ε + u²/(2σ). Lengths along the hop are measured in (ε σ²)^(1/3) and slacks in the square of
it over σ. For ε → 0 the room is then u²/2, the relative velocity along the hop is constant outside
of the neck, and in the neck the adiabatic invariants w_i = v_i × room/ε are kept.

A pair leaves the neck with the invariants w of the flux through it, at a relative speed g. The
total velocity along the hop is P ≥ 0, with P² + g² = 2, and the disc that leads has the speed
p = (P + g)/2. (For P < 0 the other disc turns the pair round, as in a mirror. The mean is over
P ≥ 0; over both signs it would be c/2.) After the disc met the wall, the pair comes back at the
relative speed P, and it passes if P² > 2(w'₁² + w'₂²), with the invariants w' that it has then. If
not, the neck reflects the pair, and no wall sends it back again: the disc that turned then has the
velocity (P − g)/2. If P < g it leaves the wall. If P > g it meets the wall again, but the other
disc, at the speed p, leaves faster, and the separation grows at the speed g. The distance of the
neck from the wall is distributed evenly, so c = 2 ⟨p/g ∫ 1[passes] dU⟩ with the separation U at
which the disc turns.
"""

import math

import numpy as np

from twodiscs.sampling.jit import compiled, inlined
from twodiscs.sampling.streams import open_stream, uniform
from twodiscs_paper.studies.estimates import sample_mean

#: The separation below which invariants are kept; for half as much c is the same within 5e-3.
KEPT_SEPARATION = 0.3

#: Separations U of the turn are drawn uniformly up to ``UNIFORM_TURNS``, and with this probability
#: from a density ∝ 1/U up to ``FARTHEST_TURN`` times that. A pair passes with a probability ∝ U⁻²
#: there, so all that turn later would add less than 1e-4 to c.
UNIFORM_TURNS, FAR_SHARE, FARTHEST_TURN = 1.5, 0.4, 2.0**10

#: A pair on its way back is given up once an invariant is ``LOST_INVARIANT`` times the largest that
#: passes, where one traversal of the room changes the room by less than the share ``ROOM_CHANGE``.
LOST_INVARIANT, ROOM_CHANGE = 1.5, 0.05

#: Pairs in a block, which has a stream of random numbers.
LIMIT_PAIRS = 2**12


@inlined
def first_contact(slack, speed, separation, rate):
    """Return the time until ``slack`` + ``speed`` t meets (``separation`` + ``rate`` t)²/2.

    It is infinite if they do not meet, and 0 if they touch and approach.
    """
    half = rate * separation - speed
    gap = max(separation * separation / 2 - slack, 0.0)
    square = half * half - 2 * rate * rate * gap
    return 2 * gap / (math.sqrt(square) - half) if half < 0.0 and square > 0.0 else math.inf


@compiled
def fly(state, separation, rate, end, largest):
    """Move the slacks and their velocities, ``state`` (4), until the separation is ``end``.

    The separation changes at the constant ``rate``. Returns whether it came there: a pair with an
    invariant above ``largest`` is given up.
    """
    while True:
        x, y, v, w = state[0], state[1], state[2], state[3]
        time, event = (end - separation) / rate, 0
        if v < 0.0 and x < -v * time:
            time, event = -x / v, 1
        if w < 0.0 and y < -w * time:
            time, event = -y / w, 2
        contact = first_contact(x + y, v + w, separation, rate)
        if contact < time:
            time, event = contact, 3
        state[0], state[1] = x + v * time, y + w * time
        separation += rate * time
        if event == 0:
            return True
        if event == 3:
            # Relative to the moving limit of the room the sum of the velocities is reversed.
            state[2], state[3] = separation * rate - w, separation * rate - v
        else:
            state[event - 1], state[event + 1] = 0.0, -state[event + 1]
        invariant = math.sqrt(state[2] ** 2 + state[3] ** 2) * separation * separation / 2
        if invariant > largest and separation**3 * abs(rate) < ROOM_CHANGE * invariant:
            return False


@compiled
def returns(seed, first, stop, near):
    """Return the means over the pairs of blocks ``first`` … ``stop`` − 1, whose mean is c.

    Below the separation ``near`` invariants are kept.
    """
    means, state, room = np.zeros(stop - first), np.zeros(4), near * near / 2
    for block in range(first, stop):
        stream = open_stream(seed, block)
        for _ in range(LIMIT_PAIRS):
            # 1 − (relative speed)²/2 on the surface, weighted by the flux, and a direction.
            rest, cosine = uniform(stream) ** (2 / 3), uniform(stream)
            total = math.sqrt(2 * rest) * cosine
            across, angle = math.sqrt(rest * (1 - cosine**2)), math.pi / 2 * uniform(stream)
            apart = math.sqrt(2 - total * total)
            r = uniform(stream)
            if r < FAR_SHARE:
                turn = UNIFORM_TURNS * FARTHEST_TURN ** (r / FAR_SHARE)
                weight = turn * math.log(FARTHEST_TURN) / FAR_SHARE
            else:
                turn = UNIFORM_TURNS * (r - FAR_SHARE) / (1 - FAR_SHARE)
                weight = UNIFORM_TURNS / (1 - FAR_SHARE)
            if turn <= near:
                passes = total > math.sqrt(2.0) * across
            else:
                a, b = uniform(stream), uniform(stream)
                a, b = (1 - a, 1 - b) if a + b > 1 else (a, b)
                state[0], state[1] = a * room, b * room
                state[2] = math.copysign(across * math.cos(angle) / room, uniform(stream) - 0.5)
                state[3] = math.copysign(across * math.sin(angle) / room, uniform(stream) - 0.5)
                fly(state, near, apart, turn, math.inf)
                most = total / math.sqrt(2.0)
                passes = fly(state, turn, -total, near, LOST_INVARIANT * most)
                passes = passes and (state[2] ** 2 + state[3] ** 2) * room * room < most * most
            if passes:
                means[block - first] += weight * (1 + total / apart) / LIMIT_PAIRS
    return means


def amplitude(blocks, seed, near=KEPT_SEPARATION):
    """Return c as an ``Estimate``, from ``blocks`` blocks of ``LIMIT_PAIRS`` pairs.

    ``near`` is the separation, in units of (ε σ²)^(1/3), below which invariants are taken as kept;
    c is the limit for small ones.
    """
    return sample_mean(returns(np.uint64(seed), 0, blocks, float(near)))
