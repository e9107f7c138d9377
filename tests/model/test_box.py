"""A box and its effects: its scenes and where they end, its plain values, and nonsense refused."""

import json
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from twodiscs.model.box import Box
from twodiscs.model.effects import ABSENT
from twodiscs.model.events import EVENTS, HOPS
from twodiscs.model.scene import Scene

PAPER = Box(1.5, 1.0)
EFFECTS = [
    {"radius_ratio": 0.5, "mass_ratio": 2.0},
    {"periodic": "xy"},
    {"field": 1.0},
    {"moment_of_inertia": 0.5},
    {"periodic": "z", "depth": 1.2},
]
sides = st.floats(-6, 6).map(lambda x: 10**x)


# Scenes and plain values ------------------------------------------------------------------------


def test_a_plain_box_does_not_know_that_there_are_effects():
    assert PAPER.parameters() == {"height": 1.0, "width": 1.5}
    assert PAPER.scene(0.1) == Scene(1.5, 1.0, 0.1)
    assert PAPER == Box(1.5, 1.0, dict(ABSENT)) == Box(**PAPER.parameters())
    assert Box.of(Scene(1.5, 1.0, 0.1)) == PAPER


@pytest.mark.parametrize("effects", EFFECTS, ids=str)
def test_a_box_makes_the_round_trip_through_json(effects):
    box = Box(1.5, 1.0, effects)
    assert Box(**json.loads(json.dumps(box.parameters()))) == box
    assert box.scene(0.1) == Scene(1.5, 1.0, 0.1, **effects)
    assert Box.of(box.scene(0.1)) == box


@pytest.mark.parametrize("effects", EFFECTS, ids=str)
def test_the_same_box_is_equal_and_has_the_same_hash_and_parameters(effects):
    """Jobs are named by their parameters: order and spelling of the effects must not matter."""
    spelled = dict(reversed((ABSENT | effects).items()))
    spelled = {k: int(v) if v in (1.0, 2.0) else v for k, v in spelled.items()}
    if "periodic" in effects:
        spelled["periodic"] = effects["periodic"][::-1]
    box, other = Box(1.5, 1.0, effects), Box(1.5, 1, spelled)
    assert box == other
    assert hash(box) == hash(other)
    assert json.dumps(box.parameters()) == json.dumps(other.parameters())
    assert list(box.effects) == sorted(effects)
    assert list(box.parameters()) == ["effects", "height", "width"]
    # The result is a copy.
    box.parameters()["effects"].clear()
    assert box == other


def test_boxes_that_differ_are_not_equal():
    boxes = [PAPER, PAPER.turned(), Box(1.5, 1.1), *(Box(1.5, 1.0, e) for e in EFFECTS)]
    assert len(set(boxes)) == len(boxes)


def test_sides():
    assert (PAPER.sides, PAPER.shortest) == ((1.5, 1.0), 1.0)
    assert Box(1.5, 1.0, {"depth": 0.5}).sides == (1.5, 1.0, 0.5)
    assert Box(1.5, 1.0, {"depth": 0.5}).shortest == 0.5
    assert PAPER.turned() == Box(1.0, 1.5)
    assert Box(1.5, 1.0, {"periodic": "x"}).turned() == Box(1.0, 1.5, {"periodic": "y"})
    with pytest.raises(ValueError, match=r"field must be 0 to exchange the axes, not 1\.0"):
        Box(1.5, 1.0, {"field": 1.0}).turned()


@pytest.mark.parametrize("effects", EFFECTS, ids=str)
def test_a_tiny_scene_is_far_below_every_threshold(effects):
    box = Box(1.5, 1.0, effects)
    assert Box.of(box.tiny) == box
    assert max(box.tiny.radii) <= 1e-6
    assert all(box.tiny.is_possible(hop) for hop in HOPS if hop in box.tiny.events)


# Radii at which something ends ------------------------------------------------------------------


@pytest.mark.parametrize(
    ("width", "height", "thresholds"),
    [
        (1.5, 1.0, (0.25, 0.375)),
        (1.0, 1.5, (0.25, 0.375)),
        (3.0, 1.0, (0.25,)),  # w/4 is beyond the largest radius
        (2.0, 1.0, (0.25,)),
        (1.0, 1.0, (0.25,)),
    ],
)
def test_thresholds_of_a_plain_box(width, height, thresholds):
    box = Box(width, height)
    assert box.thresholds == thresholds
    for hop, across in zip(HOPS, (width, height), strict=True):
        assert box.blocking_radius(hop) == across / 4
        assert box.threshold(hop) == min(across / 4, box.largest_radius)
    others = {*EVENTS} - {*HOPS}
    assert all(box.threshold(event) == box.largest_radius for event in others)
    assert box.last_radius == box.largest_radius


