"""The exact theory of more than two discs, as far as it is known."""

from dataclasses import replace

from twodiscs.model.events import DECLARED
from twodiscs.model.family import of_family
from twodiscs.theory.many.methods import event_rates, volume_and_areas

__all__ = ["areas", "least_free_fraction", "rate", "replicas_needed", "volume", "work_per_event"]


#: Initial states do not need a free prism.
least_free_fraction = 0.0


def volume(scene):
    """Return the volume of a ``Scene``, None if no exact value is known."""
    return volume_and_areas(scene)[0]


def areas(scene):
    """Return {event: area} of a ``Scene``, values None if not known."""
    return volume_and_areas(scene)[1]


def rate(scene, event):
    """Return the rate of ``event``, None if no exact value is known."""
    return event_rates(scene)[event]


def work_per_event(scene, event_rate):
    """Return 1: the kernel of N discs has extra work only once in half a period."""
    return 1.0


def replicas_needed(scene, event, error):
    """Return the number of initial states for the bursts of rough discs, an estimate; else 0.

    It is that of two of the discs in the same box, divided by the number of pairs. Any pair of N
    discs may begin in a neck, and the other discs only shorten its bursts. Each disc is in N − 1
    pairs, whose bursts at the walls add up.
    """
    if scene.moment_of_inertia is None:
        return 0.0
    pair, others = replace(scene, discs=2), scene.discs - 1
    if DECLARED[event].kind in ("wall", "walls"):
        error /= others
    needed = of_family(pair, "theory", "replicas_needed")(pair, event, error)
    return needed / (scene.discs * others / 2)
