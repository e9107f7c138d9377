"""Any number of discs that keep their order in a channel, exact by a transfer operator.

For h ≤ (2 + √3) r only neighbours touch. They keep d(y, y') = √(σ² − (y − y')²) apart along x, so

    V = ∫_[0,B]^N dy (A − S)₊^N,  S = Σ d(y_i, y_{i+1})

Its Laplace transform with respect to A is N! p^(−N−1) Z(p), with Z(p) = ⟨1|T^(N−1)|1⟩ of the
transfer operator T(y, y') = exp(−p d(y, y')). Derivatives of V are such integrals, with one of the
T replaced by T σ/d (by σ) or by T (y − y')²/(B d) (by B): all their terms are positive. For a hop
in y of neighbours it is T δ(y − y'), for other pairs the diagonal of a power of T.

Conditioning. The least d is d₀ = √(σ² − B²) ≥ r, between discs on opposite walls: d is smooth
everywhere (B < σ), and only the room A − (N − 1) d₀ and d − d₀ = (B² − (y − y')²)/(d + d₀) count.
Both are formed without cancellation, with y measured from the nearer wall. Nodes are Gauss nodes on
panels that are narrow at both walls, to which discs that hardly fit are confined.

The inverse is taken by the trapezoidal rule along the vertical line through the saddle of
e^{pA} p^(−N−1) Z(p), on which terms do not cancel. A contour that bends to the left, such as
Talbot's, would be wrong: Z grows there like exp(|p| (N − 1) σ), faster than e^{pA} falls unless the
channel is longer than the discs in a row. Along the line terms fall at least like a power of p,
which is higher for more discs. The number of terms is largest if A is near a length at which S is
stationary, such as (N − 1) σ.
"""

import math
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from twodiscs.model.checks import InputError
from twodiscs.theory.flux import Derivatives
from twodiscs.theory.quadrature import as_arrays, gauss_legendre

#: Nodes of a panel, the phase that they resolve, and the most panels that double.
NODES_PER_PANEL, PANEL_PHASE, MOST_PANELS = 20, 15.0, 60

#: Relative sizes of neglected parts: periodic images of the function, which come from the step of
#: the trapezoidal rule, and the terms after the last.
ALIAS_ERROR, TAIL_ERROR = 1e-14, 1e-11

#: The number of vectors in the first trial for the range of the kernel, and its relative error.
FIRST_RANK, RANK_ERROR = 16, 2e-15

#: If two powers of the kernel differ less in shape, the next ones are taken as a geometric series.
RATIO_ERROR = 4e-15

#: The terms of an inverse in the first trial, and at most.
FIRST_TERMS, MOST_TERMS = 24, 6000


class Channel(NamedTuple):
    """The constants of the transfer operator: lengths, nodes across half of the channel, and pairs.

    The arrays (2, m, m) have the pairs of nodes on the same side of the middle, then those on
    opposite sides.
    """

    discs: int
    sigma: float
    height: float  # B
    least: float  # d₀
    room: float  # A − (N − 1) d₀
    weights: np.ndarray  # (m,)
    apart: np.ndarray  # d − d₀
    distance: np.ndarray  # d
    separation: np.ndarray  # |y − y'|


def graded_nodes(height, finest, widest, farthest):
    """Return (distances from the nearer wall, weights) on panels that double from the wall on.

    The first one is about ``finest``, none is wider than ``widest``, and none begins beyond
    ``farthest``.
    """
    x, w = as_arrays(gauss_legendre(NODES_PER_PANEL))
    ends = [height / 2]
    while ends[-1] > finest and len(ends) < MOST_PANELS:
        ends.append(ends[-1] / 2)
    split = [0.0]
    for end in reversed(ends):
        start = split[-1]
        if start >= farthest:
            break
        pieces = max(1, math.ceil((end - start) / widest))
        split += [start + (end - start) * (k + 1) / pieces for k in range(pieces)]
    low, high = np.array(split[:-1])[:, None], np.array(split[1:])[:, None]
    return (low + (high - low) * x).ravel(), ((high - low) * w).ravel()


