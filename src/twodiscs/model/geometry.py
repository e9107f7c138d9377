"""The geometry of a scene, for two discs and for more."""

from collections.abc import Callable
from typing import NamedTuple

from twodiscs.model import many_geometry, two_geometry


class Geometry(NamedTuple):
    """The functions of a ``Scene`` that differ between two discs and more; ``Scene`` says more."""

    check: Callable  # raises ``InputError`` if the discs do not fit or cannot move
    require_followable: Callable  # raises ``InputError`` where doubles are too coarse to move them
    largest_radius: Callable  # in length
    open_axes: Callable  # the axes of open hops
    ergodic_components: Callable  # their number, None if it is not known
    confined: Callable  # for x and y, whether disc 1 reaches a wall only from one side of disc 2
    copies: Callable  # (an event): the number of events with its rate


TWO_DISCS = Geometry(
    check=two_geometry.check,
    require_followable=two_geometry.require_followable,
    largest_radius=two_geometry.largest_radius,
    open_axes=two_geometry.open_axes,
    ergodic_components=two_geometry.ergodic_components,
    confined=two_geometry.confined,
    copies=two_geometry.copies,
)

MANY_DISCS = Geometry(
    check=many_geometry.check,
    require_followable=many_geometry.require_followable,
    largest_radius=many_geometry.largest_radius,
    open_axes=many_geometry.open_axes,
    ergodic_components=many_geometry.ergodic_components,
    confined=lambda scene: (False, False),
    copies=many_geometry.copies,
)
