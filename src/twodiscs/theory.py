"""Exact volume, surface areas and mean times of two equal discs in a box, for every radius.

Only the separations u = |x1 − x2| and v = |y1 − y2| matter. They lie in [0, A] × [0, B] with the
density 4 (A − u)(B − v), outside the arc (u, v) = σ (cos θ, sin θ). The volume of configuration
space and the areas of the surfaces where events happen are

    V       = 4 ∬ (A − u)(B − v) 1[u² + v² ≥ σ²] du dv
    A_coll  = −√2 ∂V/∂σ         A_right = ½ ∂V/∂A           A_top = ½ ∂V/∂B
    A_hop,v = √2 B (A − σ)₊²    A_hop,h = √2 A (B − σ)₊²    A_walls = 4 (A_right + A_top)

Speeds are uniform on the unit sphere in four dimensions, so the mean time between events of an
ergodic component is (3π/2) V/A, or half of it for a hop, whose surface is crossed from both sides
(Chernov, J. Stat. Phys. 88, 1 (1997)).

Written out in powers and inverse sines (``closed_form``) these cancel to nothing near the largest
radius. Here they are sums of positive terms: integrals over the arc of products of the slacks
A − σ cos θ and B − σ sin θ, each itself a sum of positive terms. Every length, angle and difference
that cancels is rounded once, from exact fractions of the given doubles.

That is the plain scene. Scenes that call for effects are handed over to ``rates``, which needs
NumPy and is imported only then: ``volume``, ``areas``, ``rate``, ``mean_times``, ``exact`` and
``shell_expectation`` hold for every scene, closed forms and limits for plain ones only.
"""

import math
from fractions import Fraction
from functools import lru_cache
from typing import NamedTuple

from twodiscs.checks import a_scene, one_of
from twodiscs.scene import EVENTS, HOPS, Scene, length

#: The events whose surface has a shell of its own; all walls together are corners as well.
SHELLS = tuple(event for event in EVENTS if event != "any_wall")

#: The same events in the box turned by a quarter.
TURNED = {
    "vertical_hop": "horizontal_hop",
    "horizontal_hop": "vertical_hop",
    "right_wall": "top_wall",
    "top_wall": "right_wall",
}


def _gauss_legendre(order):
    """Return triples (t, 1 − t, weight) of the Gauss–Legendre rule on [0, 1]."""
    rule = []
    for i in range(order):
        x = math.cos(math.pi * (i + 0.75) / (order + 0.5))
        for _ in range(8):
            last, p = 1.0, x
            for k in range(2, order + 1):
                last, p = p, ((2 * k - 1) * x * p - (k - 1) * last) / k
            slope = order * (last - x * p) / (1 - x * x)
            x -= p / slope
        rule.append(((1 - x) / 2, (1 + x) / 2, 1 / ((1 - x * x) * slope**2)))
    return rule


#: The integrands are trigonometric polynomials of degree 4 at most over a quarter of a turn, or as
#: smooth as that: sixteen nodes are exact to rounding.
RULE = _gauss_legendre(16)

#: Exact for cubics.
CUBIC = _gauss_legendre(2)


