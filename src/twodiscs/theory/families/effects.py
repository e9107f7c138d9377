"""The exact theory of two discs in scenes with effects."""

from twodiscs.model.events import DECLARED
from twodiscs.theory import weighted
from twodiscs.theory.families.clusters import replicas_needed
from twodiscs.theory.flux import constant
from twodiscs.theory.weighted import shell_expectation

__all__ = [
    "fraction_near", "passing_rate", "rate", "replicas_needed", "shell_expectation", "shells",
    "volume_and_areas", "work_per_event",
]  # fmt: skip

#: Times that discs may leave their periodic cell between two events before that counts as work.
PASSES_PER_EVENT = 64


def volume_and_areas(scene):
    """Return (volume, {event: area}) of a ``Scene``, weighted in a field."""
    return weighted.volume(scene), weighted.areas(scene)


def rate(scene, event, volume, areas):
    """Return the rate of ``event``, given the ``volume`` and {event: area}."""
    return DECLARED[event].sides / 2 * constant(scene.velocity_components) * areas[event] / volume


def passing_rate(scene, hop, volume):
    """Return how often the discs pass each other in a ``hop`` along a periodic axis."""
    area = weighted.passing_area(scene, hop)
    return constant(scene.velocity_components) * area / volume


def work_per_event(scene, event_rate):
    """Return how many times as much an event costs as usual, at most; 1 in a box without ends.

    On a periodic axis discs leave their cell between two events, very often where they are small;
    ``PASSES_PER_EVENT`` times are in what an event costs anyhow.
    """
    passes = sum(scene.fastest / scene.side(axis) for axis in scene.periodic)
    return max(1.0, passes / PASSES_PER_EVENT / event_rate)


def shells(scene):
    """Return the events whose surface has a shell of its own: all, for masses may differ."""
    return scene.events


def fraction_near(scene, hop, distance, volume):
    """Return the share of configuration space within a ``distance`` of level, see ``exact``."""
    return weighted.volume_near(scene, hop, distance) / volume
