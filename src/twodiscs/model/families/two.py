"""The geometry that two discs have with and without effects."""

import math
from fractions import Fraction

from twodiscs.model.checks import InputError

#: The total energy, kinetic and potential.
ENERGY = 0.5


def check(scene):
    """Raise ``InputError`` for a ``Scene`` whose discs have no room, or too little energy."""
    if not _fits(scene):
        raise InputError(
            f"radius {scene.radius!r} does not fit: two {scene.noun} in a box of "
            f"{scene.sides} need a radius below {scene.largest_radius!r}"
        )
    if scene.field:
        _check_energy(scene)


def _fits(scene):
    """Say, in exact arithmetic, whether both discs have room to move."""
    widest = 2 * max(scene.exact_radii)
    if any(Fraction(scene.side(axis)) <= widest for axis in scene.axes):
        return False
    if any(scene.reach(axis) <= 0 for axis in scene.axes):
        return False
    return scene.spread() > scene.exact_contact**2


def _check_energy(scene):
    if _lowest_potential(scene, scene.spread("y")) >= ENERGY:
        raise InputError(
            f"field {scene.field!r} is too strong at radius {scene.radius!r}: with a total "
            "energy of 1/2 the discs cannot leave the bottom, where they do not fit side by "
            "side"
        )
    if (scene.radius_ratio, scene.mass_ratio) != (1.0, 1.0) and not scene.vertical_hops:
        raise InputError(
            "unequal discs in a field need room and energy to pass each other on y1 = y2, or "
            f"the parts of configuration space are unequal, too; at radius {scene.radius!r} "
            "they lack it"
        )


def _lowest_potential(scene, spread):
    """Return the least potential energy of discs whose separation except along y has this square.

    ``spread`` is the largest such square. The lower disc lies on the bottom and the other one
    on it, or beside it if there is room.
    """
    if not scene.field:
        return 0.0
    square = scene.exact_contact**2 - spread
    apart = math.sqrt(square) if square > 0 else 0.0
    (r1, r2), (m1, m2) = scene.radii, scene.masses
    return scene.field * min(m2 * max(apart + r1 - r2, 0.0), m1 * max(apart + r2 - r1, 0.0))


def passed(scene):
    """Return the axes with walls along which the discs have room and energy to exchange sides."""
    return tuple(axis for axis in scene.walled if _has_gap(scene, axis))


def _has_gap(scene, axis):
    if scene.spread(axis) <= scene.exact_contact**2:
        return False
    if axis == "y":
        (r1, r2), (m1, m2) = scene.radii, scene.masses
        lowest = scene.field * (m1 * (r2 - r1) if r2 > r1 else m2 * (r1 - r2))
    else:
        lowest = _lowest_potential(scene, scene.spread(axis, "y"))
    return lowest < ENERGY


def ergodic_components(scene):
    """Return the number of disjoint parts of configuration space.

    Each hop that is blocked between walls doubles it; a periodic axis has a way around.
    """
    return 2 ** (len(scene.walled) - len(scene.passed))


def confined(scene):
    """Return whether disc 1 reaches a wall of x, and one of y, only from its own side of disc 2."""
    return _confined(scene, "x"), _confined(scene, "y")


def _confined(scene, axis):
    """Say whether disc 1 reaches the far wall of ``axis`` only from its own side of disc 2.

    It does so once the hop is blocked, unless it is the larger disc and there is room for
    disc 2 in the corner behind it.
    """
    if axis in scene.passed or axis not in scene.walled:
        return False
    r1, r2 = scene.exact_radii
    if r1 <= r2:
        return True
    behind = (r1 - r2) ** 2
    if scene.spread(axis) + behind <= scene.exact_contact**2:
        return True
    return _lowest_potential(scene, scene.spread(axis, "y") + behind) >= ENERGY


def multiplicity(scene, event):
    """Return how many events of a ``Scene`` have the rate of ``event``, an ``Event``.

    Mirror images and equal discs leave four of the pairs of a disc and a wall that have one rate,
    two of them within the reach of a trajectory where the discs keep their sides. A field has no
    mirror image along y.
    """
    if event.kind != "wall":
        return 1
    mirrored = event.axis == "x" or not scene.field
    return round((1 + mirrored) * (1 + scene.identical) * scene.share(event.name))