class _Arc:
    """The arc u² + v² = σ² within [0, A] × [0, B], for exact A, B, σ > 0.

    A point on it is named by its squared abscissa u², an exact fraction, which falls from ``start``
    (at the angle β) to ``stop`` (at α) as θ grows. Where A² + B² ≤ σ² nothing is left of the arc.
    """

    def __init__(self, range_x, range_y, sigma):
        self.exact = range_x, range_y, sigma
        self.range_x, self.range_y, self.sigma = float(range_x), float(range_y), float(sigma)
        self.beyond_x = max(float(range_x - sigma), 0.0)
        self.beyond_y = max(float(range_y - sigma), 0.0)
        self.square = sigma**2
        self.start = min(range_x, sigma) ** 2
        self.stop = self.square - min(range_y, sigma) ** 2
        self.beta = self.angle(self.square, self.start)
        self.alpha_left = self.angle(self.stop, Fraction(0))  # π/2 − α

    @classmethod
    def of(cls, scene):
        """Return the arc of a ``Scene``."""
        w, h, r = Fraction(scene.width), Fraction(scene.height), Fraction(scene.radius)
        return cls(w - 2 * r, h - 2 * r, 2 * r)

    def turned(self):
        """Return the arc with u and v exchanged."""
        range_x, range_y, sigma = self.exact
        return _Arc(range_y, range_x, sigma)

    def angle(self, first, second):
        """Return the angle from one point to another, both anywhere on the quarter circle."""
        if first == second:
            return 0.0
        u1, v1 = math.sqrt(first), math.sqrt(self.square - first)
        u2, v2 = math.sqrt(second), math.sqrt(self.square - second)
        # u1 v2 − u2 v1, without its cancellation.
        cross = float(self.square * (first - second)) / (u1 * v2 + u2 * v1)
        return math.atan2(cross, u1 * u2 + v1 * v2)

    def nodes(self, first, second):
        """Yield (weight σ dθ, A − σ cos θ, B − σ sin θ, cos θ, sin θ) between two of its points.

        Yields nothing unless ``first`` comes before ``second``.
        """
        if first <= second:
            return
        turn = self.angle(first, second)
        before, after = self.angle(self.start, first), self.angle(second, self.stop)
        for t, rest, weight in RULE:
            s = before + t * turn
            left = after + rest * turn
            yield (
                weight * turn * self.sigma,
                self.beyond_x + 2 * self.sigma * math.sin(s / 2) * math.sin(self.beta + s / 2),
                self.beyond_y
                + 2 * self.sigma * math.sin(left / 2) * math.sin(self.alpha_left + left / 2),
                math.sin(self.alpha_left + left),
                math.sin(self.beta + s),
            )


class _Measures(NamedTuple):
    """Volume of configuration space and the areas that take an integral."""

    volume: float
    disc_collision: float
    right_wall: float
    top_wall: float


def _measures(arc):
    """Return the ``_Measures`` of an arc."""
    volume, disc = arc.range_x**2 * arc.beyond_y**2, 0.0
    right, top = arc.range_x * arc.beyond_y**2, arc.range_y * arc.beyond_x**2
    for weight, x, y, cos, sin in arc.nodes(arc.start, arc.stop):
        area = 2 * weight * x * y
        disc += area
        volume += area * x * cos
        right += area * cos
        top += area * sin
    return _Measures(volume, 2 * math.sqrt(2) * disc, right, top)


def _plain(scene):
    """Return ``scene``; raise ``ValueError`` unless it is a ``Scene`` without effects."""
    if a_scene(scene).has_effects:
        raise ValueError(
            "scene must be plain for closed forms, limits and distributions, but it has "
            f"{', '.join(scene.effects)}"
        )
    return scene


@lru_cache(maxsize=1024)
def _exact(scene):
    """Return (volume, {event: area})."""
    if scene.has_effects:
        from twodiscs import rates

        return rates.volume(scene), rates.areas(scene)
    arc = _Arc.of(scene)
    volume, disc, right, top = _measures(arc)
    return volume, {
        "vertical_hop": math.sqrt(2) * arc.range_y * arc.beyond_x**2,
        "horizontal_hop": math.sqrt(2) * arc.range_x * arc.beyond_y**2,
        "disc_collision": disc,
        "right_wall": right,
        "top_wall": top,
        "any_wall": 4 * (right + top),
    }


def volume(scene):
    """Return the volume of the configuration space of a ``Scene``, in length⁴ (6 for balls).

    Within a few roundings of the exact value for every box and radius. In a field it is weighted
    with the invariant density (see ``rates``). Raises ``ValueError`` for anything that is not a
    ``Scene``.
    """
    return _exact(a_scene(scene))[0]


def areas(scene):
    """Return {event: area of its surface in configuration space} of a ``Scene``, in length³.

    Keys are ``scene.EVENTS`` in their order. The area is exactly 0.0 where the event is impossible
    or has no place; that of all walls is 4 (right + top) in a plain scene. It is in length⁵ for
    balls, carries 1/√mass (1 for disc 1), and is weighted in a field (see ``rates``). Accuracy and
    errors as for ``volume``.
    """
    return dict(_exact(a_scene(scene))[1])


