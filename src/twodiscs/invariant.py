"""Exact draws from the invariant measure: configurations, velocities, crossings of a hop surface.

Rejection from the whole prism dies out as the radius grows. Here the separations u = |x1 − x2| and
v = |y1 − y2| are drawn instead; their density is (A − u)(B − v) outside the circle u² + v² = σ².
Integrated over v it is g(u) = (A − u)(B − k)₊²/2 with k = √(σ² − u²)₊:

* for u ≥ σ, g is a triangle and is drawn directly;
* for u < σ, B − k has a bound that is a sum of positive powers of s = u − u₀ (u₀ = √(σ² − B²)₊):
  (B − σ) + s²/σ where B ≥ σ, and s (2u₀ + s)/(B + k₁) where B < σ, with k₁ the smallest k. Each is
  at most twice B − k, so that at least a quarter of the proposals is accepted, whatever the radius.

The powers are drawn as order statistics of uniform numbers, so nothing here needs more than
+ − × / and √.

Scenes with effects take the simple way, rejection from the prism (``Prism``, ``draw_in_prism``):
there the density of configurations is ∝ (E − U)^(D/2 − 1) where the discs do not overlap, with D
velocity components, and velocities scaled by √mass are uniform on a sphere in D dimensions.
"""

import math
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from twodiscs.jit import compiled, optional
from twodiscs.streams import largest_of, next_bits, second_largest_of, signed_uniform, uniform


class Draw(NamedTuple):
    """What a draw of separations needs to know of the scene; all lengths, weights without unit."""

    half_x: float  # a
    half_y: float  # b
    range_y: float  # B
    sigma: float  # σ
    start: float  # u₀, where the arc enters the rectangle
    stop: float  # u₁ = min(σ, A), where it leaves
    span: float  # u₁ − u₀
    beyond_x: float  # (A − σ)₊
    beyond_y: float  # (B − σ)₊
    least_k: float  # k₁ = √(σ² − u₁²)
    weights: tuple  # cumulative probabilities of the seven parts of the proposal
    mass: float  # integral of the proposal; the accepted share is V/2 over it


def draw_constants(scene):
    """Return the ``Draw`` of a ``Scene``.

    The differences of lengths that cancel near a threshold or near the largest radius are rounded
    once, from exact fractions.
    """
    w, h, r = Fraction(scene.width), Fraction(scene.height), Fraction(scene.radius)
    range_x, range_y, sigma = float(w - 2 * r), float(h - 2 * r), float(2 * r)
    beyond_x, beyond_y = max(float(w - 4 * r), 0.0), max(float(h - 4 * r), 0.0)
    start = math.sqrt(max(float(h * (4 * r - h)), 0.0))
    least_k = math.sqrt(max(float(w * (4 * r - w)), 0.0))
    stop = min(sigma, range_x)
    if beyond_y > 0:
        span = stop
    elif beyond_x > 0:
        span = range_y * range_y / (sigma + start)
    else:
        room = (w - 2 * r) ** 2 + (h - 2 * r) ** 2 - (2 * r) ** 2
        span = float(room) / (range_x + start)

    # The bound of (B − k)² as Σ c_j s^j, times A − u = (A − σ)₊ + (span − s). Products, not powers,
    # whose last digit depends on the math library, nor ``sum``, whose depends on Python's version.
    if beyond_y > 0:
        powers = {0: beyond_y * beyond_y, 2: 2 * beyond_y / sigma, 4: 1 / (sigma * sigma)}
    else:
        scale = 1 / ((range_y + least_k) * (range_y + least_k))
        powers = {2: 4 * start * start * scale, 3: 4 * start * scale, 4: scale}
    parts = [beyond_x * beyond_x / 2 * range_y * range_y]
    for j, c in powers.items():
        parts.append(c * beyond_x * math.prod([span] * (j + 1)) / (j + 1))
        parts.append(c * math.prod([span] * (j + 2)) / ((j + 1) * (j + 2)))
    total = math.fsum(parts)
    cumulative = tuple(math.fsum(parts[: i + 1]) / total for i in range(len(parts)))
    return Draw(
        range_x / 2, range_y / 2, range_y, sigma, start, stop, span, beyond_x, beyond_y, least_k,
        cumulative, total,
    )  # fmt: skip


