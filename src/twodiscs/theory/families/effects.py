"""The exact theory of two discs in scenes with effects.

Friction changes none of it. A kick draws velocities from the law that they have in the invariant
measure, for given centres and conserved momenta, so the measure stays invariant. A rate is the flux
of this measure through a surface, and so it is the same with and without kicks.
"""

from twodiscs.model.events import DECLARED
from twodiscs.theory import weighted
from twodiscs.theory.exact import MIN_FRACTION as least_free_fraction
from twodiscs.theory.families.clusters import replicas_needed
from twodiscs.theory.flux import constant
from twodiscs.theory.weighted import areas, shell_expectation, volume

__all__ = [
    "areas", "fraction_near", "least_free_fraction", "passing_rate", "rate", "replicas_needed",
    "shell_expectation", "shells", "volume", "work_per_event",
]  # fmt: skip

#: Crossings of the periodic cell between two events that the usual cost of an event includes.
PASSES_PER_EVENT = 64

#: The time of a kick over the time of an event.
KICK = 15


def rate(scene, event):
    """Return the rate of ``event``."""
    flux = DECLARED[event].ways / 2 * constant(scene.velocity_components) * areas(scene)[event]
    return flux / volume(scene)


def passing_rate(scene, hop):
    """Return the rate at which the discs pass each other in a ``hop`` along a periodic axis."""
    area = weighted.passing_area(scene, hop)
    return constant(scene.velocity_components) * area / volume(scene)


def work_per_event(scene, event_rate):
    """Return an upper bound on the cost of an event over the usual cost, 1 between walls.

    On a periodic axis discs leave their cell between two events, very often if they are small. The
    usual cost includes ``PASSES_PER_EVENT`` such crossings. A kick by friction costs about as much
    as ``KICK`` events.
    """
    passes = sum(scene.fastest / scene.side(axis) for axis in scene.periodic)
    usual = max(1.0, passes / PASSES_PER_EVENT / event_rate)
    return usual + KICK * scene.friction / event_rate


def shells(scene):
    """Return the events whose surface has a shell: all of them, because masses may differ."""
    return scene.events


def fraction_near(scene, hop, distance):
    """Return the fraction of configuration space within a ``distance`` of a hop, see ``exact``."""
    return weighted.volume_near(scene, hop, distance) / volume(scene)
