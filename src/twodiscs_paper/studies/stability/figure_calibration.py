"""Mean squares of scores over seeds: what error bars say, counted, call by call."""

import math
import re

from matplotlib.ticker import NullFormatter

from twodiscs.figures import panels
from twodiscs.figures.style import BLACK, BLUE, COLUMN_WIDTH, GREEN, GREY, VERMILLION, new_figure

#: {what scenes have in common: colour and marker}.
SCENE_LOOKS = {"plain discs": (BLUE, "o"), "effects": (VERMILLION, "s"), "more discs": (GREEN, "^")}

#: The mean squares shown, the standard deviations of a mean square that the band allows, and the
#: fewest scores of a mean square that is shown.
SQUARES_RANGE, BAND, FEWEST_SCORES = (0.2, 5.0), 5, 16

#: {line of the figure: (call or study, pattern in the name of its quantities)}, from the top.
ESTIMATORS = {
    "mean times of hops": ("simulate", "hop_time"),
    "mean times of collisions": ("simulate", "collision_time"),
    "mean times of walls": ("simulate", "wall_time"),
    "ratios of mean times": ("simulate", "ratio"),
    "pressures": ("simulate", "pressure|compressibility"),
    "volume": ("sample", "volume"),
    "areas": ("sample", "area"),
    "free energy": ("sample", "free_energy"),
    "mean intervals": ("intervals", "mean"),
    "bins of intervals": ("intervals", "bin|density"),
    "transmission, clusters": ("transmission", "coefficient"),
    r"transmission, $\kappa(t)$": ("transmission", "κ"),
    "observed averages": ("observe", "average"),
    "diffusion": ("diffusion", "average"),
    "prices": ("cost", "by"),
    "tails: $P(T>t)$, $c$, rates": ("tails", ""),
    "hazards, first passages": ("distributions", ""),
    "powers at thresholds": ("thresholds", ""),
    r"passages: $\kappa$, $D$, $c$": ("passages", "^(?!corr|displ|file|single|ord|dens|.*expon)"),
    r"passages: $\kappa(t)$": ("passages", "^corr"),
    "passages: exponents": ("passages", "exponent"),
    "files: displacements, $F$": ("passages", "^(displ|file|single|ord|dens)"),
    "Brownian discs": ("brownian", ""),
    "rates by two methods": ("more_discs", ""),
    "shares that never met": ("effects", ""),
    "Lyapunov exponents": ("stability", ""),
    "powers of time": ("accuracy_cost", ""),
}


def draw(box, tables):
    """Draw the rows of calibration.csv; its scenes have boxes of their own, not the ``box``.

    Long calls, and other quantities with fewer than ``FEWEST_SCORES`` scores, are left out.
    """
    rows = [
        r for r in tables["calibration"] if r["scores"] >= FEWEST_SCORES and r["size"] != "long"
    ]
    figure = new_figure(0.155 * len(ESTIMATORS) + 0.9, COLUMN_WIDTH, layout="constrained")
    axes = figure.subplots()
    axes.set_label("calibration")
    for level, (call, part) in enumerate(ESTIMATORS.values()):
        own = [r for r in rows if r["call"] == call and re.search(part, r["quantity"])]
        fewest = min((r["scores"] for r in own), default=2)
        half = BAND * math.sqrt(2 / fewest)
        low, high = max(1 - half, SQUARES_RANGE[0]), 1 + half
        axes.fill_betweenx((level - 0.42, level + 0.42), low, high, color="#EEEEEE", lw=0)
        for k, (name, (colour, marker)) in enumerate(SCENE_LOOKS.items()):
            for least in (True, False):
                here = [
                    row["mean_square"]
                    for row in own
                    if row["kind"] == name and (row["size"] == "least") is least
                ]
                style = panels.open_symbol(colour, marker, 0.8)
                if not least:
                    style["markerfacecolor"] = colour
                axes.plot(here, [level + 0.25 * (k - 1)] * len(here), ls="", alpha=0.7, **style)
    axes.axvline(1, color=GREY, lw=0.7, zorder=0)
    axes.set(xscale="log", xlim=SQUARES_RANGE, ylim=(len(ESTIMATORS) - 0.5, -0.5))
    axes.set_xticks([0.25, 0.5, 1, 2, 4], ["1/4", "1/2", "1", "2", "4"])
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_yticks(range(len(ESTIMATORS)), [*ESTIMATORS])
    axes.tick_params(axis="y", length=0)
    axes.set_xlabel("mean square of scores over seeds")
    for name, (colour, marker) in SCENE_LOOKS.items():
        axes.plot([], [], ls="", label=name, **panels.open_symbol(colour, marker, 0.8))
    axes.plot([], [], "o", color=BLACK, markersize=2.4, label="usual work")
    axes.legend(loc="lower right", ncols=4, bbox_to_anchor=(1, 1.0), borderaxespad=0.2)
    return figure
