"""The geometry of N equal discs in the plane: between walls, on a ring or on a torus."""

import math
from fractions import Fraction
from functools import cache

from twodiscs.model.checks import MOST_DISCS_WITH_VOLUME, InputError
from twodiscs.model.events import WALLS

#: The effects of more than two discs.
MANY_DISC_EFFECTS = ("periodic", "moment_of_inertia", "friction")

#: From this number of discs on, cells list the discs that may touch. The least side of a cell over
#: σ: it must be longer. Along a periodic axis there are two cells, or more.
CELL_DISCS, LEAST_CELL_SIDE = 20, 1 + 2.0**-20

#: The most decimal digits before or after the point of the volume of the prism: a double then holds
#: the volume, and its square.
MOST_DIGITS = 150


def check_box(box):
    """Raise ``InputError`` for a ``Box`` with an invalid effect."""
    if other := [name for name in box.effects if name not in MANY_DISC_EFFECTS]:
        raise InputError(
            f"{other[0]} must be left out with {box.discs} discs, because more than two discs "
            f"have no effects except {', '.join(MANY_DISC_EFFECTS)}, not {box.effects[other[0]]!r}"
        )


def has_volume(scene):
    """Return whether a double holds the volume of configuration space in the unit of length.

    More than ``MOST_DISCS_WITH_VOLUME`` discs have none, because almost no sample of it has a
    weight.
    """
    digits = scene.discs * math.log10(scene.range_x * scene.range_y)
    return scene.discs <= MOST_DISCS_WITH_VOLUME and abs(digits) <= MOST_DIGITS


def check(scene):
    """Raise ``InputError`` for a ``Scene`` with a radius that does not fit."""
    if scene.radius >= scene.largest_radius:
        raise InputError(
            f"radius {scene.radius!r} does not fit: {scene.discs} discs in a box of "
            f"{scene.width!r} × {scene.height!r} need a radius below {scene.largest_radius!r}, as "
            "far as arrangements are known here"
        )


def largest_radius(scene):
    """Return the largest radius at which an arrangement of the discs is known here."""
    return largest_known_radius(scene.discs, scene.width, scene.height, scene.periodic)


def require_followable(scene):
    """Raise ``InputError`` for ``CELL_DISCS`` discs or more that just fit on a periodic axis."""
    for axis in scene.periodic if scene.discs >= CELL_DISCS else "":
        longest = scene.side(axis) / (4 * LEAST_CELL_SIDE)
        if scene.radius > longest:
            raise InputError(
                f"radius {scene.radius!r} must not exceed {longest!r} for {scene.discs} discs with "
                f"a period of {scene.side(axis)!r} along {axis}, which has to have room for two "
                "cells that hold a disc"
            )


def open_axes(scene):
    """Return the axes with walls along which geometry does not keep the discs from passing."""
    return tuple(axis for axis in scene.walled if can_be_level(scene, axis))


def confined(scene):
    """Return that a wall is reached from everywhere: times are averages over all initial states."""
    return False, False


def copies(scene, event):
    """Return the number of events with the rate of ``event``, see ``Scene``."""
    return 2 * scene.discs if event in WALLS else 1


def is_ordered(scene):
    """Return whether the discs keep their order along x and only neighbours can touch.

    This holds between walls if h ≤ (2 + √3) r: discs with one between them are then at least
    2√(σ² − B²) ≥ σ apart.
    """
    return not scene.periodic and scene.height <= (2 + math.sqrt(3)) * scene.radius


def ergodic_components(scene):
    """Return the number of disjoint parts of configuration space; None if it is not known here.

    If all discs fit side by side along an axis, they can always be drawn apart along it. The
    centres move linearly, in their order, until neighbours are at least σ apart. They are never
    nearer to each other than √(σ² − Δ²), with the separation Δ of the pair along the other axis. If
    the range along the other axis is larger than σ, neighbours can then be exchanged, and there is
    one part. Otherwise each order is a part: there are N!, on a ring (N − 1)! up to a cyclic shift.
    On a torus discs pass each other along both axes, so they can be exchanged in a row.
    In an ordered channel too short for this, the heights of one order also form several parts
    (``_zigzags``).
    """
    n, sigma, ring = scene.discs, 2 * Fraction(scene.radius), bool(scene.periodic)
    if scene.periodic == "xy":
        return 1 if max(map(Fraction, scene.sides)) > n * sigma else None
    if scene.periodic == "y":
        return ergodic_components(scene.turned())
    a, b = Fraction(scene.width) - sigma, Fraction(scene.height) - sigma
    if Fraction(scene.width) > n * sigma if ring else a > (n - 1) * sigma:
        return 1 if b > sigma else math.factorial(n - ring)
    if b > (n - 1) * sigma:
        return 1 if a > sigma else math.factorial(n)
    if is_ordered(scene):
        return math.factorial(n) * _zigzags(scene)
    return None if ring or not is_ordered(scene.turned()) else ergodic_components(scene.turned())


