"""The virial theorem and the equation of state.

Without these tests a momentum or a weight of the virial theorem could be another one with effects.
"""

import math
from dataclasses import replace

import pytest
from effect_scenes import SCENES, exchanged

from twodiscs.model.scene import Scene
from twodiscs.theory import exact, flux, virial
from twodiscs.theory.n_discs import known_derivatives
from twodiscs_paper.studies.more_discs.measure import virial_sum, virial_weights


@pytest.mark.parametrize(
    "scene",
    [
        *(Scene(1.5, 1.0, radius) for radius in (1e-3, 0.1, 0.24, 0.3, 0.37, 0.383974)),
        *(Scene(3.0, 1.0, radius) for radius in (0.1, 0.4, 0.4999)),
        Scene(1.0, 4.0, 0.2),
        *(SCENES[name] for name in ("unequal", "rough", "balls")),
        replace(SCENES["unequal"], moment_of_inertia=0.3),
        replace(SCENES["balls"], radius_ratio=1.3, mass_ratio=0.4),
    ],
)
def test_virials_of_all_forces_add_up_to_twice_the_kinetic_energy(scene):
    """Every disc at every wall, by scenes that are turned and with the discs exchanged."""
    virials = []
    for axis in scene.axes:
        # The same scene with the walls of this axis to the right and to the left.
        sides = [scene.side(axis), *(scene.side(other) for other in scene.axes if other != axis)]
        here = replace(scene, **dict(zip(("width", "height", "depth"), sides, strict=False)))
        for one in (here, exchanged(here)[0]):
            # A momentum times a rate is an energy over a length, in any unit of mass.
            force = virial.momentum_per_hit(one) * exact.rate(one, "right_wall")
            virials.append((one.width - 2 * one.radius) * force)
    momentum = virial.momentum_per_hit(scene) / scene.fastest
    virials.append(-scene.contact_distance * momentum * exact.rate(scene, "disc_collision"))
    kinetic = 2 * len(scene.axes) / scene.velocity_components
    assert math.fsum(virials) == pytest.approx(kinetic, rel=1e-13, abs=1e-13 * max(virials))


@pytest.mark.parametrize("name", ["unequal", "rough", "balls", "channel"])
def test_the_pressure_of_points_is_that_of_an_ideal_gas(name):
    """Corrections are of the order of the radius over a side."""
    scene = replace(SCENES[name], radius=1e-9)
    pressure = virial.pressure_factor(scene, "top_wall") * exact.rate(scene, "top_wall")
    assert pressure == pytest.approx(1, abs=1e-7)


KNOWN = [
    Scene(1.5, 1.0, 0.2), Scene(1.5, 1.0, 0.38),
    *(Scene(*sides, discs=3) for sides in ((1.5, 1.0, 0.05), (1.5, 1.0, 0.28), (1.0, 1.5, 0.2))),
    *(Scene(*sides, discs=n) for n, *sides in (
        (5, 1.6, 0.6, 0.18), (5, 2.2e-6, 6e-7, 1.8e-7), (8, 2.7, 0.6, 0.18),
        (16, 7.0, 1.0, 0.29), (256, 120.0, 0.6, 0.18),
    )),
]  # fmt: skip


@pytest.mark.parametrize("scene", KNOWN, ids=repr)
def test_the_virial_theorem_holds(scene):
    found = flux.rates(scene, known_derivatives(scene, hops=False))
    size = found["right_wall"] * virial_weights(scene)["right_wall"]
    assert virial_sum(scene, found) == pytest.approx(1, abs=1e-11 * (1 + size))