def node_pairs(height, sigma, y):
    """Return (d − d₀, d, |y − y'|, d₀) of pairs of ``y`` on the same side and on opposite ones."""
    both, same = y[:, None] + y, np.abs(y[:, None] - y)
    short = np.array([height - same, both])  # B − |y − y'|
    separation = np.array([same, height - both])
    distance = np.sqrt((sigma - separation) * (sigma + separation))
    least = math.sqrt((sigma - height) * (sigma + height))
    return short * (height + separation) / (distance + least), distance, separation, least


def _room(scene):
    """Return A − (N − 1) d₀, from an exact difference of squares."""
    a, n = scene.reach("x"), scene.discs - 1
    h, r = Fraction(scene.height), Fraction(scene.radius)
    square = h * (4 * r - h)
    return float(a * a - n * n * square) / (float(a) + n * math.sqrt(square))


def make_channel(scene, force=None, reach=None):
    """Return the ``Channel`` of a ``Scene``, for transforms at a real part ``force`` of p.

    Its nodes resolve exp(−p (d − d₀)) up to |p| = ``reach``, unless it is negligible.
    """
    room = _room(scene)
    # At the saddle p is between N/room and (2N + 1)/room.
    force = force or scene.discs / room
    panels = panel_sizes(scene.range_y, scene.contact_distance, force, reach or 2 * force)
    y, weights = graded_nodes(*panels)
    apart, distance, separation, least = node_pairs(scene.range_y, scene.contact_distance, y)
    return Channel(
        scene.discs, scene.contact_distance, scene.range_y, least, room, weights, apart, distance,
        separation,
    )  # fmt: skip


def panel_sizes(height, sigma, force, reach):
    """Return the arguments of ``graded_nodes`` for Re p = ``force``, up to |p| = ``reach``."""
    least = math.sqrt((sigma - height) * (sigma + height))
    # At a distance ℓ from a corner d − d₀ is at most ℓ B/d₀. A disc ``far`` from both walls has no
    # neighbour this close.
    steepest, far = height / least, least + 40 / force  # exp(−40) is negligible
    return (
        height,
        1 / (2 * force * steepest),
        PANEL_PHASE / (reach * steepest),
        height - math.sqrt((sigma - far) * (sigma + far)) if far < sigma else height,
    )


# Laplace transforms ------------------------------------------------------------------------------


def _folded(channel, kinds):
    """Return the operator of a kernel (2, m, m) on functions that are even about the middle.

    Each node has a factor √weight, so that the operator is symmetric.
    """
    root = np.sqrt(channel.weights)
    return root[:, None] * (kinds[0] + kinds[1]) * root


def _vectors(channel, p):
    """Return (kernels T, T^k 1 for k = 0 … N − 1, ln of the factors that scale these vectors).

    Each T is without its factor exp(−p d₀).
    """
    kinds = np.exp(-p * channel.apart)
    kernel = _folded(channel, kinds)
    vectors, logs = [np.sqrt(channel.weights) + 0 * p], [0.0]
    for _ in range(channel.discs - 1):
        new = kernel @ vectors[-1]
        # Powers of many discs would underflow.
        size = np.max(np.abs(new))
        vectors.append(new / size)
        logs.append(logs[-1] + math.log(size))
    return kinds, np.array(vectors), np.array(logs)


def _log_partition(channel, p):
    """Return ln Z at a real ``p``, without (N − 1) p d₀."""
    _, vectors, logs = _vectors(channel, p)
    return math.log(2 * float(vectors[0] @ vectors[-1])) + logs[-1]


def saddle(channel):
    """Return (p, φ(p)) at the minimum of φ = p room − (N + 1) ln p + ln Z on the real axis."""

    def phi(log_p):
        p = math.exp(log_p)
        return p * channel.room - (channel.discs + 1) * log_p + _log_partition(channel, p)

    # The product of p and room is N + 1 for an ideal gas, 2N + 1 for discs that hardly fit.
    low = math.log((channel.discs + 1) / channel.room) - 0.1
    high = math.log((2 * channel.discs + 1) / channel.room) + 0.5
    golden = (math.sqrt(5) - 1) / 2
    for _ in range(24):
        left, right = high - golden * (high - low), low + golden * (high - low)
        low, high = (low, right) if phi(left) < phi(right) else (left, high)
    middle = (low + high) / 2
    return math.exp(middle), phi(middle)


