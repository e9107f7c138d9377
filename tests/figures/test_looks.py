"""Looks: every event has its own, and a name that people use."""

import runpy

import pytest

from twodiscs.figures import style
from twodiscs.figures.style import _LOOKS, LOOKS, SIZES, name_of
from twodiscs.model import events
from twodiscs.model.events import EVENTS, HOPS


def test_either_colour_or_marker_tells_events_apart():
    assert tuple(LOOKS) == EVENTS
    for part in zip(*LOOKS.values(), strict=True):
        assert len(set(part[:6])) == min(len(EVENTS), 6)


def test_looks_of_events_to_come_differ_from_all_others():
    assert len(set(_LOOKS)) == len(_LOOKS)
    assert {marker for _, marker in _LOOKS} <= set(SIZES)


def test_events_without_a_look_are_told(monkeypatch):
    monkeypatch.setattr(events, "EVENTS", tuple("abcdefghi"))
    with pytest.raises(TypeError, match=r"style\.py has 8 looks, too few for 9 events"):
        runpy.run_path(style.__file__)


def test_names_are_plural_but_for_walls():
    names = {event: name_of(event) for event in EVENTS}
    assert names["right_wall"] == "right wall"
    assert names["any_wall"] == "any wall"
    assert [names[hop] for hop in HOPS] == ["vertical hops", "horizontal hops"]
    assert names["disc_collision"] == "disc collisions"
