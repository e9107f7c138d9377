"""The name, colour and marker of each event, the same in every figure."""

from twodiscs.figures.kit.style import BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILLION
from twodiscs.model.events import EVENTS

#: (colour, marker) of the events in their order; all colours differ, and all markers.
_LOOKS = (
    (BLUE, "o"),
    (VERMILLION, "s"),
    (GREEN, "^"),
    (PURPLE, "D"),
    (ORANGE, "v"),
    (SKY, "P"),
    (PURPLE, "v"),
    (GREEN, "D"),
)
if len(EVENTS) > len(_LOOKS):
    raise TypeError(
        f"figures/kit/looks.py has {len(_LOOKS)} looks, too few for {len(EVENTS)} events"
    )

#: {event: (colour, marker)}
LOOKS = dict(zip(EVENTS, _LOOKS, strict=False))


def name_of(event):
    """Return the name of an event for people: "vertical hops", "disc collisions", "right wall"."""
    words = event.replace("_", " ")
    return words if words.endswith("wall") else f"{words}s"
