"""Sampling of two equal, smooth discs between walls."""

from twodiscs.model.events import SHELLS
from twodiscs.model.scene import hopping_along
from twodiscs.sampling.montecarlo import (
    COST_RATIO,
    PROPOSALS,
    conditioned,
    in_blocks,
    in_prism,
    plain_thickness,
)
from twodiscs.sampling.separations import draw_constants
from twodiscs.sampling.starts import states_of_two
from twodiscs.theory import exact

__all__ = [
    "components", "near_hop", "origins", "plan", "proposals_per_event", "rejection",
    "require_free_fraction", "shelled", "states", "thickness",
]  # fmt: skip

#: The events that Monte Carlo samples by a shell, in the order of its counts.
shelled = SHELLS

thickness, rejection, states = plain_thickness, in_prism, states_of_two


def components(scene):
    """Return the names of the components of a state: centres, then velocities."""
    return ("x1", "y1", "x2", "y2", "u1", "v1", "u2", "v2")


def require_free_fraction(scene):
    """Accept every ``Scene``: draws keep to separations at which the discs fit."""


def origins(scene, hop=None, within=None):
    """Return (``SeparationSampler``, None) for initial states, see ``starts.origins``."""
    return draw_constants(scene, within), None


def proposals_per_event(scene, duration):
    """Return 0: proposals of initial states are few."""
    return 0.0


def near_hop(scene, hop):
    """Return an equivalent ``Scene`` and hop along x: draws are possible along this axis only."""
    return hopping_along(scene, hop, "x")


def plan(scene, samples):
    """Return the function that makes the ``Sampler`` of a ``Scene``, and the number of samples.

    ``samples`` are samples of the prism. Rejection is used if it accepts at least one in
    ``COST_RATIO``.
    """
    if exact.free_fraction(scene) >= 1 / COST_RATIO:
        return in_prism, in_blocks(samples)
    return conditioned, -(-samples // (COST_RATIO * PROPOSALS)) * PROPOSALS
