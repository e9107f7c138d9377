"""Looks: every event has its own, and a name that people use."""

from twodiscs.figures.kit.looks import _LOOKS, LOOKS, name_of
from twodiscs.figures.kit.style import SIZES
from twodiscs.model.events import EVENTS, HOPS


def test_either_colour_or_marker_tells_events_apart():
    assert tuple(LOOKS) == EVENTS
    for part in zip(*LOOKS.values(), strict=True):
        assert len(set(part)) == len(EVENTS)


def test_looks_of_events_to_come_differ_from_all_others():
    assert len(set(_LOOKS)) == len(_LOOKS)
    assert {marker for _, marker in _LOOKS} <= set(SIZES)


def test_names_are_plural_but_for_walls():
    names = {event: name_of(event) for event in EVENTS}
    assert names["right_wall"] == "right wall"
    assert names["any_wall"] == "any wall"
    assert [names[hop] for hop in HOPS] == ["vertical hops", "horizontal hops"]
    assert names["disc_collision"] == "disc collisions"
