"""Exact volumes, areas and mean times of every scene of two discs, with any effects.

Velocities times √mass (spins times √moment of inertia) are uniform on a sphere in D dimensions. D
is the number of components minus the number of conserved momenta, which are 0. At total energy
E = 1/2 and potential energy U the invariant density of configurations is ∝ (1 − U/E)^(D/2 − 1), the
speed √(1 − U/E). With the mean size c_D of a component of the uniform unit vector, an event at
g = 0 has the one-sided rate (c_D/2) A/V. Here

    V = ∫ (1 − U/E)₊^(D/2 − 1) dq                A = ∫ (1 − U/E)₊^((D−1)/2) δ(g) √(∇gᵀ M⁻¹ ∇g) dq
    c_D = Γ(D/2) / (√π Γ((D + 1)/2))

are integrals over both centres: c_4/2 = 2/(3π), Chernov's constant (J. Stat. Phys. 88, 1 (1997)).
Conserved momenta do not matter, because ∇g has no component along them. Without a field V is the
volume of configuration space. V and A are in powers of the length, masses in the mass of disc 1.

Along an axis the integrand depends only on the separation t of the centres. For either order of the
discs its density f(t), the integral over their common motion, is elementary, because U is linear
(``Branch``). V is the integral of Π f over Σ t² ≥ σ², and A for disc collisions is one over
Σ t² = σ². For a hop t is 0 along its axis; for a wall the disc is at the wall. The integrals are
done axis by axis, over the angle θ of t = ρ cos θ; ρ² is σ² minus t² of the axes before. The rest
of the range of an axis is never computed as a difference: the room Σ reach² − σ² is rounded once
and passed on from axis to axis. The sums are therefore accurate up to the largest radius.
"""

import math
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, lru_cache
from itertools import product
from typing import NamedTuple

import numpy as np

from twodiscs.model.events import EVENT_AXES, EVENT_WAYS, by_kind
from twodiscs.model.two_geometry import ENERGY
from twodiscs.theory.flux import flux_constant
from twodiscs.theory.quadrature import as_arrays, double_exponential, gauss_legendre

# Functions of arrays ------------------------------------------------------------------------------

# NumPy's functions have different last digits on processors with and without AVX-512.
_pow, _arctan2 = (np.vectorize(function, otypes=[float]) for function in (math.pow, math.atan2))


def _power(x, n):
    """Return ``x``ⁿ of an array for an integer n ≥ 0."""
    return _pow(x, n) if n > 2 else x**n


# Quadrature ---------------------------------------------------------------------------------------


#: Exact for the densities of an axis without field, which are piecewise linear.
LINEAR_RULE = as_arrays(gauss_legendre(2))

#: Exact to rounding for a piece of the arc between two such axes, a trigonometric polynomial.
SMOOTH_RULE = as_arrays(gauss_legendre(16))

#: For half-integer powers: of the energy left in a field, or where a sphere touches a plane.
SINGULAR_RULE = as_arrays(double_exponential(1 / 16))


def _nodes(cuts, rule):
    """Return nodes and weights between successive ``cuts``, along two new last axes."""
    nodes, weights = rule
    widths = np.diff(cuts)[..., None]
    return cuts[..., :-1, None] + widths * nodes, widths * weights


# One axis -----------------------------------------------------------------------------------------


class Interval(NamedTuple):
    """The range of a disc's centre along an axis; exact lengths from the lower wall."""

    low: Fraction
    high: Fraction
    rest: Fraction  # the position with potential energy 0
    slope: Fraction  # U/E per length, 0 without a field along the axis


