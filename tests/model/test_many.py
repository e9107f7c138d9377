"""N discs: what is accepted, where they fit, and what they are called."""

import itertools
import math

import numpy as np
import pytest

from twodiscs.model.box import Box
from twodiscs.model.checks import InputError
from twodiscs.model.events import AXIS, EVENTS
from twodiscs.model.many import Gas, largest_radius
from twodiscs.model.scene import Scene


@pytest.mark.parametrize("width", [1.0, 1.3, 1.5, 1.99, 2.0, 5.0])
def test_two_discs_fit_as_in_a_scene(width):
    assert largest_radius(2, width, 1.0) == pytest.approx(
        Scene(width, 1.0, 0.1).largest_radius, rel=1e-14
    )


@pytest.mark.parametrize("width", [1.0, 1.02, 1.05, 1.1, 1.3, 1.5, 2.0, 2.9, 3.0, 4.0])
def test_three_discs_fit_as_far_as_closed_forms_say(width):
    """A zigzag, the largest equilateral triangle, or a row."""
    total, short = width + 4, 1.0
    zigzag = (total - math.sqrt(total**2 - width**2 - 4)) / 2
    c = 7 - 4 * math.sqrt(3)
    b = (4 - 2 * math.sqrt(3)) * (width + 1)
    triangle = (b - math.sqrt(b * b - 4 * c * (width**2 + 1 - math.sqrt(3) * width))) / (2 * c)
    a, height = width - 2 * triangle, 1 - 2 * triangle
    is_triangle = height > a * math.sqrt(3) / 2
    expected = min(triangle if is_triangle else zigzag, short / 2)
    assert largest_radius(3, width, 1.0) == pytest.approx(expected, rel=1e-13)


@pytest.mark.parametrize("discs", [2, 3, 4, 5, 8, 13, 64])
@pytest.mark.parametrize("sides", [(1.5, 1.0), (1.0, 1.0), (1.0, 6.0), (20.0, 1.0)])
@pytest.mark.parametrize("periodic", ["", "x"])
def test_arrangements_fit(discs, sides, periodic):
    largest = largest_radius(discs, *sides, periodic)
    gas = Gas(discs, *sides, largest * (1 - 1e-9), periodic)
    centres = gas.arrangement
    assert len(centres) == discs
    for (x, y), (other_x, other_y) in itertools.combinations(centres, 2):
        dx = abs(x - other_x)
        dx = min(dx, gas.width - dx) if periodic else dx
        assert math.hypot(dx, y - other_y) >= gas.contact_distance
    assert max(abs(x) for x, _ in centres) <= gas.range_x / 2 * (1 + 1e-15)
    assert max(abs(y) for _, y in centres) <= gas.range_y / 2 * (1 + 1e-15)


def test_names():
    gas = Gas(5, 1.5, 1.0, 0.1)
    assert gas.velocity_components == 10
    assert Gas(5, 1.5, 1.0, 0.1, "x").velocity_components == 9
    assert gas.multiplicity("right_wall") == 10
    assert gas.multiplicity("disc_collision") == 1
    assert gas.turned() == Gas(5, 1.0, 1.5, 0.1)
    assert not gas.is_ordered
    assert Gas(5, 3.0, 0.6, 0.18).is_ordered
    assert not Gas(5, 3.0, 0.6, 0.18, "x").is_ordered


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((1, 1.5, 1.0, 0.1), "discs must be an integer from 2 to 64, not 1"),
        ((65, 1.5, 1.0, 0.1), "discs must be an integer from 2 to 64, not 65"),
        ((3.0, 1.5, 1.0, 0.1), "discs must be an integer"),
        ((3, 1.5, 1.0, 0.31), "radius 0.31 does not fit: of 3 discs in a box of 1.5 × 1.0"),
        ((3, 1.5, -1.0, 0.1), "height must be a positive"),
        ((3, 1.5, 1.0, 0.1, "y"), "periodic must be left out or x for more than two discs"),
        ((2, 1.5, 1.0, 0.376, "x"), "radius 0.376 does not fit"),
    ],
)
def test_bad_input_is_one_sentence(arguments, message):
    with pytest.raises(InputError, match=message):
        Gas(*arguments)


def test_a_ring_is_not_turned():
    with pytest.raises(InputError, match="cannot be turned"):
        Gas(3, 1.5, 1.0, 0.1, "x").turned()


# As a scene --------------------------------------------------------------------------------------


