"""The cost of accuracy: error against processor time for every method, and errors that stay."""

import math
from statistics import median
from typing import NamedTuple

import numpy as np
from matplotlib.ticker import LogLocator, NullLocator

from twodiscs.figures import drawing, panels
from twodiscs.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    MARKER_SIZES,
    ORANGE,
    PURPLE,
    SKY,
    VERMILLION,
    new_figure,
)
from twodiscs_paper.study import select

#: Inches: width of two columns, and the height.
COST_WIDTH, COST_HEIGHT = 7.0, 4.3

#: The ends of the axes: relative errors, and seconds.
ERROR_RANGE, SECONDS_RANGE = (1.0, 1e-6), (1e-7, 1e6)

GUIDES = {"1 s": 1.0, "1 min": 60.0, "1 h": 3600.0, "1 day": 86400.0}

#: The number of doublings of the time from one symbol to the next; the longest run also has one.
SYMBOL_DOUBLINGS = 2

#: The white box of a text that lines would run through.
PATCH = {"facecolor": "white", "edgecolor": "none", "pad": 0.4}


class MethodCurve(NamedTuple):
    """A method at one radius: its name in the figure, and its look."""

    method: str
    quantity: str
    is_hard: bool
    name: str
    colour: str
    marker: str


HOP_TIME, COLLISION_AREA = "horizontal_hop_time", "disc_collision_area"
TIME_CURVES = (
    MethodCurve("time_step", HOP_TIME, False, "time steps", VERMILLION, "s"),
    MethodCurve("scalar", HOP_TIME, False, "one by one", ORANGE, "D"),
    MethodCurve("lockstep", HOP_TIME, False, "dynamics", BLUE, "o"),
    MethodCurve("lockstep", HOP_TIME, True, "dynamics", SKY, "o"),
    MethodCurve("strip", HOP_TIME, True, "strips", GREEN, "^"),
)
SAMPLE_CURVES = (
    MethodCurve("shell", COLLISION_AREA, False, "area, shells", VERMILLION, "s"),
    MethodCurve("surface", COLLISION_AREA, False, "area, surface", GREEN, "^"),
    MethodCurve("conditioned", "volume", False, "volume, conditioned", PURPLE, "v"),
    MethodCurve("rejection", "volume", False, "volume, rejection", BLUE, "o"),
    MethodCurve("shell", COLLISION_AREA, True, "area, shells", ORANGE, "D"),
    MethodCurve("rejection", "volume", True, "volume, rejection", SKY, "o"),
)

#: The symbols of the settings of methods.
SETTING_SYMBOLS = {"time_step": r"\Delta t", "shell": r"\varepsilon"}

#: The lines of hard radii.
HARD_DASHES = (0, (4, 2))


def draw(box, tables):
    """Draw the rows of accuracy_cost.csv and of the long run, which is ``kept``.

    ``box`` is not used, because the tables have their own.
    """
    rows, kept = tables["accuracy_cost"], tables["kept"]
    figure = new_figure(COST_HEIGHT, COST_WIDTH, layout="constrained")
    radii = sorted({row["radius"] for row in kept})
    for axes, letter, series, title in zip(
        figure.subplots(1, 2, sharey=True), "ab", (TIME_CURVES, SAMPLE_CURVES),
        ("mean time between horizontal hops", "volume, area of disc collisions"), strict=True,
    ):  # fmt: skip
        axes.set_label(letter)
        axes.set(xscale="log", yscale="log", xlim=ERROR_RANGE, ylim=SECONDS_RANGE)
        axes.set_xlabel("relative error")
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(LogLocator(numticks=16))
            axis.set_minor_locator(NullLocator())
        axes.set_title(f"({letter})  {title}", loc="left")
        for name, seconds in GUIDES.items():
            axes.axhline(seconds, color=GREY, lw=0.4, zorder=0)
            drawing.label(axes, name, (ERROR_RANGE[1], seconds), (3, 0), ha="left", fontsize=6.8)
        for one in series:
            _draw_series(axes, kept, rows, one, radii)
        _draw_exact(axes, rows, radii[0], "volume" if series is TIME_CURVES else COLLISION_AREA)
        axes.plot([], [], ls="", label="this build", **panels.open_symbol(BLACK, "o", 0.8))
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=2, columnspacing=1.0)
    figure.axes[0].set_ylabel("processor time on one core (s)")
    figure.axes[1].tick_params(labelleft=False)
    return figure


