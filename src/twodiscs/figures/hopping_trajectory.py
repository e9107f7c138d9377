"""One trajectory: how the discs lie to each other, and when they hop."""

import numpy as np
from matplotlib.patches import Rectangle

from twodiscs.figures import drawing, panels
from twodiscs.figures.style import BLACK, BLUE, GREY, VERMILLION, new_figure

#: Inches: each of the two panels, the gap between them and the room above.
PANEL, GAP, TOP = 1.15, 0.42, 0.22

#: Length of the lower panel over that of the whole trajectory.
CLOSE = 1 / 40


def draw(scene, tables):
    """Draw x2 − x1 against time (y2 − y1 in a box higher than wide) from trajectory.csv.

    ``scene`` may give the radius too, to be written above. The discs move freely between events, so
    straight lines through the rows are the trajectory itself.
    """
    width, height = drawing.box(scene)
    axis, hop = ("x", "horizontal_hop") if width >= height else ("y", "vertical_hop")
    rows = tables["trajectory"]
    times = np.array([row["time"] for row in rows])
    apart = np.array([row[f"{axis}2"] - row[f"{axis}1"] for row in rows])
    hops = times[[row["event"] == hop for row in rows]]

    figure = new_figure(panels.BOTTOM + 2 * PANEL + GAP + TOP)
    whole = panels.add_panel(figure, panels.BOTTOM + PANEL + GAP, PANEL)
    close = panels.add_panel(figure, panels.BOTTOM, PANEL)
    start, end = _crowded(hops, times[0], times[-1])
    for axes, thick, size in ((whole, 0.3, 2.2), (close, 0.7, 3.4)):
        axes.set_ylabel(f"${axis}_2-{axis}_1$")
        axes.axhline(0, color=GREY, lw=0.5, zorder=1)
        axes.plot(times, apart, color=BLUE, lw=thick, zorder=2)
        axes.plot(hops, 0 * hops, "o", color=VERMILLION, markersize=size, mew=0, zorder=3)
    reach = 1.08 * np.abs(apart).max()
    whole.set(xlim=(times[0], times[-1]), ylim=(-reach, reach))
    close.set(xlim=(start, end), ylim=(-reach, reach), xlabel="time $t$")
    frame = {"facecolor": "none", "edgecolor": BLACK, "linewidth": 0.8, "zorder": 4}
    whole.add_patch(Rectangle((start, -reach), end - start, 2 * reach, **frame))
    for x, corner in ((start, 0), (end, 1)):
        close.annotate(
            "",
            (corner, 1),
            (x, -reach),
            xycoords="axes fraction",
            textcoords=whole.transData,
            arrowprops={"arrowstyle": "-", "linewidth": 0.5, "shrinkA": 0, "shrinkB": 0},
        )
    radius = scene.get("radius")
    panels.name_box(whole, width, height, f",  $r={radius:g}$" if radius else "")
    return figure


def _crowded(hops, start, end):
    """Return the ends of the short stretch of time that holds the most ``hops``."""
    length = CLOSE * (end - start)
    first = start
    if len(hops):
        counts = np.searchsorted(hops, hops + 0.6 * length) - np.arange(len(hops))
        first = hops[np.argmax(counts)] - 0.3 * length
    first = min(max(first, start), end - length)
    return first, first + length
