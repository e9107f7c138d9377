"""The mean times between hops."""

import numpy as np

from twodiscs import parameters, theory
from twodiscs.figures import panels, times
from twodiscs.figures.limits import hop_ends
from twodiscs.figures.style import SERIES

EVENTS = {"vertical_hop": "vertical hops", "horizontal_hop": "horizontal hops"}

#: Inches: the height of the lower panel and of the room that it takes.
APPROACH, ROOM = 1.4, 1.8

#: The lower panel begins this close to the end, relatively; its law is drawn from there on.
CLOSEST, LAW = 1e-5, 0.3


def draw(scene, tables):
    """Draw the mean times in the box of ``scene``, with the rows of mean_times.csv."""
    radii, found = times.series(scene, tables, EVENTS)
    series = list(found.values())
    label = r"mean time between hops $\tau$"
    figure, main, lower = panels.panels(scene, label, ROOM)
    panels.draw_series(main, lower, radii, series)
    for event in found:
        times.small_law(main, scene, event)
    panels.logarithmic(main, radii, series)
    panels.legend(main, scene, series, "upper left")
    panels.letter(main, "a")
    _approach(panels.add_panel(figure, panels.BOTTOM, APPROACH), scene, found)
    return figure


def _approach(axes, scene, found):
    """Draw the times over the distance from the radius at which the hop dies out."""
    distances = np.geomspace(CLOSEST, 0.99, 70)
    ends = hop_ends(scene)
    shown = []
    for (colour, marker), (event, one) in zip(SERIES, found.items(), strict=False):
        end, name = ends[event]
        scenes = [parameters.scene(scene, float(end * (1 - d))) for d in distances]
        exact = [theory.mean_times(s)[event] for s in scenes]
        (line,) = axes.plot(distances, exact, color=colour, zorder=5)
        line.set_label(rf"{one.name}, $r_{{\mathrm{{c}}}}={name}$")
        shown += exact
        if "effects" not in scene:
            near = distances < LAW
            laws = [theory.threshold_time(s, event) for s in scenes]
            panels.asymptote(axes, distances[near], np.array(laws)[near])
        rows = [row | {"radius": 1 - row["radius"] / end} for row in one.rows]
        panels.estimates(axes, [row for row in rows if row["radius"] > 0], colour, marker)
    axes.set(xscale="log", yscale="log", xlim=(CLOSEST, 1), ylim=(min(shown) / 3, 3 * max(shown)))
    axes.set_xlabel(r"relative distance from the end, $1-r/r_{\mathrm{c}}$")
    axes.set_ylabel(r"mean time $\tau$")
    axes.legend(loc="upper right")
    panels.letter(axes, "b")