@dataclass(frozen=True)
class Branch:
    """Density of the separation t of two centres along an axis, for one order of the discs.

    f(t) = ∫ (1 − U/E)₊^p over their common motion, for t from ``start`` to ``reach``, exact lengths
    ≥ 0; ``kinks`` are the t between them at which f is not analytic. f is a function of the
    distance z = reach − t from the reach. The interval of the common motion has the length
    min(flat, near + z, far − z). At its lower end 1 − U/E is min(first + upper z, second − lower
    z), and it falls by upper + lower per length. If flat is 0, one of the discs is fixed, and f is
    (1 − U/E)₊^p there.
    """

    reach: Fraction
    start: Fraction
    kinks: tuple
    lengths: tuple  # flat, near, far
    energies: tuple  # first, upper, second, lower
    power: float

    @property
    def curved(self):
        """Whether f is not piecewise linear."""
        return bool(self.energies[1])

    @property
    def distances(self):
        """The distances z of the reach, of the kinks and of the start, in this order."""
        return np.array([float(self.reach - t) for t in (self.reach, *self.kinks, self.start)])

    @property
    def marks(self):
        """The separations at which integrals are not analytic in the rest for the other axes."""
        return {Fraction(0), self.reach, self.start, *self.kinks}

    def density(self, z):
        """Return f at distances ``z``, an array of lengths in [0, reach − start]."""
        first, upper, second, lower = self.energies
        flat, near, far = self.lengths
        open_length = np.minimum(np.minimum(flat, near + z), far - z)
        if not self.curved:
            return open_length if flat else np.ones_like(z)
        bottom = np.maximum(np.minimum(first + upper * z, second - lower * z), 0.0)
        alpha = np.sqrt(bottom)
        order = round(2 * self.power) + 2
        if not flat:
            return _power(alpha, order - 2)
        # ∫ (bottom − slope q)₊^p dq = (α^order − β^order)/((p + 1) slope), and α² − β² is slope
        # times the length with energy left: a sum of positive terms, for any slope.
        slope = upper + lower
        beta = np.sqrt(np.maximum(bottom - slope * open_length, 0.0))
        total = sum(_power(alpha, order - 1 - j) * _power(beta, j) for j in range(order))
        within = np.minimum(open_length, bottom / slope)
        return within * total / ((self.power + 1) * np.maximum(alpha + beta, 1e-300))

    def beyond(self, square, room):
        """Return ∫ f over t² ≥ ``square``, with ``room`` = reach² − square, arrays of one shape."""
        end = room / (float(self.reach) + np.sqrt(square))
        distances = self.distances
        cuts = np.minimum(distances, np.minimum(end, distances[-1])[..., None])
        z, weights = _nodes(cuts, SINGULAR_RULE if self.curved else LINEAR_RULE)
        return np.sum(weights * self.density(z), axis=(-2, -1))


def _branch(upper, lower, power, farthest=None):
    """Return the ``Branch`` with one ``Interval`` above another; None if it is empty.

    ``farthest``, if given, is its largest separation.
    """

    def energy(q):
        """Return 1 − U/E with both centres at ``q``."""
        return 1 - upper.slope * (q - upper.rest) - lower.slope * (q - lower.rest)

    # At the lower end of the common motion one disc is at its low end, at the upper end one is at
    # its high end; U at these ends rises or falls with t.
    reach, start = upper.high - lower.low, max(Fraction(0), upper.low - lower.high)
    kinks = {upper.low - lower.low, upper.high - lower.high}
    if upper.slope:
        reach = min(reach, energy(lower.low) / upper.slope)
        start = max(start, -energy(upper.low) / lower.slope)
        kinks |= {-energy(upper.high) / lower.slope, energy(lower.high) / upper.slope}
    if farthest is not None:
        reach = min(reach, farthest)
    if start >= reach:
        return None
    flat = min(upper.high - upper.low, lower.high - lower.low)
    lengths = flat, upper.high - lower.low - reach, reach + lower.high - upper.low
    first = energy(lower.low) - upper.slope * reach
    second = energy(upper.low) + lower.slope * reach
    return Branch(
        reach,
        start,
        tuple(sorted((t for t in kinks if start < t < reach), reverse=True)),
        tuple(map(float, lengths)),
        tuple(map(float, (first, upper.slope, second, lower.slope))),
        power,
    )


def _walled(first, second, power, farthest=None):
    """Return {``Branch``: multiplicity} of an axis between walls, from the two ``Interval``s."""
    branches = (_branch(first, second, power, farthest), _branch(second, first, power, farthest))
    return Counter(branch for branch in branches if branch)


def _periodic(side, farthest):
    """Return {``Branch``: multiplicity} of a periodic axis, on which the nearest image counts."""
    side = Fraction(side)
    reach = side / 2 if farthest is None else min(side / 2, farthest)
    lengths = float(side), float(side), float(2 * side)
    return Counter({Branch(reach, Fraction(0), (), lengths, (1.0, 0.0, 1.0, 0.0), 0.0): 2})


# All axes -----------------------------------------------------------------------------------------


