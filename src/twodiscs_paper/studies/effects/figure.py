"""How each effect changes the mean times, and how much its simulation costs."""

import json

import numpy as np

from twodiscs.figures.kit import drawing, panels
from twodiscs.figures.kit.limits import limits
from twodiscs.figures.kit.looks import name_of
from twodiscs.figures.kit.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    VERMILLION,
    new_figure,
)
from twodiscs.model.box import Box
from twodiscs_paper.studies.effects.measure import SHOWN_EVENTS

#: Inches: widths of the figure, of a panel of times, of the panel of costs and of its names;
#: margins and gaps; heights of the panels of curves and of residuals, and of the legend.
WIDTH, ACROSS, COST, NAMES = 7.0, 1.56, 0.96, 0.7
LEFT, BOTTOM, TOP, GAP, JOINT = 0.42, 0.34, 0.36, 0.06, 0.07
MAIN, LOWER, LEGEND = 1.95, 0.75, 0.4

#: Names of events in this figure, if they differ from those in other figures.
NAMES_OF = {"any_wall": "wall hits"}

#: The quantity that is no mean time, and is not drawn.
SHARE = "never_met_share"

COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, BLACK)
MARKERS = ("o", "s", "^", "D", "v", "P")

#: The range of the ratios; curves leave it only near the ends of the radii.
SHOWN = (0.22, 22)


def draw(box=None, *, tables):
    """Draw the rows of effects.csv and the curves; ``box`` is not used: the rows name theirs."""
    rows = [row for row in tables["effects"] if row["quantity"] != SHARE]
    looks = {name: _look(i) for i, name in enumerate(dict.fromkeys(r["scene"] for r in rows))}
    boxes = {row["scene"]: _box(row) for row in rows}
    plain = Box(rows[0]["width"], rows[0]["height"])
    ends = limits(plain)

    figure = new_figure(BOTTOM + LOWER + JOINT + MAIN + TOP + LEGEND, WIDTH)
    for i, event in enumerate(SHOWN_EVENTS):
        left = LEFT + i * (ACROSS + GAP)
        main = panels.add_panel(figure, BOTTOM + LOWER + JOINT, MAIN, left, ACROSS)
        lower = panels.add_panel(figure, BOTTOM, LOWER, left, ACROSS)
        for name, look in looks.items():
            own = [r for r in rows if r["scene"] == name and r["quantity"] == f"{event}_time"]
            main.plot(*_curve(tables["effects_curves"], name, event), color=look[0], zorder=5)
            panels.estimates(main, list(map(_relative, own)), *look)
            panels.residuals(lower, own, *look)
        main.axhline(1, color=GREY, lw=0.5, zorder=0)
        main.set(yscale="log", ylim=SHOWN)
        main.tick_params(which="both", labelbottom=False, labelleft=i == 0)
        lower.set(xlabel="radius $r$")
        lower.tick_params(labelleft=i == 0)
        panels.scale_residuals(lower)
        panels.mark((main, lower), ends)
        panels.label_decades(main.yaxis, 10)
        _title(main, "abc"[i], NAMES_OF.get(event, name_of(event)))
        if i == 0:
            main.set_ylabel(r"mean time / that of plain discs")
            lower.set_ylabel("residual $z$")
    _costs(figure, tables["effects_cost"], looks)
    _legend(figure, boxes, looks, any(row["stderr"] is None for row in rows if row["estimate"]))
    panels.name_box(figure.axes[0], plain, up=30)
    return figure


def caption(shown):
    """Return the caption."""
    text = """
    Mean times of scenes with one effect or two, divided by the mean times of plain discs in the
    same box at the same radius (of disc 1) and total energy: exact (lines) and by event-driven
    molecular dynamics (symbols). The events are (a) vertical hops, (b) disc collisions and (c) hits
    of any disc on any wall, up to the largest radius of plain discs. Error bars are one standard
    error; they are hidden if they are smaller than the symbols. Vertical lines mark h/4 and w/4,
    where hops of plain discs become blocked, and their largest radius. The torus has neither hops
    nor walls. Residuals z beneath are in standard errors, with guide lines at ±2 and ±5. (d)
    Processor time per wall hit or disc collision at r = 0.2, divided by the time for plain discs
    with all events counted. Leaving a periodic cell takes as much time as an event, but is not
    counted.
    """
    return text + shown.if_any(
        lambda row: row.get("estimate") and row["stderr"] is None and row["quantity"] != SHARE,
        "Crosses are estimates from too few events for an error bar.",
    )


def _look(i):
    """Return the colour and marker of scene ``i``, a different pair for each."""
    n = len(COLOURS)
    return COLOURS[i % n], MARKERS[(i + i // n) % n]


def _box(row):
    """Return the ``Box`` that a row is about."""
    return Box(row["width"], row["height"], json.loads(row["effects"]))


def _curve(rows, scene, event):
    """Return the radii and ratios of the curve of an event, with NaN at its gaps."""
    own = [row for row in rows if (row["scene"], row["event"]) == (scene, event)]
    return np.array([[row["radius"], row["ratio"]] for row in own], float).reshape(-1, 2).T


def _relative(row):
    """Return a row whose estimate and error are in units of the time of plain discs."""
    unit = row["plain"]
    return row | {
        name: row[name] / unit if row[name] is not None and unit else None
        for name in ("estimate", "stderr")
    }


def _title(axes, letter, text):
    corner = {"xycoords": "axes fraction", "ha": "left", "va": "bottom"}
    drawing.label(axes, f"({letter})  {text}", (0, 1), (0, 15), **corner)


def _costs(figure, rows, looks):
    """Draw the time per event of each scene, over the time per event of the plain scene."""
    left = LEFT + len(SHOWN_EVENTS) * (ACROSS + GAP) + NAMES
    axes = panels.add_panel(figure, BOTTOM, LOWER + JOINT + MAIN, left, COST)
    others = [row for row in rows if row["variant"] != "plain"]
    for i, row in enumerate(others):
        colour, marker = looks.get(row["variant"], (GREY, "o"))
        axes.plot([1, 1 / row["ratio"]], [i, i], color=colour)
        axes.plot(1 / row["ratio"], i, **panels.open_symbol(colour, marker))
    axes.axvline(1, color=GREY, lw=0.5, zorder=0)
    names = ["plain,\nno hops" if r["variant"] == "plain_walls" else r["variant"] for r in others]
    axes.set_yticks(range(len(others)), names)
    longest = max(1 / row["ratio"] for row in rows)
    axes.set(ylim=(len(others) - 0.5, -0.5), xlim=(0, 1.12 * longest))
    axes.set_xlabel("time / that of plain")
    axes.tick_params(axis="y", length=0)
    _title(axes, "d", "time per event")


def _legend(figure, boxes, looks, rough):
    """Name the scenes; ``rough`` says whether there are estimates without an error bar."""
    handles = [
        figure.axes[0].plot([], [], **panels.open_symbol(*look), ls="-")[0]
        for look in looks.values()
    ]
    names = [f"{name}: {', '.join(panels.effects(box))}" for name, box in boxes.items()]
    if rough:
        handles += figure.axes[0].plot([], [], "x", color=GREY)
        names.append("too few events for an error bar")
    figure.legend(handles, names, loc="upper center", ncols=3, columnspacing=2.0)
