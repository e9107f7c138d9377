"""Draws of plain scenes from the invariant measure: configurations, velocities, hop crossings.

For large radii, rejection from the whole prism accepts almost nothing. Here the separations
u = |x1 − x2| and v = |y1 − y2| are drawn instead. Their density is (A − u)(B − v) outside the
circle u² + v² = σ². Integrated over v it is g(u) = (A − u)(B − k)₊²/2 with k = √(σ² − u²)₊:

* for u ≥ σ, g is a triangle and is drawn directly;
* for u < σ, B − k has a bound that is a sum of positive powers of s = u − u₀ (u₀ = √(σ² − B²)₊):
  (B − σ) + s²/σ for B ≥ σ, and s (2u₀ + s)/(B + k₁) for B < σ, with k₁ the smallest k. Each is at
  most twice B − k, so at least a quarter of the proposals is accepted at any radius.

The powers are drawn as order statistics of uniform numbers, so the arithmetic is + − × / and √
only.
"""

import math
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from twodiscs.sampling.jit import compiled, inlined
from twodiscs.sampling.streams import draw_largest, next_bits, signed_uniform, uniform


class ConditionedSampler(NamedTuple):
    """The constants of a scene for draws of separations: lengths, and weights without unit."""

    half_x: float  # a
    half_y: float  # b
    range_y: float  # B
    sigma: float  # σ
    arch: float  # a lower bound of σ + k
    start: float  # u₀, at which the arc enters the rectangle
    stop: float  # u₁ = min(σ, A), at which it leaves, or at which the strip ends
    span: float  # u₁ − u₀
    beyond_x: float  # A − u₁
    beyond_y: float  # (B − σ)₊
    least_k: float  # k₁ = √(σ² − u₁²)
    weights: tuple  # cumulative probabilities of the seven parts of the proposal
    mass: float  # integral of the proposal; the acceptance is V/2 over it


def conditioned_sampler(scene, within=None):
    """Return the ``ConditionedSampler`` of a ``Scene``; with u < ``within`` < σ, if that is given.

    Such a strip needs an open horizontal hop: σ < B. Differences of lengths that cancel near a
    threshold or near the largest radius are computed from exact fractions and rounded once.
    """
    w, h, r = Fraction(scene.width), Fraction(scene.height), Fraction(scene.radius)
    range_x, range_y, sigma = float(w - 2 * r), float(h - 2 * r), float(2 * r)
    beyond_x, beyond_y = max(float(w - 4 * r), 0.0), max(float(h - 4 * r), 0.0)
    start = math.sqrt(max(float(h * (4 * r - h)), 0.0))
    least_k = math.sqrt(max(float(w * (4 * r - w)), 0.0))
    stop, arch, whole = min(sigma, range_x), sigma, 1
    if within is not None:
        stop, whole, beyond_x = within, 0, float(w - 2 * r - Fraction(within))
        least_k = math.sqrt(float((2 * r) ** 2 - Fraction(within) ** 2))
        arch += least_k
    if beyond_y > 0:
        span = stop
    elif beyond_x > 0:
        span = range_y * range_y / (sigma + start)
    else:
        room = (w - 2 * r) ** 2 + (h - 2 * r) ** 2 - (2 * r) ** 2
        span = float(room) / (range_x + start)

    # The bound of (B − k)² as Σ c_j s^j, times A − u = (A − σ)₊ + (span − s). Powers are products,
    # because the last digit of ``**`` depends on the math library, and that of ``sum`` on Python.
    if beyond_y > 0:
        powers = {0: beyond_y * beyond_y, 2: 2 * beyond_y / arch, 4: 1 / (arch * arch)}
    else:
        scale = 1 / ((range_y + least_k) * (range_y + least_k))
        powers = {2: 4 * start * start * scale, 3: 4 * start * scale, 4: scale}
    parts = [whole * beyond_x * beyond_x / 2 * range_y * range_y]
    for j, c in powers.items():
        parts.append(c * beyond_x * math.prod([span] * (j + 1)) / (j + 1))
        parts.append(c * math.prod([span] * (j + 2)) / ((j + 1) * (j + 2)))
    total = math.fsum(parts)
    cumulative = tuple(math.fsum(parts[: i + 1]) / total for i in range(len(parts)))
    return ConditionedSampler(
        range_x / 2, range_y / 2, range_y, sigma, arch, start, stop, span, beyond_x, beyond_y,
        least_k, cumulative, total,
    )  # fmt: skip


@inlined
def draw_second_largest(state, n):
    """Return the second largest of ``n`` ≥ 2 uniform numbers: density ∝ sⁿ⁻² (1 − s) on [0, 1)."""
    largest, second = uniform(state), 0.0
    for _ in range(n - 1):
        value = uniform(state)
        second = max(second, min(value, largest))
        largest = max(value, largest)
    return second


