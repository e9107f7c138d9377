"""The events whose mean times are known exactly. Each is declared here, once.

Every table, kernel and figure takes the names from here and in this order. The area of a surface,
the shell around it and how a kernel sees the event follow from its kind, axis and side, by
``by_kind``: a kind that a module has forgotten is an error with a sentence when it is imported.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Event:
    """A surface in configuration space and when a trajectory passes through it.

    ``kind`` is "hop" (the discs pass each other: the surface is crossed from both sides),
    "collision" (of the discs), "wall" (disc 1 at one wall) or "walls" (any disc at any wall).
    ``axis`` is the one along which it has its place; it needs walls there. ``side`` is +1 for the
    wall at the far end of the axis and −1 for the near one.
    """

    name: str
    kind: str
    axis: str | None = None
    side: int = 0

    @property
    def sides(self):
        """How many sides the surface is crossed from: 2 for a hop, 1 for everything else."""
        return 2 if self.kind == "hop" else 1


DECLARED = {
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
EVENTS = tuple(DECLARED)


def _of_kind(*kinds):
    return tuple(event.name for event in DECLARED.values() if event.kind in kinds)


#: The events at which the discs exchange sides; those of disc 1 at one wall.
HOPS, WALLS = _of_kind("hop"), _of_kind("wall")

#: The events whose surface has a shell of its own; all walls together are corners as well.
SHELLS = _of_kind("hop", "collision", "wall")

#: The events with an axis, {name: axis}.
AXIS = {event.name: event.axis for event in DECLARED.values() if event.axis}


def by_kind(where, makers, events=EVENTS):
    """Return {name: what the maker of its kind returns for the ``Event``} of these ``events``.

    ``makers`` maps kinds to functions. Raises ``TypeError`` with a sentence that names the kind of
    which ``where``, a file of this package, says nothing.
    """
    places = {}
    for name in events:
        event = DECLARED[name]
        if event.kind not in makers:
            known = ", ".join(makers)
            raise TypeError(f"{where} knows events of kind {known}, not {event.kind} as {name} is")
        places[name] = makers[event.kind](event)
    return places
