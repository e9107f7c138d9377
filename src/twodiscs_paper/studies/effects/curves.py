"""Exact mean times of scenes with effects over exact mean times of plain discs in the same box."""

import math

from twodiscs.figures.kit import curves
from twodiscs.figures.kit.limits import limits
from twodiscs.model.box import Box
from twodiscs.theory.exact import mean_times

#: The events whose mean times are shown, a panel each.
SHOWN_EVENTS = ("vertical_hop", "disc_collision", "any_wall")


def rows(scenes):
    """Yield the rows of effects_curves.csv.

    ``scenes`` is {name: parameters of a box}; plain discs are in a box with the first one's sides.
    """
    boxes = {name: Box(**parameters) for name, parameters in scenes.items()}
    first = next(iter(boxes.values()))
    plain = Box(first.width, first.height)
    others = [radius for radius, _ in limits(plain)]
    for name, box in boxes.items():
        radii, times = curves.exact_curves(box, others)
        for i, radius in enumerate(map(float, radii)):
            unit = mean_times(plain.scene(radius)) if radius > 0 and plain.fits(radius) else {}
            for event in SHOWN_EVENTS:
                ratio = float(times[f"{event}_time"][i]) / (unit.get(event) or math.nan)
                yield {
                    "scene": name,
                    "radius": None if math.isnan(radius) else radius,
                    "event": event,
                    "ratio": None if math.isnan(ratio) else ratio,
                }
