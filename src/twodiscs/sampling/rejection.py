"""Draws of scenes with effects from the invariant measure, by rejection from the prism.

The prism has all positions of both centres. Without overlap the density of configurations is ∝
(E − U)^(D/2 − 1), with D velocity components, and velocities scaled by √mass are uniform on a
sphere in D dimensions.
"""

import math
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from twodiscs.model.events import EVENT_AXES
from twodiscs.sampling.conditioned import draw_in_disc
from twodiscs.sampling.jit import compiled, optional
from twodiscs.sampling.streams import draw_largest, next_bits, signed_uniform, uniform


class Neck(NamedTuple):
    """The configurations near the surface of a hop, where |Δ| along one axis is small.

    Along the other axes |Δ| has a minimum there, maybe 0. If it is above 0 between walls, each disc
    is within ``span`` of a different wall.
    """

    axis: int  # 0 for x, 1 for y
    within: float  # the largest |Δ| along it
    least: tuple  # the minimum of |Δ| along x, y, z
    span: tuple  # the largest |Δ| minus the minimum
    most: float  # the largest kinetic fraction of the energy


class RejectionSampler(NamedTuple):
    """The constants of a scene for draws by rejection; None for absent effects.

    The centre of disc i lies within ±half_xi, half the side where the axis is periodic; ``period``
    holds the sides of periodic axes, 0 between walls.
    """

    half_1: tuple  # of disc 1 along x, y, z; z is 0 in the plane
    half_2: tuple
    period: tuple
    conserved: tuple  # whether the total momentum along x, y, z is 0
    sigma: float
    inverse_roots: tuple  # 1/√m of disc 1 and 2, and of the reduced mass
    fractions: tuple  # m2/M, m1/M
    components: int  # D
    weights: tuple | None  # of the potential: 2 g m1, 2 g m2
    depth: bool | None
    inertia: tuple | None  # 1/√(κ m) of disc 1 and 2
    neck: Neck | None = None  # the neck to which draws are restricted


def find_neck(scene, hop, within):
    """Return the ``Neck`` of an open ``hop`` of a ``Scene``, ``within`` a distance < σ."""
    axis, within = EVENT_AXES[hop], Fraction(within)
    squares = {a: scene.reach(a) ** 2 for a in scene.axes if a != axis}
    missing = scene.exact_contact**2 - within**2 - sum(squares.values())
    least, span = dict.fromkeys("xyz", 0.0), dict.fromkeys("xyz", 0.0)
    for a, square in squares.items():
        least[a] = math.sqrt(max(missing + square, 0))
        span[a] = float(min(-missing, square)) / (float(scene.reach(a)) + least[a])
    # In a field the upper disc is at least at this height.
    rise = least["y"] - abs(scene.radii[0] - scene.radii[1])
    most = 1 - 2 * scene.field * min(scene.masses) * max(rise, 0.0)
    return Neck("xy".index(axis), float(within), tuple(least.values()), tuple(span.values()), most)


def rejection_sampler(scene, hop=None, within=None):
    """Return the ``RejectionSampler`` of a ``Scene``, for a ``hop`` in its neck (``find_neck``)."""

    def half(axis, radius):
        if axis not in scene.axes:
            return 0.0
        return (scene.side(axis) - (0 if axis in scene.periodic else 2 * radius)) / 2

    (m1, m2), inertia = scene.masses, scene.moment_of_inertia
    return RejectionSampler(
        half_1=tuple(half(axis, scene.radii[0]) for axis in "xyz"),
        half_2=tuple(half(axis, scene.radii[1]) for axis in "xyz"),
        period=tuple(scene.side(axis) if axis in scene.periodic else 0.0 for axis in "xyz"),
        conserved=tuple(axis in scene.conserved for axis in "xyz"),
        sigma=scene.contact_distance,
        inverse_roots=(1.0, 1 / math.sqrt(m2), math.sqrt(1 / m1 + 1 / m2)),
        fractions=(m2 / (m1 + m2), m1 / (m1 + m2)),
        components=scene.velocity_components,
        weights=(2 * scene.field * m1, 2 * scene.field * m2) if scene.field else None,
        depth=None if scene.depth is None else True,
        inertia=inertia and (1 / math.sqrt(inertia * m1), 1 / math.sqrt(inertia * m2)),
        neck=None if hop is None else find_neck(scene, hop, within),
    )


def proposed_measure(prism):
    """Return the volume that ``propose_anywhere`` fills, times the largest weight.

    The acceptance of a proposal is the weighted volume of the scene (in the neck) over this.
    """
    neck, measure = prism.neck, 1.0
    for axis, (half_1, half_2) in enumerate(zip(prism.half_1, prism.half_2, strict=True)):
        if not half_1:
            continue  # z in the plane
        if axis == neck.axis:
            measure *= 4 * half_1 * neck.within
        elif neck.least[axis] == 0.0:
            measure *= 4 * half_1 * half_2
        elif prism.period[axis]:
            measure *= 4 * half_1 * neck.span[axis]
        else:
            measure *= 2 * math.prod(min(neck.span[axis], 2 * half) for half in (half_1, half_2))
    return measure * neck.most ** (prism.components / 2 - 1)