def by_setting(rows, one, radii):
    """Return {setting: rows} of a ``MethodCurve``, the largest setting first."""
    wanted = {"radius": radii[one.is_hard], "method": one.method, "quantity": one.quantity}
    found = {}
    for row in select(rows, part="error", **wanted):
        found.setdefault(row["setting"] or 0.0, []).append(row)
    return dict(sorted(found.items(), reverse=True))


def _draw_series(axes, kept, rows, one, radii):
    """Draw measured errors, full for the long run and open for this build, and c/error²."""
    full = panels.open_symbol(one.colour, one.marker) | {"markerfacecolor": one.colour}
    name = f"{one.name}, near $h/4$" if one.is_hard else one.name
    axes.plot([], [], lw=0.8, ls=HARD_DASHES if one.is_hard else "-", label=name, **full)
    found = by_setting(kept, one, radii)
    for setting, own in found.items():
        _draw_law(axes, own[0]["c"], own[0]["floor"], one, setting, setting == min(found))
        _draw_errors(axes, own, full | {"zorder": 3})
    for own in by_setting(rows, one, radii).values():
        _draw_errors(axes, own, panels.open_symbol(one.colour, one.marker, 0.8) | {"zorder": 4})


def _draw_errors(axes, rows, style):
    """Draw some of the errors in a ``style``, the longest run always; few runs have bars."""
    rows = rows[::-1][::SYMBOL_DOUBLINGS]
    axes.plot(*_columns(rows), ls="", **style)
    # Errors of fewer runs than this have a bar.
    few = [row for row in rows if row["repetitions"] < 64]
    bars = [_spread(row) for row in few]
    axes.errorbar(*_columns(few), xerr=bars, ls="", color=style["color"], lw=0.6, zorder=2)


def _columns(rows):
    return [[row[name] for row in rows] for name in ("error", "seconds")]


def _spread(row):
    """Return the standard error of the root mean square of R errors with a bias and a variance."""
    variance, bias = row["c"] / row["seconds"], row["floor"] ** 2
    square = (2 * bias + variance) * variance / (2 * row["repetitions"])
    return row["error"] * math.sqrt(square) / (bias + variance)


def _law(c, floor):
    """Return (errors, seconds) of a method with c, above the ``floor``."""
    errors = np.geomspace(*ERROR_RANGE, 400)
    if floor:
        above = floor * (1 + np.geomspace(1e-14, 1, 200))
        errors = np.sort(np.append(errors[errors > floor], above))
    return errors, c / (errors**2 - floor**2)


def _draw_law(axes, c, floor, one, setting, is_last):
    """Draw c/error², or c/(error² − bias²) with the setting, right of the ``is_last`` line."""
    errors, seconds = _law(c, floor)
    dashes = HARD_DASHES if one.is_hard else "-"
    axes.plot(errors, seconds, color=one.colour, lw=0.8, ls=dashes, zorder=1)
    if floor and one.method in SETTING_SYMBOLS:
        number = f"{setting:.2g}"
        if one.method == "time_step":
            number = f"2^{{{round(math.log2(setting))}}}"
        style = {"rotation": 90, "va": "top", "fontsize": 6.8, "bbox": PATCH}
        offset, style["ha"] = ((2, -3), "left") if is_last else ((-2, -3), "right")
        text = f"${SETTING_SYMBOLS[one.method]}={number}$"
        drawing.label(axes, text, (floor, SECONDS_RANGE[1]), offset, **style)


def _draw_exact(axes, rows, radius, quantity):
    """Draw the time of the exact value, which has no error to speak of, and Gauss quadrature."""
    own = select(rows, part="exact", radius=radius, quantity=quantity)
    seconds = median(row["seconds"] for row in select(own, method="exact"))
    axes.axhline(seconds, color=BLACK, lw=1.0, zorder=2)
    text = f"exact: {1e3 * seconds:.2g} ms, error $10^{{-15}}$"
    drawing.label(axes, text, (ERROR_RANGE[1], seconds), (-3, -2), ha="right", va="top", bbox=PATCH)
    if quantity == COLLISION_AREA:
        nodes = select(own, method="quadrature")
        seconds = median(row["seconds"] for row in nodes)
        shown = [row for row in nodes if row["error"] > ERROR_RANGE[1]]
        error = [row["error"] for row in shown]
        text = f"quadrature, 1 to {len(error)} nodes"
        axes.plot(error, [seconds] * len(error), "P", color=BLACK, ms=MARKER_SIZES["P"], label=text)
