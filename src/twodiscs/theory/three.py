"""Three discs in any box, exact by quadrature between the kinks of the integrand, or on a torus.

With centres x1 < x2 < x3 the discs i and j are at least d_ij = √(σ² − (y_i − y_j)²)₊ apart along x.
For given heights the x fill a volume g(s) = (A − s)₊³/6, s = d12 + d23, if d13 ≤ s, and otherwise

    h(s, d13) = ∫ (A − t)(t − s) dt from d13 to A = (A − s) m²/2 − m³/3,  m = (A − d13)₊

The integrand depends only on the gaps between the sorted heights: a larger one P, a smaller one Q
and their sum t, with weight B − t. With p, q, c = d(P), d(Q), d(t)

    V = 24 ∫_0^B dt (B − t) ∫_{t/2}^t dP [g(p + q) + g(q + c) + h(p + c, q)]

In it h is g unless q > p + c. The derivatives by A, B and σ are taken under the integral, and all
their terms are positive; ``flux.rates`` makes rates of them. For pairs with the same x, at least σ
apart in y,

    Σ ∫ δ(x_i − x_j) = 12 ∫_0^B dt (B − t) ∫_{t/2}^t dP
                       [A² 1(Q ≥ σ) + (A − q)₊² (1(P ≥ σ) + 1(t ≥ σ))]

The integrands are smooth except at kinks: P, Q or t is σ; p + q, p + c, q + c or q is A; and
q = p + c, at which the discs form an equilateral triangle. Closed forms give all of these P, and
the t at which two of them meet. Between them the variables are angles: P, Q and t below σ are σ
times a sine, so that the roots d are smooth too. Relative errors are some 1e-14, times
r/(r_max − r) if the discs hardly fit.

On a torus of the area S = w h, each pair overlaps at one image at most, because σ ≤ w/2 and
σ ≤ h/2. With β = πσ²/S, Mayer's sum over pairs, chains of two pairs and triangles ends with

    V/S³ = 1 − 3β + 3β² − T/S²,    T = Σ_W ∫∫ 1(|a| < σ) 1(|b| < σ) 1(|W − a − b| < σ) da db

over the vectors W of the lattice of images: the three separations of a triangle add up to W. For
W = 0 the integral is (π² − 3√3π/4) σ⁴. It is the whole T if σ ≤ w/3 and σ ≤ h/3, because no
triangle winds around the torus; otherwise W shorter than 3σ count as well. With the overlap L(t) of
two circles of radius σ at a distance t, their integral and its derivative by σ are

    ∫ L(t) 2 acos((t² + W² − σ²)/(2tW)) t dt from W − σ to 2σ,    6σ ∫ L(|W − σe(θ)|) dθ from 0 to π
"""

import math
from itertools import pairwise, product

import numpy as np

from twodiscs.theory.flux import Derivatives
from twodiscs.theory.quadrature import as_arrays, gauss_legendre

#: Nodes between two kinks, for the sum of the gaps and for the larger gap.
OUTER_NODES, INNER_NODES = 48, 32


def _root(square):
    return math.sqrt(square) if square > 0 else 0.0


def _ends(a, b, sigma):
    """Return the ascending sums of gaps at which two kinks in P meet, including 0 and B."""
    level = _root(sigma**2 - a * a)  # the gap with q = A
    values = [
        sigma, 2 * sigma, math.sqrt(0.75) * sigma,
        _root(4 * sigma**2 - a * a),  # p + q reaches A at P = Q
        _root(sigma**2 - (a - sigma) ** 2),  # … and at Q = 0, like q + c
        _root(sigma**2 - a * a / 4),  # p + c at Q = 0
        2 * level, sigma + level,
    ]  # fmt: skip
    if a < sigma:
        # p + c = q = A.
        values.append(sigma * math.sin(math.acos(a / sigma) + math.pi / 3))
    return [0.0, *sorted({end for end in values if 0.0 < end < b}), b]


