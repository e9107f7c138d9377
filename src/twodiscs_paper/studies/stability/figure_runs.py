"""How the dynamics behaves in numerically hard cases: parts of stability.csv, a panel each."""

import math

import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter, NullLocator

from twodiscs.figures import drawing, panels
from twodiscs.figures.style import (
    BLACK,
    EVENT_LOOKS,
    GREY,
    ORANGE,
    SERIES,
    VERMILLION,
    event_name,
    new_figure,
)
from twodiscs_paper.studies.stability.figure import BOUND, PANEL_HEIGHT, TWO_COLUMNS
from twodiscs_paper.study import select

#: The symbol of times by the formula of textbooks; the look of the sum rule of virials.
TEXTBOOK, VIRIAL_LOOK = {"color": VERMILLION, "marker": "x", "markersize": 3.4}, (GREY, "o")

#: Inches: the height of the lowest panel. Its legend stands above.
LOWEST_HEIGHT = 2.6
LEGEND_PLACE = {
    "loc": "lower right", "bbox_to_anchor": (1, 1.01), "handletextpad": 0.1, "columnspacing": 0.8,
    "borderaxespad": 0.0,
}  # fmt: skip

#: The quantities of the runs of many events, and their names.
WORST = {"energy_error": "$|E-1/2|$", "smallest_gap": "overlap", "excess": "beyond wall"}


def draw(box, tables):
    """Draw the rows of stability.csv on dynamics, for the ``box`` of the first scene."""
    rows = tables["stability"]
    heights = PANEL_HEIGHT, PANEL_HEIGHT, LOWEST_HEIGHT
    figure = new_figure(sum(heights), TWO_COLUMNS, layout="constrained")
    upper, middle, lower = figure.subfigures(3, height_ratios=heights)
    axes = *upper.subplots(1, 2), middle.subplots(), lower.subplots()
    parts = {"dynamics": _runs, "times": _times, "reversal": _reversal, "extremes": _extremes}
    for one, letter, (part, draw_part) in zip(axes, "abcd", parts.items(), strict=True):
        one.set_label(letter)
        panels.title(one, letter, box if letter == "c" else None)
        draw_part(one, select(rows, part=part))
    return figure


def rounded(number):
    """Return a positive ``number`` to one digit, "10⁻⁹" or "5 × 10⁷", in mathtext."""
    mantissa, exponent = f"{number:.0e}".split("e")
    times = "" if mantissa == "1" else rf"{mantissa}\times"
    return rf"{times}10^{{{int(exponent)}}}"


def _power(distance):
    """Return "(1 − 10⁻⁹)" or the like in mathtext."""
    return f"(1{'+' if distance > 0 else '-'}{rounded(abs(distance))})"


def name_radii(rows):
    """Return {(case, radius): name in mathtext}, ascending in the radius."""
    names = {"h/4": "h/4", "w/4": "w/4", "largest radius": r"r_{\mathrm{max}}"}
    texts = {}
    for row in sorted(rows, key=lambda row: row["radius"]):
        key = row["case"], row["radius"]
        if row["case"] in names:
            texts[key] = rf"${names[row['case']]}\,{_power(row['distance'])}$"
        else:
            text = panels.mathtext if row["case"] == "ordinary" else rounded
            texts[key] = f"$r={text(row['radius'])}$"
    return texts


def name_lines(axes, names, places):
    """Make the ordinate a list of ``names`` at ``places``, from the top down."""
    axes.set_ylim(max(places, default=0) + 0.6, min(places, default=0) - 0.6)
    axes.set_yticks(places, names, fontsize=6.9)
    axes.tick_params(axis="y", length=0)


def rule_lines(axes, names):
    """Make the ordinate a list of ``names``, from the top down, with a thin line for each."""
    name_lines(axes, names, range(len(names)))
    for i in range(len(names)):
        axes.axhline(i, color=GREY, lw=0.25, alpha=0.5, zorder=0)


def _runs(axes, rows):
    """Write a table of the worst errors of the runs of many events, with their bounds beneath."""
    radii = name_radii(rows)
    top, *places, bottom = -0.3, *range(1, len(radii) + 1), len(radii) + 1.3
    name_lines(axes, ["radius", *radii.values(), "at most"], [top, *places, bottom])
    axes.set(xlim=(0, len(WORST) + 1), xticks=[])
    axes.spines[:].set_visible(False)
    for line in (0.35, len(radii) + 0.6):
        axes.axhline(line, -0.26, color=BLACK, lw=0.5, clip_on=False)
    lines = dict(zip(radii, places, strict=True))

    def write(column, line, text):
        drawing.label(axes, text, (column + 0.5, line), fontsize=6.9)

    for column, (quantity, name) in enumerate(WORST.items()):
        write(column, top, name)
        sign = -1 if quantity == "smallest_gap" else 1
        worst = select(rows, quantity=quantity)
        for row in worst:
            value = sign * row["value"]
            text = f"${rounded(value)}$" if value > 0 else "0"
            write(column, lines[row["case"], row["radius"]], text)
        for row in worst[:1]:
            bound = abs(row["low"] if sign < 0 else row["high"])
            write(column, bottom, f"${rounded(bound)}$")
    write(len(WORST), top, "events")
    for row in select(rows, quantity="energy_error"):
        write(len(WORST), lines[row["case"], row["radius"]], f"${rounded(row['count'])}$")


