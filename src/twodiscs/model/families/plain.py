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

#: The least relative distance from the largest radius for dynamics in doubles. At a tenth of it
#: errors of mean times exceed 1e-4.
FOLLOWED = 1e-12


def largest_radius(scene):
    """Return the radius at which two equal discs just fit in the box of a ``Scene``.

    If the long side is less than twice the short one, the discs jam along a diagonal, at
    (w + h − √(2wh))/2. Otherwise each of them spans the short side, at half of it.
    """
    width, height = scene.width, scene.height
    short, long = min(width, height), max(width, height)
    if long >= 2 * short:
        return short / 2
    return (width + height - math.sqrt(2 * width) * math.sqrt(height)) / 2


def require_followable(scene):
    """Raise ``InputError`` too close to the largest radius for dynamics in doubles.

    If discs jam along a diagonal, roundings of the centres become larger than their free lengths.
    """
    largest = scene.largest_radius
    jams = largest < min(scene.width, scene.height) / 2
    if jams and scene.radius > (closest := largest * (1 - FOLLOWED)):
        raise InputError(
            f"radius {scene.radius!r} must not exceed {closest!r} for molecular dynamics: "
            f"above it, roundings matter, because discs only fit up to {largest!r}"
        )
