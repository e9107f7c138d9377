"""The geometry of two equal, smooth discs between walls."""

import math

from twodiscs.model.checks import InputError
from twodiscs.model.families.two import (
    check,
    confined,
    ergodic_components,
    multiplicity,
    passed,
)

__all__ = [
    "check", "confined", "ergodic_components", "largest_radius", "multiplicity", "passed",
    "require_followable",
]  # fmt: skip

#: How close to the largest radius dynamics in doubles holds, relatively: at a tenth of that mean
#: times begin to be off by more than 1e-4.
FOLLOWED = 1e-12


def largest_radius(scene):
    """Return the radius at which two equal discs just fit in the box of a ``Scene``.

    For max < 2 min the discs jam along a diagonal, (w + h − √(2wh))/2; otherwise each of them spans
    the short side, min/2.
    """
    width, height = scene.width, scene.height
    short, long = min(width, height), max(width, height)
    if long >= 2 * short:
        return short / 2
    return (width + height - math.sqrt(2 * width) * math.sqrt(height)) / 2


def require_followable(scene):
    """Raise ``InputError`` where dynamics in doubles is off: too close to the largest radius.

    Where discs jam along a diagonal, the room left to them is lost in the roundings of places.
    """
    largest = scene.largest_radius
    jams = largest < min(scene.width, scene.height) / 2
    if jams and scene.radius > (closest := largest * (1 - FOLLOWED)):
        raise InputError(
            f"radius {scene.radius!r} must not exceed {closest!r} for molecular dynamics: "
            f"beyond it, roundings count in the room that is left below {largest!r}"
        )
