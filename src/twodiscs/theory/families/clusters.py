"""Where rough discs have their events in crowds, and how many initial states have to be there.

Two rough discs that are level in a narrow gap bounce to and fro in it and leave it late, because
the impulses along their surfaces turn their motion along the gap back. A run without an initial
state in the gap misses a part of the rate, and its sample does not show that.

The part is exact. Let G be the configurations that are level along an axis within a distance d. The
share s of the rate of an event that comes from G is the area of its surface in G over the whole
area. The share P of initial states in G is the volume of G over the whole volume. Of R replicas
n = P R begin in G, in the mean. If none does, the mean count is short by s. If some do, they add
s/√n to its relative error at least.

The least G is the neck, where the room of the discs is at most twice the room of level ones, and d
doubles from there on. Visits of G that begin outside are not counted, so the answer is on the safe
side. Smooth discs pass a neck in one flight along it and have no such crowds.
"""

import math
from functools import lru_cache
from typing import NamedTuple

from twodiscs.model.events import AXIS, EVENTS, HOPS
from twodiscs.theory import weighted

#: So many initial states in G show how large its crowds are.
VISITS = 100

#: A part of an error that is too small to matter.
NEGLIGIBLE = 0.3

#: The least distance from level, in units of the largest one: below, there are next to no events.
SMALLEST = 2.0**-20


class Region(NamedTuple):
    """What is level along an axis ``within`` a distance: its shares of volume and of each rate."""

    axis: str
    within: float
    volume: float
    rates: dict


def _neck(scene, hop):
    """Return the distance from level up to which there is a neck, None without one."""
    room, sigma = scene.room(hop), scene.contact_distance
    depth = room if room > 0 else -2 * room  # of the arch that the discs leave over it
    return math.sqrt(depth * (2 * sigma - depth)) if depth < sigma else None


@lru_cache(maxsize=256)
def regions(scene):
    """Return the ``Region``s of a ``Scene`` in which events come in crowds, none for smooth discs.

    The largest ones have no crowds themselves, but enough initial states in any run.
    """
    if scene.moment_of_inertia is None:
        return ()
    volume, areas, found = weighted.volume(scene), weighted.areas(scene), []
    for hop in HOPS:
        axis = AXIS[hop]
        if axis not in scene.axes or (least := _neck(scene, hop)) is None:
            continue
        reach = float(scene.reach(axis))
        within = max(least, reach * SMALLEST)
        while within < reach:
            share = weighted.volume_near(scene, hop, within) / volume
            near = weighted.areas_near(scene, axis, within)
            rates = {event: near[event] / areas[event] for event in EVENTS if areas[event]}
            found.append(Region(axis, within, share, rates))
            within *= 2
    return tuple(found)


def replicas_needed(scene, event, error):
    """Return how many initial states show the crowds of an ``event``, for a relative ``error``.

    Fewer may see none of its crowds, and then have too small an error bar. 0 where there are none.
    """
    most = 0.0
    for region in regions(scene):
        excess = region.rates.get(event, 0.0) / (NEGLIGIBLE * error)
        if excess > 1:
            most = max(most, min(VISITS, excess**2) / region.volume)
    return most
