"""The cost of a digit: error against processor time, for every method."""

import math

import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter, NullLocator

from twodiscs.figures import drawing
from twodiscs.figures.panels import add_panel, title
from twodiscs.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    SIZES,
    VERMILLION,
    new_figure,
)
from twodiscs.model.box import Box

#: Inches: width of two columns, the height of a panel, margins and gaps.
WIDTH, HEIGHT = 7.0, 1.6
LEFT, RIGHT, BOTTOM, TOP, ACROSS, BETWEEN = 0.5, 0.1, 0.36, 0.36, 0.55, 0.58

LEGEND = {"fontsize": 6.8, "handlelength": 1.8, "borderaxespad": 0.3, "labelspacing": 0.2}

#: Smaller errors cannot be distinguished from rounding.
ROUNDING = 2.0**-53

#: Colour and marker of each method.
LOOK = {
    "rejection": (BLUE, "o"),
    "conditioned": (GREEN, "^"),
    "sobol": (ORANGE, "D"),
    "balanced_shell": (BLACK, "*"),
    "surface": (GREEN, "^"),
    "lockstep": (BLUE, "o"),
    "scalar": (GREEN, "^"),
    "time_step": (VERMILLION, "s"),
}

#: The error at which time steps and events are compared, and the line of an error that stays.
LEVEL = 1e-3
DOTTED = (0, (1, 1.5))

#: Colour and marker of shells of each thickness, the thickest first.
SHELLS = (("#3B0F4F", "o"), ("#7A2A7F", "s"), ("#B04F9E", "^"), (PURPLE, "v"))


