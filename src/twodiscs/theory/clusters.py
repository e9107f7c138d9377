"""The bursts of events of rough discs, and the number of initial states that must be in them.

Two rough discs side by side in a narrow gap bounce between its walls. They leave it late, because
the impulses along their surfaces reverse their motion along the gap. A run without an initial state
in the gap misses a part of the rate, and its sample does not show that.

The part is exact. Let G be the configurations with a separation of at most d along an axis. The
fraction s of an event's rate that comes from G is the area of its surface in G over the whole area.
The fraction P of initial states in G is the volume of G over the whole volume. On average n = P R
out of R replicas begin in G. If none does, the mean count is too small by s. If some do, they add
at least s/√n to its relative error.

The smallest G is the neck, in which the free length of the discs is at most twice that at
separation 0. From there on d doubles. Visits of G that begin outside are not counted, so the number
of initial states is an upper bound. Smooth discs pass a neck in one flight along it and have no
bursts.

A rough disc may also stay in a corner of two walls. It hits one wall and the other in turn, and at
every second hit its velocity and spin, scaled by the roots of mass and inertia, turn by 2θ about
one axis, cos θ = −I/(1 + I). If the circle of its velocities leads from each wall to the other, it
stays until another disc or a kick hits it. This is so for a fraction 1 − √((1 + I)/(1 + 2I)) of the
directions. At a distance d it hits the walls at a rate Λ ~ v/d, so P(N > n) → A/n² (see
``corner_hits``). The variance of N grows as the logarithm of the number of replicas, and the error
from a sample lacks what is larger than its largest N. ``corner_variance`` is a multiple of A, which
an error has to add. No run is rejected because its sample has a few large N: this would keep the
runs without large N, whose errors are too small.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from twodiscs.model.events import DECLARED_EVENTS, EVENT_AXES, EVENTS, HOPS, WALL_HITS, WALLS
from twodiscs.theory import weighted
from twodiscs.theory.quadrature import gauss_legendre

#: The number of initial states in G that is enough for the error of its bursts.
ENOUGH_VISITS = 100

#: A contribution to the error below this fraction of it is ignored.
NEGLIGIBLE_ERROR = 0.3

#: The smallest d over the largest one: below, almost no events come from G.
SMALLEST_REACH = 2.0**-20

#: The rule for A, whose integrand is smooth: its error is below 1e-11 of A for all I up to 1.
BURST_RULE = gauss_legendre(8)

#: Points of the arc on which discs may touch a disc in a corner.
ARC_POINTS = 64

#: The variance to add, over A. Scores of walls then have mean squares of 0.8 to 1.2 with 1024
#: replicas, for eight scenes with two and three discs and 100 seeds each; without it of up to 2. In
#: five scenes A was counted, by the 30th and the 100th largest of 40000 counts: it is 0.7 to 1.5 of
#: what is computed here.
ADDED_VARIANCE = 2.5


class Region(NamedTuple):
    """A region ``within`` a separation along an axis: its fractions of volume and of each rate."""

    axis: str
    within: float
    volume: float
    rates: dict


def _neck(scene, hop):
    """Return the separation up to which there is a neck, None without one."""
    room, sigma = scene.clearance(hop), scene.contact_distance
    depth = room if room > 0 else -2 * room  # the height of the arch above the gap
    return math.sqrt(depth * (2 * sigma - depth)) if depth < sigma else None


@lru_cache(maxsize=256)
def regions(scene):
    """Return the ``Region``s of a ``Scene`` with bursts of events, none for smooth discs.

    The largest ones have no bursts, but enough initial states in any run.
    """
    if scene.moment_of_inertia is None:
        return ()
    volume, areas, found = weighted.volume(scene), weighted.areas(scene), []
    for hop in HOPS:
        axis = EVENT_AXES[hop]
        if axis not in scene.axes or (least := _neck(scene, hop)) is None:
            continue
        reach = float(scene.reach(axis))
        within = max(least, reach * SMALLEST_REACH)
        while within < reach:
            share = weighted.volume_near(scene, hop, within) / volume
            near = weighted.areas_near(scene, axis, within)
            rates = {event: near[event] / areas[event] for event in EVENTS if areas[event]}
            found.append(Region(axis, within, share, rates))
            within *= 2
    return tuple(found)


def replicas_needed(scene, event, error):
    """Return the number of initial states that a relative ``error`` of an ``event`` needs.

    Fewer may miss all of its bursts and have too small an error bar.
    """
    most = 0.0
    for region in regions(scene):
        excess = region.rates.get(event, 0.0) / (NEGLIGIBLE_ERROR * error)
        if excess > 1:
            most = max(most, min(ENOUGH_VISITS, excess**2) / region.volume)
    return most


def corner_hits(inertia):
    """Return A of P(N > n) → A/n², over p ⟨V²⟩ ⟨t²⟩, of rough discs with an ``inertia`` I.

    N is the number of hits in a stay of the time t near one corner, p the density of the centre in
    the corner, and V the velocity of two components and √I times the spin.

    Hits on one wall or the other turn V by half a turn about the axes (1, 0, −√I) and (0, 1, √I).
    Both are normal to e ∝ (√I, −√I, 1), so μ = |e·V|/|V| is kept. With e along V the speeds along
    the walls are |v_x| = a + b cos φ and |v_y| = a + b cos(φ + θ), with a² = μ² I/(1 + 2I), b² =
    (1 − μ²) μ₀², μ₀² = (1 + I)/(1 + 2I), in units of |V|. A disc stays if a > b, that is μ > μ₀.
    A hit keeps J = |x v_y − y v_x|, and a flight from wall to wall takes J/|v_x v_y|. It fills a
    triangle of the area J²/2|v_x v_y|. As φ comes to be distributed evenly, N → t/(J M) with

        M = ⟨1/|v_x v_y|⟩ = 2a/√(a² − b²)/(2a² − b²/(1 + I)),  a² − b² = μ² − μ₀².

    N > n for J < t/(n M), so A = p ⟨t²⟩ ⟨V²⟩/2 ∫ dμ/M from μ₀ to 1. With μ² = μ₀² + x² I/(1 + 2I)

        A/(p ⟨V²⟩ ⟨t²⟩) = I²/(4 (1 + 2I)) ∫ x² (1 + x²)/(1 + I + I x²) dx,  0 < x < 1,

    where no terms cancel. The integral is [1/3 − (1 − √q arctan(1/√q))/I]/I with q = (1 + I)/I. At
    I = 1 the circle is three points: a quarter of the directions stay, and A is a tenth larger.
    """
    kept = sum(w * x**2 * (1 + x**2) / (1 + inertia * (1 + x**2)) for x, _, w in BURST_RULE)
    return inertia**2 / (4 * (1 + 2 * inertia)) * kept


def corner_variance(scene, event, duration):
    """Return the variance of a replica's count of an ``event`` to add for bursts in corners.

    It is 0 for events other than wall hits, for smooth discs, and where no two walls meet. The
    counts are those of all events that are equal by symmetry, in a ``duration``. In a field, and
    for more than two discs, their positions are taken as independent.
    """
    inertia = scene.moment_of_inertia
    if inertia is None or len(scene.walled) < 2 or event not in WALL_HITS:
        return 0.0
    one = event in WALLS and not scene.identical
    corners = [_corners(scene, i, duration) for i in range(1 if one else scene.discs)]
    bottom, top = (math.fsum(part) for part in zip(*corners, strict=True))
    found = bottom + top
    if event in WALLS:  # half of the hits, of a quarter of the variance
        own = top if DECLARED_EVENTS[event].side > 0 else bottom
        found = (found if EVENT_AXES[event] == "x" or not scene.field else own) / 4
    return ADDED_VARIANCE * corner_hits(inertia) * found


def _corners(scene, i, duration):
    """Return Σ p ⟨v²⟩ ⟨t²⟩ of the corners at the bottom and at the top, for a disc ``i``."""
    d, radius = scene.velocity_components, scene.radii[i]
    j = 1 - i if scene.discs == 2 else 0
    sides = [scene.side(axis) for axis in scene.walled]
    area, of_other = (math.prod(s - 2 * r for s in sides) for r in (radius, scene.radii[j]))
    # Contacts with a disc in the corner, as far as the other centre has room there; and that room.
    sigma, others, offset = scene.contact_distance, scene.discs - 1, scene.radii[j] - radius
    reach_x, reach_y = (s - 2 * scene.radii[j] for s in sides)
    middles = (np.arange(ARC_POINTS) + 0.5) / ARC_POINTS
    x, y = sigma * np.cos(middles * math.pi / 2), sigma * np.sin(middles * math.pi / 2)
    there = (x >= offset) & (x <= offset + reach_x) & (y >= offset) & (y <= offset + reach_y)
    share = np.mean(there)
    half = np.sqrt(np.maximum(sigma**2 - (offset + reach_x * middles) ** 2, 0.0))
    low, high = (np.clip(end - offset, 0.0, reach_y) for end in (-half, half))
    blocked = reach_x * np.mean(high - low)
    free = max(of_other - others * blocked, of_other / 2**5)
    speed = math.gamma(d / 2) / (math.sqrt(math.pi) * math.gamma((d + 1) / 2))
    flux = speed / math.sqrt(scene.masses[j]) / 2
    rate = scene.friction + others * flux * share * math.pi / 2 * sigma / free
    x = rate * duration
    stays = 2 * (x + math.expm1(-x)) / rate**2 if x > 1e-4 else duration**2
    known = scene.discs == 2 and not scene.field
    density = free / weighted.volume(scene) if known else 1 / area
    found = 2 * density * stays * 3 / (d * scene.masses[i])
    # In a field a disc at the height y has the density of the kinetic energy left, 1 − c y.
    fall = 2 * scene.field * scene.masses[i] * (scene.height - 2 * radius)
    left = max(1 - fall, 0.0)
    # Below the root of the precision the difference 1 − left has a larger error than the value 1.
    mean = (1 - left ** (d / 2)) / (fall * d / 2) if fall > 1e-8 else 1.0
    return found / mean, found * left ** (d / 2 - 1) / mean
