"""The exact theory of more than two discs, as far as it is known."""

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
    """Return 0: smooth discs have no bursts of events."""
    return 0.0