@compiled
def nearest(separation, period):
    """Return a ``separation`` to the nearest image; ``period`` 0 stands for walls."""
    if period == 0.0:
        return separation
    if separation > 0.5 * period:
        return separation - period
    if separation < -0.5 * period:
        return separation + period
    return separation


@optional(lambda y1, y2, half1, half2, weights: 1.0)
def kinetic_fraction(y1, y2, half1, half2, weights):
    """Return 1 − U/E, the kinetic fraction of the energy E = 1/2; it is negative if U > E."""
    return 1.0 - weights[0] * (y1 + half1) - weights[1] * (y2 + half2)


@optional(lambda state, prism: 1.0)
def state_kinetic_fraction(state, prism):
    """Return the kinetic fraction of the energy in a ``state``; 1 without a ``prism``."""
    half_1, half_2 = prism.half_1[1], prism.half_2[1]
    return kinetic_fraction(state[1], state[3], half_1, half_2, prism.weights)


@compiled
def power_chance(state, fraction, power):
    """Return True with the probability ``fraction`` to the ``power``/2, for 0 ≤ ``power``."""
    if fraction <= 0.0:
        return False
    chance = 1.0
    for _ in range(power):
        chance *= fraction
    root = uniform(state)
    return root * root < chance


@optional(lambda state, prism, depth: (0.0, 0.0))
def propose_deep(state, prism, depth):
    """Return (z1, dz), both 0 in the plane."""
    z1 = prism.half_1[2] * signed_uniform(state)
    return z1, nearest(z1 - prism.half_2[2] * signed_uniform(state), prism.period[2])


@compiled
def propose_in_prism(state, prism):
    """Return (x1, y1, z1, dx, dy, dz): a centre of disc 1 and the separation, drawn in the prism.

    Separations are to the nearest image on periodic axes. In the plane z1 and dz are 0.
    """
    x1, y1 = prism.half_1[0] * signed_uniform(state), prism.half_1[1] * signed_uniform(state)
    dx = x1 - prism.half_2[0] * signed_uniform(state)
    dy = y1 - prism.half_2[1] * signed_uniform(state)
    z1, dz = propose_deep(state, prism, prism.depth)
    return x1, y1, z1, nearest(dx, prism.period[0]), nearest(dy, prism.period[1]), dz


@compiled
def propose_apart(state, prism, axis, neck):
    """Return (q1, Δ, whether it counts) along an axis other than that of the ``neck``.

    Between walls disc 1 is drawn near one wall and disc 2 near the other. If ``span`` is large, the
    draw may have the opposite order. It then does not count, because the opposite choice of walls
    draws it already.
    """
    half_1, half_2, span = prism.half_1[axis], prism.half_2[axis], neck.span[axis]
    if neck.least[axis] == 0.0:
        q1 = half_1 * signed_uniform(state)
        return q1, nearest(q1 - half_2 * signed_uniform(state), prism.period[axis]), True
    sign = 1.0 if next_bits(state) & np.uint64(1 << 61) else -1.0
    if prism.period[axis] > 0.0:
        q1 = half_1 * signed_uniform(state)
        return q1, sign * (neck.least[axis] + span * uniform(state)), True
    q1 = sign * (half_1 - min(span, 2.0 * half_1) * uniform(state))
    q2 = sign * (min(span, 2.0 * half_2) * uniform(state) - half_2)
    return q1, q1 - q2, sign * (q1 - q2) > 0.0


@optional(lambda state, prism, neck, depth: (0.0, 0.0, True))
def propose_deep_apart(state, prism, neck, depth):
    """Return (z1, dz, whether they count), both 0 in the plane."""
    return propose_apart(state, prism, 2, neck)


@optional(lambda state, prism, neck: propose_in_prism(state, prism))
def propose_anywhere(state, prism, neck):
    """Return a proposal as ``propose_in_prism`` does, within a ``neck`` if there is one."""
    half_1, half_2 = prism.half_1[neck.axis], prism.half_2[neck.axis]
    q1, apart = half_1 * signed_uniform(state), neck.within * signed_uniform(state)
    other, separation, counts = propose_apart(state, prism, 1 - neck.axis, neck)
    z1, dz, deep_counts = propose_deep_apart(state, prism, neck, prism.depth)
    if abs(q1 - apart) > half_2 or not counts or not deep_counts:
        # An overlap: this is never accepted.
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    if neck.axis == 0:
        return q1, other, z1, apart, separation, dz
    return other, q1, z1, separation, apart, dz


@optional(lambda fraction, neck: fraction)
def relative_fraction(fraction, neck):
    """Return the kinetic ``fraction`` over the largest one."""
    return fraction / neck.most


