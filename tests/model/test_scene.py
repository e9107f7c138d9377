"""Scene: the geometry that it derives, against bisection in exact arithmetic."""

import math
import pickle
from dataclasses import FrozenInstanceError
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from twodiscs.model.box import Box
from twodiscs.model.checks import InputError
from twodiscs.model.events import EVENTS, HOPS
from twodiscs.model.scene import REGIMES, Scene, check_two

BOXES = [(1.5, 1.0), (3.0, 1.0), (1.0, 1.0), (2.0, 1.0), (1.0, 2.0), (1.0, 1.7), (1e-6, 1e6)]
sides = st.floats(-6, 6).map(lambda x: 10**x)


def largest_by_bisection(width, height):
    """The supremum of the radii at which centres in opposite corners are more than 2r apart."""
    low, high = Fraction(0), Fraction(min(width, height)) / 2
    for _ in range(70):
        radius = (low + high) / 2
        diagonal = (Fraction(width) - 2 * radius) ** 2 + (Fraction(height) - 2 * radius) ** 2
        low, high = (radius, high) if diagonal > (2 * radius) ** 2 else (low, radius)
    return float(low)


@pytest.mark.parametrize(("width", "height"), BOXES)
def test_largest_radius_is_where_the_discs_jam(width, height):
    assert Box(width, height).largest_radius == pytest.approx(
        largest_by_bisection(width, height), rel=4 * 2**-52
    )


@given(sides, sides)
def test_largest_radius_separates_what_fits_from_what_does_not(width, height):
    largest = Box(width, height).largest_radius
    assert largest == pytest.approx(Box(height, width).largest_radius, rel=4 * 2**-52)
    assert Box(width, height).fits(largest * (1 - 1e-9))
    assert not Box(width, height).fits(largest * (1 + 1e-9))


def test_discs_that_jam_do_not_fit():
    """In a box of 9/8 × 1 they jam at r = 5/16 exactly: centres at most (1/2, 3/8) apart touch."""
    box = Box(1.125, 1.0)
    assert box.largest_radius == 0.3125
    assert not box.fits(0.3125)
    assert box.fits(math.nextafter(0.3125, 0.0))


@pytest.mark.parametrize(
    ("width", "height", "radius", "regime", "components"),
    [
        (1.5, 1, 0.2, "all-hops", 1),
        (1.5, 1, 0.25, "vertical-hops", 2),  # zero room is blocked
        (1.5, 1, 0.3, "vertical-hops", 2),
        (1.5, 1, 0.375, "no-hops", 4),
        (1.5, 1, 0.38, "no-hops", 4),
        (1, 1.5, 0.3, "horizontal-hops", 2),
        (3, 1, 0.49, "vertical-hops", 2),
        (1, 1, 0.25, "no-hops", 4),
    ],
)
def test_regimes(width, height, radius, regime, components):
    scene = Scene(width, height, radius)
    assert scene.regime == regime
    assert regime in REGIMES
    assert scene.ergodic_components == components
    assert scene.is_possible("vertical_hop") == scene.vertical_hops
    assert scene.is_possible("horizontal_hop") == scene.horizontal_hops
    assert all(scene.is_possible(event) for event in {*EVENTS} - {*HOPS})


def test_derived_lengths():
    scene = Scene(1.5, 1, 0.25)
    assert (scene.range_x, scene.range_y, scene.contact_distance) == (1.0, 0.5, 0.5)
    assert scene.largest_radius == Box(1.5, 1).largest_radius
    assert scene.with_radius(0.1) == Scene(1.5, 1, 0.1)


def test_a_scene_is_frozen_and_holds_floats():
    scene = Scene(3, 1, Fraction(1, 4))
    assert scene == Scene(3.0, 1.0, 0.25)
    assert type(scene.width) is type(scene.radius) is float
    with pytest.raises(FrozenInstanceError):
        scene.width = 2.0


def test_a_copy_is_the_same_whatever_was_asked_before():
    """Cached values are not in a pickle, by which libraries compare arguments."""
    scene = Scene(1.5, 1.0, 0.25, periodic="x")
    new = pickle.dumps(scene)
    assert scene.axes
    assert scene.largest_radius
    assert pickle.dumps(scene) == new
    assert pickle.loads(new) == scene


SCENES = {
    "plain": Scene(1.5, 1.0, 0.2),
    "effects": Scene(1.5, 1.0, 0.2, mass_ratio=2.0),
    "many": Scene(1.5, 1.0, 0.15, discs=3),
}


@pytest.mark.parametrize("family", SCENES)
def test_a_scene_knows_its_family(family):
    assert SCENES[family].family == family


def test_all_discs_have_a_radius_and_a_mass():
    assert (SCENES["many"].radii, SCENES["many"].masses) == ((0.15,) * 3, (1.0,) * 3)
    assert (SCENES["effects"].radii, SCENES["effects"].masses) == ((0.2, 0.2), (1.0, 2.0))


def test_two_discs_are_required_in_one_sentence():
    assert check_two(SCENES["effects"], "shells") is SCENES["effects"]
    with pytest.raises(InputError, match=r"^discs must be 2 for shells, not 3$"):
        check_two(SCENES["many"], "shells")
