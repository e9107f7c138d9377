"""How every method behaves where arithmetic has it hard, a panel for each part of stability.csv."""

import math

import numpy as np
from matplotlib.ticker import FixedLocator, LogLocator, NullFormatter, NullLocator
from matplotlib.transforms import blended_transform_factory

from twodiscs.figures.kit import drawing, panels
from twodiscs.figures.kit.looks import LOOKS, name_of
from twodiscs.figures.kit.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    SERIES,
    VERMILLION,
    new_figure,
)

#: Inches: the width of two columns, rows of panels, what stands between and around them.
WIDTH, ROWS = 7.0, (1.75, 1.75, 1.85)
RIGHT, BOTTOM, TOP, BETWEEN = 0.1, 0.36, 0.2, 0.56

BOUND = {"color": GREY, "lw": 0.6, "ls": (0, (4, 2)), "zorder": 0}
SMALL = {"fontsize": 6.5, "borderaxespad": 0.3}

#: Colour and marker of each quantity of the long runs.
WORST = {"energy_error": (BLUE, "o"), "smallest_gap": (VERMILLION, "s"), "excess": (GREEN, "^")}

#: Errors that are exactly zero are drawn here.
NOTHING = 1e-17


def draw(box, tables):
    """Draw the rows of stability.csv, which are on the ``Box`` of the first scene."""
    parts = {}
    for row in tables["stability"]:
        parts.setdefault(row["part"], []).append(row)
    figure = new_figure(TOP + sum(ROWS) + 2 * BETWEEN + BOTTOM, WIDTH)
    _largest(_panel(figure, 0, 0.5, 1.75, "a"), parts.get("theory", []))
    _thresholds(_panel(figure, 0, 2.75, 1.75, "b"), parts.get("theory", []))
    _shares(_panel(figure, 0, 5.0, 1.9, "c"), parts.get("sampling", []))
    runs, estimates = parts.get("dynamics", []), parts.get("estimates", [])
    radii = _radii(estimates + runs)
    left = _panel(figure, 1, 1.0, 1.4, "d", 0.9)
    _estimates(left, estimates, radii)
    _runs(_panel(figure, 1, 2.6, 1.8, "e", 0.1), runs, radii)
    _times(_panel(figure, 1, 5.8, 1.1, "f", 1.05), parts.get("times", []))
    _reversal(_panel(figure, 2, 0.5, 2.6, "g"), parts.get("reversal", []))
    _coverage(_panel(figure, 2, 3.65, 3.25, "h"), parts.get("coverage", []))
    panels.name_box(figure.axes[0], box)
    return figure


def caption(shown):
    """Return the caption."""
    text = """
    How the methods behave at hard radii; dashed lines are what is required. (a) Relative error of
    volume and areas in double precision below the largest radius, and (b) on both sides of the
    radii where a hop becomes blocked: closed forms, and the worst of volume, areas and mean times
    as computed here. (c) Share of proposed configurations that is accepted, by rejection from the
    prism and by the draws of initial states. (d) Residuals of volume and areas estimated by those
    draws. (e) Worst of a long run: error of the energy, overlap of the discs, distance of centres
    beyond their range. (f) Worst error of predicted times to a contact (circles) and to a wall
    (squares), against 50 digits, for many ways to approach. (g) Velocities are reversed after n
    events: error of return after n more events, against the binary digits that the Lyapunov
    exponent λ per event costs; the line is one rounding that grows at this rate. The legend has the
    number of events after which half of the digits are lost, and in brackets the number that λ
    predicts. (h) Share of 95 % intervals that contain the exact mean time, over independent
    repetitions. Rows without a symbol were not run.
    """
    return text + shown.if_any(
        lambda row: row["part"] == "coverage" and row["value"] is None,
        "Crosses are events too rare for an interval.",
    )


def _panel(figure, line, left, width, name, margin=0.42):
    """Return new axes in a row of panels, ``left`` and ``width`` in inches, with their letter."""
    bottom = BOTTOM + sum(ROWS[line + 1 :]) + BETWEEN * (len(ROWS) - 1 - line)
    axes = panels.add_panel(figure, bottom, ROWS[line], left, width)
    corner = {"xycoords": "axes fraction", "ha": "left", "va": "bottom"}
    drawing.label(axes, f"({name})", (0, 1), (-72 * margin, 3), **corner)
    return axes


def _select(rows, **wanted):
    return [row for row in rows if all(row[name] == value for name, value in wanted.items())]


def _logarithmic(axes, x, y):
    """Make both scales logarithmic between the limits ``x`` and ``y``, a label a few decades."""
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
    """Return (distances, worst errors) of a method; ``quantity`` None stands for all of them."""
    worst = {}
    for row in _select(rows, method=method):
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
    for row in _select(rows, method="stable")[:1]:
        axes.axhline(row["high"], **BOUND)
    _logarithmic(axes, (5e-15, 0.3), (NOTHING, high))
    axes.set_ylabel("relative error")


