"""N equal, smooth discs in a rectangular box: their number, their geometry and their events.

Units and coordinates are those of ``model.scene``: mass one, total energy 1/2, the origin at the
centre of the box. What two discs have in a ``Scene`` has the same name here.

Events are classes: ``disc_collision`` of any pair, ``vertical_hop`` (y_i = y_j) and
``horizontal_hop`` (x_i = x_j) of any pair, and the walls, of which all hits of an axis are counted
together: 2N pairs of a disc and a wall share the rate of ``right_wall``, as many that of
``top_wall``.
"""

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, cached_property

from twodiscs.model.checks import MOST_DISCS, InputError, check_integer, check_length, quote

#: Classes of events, in the order of all counts.
CLASSES = ("vertical_hop", "horizontal_hop", "disc_collision", "right_wall", "top_wall")


@dataclass(frozen=True)
class Gas:
    """``discs`` equal discs of ``radius`` in a box of ``width`` × ``height``.

    ``periodic`` is "" or "x": then the box is a ring of circumference ``width`` along x, its total
    momentum along x is zero, and the discs fit beside each other twice.

    Raises ``InputError`` for a number of discs that is not an integer from 2 to 64, for a
    side or radius that is no length, for another periodic axis, and for a radius at which no
    arrangement of so many discs is known here.
    """

    discs: int
    width: float
    height: float
    radius: float
    periodic: str = ""

    def __post_init__(self):
        object.__setattr__(self, "discs", check_integer("discs", self.discs, 2, MOST_DISCS))
        for name in ("width", "height", "radius"):
            object.__setattr__(self, name, check_length(name, getattr(self, name)))
        if self.periodic not in ("", "x"):
            raise InputError(
                f"periodic must be left out or x for more than two discs, not "
                f"{quote(self.periodic)}"
            )
        if self.radius >= self.largest_radius:
            raise InputError(
                f"radius {self.radius!r} does not fit: {self.discs} discs in a box of "
                f"{self.width!r} × {self.height!r} need a radius below {self.largest_radius!r}, as "
                "far as arrangements are known here"
            )

    @cached_property
    def range_x(self):
        """A = w − 2r, the range of a centre between walls; w on a ring."""
        return self.width if self.periodic else float(self.exact_range_x)

    @cached_property
    def range_y(self):
        """B = h − 2r, the range of a centre."""
        return float(self.exact_range_y)

    @property
    def exact_range_x(self):
        """w − 2r without rounding."""
        return Fraction(self.width) - 2 * Fraction(self.radius)

    @property
    def exact_range_y(self):
        """h − 2r without rounding."""
        return Fraction(self.height) - 2 * Fraction(self.radius)

    @cached_property
    def contact_distance(self):
        """σ = 2r."""
        return 2 * self.radius

    @cached_property
    def velocity_components(self):
        """D: the components of all velocities, less a momentum that is conserved."""
        return 2 * self.discs - len(self.periodic)

    @cached_property
    def is_ordered(self):
        """Whether the discs keep their order along x and only neighbours can touch.

        That is so between walls if h ≤ (2 + √3) r: discs with one between them are then at least
        2√(σ² − B²) ≥ σ apart.
        """
        return not self.periodic and self.height <= (2 + math.sqrt(3)) * self.radius

    @cached_property
    def ergodic_components(self):
        """The number of disjoint parts of configuration space; None where it is not known here.

        Where all discs fit side by side along an axis, they can always be drawn apart along it:
        places that go linearly, in their order, to σ or more from neighbour to neighbour never come
        nearer to each other than √(σ² − Δ²), Δ what the pair is apart along the other axis. Then
        neighbours can be exchanged if that other axis has more room than σ, and all is one part.
        Else there is one for each order, N! of them, on a ring (N − 1)! up to a cyclic shift. In an
        ordered channel too short for that the heights have parts of their own (``_zigzags``).
        """
        n, sigma = self.discs, 2 * Fraction(self.radius)
        ring, a, b = bool(self.periodic), self.exact_range_x, self.exact_range_y
        if Fraction(self.width) > n * sigma if ring else a > (n - 1) * sigma:
            return 1 if b > sigma else math.factorial(n - ring)
        if b > (n - 1) * sigma:
            return 1 if ring or a > sigma else math.factorial(n)
        if self.is_ordered:
            return math.factorial(n) * self._zigzags()
        return None if ring or not self.turned().is_ordered else self.turned().ergodic_components

    def _zigzags(self):
        """Return how many disjoint parts the heights of one order have in an ordered channel.

        They are y in [0, B]^N with Σ d < A, d = √(σ² − Δ²) of neighbours. Each d is concave: so
        each part has a corner of that cube, and two corners are in one part if a path along edges
        joins them, for what is cut out is convex. At a corner k neighbours are level, with d = σ,
        and all others d₀ = √(σ² − B²) apart. A level pair comes and goes at the ends of the row,
        or with one next to it; it moves by one disc where A allows for two pairs halfway,
        2 √(σ² − B²/4).
        """
        n, sigma, a = self.discs, self.contact_distance, self.range_x
        least = math.sqrt((sigma - self.range_y) * (sigma + self.range_y))
        most = max(k for k in range(n) if k == 0 or k * sigma + (n - 1 - k) * least < a)
        if most == 0:
            return 2
        midway = 2 * math.sqrt(sigma**2 - self.range_y**2 / 4)
        if most == n - 1 or (most - 1) * sigma + (n - 2 - most) * least + midway < a:
            return 1
        # The others stay where they are: neither at an end nor next to each other.
        return (2 if most == 1 else 1) + 2 * math.comb(n - 2 - most, most)

    def can_be_level(self, axis):
        """Say whether geometry lets two discs be level along ``axis``, "x" or "y", with a third.

        Two that are level along y are σ apart at least along x, and a third one keeps σ from both:
        it is best off at the other wall of y, in the middle between them or beside them. So this is
        exact for three discs. Of two it is asked of themselves alone, and what it does not exclude
        for more than three may still be impossible.
        """
        along, across = self.range_x, self.range_y
        if axis == "x":
            along, across = across, along
        ring = bool(self.periodic) and axis == "y"
        sigma = self.contact_distance
        if along <= (2 * sigma if ring else sigma):
            return False
        beside = (along - sigma) / 2 if ring else max(along / 2, along - sigma)
        return self.discs == 2 or math.hypot(beside, across) > sigma

    def turned(self):
        """Return the same discs in the box turned by a quarter; only between walls."""
        if self.periodic:
            raise InputError("a box with a periodic axis cannot be turned")
        return Gas(self.discs, self.height, self.width, self.radius)

    def multiplicity(self, event):
        """Return how many events with equal rates the class of ``event`` counts together."""
        return 2 * self.discs if event.endswith("wall") else 1

    @cached_property
    def largest_radius(self):
        """The largest radius at which an arrangement of the discs is known here.

        Of two and of three discs between walls, and of any number in an ordered channel, there is
        none at a larger one.
        """
        return largest_radius(self.discs, self.width, self.height, self.periodic)

    @cached_property
    def arrangement(self):
        """Centres [(x, y), …] of a state without overlap, as far apart as is known here."""
        half_x = self.range_x / 2
        centres, _ = arranged(self.discs, self.range_x, self.range_y, self.periodic)
        return [(x - half_x, y - self.range_y / 2) for x, y in centres]


