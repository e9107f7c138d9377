"""The geometry of two discs, with and without effects."""

import math
from fractions import Fraction

from twodiscs.model.checks import InputError
from twodiscs.model.events import EVENT_AXES, WALLS

#: The total energy, kinetic and potential.
ENERGY = 0.5


def check(scene):
    """Raise ``InputError`` for a ``Scene`` whose discs do not fit, or have too little energy."""
    if not _fits(scene):
        raise InputError(
            f"radius {scene.radius!r} does not fit: two {scene.noun} in a box of "
            f"{scene.box_text} need a radius below {scene.largest_radius!r}"
        )
    if scene.field:
        _check_energy(scene)


def _fits(scene):
    """Return, by exact arithmetic, whether both discs have room to move."""
    widest = 2 * max(scene.exact_radii)
    return widest < Fraction(scene.shortest) and scene.squared_reaches() > scene.exact_contact**2


def _check_energy(scene):
    if _lowest_potential(scene, scene.squared_reaches("y")) >= ENERGY:
        raise InputError(
            f"field {scene.field!r} is too strong at radius {scene.radius!r}: with a total "
            "energy of 1/2 the discs cannot leave the bottom, where they do not fit side by "
            "side"
        )
    if (scene.radius_ratio, scene.mass_ratio) != (1.0, 1.0) and not scene.vertical_hops:
        raise InputError(
            f"radius {scene.radius!r} is too large: in a field unequal discs must be able to hop "
            f"vertically, here below radius {_last_of_vertical_hops(scene)!r}"
        )


def _last_of_vertical_hops(scene):
    """Return the radius of disc 1 at which unequal discs in a field lose the vertical hop.

    At this hop the separation along y is zero, and the potential that of the centres on one height.
    """
    mass, excess = scene.masses[scene.radius_ratio < 1], abs(scene.radius_ratio - 1)
    limit = _largest_with_effects(scene, without="y")
    return min(limit, ENERGY / (scene.field * mass * excess)) if excess else limit


def _lowest_potential(scene, spread):
    """Return the least potential energy, for the largest squared separation across y, ``spread``.

    The lower disc is on the bottom. The other one is on the bottom beside it if there is room, or
    else on the lower disc.
    """
    square = scene.exact_contact**2 - spread
    apart = math.sqrt(square) if square > 0 else 0.0
    (r1, r2), (m1, m2) = scene.radii, scene.masses
    return scene.field * min(m2 * max(apart + r1 - r2, 0.0), m1 * max(apart + r2 - r1, 0.0))


def open_axes(scene):
    """Return the axes with walls along which the discs have room and energy to exchange sides."""
    return tuple(axis for axis in scene.walled if _has_gap(scene, axis))


def _has_gap(scene, axis):
    if scene.squared_reaches(axis) <= scene.exact_contact**2:
        return False
    if axis == "y":
        (r1, r2), (m1, m2) = scene.radii, scene.masses
        lowest = scene.field * (m1 * (r2 - r1) if r2 > r1 else m2 * (r1 - r2))
    else:
        lowest = _lowest_potential(scene, scene.squared_reaches(axis, "y"))
    return lowest < ENERGY


def ergodic_components(scene):
    """Return the number of disjoint parts of configuration space, see ``Scene``."""
    return 2 ** (len(scene.walled) - len(scene.open_axes))


def confined(scene):
    """Return whether disc 1 reaches a wall of x, and one of y, only from one side of disc 2."""
    return _confined(scene, "x"), _confined(scene, "y")


def _confined(scene, axis):
    """Return whether disc 1 reaches the far wall of ``axis`` only from one side of disc 2.

    This is so if the hop is blocked, unless disc 1 is the larger disc and the corner behind it has
    room for disc 2.
    """
    if axis in scene.open_axes or axis not in scene.walled:
        return False
    r1, r2 = scene.exact_radii
    if r1 <= r2:
        return True
    behind = (r1 - r2) ** 2
    if scene.squared_reaches(axis) + behind <= scene.exact_contact**2:
        return True
    return _lowest_potential(scene, scene.squared_reaches(axis, "y") + behind) >= ENERGY


def copies(scene, event):
    """Return the number of events with the rate of ``event``, see ``Scene``."""
    if event not in WALLS:
        return 1
    mirrored = EVENT_AXES[event] == "x" or not scene.field
    return round((1 + mirrored) * (1 + scene.identical) * scene.accessible_fraction(event))


def largest_radius(scene):
    """Return the radius of disc 1 at which two discs just fit in the box of a ``Scene``."""
    return _largest_plain(scene) if scene.is_plain else _largest_with_effects(scene)


def _largest_plain(scene):
    """Return the radius at which two equal discs just fit.

    If the long side is less than twice the short one, the discs jam along a diagonal, at
    (w + h − √(2wh))/2. Otherwise each of them spans the short side, at half of it.
    """
    width, height = scene.width, scene.height
    short, long = min(width, height), max(width, height)
    if long >= 2 * short:
        return short / 2
    return (width + height - math.sqrt(2 * width) * math.sqrt(height)) / 2


def _largest_with_effects(scene, without=""):
    """Return the radius of disc 1 at which two discs just fit, with the axis ``without`` closed.

    The equation for σ is Σ over walls of (side − σ)² + Σ over periodic axes of (side/2)² = σ²,
    unless a disc spans a side before.
    """
    walls, ratio = [scene.side(q) for q in scene.walled if q != without], scene.radius_ratio
    n, total = len(walls), math.fsum(walls)
    squares = math.fsum(side * side for side in walls)
    squares += math.fsum(scene.side(axis) ** 2 / 4 for axis in scene.periodic)
    limits = [scene.shortest / max(1.0, ratio) / 2]
    if n == 0:
        limits.append(math.sqrt(squares) / (1 + ratio))
    elif total**2 >= (n - 1) * squares:
        # The smaller root, without its cancellation.
        root = math.sqrt(total**2 - (n - 1) * squares)
        limits.append(squares / (total + root) / (1 + ratio))
    return min(limits)


#: The least relative distance from the largest radius for dynamics in doubles. At a tenth of it
#: errors of mean times exceed 1e-4.
LEAST_DISTANCE = 1e-12


def require_followable(scene):
    """Raise ``InputError`` too close to the largest radius for dynamics in doubles.

    If discs jam along a diagonal, roundings of the centres become larger than their free lengths.
    """
    largest = scene.largest_radius
    # With effects, initial states need more room than dynamics in doubles.
    jams = scene.is_plain and largest < scene.shortest / 2
    if jams and scene.radius > (closest := largest * (1 - LEAST_DISTANCE)):
        raise InputError(
            f"radius {scene.radius!r} must not exceed {closest!r} for molecular dynamics: "
            f"above it, roundings matter, because discs only fit up to {largest!r}"
        )