#: Effects, and where hops along y and x end by the geometry: None where they have no place, "last"
#: where they go on to the last radius.
ENDS = [
    # σ = (1 + ratio) r is half the side.
    ({"radius_ratio": 1.5}, 1.5 / 5, 1.0 / 5),
    ({"radius_ratio": 0.5}, "last", 1.0 / 3),
    ({"mass_ratio": 3.0}, 1.5 / 4, 1.0 / 4),
    ({"moment_of_inertia": 0.5}, 1.5 / 4, 1.0 / 4),
    # The image is as far away as the wall allows.
    ({"periodic": "x"}, 1.5 / 4, None),
    ({"periodic": "y"}, None, 1.0 / 4),
    ({"periodic": "xy"}, None, None),
    # Balls pass each other until a disc jams in the rectangle across.
    ({"depth": 1.2}, (2.7 - math.sqrt(3.6)) / 2, (2.2 - math.sqrt(2.4)) / 2),
    # One disc on top of the other takes 2 r g of the energy 1/2.
    ({"field": 1.5}, 1.5 / 4, 1 / 6),
    ({"field": 0.9}, 1.5 / 4, 1.0 / 4),
]


@pytest.mark.parametrize(("effects", "vertical", "horizontal"), ENDS, ids=str)
def test_thresholds_with_effects_follow_from_the_geometry(effects, vertical, horizontal):
    box = Box(1.5, 1.0, effects)
    inner = set()
    for hop, end in zip(HOPS, (vertical, horizontal), strict=True):
        found = box.threshold(hop)
        if end is None:
            assert found is None
        elif end == "last":
            assert found == box.last_radius
        else:
            assert found == pytest.approx(end, rel=1e-15)
            inner.add(found)
    assert box.thresholds == tuple(sorted(inner))

    # Events that are no hops are possible up to the last radius.
    last = box.scene(math.nextafter(box.last_radius, 0))
    for event in {*EVENTS} - {*HOPS}:
        expected = box.last_radius if last.is_possible(event) else None
        assert box.threshold(event) == expected
    assert not box.fits(box.last_radius)
    assert box.last_radius <= box.largest_radius * (1 + 1e-15)


def test_a_disc_that_reaches_the_top_only_if_it_is_large_has_no_threshold_before_the_last():
    """The larger the disc, the less it has to be lifted to touch the top."""
    box = Box(1.5, 1.0, {"field": 1.2})
    assert not box.scene(0.25).is_possible("top_wall")
    assert box.scene(0.3).is_possible("top_wall")
    assert box.threshold("top_wall") == box.last_radius
    assert Box(1.5, 10.0, {"field": 1.2}).threshold("top_wall") is None


@pytest.mark.parametrize("width", [0.6, 0.7])
def test_a_field_ends_the_scenes_where_the_energy_does_not_lift_one_disc_onto_the_other(width):
    box = Box(width, 1.5, {"field": 1.5})
    # Above it the discs lie askew in the width, √(σ² − (w − σ)²) g = 1/2.
    end = (width / 2 + 1 / (18 * width)) / 2
    assert box.last_radius == pytest.approx(end, rel=1e-15)
    assert box.last_radius < box.largest_radius
    assert not box.fits(box.last_radius)
    assert box.fits(math.nextafter(box.last_radius, 0))


@given(sides, sides)
def test_ends_are_found_to_the_last_digit(width, height):
    """The closed forms of a plain box: w/4 or the largest radius, which ``fits`` decides."""
    box = Box(width, height)
    found = box.end(lambda scene: True)
    assert not box.fits(found)
    assert box.fits(math.nextafter(found, 0))
    hop = box.end(lambda scene: scene.vertical_hops)
    assert hop == (width / 4 if box.fits(math.nextafter(width / 4, 0)) else found)


def test_what_never_holds_ends_at_next_to_nothing():
    assert Box(1, 1).end(lambda scene: False) < 1e-18
