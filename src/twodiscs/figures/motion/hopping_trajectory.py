"""One trajectory: the separation of the discs over time, and their hops."""

import numpy as np

from twodiscs.figures.kit import panels
from twodiscs.figures.kit.style import BLUE, GREY, ORANGE, VERMILLION, new_figure
from twodiscs.figures.motion import many
from twodiscs.model.events import AXIS

#: Inches: each of the two panels, the gap between them and the space above.
PANEL, GAP, TOP = 1.05, 0.42, 0.22

#: The mean number of rows in the lower panel, which is lower if hops would be closer than ``APART``
#: of its width; and its longest time, over that of the upper panel.
CLOSE, APART, MOST = 150, 0.02, 1 / 3


def draw(box, tables, radius=None):
    """Draw x2 − x1 against time from trajectory.csv.

    In a box higher than wide, or if x is periodic, it is y2 − y1. The ``radius``, if given, is
    written above. Between events the discs move freely, or fall with the same acceleration, so
    straight lines through the rows are the trajectory itself. More than two discs are drawn by
    ``many.world_lines``.
    """
    if box.family == "many":
        return many.world_lines(box, tables["trajectory"], radius)
    hop = shown_hop(box)
    axis = AXIS[hop]
    rows = tables["trajectory"]
    times = np.array([row["time"] for row in rows])
    apart = np.array([row[f"{axis}2"] - row[f"{axis}1"] for row in rows])
    hops = times[[row["event"] == hop for row in rows]]

    # Points: a heading that leaves no space for the legend beside it is higher.
    above = 0 if panels.is_short(box, radius) else panels.ABOVE
    more = panels.of_radius(radius)
    room = above / 72 + panels.room(box, more)
    figure = new_figure(panels.BOTTOM + 2 * PANEL + GAP + TOP + room)
    whole = panels.add_panel(figure, panels.BOTTOM + PANEL + GAP, PANEL)
    close = panels.add_panel(figure, panels.BOTTOM, PANEL)
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
    for axes, name in ((whole, "a"), (close, "b")):
        panels.letter(axes, name)
    whole.axvspan(start, end, color=ORANGE, alpha=0.45, lw=0, zorder=0, label="stretch in (b)")
    if hops.size:
        whole.plot([], [], ls="", marker="o", markersize=2.2, color=VERMILLION, label="hops")
    whole.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2)  # above, beside the box
    panels.name_box(whole, box, more, up=above)
    return figure


def caption(shown):
    """Return the caption."""
    if shown.many:
        return _caption_of_many(shown)
    text = """
    (a) One trajectory: the separation of the discs in one direction against time. (b) The shaded
    stretch of time enlarged.
    """
    if shown.any_row(lambda row: row["event"] == shown_hop(shown.box)):
        text += """
        Dots mark the hops, at which the separation changes sign. A hop is
        often undone soon, before collisions have scrambled the motion.
        """
    return text


def _caption_of_many(shown):
    axis = many.along(shown.box)
    hop = "horizontal_hop" if axis == "x" else "vertical_hop"
    text = """
    (a) The beginning of one trajectory: the positions of the discs along the longer side against
    time, coloured by their order at the start. (b) The first part of it enlarged.
    """
    if axis in shown.effects.get("periodic", ""):
        return text + "On the periodic axis positions go on beyond the box."
    hops = shown.any_row(lambda row: row["event"] == hop)
    return text + ("Discs hop at the points where lines cross." if hops else "")


def shown_hop(box):
    """Return the hop of two discs in a ``Box`` that the figure shows.

    It is the one along the longer side, unless this axis is periodic.
    """
    if box is None:
        return "horizontal_hop"
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
