"""How events look in every figure: their name, colour and marker."""

from twodiscs.figures.kit.style import BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILLION
from twodiscs.model.events import EVENTS

#: (colour, marker) of the events in their order; either of the two tells them apart.
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
    """Return what an event is called: "vertical hops", "disc collisions", "right wall"."""
    words = event.replace("_", " ")
    return words if words.endswith("wall") else f"{words}s"
