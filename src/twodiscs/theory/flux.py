"""Rates as fluxes of the invariant measure: derivatives of the volume of configuration space.

With N discs, D components of velocity uniform on a sphere at total energy 1/2, all events of a
class together have the rates below. D is 2N, minus 1 for each momentum that is conserved; it is 3N
with the spins of rough discs.

    collisions     −(c_D/√2) ∂lnV/∂σ
    walls of x     c_D ∂lnV/∂A                              walls of y likewise
    hops in x      √2 c_D Σ_pairs ∫ δ(x_i − x_j) / V        hops in y likewise

V is the volume of configuration space, a function of the ranges A and B of the centres and of the
contact distance σ.
"""

import math
from typing import NamedTuple


def flux_constant(components):
    """Return c_D: the mean of |n·s| for a unit vector s uniform in D ``components``.

    2/π, 4/(3π), 16/(15π) in two, four and six dimensions.
    """
    half = components / 2
    return math.exp(math.lgamma(half) - math.lgamma(half + 0.5)) / math.sqrt(math.pi)


class Derivatives(NamedTuple):
    """The logarithm of the volume V of configuration space, its derivatives, and the hops over V.

    ``per_contact`` is −∂lnV/∂σ. ``horizontal_hops`` is Σ_pairs ∫ δ(x_i − x_j)/V; either of the hops
    may be None if it was not asked for. All except the logarithm are in 1/length.
    """

    log_volume: float
    per_width: float
    per_height: float
    per_contact: float
    horizontal_hops: float | None = None
    vertical_hops: float | None = None

    def turned(self):
        """Return the same of the box turned by a quarter."""
        return Derivatives(
            self.log_volume, self.per_height, self.per_width, self.per_contact,
            self.vertical_hops, self.horizontal_hops,
        )  # fmt: skip


def rates(scene, known):
    """Return {event: rate × copies} of a ``Scene``, given its ``Derivatives``.

    Hops that are None have no entry. Hops along a ring are no events, but have an entry: the rate
    at which two discs pass each other.
    """
    c = flux_constant(scene.velocity_components)
    rates = {
        "vertical_hop": known.vertical_hops and math.sqrt(2) * c * known.vertical_hops,
        "horizontal_hop": known.horizontal_hops and math.sqrt(2) * c * known.horizontal_hops,
        "disc_collision": c / math.sqrt(2) * known.per_contact,
        "right_wall": c * known.per_width,
        "top_wall": c * known.per_height,
    }
    return {event: rate for event, rate in rates.items() if rate is not None}
