"""Relations for every number of discs: the virial theorem, bounds of the volume, small discs."""

import math

import numpy as np
import pytest

from twodiscs.model.scene import Scene
from twodiscs.theory import n_discs, virial
from twodiscs.theory.virial import flux_constant, weights

KNOWN = [
    Scene(1.5, 1.0, 0.2), Scene(1.5, 1.0, 0.38),
    *(Scene(*sides, discs=3) for sides in ((1.5, 1.0, 0.05), (1.5, 1.0, 0.28), (1.0, 1.5, 0.2))),
    Scene(2.2, 0.6, 0.18, discs=5), Scene(8.0, 0.5, 0.18, discs=16),
]  # fmt: skip


@pytest.mark.parametrize("scene", KNOWN, ids=repr)
def test_the_virial_theorem_holds(scene):
    found = virial.rates(scene, n_discs.known_derivatives(scene, hops=False))
    size = found["right_wall"] * virial.virial_weights(scene)["right_wall"]
    assert virial.virial_sum(scene, found) == pytest.approx(1, abs=1e-11 * (1 + size))


def test_two_discs_have_the_weights_of_a_scene():
    scene = Scene(1.5, 1.0, 0.2, discs=2)

    known = weights(Scene(1.5, 1.0, 0.2))
    for event, weight in virial.virial_weights(scene).items():
        # Four pairs of a disc and a wall are counted together here.
        each = weight * (4 if event.endswith("wall") else 1)
        assert each == pytest.approx(known[event], rel=1e-14)


def rates_of_small_discs(scene):
    """Return {class of events: rate} without hops, for small σ at fixed ranges A and B.

    They follow from V ≈ (AB)^N [1 − n (πσ²/(AB) − (4/3) σ³ (A + B)/(AB)²)], n = N(N − 1)/2. Wall
    hits are those of an ideal gas with the second virial coefficient, and collisions have the first
    two orders.
    """
    c, n = flux_constant(scene.velocity_components), scene.discs * (scene.discs - 1) / 2
    a, b, sigma = scene.range_x, scene.range_y, scene.contact_distance
    closed = math.pi * sigma**2 / (a * b)
    return {
        "disc_collision": c / math.sqrt(2) * n * (2 * closed / sigma)
        * (1 - 2 * sigma * (a + b) / (math.pi * a * b)),
        "right_wall": c * (scene.discs + n * closed) / a,
        "top_wall": c * (scene.discs + n * closed) / b,
    }  # fmt: skip


@pytest.mark.parametrize("discs", [2, 3])
def test_small_discs(discs):
    """The error of the first orders falls like the next one: σ³ for walls, σ² over collisions."""
    errors = {}
    for radius in (2e-3, 1e-3):
        scene = Scene(1.5, 1.0, radius, discs=discs)
        true = virial.rates(scene, n_discs.known_derivatives(scene))
        for event, rate in rates_of_small_discs(scene).items():
            errors.setdefault(event, []).append(abs(rate / true[event] - 1))
    for event, (large, small) in errors.items():
        assert small < 1e-3
        power = math.log2(large / small)
        assert power > (1.8 if event == "disc_collision" else 2.8), (event, errors)


def test_overlap_on_a_ring():
    """Against the mean over a grid of separations."""
    for height, radius in ((1.0, 0.2), (0.6, 0.18), (0.5, 0.2)):
        scene = Scene(1.5, height, radius, discs=2, periodic="x")
        b, sigma = scene.range_y, scene.contact_distance
        v = b * (np.arange(200_000) + 0.5) / 200_000
        closed = 2 * np.sqrt(np.maximum(sigma**2 - v**2, 0)) / scene.width
        mean = np.mean(2 * (b - v) / b * closed)
        assert virial.overlap_of_two(scene) == pytest.approx(mean, rel=1e-6)