def _inverses(channel, p, hops):
    """Return (ln |scale|, values of the transforms at ``p``): V, ∂A, ∂B, −∂σ, hops in y.

    They are without the factors exp(p room) and N!.
    """
    kinds, vectors, logs = _vectors(channel, p)
    n, scale = channel.discs, logs[-1] - (channel.discs + 1) * math.log(abs(p))
    total = 2 * (vectors[0] @ vectors[-1])
    # Bond k is between T^(k−1) 1 and T^(N−1−k) 1; each has its own scale.
    left, right = vectors[: n - 1], vectors[: n - 1][::-1]
    factors = 2 * np.exp(logs[: n - 1] + logs[: n - 1][::-1] - logs[-1])

    def bonds(weight):
        operator = _folded(channel, kinds * weight)
        return np.sum(factors * np.einsum("ki,ki->k", left @ operator, right))

    contact = bonds(channel.sigma / channel.distance)
    height = bonds(channel.separation**2 / (channel.height * channel.distance))
    level = _levels(channel, kinds, vectors, logs) if hops else 0.0
    power = (abs(p) / p) ** (n + 1)
    per_height = n / channel.height * power * total + power * p * height
    values = (power * total, power * p * total, per_height, power * p * contact, power * level)
    return scale, np.array(values)


def _factors(kernel):
    """Return (Q, R) with ``kernel`` = Q R to rounding, of the smallest inner dimension.

    The kernel is smooth, so that its rank is some tens for a thousand nodes. Its range is found
    from its products with random vectors, always the same ones (Halko, Martinsson and Tropp, SIAM
    Rev. 53, 217 (2011)). Half of the vectors test whether the other half is enough.
    """
    nodes, rank = len(kernel), FIRST_RANK
    while 2 * rank < nodes:
        probes = np.random.default_rng(0).standard_normal((nodes, 2 * rank))
        image = kernel @ probes
        basis = np.linalg.qr(image[:, :rank])[0]
        rest = image[:, rank:] - basis @ (basis.conj().T @ image[:, rank:])
        if np.max(np.abs(rest)) <= RANK_ERROR * np.max(np.abs(image)):
            return basis, basis.conj().T @ kernel
        rank *= 2
    return np.eye(nodes), kernel


def _levels(channel, kinds, vectors, logs):
    """Return Σ over i < j of ∫ T^(i−1)1 T^(j−i)(y, y) T^(N−j)1 dy.

    With T = Q R the diagonal of T^k is the diagonal of Q (R Q)^(k−1) R, in which R Q is small.
    """
    n, total = channel.discs, 0.0
    for sign in (1, -1):
        # Functions that are even and odd about the middle have half of the diagonal each.
        kernel = _folded(channel, kinds * np.array([1, sign])[:, None, None])
        columns, rows = _factors(kernel)
        small, log, size = rows @ columns, 0.0, 1.0
        diagonal = np.diag(kernel) / channel.weights
        for k in range(1, n):
            if k > 1:
                last = diagonal
                diagonal = np.einsum("ia,ai->i", columns, rows) / channel.weights
                ratio = np.vdot(last, diagonal) / np.vdot(last, last)
                change = np.max(np.abs(diagonal - ratio * last))
                if change <= RATIO_ERROR * np.max(np.abs(diagonal)):
                    total += _geometric(vectors, logs, ratio * size, k, log) @ diagonal
                    break
            scales = logs[: n - k] + logs[n - 1 - k :: -1] + log - logs[-1]
            total += np.exp(scales) @ ((vectors[: n - k] * vectors[n - 1 - k :: -1]) @ diagonal)
            # Powers of many discs would underflow.
            columns = columns @ small
            size = np.max(np.abs(columns))
            columns, log = columns / size, log + math.log(size)
    return total


