"""More than two discs as they move, coloured by their order along the longer side at the start.

In a channel where they cannot pass each other colours keep that order for ever; elsewhere they mix.
"""

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import to_rgb

from twodiscs.figures.kit import panels
from twodiscs.figures.kit.style import new_figure

#: The part of the map of colours that is neither too dark nor too light.
LOW, HIGH = 0.05, 0.95

#: Inches: each of the two panels, the gap between them and the room above.
PANEL, GAP, TOP = 1.45, 0.3, 0.22

#: Points: a line for each disc, of the whole and of the part of it that is enlarged.
THIN, THICK = 0.35, 0.9

#: The part of the time that is enlarged.
CLOSE = 0.06


def along(box):
    """Return "x" in a box at least as wide as high, else "y"."""
    return "x" if box.width >= box.height else "y"


def colours(box, first):
    """Return a colour for each disc, by its rank along the longer side in the row ``first``."""
    places = [first[f"{along(box)}{disc}"] for disc in range(1, box.discs + 1)]
    ranks = np.argsort(np.argsort(places))
    shades = LOW + (HIGH - LOW) * ranks / (box.discs - 1)
    return [to_rgb(colormaps["turbo"](shade)) for shade in shades]


def world_lines(box, rows, radius=None):
    """Draw where all discs of a ``Box`` are along its longer side, against time.

    ``rows`` are those of trajectory.csv; between them discs move freely. The ``radius``, if given,
    is written above.
    """
    axis, side = along(box), max(box.width, box.height)
    times = np.array([row["time"] for row in rows])
    figure = new_figure(panels.BOTTOM + 2 * PANEL + GAP + TOP)
    whole = panels.add_panel(figure, panels.BOTTOM + PANEL + GAP, PANEL)
    close = panels.add_panel(figure, panels.BOTTOM, PANEL)
    shades = colours(box, rows[0])
    whole.set_xlim(times[0], times[-1])
    close.set_xlim(times[0], times[0] + CLOSE * (times[-1] - times[0]))
    places = np.array([[row[f"{axis}{disc}"] for row in rows] for disc in range(1, box.discs + 1)])
    for axes, width in ((whole, THIN), (close, THICK)):
        shown = places[:, times <= axes.get_xlim()[1]]
        goes_on = axis in box.effects.get("periodic", "")
        low, high = (shown.min(), shown.max()) if goes_on else (-side / 2, side / 2)
        axes.set(ylabel=f"${axis}$", ylim=(low, high))
        for line, colour in zip(places, shades, strict=True):
            axes.plot(times, line, color=colour, lw=width)
    close.set_xlabel("time $t$")
    for axes, name in ((whole, "a"), (close, "b")):
        panels.letter(axes, name)
    panels.name_box(whole, box, f",  $r={radius:g}$" if radius else "")
    return figure
