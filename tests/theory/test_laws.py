"""Closed forms, and the laws of mean times where the discs are small and where events die out."""

import math
from dataclasses import replace

import pytest

from twodiscs.model import scene as scene_module
from twodiscs.model.box import Box
from twodiscs.model.events import DECLARED, EVENTS, WALLS
from twodiscs.model.scene import Scene
from twodiscs.theory import exact, laws
from twodiscs.theory.laws import (
    closed_form,
    leading_law,
    small_radius_time,
    threshold_time,
)

PAPER = (1.5, 1.0)
BOXES = [PAPER, (1.0, 1.0), (2.0, 1.0), (1.0, 2.0), (3.0, 1.0), (1.0, 1.7)]
GOOD = Scene(*PAPER, 0.3)
UNEQUAL = Scene(*PAPER, 0.2, radius_ratio=0.5, field=0.1)


# Closed forms -----------------------------------------------------------------------------------


@pytest.mark.parametrize("box", BOXES)
@pytest.mark.parametrize("fraction", [0.01, 0.1, 0.3, 0.5, 0.6, 0.7, 0.8])
def test_closed_forms_agree_where_they_do_not_cancel(box, fraction):
    """Terms of order (wh)² leave an absolute error of some roundings of them."""
    w, h = box
    scene = Scene(w, h, fraction * Box(w, h).largest_radius)
    closed, areas = closed_form(scene), exact.areas(scene)
    assert tuple(closed["areas"]) == EVENTS
    assert abs(closed["volume"] - exact.volume(scene)) < 1e-14 * (w * h) ** 2
    for event, area in closed["areas"].items():
        assert abs(area - areas[event]) < 1e-14 * w * h * (w + h)


def test_closed_forms_fail_near_the_largest_radius_as_documented():
    for delta in (1e-3, 1e-4):
        scene = Scene(*PAPER, Box(*PAPER).largest_radius * (1 - delta))
        error = abs(closed_form(scene)["volume"] / exact.volume(scene) - 1)
        assert 1e-3 < error * delta**4 / 1e-16 < 1e3


# Limits -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("box", [PAPER, (1.0, 1.0), (0.3, 2.0)])
def test_small_discs(box):
    """What the first-order laws leave out is of second order: a hundredth at a tenth of r."""
    w, h = box
    for event in EVENTS:
        errors = [
            exact.mean_times(Scene(w, h, r))[event] / small_radius_time(Box(w, h), event, radius=r)
            - 1
            for r in (1e-3 * min(box), 1e-4 * min(box))
        ]
        assert abs(errors[0]) < 1e-4
        assert errors[1] == pytest.approx(errors[0] / 100, rel=0.05, abs=1e-13)


def test_point_discs():
    w, h = PAPER
    limits = {
        "vertical_hop": 3 * math.pi * h / (4 * math.sqrt(2)),
        "horizontal_hop": 3 * math.pi * w / (4 * math.sqrt(2)),
        "disc_collision": math.inf,
        "right_wall": 3 * math.pi * w / 2,
        "top_wall": 3 * math.pi * h / 2,
        "any_wall": 3 * math.pi * w * h / (8 * (w + h)),
    }
    times = exact.mean_times(Scene(w, h, 1e-12))
    for event, limit in limits.items():
        assert small_radius_time(Box(w, h), event) == pytest.approx(limit, rel=1e-15)
        if event != "disc_collision":
            assert times[event] == pytest.approx(limit, rel=1e-11)
    assert times["disc_collision"] == pytest.approx(3 * w * h / (8 * math.sqrt(2) * 1e-12))


@pytest.mark.parametrize(
    ("box", "event", "order"),
    [
        *(((1.2, 1.0), event, 1) for event in EVENTS),
        *(((1.0, 1.2), event, 1) for event in EVENTS),
        *(((1.0, 1.0), event, 1) for event in EVENTS),
        *(((2.0, 1.0), event, 1) for event in EVENTS),
        *(((1.0, 2.0), event, 1) for event in EVENTS),
        ((3.0, 1.0), "horizontal_hop", 1),
        ((3.0, 1.0), "disc_collision", 2),
        ((3.0, 1.0), "right_wall", 2),
        ((3.0, 1.0), "vertical_hop", 2),
        ((1.0, 3.0), "vertical_hop", 1),
        ((1.0, 3.0), "horizontal_hop", 2),
        ((1.0, 3.0), "any_wall", 2),
    ],
)
def test_laws_at_the_threshold(box, event, order):
    """The error shrinks with the given power of the distance from the threshold."""
    w, h = box
    limit = Box(w, h).largest_radius
    if event == "vertical_hop":
        limit = min(limit, w / 4) if w < 2 * h else limit
    if event == "horizontal_hop":
        limit = min(limit, h / 4) if h < 2 * w else limit
    errors = []
    for delta in (1e-5, 1e-6):
        scene = Scene(w, h, limit * (1 - delta))
        errors.append(exact.mean_times(scene)[event] / threshold_time(scene, event) - 1)
    assert abs(errors[0]) < 1e-2
    assert errors[1] == pytest.approx(errors[0] / 10**order, rel=0.05, abs=1e-13)


