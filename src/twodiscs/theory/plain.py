"""Volume, areas and shells of two equal discs between walls, for every radius.

The integrals depend only on the separations u = |x1 − x2| and v = |y1 − y2|. They are in
[0, A] × [0, B] with the density 4 (A − u)(B − v), outside the arc (u, v) = σ (cos θ, sin θ). The
volume of configuration space and the areas of the surfaces of events are

    V       = 4 ∬ (A − u)(B − v) 1[u² + v² ≥ σ²] du dv
    A_coll  = −√2 ∂V/∂σ         A_right = ½ ∂V/∂A           A_top = ½ ∂V/∂B
    A_hop,v = √2 B (A − σ)₊²    A_hop,h = √2 A (B − σ)₊²    A_walls = 4 (A_right + A_top)

The powers and inverse sines of closed forms cancel near the largest radius, and no digit is left.
Here volume and areas are integrals over the arc of products of A − σ cos θ and B − σ sin θ.
Both factors, and therefore volume and areas, are sums of positive terms. Every length, angle and
difference that cancels is computed from exact fractions of the given doubles and rounded once.
"""

import math
from fractions import Fraction
from functools import lru_cache

from twodiscs.model.events import EVENT_WAYS, SHELL_EVENTS, by_kind
from twodiscs.theory.quadrature import gauss_legendre

#: The integrands are trigonometric polynomials of degree 4 at most over a quarter turn, or equally
#: smooth: sixteen nodes are exact to rounding.
ARC_RULE = gauss_legendre(16)

#: Exact for cubics.
CUBIC_RULE = gauss_legendre(2)


class Arc:
    """The arc u² + v² = σ² within [0, A] × [0, B], for exact A, B, σ > 0.

    A point on it is given by its squared abscissa u², an exact fraction, which falls from ``start``
    (at the angle β) to ``stop`` (at α) as θ grows. If A² + B² ≤ σ², the arc is empty.
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
        return Arc(range_y, range_x, sigma)

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
        for t, rest, weight in ARC_RULE:
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


def arc_integrals(arc):
    """Return (volume, areas of disc collisions, of the right wall, of the top wall) of an arc."""
    volume, disc = arc.range_x**2 * arc.beyond_y**2, 0.0
    right, top = arc.range_x * arc.beyond_y**2, arc.range_y * arc.beyond_x**2
    for weight, x, y, cos, sin in arc.nodes(arc.start, arc.stop):
        area = 2 * weight * x * y
        disc += area
        volume += area * x * cos
        right += area * cos
        top += area * sin
    return volume, 2 * math.sqrt(2) * disc, right, top


@lru_cache(maxsize=1024)
def volume_and_areas(scene):
    """Return (volume, {event: area}) of a plain ``Scene``, in length⁴ and length³."""
    arc = Arc.of(scene)
    volume, disc, right, top = arc_integrals(arc)
    surfaces = {
        "hop": lambda event: hop_area(arc if event.axis == "y" else arc.turned()),
        "collision": lambda event: disc,
        "wall": lambda event: right if event.axis == "x" else top,
        "walls": lambda event: 4 * (right + top),
    }
    return volume, by_kind("theory/plain.py", surfaces)


def hop_area(arc):
    """Return the area of y1 = y2, √2 B (A − σ)₊², or of x1 = x2 for the arc ``turned``."""
    return math.sqrt(2) * arc.range_y * arc.beyond_x**2


# Shells -----------------------------------------------------------------------------------------


def _hop_shell(arc, epsilon):
    """Return the volume with v ≤ √2 ε, over 2ε."""
    end = max(arc.stop, arc.square - 2 * Fraction(epsilon) ** 2)
    total = sum(w * x * x * y * cos for w, x, y, cos, _ in arc.nodes(arc.start, end))
    return total / epsilon


def _wall_shell(arc, epsilon):
    """Return the volume with x1 ≥ a − ε, over ε.

    With x1 = a − g it is the mean over g of ∫ W over [−g, A − g], with W(u) = (B − √(σ² − u²)₊)₊².
    Disc 2 on the left gives ∫ W min(1, (A − u)/ε). Disc 2 on the right gives ∫ W (1 − u/ε)₊, which
    is V/(2ε) with ε in place of A.
    """
    range_x, range_y, sigma = arc.exact
    thick = Fraction(epsilon)
    if thick >= range_x:
        volume, *_ = arc_integrals(arc)
        return volume / epsilon
    flat, near = arc.beyond_x, min(max((range_x - thick) ** 2, arc.stop), arc.start)
    total = arc.range_y**2 * (flat**2 / (2 * epsilon) if flat < epsilon else flat - epsilon / 2)
    total += sum(w * y * y * sin * x / epsilon for w, x, y, _, sin in arc.nodes(arc.start, near))
    total += sum(w * y * y * sin for w, _, y, _, sin in arc.nodes(near, arc.stop))
    thin_volume, *_ = arc_integrals(Arc(thick, range_y, sigma))
    return total + thin_volume / (2 * epsilon)


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
        for t, _, share in CUBIC_RULE:
            s = t * ray
            total += weight * share * ray * (1 + s / arc.sigma) * (x - s * cos) * (y - s * sin)
    return 4 * total / epsilon


def _along(axis, shell):
    """Return the function of an ``Event``s arc for a ``shell`` that is that of ``axis``."""
    return lambda event: lambda arc, e: shell(arc if event.axis == axis else arc.turned(), e)


#: {event: expectation of its shell}, functions of an ``Arc`` and of a thickness
SHELL_EXPECTATIONS = by_kind(
    "theory/plain.py",
    {
        "hop": _along("y", _hop_shell),
        "collision": lambda event: _collision_shell,
        "wall": _along("x", _wall_shell),
    },
    SHELL_EVENTS,
)


def shell_expectation(scene, event, epsilon):
    """Return the exact expectation of a shell in a plain ``Scene``, see ``exact``."""
    return SHELL_EXPECTATIONS[event](Arc.of(scene), epsilon)


def volume_near(scene, hop, distance):
    """Return the volume within a ``distance`` of the surface of a ``hop``, see ``exact``."""
    epsilon = distance / math.sqrt(2)
    return 2 * epsilon * shell_expectation(scene, hop, epsilon)


def volume(scene):
    """Return the volume of a ``Scene``, see ``exact``."""
    return volume_and_areas(scene)[0]


def areas(scene):
    """Return {event: area} of a ``Scene``, see ``exact``."""
    return volume_and_areas(scene)[1]


def rate(scene, event):
    """Return the rate of ``event``."""
    volume, areas = volume_and_areas(scene)
    return EVENT_WAYS[event] * areas[event] / (1.5 * math.pi * volume)
