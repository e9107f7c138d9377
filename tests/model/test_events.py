"""The declarations of events, by kind.

Without it a new event could replace a published one, or a kind be forgotten.
"""

import re

import pytest

from twodiscs.model.events import DECLARED_EVENTS, Event, by_kind
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

KINDS = ("hop", "collision", "wall", "walls")


def test_what_was_published_stays_and_keeps_its_order():
    names = [event.name for event in PUBLISHED]
    assert [event for event in DECLARED_EVENTS.values() if event.name in names] == [*PUBLISHED]


@pytest.mark.parametrize("event", DECLARED_EVENTS.values(), ids=DECLARED_EVENTS)
def test_an_event_has_its_place_where_its_axis_has_walls(event):
    for periodic in ("", "x", "y", "xy"):
        walls = {"x", "y"} - set(periodic)
        needed = {event.axis} & walls if event.axis else walls or event.kind == "collision"
        assert (event.name in Scene(1.5, 1.0, 0.2, periodic=periodic).events) == bool(needed)


@pytest.mark.parametrize("kind", KINDS)
def test_a_forgotten_kind_is_an_error_with_a_sentence(kind):
    makers = dict.fromkeys([name for name in KINDS if name != kind], lambda event: None)
    first = next(event.name for event in DECLARED_EVENTS.values() if event.kind == kind)
    sentence = f"here.py knows events of kind {', '.join(makers)}, not {kind} as {first} is"
    with pytest.raises(TypeError, match=f"^{re.escape(sentence)}$"):
        by_kind("here.py", makers)