def test_threshold_laws_as_written():
    w, h = PAPER
    scene = Scene(w, h, 0.37)
    law = 0.75 * math.pi * exact.volume(Scene(w, h, w / 4))
    law /= 16 * math.sqrt(2) * (h - w / 2) * (w / 4 - 0.37) ** 2
    assert threshold_time(scene, "vertical_hop") == pytest.approx(law, rel=1e-12)

    largest, delta = Box(w, h).largest_radius, 0.01
    scene = Scene(w, h, largest - delta)
    collision = 0.75 * math.pi * math.sqrt(w * h) * delta / (2 * largest)
    right = 0.75 * math.pi * math.sqrt(2 * w * h) * delta / (w - 2 * largest)
    assert threshold_time(scene, "disc_collision") == pytest.approx(collision, rel=1e-12)
    assert threshold_time(scene, "right_wall") == pytest.approx(right, rel=1e-12)

    delta = 0.01
    hop = 3 * math.pi * delta / (2 * math.sqrt(2))
    double = Scene(2, 1, 0.5 - delta)
    assert threshold_time(double, "vertical_hop") == pytest.approx(hop, rel=1e-12)
    collision = 3 * math.pi / (4 * math.sqrt(2)) * (3 - 2)
    slim = Scene(3, 1, 0.5 * (1 - 1e-9))
    assert threshold_time(slim, "disc_collision") == pytest.approx(collision, rel=1e-8)
    assert threshold_time(slim, "horizontal_hop") is None


@pytest.mark.parametrize("event", EVENTS)
@pytest.mark.parametrize("box", [PAPER, (1.0, 1.5), (1.0, 1.0), (2.0, 1.0), (3.0, 1.0)])
def test_the_leading_law_is_that_of_the_threshold_in_powers(box, event):
    """Hops that end before the discs jam get rare, all other times vanish or stay finite."""
    box = Box(*box)
    law = leading_law(box, event)
    limit = box.threshold(event)
    if law is None:
        ends = [threshold_time(box.scene(limit * (1 - d)), event) for d in (1e-5, 1e-6)]
        assert ends[1] == pytest.approx(ends[0], rel=1e-4)
        assert limit == box.largest_radius
        return
    assert law.limit == limit
    assert law.power == (-2 if limit < box.largest_radius else 1)
    for distance in (1e-4, 1e-6, 1e-8):
        scene = box.scene(limit * (1 - distance))
        expected = threshold_time(scene, event)
        assert law(scene.radius) == pytest.approx(expected, rel=2 * distance + 1e-5)


def test_what_stays_finite_in_a_slim_box_has_no_leading_law():
    finite = [event for event in EVENTS if leading_law(Box(3.0, 1.0), event) is None]
    assert finite == ["disc_collision", "right_wall"]


@pytest.mark.parametrize("box", [PAPER, (1.0, 1.5), (3.0, 1.0), (1.0, 3.0)])
@pytest.mark.parametrize("wall", WALLS)
def test_walls_at_both_ends_have_the_same_laws(monkeypatch, box, wall):
    """Also where only one of the two is an event that is declared."""
    here = Box(*box).scene(0.9 * Box(*box).largest_radius)
    monkeypatch.setitem(DECLARED, "other_end", replace(DECLARED[wall], name="other_end", side=-1))
    for module in (laws, scene_module):
        monkeypatch.setattr(module, "EVENTS", (*EVENTS, "other_end"))
    there = here.with_radius(here.radius)
    assert threshold_time(there, "other_end") == threshold_time(here, wall)
    assert small_radius_time(Box(*box), "other_end") == small_radius_time(Box(*box), wall)


# Bad input --------------------------------------------------------------------------------------


@pytest.mark.parametrize("function", [closed_form, lambda scene: threshold_time(scene, "any_wall")])
def test_only_plain_scenes_have_closed_forms_and_limits(function):
    with pytest.raises(ValueError, match=r"must be plain .* it has radius_ratio, field"):
        function(UNEQUAL)


def test_false_is_no_radius_of_small_discs():
    with pytest.raises(ValueError, match=r"^radius must "):
        small_radius_time(Box(1, 1), "any_wall", radius=False)


@pytest.mark.parametrize("law", [small_radius_time, leading_law])
def test_only_plain_boxes_have_limits(law):
    with pytest.raises(ValueError, match=r"must be plain .* it has radius_ratio, field"):
        law(Box.of(UNEQUAL), "any_wall")
