"""The scene: two equal hard discs in a rectangular box, and the geometry that follows from it.

Coordinates have their origin at the centre of the box. Lengths are in the unit of the box, masses
are one and the total energy is 1/2, so that v1² + v2² = 1 and times are lengths over a speed of
one.
"""

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

#: The events whose mean time is known exactly, in the order of every table.
EVENTS = (
    "vertical_hop",
    "horizontal_hop",
    "disc_collision",
    "right_wall",
    "top_wall",
    "any_wall",
)

#: The two events at which the discs exchange sides; their surfaces can be crossed from both sides.
HOPS = ("vertical_hop", "horizontal_hop")

#: What is open to the discs, named by the hops that remain.
REGIMES = ("all-hops", "vertical-hops", "horizontal-hops", "no-hops")

#: Lengths outside this range would overflow or underflow when multiplied four at a time.
SHORTEST, LONGEST = 1e-60, 1e60


def length(name, value):
    """Return ``value`` as a float, or raise ``ValueError`` naming ``name`` if it is no length.

    A length is a real number, finite and positive, between 1e-60 and 1e60.
    """
    if isinstance(value, bool | str | bytes) or not hasattr(value, "__float__"):
        raise ValueError(f"{name} must be a positive number, not {value!r}")
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name} must be a positive number, not {value!r}") from None
    if not math.isfinite(number) or number <= 0:
        raise ValueError(f"{name} must be a positive, finite number, not {number!r}")
    if not SHORTEST <= number <= LONGEST:
        raise ValueError(f"{name} must lie between {SHORTEST!r} and {LONGEST!r}, not {number!r}")
    return number


def largest_radius(width, height):
    """Return the radius at which two equal discs just fit in a ``width`` × ``height`` box.

    For max < 2 min the discs jam along a diagonal, (w + h − √(2wh))/2; otherwise each of them spans
    the short side, min/2. Raises ``ValueError`` for anything that is not a length.
    """
    width, height = length("width", width), length("height", height)
    short, long = min(width, height), max(width, height)
    if long >= 2 * short:
        return short / 2
    return (width + height - math.sqrt(2 * width) * math.sqrt(height)) / 2


def fits(width, height, radius):
    """Say, in exact arithmetic on the given doubles, whether two discs have room to move.

    Raises ``ValueError`` for anything that is not a length.
    """
    w, h = Fraction(length("width", width)), Fraction(length("height", height))
    r = Fraction(length("radius", radius))
    range_x, range_y = w - 2 * r, h - 2 * r
    return range_x > 0 and range_y > 0 and range_x**2 + range_y**2 > 4 * r**2


@dataclass(frozen=True)
class Scene:
    """Two hard discs of radius ``radius`` in a box of ``width`` × ``height``.

    Raises ``ValueError`` for a length that is not finite and positive, and for a radius that leaves
    the discs no room.
    """

    width: float
    height: float
    radius: float

    def __post_init__(self):
        for name in ("width", "height", "radius"):
            object.__setattr__(self, name, length(name, getattr(self, name)))
        largest = largest_radius(self.width, self.height)
        if not fits(self.width, self.height, self.radius):
            raise ValueError(
                f"radius {self.radius!r} does not fit: two discs in a box of {self.width!r} × "
                f"{self.height!r} need a radius below {largest!r}"
            )

    def with_radius(self, radius):
        """Return the same scene with discs of another radius."""
        return replace(self, radius=radius)

    @cached_property
    def range_x(self):
        """A = w − 2r: the length that a centre can cover along x."""
        return self.width - 2 * self.radius

    @cached_property
    def range_y(self):
        """B = h − 2r: the length that a centre can cover along y."""
        return self.height - 2 * self.radius

    @cached_property
    def contact_distance(self):
        """σ = 2r: the distance of the centres when the discs touch."""
        return 2 * self.radius

    @cached_property
    def largest_radius(self):
        """The radius at which the discs have no room left."""
        return largest_radius(self.width, self.height)

    @cached_property
    def vertical_hops(self):
        """Whether the discs can pass each other on y1 = y2, which takes w > 4r."""
        return self.width > 4 * self.radius

    @cached_property
    def horizontal_hops(self):
        """Whether the discs can pass each other on x1 = x2, which takes h > 4r."""
        return self.height > 4 * self.radius

    @cached_property
    def regime(self):
        """One of ``REGIMES``."""
        if self.vertical_hops and self.horizontal_hops:
            return "all-hops"
        if self.vertical_hops:
            return "vertical-hops"
        return "horizontal-hops" if self.horizontal_hops else "no-hops"

    @cached_property
    def ergodic_components(self):
        """The number of disjoint parts of configuration space: each blocked hop doubles it."""
        return 2 ** ((not self.vertical_hops) + (not self.horizontal_hops))

    def is_possible(self, event):
        """Say whether ``event`` ever happens; only a hop can be blocked."""
        if event not in EVENTS:
            raise ValueError(f"event must be one of {', '.join(EVENTS)}, not {event!r}")
        return {
            "vertical_hop": self.vertical_hops,
            "horizontal_hop": self.horizontal_hops,
        }.get(event, True)
