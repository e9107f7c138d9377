"""Volume, areas and mean times to fifty digits, by quadrature from their definitions.

Tests compare all exact values with these. They are slow, made of mpmath numbers, independent of
``twodiscs.theory``. The integrals depend only on the separations u = |x1 − x2| in [0, A] and
v = |y1 − y2| in [0, B], or on x = u/√2 and y = v/√2, whose quadrant the source divides into parts.
"""

from functools import cache, wraps
from typing import NamedTuple

from mpmath import mp, mpf

from twodiscs.model.events import EVENT_AXES, EVENT_WAYS, EVENTS, WALLS, by_kind

#: Working digits.
DIGITS = 60


class MpScene(NamedTuple):
    """A plain scene in mpmath numbers: width and height of the box, radius of the discs."""

    w: mpf
    h: mpf
    r: mpf

    @classmethod
    def of(cls, width, height, radius):
        """Return the scene of three numbers, without rounding."""
        return cls(mpf(width), mpf(height), mpf(radius))

    @property
    def a(self):
        """Half the range of the centres along x."""
        return self.w / 2 - self.r

    @property
    def b(self):
        """Half the range of the centres along y."""
        return self.h / 2 - self.r

    @property
    def alpha(self):
        """The angle at which the arc u² + v² = (2r)² leaves the quadrant of separations."""
        return mp.asin(min(self.b / self.r, mpf(1)))

    @property
    def beta(self):
        """The angle at which it enters."""
        return mp.acos(min(self.a / self.r, mpf(1)))

    @property
    def upper(self):
        """√(r² − b²), or 0 if r < b."""
        return mp.sqrt(max(self.r**2 - self.b**2, mpf(0)))

    @property
    def lower(self):
        """√(r² − a²), or 0 if r < a."""
        return mp.sqrt(max(self.r**2 - self.a**2, mpf(0)))

    def weight(self, x, y):
        """The ranges of X and Y at the separations x and y, both positive, over 4."""
        return (self.a * mp.sqrt(2) - x) * (self.b * mp.sqrt(2) - y)


# Quadrature ---------------------------------------------------------------------------------------


def line(f, start, stop):
    """Return ∫ f for a polynomial f of degree 5 at most."""
    middle, half = (start + stop) / 2, (stop - start) / 2
    shift = half * mp.sqrt(mpf(3) / 5)
    return half * (5 * (f(middle - shift) + f(middle + shift)) + 8 * f(middle)) / 9


def smooth(f, start, stop):
    """Return ∫ f for an f without singularities."""
    return mp.quad(f, [start, stop], method="gauss-legendre")


def rectangle(f, x_end, y_end):
    """Return ∬ f(x, y) over [0, x_end] × [0, y_end]; f is a polynomial as for ``line``."""
    return line(lambda x: line(lambda y: f(x, y), mpf(0), y_end), mpf(0), x_end)


def inside(f, x_end, y_end, rho):
    """Return ∬ f(x, y) over the part of [0, x_end] × [0, y_end] with x² + y² < rho²."""
    flat = min(mp.sqrt(max(rho**2 - y_end**2, mpf(0))), x_end)

    def strip(t):
        x, y = rho * mp.sin(t), rho * mp.cos(t)
        return y * line(lambda v: f(x, v), mpf(0), y)

    arc = smooth(strip, mp.asin(flat / rho), mp.asin(min(x_end / rho, mpf(1))))
    return rectangle(f, flat, y_end) + arc


def outside(f, x_end, y_end, rho):
    """Return ∬ f(x, y) over the part of [0, x_end] × [0, y_end] with x² + y² ≥ rho²."""
    return rectangle(f, x_end, y_end) - inside(f, x_end, y_end, rho)


def circle_integral(q, f):
    """Return ∬ f(x, y) δ(√(x² + y²) − √2 r) over [0, √2 a] × [0, √2 b], along x and along y."""
    rho = mp.sqrt(2) * q.r
    middle = min(max(mp.pi / 4, q.beta), q.alpha)
    # Over x on the flat part of the circle, over y on the steep part.
    flat = smooth(
        lambda x: f(x, mp.sqrt(rho**2 - x * x)) * rho / mp.sqrt(rho**2 - x * x),
        rho * mp.cos(q.alpha),
        rho * mp.cos(middle),
    )
    steep = smooth(
        lambda y: f(mp.sqrt(rho**2 - y * y), y) * rho / mp.sqrt(rho**2 - y * y),
        rho * mp.sin(q.beta),
        rho * mp.sin(middle),
    )
    return flat + steep


