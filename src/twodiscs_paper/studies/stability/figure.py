"""How theory and sampling behave in numerically hard cases: parts of stability.csv."""

import numpy as np
from matplotlib.ticker import FixedLocator, LogLocator, NullLocator
from scipy.special import ndtr

from twodiscs.figures import drawing, panels
from twodiscs.figures.style import BLACK, BLUE, GREY, ORANGE, SERIES, VERMILLION, new_figure

#: Inches: the width of two columns, the height of a panel, margins, the gap between panels.
WIDTH, HEIGHT = 7.0, 1.5
RIGHT, BOTTOM, TOP, BETWEEN = 0.1, 0.36, 0.24, 0.6

BOUND = {"color": GREY, "lw": 0.6, "ls": (0, (4, 2)), "zorder": 0}
#: Errors that are exactly zero are drawn here.
NOTHING = 1e-17

#: Residuals are counted up to this size, which no test passes.
LARGEST_Z = 5


def draw(box, tables):
    """Draw the rows of stability.csv on theory and sampling, for the ``box`` of the first scene."""
    parts = by_part(tables["stability"])
    figure = new_figure(TOP + 2 * HEIGHT + BETWEEN + BOTTOM, WIDTH)
    _largest(panel(figure, "a"), parts.get("theory", []))
    _thresholds(panel(figure, "b"), parts.get("theory", []))
    _shares(panel(figure, "c"), parts.get("sampling", []))
    _scores(panel(figure, "d"), parts.get("estimates", []), parts.get("extremes", []))
    panels.title(figure.axes[0], "", box)
    return figure


def by_part(rows):
    """Return {part: its rows}."""
    parts = {}
    for row in rows:
        parts.setdefault(row["part"], []).append(row)
    return parts


def panel(figure, name, names=0.0, beside=0.0, lowest=0.0):
    """Return new axes in one of the four quarters, with their letter ``name``.

    ``names`` and ``beside`` are the widths, in inches, of texts at the left and at the right of the
    panel. The quarters begin at the height ``lowest``, in inches.
    """
    place = "abcd".index(name)
    left, across = panels.LEFT + place % 2 * WIDTH / 2, WIDTH / 2 - panels.LEFT - RIGHT
    bottom = lowest + BOTTOM + (1 - place // 2) * (HEIGHT + BETWEEN)
    axes = panels.add_panel(figure, bottom, HEIGHT, left + names, across - names - beside, name)
    corner = {"xycoords": "axes fraction", "ha": "left", "va": "bottom"}
    drawing.label(axes, f"({name})", (0, 1), (2 - 72 * (panels.LEFT + names), 3), **corner)
    return axes


def select(rows, **wanted):
    """Return the ``rows`` that have these values."""
    return [row for row in rows if all(row[name] == value for name, value in wanted.items())]


def _logarithmic(axes, x, y):
    """Make both scales logarithmic between the limits ``x`` and ``y``, with few labels."""
    axes.set(xscale="log", yscale="log", xlim=x, ylim=y)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(numticks=6))
        axis.set_minor_locator(NullLocator())


# Theory and sampling ------------------------------------------------------------------------------

LINES = (
    ("closed-form", "volume", VERMILLION, "s", "$V$, closed form"),
    ("closed-form", "areas", ORANGE, "D", "areas, closed form"),
    ("stable", None, BLUE, "o", "as computed"),
)


def _worst(rows, method, quantity):
    """Return (distances, worst errors) of a method, over all quantities if ``quantity`` is None."""
    worst = {}
    for row in select(rows, method=method):
        if quantity in (None, row["quantity"]):
            distance = abs(row["distance"])
            worst[distance] = max(worst.get(distance, 0.0), row["value"])
    return zip(*sorted(worst.items()), strict=True) if worst else ([], [])


def _errors(axes, rows, high):
    """Draw relative errors over distances, with their bound."""
    for method, quantity, colour, marker, name in LINES:
        x, y = _worst(rows, method, quantity)
        y = [max(value, NOTHING) for value in y]
        axes.plot(x, y, label=name, lw=0.7, **panels.open_symbol(colour, marker, 0.8))
    for row in select(rows, method="stable")[:1]:
        axes.axhline(row["high"], **BOUND)
    _logarithmic(axes, (5e-15, 0.3), (NOTHING, high))
    axes.set_ylabel("relative error")