def _largest(axes, rows):
    _errors(axes, _select(rows, case="largest radius"), 0.3)
    axes.set(xlim=(5e-13, 0.3), xlabel=r"$1-r/r_{\mathrm{max}}$")
    axes.legend(loc="upper left", **SMALL)


def _thresholds(axes, rows):
    _errors(axes, [row for row in rows if row["case"] != "largest radius"], 1e-2)
    axes.set_xlabel(r"$|r/r_{\mathrm{c}}-1|$,  $r_{\mathrm{c}}=h/4,\,w/4$")
    axes.legend(loc="upper right", **SMALL)


def _shares(axes, rows):
    """Draw the accepted shares below the largest radius."""
    rows = _select(rows, case="largest radius")
    for method, look, name in (
        ("conditioned", SERIES[0], "as drawn here"),
        ("prism", SERIES[1], "from the prism"),
    ):
        points = sorted((-row["distance"], row["value"]) for row in _select(rows, method=method))
        x, y = zip(*points, strict=True) if points else ([], [])
        axes.plot(x, y, label=name, lw=0.7, **panels.open_symbol(*look, 0.8))
    for row in _select(rows, method="conditioned")[:1]:
        axes.axhline(row["low"], **BOUND)
    _logarithmic(axes, (5e-13, 0.3), (1e-20, 1e2))
    axes.set(xlabel=r"$1-r/r_{\mathrm{max}}$", ylabel="accepted share")
    axes.legend(loc="lower left", **SMALL)


# One line a radius --------------------------------------------------------------------------------


def _rounded(number):
    """Return a positive ``number`` to one digit, "10⁻⁹" or "5 × 10⁷", in mathtext."""
    mantissa, exponent = f"{number:.0e}".split("e")
    times = "" if mantissa == "1" else rf"{mantissa}\times"
    return rf"{times}10^{{{int(exponent)}}}"


def _power(distance):
    """Return "(1 − 10⁻⁹)" or the like in mathtext."""
    return f"(1{'+' if distance > 0 else '-'}{_rounded(abs(distance))})"


def _radii(rows):
    """Return {(case, radius): name in mathtext}, ascending in the radius."""
    names = {"h/4": "h/4", "w/4": "w/4", "largest radius": r"r_{\mathrm{max}}"}
    texts = {}
    for row in sorted(rows, key=lambda row: row["radius"]):
        key = row["case"], row["radius"]
        if row["case"] in names:
            texts[key] = rf"${names[row['case']]}\,{_power(row['distance'])}$"
        else:
            tiny = f"$r={_rounded(row['radius'])}$"
            texts[key] = (
                f"$r={panels.number(row['radius'])}$" if row["case"] == "ordinary" else tiny
            )
    return texts


def _lines(axes, names, labelled=True):
    """Make the ordinate a list of ``names``, from the top down."""
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.yaxis.set_major_locator(FixedLocator(range(len(names))))
    axes.set_yticklabels(names if labelled else [""] * len(names), fontsize=6.5)
    axes.tick_params(axis="y", length=0)
    for i in range(len(names)):
        axes.axhline(i, color=GREY, lw=0.25, alpha=0.5, zorder=0)


def _estimates(axes, rows, radii):
    """Draw the residuals of the conditioned estimates."""
    places = {key: i for i, key in enumerate(radii)}
    _lines(axes, list(radii.values()))
    for look, volume, name in ((SERIES[0], True, "$V$"), (SERIES[1], False, "areas")):
        shown = [
            (row["z"], places[row["case"], row["radius"]])
            for row in rows
            if (row["quantity"] == "volume") == volume and row["status"] == "sampled"
        ]
        x, y = zip(*shown, strict=True) if shown else ([], [])
        axes.plot(x, y, ls="", label=name, clip_on=False, **panels.open_symbol(*look, 0.8))
    for z in (-5, 5):
        axes.axvline(z, **BOUND)
    axes.axvline(0, color=GREY, lw=0.5, zorder=0)
    axes.set(xlim=(-6.5, 6.5), xlabel="residual $z$ of estimates")
    axes.xaxis.set_major_locator(FixedLocator([-5, 0, 5]))
    _heading(axes)


def _runs(axes, rows, radii):
    """Draw the worst errors of the long runs, with their bounds."""
    places = {key: i for i, key in enumerate(radii)}
    _lines(axes, list(radii.values()), labelled=False)
    names = {"energy_error": "$|E-1/2|$", "smallest_gap": "overlap", "excess": "beyond wall"}
    for quantity, (colour, marker) in WORST.items():
        shown = _select(rows, quantity=quantity)
        sign = -1 if quantity == "smallest_gap" else 1
        x = [max(sign * row["value"], NOTHING) for row in shown]
        y = [places[row["case"], row["radius"]] for row in shown]
        axes.plot(x, y, ls="", label=names[quantity], **panels.open_symbol(colour, marker, 0.9))
        for row in shown[:1]:
            bound = abs(row["low"] if sign < 0 else row["high"])
            axes.axvline(bound, **BOUND | {"color": colour})
    axes.set(xscale="log", xlim=(NOTHING / 2, 1e-10), xlabel="worst of a run")
    axes.xaxis.set_major_locator(FixedLocator([NOTHING, 1e-15, 1e-13, 1e-11]))
    axes.set_xticklabels(["0", "$10^{-15}$", "$10^{-13}$", "$10^{-11}$"])
    axes.xaxis.set_minor_locator(NullLocator())
    _heading(axes)
    beside = {"xycoords": blended_transform_factory(axes.transAxes, axes.transData), "ha": "left"}
    for row in _select(rows, quantity="energy_error"):
        events = f"${_rounded(row['count'])}$"
        at = 1, places[row["case"], row["radius"]]
        drawing.label(axes, events, at, (4, 0), fontsize=6.5, **beside)
    drawing.label(axes, "events", (1, -0.6), (4, 5), fontsize=6.5, **beside)