@inlined
def propose_separation(state, sampler):
    """Propose separations u, v; return (accepted, A − u, B − v, u, u² + v² − σ²).

    The distances from the far corner, A − u and B − v, keep their relative accuracy if the discs
    hardly fit. The last value keeps it near contact. A proposal is accepted with probability V/2
    over ``sampler.mass``; accepted proposals have the law of the invariant measure.
    """
    choice = uniform(state)
    if choice < sampler.weights[0]:
        corner_x = sampler.beyond_x * math.sqrt(uniform(state))
        beyond = sampler.beyond_x - corner_x
        u = sampler.sigma + beyond
        corner_y = sampler.range_y * math.sqrt(uniform(state))
        v = sampler.range_y - corner_y
        return True, corner_x, corner_y, u, beyond * (u + sampler.sigma) + v * v
    part = 1
    while part < 6 and choice >= sampler.weights[part]:
        part += 1
    pair = (part - 1) // 2
    power = 2 * pair if sampler.beyond_y > 0.0 else 2 + pair
    if part % 2 == 1:
        s = sampler.span * draw_largest(state, power + 1)
    else:
        s = sampler.span * draw_second_largest(state, power + 2)
    u = sampler.start + s
    z = sampler.span - s
    k = math.sqrt(sampler.least_k * sampler.least_k + z * (2.0 * sampler.stop - z))
    if sampler.beyond_y > 0.0:
        room = sampler.beyond_y + u * u / (sampler.sigma + k)
        bound = sampler.beyond_y + u * u / sampler.arch
    else:
        room = s * (2.0 * sampler.start + s) / (sampler.range_y + k)
        bound = s * (2.0 * sampler.start + s) / (sampler.range_y + sampler.least_k)
    if uniform(state) * (bound * bound) >= room * room:
        return False, 0.0, 0.0, 0.0, 0.0
    corner_y = room * math.sqrt(uniform(state))
    # v = k + room − corner_y.
    return True, sampler.beyond_x + z, corner_y, u, (room - corner_y) * (2.0 * k + room - corner_y)


@compiled
def draw_separation(state, sampler):
    """Return (A − u, B − v, u) for separations u, v of the invariant measure."""
    while True:
        accepted, corner_x, corner_y, u, _ = propose_separation(state, sampler)
        if accepted:
            return corner_x, corner_y, u


@compiled
def pair_at_distance(state, half, missing, order):
    """Return coordinates (q1, q2) on [−half, half] whose distance is 2 half − ``missing``.

    ``order`` ≥ 0 puts disc 1 above disc 2, otherwise below.
    """
    fraction = uniform(state)
    low = missing * fraction - half
    high = half - missing * (1.0 - fraction)
    if order >= 0:
        return high, low
    return low, high


@compiled
def draw_configuration(state, sampler):
    """Return centres (x1, y1, x2, y2), uniform over the allowed configurations.

    If hops are blocked, the ergodic components have the same probability.
    """
    corner_x, corner_y, _ = draw_separation(state, sampler)
    bits = next_bits(state)
    order_x = 1 if bits & np.uint64(1 << 62) else -1
    order_y = 1 if bits & np.uint64(1 << 61) else -1
    x1, x2 = pair_at_distance(state, sampler.half_x, corner_x, order_x)
    y1, y2 = pair_at_distance(state, sampler.half_y, corner_y, order_y)
    return x1, y1, x2, y2


@compiled
def draw_in_disc(state):
    """Return (p, q, p² + q²), with (p, q) uniform in the unit disc without its centre."""
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

    Positions are uniform on the surface: A − |x1 − x2| is (A − σ)√U with a uniform number U. The
    component of the velocity along the surface's normal, n = (v1 − v2)/√2, has density
    ∝ |n| √(1 − n²), so 1 − n² is the square of the largest of three uniform numbers.
    """
    corner_x = beyond_x * math.sqrt(uniform(state))
    bits = next_bits(state)
    x1, x2 = pair_at_distance(state, half_x, corner_x, 1 if bits & np.uint64(1 << 62) else -1)
    y = half_y * signed_uniform(state)
    rest = draw_largest(state, 3)
    normal = math.sqrt((1.0 - rest) * (1.0 + rest))
    if bits & np.uint64(1 << 61):
        normal = -normal
    # Uniform on the sphere of radius ``rest`` in the other three components (Marsaglia).
    p, q, square = draw_in_disc(state)
    scale = 2.0 * rest * math.sqrt(1.0 - square)
    u1, u2, common = p * scale, q * scale, rest * (1.0 - 2.0 * square)
    half = math.sqrt(0.5)
    return x1, y, x2, y, u1, (common + normal) * half, u2, (common - normal) * half