def _sums(a, b, sigma):
    """Return (t, weight, c) of the nodes of the outer integral."""
    x, w = as_arrays(gauss_legendre(OUTER_NODES))
    # Powers of a half at the ends are smooth in the angle of a sine squared.
    fraction, slope = np.sin(math.pi / 2 * x) ** 2, math.pi / 2 * np.sin(math.pi * x)
    t, weight, c = [], [], []
    ends = _ends(a, b, sigma)
    for low, high in pairwise(ends):
        if high <= sigma:
            start = math.asin(low / sigma)
            width = math.asin(high / sigma) - start
            angle = start + width * fraction
            t.append(sigma * np.sin(angle))
            c.append(sigma * np.cos(angle))
            weight.append(width * slope * w * c[-1])
        else:
            t.append(low + (high - low) * fraction)
            c.append(np.zeros(OUTER_NODES))
            weight.append((high - low) * slope * w)
    return np.concatenate(t), np.concatenate(weight), np.concatenate(c)


def _kinks(a, sigma, t, c):
    """Return gaps (P, Q), each (n, t), of the kinks of the integrand and of both ends.

    P ascends. Both gaps are kept, because the difference of t and the other gap has a rounding that
    matters in the root if Q is exactly σ.
    """
    level = _root(sigma**2 - a * a)
    with np.errstate(invalid="ignore"):
        apart = np.arccos(np.hypot(t, a) / (2 * sigma))
        beside = np.sqrt(sigma**2 - (a - c) ** 2)
        by_p = [
            t,
            np.full_like(t, sigma),
            sigma * np.sin(np.arctan2(t, a) + apart),
            beside,
            sigma * np.sin(2 * math.pi / 3 - np.arcsin(t / sigma)),
        ]
        by_q = [np.full_like(t, sigma), np.full_like(t, level), beside]
    p = np.array(by_p + [t - q for q in by_q])
    q = np.array([t - p for p in by_p] + by_q)
    # A kink that is not in the range, or is none, is replaced by an end of it.
    p, q = np.fmax(np.fmin(p, t), t / 2), np.fmin(np.fmax(q, 0.0), t / 2)
    order = np.argsort(p, axis=0)
    return np.take_along_axis(p, order, 0), np.take_along_axis(q, order, 0)


def _gaps(a, sigma, t, c):
    """Return (p, q, weight, P < σ, Q < σ) at the inner nodes, arrays (panels, nodes, t)."""
    x, w = (part[:, None] for part in as_arrays(gauss_legendre(INNER_NODES)))
    larger, smaller = _kinks(a, sigma, t, c)
    low, high = larger[:-1, None, :], larger[1:, None, :]
    most, least = smaller[:-1, None, :], smaller[1:, None, :]
    near_p, near_q = low + high < 2 * sigma, most + least < 2 * sigma

    def sines(start, stop):
        """Return (gap, d(gap), weight) between two gaps, σ times the sines of their angles."""
        start, stop = (np.arcsin(np.minimum(gap / sigma, 1.0)) for gap in (start, stop))
        angle = start + (stop - start) * x
        d = sigma * np.cos(angle)
        return sigma * np.sin(angle), d, (stop - start) * d * w

    # The larger gap is a sine, or above σ; then the smaller one is also a sine, or above σ.
    gap, p, weight_p = sines(low, high)
    rest = t - gap
    q_of_p = np.sqrt(np.maximum((sigma - rest) * (sigma + rest), 0.0))
    _, q, weight_q = sines(least, most)
    q = np.where(near_p, q_of_p, np.where(near_q, q, 0.0))
    weight = np.where(near_p, weight_p, np.where(near_q, weight_q, (high - low) * w))
    return np.where(near_p, p, 0.0), q, weight, near_p, near_q


def torus_derivatives(scene):
    """Return the ``Derivatives`` of a ``Scene`` of three discs on a torus, without hops."""
    area, sigma = scene.width * scene.height, scene.contact_distance
    overlap, total, slope = math.pi * sigma**2 / area, 0.0, 0.0
    for i, j in product(range(-2, 3), repeat=2):
        part, part_slope = _triangles(math.hypot(i * scene.width, j * scene.height), sigma)
        total, slope = total + part, slope + part_slope
    volume = 1 - 3 * overlap + 3 * overlap**2 - total / area**2
    loss = (6 * overlap - 12 * overlap**2) / sigma + slope / area**2
    return Derivatives(3 * math.log(area) + math.log(volume), 0.0, 0.0, loss / volume)


