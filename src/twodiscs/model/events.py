"""The events whose mean times are known exactly. Each is declared only here.

Every table, kernel and figure takes the names from here, in this order. The area of a surface, its
shell and the test of a kernel for the event follow from its kind, axis and side, by ``by_kind``. If
a module lacks a kind, its import raises an error that names the kind.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Event:
    """A surface in configuration space, and the moment at which a trajectory crosses it.

    ``kind`` is "hop" (the discs pass each other: the surface is crossed from both sides),
    "collision" (of the discs), "wall" (disc 1 at one wall) or "walls" (any disc at any wall).
    ``axis`` is the axis of the event, which must have walls. ``side`` is +1 for the wall at the
    positive end of the axis and −1 for the other.
    """

    name: str
    kind: str
    axis: str | None = None
    side: int = 0


DECLARED_EVENTS = {
    event.name: event
    for event in (
        Event("vertical_hop", "hop", "y"),
        Event("horizontal_hop", "hop", "x"),
        Event("disc_collision", "collision"),
        Event("right_wall", "wall", "x", +1),
        Event("top_wall", "wall", "y", +1),
        Event("any_wall", "walls"),
    )
}

#: Their names, in the order of every table.
EVENTS = tuple(DECLARED_EVENTS)

#: The events with an axis, {name: axis}.
EVENT_AXES = {event.name: event.axis for event in DECLARED_EVENTS.values() if event.axis}


def by_kind(where, makers, events=EVENTS):
    """Return {name: result of the maker of its kind for the ``Event``} for these ``events``.

    ``makers`` maps kinds to functions. Raises ``TypeError`` that names the missing kind and
    ``where``, a file of this package.
    """
    places = {}
    for name in events:
        event = DECLARED_EVENTS[name]
        if event.kind not in makers:
            known = ", ".join(makers)
            raise TypeError(f"{where} knows events of kind {known}, not {event.kind} as {name} is")
        places[name] = makers[event.kind](event)
    return places


def facts(where, **values):
    """Return {event: value of its kind}, with an error as of ``by_kind`` if a kind has none."""
    return by_kind(where, {kind: lambda event, v=value: v for kind, value in values.items()})


def _select(**kinds):
    return tuple(event for event, chosen in facts("model/events.py", **kinds).items() if chosen)


#: {event: the number of ways in which the surface is crossed}; a hop happens in both.
EVENT_WAYS = facts("model/events.py", hop=2, collision=1, wall=1, walls=1)

#: The events at which the discs exchange sides, those of disc 1 at one wall, and all at walls.
HOPS = _select(hop=True, collision=False, wall=False, walls=False)
WALLS = _select(hop=False, collision=False, wall=True, walls=False)
WALL_HITS = _select(hop=False, collision=False, wall=True, walls=True)

#: The events whose surface has a simple shell; the surface of all walls together has corners.
SHELL_EVENTS = _select(hop=True, collision=True, wall=True, walls=False)
