"""The exact theory of two equal, smooth discs between walls."""

import math

from twodiscs.model.events import DECLARED, SHELLS
from twodiscs.theory.plain import shell_expectation, volume_and_areas

__all__ = [
    "areas", "fraction_near", "least_free_fraction", "rate", "replicas_needed", "shell_expectation",
    "shells", "volume", "work_per_event",
]  # fmt: skip


#: Initial states are drawn at separations at which the discs fit, not in the prism.
least_free_fraction = 0.0


def volume(scene):
    """Return the volume of a ``Scene``, see ``exact``."""
    return volume_and_areas(scene)[0]


def areas(scene):
    """Return {event: area} of a ``Scene``, see ``exact``."""
    return volume_and_areas(scene)[1]


def rate(scene, event):
    """Return the rate of ``event``."""
    volume, areas = volume_and_areas(scene)
    return DECLARED[event].ways * areas[event] / (1.5 * math.pi * volume)


def work_per_event(scene, event_rate):
    """Return 1: an event has the usual cost."""
    return 1.0


def shells(scene):
    """Return the events whose surface has a shell."""
    return SHELLS


def fraction_near(scene, hop, distance):
    """Return the fraction of configuration space within a ``distance`` of a hop, see ``exact``."""
    epsilon = distance / math.sqrt(2)
    return 2 * epsilon * shell_expectation(scene, hop, epsilon) / volume(scene)


def replicas_needed(scene, event, error):
    """Return 0: smooth discs have no bursts of events."""
    return 0.0
