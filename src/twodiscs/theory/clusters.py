"""The bursts of events of rough discs, and the number of initial states that must be in them.

Two rough discs side by side in a narrow gap bounce between its walls. They leave it late, because
the impulses along their surfaces reverse their motion along the gap. A run without an initial state
in the gap misses a part of the rate, and its sample does not show that.

The part is exact. Let G be the configurations with a separation of at most d along an axis. The
fraction s of an event's rate that comes from G is the area of its surface in G over the whole area.
The fraction P of initial states in G is the volume of G over the whole volume. On average n = P R
out of R replicas begin in G. If none does, the mean count is too small by s. If some do, they add
at least s/√n to its relative error.

The smallest G is the neck, in which the free length of the discs is at most twice that at
separation 0. From there on d doubles. Visits of G that begin outside are not counted, so the number
of initial states is an upper bound. Smooth discs pass a neck in one flight along it and have no
bursts.

A rough disc may also stay in a corner of two walls as long as a replica lasts. At a distance d from
the corner it hits the walls N ~ T/d times, so P(N > n) ~ n⁻². The variance of N then grows as the
logarithm of the number of replicas. The mean over its standard error from the same sample still
tends to a normal variable (Giné, Götze and Mason 1997). No run is rejected because its sample has a
few large N: this would keep the runs without large N, whose errors are too small.
"""

import math
from functools import lru_cache
from typing import NamedTuple

from twodiscs.model.events import AXIS, EVENTS, HOPS
from twodiscs.theory import weighted

#: The number of initial states in G that is enough for the error of its bursts.
VISITS = 100

#: A contribution to the error below this fraction of it is ignored.
NEGLIGIBLE = 0.3

#: The smallest d over the largest one: below, almost no events come from G.
SMALLEST = 2.0**-20


class Region(NamedTuple):
    """A region ``within`` a separation along an axis: its fractions of volume and of each rate."""

    axis: str
    within: float
    volume: float
    rates: dict


def _neck(scene, hop):
    """Return the separation up to which there is a neck, None without one."""
    room, sigma = scene.clearance(hop), scene.contact_distance
    depth = room if room > 0 else -2 * room  # the height of the arch above the gap
    return math.sqrt(depth * (2 * sigma - depth)) if depth < sigma else None


@lru_cache(maxsize=256)
def regions(scene):
    """Return the ``Region``s of a ``Scene`` with bursts of events, none for smooth discs.

    The largest ones have no bursts, but enough initial states in any run.
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
    """Return the number of initial states that a relative ``error`` of an ``event`` needs.

    Fewer may miss all of its bursts and have too small an error bar.
    """
    most = 0.0
    for region in regions(scene):
        excess = region.rates.get(event, 0.0) / (NEGLIGIBLE * error)
        if excess > 1:
            most = max(most, min(VISITS, excess**2) / region.volume)
    return most
