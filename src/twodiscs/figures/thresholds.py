"""Power laws of mean times below the radii at which their events die out."""

import numpy as np

from twodiscs import theory
from twodiscs.figures import drawing, panels
from twodiscs.figures.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, VERMILLION, new_figure
from twodiscs.scene import HOPS, Scene
from twodiscs.thresholds import leading_law, near, start

#: Inches: the panel of the hops, that of the ratios to the laws, the gap, the room above.
HOP_TIMES, RATIOS, GAP, TOP = 2.0, 1.6, 0.4, 0.22

#: Colour and marker of the events.
LOOKS = {
    "vertical_hop": (BLUE, "o"),
    "horizontal_hop": (VERMILLION, "s"),
    "disc_collision": (GREEN, "^"),
    "right_wall": (PURPLE, "D"),
    "top_wall": (ORANGE, "o"),
}

#: The least distance below the limit, relative to it, and points on a curve.
NEAREST, POINTS = 2e-5, 80


def draw(scene, tables):
    """Draw mean_times.csv, if given, and the first passages of distributions.csv."""
    width, height = drawing.box(scene)
    figure = new_figure(panels.BOTTOM + RATIOS + GAP + HOP_TIMES + TOP)
    hops = panels.add_panel(figure, panels.BOTTOM + RATIOS + GAP, HOP_TIMES)
    ratios = panels.add_panel(figure, panels.BOTTOM, RATIOS)
    for event, (colour, marker) in LOOKS.items():
        law = leading_law(width, height, event)
        if law is None:
            continue
        rows = [row for row in tables.get("mean_times", []) if row["event"] == event]
        rows = near(width, height, law, rows)
        end = 1 - start(width, height, law) / law.limit
        distances = np.geomspace(NEAREST, 0.999 * end, POINTS)
        radii = law.limit * (1 - distances)
        exact = np.array([theory.mean_times(Scene(width, height, r))[event] for r in radii])
        style = panels.open_symbol(colour, marker)
        name = event.replace("_", " ")
        _points(ratios, law, rows, name, style, law)
        ratios.plot(distances, exact / law(radii), color=colour, zorder=2)
        if event in HOPS and law.power < 0:
            _points(hops, law, rows, f"{name}s", style)
            hops.plot(distances, exact, color=colour, zorder=2)
            hops.plot(distances, law(radii), color=colour, lw=0.7, ls=(0, (4, 2)))
            passages = near(width, height, law, _passages(tables["distributions"], event))
            seen = hops.get_legend_handles_labels()[1]
            name = None if "first passages" in seen else "first passages"
            _points(hops, law, passages, name, {"color": colour, "marker": "x", "markersize": 3})
    _slopes(hops)
    ratios.axhline(1, color=BLACK, lw=0.7, ls=(0, (4, 2)))
    for axes in (hops, ratios):
        axes.set(xscale="log", yscale="log", xlim=(NEAREST, 0.25))
    ratios.set(ylim=(0.7, 5))
    ratios.set_yticks([1, 2, 5], ["1", "2", "5"])
    ratios.yaxis.set_minor_formatter("")
    hops.set_ylabel("time between hops")
    ratios.set(xlabel=r"distance from the limit $\delta/r_{\rm c}$", ylabel=r"$\tau/(C\delta^p)$")
    hops.legend(loc="upper right")
    ratios.legend(loc="upper left")
    panels.letter(hops, "a")
    panels.letter(ratios, "b")
    panels.name_box(hops, scene)
    return figure


def _passages(rows, event):
    """Return the rows on mean first passages in the scene that the table begins with."""
    wanted = rows[0]["scene"], event, "first_passage", None
    return [
        row for row in rows if (row["scene"], row["event"], row["quantity"], row["last"]) == wanted
    ]


def _points(axes, law, rows, name, style, unit=np.ones_like):
    """Draw measured times over ``unit`` of the radius."""
    columns = [[row[c] for row in rows] for c in ("radius", "estimate", "stderr")]
    radius, value, error = np.array(columns, float)
    scale = unit(radius)
    axes.errorbar(
        1 - radius / law.limit, value / scale, error / scale, ls="", elinewidth=0.6, label=name,
        zorder=3, **style,
    )  # fmt: skip


def _slopes(axes):
    """Draw the two powers that are told apart."""
    x = np.array([4e-5, 1e-3])
    for power, name in ((-2, r"$\delta^{-2}$"), (-1.5, r"$\delta^{-3/2}$")):
        y = 100 * (x / x[0]) ** power
        axes.plot(x, y, color=GREY, lw=0.8)
        drawing.label(axes, name, (x[1], y[1]), (3, 0), ha="left", va="center", color=GREY)