def _outside(branches, square, room, surface, less=None):
    """Return ∫ Π f over Σ t² ≥ ``square``, or −∂/∂√square of it for a ``surface``.

    ``room`` is Σ reach² − square; both are arrays of one shape, as the result. ``less``
    returns square − c of an exact c, if it is known better than from ``square``.
    """
    first, *rest = branches
    reach, rho = float(first.reach), np.sqrt(square)
    if not rest:
        if not surface:
            return first.beyond(square, room)
        return first.density(np.maximum(room, 0.0) / (reach + rho))

    # The arc t² + k² = ρ² from (t0, k0) downwards; k is for the other axes.
    others = float(sum(branch.reach**2 for branch in rest))
    if less:
        excess = -less(first.reach**2)
    else:
        excess = np.where(room < reach**2, room - others, reach**2 - square)
    z0 = np.maximum(excess, 0.0) / (reach + rho)
    t0, k0_square = np.minimum(reach, rho)[..., None], np.maximum(-excess, 0.0)[..., None]
    k0, room0 = np.sqrt(k0_square), np.minimum(room, others)[..., None]

    # The integrand is not analytic if t is a mark of its axis or k² is a sum of squares of marks of
    # the others, the last of which belongs to their reaches. With y = t0 − t, neither y nor t is
    # computed as a difference when it is small, because k² − k0² = y (t0 + t).
    sums = _sums(rest)
    k_square = np.array([float(c) for c in sums])
    missing = np.array([float(sums[-1] - c) for c in sums])
    t_square = np.stack([less(c) if less else square - float(c) for c in sums], axis=-1)
    rise = np.where(k_square < room0, k_square - k0_square, room0 - missing)
    touches = np.sqrt(np.maximum(t_square, 0.0))
    falls = rise / (t0 + touches)
    marks = np.array([float(t) for t in (first.reach, *first.kinks, first.start)])
    below = np.where(marks < reach / 2, t0 - marks, first.distances - z0[..., None])
    end = np.minimum(falls[..., -1:], below[..., -1:]), np.maximum(touches[..., -1:], marks[-1:])
    t = np.concatenate((touches, np.broadcast_to(marks, below.shape)), axis=-1)
    t = -np.sort(-np.clip(t, end[1], t0), axis=-1)
    y = np.concatenate((falls, below), axis=-1)
    y = np.sort(np.clip(y, 0.0, np.maximum(end[0], 0.0)), axis=-1)

    # The same as angles from the begin of the arc.
    k = np.sqrt(k0_square + y * (t0 + t))
    sine = y * (t0 + t) / np.maximum(t0 * k + t * k0, 1e-300)
    angles = _arctan2(sine, (t0 * t + k0 * k) / square[..., None])
    angles = angles if square.ndim else np.unique(angles)
    angle, weights = _nodes(angles, SINGULAR_RULE if first.curved or len(rest) > 1 else SMOOTH_RULE)
    t0, k0, rho, room0 = (part[..., None] for part in (t0, k0, rho[..., None], room0))
    begin = _arctan2(k0, t0)
    y = 2 * rho * np.sin(angle / 2) * np.sin(begin + angle / 2)
    k = rho * np.sin(begin + angle)
    inner = _outside(rest, k * k, room0 - y * (2 * t0 - y), surface)
    density = first.density(z0[..., None, None] + y)
    total = np.sum(weights * (rho if surface else k) * density * inner, axis=(-2, -1))
    if not surface and np.any(excess > 0):
        free = math.prod(b.beyond(np.array(0.0), np.array(float(b.reach**2))) for b in rest)
        total = total + free * first.beyond(square, excess)
    return total


def _sums(branches):
    """Return the sums of squares of marks, one of each branch, in ascending order."""
    return sorted({sum(t * t for t in marks) for marks in product(*(b.marks for b in branches))})


def _at_distance(branches, sigma, surface, further=0.0):
    """Return ``_outside`` of the square of an exact ``sigma``, or of σ ``further`` away."""
    rise = further * (2 * float(sigma) + further)

    def less(c):
        """Return the square minus an exact ``c``."""
        return np.array(float(sigma**2 - c) + rise)

    room = -less(sum(branch.reach**2 for branch in branches))
    return float(_outside(branches, less(0), room, surface, less)) if room > 0 else 0.0


@lru_cache(maxsize=1024)
def _beyond_contact(branches, sigma):
    """Return ∫ Π f over Σ t² ≥ σ², for a tuple of ``Branch``es and an exact σ."""
    return _at_distance(branches, sigma, False)


