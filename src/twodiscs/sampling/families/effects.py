"""Sampling of two discs in scenes with effects."""

from twodiscs.model.checks import InputError
from twodiscs.model.events import EVENTS
from twodiscs.sampling.montecarlo import in_blocks, weighted, weighted_thickness
from twodiscs.sampling.prism import prism_of
from twodiscs.sampling.starts import states_of_two
from twodiscs.theory import exact

__all__ = [
    "components", "near_hop", "origins", "plan", "proposals_per_event", "rejection",
    "require_free_fraction", "shelled", "states", "thickness",
]  # fmt: skip

#: The events that Monte Carlo samples by a shell, in the order of its counts.
shelled = EVENTS

thickness, rejection, states = weighted_thickness, weighted, states_of_two


def components(scene):
    """Return the names of the components of a state: centres, velocities, then those of effects."""
    balls = ("z1", "z2", "w1", "w2") if scene.depth is not None else ()
    rough = ("s1", "s2") if scene.moment_of_inertia is not None else ()
    return ("x1", "y1", "x2", "y2", "u1", "v1", "u2", "v2", *balls, *rough)


def require_free_fraction(scene):
    """Raise ``InputError`` for a ``Scene`` whose discs overlap in almost all of the prism."""
    if (fraction := exact.free_fraction(scene)) < exact.MIN_FRACTION:
        raise InputError(
            f"radius {scene.radius!r} leaves a fraction {fraction:.1g} of the prism of all centres "
            f"without overlap, but a scene with effects needs {exact.MIN_FRACTION:g} of it"
        )


def origins(scene, hop=None, within=None):
    """Return (None, ``PrismSampler``) for initial states, see ``starts.origins``."""
    return None, prism_of(scene, hop, within)


def proposals_per_event(scene, duration):
    """Return the proposals of initial states for each event of replicas of a ``duration``."""
    return 1 / exact.free_fraction(scene) / (exact.event_rate(scene) * duration)


def near_hop(scene, hop):
    """Return the ``Scene`` and the hop unchanged: draws are possible along any axis."""
    return scene, hop


def plan(scene, samples):
    """Return the function that makes the ``Sampler`` of a ``Scene``, and the number of samples."""
    return weighted, in_blocks(samples)
