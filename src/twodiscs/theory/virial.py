"""The virial theorem of Clausius for N discs: wall rates are pressures.

Without a field velocities times √mass are uniform on a sphere in D dimensions at total energy 1/2,
so that a component has the mean square 1/D, and over the passages through a surface, which come at
a rate ∝ |component|, the mean size 1/(D c_D), with c_D of ``flux.constant``. In the mean a
disc of mass m gives the momentum 2√m/(D c_D) to a wall, and the discs give each other 2/(k D c_D),
k = √(1/m1 + 1/m2). In four dimensions and for equal discs these are 3π/8 and 3π/(8√2).

The theorem says that 2⟨K⟩ is the sum over walls of (distance of a centre at contact from the middle
of the box) × (momentum per time), less σ × (momentum per time) of collisions. Over 2⟨K⟩ = 4/D, the
share of the four components of velocity, it is

    1 = [A ν_right + B ν_top − σ ν_coll/√8] / c_D

for two equal discs between walls, with rates ν over all initial conditions. For N of them, with the
rates of one disc at one wall and of collisions of any pair, √8 is √2 N. No volume has to be known.
"""

import math

from twodiscs.model.checks import InputError, check_choice
from twodiscs.model.events import DECLARED, WALLS
from twodiscs.model.scene import check_scene
from twodiscs.theory.flux import constant


def momentum_per_hit(scene, event):
    """Return the mean momentum handed over in an ``event``, in the mass of disc 1 × its speed.

    For disc 1 at a wall and for the collisions of the discs. Raises ``InputError`` for anything
    that is not a ``Scene``, in a field, where it depends on the height, and for other events.
    """
    check_choice("event", event, (*WALLS, "disc_collision"))
    if check_scene(scene).field:
        raise InputError(f"field must be 0, not {scene.field!r}: momenta depend on the height")
    components = scene.velocity_components
    normal = 1 / (components * constant(components))
    if event == "disc_collision":
        return 2 * normal / scene.fastest
    return 2 * normal


def pressure_factor(scene, event):
    """Return what turns the rate of disc 1 at a wall into its pressure, over that of an ideal gas.

    That is side × (momentum per hit)/kT, with kT = 1/D: the force of an ideal gas of one particle
    on the wall at a distance of ``side`` from the opposite one is kT/side. ``event`` is
    one of ``WALLS``. Raises ``InputError`` for another one, for anything that is not a
    ``Scene``, and in a field.
    """
    check_choice("event", event, WALLS)
    momentum = momentum_per_hit(scene, event)
    side = scene.side(DECLARED[event].axis)
    return side * scene.velocity_components * momentum


def weights(scene):
    """Return {event: weight} with which the rates over all initial conditions add up to 1.

    None where the events do not tell all forces, or a rate not their mean: for unequal discs, balls
    and periodic axes, and in a field. For more than two discs see ``many.rates``, from where the
    weights are; no exact volume is needed. Raises ``InputError`` for anything that is not a
    ``Scene``.
    """
    if check_scene(scene).effects.keys() - {"moment_of_inertia"}:
        return None
    per_rate = 1 / constant(scene.velocity_components)
    pairs = math.sqrt(2) * scene.discs
    return {
        "disc_collision": -scene.contact_distance / pairs * per_rate,
        "right_wall": scene.range_x * per_rate,
        "top_wall": scene.range_y * per_rate,
    }