def draw(box, tables):
    """Draw the rows of accuracy_cost.csv; ``box`` is not used, because the table has its own."""
    rows = tables["accuracy_cost"]
    figure = new_figure(BOTTOM + 2 * HEIGHT + BETWEEN + TOP, WIDTH)
    for i, draw_panel in enumerate((_volume, _area, _times, _quadrature)):
        width = (WIDTH - LEFT - RIGHT - ACROSS) / 2
        left, bottom = LEFT + i % 2 * (width + ACROSS), BOTTOM + (1 - i // 2) * (HEIGHT + BETWEEN)
        axes = add_panel(figure, bottom, HEIGHT, left, width, draw_panel.__name__.strip("_"))
        axes.set(yscale="log", ylabel="relative error")
        drawing.label(axes, f"({'abcd'[i]})", (0, 1), (-28, 7), xycoords="axes fraction")
        if draw_panel is not _quadrature:
            axes.set(xscale="log", xlabel="processor time (s)")
            axes.xaxis.set_major_locator(LogLocator(numticks=12))
            axes.xaxis.set_minor_formatter(NullFormatter())
        draw_panel(axes, rows)
        axes.yaxis.set_minor_formatter(NullFormatter())
    title(figure.axes[0], "", Box(rows[0]["width"], rows[0]["height"]), up=12)
    return figure


def _of(rows, part, method, **where):
    """Return {setting: rows} of a method, settings from the largest down."""
    where |= {"part": part, "method": method}
    settings = {}
    for row in rows:
        if all(row[name] == value for name, value in where.items()):
            settings.setdefault(row["setting"], []).append(row)
    return dict(sorted(settings.items(), key=lambda item: -(item[0] or 0.0)))


def _points(axes, rows, look, label=None, style="-", full=False):
    """Draw the errors of one method: root mean square, with bars for the spread between runs."""
    colour, marker = look
    x = np.array([row["seconds"] for row in rows])
    y = np.maximum([row["error"] for row in rows], ROUNDING)
    filled = full or marker == "*"
    axes.plot(
        x, y, marker=marker, ms=6 if marker == "*" else SIZES[marker],
        ls=style if len(rows) > 1 else "", lw=0.7, color=colour, label=label,
        mfc=colour if filled else "white", mew=0.0 if marker == "*" else 0.6,
    )  # fmt: skip
    if rows[0]["repetitions"] and len(rows) > 1:
        # The error of a mean over R runs is √R times smaller than the error of one run.
        bars = [row["spread"] / math.sqrt(row["repetitions"]) for row in rows]
        axes.errorbar(x, y, np.minimum(bars, 0.9 * y), ls="", color=colour, lw=0.6)


def _law(axes, rows):
    """Draw the law of independent samples, error² ∝ 1/time, through the errors of one method."""
    seconds, error = (np.array([row[name] for row in rows]) for name in ("seconds", "error"))
    law = np.exp(np.mean(np.log(error) + np.log(seconds) / 2)) / np.sqrt(seconds)
    axes.plot(
        seconds, law, color=GREY, lw=0.8, ls=(0, (4, 2)), zorder=1, label=r"$\propto t^{-1/2}$"
    )


def _floor(axes, rows, colour):
    """Draw the error that no work removes, from the first of ``rows`` to the edge of the panel."""
    if rows[0]["floor"]:
        ends = [rows[0]["seconds"], axes.get_xlim()[1]]
        axes.plot(ends, [rows[0]["floor"]] * 2, color=colour, lw=0.6, ls=DOTTED)


def _decades(axes):
    """Let the abscissa end at powers of ten, which have labels."""
    low, high = np.log10(axes.dataLim.intervalx)
    axes.set_xlim(10 ** math.floor(low), 10 ** math.ceil(high))


def _volume(axes, rows):
    radii = sorted({row["radius"] for row in rows if row["part"] == "volume"})
    for radius, style, full in zip(radii, ("-", (0, (4, 2))), (False, True), strict=False):
        for method in ("rejection", "conditioned"):
            (series,) = _of(rows, "volume", method, radius=radius).values()
            _points(axes, series, LOOK[method], f"{method}, $r={radius:g}$", style, full)
    (series,) = _of(rows, "volume", "sobol").values()
    _points(axes, series, LOOK["sobol"], f"Sobol points, $r={radii[0]:g}$")
    _law(axes, next(iter(_of(rows, "volume", "rejection", radius=radii[0]).values())))
    _decades(axes)
    axes.legend(loc="best", **LEGEND)
    _title(axes, "volume")


def _area(axes, rows):
    shells = _of(rows, "area", "shell").items()
    for look, (thickness, series) in zip(SHELLS, shells, strict=False):
        _points(axes, series, look, rf"shells, $\varepsilon={thickness:.2g}$")
    best = [row for series in _of(rows, "area", "balanced_shell").values() for row in series]
    _points(axes, best, LOOK["balanced_shell"], r"best $\varepsilon$")
    for method, name in (("surface", "on the surface"), ("sobol", "same, Sobol")):
        (series,) = _of(rows, "area", method).values()
        _points(axes, series, LOOK[method], name)
    (series,) = _of(rows, "area", "surface").values()
    _law(axes, series)
    _decades(axes)
    for look, (_, series) in zip(SHELLS, shells, strict=False):
        _floor(axes, series, look[0])
    axes.legend(loc="lower left", **LEGEND)
    _title(axes, f"area of collisions, $r={best[0]['radius']:g}$")


def _quadrature(axes, rows):
    """Draw the errors of quadrature over the number of its nodes, and of the exact evaluation."""
    parts = (("volume", "volume", BLUE, "o"), ("area", "area", VERMILLION, "s"))
    for i, (part, name, colour, marker) in enumerate(parts):
        (nodes,) = _of(rows, part, "quadrature").values()
        (exact,) = _of(rows, part, "exact").values()
        error = np.maximum([row["error"] for row in nodes], ROUNDING)
        micro = 1e6 * np.median([row["seconds"] for row in nodes])
        axes.plot(
            [row["work"] for row in nodes], error, marker=marker, ms=SIZES[marker], mfc="white",
            color=colour, lw=0.7, label=rf"{name}, quadrature: ${micro:.1f}\,\mu$s",
        )  # fmt: skip
        micro = 1e6 * exact[0]["seconds"]
        axes.axhline(
            max(exact[0]["error"], ROUNDING), color=colour, lw=0.8, ls=(5 * i, (4, 6)),
            label=rf"{name}, exact evaluation: ${micro:.0f}\,\mu$s",
        )  # fmt: skip
    axes.set(xlabel="number of nodes", ylim=(2e-17, 1))
    axes.yaxis.set_major_locator(LogLocator(numticks=6))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.legend(loc="upper right", **LEGEND)
    _title(axes, f"quadrature, $r={nodes[0]['radius']:g}$")


def _times(axes, rows):
    quantity = "vertical_hop_time"
    names = {
        "scalar": "events, one by one",
        "lockstep": "events, in lock step",
    }
    for method, name in names.items():
        (series,) = _of(rows, "time", method, quantity=quantity).values()
        _points(axes, series, LOOK[method], name)
    steps = _of(rows, "time", "time_step", quantity=quantity).items()
    for i, (step, series) in enumerate(steps):
        _points(axes, series, LOOK["time_step"], None if i else r"time steps $\Delta t$")
        at = series[-1]["seconds"], series[-1]["error"]
        text = rf"$\Delta t=2^{{{round(math.log2(step))}}}$"
        style = {"ha": "left", "va": "bottom", "fontsize": 6.8, "color": VERMILLION}
        drawing.label(axes, text, at, (5, 1), **style)
    _gain(axes, rows, quantity)
    (series,) = _of(rows, "time", "lockstep", quantity=quantity).values()
    _law(axes, series)
    _decades(axes)
    for series in _of(rows, "time", "time_step", quantity=quantity).values():
        _floor(axes, series, VERMILLION)
    low, high = axes.get_ylim()
    axes.set_ylim(low / 60, 2 * high)
    axes.legend(loc="lower left", **LEGEND)
    _title(axes, f"mean time of vertical hops, $r={series[0]['radius']:g}$")


def _gain(axes, rows, quantity):
    """Draw the least error of time steps at any Δt, and the factor that lock step gains."""
    step, (floor,) = next(iter(_of(rows, "floor", "time_step", quantity=quantity).items()))
    bias = floor["error"] / step
    # The noise of a run falls like the root of the time simulated, ∝ seconds × Δt.
    series = _of(rows, "time", "time_step", quantity=quantity).values()
    runs = [row for part in series for row in part]
    noise = [
        (row["error"] ** 2 - row["bias"] ** 2) * row["seconds"] * row["setting"] for row in runs
    ]
    noise = np.median(noise)
    # At a given time, (bias Δt)² + noise/(seconds Δt) is least, 3 (bias Δt)², for one Δt.
    best = LEVEL / (math.sqrt(3) * bias)
    end = noise / (2 * bias**2 * best**3)
    (engine,) = _of(rows, "time", "lockstep", quantity=quantity).values()
    start = np.median([row["error"] ** 2 * row["seconds"] for row in engine]) / LEVEL**2
    seconds = np.array([min(row["seconds"] for row in runs), 3 * end])
    style = {"color": GREY, "lw": 0.8, "ls": (0, (6, 1.5, 1, 1.5))}
    error = LEVEL * (end / seconds) ** (1 / 3)
    axes.plot(seconds, error, label=r"best $\Delta t$, $\propto t^{-1/3}$", **style)
    drawing.arrow(axes, (start, LEVEL), (end, LEVEL), "<|-|>", width=0.6, size=6)
    middle = math.sqrt(start * end), LEVEL
    times = float(f"{end / start:.2g}")
    drawing.label(axes, rf"$\times{times:g}$", middle, (0, 5), fontsize=7.5)


def _title(axes, text):
    drawing.label(axes, text, (0.5, 1), (0, 6), xycoords="axes fraction")
