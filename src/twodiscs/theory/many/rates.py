"""Rates of N discs from volume and areas of configuration space, and relations for every N.

With D components of velocity uniform on a sphere at total energy 1/2, and c_D of ``flux.constant``,
all events of a class together have the rates below. D is 2N, minus 1 if a momentum is conserved; it
is 3N with the spins of rough discs.

    collisions     −(c_D/√2) ∂lnV/∂σ
    walls of x     c_D ∂lnV/∂A                              walls of y likewise
    hops in x      √2 c_D Σ_pairs ∫ δ(x_i − x_j) / V        hops in y likewise

V is the volume of configuration space, a function of the ranges A and B of the centres and of the
contact distance σ. It scales as a length to the power 2N. The virial theorem follows for any N,
without V:

    (A ν_x + B ν_y − √2 σ ν_coll) / (2N c_D) = 1

ν_x is the rate of all hits of both walls of x by any disc. At the same energy per disc times scale
as 1/√N.
"""

import math
from typing import NamedTuple

from twodiscs.model.checks import InputError
from twodiscs.model.scene import Scene
from twodiscs.theory import plain
from twodiscs.theory.flux import constant


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
    """Return {event: rate × multiplicity} of a ``Scene``, given its ``Derivatives``.

    Hops that are None have no entry. Hops along a ring are no events, but have an entry: the rate
    at which two discs pass each other.
    """
    c = constant(scene.velocity_components)
    rates = {
        "vertical_hop": known.vertical_hops and math.sqrt(2) * c * known.vertical_hops,
        "horizontal_hop": known.horizontal_hops and math.sqrt(2) * c * known.horizontal_hops,
        "disc_collision": c / math.sqrt(2) * known.per_contact,
        "right_wall": c * known.per_width,
        "top_wall": c * known.per_height,
    }
    return {event: rate for event, rate in rates.items() if rate is not None}


def virial_weights(scene):
    """Return {class of events: weight} with which the rates of a ``Scene`` add up to 1.

    This holds between walls only. On a ring no rate of events gives the force across a line; there
    ``InputError`` is raised.
    """
    if scene.periodic:
        raise InputError("scene must have walls along x for the virial theorem, but x is periodic")
    c = 2 * scene.discs * constant(scene.velocity_components)
    return {
        "disc_collision": -math.sqrt(2) * scene.contact_distance / c,
        "right_wall": scene.range_x / c,
        "top_wall": scene.range_y / c,
    }


def virial_sum(scene, rates):
    """Return the sum in the virial theorem, which is 1, from {class of events: rate}."""
    return math.fsum(weight * rates[event] for event, weight in virial_weights(scene).items())


# Small discs --------------------------------------------------------------------------------------


def overlap_of_two(scene):
    """Return q, the probability that two of the centres, drawn uniformly, overlap."""
    if scene.periodic:
        # On a ring the separation along x is uniform; along y it has the density 2 (B − v)/B².
        b, sigma = scene.range_y, scene.contact_distance
        reach = min(b, sigma)
        phi = math.asin(reach / sigma)
        whole = b * sigma * (phi + math.sin(phi) * math.cos(phi)) / 2 * sigma
        moment = sigma**3 * (1 - math.cos(phi) ** 3) / 3
        return 4 * (whole - moment) / (b * b * scene.width)
    two = Scene(scene.width, scene.height, scene.radius)
    return 1 - plain.volume_and_areas(two)[0] / (scene.range_x * scene.range_y) ** 2


# Many discs ---------------------------------------------------------------------------------------


def bulk_derivatives(scene):
    """Return approximate ``Derivatives`` of many discs, from an equation of state.

    PV/(N kT) is Z = (1 + η²/8)/(1 − η)², with η the packing fraction (Henderson, Mol. Phys. 30, 971
    (1975)). The rate of hops of a pair is taken as without other discs.
    """
    a, b, n, sigma = scene.range_x, scene.range_y, scene.discs, scene.contact_distance
    packing = min(0.9, n * math.pi * sigma * sigma / 4 / (scene.width * scene.height))
    z = (1 + packing * packing / 8) / (1 - packing) ** 2
    pairs = n * (n - 1) / 2
    return Derivatives(
        math.nan, 0.0 if scene.periodic else n * z / a, n * z / b, 2 * n * (z - 1) / sigma,
        pairs / a * max(0.0, 1 - sigma / b) ** 2, pairs / b * max(0.0, 1 - sigma / a) ** 2,
    )  # fmt: skip
