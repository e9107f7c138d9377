"""The events that are declared, and what modules make of their kinds."""

import re

import pytest

from twodiscs.model.events import AXIS, DECLARED, EVENTS, HOPS, SHELLS, WALLS, by_kind
from twodiscs.model.scene import Scene


def test_groups_of_events_follow_from_their_kinds():
    # Published tables have their columns in this order.
    assert EVENTS == (
        "vertical_hop", "horizontal_hop", "disc_collision", "right_wall", "top_wall", "any_wall"
    )  # fmt: skip
    assert (EVENTS[:2], EVENTS[3:5], EVENTS[:5]) == (HOPS, WALLS, SHELLS)
    assert AXIS == {
        "vertical_hop": "y", "horizontal_hop": "x", "right_wall": "x", "top_wall": "y"
    }  # fmt: skip
    assert [name for name, event in DECLARED.items() if event.sides == 2] == list(HOPS)


@pytest.mark.parametrize("event", DECLARED.values(), ids=DECLARED)
def test_an_event_has_its_place_where_its_axis_has_walls(event):
    for periodic in ("", "x", "y", "xy"):
        walls = {"x", "y"} - set(periodic)
        needed = {event.axis} & walls if event.axis else walls or event.kind == "collision"
        assert (event.name in Scene(1.5, 1.0, 0.2, periodic=periodic).events) == bool(needed)


MAKERS = {
    "hop": lambda event: f"hop along {event.axis}",
    "collision": lambda event: "collision",
    "wall": lambda event: f"wall at {event.side:+d}{event.axis}",
    "walls": lambda event: None,
}


def test_every_event_that_is_wanted_gets_what_the_maker_of_its_kind_returns():
    found = by_kind("here.py", MAKERS)
    assert tuple(found) == EVENTS
    assert tuple(by_kind("here.py", {"hop": MAKERS["hop"]}, HOPS)) == HOPS
    assert found == {
        "vertical_hop": "hop along y",
        "horizontal_hop": "hop along x",
        "disc_collision": "collision",
        "right_wall": "wall at +1x",
        "top_wall": "wall at +1y",
        "any_wall": None,
    }


@pytest.mark.parametrize("kind", MAKERS)
def test_a_forgotten_kind_is_an_error_with_a_sentence(kind):
    makers = {name: maker for name, maker in MAKERS.items() if name != kind}
    first = next(event.name for event in DECLARED.values() if event.kind == kind)
    sentence = f"here.py knows events of kind {', '.join(makers)}, not {kind} as {first} is"
    with pytest.raises(TypeError, match=f"^{re.escape(sentence)}$"):
        by_kind("here.py", makers)