@lru_cache(maxsize=1024)
def _near_contact(branches, sigma, thickness):
    """Return ∫ Π f over σ² ≤ Σ t² ≤ (σ + thickness)², over the thickness, which may be 0."""
    if not thickness:
        return _at_distance(branches, sigma, True)
    inner, outer = (_beyond_contact(branches, d) for d in (sigma, sigma + thickness))
    if inner - outer > 1e-3 * inner:
        return (inner - outer) / float(thickness)
    # The difference would cancel. At the cuts the growing sphere touches an edge or a corner.
    touches = [float(c - sigma**2) / (float(sigma) + math.sqrt(c)) for c in _sums(branches)]
    cuts = np.unique(np.clip([*touches, float(thickness)], 0.0, float(thickness)))
    nodes = zip(*(part.ravel() for part in _nodes(cuts, SINGULAR_RULE)), strict=True)
    total = math.fsum(weight * _at_distance(branches, sigma, True, x) for x, weight in nodes)
    return total / float(thickness)


def _sum_of_orders(axes, integral, *arguments):
    """Return the sum of an integral over all orders of the discs along ``axes``.

    ``axes`` are {``Branch``: multiplicity} of one axis each, y with its field before the others.
    """
    return math.fsum(
        math.prod(often) * integral(branches, *arguments)
        for branches, often in (
            zip(*choice, strict=True) for choice in product(*(axis.items() for axis in axes))
        )
    )


class _Space:
    """The configuration space of a ``Scene`` with the weight (1 − U/E)₊^p.

    ``level`` is {axis: the largest separation of the centres along it}, for a part of the space.
    """

    def __init__(self, scene, power, level=None):
        self.scene, self.power, self.level = scene, power, level or {}
        self.sigma = scene.exact_contact
        self.order = sorted(scene.axes, key="yxz".index)
        # Many integrals use them.
        self.axis, self.wall = cache(self.axis), cache(self.wall)

    def intervals(self, axis):
        """Return the ``Interval``s of both discs between the walls of ``axis``."""
        side = Fraction(self.scene.side(axis))
        field = Fraction(self.scene.field) / Fraction(ENERGY) if axis == "y" else Fraction(0)
        return [
            Interval(r, side - r, r, field * Fraction(m))
            for r, m in zip(self.scene.exact_radii, self.scene.masses, strict=True)
        ]

    def axis(self, axis, farthest=None):
        """Return {``Branch``: multiplicity} of ``axis``."""
        farthest = self.level.get(axis) if farthest is None else farthest
        if axis in self.scene.walled:
            return _walled(*self.intervals(axis), self.power, farthest)
        return _periodic(self.scene.side(axis), farthest)

    def axes(self, **replaced):
        """Return {``Branch``: multiplicity} of all axes, some of which are ``replaced``."""
        return [replaced[a] if a in replaced else self.axis(a) for a in self.order]

    def beyond(self, **replaced):
        """Return the measure of the configurations without overlap."""
        return _sum_of_orders(self.axes(**replaced), _beyond_contact, self.sigma)

    def within(self, axis, distance):
        """Return the measure of separations up to a ``distance`` along ``axis``."""
        return self.beyond(**{axis: self.axis(axis, farthest=distance)})

    def contact(self, thickness):
        """Return the measure of distances from σ to σ + ``thickness``, per length."""
        return _sum_of_orders(self.axes(), _near_contact, self.sigma, Fraction(thickness))

    def passing(self, axis):
        """Return the measure of the separation 0 along ``axis``, per length.

        The branch begins at 0: discs that fit can be beside each other, also in a field.
        """
        others = [self.axis(other) for other in self.order if other != axis]
        if axis in self.scene.periodic:
            density = float(self.scene.side(axis))
        else:
            level = _branch(*self.intervals(axis), self.power)
            density = float(level.density(np.array(float(level.reach))))
        return density * _sum_of_orders(others, _beyond_contact, self.sigma)

    def wall(self, axis, disc, high, thickness=0):
        """Return the measure with ``disc`` 0 or 1 at a wall, or within ``thickness`` of it."""
        both = self.intervals(axis)
        own = both[disc]
        if high:
            own = own._replace(low=max(own.low, own.high - thickness))
        else:
            own = own._replace(high=min(own.high, own.low + thickness))
        both[disc] = own
        return self.beyond(**{axis: _walled(*both, self.power, self.level.get(axis))})


class _Surface(NamedTuple):
    """The ``area`` A of an event in a ``_Space``; the expectation of its ``shell`` for an ε."""

    area: Callable
    shell: Callable


def _hop(event):
    def shell(space, epsilon):
        thickness = Fraction(epsilon) * Fraction(space.scene.fastest)
        return space.within(event.axis, thickness) / (2 * epsilon)

    return _Surface(lambda space: space.scene.fastest * space.passing(event.axis), shell)