def rate(scene, event):
    """Return how often ``event`` happens per unit of time, over all initial conditions; 0 if never.

    This is the mean over the whole configuration space. A trajectory that can reach the right (top)
    wall at all hits it twice as often where it is confined to one side of the other disc:
    ``mean_times``. Raises ``ValueError`` for anything that is not a ``Scene`` or one of
    ``scene.EVENTS``.
    """
    if a_scene(scene).has_effects:
        from twodiscs import rates

        return rates.rate(scene, event)
    volume, areas = _exact(scene)
    sides = 2 if one_of("event", event, EVENTS) in HOPS else 1
    return sides * areas[event] / (1.5 * math.pi * volume)


def event_rate(scene):
    """Return the wall hits and disc collisions per unit of time of a ``Scene``, hops not counted.

    Raises ``ValueError`` for anything that is not a ``Scene``.
    """
    return rate(scene, "any_wall") + rate(scene, "disc_collision")


def mean_times(scene):
    """Return {event: mean time between two of them}, for disc 1 of mass 1 and total energy 1/2.

    Keys are ``scene.EVENTS`` in their order, values lengths over unit speed, or None where the
    event is impossible. Wall times are those of disc 1 on the trajectories that can reach the wall:
    half of configuration space where ``Scene.confined``. Accuracy and errors as for ``volume``.
    """
    share = dict(zip(("right_wall", "top_wall"), a_scene(scene).confined, strict=True))
    share = {event: 0.5 if confined else 1 for event, confined in share.items()}
    return {
        event: share.get(event, 1) / rate(scene, event) if area else None
        for event, area in areas(scene).items()
    }


def exact(scene):
    """Return all exact numbers of a ``Scene`` as one dict, ready for JSON.

    Keys: regime, ergodic_components, largest_radius, volume, areas, mean_times. Raises
    ``ValueError`` for anything that is not a ``Scene``.
    """
    return {
        "regime": a_scene(scene).regime,
        "ergodic_components": scene.ergodic_components,
        "largest_radius": scene.largest_radius,
        "volume": volume(scene),
        "areas": areas(scene),
        "mean_times": mean_times(scene),
    }


# Shells ---------------------------------------------------------------------------------------


def _hop_shell(arc, epsilon):
    """Return the volume with v ≤ √2 ε, over 2ε."""
    end = max(arc.stop, arc.square - 2 * Fraction(epsilon) ** 2)
    total = sum(w * x * x * y * cos for w, x, y, cos, _ in arc.nodes(arc.start, end))
    return total / epsilon


def _wall_shell(arc, epsilon):
    """Return the volume with x1 ≥ a − ε, over ε.

    With x1 = a − g it is the mean over g of ∫ W over [−g, A − g], where W(u) = (B − √(σ² − u²)₊)₊².
    Disc 2 on the left gives ∫ W min(1, (A − u)/ε), disc 2 on the right ∫ W (1 − u/ε)₊, which is
    V/(2ε) with ε in the place of A.
    """
    range_x, range_y, sigma = arc.exact
    thick = Fraction(epsilon)
    if thick >= range_x:
        return _measures(arc).volume / epsilon
    flat, near = arc.beyond_x, min(max((range_x - thick) ** 2, arc.stop), arc.start)
    total = arc.range_y**2 * (flat**2 / (2 * epsilon) if flat < epsilon else flat - epsilon / 2)
    total += sum(w * y * y * sin * x / epsilon for w, x, y, _, sin in arc.nodes(arc.start, near))
    total += sum(w * y * y * sin for w, _, y, _, sin in arc.nodes(near, arc.stop))
    return total + _measures(_Arc(thick, range_y, sigma)).volume / (2 * epsilon)


