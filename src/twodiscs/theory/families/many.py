"""The exact theory of more than two discs, where there is any."""

from twodiscs.theory.many.exact import event_rates, volume_and_areas

__all__ = ["rate", "replicas_needed", "volume_and_areas", "work_per_event"]


def rate(scene, event, volume, areas):
    """Return the rate of ``event``, None where no exact value is known; the volume is not used."""
    return event_rates(scene)[event]


def work_per_event(scene, event_rate):
    """Return 1: the kernel of N discs looks again only after half a period."""
    return 1.0


def replicas_needed(scene, event, error):
    """Return 0: smooth discs have no crowds of events."""
    return 0.0
