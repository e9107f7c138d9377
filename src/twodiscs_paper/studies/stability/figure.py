"""How theory and sampling behave in numerically hard cases: parts of stability.csv."""

import numpy as np
from matplotlib.ticker import LogLocator, NullLocator
from scipy.special import ndtr

from twodiscs.figures import panels
from twodiscs.figures.style import BLACK, BLUE, GREY, ORANGE, SERIES, VERMILLION, new_figure
from twodiscs_paper.study import select

#: Inches: the width of two columns, and the height of a panel with its labels.
TWO_COLUMNS, PANEL_HEIGHT = 7.0, 2.0

BOUND = {"color": GREY, "lw": 0.6, "ls": (0, (4, 2)), "zorder": 0}
#: Errors that are exactly zero are drawn here.
ZERO_ERROR = 1e-17

#: Residuals are counted up to this size, which no test passes.
SHOWN_Z = 5


def draw(box, tables):
    """Draw the rows of stability.csv on theory and sampling, for the ``box`` of the first scene."""
    rows = tables["stability"]
    figure = new_figure(2 * PANEL_HEIGHT, TWO_COLUMNS, layout="constrained")
    axes = dict(zip("abcd", figure.subplots(2, 2).flat, strict=True))
    for letter, one in axes.items():
        one.set_label(letter)
        panels.title(one, letter, box if letter == "a" else None)
    theory = select(rows, part="theory")
    _largest(axes["a"], theory)
    _thresholds(axes["b"], theory)
    _shares(axes["c"], select(rows, part="sampling"))
    _scores(axes["d"], select(rows, part="estimates"), select(rows, part="extremes"))
    return figure


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
        y = [max(value, ZERO_ERROR) for value in y]
        axes.plot(x, y, label=name, lw=0.7, **panels.open_symbol(colour, marker, 0.8))
    for row in select(rows, method="stable")[:1]:
        axes.axhline(row["high"], **BOUND)
    _logarithmic(axes, (5e-15, 0.3), (ZERO_ERROR, high))
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


def _scores(axes, estimates, extremes):
    """Draw how many residuals are how large, beside the normal law of as many of them."""
    edges = np.linspace(-SHOWN_Z, SHOWN_Z, 2 * SHOWN_Z + 1)
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
