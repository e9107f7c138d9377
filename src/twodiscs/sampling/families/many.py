"""Sampling of more than two discs."""

from twodiscs.model.checks import check_integer
from twodiscs.sampling.many import measures
from twodiscs.sampling.many.initial import labelled

__all__ = ["components", "plan", "proposals_per_event", "require_free_fraction", "states"]


def components(scene):
    """Return the names of the components of a state: x1 … xN, then y, u, v and maybe s of all."""
    names = "xyuv" if scene.moment_of_inertia is None else "xyuvs"
    return tuple(f"{name}{disc}" for name in names for disc in range(1, scene.discs + 1))


def require_free_fraction(scene):
    """Accept every ``Scene``: initial states do not come from the prism."""


def proposals_per_event(scene, duration):
    """Return 0: the length of a replica takes account of the cost of its initial state."""
    return 0.0


def states(scene, number, seed, block=0, order=(0, 0), progress=None):
    """Return ``number`` initial states, see ``starts.states``; there is no ``order`` to choose."""
    return labelled(scene, number, seed, block, progress)


def plan(scene, samples):
    """Return the function that makes the ``Sampler`` of a ``Scene``, and the number of samples."""
    blocks = -(-check_integer("samples", samples) // measures.BLOCK)
    return measures.inserted, blocks * measures.BLOCK