def _collision_shell(arc, epsilon):
    """Return the volume with u² + v² ≤ (σ + √2 ε)², over ε.

    In the direction θ the shell ends at the outer arc or before, at a side of the rectangle.
    """
    range_x, range_y, sigma = arc.exact
    outer = sigma + Fraction(math.sqrt(2)) * Fraction(epsilon)
    thick = float(outer - sigma)
    reach = min(outer**2, range_x**2 + range_y**2)
    side_ends = min(arc.square * range_x**2 / reach, arc.square)
    top_begins = arc.square - min(arc.square * range_y**2 / reach, arc.square)
    rays = [(node, node[1] / node[3]) for node in arc.nodes(arc.start, side_ends)]
    rays += [(node, thick) for node in arc.nodes(side_ends, top_begins)]
    rays += [(node, node[2] / node[4]) for node in arc.nodes(top_begins, arc.stop)]
    total = 0.0
    for (weight, x, y, cos, sin), ray in rays:
        for t, _, share in CUBIC:
            s = t * ray
            total += weight * share * ray * (1 + s / arc.sigma) * (x - s * cos) * (y - s * sin)
    return 4 * total / epsilon


def shell_expectation(scene, event, epsilon):
    """Return what a shell of thickness ``epsilon`` around the surface of ``event`` estimates.

    That is the exact volume of the shell over ε, or over 2ε for hops, in length³; it tends to the
    area of the surface as ε → 0. Distances g in configuration space from the surface:

        vertical hop     |g| ≤ ε, g = (y1 − y2)/√2         horizontal hop   likewise in x
        disc collision   0 ≤ g ≤ ε, g = (distance − σ)/√2
        right wall       0 ≤ g ≤ ε, g = a − x1             top wall         0 ≤ g ≤ ε, g = b − y1

    Just beyond the radius where a hop becomes blocked its shell is not empty yet, though its area
    is 0. Shells of scenes with effects, whose discs may differ in mass, are in
    ``rates.shell_expectation``. Raises ``ValueError`` for anything that is not a ``Scene``, for an
    ``epsilon`` that is not a length up to the radius, and for ``any_wall``, which has no shell of
    its own in a plain scene.
    """
    if a_scene(scene).has_effects:
        from twodiscs import rates

        return rates.shell_expectation(scene, event, epsilon)
    arc = _Arc.of(scene)
    one_of("event", event, SHELLS)
    epsilon = length("epsilon", epsilon)
    if epsilon > scene.radius:
        raise ValueError(
            f"epsilon must not exceed the radius {scene.radius!r}, but it is {epsilon!r}"
        )
    if event == "disc_collision":
        return _collision_shell(arc, epsilon)
    shell = _hop_shell if event in HOPS else _wall_shell
    upright = event in ("vertical_hop", "right_wall")
    return shell(arc if upright else arc.turned(), epsilon)


# Closed forms and limits ------------------------------------------------------------------------


def closed_form(scene):
    """Return {"volume": V, "areas": {event: area}} from closed forms, in plain doubles.

    For reading, for comparisons and to show how they fail: just above a threshold they can lose
    half of the digits or more, and near the largest radius, at r = (1 − δ) r_max, all of them (the
    volume like 1e-16/δ⁴). Use ``volume`` and ``areas`` for numbers. Raises ``ValueError`` for
    anything that is not a plain ``Scene``.
    """
    r = _plain(scene).radius
    a, b = scene.range_x / 2, scene.range_y / 2
    # Of the quarter circle, the angle within [0, a] × [0, b].
    angle = math.asin(min(b / r, 1.0)) - math.acos(min(a / r, 1.0))

    def side(a, b):
        """Return the terms of V, A_coll and the two wall areas that say whether discs can pass."""
        if a >= r:
            return 64 / 3 * a * r**3 - 8 * r**4, r * r - 2 * a * r, 16 / 3 * r**3, 0.0
        k = math.sqrt(r * r - a * a)
        cubic = 8 / 3 * k * (2 * r * r + a * a)
        return (
            16 * (a * r) ** 2 - 8 / 3 * a**4 - 4 * b * cubic,
            2 * b * k - a * a,
            8 * a * r * r - 8 / 3 * a**3 - 8 * a * b * k,
            -cubic,
        )

    (v_x, c_x, own_x, other_x), (v_y, c_y, own_y, other_y) = side(a, b), side(b, a)
    right = 8 * a * b * b - 8 * b * r * r * angle + own_x + other_y
    top = 8 * a * a * b - 8 * a * r * r * angle + own_y + other_x
    return {
        "volume": 16 * (a * b) ** 2 - 32 * a * b * r * r * angle + 8 * r**4 + v_x + v_y,
        "areas": {
            "vertical_hop": 8 * math.sqrt(2) * b * max(a - r, 0.0) ** 2,
            "horizontal_hop": 8 * math.sqrt(2) * a * max(b - r, 0.0) ** 2,
            "disc_collision": 16 * math.sqrt(2) * r * (2 * a * b * angle - r * r + c_x + c_y),
            "right_wall": right,
            "top_wall": top,
            "any_wall": 4 * (right + top),
        },
    }