# Arrangements ------------------------------------------------------------------------------------


def _patterns(n, along, across, ring):
    """Yield (least distance, rows, discs a row, shift, fewer, spacing) of rows of ``n`` discs.

    Rows stand in line, or are shifted in turns by half a spacing; then every other one may have a
    disc less.
    """
    for rows in range(1, n + 1):
        v = across / (rows - 1) if rows > 1 else math.inf
        least = -(-n // rows)
        for count in (least, least + 1):
            for shift, fewer in ((0.0, 0), (0.5, 0), (0.5, 1)):
                if count * rows - fewer * (rows // 2) < n or (ring and fewer):
                    continue
                steps = count if ring else count - 1 + (0.0 if fewer else shift)
                s = along / steps if steps > 0 else 0.0
                # On a ring the only disc of a row is its own neighbour, which is no contact.
                in_row = s if count > 1 else math.inf
                two_on = 2 * v if shift else math.inf
                yield min(in_row, math.hypot(shift * s, v), two_on), rows, count, shift, fewer, s


def _rows(n, along, across, ring):
    """Return (least distance, centres) of the best of ``_patterns``."""
    best = max(_patterns(n, along, across, ring))
    least, rows, count, shift, fewer, s = best
    v = across / (rows - 1) if rows > 1 else 0.0
    centres = [
        ((i + shift * (row % 2)) * s, row * v)
        for row in range(rows)
        for i in range(count - fewer * (row % 2))
    ]
    return least, centres[:n]


def _largest_triangle(a, b):
    """Return (corners, side) of the largest equilateral triangle in a × b, b ≤ a ≤ 2b/√3."""
    # One corner at (0, 0), one on x = a, one on y = b: a = s cos θ, b = s cos(π/6 − θ).
    side = 2 * math.sqrt(max(a * a + b * b - math.sqrt(3) * a * b, 0.0))
    low = math.sqrt(max(side * side - a * a, 0.0))
    high = math.sqrt(max(side * side - b * b, 0.0))
    return [(0.0, 0.0), (a, low), (high, b)], side


def arranged(discs, a, b, periodic=""):
    """Return (centres in [0, ``a``] × [0, ``b``], their least distance), the best known here.

    Of rows in line and staggered ones along either axis, and for three discs the largest triangle,
    which is the best of all.
    """
    least, centres = _rows(discs, a, b, bool(periodic))
    if not periodic:
        other, turned = _rows(discs, b, a, False)
        if other > least:
            least, centres = other, [(x, y) for y, x in turned]
    if discs == 3 and not periodic and min(a, b) > max(a, b) * math.sqrt(3) / 2:
        corners, side = _largest_triangle(max(a, b), min(a, b))
        if side > least:
            least, centres = side, corners if a >= b else [(x, y) for y, x in corners]
    return centres, least


@cache
def largest_radius(discs, width, height, periodic=""):
    """Return the largest radius of which ``arranged`` knows centres at least 2r apart.

    Bisection, to the last digit. On a ring it is at most a quarter of the circumference.
    """
    low, high = 0.0, min(width, height) / 2
    if periodic:
        high = min(width / 4, height / 2)
    for _ in range(80):
        radius = (low + high) / 2
        across = height - 2 * radius
        along = width if periodic else width - 2 * radius
        fits = across >= 0 and along >= 0
        fits = fits and arranged(discs, along, across, periodic)[1] >= 2 * radius
        low, high = (radius, high) if fits else (low, radius)
    return low
