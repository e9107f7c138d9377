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
    ORANGE,
    PURPLE,
    SIZES,
    SKY,
    VERMILLION,
    new_figure,
)

#: Inches: width of two columns, and the height.
WIDTH, HEIGHT = 7.0, 3.9

#: The ends of the axes: relative errors, and seconds.
ERRORS, SECONDS = (1.0, 1e-6), (1e-7, 1e6)

GUIDES = {"1 s": 1.0, "1 min": 60.0, "1 h": 3600.0, "1 day": 86400.0}

#: The number of doublings of the time from one symbol to the next; the longest run has one, too.
THINNED = 2

#: Errors of fewer runs than this have a bar.
FEW = 64

#: Names at the right end of an axis are apart by this factor of the time at least.
APART = 2.6


class MethodCurve(NamedTuple):
    """A method at one radius: its name in the figure, and its look."""

    method: str
    quantity: str
    is_hard: bool
    name: str
    colour: str
    marker: str


HOP, AREA = "horizontal_hop_time", "disc_collision_area"
TIMES = (
    MethodCurve("time_step", HOP, False, "time steps", VERMILLION, "s"),
    MethodCurve("scalar", HOP, False, "one by one", ORANGE, "D"),
    MethodCurve("lockstep", HOP, False, "dynamics", BLUE, "o"),
    MethodCurve("lockstep", HOP, True, "dynamics", SKY, "o"),
    MethodCurve("strip", HOP, True, "strips", GREEN, "^"),
)
SAMPLES = (
    MethodCurve("shell", AREA, False, "area, shells", VERMILLION, "s"),
    MethodCurve("surface", AREA, False, "area, surface", GREEN, "^"),
    MethodCurve("conditioned", "volume", False, "volume, conditioned", PURPLE, "v"),
    MethodCurve("rejection", "volume", False, "volume, rejection", BLUE, "o"),
    MethodCurve("shell", AREA, True, "area, shells", ORANGE, "D"),
    MethodCurve("rejection", "volume", True, "rejection", SKY, "o"),
)

#: The name and the symbol of the setting of a method.
SETTINGS = {"time_step": ("step", r"\Delta t"), "shell": ("shell", r"\varepsilon")}


def draw(box, tables):
    """Draw the rows of accuracy_cost.csv and of the long run, which is ``kept``.

    ``box`` is not used, because the tables have their own.
    """
    rows, kept = tables["accuracy_cost"], tables["kept"]
    figure = new_figure(HEIGHT, WIDTH, layout="constrained")
    radii = sorted({row["radius"] for row in kept})
    for axes, letter, series, title in zip(
        figure.subplots(1, 2, sharey=True), "ab", (TIMES, SAMPLES),
        ("mean time between horizontal hops", "volume, area of disc collisions"), strict=True,
    ):  # fmt: skip
        axes.set_label(letter)
        axes.set(xscale="log", yscale="log", xlim=ERRORS, ylim=SECONDS, xlabel="relative error")
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(LogLocator(numticks=16))
            axis.set_minor_locator(NullLocator())
        axes.set_title(f"({letter})  {title}", loc="left")
        for name, seconds in GUIDES.items():
            axes.axhline(seconds, color=GREY, lw=0.4, zorder=0)
            place = {"ha": "left", "va": "bottom", "color": GREY, "fontsize": 6.8}
            drawing.label(axes, name, (ERRORS[0], seconds), (3, 1), **place)
        lines = [line for one in series for line in _draw_series(axes, kept, rows, one, radii)]
        _name_lines(axes, lines)
        _draw_exact(axes, rows, radii[0], "volume" if series is TIMES else AREA)
    figure.axes[0].set_ylabel("processor time on one core (s)")
    figure.axes[1].tick_params(labelleft=False)
    return figure


def select(rows, one, radii):
    """Return {setting: rows} of a ``MethodCurve``, the largest setting first."""
    found = {}
    for row in rows:
        own = row["part"] == "error" and row["radius"] == radii[one.is_hard]
        if own and (row["method"], row["quantity"]) == (one.method, one.quantity):
            found.setdefault(row["setting"] or 0.0, []).append(row)
    return dict(sorted(found.items(), reverse=True))


