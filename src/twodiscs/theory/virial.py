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

For N discs, with the derivatives of ``flux``, it is

    (A ν_x + B ν_y − √2 σ ν_coll) / (2N c_D) = 1

because V scales as a length to the power 2N. ν_x is the rate of all hits of both walls of x by any
disc. At the same energy per disc times scale as 1/√N.
"""

import math

from twodiscs.model.events import DECLARED_EVENTS
from twodiscs.model.scene import check_scene
from twodiscs.theory.flux import flux_constant


def momentum_per_hit(scene):
    """Return the mean momentum of a hit of disc 1 at a wall, in its mass × the unit of speed.

    It is that without a field, in which it depends on the height.
    """
    components = scene.velocity_components
    return 2 / (components * flux_constant(components))


def pressure_factor(scene, event):
    """Return the pressure of disc 1 on a wall, over that of an ideal gas, per rate of its hits.

    It is side × (momentum per hit)/kT, with kT = 1/D, because an ideal gas of one particle has the
    force kT/side on the wall at a distance ``side`` from the opposite one. ``event`` is one of
    ``WALLS``.
    """
    side = scene.side(DECLARED_EVENTS[event].axis)
    return side * scene.velocity_components * momentum_per_hit(scene)


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
