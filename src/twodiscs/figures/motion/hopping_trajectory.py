"""One trajectory: the separation of the discs over time, and their hops."""

import numpy as np

from twodiscs.figures.kit import panels
from twodiscs.figures.kit.style import BLUE, GREY, ORANGE, VERMILLION, new_figure
from twodiscs.figures.motion import many
from twodiscs.model.events import AXIS

#: Inches: each of the two panels.
PANEL = 1.55

#: The mean number of rows in the lower panel, which is lower if hops would be closer than ``APART``
#: of its width; and its longest time, over that of the upper panel.
CLOSE, APART, MOST = 150, 0.02, 1 / 3


def draw(box, rows, radius=None):
    """Draw x2 − x1 against time from trajectory.csv.

    In a box higher than wide, or if x is periodic, it is y2 − y1. The ``radius``, if given, is
    written above. Between events the discs move freely, or fall with the same acceleration, so
    straight lines through the rows are the trajectory itself. More than two discs are drawn by
    ``many.world_lines``.
    """
    if box.family == "many":
        return many.world_lines(box, rows, radius)
    hop = shown_hop(box)
    axis = AXIS[hop]
    times = np.array([row["time"] for row in rows])
    apart = np.array([row[f"{axis}2"] - row[f"{axis}1"] for row in rows])
    hops = times[[row["event"] == hop for row in rows]]

    figure = new_figure(2 * PANEL, layout="constrained")
    whole, close = figure.subplots(2)
    length = (times[-1] - times[0]) * min(MOST, CLOSE / len(rows))
    start, end = _crowded(hops, length, times[0], times[-1])
    gaps = np.diff(hops[(hops > start) & (hops < end)])
    if gaps.size and gaps.min() < APART * length:
        length = max(gaps.min() / APART, length / 10)
        start, end = _crowded(hops, length, times[0], times[-1])
    for axes, thick, size in ((whole, 0.3, 2.2), (close, 0.7, 3)):
        axes.set(xlabel="time $t$", ylabel=f"${axis}_2-{axis}_1$")
        axes.axhline(0, color=GREY, lw=0.5, zorder=1)
        axes.plot(times, apart, color=BLUE, lw=thick, zorder=2)
        axes.plot(hops, 0 * hops, "o", color=VERMILLION, markersize=size, mew=0, zorder=3)
    reach = 1.08 * np.abs(apart).max()
    whole.set(xlim=(times[0], times[-1]), ylim=(-reach, reach))
    close.set(xlim=(start, end), ylim=(-reach, reach))
    whole.axvspan(start, end, color=ORANGE, alpha=0.45, lw=0, zorder=0, label="stretch in (b)")
    if hops.size:
        whole.plot([], [], ls="", marker="o", markersize=2.2, color=VERMILLION, label="hops")
    figure.legend(loc="outside lower center", ncols=2)
    panels.title(whole, "a", box, panels.of_radius(radius))
    panels.title(close, "b")
    return figure


def shown_hop(box):
    """Return the hop of two discs in a ``Box`` that the figure shows.

    It is the one along the longer side, unless this axis is periodic.
    """
    periodic = box.effects.get("periodic", "")
    along_x = "y" in periodic or (box.width >= box.height and "x" not in periodic)
    return "horizontal_hop" if along_x else "vertical_hop"


def _crowded(hops, length, start, end):
    """Return the ends of the stretch of ``length`` with the most ``hops``."""
    first = start
    if len(hops):
        counts = np.searchsorted(hops, hops + 0.6 * length) - np.arange(len(hops))
        first = hops[np.argmax(counts)] - 0.3 * length
    first = min(max(first, start), end - length)
    return first, first + length
