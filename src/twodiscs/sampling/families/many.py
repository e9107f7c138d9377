"""Sampling of more than two discs."""

from twodiscs.model.checks import check_integer
from twodiscs.sampling.many import measures
from twodiscs.sampling.many.initial import labelled

__all__ = ["components", "plan", "proposals_per_event", "require_free_fraction", "states"]


def components(scene):
    """Return the names of the components of a state: x1 … xN, then y, u and v of all discs."""
    return tuple(f"{name}{disc}" for name in "xyuv" for disc in range(1, scene.discs + 1))


def require_free_fraction(scene):
    """Accept every ``Scene``: initial states do not need a free prism."""


def proposals_per_event(scene, duration):
    """Return 0: what initial states take is in the length of a replica."""
    return 0.0


def states(scene, number, seed, block=0, sides=(0, 0), progress=None):
    """Return ``number`` initial states, see ``starts.states``; there are no ``sides`` to choose."""
    return labelled(scene, number, seed, block, progress)


def plan(scene, samples):
    """Return what makes the ``Sampler`` of a ``Scene``, and the number of its insertions."""
    blocks = -(-check_integer("samples", samples) // measures.BLOCK)
    return measures.inserted, blocks * measures.BLOCK