@compiled
def fraction_if_accepted(state, prism, y1, dx, dy, dz, power):
    """Return the kinetic fraction of the energy if a proposal is accepted, and −1 if it is not.

    Discs that do not overlap are accepted with the probability fraction^(``power``/2); in a neck
    the fraction is divided by its largest value.
    """
    if dx * dx + dy * dy + dz * dz < prism.sigma * prism.sigma:
        return -1.0
    fraction = kinetic_fraction(y1, y1 - dy, prism.half_1[1], prism.half_2[1], prism.weights)
    if prism.weights is None or power_chance(state, relative_fraction(fraction, prism.neck), power):
        return fraction
    return -1.0


@compiled
def draw_in_prism(state, prism, axis):
    """Return (x1, y1, z1, dx, dy, dz, kinetic fraction) from the invariant measure.

    With an ``axis`` (0 for x, 1 for y, −1 for none) they are on the surface of a hop along it. The
    density there is ∝ (E − U)^((D − 1)/2), like the flux through the surface.
    """
    power = prism.components - (2 if axis < 0 else 1)
    while True:
        x1, y1, z1, dx, dy, dz = propose_anywhere(state, prism, prism.neck)
        if axis == 0:
            x1, dx = min(prism.half_1[0], prism.half_2[0]) * signed_uniform(state), 0.0
        elif axis == 1:
            y1, dy = min(prism.half_1[1], prism.half_2[1]) * signed_uniform(state), 0.0
        fraction = fraction_if_accepted(state, prism, y1, dx, dy, dz, power)
        if fraction >= 0.0:
            return x1, y1, z1, dx, dy, dz, fraction


@compiled
def draw_direction(state, n, direction):
    """Fill ``direction`` with a unit vector, uniform in ``n`` ≤ 6 dimensions.

    The squared lengths of pairs of components are the spacings of sorted uniform numbers, and each
    pair has a random direction. In an odd dimension the last component is left out.
    """
    low, high = 1.0, 1.0
    if n > 2:
        low = uniform(state)
    if n > 4:
        high = uniform(state)
        low, high = min(low, high), max(low, high)
    for pair in range((n + 1) // 2):
        square = low if pair == 0 else (high - low if pair == 1 else 1.0 - high)
        p, q, s = draw_in_disc(state)
        scale = math.sqrt(square / s)
        direction[2 * pair], direction[2 * pair + 1] = p * scale, q * scale
    if n % 2 == 1:
        square = 0.0
        for i in range(n):
            square += direction[i] * direction[i]
        scale = 1.0 / math.sqrt(square)
        for i in range(n):
            direction[i] *= scale


@compiled
def draw_velocities(state, prism, speed, normal_axis, direction, velocity):
    """Fill ``velocity`` (u1, v1, w1, s1, u2, v2, w2, s2) from the invariant measure.

    The components are scaled by the roots of masses and moments of inertia. An axis with total
    momentum 0 has one component, scaled by the root of the reduced mass. They are uniform on a
    sphere of radius ``speed``. With a ``normal_axis`` (0 or 1; −1 for none) the relative velocity
    along it has the law of the flux through the surface of a hop. Its normal component n has a
    density ∝ |n| (1 − n²)^((D − 3)/2), so that √(1 − n²) is the largest of D − 1 uniform numbers.
    """
    n, rest, normal = prism.components, 1.0, 0.0
    if normal_axis >= 0:
        n -= 1
        rest = draw_largest(state, n)
        normal = math.sqrt((1.0 - rest) * (1.0 + rest))
        if next_bits(state) & np.uint64(1 << 61):
            normal = -normal
    draw_direction(state, n, direction)
    root_1, root_2, root = prism.inverse_roots
    used = 0
    for axis in range(3):
        if axis == 2 and prism.depth is None:
            velocity[2], velocity[6] = 0.0, 0.0
        elif prism.conserved[axis]:
            along = axis == normal_axis
            relative = (speed * normal if along else speed * rest * direction[used]) * root
            velocity[axis] = relative * prism.fractions[0]
            velocity[axis + 4] = -relative * prism.fractions[1]
            used += 0 if along else 1
        elif axis == normal_axis:
            # Unit vectors of the relative motion and of the centre of mass, in scaled velocities.
            along_1, along_2 = math.sqrt(prism.fractions[0]), math.sqrt(prism.fractions[1])
            common = rest * direction[used]
            velocity[axis] = speed * root_1 * (normal * along_1 + common * along_2)
            velocity[axis + 4] = speed * root_2 * (common * along_1 - normal * along_2)
            used += 1
        else:
            velocity[axis] = speed * rest * direction[used] * root_1
            velocity[axis + 4] = speed * rest * direction[used + 1] * root_2
            used += 2
    velocity[3], velocity[7] = 0.0, 0.0
    add_spins(direction, used, speed * rest, velocity, prism.inertia)


@optional(lambda direction, used, speed, velocity, inertia: None)
def add_spins(direction, used, speed, velocity, inertia):
    """Fill in the spins of rough discs from the unused components of ``direction``."""
    velocity[3] = speed * direction[used] * inertia[0]
    velocity[7] = speed * direction[used + 1] * inertia[1]
