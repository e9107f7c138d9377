"""More than two discs as they move, coloured by their order along the longer side at the start.

In a channel in which they cannot pass each other, colours keep that order; elsewhere they mix.
"""

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import to_rgb

from twodiscs.figures.kit import panels
from twodiscs.figures.kit.style import (
    BLUE,
    GREEN,
    ORANGE,
    PURPLE,
    SKY,
    VERMILLION,
    new_figure,
)
from twodiscs.model.events import HOPS

#: The colours of up to six discs.
FEW = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY)

#: The part of the map of colours of more discs that is neither too dark nor too light.
LOW, HIGH = 0.05, 0.95

#: Inches: each of the two panels.
PANEL = 2.0

#: Points: a line for each disc, in the upper panel and in the lower one.
THIN, THICK = 0.5, 0.9

#: Bends for each disc that either panel shows.
MANY, CLOSE = 75, 15

#: The most discs that the legend names, and the most lines in a panel.
NAMED, LINES = 8, 24


def along(box):
    """Return "x" in a box at least as wide as high, else "y"."""
    return "x" if box.width >= box.height else "y"


def colours(box, first):
    """Return a colour for each disc, by its rank along the longer side in the row ``first``."""
    places = [first[f"{along(box)}{disc}"] for disc in range(1, box.discs + 1)]
    ranks = np.argsort(np.argsort(places))
    if box.discs <= len(FEW):
        return [to_rgb(FEW[rank]) for rank in ranks]
    shades = LOW + (HIGH - LOW) * ranks / (box.discs - 1)
    return [to_rgb(colormaps["turbo"](shade)) for shade in shades]


def world_lines(box, rows, radius=None):
    """Draw the positions of the discs of a ``Box`` along its longer side, against time.

    ``rows`` are the rows of trajectory.csv; the first ones are shown, and discs move freely between
    them. Of more than ``LINES`` discs there are that number, at equal distances in their order at
    the start. The ``radius``, if given, is written above.
    """
    axis, side = along(box), max(box.width, box.height)
    rows = [row for row in rows if row["event"] not in HOPS][: MANY * box.discs + 1]
    times = np.array([row["time"] for row in rows])
    figure = new_figure(2 * PANEL, layout="constrained")
    whole, close = figure.subplots(2)
    shades = colours(box, rows[0])
    whole.set_xlim(times[0], times[-1])
    # A short trajectory has fewer rows than either panel could show.
    close.set_xlim(times[0], times[min(CLOSE * box.discs, len(times) * CLOSE // MANY)])
    places = np.array([[row[f"{axis}{disc}"] for row in rows] for disc in range(1, box.discs + 1)])
    shown_discs = np.arange(box.discs)
    if box.discs > LINES:
        ranks = np.linspace(0, box.discs - 1, LINES).round().astype(int)
        shown_discs = np.argsort(places[:, 0], kind="stable")[ranks]
    for axes, width in ((whole, THIN), (close, THICK)):
        shown = places[:, times <= axes.get_xlim()[1]]
        goes_on = axis in box.effects.get("periodic", "")
        low, high = (shown.min(), shown.max()) if goes_on else (-side / 2, side / 2)
        axes.set(xlabel="time $t$", ylabel=f"${axis}$", ylim=(low, high))
        for disc in shown_discs:
            axes.plot(times, places[disc], color=shades[disc], lw=width)
    if box.discs <= NAMED:
        names = ["disc 1", *map(str, range(2, box.discs + 1))]
        figure.legend(
            close.get_lines(), names, loc="outside lower center", ncols=box.discs, handlelength=1
        )
    panels.title(whole, "a", box, panels.of_radius(radius))
    panels.title(close, "b")
    if box.discs > LINES:
        close.set_title(f"{LINES} of the discs", loc="right", pad=3)
    return figure
