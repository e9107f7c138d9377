"""The distribution of the times between hops."""

from itertools import groupby, takewhile

import numpy as np

from twodiscs.figures.kit import panels
from twodiscs.figures.kit.looks import name_of
from twodiscs.figures.kit.style import BLACK, SERIES, new_figure
from twodiscs.model.events import AXIS
from twodiscs.theory import tails

#: Inches: the panel of all intervals, and the panel of short ones.
ALL, SHORT = 2.4, 1.7

#: The longest of the short intervals, in mean times.
LONGEST_SHORT = 2.5

#: The curve ends before a bin with fewer intervals than this.
FEWEST = 10

#: The number of bins that can show a density that changes with the room at a hop.
FINE = 4

#: Length of the dashes that mark exact densities at 0, in mean times, to either side of the axis.
DASH = 0.035

#: The distance between symbols in either panel, in mean times.
APART, APART_SHORT = 1.2, 0.4


def draw(box, rows):
    """Draw the densities of hop_histogram.csv, in units of the mean interval (``unit_of``)."""
    figure = new_figure(ALL + SHORT, layout="constrained")
    whole, short = figure.subplots(2, height_ratios=[ALL, SHORT])
    groups = [list(group) for _, group in groupby(rows, key=lambda row: row["radius"])]
    radii = panels.numbers([group[0]["radius"] for group in groups])
    low, last = 0.1, 1.0
    for i, group in enumerate(groups):
        colour, marker = SERIES[i % len(SERIES)]
        for axes, bins, fewest, apart in (
            (whole, "wide", FEWEST, APART),
            (short, "equal", 1, APART_SHORT),
        ):
            edges, density, errors = curve([r for r in group if r["bins"] == bins], fewest)
            middles = (edges[1:] + edges[:-1]) / 2
            wanted = apart * np.arange(0.4 + i / len(groups), middles[-1] / apart)
            at = np.unique(np.searchsorted(middles, wanted))
            axes.stairs(density, edges, baseline=None, color=colour, lw=0.7)
            symbol = panels.open_symbol(colour, marker)
            axes.errorbar(
                middles[at], density[at], errors[at], ls="", label=f"$r={radii[i]}$", **symbol
            )
            if axes is whole:
                low, last = min(low, density.min()), max(last, edges[-1])
        if box.is_plain:
            _mark_zero(short, box, group[0], colour)
    for axes, end in ((whole, last), (short, LONGEST_SHORT)):
        times = np.linspace(0, end, 60)
        axes.plot(times, np.exp(-times), color=BLACK, ls=(0, (4, 2)), label=r"$e^{-t/\tau}$")
        axes.set(xlim=(0, end), xlabel=r"interval $t/\tau$", ylabel=r"density $\tau\,p(t)$")
    whole.set(yscale="log", ylim=(low / 3, None))
    short.set_ylim(0, None)
    whole.legend(loc="upper right")
    panels.title(whole, "a", box, f",  {name_of(rows[0]['event'])}")
    panels.title(short, "b")
    return figure


def _mark_zero(axes, box, row, colour):
    """Mark the exact density at 0 if bins are fine enough to show it."""
    scene, hop = box.scene(row["radius"]), row["event"]
    free, across = (scene.width, scene.height)[:: 1 if AXIS[hop] == "y" else -1]
    sigma = scene.contact_distance
    if (row["right"] - row["left"]) * FINE <= min(across - sigma, free - 2 * sigma):
        value = row["exact_mean"] * tails.density_at_zero(scene, hop)
        axes.plot([-DASH, DASH], [value, value], color=colour, lw=1.8, clip_on=False, zorder=5)


def unit_of(row):
    """Return the exact mean interval of a row or, if that is not known, the measured one."""
    return row["exact_mean"] or row["mean"]


def curve(rows, fewest):
    """Return (edges, density, standard error) in units of the mean interval (``unit_of``).

    ``rows`` are successive bins of one radius. The first bin with fewer than ``fewest`` intervals
    and all later ones are left out.
    """
    shown = list(takewhile(lambda row: row["count"] >= fewest, rows))
    mean = unit_of(rows[0])
    edges = [rows[0]["left"], *(row["right"] for row in shown)]
    values = ([row[name] * mean for row in shown] for name in ("density", "stderr"))
    return np.array(edges) / mean, *map(np.array, values)
