"""The exact numbers of N discs, as far as they are known, by the method for each scene.

Two plain discs have the volume and the areas of ``plain``. Three discs have the quadrature between
kinks, or Mayer's sum on a torus. Any number of discs has the transfer operator, if the channel is
so low that they keep their order. For other scenes no exact value is known here; their events may
be possible.
"""

import math
from dataclasses import replace
from functools import lru_cache

from twodiscs.model.events import EVENT_WAYS, EVENTS, by_kind
from twodiscs.model.many_geometry import has_volume, is_ordered
from twodiscs.theory import channel, plain, three
from twodiscs.theory.flux import Derivatives, flux_constant

#: The largest shortest side in which exact values are computed without another unit of length.
LARGEST_UNIT = 2.0**20


def exact_method(scene):
    """Return the theory for a ``Scene``: "plain", "three", "channel", or None."""
    if scene.discs == 2:
        return "plain" if scene.is_plain else None
    if scene.discs == 3 and scene.periodic in ("", "xy"):
        return "three"
    if scene.periodic:
        return None
    return "channel" if is_ordered(scene) or is_ordered(scene.turned()) else None


def takes_minutes(scene):
    """Return whether the exact numbers of a ``Scene`` may take minutes instead of seconds.

    These are channels in which A is near a length at which S is stationary (see ``channel``). For
    eight discs or more the terms of the inverse fall fast: .3 s where four discs take 36 s.
    """
    if scene.discs > 7 or exact_method(scene) != "channel":
        return False
    length = scene.width if is_ordered(scene) else scene.height
    return length < 1.1 * scene.discs * 2 * scene.radius


@lru_cache(maxsize=1024)
def known_derivatives(scene, hops=True):
    """Return the ``Derivatives`` of a ``Scene``, None if no exact value is known here.

    ``hops`` False leaves out the hops in a channel, which take longest.
    """
    unit = 2.0 ** round(math.log2(scene.shortest))
    if not LARGEST_UNIT > unit > 1 / LARGEST_UNIT:
        # Powers of lengths would leave the range of doubles.
        lengths = {name: getattr(scene, name) / unit for name in scene.LENGTHS}
        if (known := known_derivatives(replace(scene, friction=0.0, **lengths), hops)) is None:
            return None
        log_volume, *rest = known
        rest = (value and value / unit for value in rest)
        return Derivatives(log_volume + 2 * scene.discs * math.log(unit), *rest)
    name = exact_method(scene)
    if name == "plain":
        return _plain_derivatives(scene)
    if name == "three":
        return (three.torus_derivatives if scene.periodic else three.derivatives)(scene)
    if name == "channel":
        if is_ordered(scene):
            return channel.derivatives(scene, hops)
        return channel.derivatives(scene.turned(), hops).turned()
    return None


def _plain_derivatives(scene):
    volume, areas = plain.volume_and_areas(scene)
    root = math.sqrt(2)
    return Derivatives(
        math.log(volume),
        2 * areas["right_wall"] / volume,
        2 * areas["top_wall"] / volume,
        areas["disc_collision"] / root / volume,
        areas["horizontal_hop"] / root / volume,
        areas["vertical_hop"] / root / volume,
    )


def surfaces(scene, known):
    """Return {event: area over volume} of a ``Scene``, given its ``Derivatives``.

    The metric is that of the 2N coordinates. For each axis with walls, all walls have 2N times the
    area of one disc at one wall.
    """
    root, discs = math.sqrt(2), scene.discs
    over = {
        "hop": lambda event: (
            root * ((known.vertical_hops if event.axis == "y" else known.horizontal_hops) or 0.0)
        ),
        "collision": lambda event: root * known.per_contact,
        "wall": lambda event: (known.per_width if event.axis == "x" else known.per_height) / discs,
        "walls": lambda event: 2 * (known.per_width + known.per_height),
    }
    return by_kind("theory/n_discs.py", over)


def volume(scene):
    """Return the volume of a ``Scene`` of N > 2 discs, in length^2N.

    It is None if no exact value is known, and without ``has_volume``.
    """
    known = known_derivatives(scene) if has_volume(scene) else None
    return None if known is None else math.exp(known.log_volume)


def areas(scene):
    """Return {event: area} of a ``Scene``, for an event of any pair, or of one disc at one wall.

    An area is 0.0 if the event is impossible or does not exist in the scene. Otherwise it is None
    if the ``volume`` is.
    """
    whole, found = volume(scene), {e: None if scene.is_possible(e) else 0.0 for e in EVENTS}
    if whole is None:
        return found
    over = surfaces(scene, known_derivatives(scene))
    return found | {e: whole * part for e, part in over.items() if scene.is_possible(e)}


def rate(scene, event):
    """Return the rate of ``event`` in a ``Scene``; 0.0 if it never happens, None if not known.

    It is that of a collision or a hop of any pair, of one disc at one wall, or of any disc at any
    wall. It needs only the logarithm of the volume, because the volume may underflow.
    """
    if not scene.is_possible(event):
        return 0.0
    if (known := known_derivatives(scene)) is None:
        return None
    c = flux_constant(scene.velocity_components)
    return EVENT_WAYS[event] / 2 * c * surfaces(scene, known)[event]