def _zigzags(scene):
    """Return the number of disjoint parts of the heights of one order in an ordered channel.

    The heights are y in [0, B]^N with Σ d < A, d = √(σ² − Δ²) of neighbours. Each d is concave.
    Each part therefore has a corner of this cube. Two corners are in one part if a path along edges
    joins them, because the excluded set is convex. At a corner k pairs of neighbours have the same
    height, with d = σ, and all others d₀ = √(σ² − B²). A pair of the same height appears and
    disappears at the ends of the row, or together with the pair next to it. It moves by one disc if
    A allows for two pairs halfway, 2 √(σ² − B²/4).
    """
    n, sigma, a = scene.discs, scene.contact_distance, scene.range_x
    least = math.sqrt((sigma - scene.range_y) * (sigma + scene.range_y))
    most = max(k for k in range(n - 1) if k == 0 or k * sigma + (n - 1 - k) * least < a)
    if most == 0:
        return 2
    midway = 2 * math.sqrt(sigma**2 - scene.range_y**2 / 4)
    if (most - 1) * sigma + (n - 2 - most) * least + midway < a:
        return 1
    # The other pairs cannot move: they are neither at an end nor next to each other.
    return (2 if most == 1 else 1) + 2 * math.comb(n - 2 - most, most)


def can_be_level(scene, axis):
    """Return whether two discs can have the same ``axis`` coordinate, x or y.

    Two discs with the same y are at least σ apart along x. A third one has the most room at the
    other wall of y, in the middle between them or beside them. It always has enough: of any three
    discs that fit, two are at most half of the range apart along x. The condition is exact for
    three discs. For more it is necessary, not sufficient. On a ring the discs of a row can be level
    up to the last radius.
    """
    return (scene.range_y if axis == "x" else scene.range_x) > scene.contact_distance


def arrangement(scene):
    """Return centres [(x, y), …] without overlap, with the largest distances known here."""
    centres, _ = arranged(scene.discs, scene.range_x, scene.range_y, scene.periodic)
    return [(x - scene.range_x / 2, y - scene.range_y / 2) for x, y in centres]


# Arrangements ------------------------------------------------------------------------------------


def _patterns(n, along, across, ring, torus):
    """Yield (least distance, rows, discs a row, shift, fewer, spacing) of rows of ``n`` discs.

    Rows are in line, or every other row is shifted by half a spacing and may have a disc less. On a
    torus each row is shifted against the one below, by half a spacing if the number of rows is
    even, and else by a little less, so that the last row and the first one are shifted as well.
    """
    # The best rows are about as far apart as the discs of a row; no more rows than discs.
    about = min(math.sqrt(n * across / along), n) if along else n
    for rows in range(1, n + 1)[int(about / 2) : int(2 * about) + 3]:
        v = across / (rows - (not torus)) if rows > 1 else math.inf
        least = -(-n // rows)
        half = rows // 2 / rows if torus else 0.5
        for count in (least, least + 1):
            for shift, fewer in ((0.0, 0), (half, 0), (half, 1)):
                if count * rows - fewer * (rows // 2) < n or (ring and fewer):
                    continue
                steps = count if ring else count - 1 + (0.0 if fewer else shift)
                s = along / steps if steps > 0 else 0.0
                # On a ring the only neighbour of a single disc is its image, which is no contact.
                in_row = s if count > 1 else math.inf
                two_on = math.hypot((1 - 2 * shift) * s, 2 * v)
                yield min(in_row, math.hypot(shift * s, v), two_on), rows, count, shift, fewer, s


def _rows(n, along, across, ring, torus):
    """Return (least distance, centres) of the best of ``_patterns``."""
    least, rows, count, shift, fewer, s = max(_patterns(n, along, across, ring, torus))
    v = across / (rows - (not torus)) if rows > 1 else 0.0
    centres = [
        ((i + shift * row % 1) * s, row * v)
        for row in range(rows)
        for i in range(count - fewer * (row % 2))
    ]
    return least, centres[:n]


def _largest_triangle(a, b):
    """Return (corners, side) of the largest equilateral triangle in a × b, b ≤ a ≤ 2b/√3."""
    # One corner at (0, 0), one on x = a, one on y = b: a = s cos θ, b = s cos(π/6 − θ).
    corners = [(0.0, 0.0), (a, 2 * b - math.sqrt(3) * a), (2 * a - math.sqrt(3) * b, b)]
    return corners, 2 * math.sqrt(a * a + b * b - math.sqrt(3) * a * b)


def arranged(discs, a, b, periodic):
    """Return (centres in [0, ``a``] × [0, ``b``], their least distance), the best known here.

    Candidates are rows in line and staggered rows along either axis, on a ring along the periodic
    one; for three discs between walls also the largest triangle, which is optimal.
    """
    if periodic == "y":
        centres, least = arranged(discs, b, a, "x")
        return [(x, y) for y, x in centres], least
    least, centres = _rows(discs, a, b, bool(periodic), periodic == "xy")
    if periodic != "x":
        other, turned = _rows(discs, b, a, bool(periodic), periodic == "xy")
        if other > least:
            least, centres = other, [(x, y) for y, x in turned]
    if discs == 3 and not periodic and min(a, b) > max(a, b) * math.sqrt(3) / 2:
        corners, side = _largest_triangle(max(a, b), min(a, b))
        return corners if a >= b else [(x, y) for y, x in corners], side
    return centres, least


@cache
def largest_known_radius(discs, width, height, periodic=""):
    """Return the largest radius r for which ``arranged`` has centres at least 2r apart.

    It is found by bisection, to the last digit. Along a periodic axis it is at most a quarter of
    the period.
    """
    low = 0.0
    high = min(width / (4 if "x" in periodic else 2), height / (4 if "y" in periodic else 2))
    for _ in range(80):
        radius = (low + high) / 2
        across = height if "y" in periodic else height - 2 * radius
        along = width if "x" in periodic else width - 2 * radius
        fits = arranged(discs, along, across, periodic)[1] >= 2 * radius
        low, high = (radius, high) if fits else (low, radius)
    return low
