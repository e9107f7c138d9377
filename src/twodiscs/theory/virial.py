"""The virial theorem of Clausius for N discs: wall rates are pressures.

Without a field velocities times √mass are uniform on a sphere in D dimensions at total energy 1/2,
so that a component has the mean square 1/D. Passages through a surface have a rate ∝ |component|;
over them the mean of |component| is 1/(D c_D), with c_D of ``flux_constant``. A disc of mass m
gives the mean momentum 2√m/(D c_D) to a wall, and the discs give each other 2/(k D c_D), with
k = √(1/m1 + 1/m2). In four dimensions and for equal discs these are 3π/8 and 3π/(8√2).

By the theorem 2⟨K⟩ is the sum over walls of (distance of a centre at contact from the middle of the
box) × (momentum per time), minus σ × (momentum per time) of collisions. Divided by 2⟨K⟩ = 4/D, for
the four components of velocity, it is

    1 = [A ν_right + B ν_top − σ ν_coll/√8] / c_D

for two equal discs between walls, with rates ν over all initial conditions. For N discs, with the
rates of one disc at one wall and of collisions of any pair, √8 is √2 N. The volume is not needed.

With N discs, D components of velocity uniform on a sphere at total energy 1/2, all events of a
class together have the rates below. D is 2N, minus 1 if a momentum is conserved; it is 3N with the
spins of rough discs.

    collisions     −(c_D/√2) ∂lnV/∂σ
    walls of x     c_D ∂lnV/∂A                              walls of y likewise
    hops in x      √2 c_D Σ_pairs ∫ δ(x_i − x_j) / V        hops in y likewise

V is the volume of configuration space, a function of the ranges A and B of the centres and of the
contact distance σ. It scales as a length to the power 2N, which is another proof of the theorem:

    (A ν_x + B ν_y − √2 σ ν_coll) / (2N c_D) = 1

ν_x is the rate of all hits of both walls of x by any disc. At the same energy per disc times scale
as 1/√N.
"""

import math
from typing import NamedTuple

from twodiscs.model.events import DECLARED
from twodiscs.model.scene import Scene, check_scene
from twodiscs.theory import plain


def flux_constant(components):
    """Return c_D: the mean of |n·s| for a unit vector s uniform in D ``components``.

    2/π, 4/(3π), 16/(15π) in two, four and six dimensions.
    """
    half = components / 2
    return math.exp(math.lgamma(half) - math.lgamma(half + 0.5)) / math.sqrt(math.pi)


def momentum_per_hit(scene, event):
    """Return the mean momentum transfer in an ``event``, in the mass of disc 1 × the unit of speed.

    It is for disc 1 at a wall and for the collisions of the discs, without a field, in which it
    depends on the height.
    """
    components = scene.velocity_components
    normal = 1 / (components * flux_constant(components))
    return 2 * normal / (scene.fastest if event == "disc_collision" else 1.0)


def pressure_factor(scene, event):
    """Return the pressure of disc 1 on a wall, over that of an ideal gas, per rate of its hits.

    It is side × (momentum per hit)/kT, with kT = 1/D, because an ideal gas of one particle has the
    force kT/side on the wall at a distance ``side`` from the opposite one. ``event`` is one of
    ``WALLS``.
    """
    side = scene.side(DECLARED[event].axis)
    return side * scene.velocity_components * momentum_per_hit(scene, event)


def has_theorem(box):
    """Return whether the rates of events alone give the theorem for the scenes of a ``Box``.

    With unequal discs, balls, periodic axes or a field, the events do not include all forces, or a
    rate does not give their mean.
    """
    return not box.effects.keys() - {"moment_of_inertia", "friction"}


def weights(scene):
    """Return {event: weight} with which the rates over all initial conditions add up to 1.

    It is None without the theorem. For more than two discs the weights need no exact volume.
    """
    if not has_theorem(check_scene(scene)):
        return None
    per_rate = 1 / flux_constant(scene.velocity_components)
    pairs = math.sqrt(2) * scene.discs
    return {
        "disc_collision": -scene.contact_distance / pairs * per_rate,
        "right_wall": scene.range_x * per_rate,
        "top_wall": scene.range_y * per_rate,
    }


# Any number of discs ------------------------------------------------------------------------------


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