@compiled
def propose_separation(state, draw):
    """Propose separations u, v; return (accepted, A − u, B − v, u, u² + v² − σ²).

    The distances from the far corner, A − u and B − v, keep their relative accuracy where the discs
    hardly fit, and so does the last value where they touch. A proposal is accepted with the
    probability V/2 over ``draw.mass``, and then has the law of the invariant measure.
    """
    choice = uniform(state)
    if choice < draw.weights[0]:
        slack = draw.beyond_x * math.sqrt(uniform(state))
        beyond = draw.beyond_x - slack
        u = draw.sigma + beyond
        slack_y = draw.range_y * math.sqrt(uniform(state))
        v = draw.range_y - slack_y
        return True, slack, slack_y, u, beyond * (u + draw.sigma) + v * v
    part = 1
    while part < 6 and choice >= draw.weights[part]:
        part += 1
    pair = (part - 1) // 2
    power = 2 * pair if draw.beyond_y > 0.0 else 2 + pair
    if part % 2 == 1:
        s = draw.span * largest_of(state, power + 1)
    else:
        s = draw.span * second_largest_of(state, power + 2)
    u = draw.start + s
    z = draw.span - s
    k = math.sqrt(draw.least_k * draw.least_k + z * (2.0 * draw.stop - z))
    if draw.beyond_y > 0.0:
        room = draw.beyond_y + u * u / (draw.sigma + k)
        bound = draw.beyond_y + u * u / draw.sigma
    else:
        room = s * (2.0 * draw.start + s) / (draw.range_y + k)
        bound = s * (2.0 * draw.start + s) / (draw.range_y + draw.least_k)
    if uniform(state) * (bound * bound) >= room * room:
        return False, 0.0, 0.0, 0.0, 0.0
    slack_y = room * math.sqrt(uniform(state))
    # v = k + room − slack_y.
    return True, draw.beyond_x + z, slack_y, u, (room - slack_y) * (2.0 * k + room - slack_y)


@compiled
def draw_separation(state, draw):
    """Return (A − u, B − v, u) for separations u, v of the invariant measure."""
    while True:
        accepted, slack_x, slack_y, u, _ = propose_separation(state, draw)
        if accepted:
            return slack_x, slack_y, u


@compiled
def place(state, half, slack, order):
    """Return coordinates (q1, q2) on [−half, half] whose distance is 2 half − ``slack``.

    ``order`` ≥ 0 puts disc 1 above disc 2, otherwise below.
    """
    share = uniform(state)
    low = slack * share - half
    high = half - slack * (1.0 - share)
    if order >= 0:
        return high, low
    return low, high


@compiled
def draw_configuration(state, draw, side_x, side_y):
    """Return centres (x1, y1, x2, y2), uniform over the allowed configurations.

    ``side_x`` > 0 asks for x1 > x2, < 0 for x1 < x2, 0 for either with equal chance; ``side_y``
    likewise. Where a hop is blocked this chooses the ergodic component.
    """
    slack_x, slack_y, _ = draw_separation(state, draw)
    bits = next_bits(state)
    order_x = side_x if side_x != 0 else (1 if bits & np.uint64(1 << 62) else -1)
    order_y = side_y if side_y != 0 else (1 if bits & np.uint64(1 << 61) else -1)
    x1, x2 = place(state, draw.half_x, slack_x, order_x)
    y1, y2 = place(state, draw.half_y, slack_y, order_y)
    return x1, y1, x2, y2


@compiled
def draw_in_disc(state):
    """Return (p, q, p² + q²) uniform in the unit disc without its centre."""
    while True:
        p, q = signed_uniform(state), signed_uniform(state)
        square = p * p + q * q
        if 0.0 < square < 1.0:
            return p, q, square


@compiled
def draw_velocity(state):
    """Return (u1, v1, u2, v2) uniform on the unit sphere, total energy 1/2.

    Marsaglia, Ann. Math. Stat. 43, 645 (1972): two points in the disc, one of them rescaled.
    """
    p, q, square = draw_in_disc(state)
    s, t, other = draw_in_disc(state)
    scale = math.sqrt((1.0 - square) / other)
    return p, q, s * scale, t * scale


@compiled
def draw_crossing(state, half_x, half_y, beyond_x):
    """Return a state (x1, y1, x2, y2, u1, v1, u2, v2) on y1 = y2, weighted by the flux through it.

    Positions are uniform on the surface (|x1 − x2| ≥ σ has slack (A − σ)√U). The component of the
    velocity along the surface's normal, n = (v1 − v2)/√2, has density ∝ |n| √(1 − n²): then 1 − n²
    is the square of the largest of three uniform numbers.
    """
    slack = beyond_x * math.sqrt(uniform(state))
    bits = next_bits(state)
    x1, x2 = place(state, half_x, slack, 1 if bits & np.uint64(1 << 62) else -1)
    y = half_y * signed_uniform(state)
    rest = largest_of(state, 3)
    normal = math.sqrt((1.0 - rest) * (1.0 + rest))
    if bits & np.uint64(1 << 61):
        normal = -normal
    # Uniform on the sphere of radius ``rest`` in the other three components (Marsaglia).
    p, q, square = draw_in_disc(state)
    scale = 2.0 * rest * math.sqrt(1.0 - square)
    u1, u2, common = p * scale, q * scale, rest * (1.0 - 2.0 * square)
    half = math.sqrt(0.5)
    return x1, y, x2, y, u1, (common + normal) * half, u2, (common - normal) * half


