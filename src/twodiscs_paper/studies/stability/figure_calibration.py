"""Mean squares of scores over seeds: what error bars say, counted, call by call."""

import math

from matplotlib.ticker import NullFormatter

from twodiscs.figures import panels
from twodiscs.figures.style import BLUE, COLUMN, GREEN, GREY, VERMILLION, new_figure
from twodiscs_paper.studies.stability.calibration import SCENES

#: {what scenes have in common: colour and marker}.
LOOKS = {"plain discs": (BLUE, "o"), "effects": (VERMILLION, "s"), "more discs": (GREEN, "^")}

#: The mean squares shown, and the standard deviations of a mean square that the band allows.
SHOWN, BAND = (0.2, 5.0), 5

#: {row of the figure: (call, part of the name of its quantities)}, from the top.
ESTIMATORS = {
    "mean times of hops": ("simulate", "hop_time"),
    "mean times of collisions": ("simulate", "collision_time"),
    "mean times of walls": ("simulate", "wall_time"),
    "ratios of mean times": ("simulate", "ratio"),
    "pressures": ("simulate", "pressure"),
    "volume": ("sample", "volume"),
    "areas": ("sample", "area"),
    "free energy": ("sample", "free_energy"),
    "mean intervals": ("intervals", "mean"),
    "bins of intervals": ("intervals", "bin"),
    "transmission, clusters": ("transmission", "coefficient"),
    r"transmission, $\kappa(t)$": ("transmission", "κ"),
    "observed averages": ("observe", "average"),
    "diffusion": ("diffusion", "average"),
}


def common(case):
    """Return the key of ``LOOKS`` of a scene, by its name."""
    names = SCENES[case].keys() - {"width", "height", "radius"}
    return "more discs" if "discs" in names else "effects" if names else "plain discs"


def draw(box, tables):
    """Draw the rows of calibration.csv; its scenes have boxes of their own, not the ``box``.

    Long calls, with few seeds, are left out.
    """
    rows = [r for r in tables["calibration"] if r["scores"] > 1 and r["size"] != "long"]
    figure = new_figure(0.3 * len(ESTIMATORS) + 0.9, COLUMN, layout="constrained")
    axes = figure.subplots()
    axes.set_label("calibration")
    for level, (call, part) in enumerate(ESTIMATORS.values()):
        own = [r for r in rows if r["call"] == call and part in r["quantity"]]
        fewest = min((r["scores"] for r in own), default=2)
        half = BAND * math.sqrt(2 / fewest)
        low, high = max(1 - half, SHOWN[0]), 1 + half
        axes.fill_betweenx((level - 0.42, level + 0.42), low, high, color="#EEEEEE", lw=0)
        for k, (name, (colour, marker)) in enumerate(LOOKS.items()):
            for least in (True, False):
                here = [
                    row["mean_square"]
                    for row in own
                    if common(row["case"]) == name and (row["size"] == "least") is least
                ]
                style = panels.open_symbol(colour, marker, 0.8)
                if not least:
                    style["markerfacecolor"] = colour
                axes.plot(here, [level + 0.2 * (k - 1)] * len(here), ls="", alpha=0.7, **style)
    axes.axvline(1, color=GREY, lw=0.7, zorder=0)
    axes.set(xscale="log", xlim=SHOWN, ylim=(len(ESTIMATORS) - 0.5, -0.5))
    axes.set_xticks([0.25, 0.5, 1, 2, 4], ["1/4", "1/2", "1", "2", "4"])
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_yticks(range(len(ESTIMATORS)), [*ESTIMATORS])
    axes.tick_params(axis="y", length=0)
    axes.set_xlabel("mean square of scores over seeds")
    for name, (colour, marker) in LOOKS.items():
        axes.plot([], [], ls="", label=name, **panels.open_symbol(colour, marker, 0.8))
    axes.legend(loc="lower right", ncols=3, bbox_to_anchor=(1, 1.0), borderaxespad=0.2)
    return figure
