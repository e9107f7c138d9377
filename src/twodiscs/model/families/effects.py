"""The geometry of two discs in a scene with effects."""

import math

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


def largest_radius(scene):
    """Return the radius of disc 1 at which two discs just fit in the box of a ``Scene``.

    The equation for σ is Σ over walls of (side − σ)² + Σ over periodic axes of (side/2)² = σ²,
    unless a disc spans a side before.
    """
    walls, ratio = [scene.side(axis) for axis in scene.walled], scene.radius_ratio
    n, total = len(walls), math.fsum(walls)
    squares = math.fsum(side * side for side in walls)
    squares += math.fsum(scene.side(axis) ** 2 / 4 for axis in scene.periodic)
    limits = [min(map(scene.side, scene.axes)) / max(1.0, ratio) / 2]
    limits += [side / (1 + ratio) for side in walls]
    if n == 0:
        limits.append(math.sqrt(squares) / (1 + ratio))
    elif n == 1:
        limits.append(squares / (2 * total) / (1 + ratio))
    elif total**2 >= (n - 1) * squares:
        # The smaller root, without its cancellation.
        root = math.sqrt(total**2 - (n - 1) * squares)
        limits.append(squares / (total + root) / (1 + ratio))
    return min(limits)


def require_followable(scene):
    """Accept every ``Scene``: initial states need more room than dynamics in doubles."""