# Scenes with effects ----------------------------------------------------------------------------


class Prism(NamedTuple):
    """What a draw by rejection needs to know of a scene; None for what is absent.

    The centre of disc i lies within ±half_xi, half the side where the axis is periodic; ``period``
    holds the sides of periodic axes, 0 between walls.
    """

    half_1: tuple  # of disc 1 along x, y, z; z is 0 in the plane
    half_2: tuple
    period: tuple
    conserved: tuple  # whether the total momentum along x, y, z is 0
    sigma: float
    inverse_roots: tuple  # 1/√m of disc 1 and 2, and of the reduced mass
    shares: tuple  # m2/M, m1/M
    components: int  # D
    weights: tuple | None  # of the potential: 2 g m1, 2 g m2
    depth: bool | None
    inertia: tuple | None  # 1/√(κ m) of disc 1 and 2


def prism_of(scene):
    """Return the ``Prism`` of a ``Scene``."""

    def half(axis, radius):
        if axis not in scene.axes:
            return 0.0
        return (scene.side(axis) - (0 if axis in scene.periodic else 2 * radius)) / 2

    m1, m2 = scene.masses
    inertia = scene.moment_of_inertia
    return Prism(
        half_1=tuple(half(axis, scene.radii[0]) for axis in "xyz"),
        half_2=tuple(half(axis, scene.radii[1]) for axis in "xyz"),
        period=tuple(scene.side(axis) if axis in scene.periodic else 0.0 for axis in "xyz"),
        conserved=tuple(axis in scene.conserved for axis in "xyz"),
        sigma=scene.contact_distance,
        inverse_roots=(1.0, 1 / math.sqrt(m2), math.sqrt(1 / m1 + 1 / m2)),
        shares=(m2 / (m1 + m2), m1 / (m1 + m2)),
        components=scene.velocity_components,
        weights=(2 * scene.field * m1, 2 * scene.field * m2) if scene.field else None,
        depth=None if scene.depth is None else True,
        inertia=None
        if inertia is None
        else (1 / math.sqrt(inertia * m1), 1 / math.sqrt(inertia * m2)),
    )


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
def kinetic_share(y1, y2, half1, half2, weights):
    """Return 1 − U/E, the share of the energy that is kinetic; negative where U exceeds E = 1/2."""
    return 1.0 - weights[0] * (y1 + half1) - weights[1] * (y2 + half2)


@compiled
def power_chance(state, share, power):
    """Say yes with the probability ``share`` to the ``power``/2, for 0 ≤ ``power``."""
    if share <= 0.0:
        return False
    chance = 1.0
    for _ in range(power):
        chance *= share
    draw = uniform(state)
    return draw * draw < chance


@optional(lambda state, prism, depth: (0.0, 0.0))
def propose_deep(state, prism, depth):
    """Return (z1, dz), in the plane twice 0."""
    z1 = prism.half_1[2] * signed_uniform(state)
    return z1, nearest(z1 - prism.half_2[2] * signed_uniform(state), prism.period[2])


@compiled
def propose_in_prism(state, prism):
    """Return (x1, y1, z1, dx, dy, dz): a place of disc 1 and the separation, drawn in the prism.

    Separations are to the nearest image on periodic axes. In the plane z1 and dz are 0.
    """
    x1, y1 = prism.half_1[0] * signed_uniform(state), prism.half_1[1] * signed_uniform(state)
    dx = x1 - prism.half_2[0] * signed_uniform(state)
    dy = y1 - prism.half_2[1] * signed_uniform(state)
    z1, dz = propose_deep(state, prism, prism.depth)
    return x1, y1, z1, nearest(dx, prism.period[0]), nearest(dy, prism.period[1]), dz


@compiled
def share_if_accepted(state, prism, y1, dx, dy, dz, power):
    """Return the kinetic share of the energy if a proposal is accepted, and −1 if it is not.

    Discs that do not overlap are accepted with the probability share^(``power``/2).
    """
    if dx * dx + dy * dy + dz * dz < prism.sigma * prism.sigma:
        return -1.0
    share = kinetic_share(y1, y1 - dy, prism.half_1[1], prism.half_2[1], prism.weights)
    if prism.weights is None or power_chance(state, share, power):
        return share
    return -1.0