def _triangle(f, x_end, y_end):
    """Return ∬ f(x, y) over the triangle (0, 0), (0, y_end), (x_end, y_end), x last."""
    return line(lambda x: line(lambda y: f(x, y), x * y_end / x_end, y_end), mpf(0), x_end)


def _exact(function):
    """Decorate a function of a ``MpScene``: it has ``DIGITS`` digits and a cache."""

    @cache
    @wraps(function)
    def found(q):
        with mp.workdps(DIGITS):
            return function(q)

    return found


# Volume and areas ---------------------------------------------------------------------------------


def _profile(x_range, y_range, contact, weight, power):
    """Return ∫ weight(u) (B − k)₊^power du over [0, A], k = √(σ² − u²)₊, A and B the ranges.

    For u < σ the variable is φ in u = σ sin φ, in which there is no root.
    """
    start = mp.acos(min(y_range / contact, mpf(1)))
    stop = mp.asin(min(x_range / contact, mpf(1)))

    def strip(phi):
        u, k = contact * mp.sin(phi), contact * mp.cos(phi)
        return weight(u) * (y_range - k) ** power * k

    total = smooth(strip, start, stop)
    if x_range > contact:
        total += y_range**power * line(weight, contact, x_range)
    return total


def volume_by_separations(x_range, y_range, contact):
    """Return 4 ∬ (A − u)(B − v) over u² + v² ≥ σ² in [0, A] × [0, B], v first."""
    return 2 * _profile(x_range, y_range, contact, lambda u: x_range - u, 2)


@_exact
def volume(q):
    """The volume of configuration space."""
    return volume_by_separations(2 * q.a, 2 * q.b, 2 * q.r)


@_exact
def vertical_hop_area(q):
    """The area of y1 = y2, which covers a square of x1 and x2, and √2 times the range of y1."""
    return mp.sqrt(2) * 2 * q.b * max(2 * q.a - 2 * q.r, mpf(0)) ** 2


@_exact
def horizontal_hop_area(q):
    """The area of x1 = x2."""
    return vertical_hop_area(MpScene(q.h, q.w, q.r))


@_exact
def disc_collision_area(q):
    """The area of the surface of contact, along the arc σ (cos θ, sin θ)."""
    contact = 2 * q.r

    def ray(theta):
        return (2 * q.a - contact * mp.cos(theta)) * (2 * q.b - contact * mp.sin(theta))

    return 4 * mp.sqrt(2) * contact * smooth(ray, q.beta, q.alpha)


@_exact
def right_wall_area(q):
    """The area of x1 = a, over all separations u and v of disc 2."""
    return _profile(2 * q.a, 2 * q.b, 2 * q.r, lambda u: mpf(1), 2)


@_exact
def top_wall_area(q):
    """The area of y1 = b."""
    return right_wall_area(MpScene(q.h, q.w, q.r))


@_exact
def any_wall_area(q):
    """The area of all walls, for both discs."""
    return 4 * (right_wall_area(q) + top_wall_area(q))


AREAS = by_kind(
    "twodiscs_paper/reference.py",
    {
        "hop": lambda event: vertical_hop_area if event.axis == "y" else horizontal_hop_area,
        "collision": lambda event: disc_collision_area,
        "wall": lambda event: right_wall_area if event.axis == "x" else top_wall_area,
        "walls": lambda event: any_wall_area,
    },
)


def contact_density(q):
    """∫ δ(u² + v² − 4r²) over the prism, minus the derivative of V by 4r² at fixed A and B."""
    return -mp.diff(
        lambda square: volume_by_separations(2 * q.a, 2 * q.b, mp.sqrt(square)), 4 * q.r**2
    )


def largest_radius(q):
    """The radius at which the discs jam along a diagonal, as a root."""
    return mp.findroot(
        lambda r: (q.w - 2 * r) ** 2 + (q.h - 2 * r) ** 2 - 4 * r**2, min(q.w, q.h) / 3
    )


# Mean times ---------------------------------------------------------------------------------------