def _contact(space, epsilon=0):
    """Return the expectation of a shell of collisions, or A."""
    fastest = space.scene.fastest
    return fastest * space.contact(Fraction(epsilon) * Fraction(fastest))


def _walls(hits):
    """Return the ``_Surface`` of ``hits`` of a scene: (axis, disc, whether at the far wall)."""

    def area(space):
        masses = space.scene.masses
        of_walls = (space.wall(*hit) / math.sqrt(masses[hit[1]]) for hit in hits(space.scene))
        return math.fsum(of_walls)

    def shell(space, epsilon):
        ends = [Fraction(epsilon / math.sqrt(mass)) for mass in space.scene.masses]
        return math.fsum(space.wall(*hit, ends[hit[1]]) for hit in hits(space.scene)) / epsilon

    return _Surface(area, shell)


#: {event: its surface}
SURFACES = by_kind(
    "theory/weighted.py",
    {
        "hop": _hop,
        "collision": lambda event: _Surface(_contact, _contact),
        "wall": lambda event: _walls(lambda scene: [(event.axis, 0, event.side > 0)]),
        "walls": lambda event: _walls(lambda scene: product(scene.walled, (0, 1), (False, True))),
    },
)


def _areas(space):
    """Return {event: A}, 0.0 for events that are impossible."""
    return {
        e: one.area(space) if space.scene.is_possible(e) else 0.0 for e, one in SURFACES.items()
    }


# Exact values -------------------------------------------------------------------------------------


@lru_cache(maxsize=1024)
def volume(scene):
    """Return the weighted volume V of a ``Scene``, in length⁴ (length⁶ for balls).

    Without a field it is the volume of configuration space.
    """
    return _Space(scene, scene.velocity_components / 2 - 1).beyond()


def areas_near(scene, axis, distance):
    """Return ``areas`` of the part with a separation of at most ``distance`` along ``axis``."""
    level = {axis: Fraction(distance)}
    return _areas(_Space(scene, (scene.velocity_components - 1) / 2, level))


@lru_cache(maxsize=1024)
def areas(scene):
    """Return {event: weighted area A} of a ``Scene``, keys ``EVENTS`` in their order.

    They are in length³ (length⁵ for balls) over the square root of a mass, and exactly 0.0 if the
    event is impossible or does not exist in the scene. ``any_wall`` is the sum over both discs and
    all walls.
    """
    return _areas(_Space(scene, (scene.velocity_components - 1) / 2))


def volume_near(scene, hop, distance):
    """Return the part of V with a separation up to ``distance`` along the axis of a ``hop``."""
    return _Space(scene, scene.velocity_components / 2 - 1).within(
        EVENT_AXES[hop], Fraction(distance)
    )


# Shells -------------------------------------------------------------------------------------------


def shell_expectation(scene, event, epsilon):
    """Return the exact expectation of a shell of thickness ``epsilon`` at the surface of ``event``.

    It is the integral of (1 − U/E)₊^((D−1)/2) over the shell, divided by ε, or by 2ε for hops. It
    tends to the area as ε → 0. Distances from the surface are in the metric of the masses, in which
    its normal has unit length; with k = √(1/m1 + 1/m2):

        vertical hop     |y1 − y2| ≤ k ε                  horizontal hop   likewise in x
        disc collision   0 ≤ distance − σ ≤ k ε
        right wall       0 ≤ (distance of disc 1 from contact with the wall) ≤ ε/√m1
        top wall         likewise
        any wall         the sum of the shells of both discs at all walls, ε/√m each
    """
    return SURFACES[event].shell(_Space(scene, (scene.velocity_components - 1) / 2), epsilon)


# Rates. Friction changes none of them: a kick draws velocities from the law that they have in the
# invariant measure, for given centres and conserved momenta, so the measure stays invariant. A rate
# is the flux of this measure through a surface.


def rate(scene, event):
    """Return the rate of ``event``."""
    flux = EVENT_WAYS[event] / 2 * flux_constant(scene.velocity_components) * areas(scene)[event]
    return flux / volume(scene)


def passing_rate(scene, hop):
    """Return the rate at which the discs pass each other in a ``hop`` along a periodic axis."""
    space = _Space(scene, (scene.velocity_components - 1) / 2)
    area = scene.fastest * space.passing(EVENT_AXES[hop])
    return flux_constant(scene.velocity_components) * area / volume(scene)