@compiled
def draw_in_prism(state, prism):
    """Return (x1, y1, z1, dx, dy, dz, kinetic share) from the invariant measure."""
    while True:
        x1, y1, z1, dx, dy, dz = propose_in_prism(state, prism)
        share = share_if_accepted(state, prism, y1, dx, dy, dz, prism.components - 2)
        if share >= 0.0:
            return x1, y1, z1, dx, dy, dz, share


@compiled
def draw_on_surface(state, prism, axis):
    """Return the same on the surface of a hop along ``axis`` (0 for x, 1 for y).

    The density there is ∝ (E − U)^((D − 1)/2), as the flux through the surface is.
    """
    low = min(prism.half_1[axis], prism.half_2[axis])
    while True:
        x1, y1, z1, dx, dy, dz = propose_in_prism(state, prism)
        if axis == 0:
            x1, dx = low * signed_uniform(state), 0.0
        else:
            y1, dy = low * signed_uniform(state), 0.0
        share = share_if_accepted(state, prism, y1, dx, dy, dz, prism.components - 1)
        if share >= 0.0:
            return x1, y1, z1, dx, dy, dz, share


@compiled
def draw_direction(state, n, direction):
    """Fill ``direction`` with a unit vector, uniform in ``n`` ≤ 6 dimensions.

    Pairs of components have squares whose sums are the spacings of sorted uniform numbers, and
    directions of their own. In an odd dimension one component too many is left out.
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

    Scaled by roots of masses and moments of inertia, and along an axis with total momentum 0 of the
    reduced mass, the components that there are lie on a sphere of radius ``speed``. With a
    ``normal_axis`` (0 or 1; −1 for none) the relative velocity along it has the law of a flux
    through the surface of a hop instead: for a normal component n its density is ∝ |n| (1 −
    n²)^((D − 3)/2), so that √(1 − n²) is the largest of D − 1 uniform numbers.
    """
    n, rest, normal = prism.components, 1.0, 0.0
    if normal_axis >= 0:
        n -= 1
        rest = largest_of(state, n)
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
            relative = speed * rest * direction[used] * root
            velocity[axis] = relative * prism.shares[0]
            velocity[axis + 4] = -relative * prism.shares[1]
            used += 1
        elif axis == normal_axis:
            # Unit vectors of the relative motion and of the centre of mass, in scaled velocities.
            along_1, along_2 = math.sqrt(prism.shares[0]), math.sqrt(prism.shares[1])
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
    """Fill in the spins of rough discs from the components of ``direction`` that are not used."""
    velocity[3] = speed * direction[used] * inertia[0]
    velocity[7] = speed * direction[used + 1] * inertia[1]


def _anywhere(state, prism, direction, velocity, surface):
    place = draw_in_prism(state, prism)
    draw_velocities(state, prism, math.sqrt(place[6]), -1, direction, velocity)
    return place


@optional(_anywhere)
def draw_state(state, prism, direction, velocity, surface):
    """Return a place as ``draw_in_prism`` does, or one on a ``surface``, and fill ``velocity``."""
    place = draw_on_surface(state, prism, surface)
    draw_velocities(state, prism, math.sqrt(place[6]), surface, direction, velocity)
    return place


@optional(lambda starts, i, k, a, b, present: None)
def set_pair(starts, i, k, a, b, present):
    """Set the entries ``k`` and ``k`` + 1 of column ``i``, unless they are absent."""
    starts[k, i], starts[k + 1, i] = a, b


@compiled
def fill_start(state, prism, surface, starts, i):
    """Write a state of the invariant measure to column ``i`` of ``starts``.

    With a ``surface`` (0 for x1 = x2, 1 for y1 = y2; None for anywhere) it is one of the measure on
    that surface, weighted by the flux through it.
    """
    direction, velocity = np.empty(6), np.empty(8)
    x1, y1, z1, dx, dy, dz, _ = draw_state(state, prism, direction, velocity, surface)
    starts[0, i], starts[1, i], starts[2, i], starts[3, i] = x1, y1, x1 - dx, y1 - dy
    starts[4, i], starts[5, i] = velocity[0], velocity[1]
    starts[6, i], starts[7, i] = velocity[4], velocity[5]
    set_pair(starts, i, 8, z1, z1 - dz, prism.depth)
    set_pair(starts, i, 10, velocity[2], velocity[6], prism.depth)
    set_pair(starts, i, 8, velocity[3], velocity[7], prism.inertia)
