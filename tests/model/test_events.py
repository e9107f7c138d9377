"""The declarations of events, by kind.

Without it a new event could replace a published one, or a kind be forgotten.
"""

import re

import pytest

from twodiscs.model.events import AXIS, DECLARED, EVENTS, HOPS, SHELLS, WALLS, Event, by_kind
from twodiscs.model.scene import Scene

#: The names in published tables, in the order of their columns.
PUBLISHED = (
    Event("vertical_hop", "hop", "y"),
    Event("horizontal_hop", "hop", "x"),
    Event("disc_collision", "collision"),
    Event("right_wall", "wall", "x", +1),
    Event("top_wall", "wall", "y", +1),
    Event("any_wall", "walls"),
)


def test_what_was_published_stays_and_keeps_its_order():
    names = [event.name for event in PUBLISHED]
    assert [event for event in DECLARED.values() if event.name in names] == [*PUBLISHED]


def test_groups_of_events_follow_from_their_kinds():
    def of_kind(*kinds):
        return tuple(name for name, event in DECLARED.items() if event.kind in kinds)

    assert tuple(DECLARED) == EVENTS
    assert of_kind("hop") == HOPS
    assert of_kind("wall") == WALLS
    assert of_kind("hop", "collision", "wall") == SHELLS
    assert {name: event.axis for name, event in DECLARED.items() if event.axis} == AXIS
    assert tuple(AXIS) == of_kind("hop", "wall")
    assert tuple(name for name, event in DECLARED.items() if event.ways == 2) == HOPS
    places = {(event.kind, event.axis, event.side) for event in DECLARED.values()}
    assert len(places) == len(DECLARED)


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
    assert {event.name: found[event.name] for event in PUBLISHED} == {
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