def _named(row):
    """Return the name of a kind of approach, to the other disc or to a wall."""
    return f"wall, {row['case']}" if row["quantity"] == "wall_time" else row["case"]


def _times(axes, rows):
    """Draw the worst errors of predicted times."""
    names = dict.fromkeys(map(_named, rows))
    contacts = select(rows, quantity="contact_time", method="stable")
    found = {row["case"]: row["count"] for row in contacts}
    rule_lines(axes, [*names])
    for row in rows:
        look = SERIES[0] if row["quantity"] == "contact_time" else SERIES[1]
        symbol = TEXTBOOK if row["method"] == "textbook" else panels.open_symbol(*look)
        at = row["value"], [*names].index(_named(row))
        axes.plot(*at, **symbol)
        missed = found.get(row["case"], 0) - row["count"]
        if row["method"] == "textbook" and missed:
            drawing.label(axes, f"{missed} missed", at, (5, 5), ha="left", fontsize=6.9)
    for name, symbol in (
        ("to a disc", panels.open_symbol(*SERIES[0])),
        ("to a wall", panels.open_symbol(*SERIES[1])),
        ("textbook formula", TEXTBOOK),
    ):
        axes.plot([], [], ls="", label=name, **symbol)
    axes.legend(ncols=3, **LEGEND_PLACE)
    axes.set(xscale="log", xlim=(0.1, 1e11))
    axes.set_xlabel(r"error / ($2^{-52}\times$ conditioning)", x=1, ha="right")
    axes.xaxis.set_minor_formatter(NullFormatter())
    for row in rows[:1]:
        axes.axvline(row["high"], **BOUND)


def _extremes(axes, rows):
    """Draw the residuals of the mean times in extreme scenes, a line for each scene."""
    cases = [*dict.fromkeys(row["case"] for row in rows)]
    rule_lines(axes, cases)
    for event, look in (EVENT_LOOKS | {"virial": VIRIAL_LOOK}).items():
        quantities = event, f"{event}_time"
        own = [r for r in rows if r["quantity"] in quantities and r["z"] is not None]
        x, y = [row["z"] for row in own], [cases.index(row["case"]) for row in own]
        name = "virial theorem" if event == "virial" else event_name(event)
        axes.plot(x, y, ls="", label=name, **panels.open_symbol(*look))
    axes.set(xlim=(-6.5, 6.5), xlabel="residual $z$ of mean times")
    for z in (-5, 5):
        axes.axvline(z, **BOUND)
    axes.axvline(0, color=GREY, lw=0.5, zorder=0)
    axes.legend(ncols=7, **LEGEND_PLACE)


# Reversal -----------------------------------------------------------------------------------------


def _reversal(axes, rows):
    """Draw the error of return against the digits that the exponent predicts to be lost."""
    looks = (*SERIES, (ORANGE, "v"))
    radii = sorted({row["radius"] for row in select(rows, quantity="return_error")})
    bits = np.array([0.0, 36.0])
    axes.plot(bits, 2.0 ** (bits - 53), color=BLACK, lw=0.7, zorder=1)
    for look, radius in zip(looks, radii, strict=False):
        here = select(rows, radius=radius)
        rate = select(here, quantity="exponent", case="separation")[0]["value"]
        number = select(here, quantity="events_retraced")[0]
        returns = select(here, quantity="return_error")
        x = [rate * row["count"] / math.log(2) for row in returns]
        y = [row["value"] for row in returns]
        name = (
            f"$r={panels.mathtext(radius)}$: {number['value']:.0f} events ({number['exact']:.0f})"
        )
        axes.plot(x, y, ls="", label=name, zorder=2, **panels.open_symbol(*look, 0.9))
    axes.axhline(2.0**-26, **BOUND)
    axes.set(yscale="log", xlim=(0, 36), ylim=(1e-16, 1e-4))
    axes.yaxis.set_major_locator(LogLocator(numticks=6))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.set_xlabel(r"binary digits lost to $n$ events, $n\lambda/\ln 2$")
    axes.set_ylabel("error of return")
    if radii:
        axes.legend(loc="lower right", **{"handletextpad": 0.1})
