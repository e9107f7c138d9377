"""The fifty digits of the paper could be wrong: antiderivatives give the same, with 150 of them."""

import math

import pytest
from mpmath import mp, mpf
from theory.antiderivatives import DIGITS, reference, reference_times, relative_error

from twodiscs.model.box import Box
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene
from twodiscs_paper.reference import (
    QUANTITIES,
    MpScene,
    contact_density,
    exact_numbers,
    largest_radius,
)

SCENES = [
    Scene(*lengths_given)
    for lengths_given in (
        (1.5, 1.0, 0.2), (1.5, 1.0, 0.3), (1.5, 1.0, 0.38), (1.0, 1.0, 0.27),
        (1.0, 1.7, 0.28), (3.0, 1.0, 0.35), (3.0, 1.0, 0.45),
    )
]  # fmt: skip
BOXES = [(1.5, 1.0), (1.0, 1.0), (2.0, 1.0), (1.0, 2.0), (3.0, 1.0), (1.0, 1.7), (1e6, 1), (1, 1e6)]


@pytest.fixture(autouse=True, scope="module")
def digits():
    """Work with many digits."""
    with mp.workdps(DIGITS):
        yield


# Digits -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("box", BOXES)
def test_antiderivatives_have_fifty_digits_even_next_to_the_largest_radius(box):
    scene = Scene(*box, Box(*box).largest_radius * (1 - 1e-12))
    found = reference(scene)
    with mp.workdps(400):
        for quantity, value in reference(scene).items():
            assert abs(found[quantity] - value) <= abs(value) * mpf(10) ** -50


def near_limits(box):
    """Yield scenes in all regimes, on both sides of the thresholds, and where discs hardly fit."""
    largest = Box(*box).largest_radius
    radii = [1e-9 * min(box), 0.1 * largest, 0.6 * largest, 0.9 * largest]
    for limit in (box[0] / 4, box[1] / 4):
        radii += [limit * (1 - 1e-9), limit, math.nextafter(limit, math.inf)]
    radii += [largest * (1 - room) for room in (1e-3, 1e-6, 1e-9)]
    return [Scene(*box, radius) for radius in radii if Box(*box).fits(radius)]


@pytest.mark.parametrize("box", BOXES)
def test_exact_numbers_have_the_digits_of_the_antiderivatives(box):
    for scene in near_limits(box):
        volume, areas, times = exact_numbers(scene)
        assert tuple(areas) == EVENTS
        found = volume | areas
        for quantity, value in reference(scene).items():
            assert relative_error(found.pop(quantity), value) < 1e-50, (scene, quantity)
        assert not found
        for event, time in reference_times(scene).items():
            if time is None:
                assert event not in times
            else:
                assert relative_error(times[event], time) < 1e-50, (scene, event)


def test_the_digits_do_not_depend_on_those_that_the_caller_works_with():
    scene = Scene(1.5, 1.0, 0.123)
    with mp.workdps(15):
        volume, areas, times = exact_numbers(scene)
    for quantity, value in reference(scene).items():
        assert relative_error((volume | areas)[quantity], value) < 1e-50
    for event, time in reference_times(scene).items():
        assert relative_error(times[event], time) < 1e-50


def test_every_number_has_the_name_that_tables_give_it():
    scene = SCENES[0]
    volume, areas, times = exact_numbers(scene)
    expected = {f"{event}_area": area for event, area in areas.items()} | volume
    expected |= {f"{event}_time": time for event, time in times.items()}
    q = MpScene.of(scene.width, scene.height, scene.radius)
    assert {name: quantity(q) for name, quantity in QUANTITIES.items()} == expected


# Their parts ------------------------------------------------------------------------------------


def test_a_scene_takes_numbers_for_exactly_what_they_are():
    q = MpScene.of(1.5, 1, mpf("0.1"))
    assert (q.w, q.h) == (mpf("1.5"), 1)
    assert q.r == mpf("0.1") != mpf(0.1)
    assert (q.a, q.b) == (mpf("0.65"), mpf("0.4"))


@pytest.mark.parametrize("scene", SCENES, ids=repr)
def test_the_contact_density_is_the_area_of_contact_per_square_of_the_distance(scene):
    """−∂V/∂σ² = A_coll/(2√2 σ)."""
    q = MpScene.of(scene.width, scene.height, scene.radius)
    with mp.workdps(60):
        expected = exact_numbers(scene)[1]["disc_collision"] / (4 * mp.sqrt(2) * q.r)
        assert relative_error(contact_density(q), expected) < 1e-15


@pytest.mark.parametrize("box", [(1.5, 1.0), (1.0, 1.0), (1.0, 1.7)])
def test_the_largest_radius_is_a_root(box):
    found = largest_radius(MpScene.of(*box, 0.1))
    w, h = map(mpf, box)
    assert relative_error(found, (w + h - mp.sqrt(2 * w * h)) / 2) < 1e-100
    assert float(found) == pytest.approx(Box(*box).largest_radius, rel=1e-15)