def sphere(d):
    """The area of the unit sphere in d ≥ 2 dimensions, as an integral over circles."""
    area = 2 * mp.pi
    for power in range(1, d - 1):
        area *= mp.quad(lambda t, power=power: mp.sin(t) ** power, [0, mp.pi])
    return area


@cache
def normal_speed():
    """The mean of the positive part of one component of a unit vector in four dimensions."""
    with mp.workdps(DIGITS):
        flux = mp.quad(lambda t: mp.cos(t) * mp.sin(t) ** 2, [0, mp.pi / 2])
        return flux / mp.quad(lambda t: mp.sin(t) ** 2, [0, mp.pi])


def mean_time(event, q):
    """The mean time between events: the volume of the states that can have them, over the flux.

    If a hop is blocked, disc 1 reaches a given wall in one of two parts that mirror each other.
    """
    blocked = horizontal_hop_area if EVENT_AXES.get(event) == "x" else vertical_hop_area
    parts = 2 if event in WALLS and blocked(q) == 0 else 1
    return volume(q) / (parts * EVENT_WAYS[event] * AREAS[event](q) * normal_speed())


#: The quantities of tables, as functions of a ``MpScene``.
QUANTITIES = {
    "volume": volume,
    **{f"{event}_area": area for event, area in AREAS.items()},
    **{f"{event}_time": _exact(lambda q, event=event: mean_time(event, q)) for event in EVENTS},
}


def exact_numbers(scene):
    """Return ({"volume": V}, {event: area}, {event: mean time}) of a plain ``Scene``.

    Each has fifty digits, for exactly the doubles of the scene; impossible events have no mean
    time.
    """
    q = MpScene.of(scene.width, scene.height, scene.radius)
    areas = {event: area(q) for event, area in AREAS.items()}
    times = {event: QUANTITIES[f"{event}_time"](q) for event, area in areas.items() if area}
    return {"volume": volume(q)}, areas, times


# Parts of volume and areas, as the appendix of the source divides the quadrant --------------------


def _upper(q, f):
    """Return ∬ f beyond the end of the arc at y = √2 b, between the y axis and the ray to it."""
    root = mp.sqrt(2)
    return _triangle(f, root * q.upper, root * q.b) if q.upper else mpf(0)


def _lower(q, f):
    """Return ∬ f beyond the end of the arc at x = √2 a, between the x axis and the ray to it."""
    root = mp.sqrt(2)
    return _triangle(lambda y, x: f(x, y), root * q.lower, root * q.a) if q.lower else mpf(0)


def excluded_volume(q):
    """Return the volume of the prism in which the discs overlap."""
    return (4 * q.a * q.b) ** 2 - volume(q)


def upper_volume(q):
    """Its part in the upper triangle."""
    return 16 * _upper(q, q.weight)


def lower_volume(q):
    """Its part in the lower triangle."""
    return 16 * _lower(q, q.weight)


def sector_volume(q):
    """Its part in the sector of the circle."""
    return excluded_volume(q) - upper_volume(q) - lower_volume(q)


def _wall_weight(q):
    return lambda x, y: 4 * mp.sqrt(2) * (mp.sqrt(2) * q.b - y)


def whole_wall(q):
    """The area of x1 = a if the discs could overlap."""
    return rectangle(_wall_weight(q), mp.sqrt(2) * q.a, mp.sqrt(2) * q.b)


def upper_wall(q):
    """Return the part of it in the upper triangle."""
    return _upper(q, _wall_weight(q))


def lower_wall(q):
    """Return the part of it in the lower triangle."""
    return _lower(q, _wall_weight(q))


def sector_wall(q):
    """Return the part of it in the sector of the circle."""
    return whole_wall(q) - right_wall_area(q) - upper_wall(q) - lower_wall(q)


def beside_volume(q):
    """The part of a sixteenth of the volume with x < √2 r."""
    return outside(q.weight, mp.sqrt(2) * q.r, mp.sqrt(2) * q.b, mp.sqrt(2) * q.r)


def volume_beyond_contact(q):
    """The part of a sixteenth of the volume with x > √2 r."""
    a, b, r = (mp.sqrt(2) * x for x in (q.a, q.b, q.r))
    return rectangle(q.weight, a, b) - rectangle(q.weight, r, b)