def _triangles(winding, sigma):
    """Return the integral for |W| = ``winding`` and its derivative by σ."""
    if winding == 0:
        plane = math.pi**2 - math.sqrt(27) * math.pi / 4
        return plane * sigma**4, 4 * plane * sigma**3
    if winding >= 3 * sigma:
        return 0.0, 0.0
    x, w = as_arrays(gauss_legendre(OUTER_NODES))

    def lens(t):
        half = np.minimum(t / (2 * sigma), 1.0)
        return 2 * sigma**2 * (np.arccos(half) - half * np.sqrt(1 - half * half))

    # Powers of a half at the ends are smooth in the angle of a sine squared, or of a sine.
    t = winding - sigma + (3 * sigma - winding) * np.sin(math.pi / 2 * x) ** 2
    weight = (3 * sigma - winding) * math.pi / 2 * np.sin(math.pi * x) * w
    inside = np.minimum((t * t + winding**2 - sigma**2) / (2 * t * winding), 1.0)
    end = math.acos((winding**2 - 3 * sigma**2) / (2 * winding * sigma))
    angle = end * np.sin(math.pi / 2 * x)
    arc = end * math.pi / 2 * np.cos(math.pi / 2 * x) * w
    far = np.sqrt(winding**2 + sigma**2 - 2 * winding * sigma * np.cos(angle))
    return (
        float(weight @ (lens(t) * 2 * np.arccos(inside) * t)),
        float(6 * sigma * arc @ lens(far)),
    )


def derivatives(scene):
    """Return the ``Derivatives`` of a ``Scene`` of three discs between walls, with both hops."""
    volume, *parts = integrals(scene.range_x, scene.range_y, scene.contact_distance)
    # The other hops are those of the box turned by a quarter.
    parts.append(integrals(scene.range_y, scene.range_x, scene.contact_distance)[4])
    return Derivatives(math.log(volume), *(part / volume for part in parts))


def integrals(a, b, sigma):
    """Return (V, ∂V/∂A, ∂V/∂B, −∂V/∂σ, Σ ∫ δ(x_i − x_j)) for ranges ``a`` and ``b`` of the centres.

    They touch at the distance ``sigma``. V is in length⁶, the others in length⁵.
    """
    t, outer, c = _sums(a, b, sigma)
    p, q, inner, near_p, near_q = _gaps(a, sigma, t, c)

    def free(occupied):
        return np.maximum(a - occupied, 0.0)

    both, beside, across = free(p + q), free(q + c), free(p + c)
    most = free(q)
    bent = q > p + c
    volume = both**3 / 6 + beside**3 / 6
    volume += np.where(bent, across * most**2 / 2 - most**3 / 3, across**3 / 6)
    slope = both**2 / 2 + beside**2 / 2
    across_slope = np.where(bent, most**2 / 2, across**2 / 2)
    far_slope = np.where(bent, across * most - most**2, 0.0)
    slope += across_slope + far_slope

    with np.errstate(divide="ignore"):
        over_p = np.where(p > 0, sigma / p, 0.0)
        over_q = np.where(q > 0, sigma / q, 0.0)
        over_c = np.where(c > 0, sigma / c, 0.0)
    contact = both**2 / 2 * (over_p + over_q) + beside**2 / 2 * (over_q + over_c)
    contact += across_slope * (over_p + over_c) + far_slope * over_q

    beyond_p, beyond_q, beyond_t = ~near_p, ~near_q, c == 0
    level = a * a * beyond_q + most**2 * (1.0 * beyond_p + beyond_t)

    def integrate_gaps(integrand):
        return np.sum(inner * integrand, axis=(0, 1))

    volume_at = integrate_gaps(volume)
    weight = outer * (b - t)
    return (
        24 * float(weight @ volume_at),
        24 * float(weight @ integrate_gaps(slope)),
        24 * float(outer @ volume_at),
        24 * float(weight @ integrate_gaps(contact)),
        12 * float(weight @ integrate_gaps(level)),
    )