def _draw_series(axes, kept, rows, one, radii):
    """Draw measured errors, full for the long run and open for this build, and c/error².

    Return the lines without a bias, as ``_name_lines`` takes them.
    """
    full = panels.open_symbol(one.colour, one.marker) | {"markerfacecolor": one.colour}
    found = select(kept, one, radii)
    for setting, own in found.items():
        _draw_law(axes, own[0]["c"], own[0]["floor"], one, setting, setting == max(found))
        _draw_errors(axes, own, full | {"zorder": 3})
    for own in select(rows, one, radii).values():
        _draw_errors(axes, own, panels.open_symbol(one.colour, one.marker, 0.8) | {"zorder": 4})
    name = f"{one.name}, near $h/4$" if one.is_hard else one.name
    return [(own[0]["c"], name, one.colour) for own in found.values() if not own[0]["floor"]]


def _name_lines(axes, lines):
    """Write the names of ``lines``, [(c, name, colour)], where they leave the panel.

    The panel ends on the right, or for slow methods at the top, where the names stand beneath each
    other, beside the last of these lines.
    """
    low = 0.0
    for c, name, colour in sorted(lines):
        low = max(c / ERRORS[1] ** 2, APART * low)
        if low < APART * SECONDS[1]:
            place = ERRORS[1], min(low, SECONDS[1])
            drawing.label(axes, name, place, (4, 0), ha="left", color=colour, fontsize=7.5)
    slow = [line for line in sorted(lines) if line[0] / ERRORS[1] ** 2 >= APART * SECONDS[1]]
    for i, (_, name, colour) in enumerate(reversed(slow)):
        place = (slow[0][0] / SECONDS[1]) ** 0.5, SECONDS[1]
        drawing.label(axes, name, place, (5, -6 - 9 * i), ha="left", color=colour, fontsize=6.8)


def _draw_errors(axes, rows, style):
    """Draw some of the errors in a ``style``, the longest run always; few runs have bars."""
    rows = rows[::-1][::THINNED]
    axes.plot(*_columns(rows), ls="", **style)
    few = [row for row in rows if row["repetitions"] < FEW]
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
    errors = np.geomspace(*ERRORS, 400)
    if floor:
        above = floor * (1 + np.geomspace(1e-14, 1, 200))
        errors = np.sort(np.append(errors[errors > floor], above))
    return errors, c / (errors**2 - floor**2)


def _draw_law(axes, c, floor, one, setting, is_first):
    """Draw c/error², or c/(error² − bias²) with the setting, whose name the first line has."""
    errors, seconds = _law(c, floor)
    dashes = (0, (4, 2)) if one.is_hard else "-"
    axes.plot(errors, seconds, color=one.colour, lw=0.8, ls=dashes, zorder=1)
    if floor and one.method in SETTINGS:
        number = f"{setting:.2g}"
        if one.method == "time_step":
            number = f"2^{{{round(math.log2(setting))}}}"
        name, symbol = SETTINGS[one.method]
        text = rf"{name if is_first else ''} ${symbol}={number}$".strip()
        style = {"rotation": 90, "ha": "left", "va": "top", "fontsize": 6.8, "color": one.colour}
        drawing.label(axes, text, (floor, SECONDS[1]), (2, -3), **style)


def _draw_exact(axes, rows, radius, quantity):
    """Draw the time of the exact value, which has no error to speak of, and Gauss quadrature."""
    own = [row for row in rows if row["part"] == "exact" and row["radius"] == radius]
    own = [row for row in own if row["quantity"] == quantity]
    seconds = median(row["seconds"] for row in own if row["method"] == "exact")
    axes.axhline(seconds, color=BLACK, lw=1.0, zorder=2)
    end = {"ha": "right", "va": "top"}
    text = f"exact: {1e3 * seconds:.2g} ms, error $10^{{-15}}$"
    drawing.label(axes, text, (ERRORS[1], seconds), (-3, -2), **end)
    if quantity == AREA:
        nodes = [row for row in own if row["method"] == "quadrature"]
        seconds = median(row["seconds"] for row in nodes)
        shown = [row for row in nodes if row["error"] > ERRORS[1]]
        error = [row["error"] for row in shown]
        axes.plot(error, [seconds] * len(error), "P", color=BLACK, ms=SIZES["P"])
        text = f"quadrature, 1 to {len(error)} nodes: ${1e6 * seconds:.1g}\\,\\mu$s"
        drawing.label(axes, text, (ERRORS[1], seconds), (-3, -4), **end)
