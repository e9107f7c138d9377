"""Closed forms, and laws of limits.

Without these tests a closed form or a law of a limit could have another constant or power.
"""

import math

import pytest
from theory.antiderivatives import TURNED

from twodiscs.model.events import EVENTS, HOPS
from twodiscs.model.scene import Box, Scene
from twodiscs.theory import exact
from twodiscs.theory.laws import small_radius_time, threshold_time
from twodiscs_paper.studies.single import tail_constant
from twodiscs_paper.studies.stability.closed_form import closed_form
from twodiscs_paper.studies.thresholds.measure import leading_law

PAPER = (1.5, 1.0)
BOXES = [PAPER, (1.0, 1.0), (1.4, 0.7), (1.0, 2.0), (1.5, 0.5), (2.0, 3.4)]


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


# Limits -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("box", [PAPER, (1.0, 1.0), (0.3, 2.0)])
def test_small_discs(box):
    """The error of the first-order laws is of second order: a hundredth at a tenth of r.

    Without a radius they are limits.
    """
    w, h = box
    for event in EVENTS:
        limit = exact.mean_times(Scene(w, h, 1e-12))[event]
        limit = math.inf if event == "disc_collision" else pytest.approx(limit)
        assert small_radius_time(Box(w, h), event) == limit
        errors = [
            exact.mean_times(Scene(w, h, r))[event] / small_radius_time(Box(w, h), event, radius=r)
            - 1
            for r in (1e-3 * min(box), 1e-4 * min(box))
        ]
        assert abs(errors[0]) < 1e-4
        assert errors[1] == pytest.approx(errors[0] / 100, rel=0.05, abs=1e-13)


@pytest.mark.parametrize(
    ("box", "event", "order"),
    [
        # A side of 1 would hide a wrong power of it.
        *(((w, 0.5), event, 1) for event in EVENTS for w in (0.6, 0.5, 1.0)),
        *(((0.5, h), event, 1) for event in EVENTS for h in (0.6, 1.0)),
        ((1.5, 0.5), "horizontal_hop", 1),
        *(((1.5, 0.5), event, 2) for event in ("disc_collision", "right_wall", "vertical_hop")),
        ((0.5, 1.5), "vertical_hop", 1),
        *(((0.5, 1.5), event, 2) for event in ("horizontal_hop", "any_wall")),
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
@pytest.mark.parametrize("box", [PAPER, (0.6, 0.9), (0.5, 0.5), (1.4, 0.7), (1.5, 0.5)])
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
    assert (law.limit, law.power) == (limit, -2 if limit < box.largest_radius else 1)
    for distance in (1e-4, 1e-6, 1e-8):
        scene = box.scene(limit * (1 - distance))
        expected = threshold_time(scene, event)
        assert law(scene.radius) == pytest.approx(expected, rel=2 * distance + 1e-5)


# Tails ------------------------------------------------------------------------------------------


def test_tail_constants_of_blocked_drifts():
    """The study of tails measures their size; here are the symmetries and blocked events."""
    assert tail_constant(Scene(*PAPER, 0.3), "horizontal_hop") is None
    assert tail_constant(Scene(*PAPER, 0.3), "vertical_hop") == 0.0
    assert tail_constant(Scene(*PAPER, 0.38), "disc_collision") == 0.0
    scene = Scene(*PAPER, 0.1)
    for event in (*HOPS, "disc_collision"):
        turned = tail_constant(scene.turned(), TURNED[event])
        assert tail_constant(scene, event) == pytest.approx(turned, rel=1e-13)