def small_radius_time(width, height, event, radius=0.0):
    """Return the mean time between events for small discs, to first order in ``radius``.

    With the default radius it is the limit r → 0: 3πh/(4√2) for vertical hops, 3πw/2 for the right
    wall, and infinite for disc collisions, which go like 3wh/(8√2 r). Raises ``ValueError`` for a
    box or radius (other than 0) that makes no ``Scene``, and for an event not in ``scene.EVENTS``.
    """
    w, h, r = length("width", width), length("height", height), 0.0
    if isinstance(radius, bool) or radius != 0:
        r = Scene(w, h, radius).radius
    one_of("event", event, EVENTS)
    if event == "disc_collision":
        if r == 0:
            return math.inf
        return 3 / (8 * math.sqrt(2)) * (w * h / r - (2 - 4 / math.pi) * (w + h))
    one_sided = 1.5 * math.pi
    return {
        "vertical_hop": one_sided / math.sqrt(8) * (h + (4 * h / w - 2) * r),
        "horizontal_hop": one_sided / math.sqrt(8) * (w + (4 * w / h - 2) * r),
        "right_wall": one_sided * (w - 2 * r),
        "top_wall": one_sided * (h - 2 * r),
        "any_wall": one_sided / 4 * (w * h - 2 * r * (w * w + h * h) / (w + h)) / (w + h),
    }[event]


def threshold_time(scene, event):
    """Return the leading law of a mean time where its event dies out; None where it is impossible.

    A hop that becomes blocked before the discs jam gets rare like (w/4 − r)⁻² (vertical) or
    (h/4 − r)⁻² (horizontal). All other times follow from the room left below the largest radius
    r_max: they vanish like r_max − r, except that if one side is more than twice the other those of
    disc collisions and of the walls at the far ends stay finite. Raises ``ValueError`` for anything
    that is not a plain ``Scene`` or one of ``scene.EVENTS``.
    """
    w, h, r = _plain(scene).width, scene.height, scene.radius
    if not scene.is_possible(event):
        return None
    one_sided = 1.5 * math.pi
    if event in HOPS:
        along, across = (w, h) if event == "vertical_hop" else (h, w)
        arc = _Arc.of(Scene(along, across, r))
        if along >= 2 * across:  # open to the end
            return one_sided / math.sqrt(8) * arc.range_y
        critical = volume(Scene(along, across, along / 4))
        return one_sided / math.sqrt(8) * critical / ((across - along / 2) * arc.beyond_x**2)
    if h > w:
        return threshold_time(Scene(h, w, r), TURNED.get(event, event))

    arc = _Arc.of(scene)
    if w >= 2 * h:
        # The arc is straight on the scale of the room left: V = x² y², x = A − σ, y = B.
        x, y = arc.beyond_x, arc.range_y
        times = {
            "disc_collision": x / math.sqrt(8),
            "right_wall": x / 2,
            "top_wall": y,
            "any_wall": x * y / (x + y) / 4,
        }
    else:
        # Between the arc and the far corner a triangle is left: V ∝ S⁴/(AB)² and its derivatives,
        # with S = A² + B² − σ² = 4 (r_max − r)(r₊ − r) and 2 (r₊ − r_max) = 2 √(2wh).
        range_x, range_y, sigma = arc.exact
        root = math.sqrt(2 * w * h)
        left = float(range_x**2 + range_y**2 - sigma**2) / (2 * (w + h + root - 2 * r))
        last_x, last_y = root - h, w * (2 * h - w) / (root + w)
        times = {
            "disc_collision": root * left / (math.sqrt(8) * (w + h - root)),
            "right_wall": root * left / (2 * last_x),
            "top_wall": root * left / (2 * last_y),
            "any_wall": root * left / (4 * (last_x + last_y)),
        }
    return one_sided * times[event]