def _largest(axes, rows):
    _errors(axes, select(rows, case="largest radius"), 0.3)
    axes.set(xlim=(5e-13, 0.3), xlabel=r"$1-r/r_{\mathrm{max}}$")
    axes.legend(loc="upper left")


def _thresholds(axes, rows):
    _errors(axes, [row for row in rows if row["case"] != "largest radius"], 1e-2)
    axes.set_xlabel(r"$|r/r_{\mathrm{c}}-1|$,  $r_{\mathrm{c}}=h/4,\,w/4$")
    axes.legend(loc="upper right")


def _shares(axes, rows):
    """Draw the accepted shares below the largest radius."""
    rows = select(rows, case="largest radius")
    for method, look, name in (
        ("conditioned", SERIES[0], "conditioned"),
        ("prism", SERIES[1], "rejection"),
    ):
        points = sorted((-row["distance"], row["value"]) for row in select(rows, method=method))
        x, y = zip(*points, strict=True) if points else ([], [])
        axes.plot(x, y, label=name, lw=0.7, **panels.open_symbol(*look, 0.8))
    for row in select(rows, method="conditioned")[:1]:
        axes.axhline(row["low"], **BOUND)
    _logarithmic(axes, (5e-13, 0.3), (1e-20, 1e2))
    axes.set(xlabel=r"$1-r/r_{\mathrm{max}}$", ylabel="accepted share")
    axes.legend(loc="lower left")


# A line for each radius ---------------------------------------------------------------------------


def rounded(number):
    """Return a positive ``number`` to one digit, "10⁻⁹" or "5 × 10⁷", in mathtext."""
    mantissa, exponent = f"{number:.0e}".split("e")
    times = "" if mantissa == "1" else rf"{mantissa}\times"
    return rf"{times}10^{{{int(exponent)}}}"


def _power(distance):
    """Return "(1 − 10⁻⁹)" or the like in mathtext."""
    return f"(1{'+' if distance > 0 else '-'}{rounded(abs(distance))})"


def radii_of(rows):
    """Return {(case, radius): name in mathtext}, ascending in the radius."""
    names = {"h/4": "h/4", "w/4": "w/4", "largest radius": r"r_{\mathrm{max}}"}
    texts = {}
    for row in sorted(rows, key=lambda row: row["radius"]):
        key = row["case"], row["radius"]
        if row["case"] in names:
            texts[key] = rf"${names[row['case']]}\,{_power(row['distance'])}$"
        else:
            tiny = f"$r={rounded(row['radius'])}$"
            texts[key] = (
                f"$r={panels.math_of(row['radius'])}$" if row["case"] == "ordinary" else tiny
            )
    return texts


def lines(axes, names):
    """Make the ordinate a list of ``names``, from the top down."""
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.yaxis.set_major_locator(FixedLocator(range(len(names))))
    axes.set_yticklabels(names, fontsize=6.9)
    axes.tick_params(axis="y", length=0)
    for i in range(len(names)):
        axes.axhline(i, color=GREY, lw=0.25, alpha=0.5, zorder=0)


def _scores(axes, estimates, extremes):
    """Draw how many residuals are how large, beside the normal law of as many of them."""
    edges = np.linspace(-LARGEST_Z, LARGEST_Z, 2 * LARGEST_Z + 1)
    groups = {
        "volume and areas": [row["z"] for row in estimates if row["status"] == "sampled"],
        "extreme scenes": [row["z"] for row in extremes if row["z"] is not None],
    }
    axes.hist(
        groups.values(), edges, stacked=True, label=[*groups], color=(BLUE, ORANGE), rwidth=0.85
    )
    number = sum(map(len, groups.values()))
    law = number * np.diff(ndtr(edges))
    axes.stairs(law, edges, color=BLACK, lw=0.8, label="normal law")
    axes.set(xlim=(edges[0], edges[-1]), xlabel="residual $z$", ylabel=f"count of {number}")
    axes.legend(loc="upper left")


def heading(axes):
    """Put the legend above the panel."""
    tight = {"handletextpad": 0.1, "columnspacing": 0.5, "borderaxespad": 0.0, "borderpad": 0.1}
    axes.legend(loc="lower right", bbox_to_anchor=(0.97, 1.01), ncols=3, **tight)
