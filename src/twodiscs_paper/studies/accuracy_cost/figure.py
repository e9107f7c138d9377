"""What a digit costs: error against processor time, for every method."""

import math

import numpy as np
from matplotlib.ticker import FixedLocator, LogLocator, NullFormatter, NullLocator

from twodiscs.figures.kit import drawing
from twodiscs.figures.kit.panels import add_panel, name_box
from twodiscs.figures.kit.style import (
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
from twodiscs.model.box import Box

#: Inches: width of two columns, the height, margins and the gaps between the panels.
WIDTH, HEIGHT = 7.0, 3.86
LEFT, RIGHT, BOTTOM, TOP, GAP = 0.5, 0.1, 0.36, 0.36, 0.46

#: The lower part of a panel that is split and the gap, in inches; the error there; the times.
LOWER, BREAK = 1.25, 0.05
SPLIT, TIMES = 3e-5, (1.5e-7, 2e-1)

LEGEND = {
    "fontsize": 6.5, "handlelength": 1.8, "borderaxespad": 0.3,
    "title": "method: power of the time", "title_fontsize": 6.5, "alignment": "left",
}  # fmt: skip

#: No error below this one can be told from rounding.
ROUNDING = 2.0**-53

#: Colour and marker of each method.
LOOK = {
    "rejection": (BLUE, "o"),
    "conditioned": (GREEN, "^"),
    "sobol": (ORANGE, "D"),
    "shell": (PURPLE, "o"),
    "balanced_shell": (PURPLE, "*"),
    "surface": (GREEN, "^"),
    "quadrature": (VERMILLION, "s"),
    "exact": (BLACK, "*"),
    "lockstep": (BLUE, "o"),
    "single_precision": (SKY, "D"),
    "scalar": (GREEN, "^"),
    "time_step": (VERMILLION, "s"),
}

#: The error at which time steps and events are compared, and the line of an error that stays.
LEVEL = 1e-3
DOTTED = (0, (1, 1.5))

#: Shades of one colour for several settings, the coarsest first.
SHADES = (1.0, 0.75, 0.55, 0.4, 0.3)


def draw(box=None, *, tables):
    """Draw the rows of accuracy_cost.csv; ``box`` is not used, for the table has its own box."""
    rows = tables["accuracy_cost"]
    figure = new_figure(HEIGHT, WIDTH)
    for i, drawn in enumerate((_volume, _area)):
        upper = _panel(figure, i, BOTTOM + LOWER + BREAK, TOP)
        lower = _panel(figure, i, BOTTOM, HEIGHT - BOTTOM - LOWER)
        drawn((upper, lower), rows)
        _split(upper, lower)
    _times(_panel(figure, 2, BOTTOM, TOP), rows)
    figure.axes[0].set_ylabel("relative error")
    name_box(figure.axes[0], Box(rows[0]["width"], rows[0]["height"]), up=12)
    for axes in figure.axes:
        axes.xaxis.set_major_locator(LogLocator(numticks=12))
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.yaxis.set_minor_formatter(NullFormatter())
    return figure


def caption(shown):
    """Return the caption."""
    return """
    What a digit costs: true relative error against processor time on one core, root mean square
    over repeated runs; bars are its standard error, and powers in the legend are fitted. (a)
    Volume and (b) area of disc collisions by rejection sampling, by the conditioned sampler, by
    scrambled Sobol points, by shells of thickness ε, whose bias (dotted) no work removes, and of
    the ε at which bias and noise balance, by samples on the surface itself, by Gauss quadrature
    along the arc (numbers of nodes beside) and by exact evaluation; below 3e-5 the scale changes.
    (c) Mean time between vertical hops by event-driven dynamics, one trajectory at a time, many in
    lock step, and these in single precision; and by looking for overlaps every Δt, which leaves an
    error ∝ Δt (dotted). The dashed line is the least error that time steps reach, whatever Δt; the
    arrow says how much sooner lock step knows the mean to 1e-3.
    """


def _panel(figure, i, bottom, top):
    """Return new logarithmic axes in column ``i``, with room ``bottom`` and ``top`` in inches."""
    width = (WIDTH - LEFT - RIGHT - 2 * GAP) / 3
    left = LEFT + i * (width + GAP)
    axes = add_panel(figure, bottom, HEIGHT - bottom - top, left, width)
    axes.set(xscale="log", yscale="log", xlabel="processor time (s)")
    if top == TOP:
        drawing.label(axes, f"({'abc'[i]})", (0, 1), (-24, 7), xycoords="axes fraction", ha="left")
    return axes


def _split(upper, lower):
    """Make two panels one, whose lower part has more decades to the inch."""
    upper.set(xlim=TIMES, ylim=(SPLIT, 1), xlabel="")
    lower.set(xlim=TIMES, ylim=(2e-17, SPLIT))
    upper.spines.bottom.set_visible(False)
    lower.spines.top.set_visible(False)
    upper.tick_params(labelbottom=False, bottom=False, which="both")
    lower.tick_params(top=False, which="both")
    upper.yaxis.set_major_locator(LogLocator(numticks=6))
    lower.yaxis.set_major_locator(FixedLocator([1e-16, 1e-13, 1e-10, 1e-7]))
    lower.yaxis.set_minor_locator(NullLocator())
    lower.legend(loc="lower right", bbox_to_anchor=(1, 0.1), **LEGEND)


def _of(rows, part, method, **where):
    """Return {setting: rows} of a method, settings from the largest down."""
    where |= {"part": part, "method": method}
    settings = {}
    for row in rows:
        if all(row[name] == value for name, value in where.items()):
            settings.setdefault(row["setting"], []).append(row)
    return dict(sorted(settings.items(), key=lambda item: -(item[0] or 0.0)))


def _slope(row):
    """Return the fitted slope of a row as text, its error in units of the last digit."""
    if row["slope_stderr"] is None:
        return ""
    return f"${row['slope']:.2f}({max(1, round(100 * row['slope_stderr']))})$"


def _points(axes, rows, method, label=None, shade=1.0, style="-", full=False):
    """Draw the errors of one method: root mean square, with bars for the spread between runs."""
    colour, marker = LOOK[method]
    x = np.array([row["seconds"] for row in rows])
    y = np.maximum([row["error"] for row in rows], ROUNDING)
    filled = full or marker == "*"
    axes.plot(
        x, y, marker=marker, ms=6 if marker == "*" else SIZES[marker],
        ls=style if len(rows) > 1 else "", lw=0.7, color=colour, alpha=shade, label=label,
        mfc=colour if filled else "white", mew=0.0 if marker == "*" else 0.6,
    )  # fmt: skip
    if rows[0]["repetitions"] and len(rows) > 1 and method != "quadrature":
        # The mean over R runs is known √R times better than one of them.
        bars = [row["spread"] / math.sqrt(row["repetitions"]) for row in rows]
        axes.errorbar(x, y, np.minimum(bars, 0.9 * y), ls="", color=colour, alpha=shade, lw=0.6)


def _rest(panels, rows, part):
    """Draw quadrature with its numbers of nodes, and the exact evaluation."""
    (nodes,) = _of(rows, part, "quadrature").values()
    (exact,) = _of(rows, part, "exact").values()
    colour, digits = LOOK["quadrature"][0], abs(nodes[0]["slope"])
    for axes, (high, low) in zip(panels, ((1, SPLIT), (SPLIT, 0)), strict=True):
        _points(axes, nodes, "quadrature", f"quadrature, {digits:.1f} digits/node")
        _points(axes, exact, "exact", "exact evaluation")
        for row in nodes:
            if row["work"] in (2, 4, 6, 8) and low < max(row["error"], ROUNDING) < high:
                at = row["seconds"], max(row["error"], ROUNDING)
                drawing.label(axes, f"{row['work']}", at, (-6, 0), color=colour, fontsize=6.5)


def _volume(panels, rows):
    radii = sorted({row["radius"] for row in rows if row["part"] == "volume"})
    for radius, style, full in zip(radii, ("-", (0, (4, 2))), (False, True), strict=False):
        for method in ("rejection", "conditioned"):
            (series,) = _of(rows, "volume", method, radius=radius).values()
            label = f"{method}, $r={radius:g}$: {_slope(series[0])}"
            for axes in panels:
                _points(axes, series, method, label, style=style, full=full)
    (series,) = _of(rows, "volume", "sobol").values()
    for axes in panels:
        _points(axes, series, "sobol", f"Sobol points: {_slope(series[0])}")
    _rest(panels, rows, "volume")
    _title(panels[0], f"volume, $r={radii[0]:g}$")


def _area(panels, rows):
    shells = _of(rows, "area", "shell")
    (nodes,) = _of(rows, "area", "quadrature").values()
    beside = 1.3 * max(row["seconds"] for row in nodes if row["error"] > SPLIT)
    for i, (shade, (thickness, series)) in enumerate(zip(SHADES, shells.items(), strict=False)):
        for axes in panels:
            _points(axes, series, "shell", None if i else "shells", shade)
            axes.axhline(series[0]["floor"], color=PURPLE, lw=0.5, ls=DOTTED, alpha=shade)
        text = rf"$\varepsilon={thickness:.2g}$"
        style = {"ha": "left", "va": "bottom", "fontsize": 6.5, "color": PURPLE}
        drawing.label(panels[0], text, (beside, series[0]["floor"]), (0, 0.5), **style)
    best = [row for series in _of(rows, "area", "balanced_shell").values() for row in series]
    names = {"surface": "on the surface", "sobol": "same, Sobol"}
    for axes in panels:
        _points(axes, best, "balanced_shell", rf"best $\varepsilon$: {_slope(best[0])}")
        for method, name in names.items():
            (series,) = _of(rows, "area", method).values()
            _points(axes, series, method, f"{name}: {_slope(series[0])}")
    _rest(panels, rows, "area")
    _title(panels[0], f"area of collisions, $r={best[0]['radius']:g}$")


def _times(axes, rows):
    quantity = "vertical_hop_time"
    names = {
        "scalar": "events, one by one",
        "lockstep": "events, in lock step",
        "single_precision": "in single precision",
    }
    for method, name in names.items():
        (series,) = _of(rows, "time", method, quantity=quantity).values()
        _points(axes, series, method, f"{name}: {_slope(series[0])}")
    for shade, (step, series) in zip(
        SHADES, _of(rows, "time", "time_step", quantity=quantity).items(), strict=False
    ):
        label = r"time steps $\Delta t$" if shade == SHADES[0] else None
        _points(axes, series, "time_step", label, shade)
        if series[0]["floor"]:
            axes.axhline(series[0]["floor"], color=VERMILLION, lw=0.5, ls=DOTTED, alpha=shade)
        at = series[-1]["seconds"], series[-1]["error"]
        text = rf"$\Delta t=2^{{{round(math.log2(step))}}}$"
        style = {"ha": "left", "va": "bottom", "fontsize": 6.5, "color": VERMILLION}
        drawing.label(axes, text, at, (5, 1), **style)
    _gain(axes, rows, quantity)
    axes.set(xlim=(4e-4, 200), ylim=(2e-5, 0.5))
    axes.legend(loc="lower left", **LEGEND)
    _title(axes, f"mean time of vertical hops, $r={series[0]['radius']:g}$")


def _gain(axes, rows, quantity):
    """Draw the least error of time steps at any Δt, and how far from it the lock step is."""
    step, (floor,) = next(iter(_of(rows, "floor", "time_step", quantity=quantity).items()))
    bias = floor["error"] / step
    # The noise of a run falls like the root of the time simulated, ∝ seconds × Δt.
    series = _of(rows, "time", "time_step", quantity=quantity).values()
    runs = [row for part in series for row in part]
    noise = [
        (row["error"] ** 2 - row["bias"] ** 2) * row["seconds"] * row["setting"] for row in runs
    ]
    noise = np.median(noise)
    seconds = np.geomspace(1e-3, 1e3)
    # At a given time, (bias Δt)² + noise/(seconds Δt) is least for this Δt.
    best = (noise / (2 * bias**2 * seconds)) ** (1 / 3)
    error = np.sqrt((bias * best) ** 2 + noise / (seconds * best))
    axes.plot(seconds, error, color=GREY, lw=0.8, ls=(0, (4, 2)), label=r"best $\Delta t$: $-1/3$")

    (engine,) = _of(rows, "time", "lockstep", quantity=quantity).values()
    price = np.median([row["error"] ** 2 * row["seconds"] for row in engine])
    start, end = price / LEVEL**2, np.interp(-LEVEL, -error, seconds)
    drawing.arrow(axes, (start, LEVEL), (end, LEVEL), "<|-|>", width=0.6, size=6)
    middle = math.sqrt(start * end), LEVEL
    times = float(f"{end / start:.2g}")
    drawing.label(axes, rf"$\times{times:g}$", middle, (0, 5), fontsize=7.5)


def _title(axes, text):
    drawing.label(axes, text, (0.5, 1), (0, 6), xycoords="axes fraction")