def test_a_scene_of_two_discs_does_not_know_that_there_may_be_more():
    box, scene = Box(1.5, 1.0), Scene(1.5, 1.0, 0.2)
    assert box == Box(1.5, 1.0, {}, 2)
    assert box.parameters() == {"height": 1.0, "width": 1.5}
    assert repr(box) == "Box(width=1.5, height=1.0, effects={})"
    assert hash(box) == hash((1.5, 1.0))
    assert repr(scene) == "Scene(1.5, 1.0, 0.2)"
    assert scene == Scene(1.5, 1.0, 0.2, discs=2)
    assert scene.is_plain
    assert scene.calls_for == box.calls_for == {}


def test_a_scene_of_more_discs_is_its_gas():
    scene = Scene(1.5, 1.0, 0.15, discs=3)
    box, gas = Box.of(scene), Gas(3, 1.5, 1.0, 0.15)
    assert scene.gas == gas
    assert Box(**box.parameters()) == box
    assert box.scene(0.15) == scene == eval(repr(scene), {"Scene": Scene})
    assert box.parameters()["discs"] == 3
    assert not scene.is_plain
    assert scene.effects == {}
    assert scene.calls_for == {"discs": 3}
    assert scene.events == EVENTS
    assert scene.velocity_components == 6
    assert scene.multiplicity("top_wall") == 6
    assert scene.largest_radius == box.largest_radius == gas.largest_radius
    assert (scene.unit("volume"), scene.unit("any_wall_area")) == ("length⁶", "length⁵")
    assert str(scene) == "3 discs of radius 0.15 in a box of 1.5 × 1.0"
    ring = Scene(1.5, 1.0, 0.15, periodic="x", discs=12)
    assert ring.velocity_components == 23
    assert ring.events == tuple(event for event in EVENTS if AXIS.get(event) != "x")
    assert ring.unit("volume") == "length²⁴"


def level_and_apart(gas, axis, tries=200_000):
    """Return the largest least distance found of three discs, two of them level along ``axis``."""
    rng = np.random.default_rng(1)
    x, y = (rng.uniform(0, side, (3, tries)) for side in (gas.range_x, gas.range_y))
    # Places at walls are where the largest distances are.
    for places, side in ((x, gas.range_x), (y, gas.range_y)):
        places[rng.random((3, tries)) < 0.4] = 0.0
        places[rng.random((3, tries)) < 0.3] = side
    level = y if axis == "y" else x
    level[1] = level[0]
    pairs = list(itertools.combinations(range(3), 2))
    return np.min([np.hypot(x[i] - x[j], y[i] - y[j]) for i, j in pairs], axis=0).max()


@pytest.mark.parametrize("width", [1.0, 1.05, 1.2, 1.5, 2.5])
@pytest.mark.parametrize("axis", ["x", "y"])
def test_hops_of_three_discs_end_where_two_of_them_cannot_be_level(width, axis):
    """Draws of three discs are level as long as it is possible, and never beyond."""
    box = Box(width, 1.0, discs=3)
    end = box.threshold({"x": "horizontal_hop", "y": "vertical_hop"}[axis])
    for factor, possible in ((0.97, True), (1.0001, False)):
        radius = factor * end
        if radius < box.largest_radius:
            gas = Gas(3, width, 1.0, radius)
            assert gas.can_be_level(axis) is possible
            assert bool(level_and_apart(gas, axis) > gas.contact_distance) is possible


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"discs": 1}, "discs must be an integer from 2 to 64, not 1"),
        ({"discs": 65}, "discs must be an integer from 2 to 64, not 65"),
        ({"discs": 3.0}, "discs must be an integer of at least 2, not 3.0"),
        ({"discs": True}, "discs must be an integer of at least 2, not True"),
        ({"discs": 3, "field": 1.0}, "field must be left out with 3 discs"),
        ({"discs": 3, "depth": 1.0}, "depth must be left out with 3 discs"),
        ({"discs": 3, "periodic": "xy"}, "periodic must be left out or x for more than two discs"),
        ({"discs": 4, "radius": 0.4}, "radius 0.4 does not fit: of 4 discs"),
        ({"discs": 64, "width": 1e5}, "width and height must be in a unit of length in which"),
    ],
)
def test_what_does_not_go_with_more_discs_is_refused(values, message):
    with pytest.raises(InputError, match=message):
        Scene(**{"width": 1.5, "height": 1.0, "radius": 0.1} | values)
