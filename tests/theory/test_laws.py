"""Closed forms, and the laws of mean times where the discs are small and where events die out."""

import math
from dataclasses import replace

import pytest

from twodiscs.model import scene as scene_module
from twodiscs.model.box import Box
from twodiscs.model.events import AXIS, DECLARED, EVENTS, WALLS
from twodiscs.model.scene import Scene
from twodiscs.theory import exact, laws
from twodiscs.theory.laws import small_radius_time, threshold_time
from twodiscs_paper.studies.stability.closed_form import closed_form
from twodiscs_paper.studies.thresholds.measure import leading_law

PAPER = (1.5, 1.0)
BOXES = [PAPER, (1.0, 1.0), (2.0, 1.0), (1.0, 2.0), (3.0, 1.0), (1.0, 1.7)]
GOOD = Scene(*PAPER, 0.3)
UNEQUAL = Scene(*PAPER, 0.2, radius_ratio=0.5, field=0.1)


# Closed forms -----------------------------------------------------------------------------------


@pytest.mark.parametrize(("w", "h"), BOXES)
def test_closed_forms_agree_where_they_do_not_cancel(w, h):
    """Terms of order (wh)² leave an absolute error of some roundings of them."""
    for fraction in (0.01, 0.1, 0.3, 0.5, 0.6, 0.7, 0.8):
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
    """The error of the first-order laws is of second order: a hundredth at a tenth of r."""
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
    times = exact.mean_times(Scene(*PAPER, 1e-12))
    for event in EVENTS:
        limit = small_radius_time(Box(*PAPER), event)
        assert limit == (math.inf if event == "disc_collision" else pytest.approx(times[event]))


@pytest.mark.parametrize(
    ("box", "event", "order"),
    [
        *(((w, 1.0), event, 1) for event in EVENTS for w in (1.2, 1.0, 2.0)),
        *(((1.0, h), event, 1) for event in EVENTS for h in (1.2, 2.0)),
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
    ends = [wall for wall in WALLS if AXIS[wall] == "x"]
    assert finite == [event for event in EVENTS if event in ("disc_collision", *ends)]


@pytest.mark.parametrize("box", [PAPER, (1.0, 1.5), (3.0, 1.0), (1.0, 3.0)])
@pytest.mark.parametrize("wall", WALLS)
def test_walls_at_both_ends_have_the_same_laws(monkeypatch, box, wall):
    """Also where only one of the two is an event that is declared."""
    other = replace(DECLARED[wall], name="other_end", side=-DECLARED[wall].side)
    here = Box(*box).scene(0.9 * Box(*box).largest_radius)
    monkeypatch.setitem(DECLARED, "other_end", other)
    for module in (laws, scene_module):
        monkeypatch.setattr(module, "EVENTS", (*EVENTS, "other_end"))
    there = here.with_radius(here.radius)
    assert threshold_time(there, "other_end") == threshold_time(here, wall)
    assert small_radius_time(Box(*box), "other_end") == small_radius_time(Box(*box), wall)


# Bad input --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "call",
    [
        lambda: closed_form(UNEQUAL),
        lambda: threshold_time(UNEQUAL, "any_wall"),
        lambda: small_radius_time(Box.of(UNEQUAL), "any_wall"),
        lambda: leading_law(Box.of(UNEQUAL), "any_wall"),
    ],
)
def test_only_plain_scenes_have_closed_forms_and_limits(call):
    with pytest.raises(ValueError, match=r"must be plain .* it has radius_ratio, field"):
        call()
