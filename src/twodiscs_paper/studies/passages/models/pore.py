"""Two smooth hard spheres in a cylindrical pore with flat ends: exact times, and κ with friction.

Spheres of the radius r and mass 1 are in a pore of the radius R and the length ℓ. Their centres are
within B = R − r of the axis and have 0 ≤ z ≤ A = ℓ − 2r; they keep a distance of σ = 2r. The energy
is 1/2, so D = 6 components of velocity are on a unit sphere. A hop exchanges the order of z₁ and
z₂. It is blocked if ε = 2R − 4r < 0.

Exact times. Projections of the centres on a cross section are two points of a disc of the radius B.
At a distance t ≥ d(z) = √(σ² − z²)₊ of each other, z = |z₁ − z₂|, the spheres do not overlap. With
cos(ψ/2) = d/2B

    lens(d) = 2B² ∫ sin²(x/2) dx,            the common part of two discs at the distance d,
    beyond(d) = 2B² ∫ f(x) dx,               the part of a disc beyond d from a point of its rim,
    G(d) = ∫ 2πt lens(t) dt = 8πB⁴ ∫ sin²(x/2) f(x) dx,      pairs that are farther apart than d,

from 0 to ψ, f(x) = sin((ψ − x)/2) sin((ψ + x)/2). No terms cancel. The volume and areas are

    V = 2∫ (A − z) G dz,       S_hop = √2 A G(σ),      S_collision = 4√2 π σ ∫ (A − z) lens dz,
    S_end = ∫ G dz,            S_side = 4πB ∫ (A − z) beyond dz,

over 0 < z < A, for collisions up to σ; an end is hit by sphere 1, the curved side too. Areas are
derivatives of V by A, B and σ, so 2A S_end + 2B S_side − σ S_collision/√2 = 6V. The mean times are
V/(c₆ S) for hops, else 2V/(c₆ S), with c₆ = 16/(15π). V itself is known (Urrutia, arXiv:1005.0723).

Without kicks the angular momentum along the axis is conserved. The times are then means over all
initial states, and not those of one trajectory: events are to be counted from independent states.
With friction all velocities are drawn anew at random times of a rate γ.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.integrate import quad

from twodiscs.sampling.jit import compiled, inlined
from twodiscs.sampling.streams import exponential, open_stream, signed_uniform, uniform
from twodiscs.theory.flux import flux_constant
from twodiscs.theory.quadrature import gauss_legendre
from twodiscs_paper.studies.passages.models.brownian_steps import normal_pair

#: The events, by their columns in counts: sphere 1 hits the end at z = A, and the side.
HOP, COLLISION, END_HIT, SIDE = range(4)

#: Crossings in a block, which has a stream of random numbers; larger clusters count as the largest.
PORE_CROSSINGS, PORE_CLUSTER = 2**6, 2**14

NODE, REST, WEIGHT = np.array(gauss_legendre(16)).T


class Pore(NamedTuple):
    """A pore and its spheres by the ranges A and B of their centres and their distance σ."""

    length: float
    breadth: float
    sigma: float

    @classmethod
    def of(cls, length, radius, sphere):
        """Return the ``Pore`` of a ``length`` and ``radius``, for a radius of each ``sphere``."""
        return cls(length - 2 * sphere, radius - sphere, 2 * sphere)


def across(pore, angle, first):
    """Return (G, lens, beyond) at z = σ sin(``angle``); ``first`` is the smallest angle."""
    _, b, sigma = pore
    ratio = sigma / (2 * b)
    # sin²(ψ/2) = 1 − ratio² cos²(angle), or 0 at the first angle if it is not 0.
    square = ratio**2 * math.sin(angle - first) * math.sin(angle + first)
    square += 0.0 if first else (2 * b - sigma) / (2 * b) * (1 + ratio)
    psi = 2 * math.atan2(math.sqrt(max(square, 0.0)), ratio * math.cos(angle))
    lens = np.sin(psi / 2 * NODE) ** 2
    beyond = np.sin(psi / 2 * REST) * np.sin(psi / 2 * (1 + NODE))
    parts = 4 * math.pi * b**2 * lens * beyond, lens, beyond
    return [2 * b**2 * psi * float(part @ WEIGHT) for part in parts]


def volume_and_areas(pore):
    """Return (V, areas of the four events) of a ``Pore``, from integrals of positive terms."""
    a, b, sigma = pore
    first, last = math.acos(min(1.0, 2 * b / sigma)), math.asin(min(1.0, a / sigma))
    whole, far = math.pi * b**2, max(a - sigma, 0.0)

    def integral(power, which):
        # The angle grows as t²: this removes the root of psi at the first angle.
        def integrand(t):
            angle = first + (last - first) * t * t
            slope = 2 * t * (last - first) * sigma * math.cos(angle)
            return (
                (a - sigma * math.sin(angle)) ** power * across(pore, angle, first)[which] * slope
            )

        return quad(integrand, 0, 1, epsabs=0, epsrel=1e-13, limit=200)[0]

    return 2 * integral(1, 0) + (whole * far) ** 2, [
        0.0 if first else math.sqrt(2) * a * across(pore, 0.0, 0.0)[0],
        4 * math.sqrt(2) * math.pi * sigma * integral(1, 1),
        integral(0, 0) + whole**2 * far,
        4 * math.pi * b * (integral(1, 2) + whole * far**2 / 2),
    ]


def rates(pore):
    """Return the mean rates of the four events, hops in both directions together."""
    volume, areas = volume_and_areas(pore)
    return flux_constant(6) / volume * np.array(areas) / (1, 2, 2, 2)


# Motion -----------------------------------------------------------------------------------------


@inlined
def draw_velocities(v, crossing, stream):
    """Draw velocities ``v`` (2, 3) evenly on the unit sphere.

    At a ``crossing`` u < 0 → u > 0 they are weighted by the flux.
    """
    square = 0.0
    for k in range(3):
        v[0, k], v[1, k] = normal_pair(stream)
    if crossing:
        apart, both = math.sqrt(exponential(stream)), (v[0, 2] + v[1, 2]) / 2
        v[0, 2], v[1, 2] = both + apart, both - apart
    for k in range(3):
        square += v[0, k] ** 2 + v[1, k] ** 2
    for k in range(3):
        v[0, k], v[1, k] = v[0, k] / math.sqrt(square), v[1, k] / math.sqrt(square)


@compiled
def move(q, v, pore, time, friction, far, counts, stream):
    """Move spheres at ``q`` with velocities ``v``, both (2, 3), for a ``time`` with kicks.

    They stop earlier if |u| comes to ``far``. ``counts`` (4) gets the events on the way.
    """
    length, breadth, sigma = pore
    normal, apart, rate = np.zeros((2, 3)), np.zeros(3), np.zeros(3)
    kick = exponential(stream) / friction if friction > 0.0 else math.inf
    ahead = q[0, 2] > q[1, 2] or (q[0, 2] == q[1, 2] and v[0, 2] > v[1, 2])
    while True:
        for k in range(3):
            normal[0, k] = normal[1, k] = 0.0
            apart[k], rate[k] = q[0, k] - q[1, k], v[0, k] - v[1, k]
        least, event, who = time, -1, 0
        gap = max(far - math.copysign(apart[2], apart[2] * rate[2]), 0.0)
        if gap < abs(rate[2]) * least:
            least = gap / abs(rate[2])
        if kick < least:
            least, event = kick, HOP
        for i in range(2):
            gap = max(length - q[i, 2] if v[i, 2] > 0.0 else q[i, 2], 0.0)
            if gap < abs(v[i, 2]) * least:
                least, event, who = gap / abs(v[i, 2]), END_HIT, i
            along, square = q[i, 0] * v[i, 0] + q[i, 1] * v[i, 1], v[i, 0] ** 2 + v[i, 1] ** 2
            gap = max(breadth * breadth - q[i, 0] ** 2 - q[i, 1] ** 2, 0.0)
            root = math.sqrt(along * along + square * gap)
            hit = (root - along) / square if along < 0.0 else gap / (root + along)
            if hit < least:
                least, event, who = hit, SIDE, i
        distance = approach = square = cross = 0.0
        for k in range(3):
            distance, square = distance + apart[k] ** 2, square + rate[k] ** 2
            approach += apart[k] * rate[k]
            cross += (apart[k] * rate[k - 1] - apart[k - 1] * rate[k]) ** 2
        root = square * sigma * sigma - cross
        if approach < 0.0 < root:
            hit = max(distance - sigma * sigma, 0.0) / (math.sqrt(root) - approach)
            if hit < least:
                least, event = hit, COLLISION
        for k in range(3):
            q[0, k], q[1, k] = q[0, k] + v[0, k] * least, q[1, k] + v[1, k] * least
            apart[k] = q[0, k] - q[1, k]
        if apart[2] != 0.0 and (apart[2] > 0.0) != ahead:
            counts[HOP], ahead = counts[HOP] + 1, not ahead
        time, kick = time - least, kick - least
        if event < 0:
            return
        if event == HOP:
            draw_velocities(v, False, stream)
            kick = exponential(stream) / friction
            continue
        if event == COLLISION:
            counts[COLLISION] += 1
            for k in range(3):
                normal[0, k], normal[1, k] = apart[k], -apart[k]
        elif event == END_HIT:
            counts[END_HIT] += who == 0 and v[0, 2] > 0.0
            normal[who, 2] = 1.0
        else:
            counts[SIDE] += who == 0
            normal[who, 0], normal[who, 1] = q[who, 0], q[who, 1]
        share = 2 * (v * normal).sum() / (normal * normal).sum()
        for k in range(3):
            v[0, k], v[1, k] = v[0, k] - share * normal[0, k], v[1, k] - share * normal[1, k]


@compiled
def count_events(pore, friction, time, seed, replicas):
    """Return the counts of events in a ``time`` from independent initial states, (replicas, 4)."""
    length, breadth, sigma = pore
    counts, q, v = np.zeros((replicas, 4), np.int64), np.zeros((2, 3)), np.zeros((2, 3))
    for replica in range(replicas):
        stream, apart, outside = open_stream(seed, replica), 0.0, True
        while outside or apart < sigma * sigma:
            outside = False
            for i in range(2):
                for k in range(2):
                    q[i, k] = breadth * signed_uniform(stream)
                q[i, 2] = length * uniform(stream)
                outside = outside or q[i, 0] ** 2 + q[i, 1] ** 2 > breadth * breadth
            apart = ((q[0] - q[1]) ** 2).sum()
        draw_velocities(v, False, stream)
        move(q, v, pore, time, friction, math.inf, counts[replica], stream)
    return counts


@inlined
def draw_crossing(q, pore, stream):
    """Draw positions ``q`` (2, 3) with u = 0 evenly, for σ ≥ √2 B.

    Sphere 1 has a slack at the side, and sphere 2 another one on the opposite side.
    """
    length, breadth, sigma = pore
    room, least = 2 * breadth - sigma, sigma * sigma / (2 * breadth) - breadth
    first, across, second = 0.0, 0.0, 0.0
    while (first + second) ** 2 + across**2 < sigma**2 or breadth * uniform(stream) > first:
        first = breadth - room * uniform(stream)
        across = math.sqrt(breadth**2 - least**2) * signed_uniform(stream)
        second = math.sqrt(breadth**2 - across**2) - room * uniform(stream)
    a, b = normal_pair(stream)
    a, b = a / math.sqrt(a * a + b * b), b / math.sqrt(a * a + b * b)
    q[0, 0], q[0, 1] = first * a, first * b
    q[1, 0], q[1, 1] = -second * a - across * b, across * a - second * b
    q[0, 2] = q[1, 2] = length * uniform(stream)


@compiled
def cluster_sizes(pore, friction, far, seed, first, stop):
    """Return (how many crossings are in a cluster of n, events) of the blocks ``first`` … ``stop``.

    Each random crossing is followed in both directions of time, until |u| is ``far``.
    """
    sizes, counts = np.zeros(PORE_CLUSTER + 1, np.int64), np.zeros(4, np.int64)
    q, v = np.zeros((2, 3)), np.zeros((2, 3))
    for block in range(first, stop):
        stream = open_stream(seed, block)
        for _ in range(PORE_CROSSINGS):
            before = counts[HOP]
            draw_crossing(q, pore, stream)
            draw_velocities(v, True, stream)
            earlier, reversed_ = q.copy(), -v
            move(q, v, pore, math.inf, friction, far, counts, stream)
            move(earlier, reversed_, pore, math.inf, friction, far, counts, stream)
            sizes[min(1 + counts[HOP] - before, PORE_CLUSTER)] += 1
    return sizes, counts
