"""How each effect changes the mean times, and how much its simulation costs."""

import json

import numpy as np
from matplotlib.ticker import FixedLocator

from twodiscs.figures import drawing, panels
from twodiscs.figures.curves import exact_curves, limits
from twodiscs.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    VERMILLION,
    event_name,
    new_figure,
)
from twodiscs.model.scene import Box
from twodiscs_paper.studies.effects.measure import plain_time

#: Inches: the width of the figure, and the heights of the panels of curves and of residuals.
EFFECTS_WIDTH, PANEL_HEIGHTS = 7.0, (2.6, 1.1)

#: The relative widths of the panels of times and of the panel of costs.
WIDTHS = (1.5, 1.5, 1.5, 1.2)

#: The events that are shown, a panel each.
SHOWN_EVENTS = ("vertical_hop", "disc_collision", "any_wall")

#: Names of events in this figure, if they differ from those in other figures.
EVENT_NAMES = {"any_wall": "wall hits"}

#: The quantity that is no mean time, and is not drawn.
SHARE_QUANTITY = "never_met_share"

COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, BLACK)
SCENE_MARKERS = ("o", "s", "^", "D", "v", "P")

#: The shortest relative time of the panel of costs, and the factor that leaves room for numbers.
#: Points: the end of the column of instructions, from the edge of the panel.
COST_FROM, COST_ROOM, COUNT_OFFSET = 0.6, 8.0, 26


def draw(box, tables):
    """Draw the rows of effects.csv and exact curves; ``box`` is not used: the rows name theirs."""
    rows = [row for row in tables["effects"] if row["quantity"] != SHARE_QUANTITY]
    looks = {name: _look(i) for i, name in enumerate(dict.fromkeys(r["scene"] for r in rows))}
    boxes = {row["scene"]: _box(row) for row in rows}
    plain = Box(rows[0]["width"], rows[0]["height"])
    ends = limits(plain)

    figure = new_figure(sum(PANEL_HEIGHTS), EFFECTS_WIDTH, layout="constrained")
    places = [["a", "b", "c", "d"], ["z of a", "z of b", "z of c", "d"]]
    axes = figure.subplot_mosaic(places, width_ratios=WIDTHS, height_ratios=PANEL_HEIGHTS)
    for letter, event in zip("abc", SHOWN_EVENTS, strict=True):
        main, lower = axes[letter], axes[f"z of {letter}"]
        for name, look in looks.items():
            own = [r for r in rows if r["scene"] == name and r["quantity"] == f"{event}_time"]
            main.plot(*_curve(boxes[name], plain, event), color=look[0], zorder=5)
            panels.draw_estimates(main, list(map(_relative, own)), *look)
            panels.draw_residuals(lower, own, *look)
        main.axhline(1, color=GREY, lw=0.5, zorder=0)
        # The range of the ratios; curves leave it only near the ends of the radii.
        main.set(yscale="log", ylim=(0.22, 22))
        main.tick_params(which="both", labelbottom=False, labelleft=letter == "a")
        lower.set(xlabel="radius $r$ (length)")
        lower.tick_params(labelleft=letter == "a")
        panels.scale_residuals(lower)
        panels.mark((main, lower), ends)
        panels.label_decades(main.yaxis, 10)
        title = f"({letter})  {EVENT_NAMES.get(event, event_name(event))}"
        main.set_title(title, loc="left", pad=panels.TITLE_PAD)
    axes["a"].set_ylabel(r"mean time / that of plain discs")
    axes["z of a"].set_ylabel("residual $z$")
    _costs(axes["d"], tables["effects_cost"], looks)
    _legend(axes["a"], boxes, looks, any(row["stderr"] is None for row in rows if row["estimate"]))
    return figure


def _look(i):
    """Return the colour and marker of scene ``i``, a different pair for each."""
    n = len(COLOURS)
    return COLOURS[i % n], SCENE_MARKERS[(i + i // n) % n]


def _box(row):
    """Return the ``Box`` that a row is about."""
    return Box(row["width"], row["height"], **json.loads(row["effects"]))


def _curve(box, plain, event):
    """Return the radii and ratios of the curve of an event, with NaN at its gaps."""
    radii, times = exact_curves(box, tuple(radius for radius, _ in limits(plain)))
    units = [plain_time(box, float(r), event) if r > 0 else None for r in radii]
    return radii, times[f"{event}_time"] / np.array(units, float)


def _relative(row):
    """Return a row whose estimate and error are in units of the time of plain discs."""
    unit = row["plain"]
    return row | {
        name: row[name] / unit if row[name] is not None and unit else None
        for name in ("estimate", "stderr")
    }


#: Names of variants in the panel of costs, if they differ from those in the table.
VARIANTS = {
    "without_effects": "no effect\nin the package",
    "plain_walls": "plain, no hops",
}


def _costs(axes, rows, looks):
    """Draw the time per event of each variant, over the time of a package without effects.

    The ratio stands beside its symbol, and a column has the number of machine instructions.
    """
    longest, small = max(1 / row["ratio"] for row in rows), {"fontsize": 6.8}
    axes.set(xscale="log", xlim=(COST_FROM, longest * COST_ROOM), ylim=(len(rows) - 0.4, -0.6))
    column = small | {"xycoords": axes.get_yaxis_transform(), "ha": "right"}
    for i, row in enumerate(rows):
        time, look = 1 / row["ratio"], looks.get(row["variant"], (GREY, "o"))
        axes.plot([1, time], [i, i], color=look[0], lw=0.8)
        if row["variant"] in looks:
            axes.plot(time, i, **panels.open_symbol(*look))
        drawing.label(axes, f"{time:.3g}", (time, i), (6, 0), ha="left", **small)
        drawing.label(axes, f"{row['instructions']}", (1, i), (COUNT_OFFSET, 0), **column)
    head = column | {"ha": "center", "va": "bottom", "linespacing": 1.1}
    drawing.label(axes, "instructions\nin kernel", (1, -0.6), (COUNT_OFFSET - 9, 3), **head)
    axes.axvline(1, color=GREY, lw=0.5, zorder=0)
    axes.set_yticks(range(len(rows)), [VARIANTS.get(r["variant"], r["variant"]) for r in rows])
    axes.set_xlabel("time / that without effects")
    axes.tick_params(axis="y", length=0)
    axes.xaxis.set_major_locator(FixedLocator([1, 10, 100]))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.set_title("(d)  time per event", loc="left", pad=panels.TITLE_PAD)


def _legend(axes, boxes, looks, rough):
    """Name the scenes; ``rough`` says whether there are estimates without an error bar."""
    handles = [axes.plot([], [], **panels.open_symbol(*look), ls="-")[0] for look in looks.values()]
    names = [f"{name}: {', '.join(panels.effects(box))}" for name, box in boxes.items()]
    if rough:
        handles += axes.plot([], [], **panels.CROSS_LOOK[1])
        names.append(panels.CROSS_LOOK[0])
    (box,) = {rf"$w\times h={panels.sides(box)}$" for box in boxes.values()}
    axes.figure.legend(
        handles, names, title=box, loc="outside upper center", ncols=3, columnspacing=2.0
    )
