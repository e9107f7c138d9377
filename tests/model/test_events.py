"""The declarations of events, by kind.

Without it an event could be counted where its axis has no walls, or a kind be forgotten.
"""

import re

import pytest

from twodiscs.model.events import DECLARED_EVENTS, by_kind
from twodiscs.model.scene import Scene

KINDS = ("hop", "collision", "wall", "walls")


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