# Distributions of the times ----------------------------------------------------------------------


def density_at_zero(scene, hop):
    """Return the density at 0⁺ of the interval between hops of one kind, in 1/time.

    It is None where the hop is blocked.

    An interval t → 0 is a hop, one bounce and the hop back. At a vertical hop both centres are at a
    distance d from the wall that their mean y moves to, uniform on [0, B] and independent of the
    velocities. The disc that is ahead bounces, and they meet again after t = 2d/|v1 + v2|, so that
    the density of t at 0 is the mean of |v1 + v2|/(2B), weighted by the flux ∝ |v1 − v2|. The
    components n, m = (v1 ∓ v2)/√2 are uniform in the unit disc, so that ⟨|n m|⟩/⟨|n|⟩ is
    (1/2π)/(4/3π) and

        p(0⁺) = 3√2/(16 B) for vertical hops, 3√2/(16 A) for horizontal ones.

    No other way back is as short: a collision of the discs only drives them further to the sides to
    which they hopped. Raises ``ValueError`` for anything that is not a plain ``Scene`` or
    one of ``scene.HOPS``.
    """
    one_of("hop", hop, HOPS)
    if not _plain(scene).is_possible(hop):
        return None
    side = scene.range_y if hop == "vertical_hop" else scene.range_x
    return 3 * math.sqrt(2) / (16 * side)


def tail_constant(scene, event):
    """Return C of the tail P(T > t) → C/t³ of the time between events, in time³.

    ``event`` is a disc collision or a hop. C is 0.0 where no neutral motion is left, and the tail
    falls faster than any power as far as is known; it is None where the event is impossible.

    Discs that move along x but for slow drifts v1, v2 pass clear of each other as long as
    |y1 − y2| ≥ σ. With wall hits unfolded, the slacks between discs and walls move on a straight
    line in the square |p| + |q| ≤ B − σ, and do not leave it within t for a drift in an area
    2 (B − σ)²/t². For both orders of the discs, a density 1/π of (v1, v2) at 0 and likewise along y
    the invariant measure has

        P(no collision within t) → 2 [A² (B − σ)₊⁴ + B² (A − σ)₊⁴] / (π V t²),

    and Palm's relation P(T > t) = −τ d/dt P(none within t) gives

        C = 6 [A² (B − σ)₊⁴ + B² (A − σ)₊⁴] / A_coll,    3 A² (B − σ)₊⁴ / A_hop,v,

    and A ↔ B for horizontal hops: a vertical hop is avoided by drifting motions along x only.

    Proved is, for collisions, that P(none within t) is at least this to leading order, and that no
    other family of directions of two or more dimensions avoids them: with wall hits unfolded
    flights are straight lines on a torus of four dimensions, on which the centres coincide on the
    four planes x1 = ±x2, y1 = ±y2; a plane of directions that is transversal to one of these meets
    it, and only (u1, u2) and (v1, v2) are transversal to none. Argued, not proved, is that what is
    left (neighbourhoods of periodic motions, of the order t⁻³ each in P(none within t)) adds up to
    less, and, for hops, that what comes before and after the drift, with disc collisions, is
    forgotten exponentially fast. Raises ``ValueError`` for anything that is not a plain ``Scene``,
    and for a wall.
    """
    one_of("event", event, (*HOPS, "disc_collision"))
    arc, area = _Arc.of(_plain(scene)), areas(scene)[event]
    if not scene.is_possible(event):
        return None
    along_x = arc.range_x**2 * arc.beyond_y**4
    along_y = arc.range_y**2 * arc.beyond_x**4
    motions = {
        "disc_collision": 6 * (along_x + along_y),
        "vertical_hop": 3 * along_x,
        "horizontal_hop": 3 * along_y,
    }
    return motions[event] / area
