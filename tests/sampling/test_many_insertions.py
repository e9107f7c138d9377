"""Volume and areas of many discs by insertions.

Without these tests insertions could have another volume or area than theory, or an error that is
too small.
"""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from twodiscs.analysis.scores import z_mean, z_spread
from twodiscs.model.scene import Scene
from twodiscs.sampling.many import insertions
from twodiscs.theory import exact
from twodiscs.theory.equation_of_state import pair_overlap
from twodiscs.theory.n_discs import known_derivatives

GASES = [
    Scene(1.5, 1.0, 0.2, discs=2),
    Scene(1.5, 1.0, 0.15, discs=3),
    Scene(1.5, 1.0, 0.25, discs=3),
    Scene(1.0, 1.5, 0.28, discs=3),
    Scene(1.6, 0.6, 0.18, discs=4),
    Scene(3.5, 0.6, 0.18, discs=8),
    Scene(0.6, 2.5, 0.18, discs=5),
]


@pytest.mark.parametrize("scene", GASES, ids=repr)
def test_volume_and_areas_are_exact(scene):
    """Five sigma of the mean score of each and, where small samples have a score, of the spread."""
    number = 1 if scene.radius == 0.28 else 24
    samples = [insertions.sample(scene, 200_000 // number, seed) for seed in range(number)]
    found, errors = np.swapaxes(np.array(samples, float), 0, 1)
    for value, error, true in zip(found.T, errors.T, known_derivatives(scene), strict=True):
        z = (value - true)[error > 0] / error[error > 0]
        assert z.size == (number if true else 0)
        assert not z.size or abs(z_mean(z)) < 5 > abs(z_spread(z))


@pytest.mark.parametrize(("side", "discs"), [(1.5, 3), (10.0, 7)])
def test_a_variance_that_rounds_below_zero_is_no_error(side, discs):
    """Nearly all insertions have room."""
    _, errors = insertions.sample(Scene(side, 0.7 * side, 1e-5 * side, discs=discs), 1, 1)
    assert errors.log_volume == 0 <= min(errors)


WITHOUT_THEORY = [Scene(1.5, 1.0, 0.12, discs=4, periodic=axes) for axes in ("", "x")]
WITHOUT_THEORY += [Scene(1.2, 1.0, 0.25, discs=3, periodic="x")]


@pytest.mark.parametrize("scene", WITHOUT_THEORY, ids=repr)
def test_the_volume_is_that_of_rejection(scene):
    """Five sigma of both, where there is no exact value; with the images of a ring."""
    rng, n = np.random.default_rng(3), 200_000
    x = scene.range_x * rng.random((scene.discs, n))
    y = scene.range_y * rng.random((scene.discs, n))
    free = np.ones(n, bool)
    for i, j in itertools.combinations(range(scene.discs), 2):
        dx = np.abs(x[i] - x[j])
        dx = np.minimum(dx, scene.width - dx) if scene.periodic else dx
        free &= dx**2 + (y[i] - y[j]) ** 2 >= scene.contact_distance**2
    found, errors = insertions.sample(scene, 100_000, 4)
    rejected = np.log(free.mean()) + scene.discs * np.log(scene.range_x * scene.range_y)
    error = np.sqrt((1 - free.mean()) / free.mean() / n)
    assert abs(found.log_volume - rejected) < 5 * np.hypot(error, errors.log_volume)
    assert (found.per_width == errors.per_width == 0) == bool(scene.periodic)


@pytest.mark.parametrize(("radius", "periodic"), [(0.2, ""), (0.2, "x"), (0.3, "x"), (0.2, "y")])
def test_the_overlap_of_a_pair_is_that_of_two_discs_alone(radius, periodic):
    """Also on a ring so low that discs at opposite walls may touch."""
    two = Scene(2.0, 1.0, radius, periodic=periodic)
    overlap = pair_overlap(replace(two, discs=3))
    assert overlap == pytest.approx(1 - exact.free_fraction(two), rel=1e-12)


@pytest.mark.parametrize(("periodic", "walls"), [("", ["right", "top"]), ("x", ["top"])])
def test_the_area_of_all_walls_comes_with_those_of_each_side(periodic, walls):
    scene = replace(GASES[1], periodic=periodic)
    for wanted, more in (("any_wall_area", walls), ("disc_collision_area", [])):
        made = insertions.insertion_sampler(scene, [wanted], 0.02, 1).constants["quantities"]
        assert {*made} - {wanted} == {"volume", *(f"{wall}_wall_area" for wall in more)}