def _geometric(vectors, logs, growth, k, log):
    """Return Σ over i + j ≤ n − 1 − k of T^i 1 T^j 1 ``growth``^(n − 1 − k − i − j), at each node.

    ``log`` is that of the factor of the first term, and the sum is divided by T^(n−1) 1.
    """
    last, partial, sums = len(vectors) - 1 - k, 0.0, 0.0
    for i in range(last + 1):
        # The sum over the first ones, in units of T^i 1.
        shrunk = np.exp(logs[i - 1] - logs[i]) if i else 0.0
        partial = vectors[i] + growth * shrunk * partial
        sums += np.exp(logs[i] + logs[last - i] + log - logs[-1]) * partial * vectors[last - i]
    return sums


def derivatives(scene, hops=True):
    """Return the ``Derivatives`` of a ``Scene`` in an ordered channel.

    Hops in x are impossible. Hops in y, of any pair, take about as long as all the rest; with
    ``hops`` False they are None. Relative errors are less than 1e-12 in a channel longer than the
    discs in a row, and some 1e-11 (``TAIL_ERROR``) in others. If the discs hardly fit, errors are
    roundings over the free length. Two or three discs in a short channel have many terms; other
    modules have methods for them.
    """
    channel = make_channel(scene)
    p, phi = saddle(channel)
    step = _step(channel, p, phi)
    terms, first, reach, check, last = [], None, 2 * p, FIRST_TERMS, None
    channel = make_channel(scene, p, reach)
    while True:
        z = complex(p, len(terms) * step)
        if abs(z) > reach:
            # Nodes that resolve the phase p (d − d₀) up to the next doubling.
            reach = 2 * abs(z)
            channel = make_channel(scene, p, reach)
        scale, values = _inverses(channel, z, hops)
        first = scale if first is None else first
        terms.append((values * np.exp((z - p) * channel.room + scale - first)).real)
        if len(terms) < check:
            continue
        sums = _windowed(np.array(terms))
        change = np.inf if last is None else np.max(np.abs(sums - last)[:4] / np.abs(sums)[:4])
        if change < TAIL_ERROR:
            break
        if len(terms) >= MOST_TERMS:
            raise InputError(
                f"the inverse Laplace transform for {scene.discs} discs needs more than "
                f"{MOST_TERMS} terms"
            )
        last, check = sums, math.ceil(1.25 * check)
    sums = sums * step / math.pi
    log_volume = math.lgamma(scene.discs + 1) + math.log(sums[0]) + first + p * channel.room
    ratios = sums[1:] / sums[0]
    return Derivatives(
        log_volume,
        *map(float, ratios[:3]),
        horizontal_hops=0.0,
        vertical_hops=float(ratios[3]) if hops else None,
    )


def _windowed(terms):
    """Return the sums of ``terms`` (n, …) with a window; the first term is halved.

    The terms oscillate as exp(i ω (A − S)) for each S that is stationary or at an end of its range.
    A window with a smooth end makes the missing terms negligible, unless A is such an S.
    """
    n = len(terms)
    window = [math.erfc(10 * (k / n - 0.6)) / 2 for k in range(n)]
    window[0] /= 2
    return np.array(window) @ terms


def _step(channel, p, phi):
    """Return the step along the line at which periodic images of V are below ``ALIAS_ERROR``.

    The images are V at rooms longer by multiples of 2π/step, times exp(−p 2π/step) for each. V is
    bounded there by its transform at any q < p, e^{q (room + 2π/step)} q^(−N−1) Z(q).
    """
    best = math.inf
    for fraction in (0.2, 0.35, 0.5, 0.65, 0.8):
        q = fraction * p
        at_q = q * channel.room - (channel.discs + 1) * math.log(q) + _log_partition(channel, q)
        best = min(best, (at_q - phi - math.log(ALIAS_ERROR)) / ((1 - fraction) * p))
    # V vanishes for a room of 0, so images at shorter rooms need no larger period than the room.
    return 2 * math.pi / max(best, channel.room)