def _heading(axes):
    """Put the legend above the panel."""
    tight = {"handletextpad": 0.1, "columnspacing": 0.5, "borderaxespad": 0.0, "borderpad": 0.1}
    axes.legend(loc="lower right", bbox_to_anchor=(0.97, 1.01), ncols=3, **SMALL | tight)


def _times(axes, rows):
    """Draw the worst errors of predicted times."""
    walls = {"wall_time": "wall, "}
    _lines(axes, [walls.get(row["quantity"], "") + row["case"] for row in rows])
    for i, row in enumerate(rows):
        look = SERIES[0] if row["quantity"] == "contact_time" else SERIES[1]
        axes.plot(row["value"], i, **panels.open_symbol(*look))
    axes.set(xscale="log", xlim=(0.1, 20))
    axes.set_xlabel(r"error / ($2^{-52}\times$ conditioning)", x=1, ha="right")
    axes.xaxis.set_minor_formatter(NullFormatter())
    for row in rows[:1]:
        axes.axvline(row["high"], **BOUND)


# Reversal and coverage ----------------------------------------------------------------------------


def _reversal(axes, rows):
    """Draw the error of return over what the exponent says it should be."""
    looks = (*SERIES, (ORANGE, "o"))
    radii = sorted({row["radius"] for row in _select(rows, quantity="return_error")})
    bits = np.array([0.0, 36.0])
    axes.plot(bits, 2.0 ** (bits - 53), color=BLACK, lw=0.7, zorder=1)
    for look, radius in zip(looks, radii, strict=False):
        here = _select(rows, radius=radius)
        rate = _select(here, quantity="exponent", case="separation")[0]["value"]
        number = _select(here, quantity="events_retraced")[0]
        shown = _select(here, quantity="return_error")
        x = [rate * row["count"] / math.log(2) for row in shown]
        y = [row["value"] for row in shown]
        name = f"$r={panels.number(radius)}$: {number['value']:.0f} events ({number['exact']:.0f})"
        axes.plot(x, y, ls="", label=name, zorder=2, **panels.open_symbol(*look, 0.9))
    axes.axhline(2.0**-26, **BOUND)
    axes.set(yscale="log", xlim=(0, 36), ylim=(1e-16, 1e-4))
    axes.yaxis.set_major_locator(LogLocator(numticks=6))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.set_xlabel(r"binary digits lost to $n$ events, $n\lambda/\ln 2$")
    axes.set_ylabel("error of return")
    if radii:
        axes.legend(loc="lower right", **SMALL | {"handletextpad": 0.1})


def _coverage(axes, rows):
    """Draw the coverage of the intervals, radius by radius and event by event."""
    radii = sorted({row["radius"] for row in rows})
    for i, (event, look) in enumerate(LOOKS.items()):
        beside = (i - (len(LOOKS) - 1) / 2) * 0.12
        placed = [(radii.index(r["radius"]) + beside, r) for r in _select(rows, quantity=event)]
        shown = [(x, r["value"], r["stderr"]) for x, r in placed if r["value"] is not None]
        x, y, error = zip(*shown, strict=True) if shown else ([], [], [])
        symbol = panels.open_symbol(*look)
        axes.errorbar(x, y, error, ls="", elinewidth=0.6, label=name_of(event), **symbol)
        few = [x for x, row in placed if row["value"] is None]
        axes.plot(few, [0.905] * len(few), "x", color=look[0])
    for row in [row for row in rows if row["low"] is not None][:1]:
        axes.axhline(row["low"], **BOUND)
        axes.axhline(row["high"], **BOUND)
    axes.axhline(0.95, color=GREY, lw=0.5, zorder=0)
    axes.set(
        xlim=(-0.5, max(len(radii), 1) - 0.5), ylim=(0.9, 1.0), ylabel="coverage of 95 % intervals"
    )
    axes.xaxis.set_major_locator(FixedLocator(range(len(radii))))
    axes.set_xticklabels([f"$r={panels.number(radius)}$" for radius in radii])
    axes.tick_params(axis="x", length=0)
    axes.legend(loc="upper center", ncols=3, columnspacing=1.0, **SMALL)
