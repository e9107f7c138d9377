"""How the times between hops are distributed."""

from itertools import groupby

import numpy as np

from twodiscs.figures.kit import panels
from twodiscs.figures.kit.style import BLACK, SERIES, new_figure
from twodiscs.theory import tails

#: Inches: the panel of all intervals, that of the short ones, the gap between them, the room above.
ALL, SHORT, GAP, TOP = 1.9, 1.2, 0.3, 0.22

#: The longest of the short intervals, in mean times.
LONGEST_SHORT = 2.5

#: Bins grow to this fraction of the interval; the curve ends before one that holds fewer than so
#: many.
GROWTH, FEWEST = 0.08, 10

#: Length of the dashes that mark exact densities at 0, in mean times, to either side of the axis.
DASH = 0.035

#: How far symbols stand apart in either panel, in mean times.
APART, APART_SHORT = 1.2, 0.4


def draw(box, tables):
    """Draw the densities of hop_histogram.csv, in units of the exact mean interval."""
    rows = tables["hop_histogram"]
    figure = new_figure(panels.BOTTOM + SHORT + GAP + ALL + TOP)
    whole = panels.add_panel(figure, panels.BOTTOM + SHORT + GAP, ALL)
    short = panels.add_panel(figure, panels.BOTTOM, SHORT)
    groups = [list(group) for _, group in groupby(rows, key=lambda row: row["radius"])]
    low, last = 0.1, 1.0
    for i, group in enumerate(groups):
        colour, marker = SERIES[i % len(SERIES)]
        for axes, joining, apart in (
            (whole, (GROWTH, FEWEST), APART),
            (short, (0, 1), APART_SHORT),
        ):
            edges, density, errors = _scaled(group, *joining)
            middles = (edges[1:] + edges[:-1]) / 2
            wanted = apart * np.arange(0.4 + i / len(groups), middles[-1] / apart)
            at = np.unique(np.searchsorted(middles, wanted))
            axes.stairs(density, edges, baseline=None, color=colour, lw=0.7)
            symbol = panels.open_symbol(colour, marker)
            name = f"$r={group[0]['radius']:g}$"
            axes.errorbar(middles[at], density[at], errors[at], ls="", label=name, **symbol)
            if axes is whole:
                low, last = min(low, density.min()), max(last, edges[-1])
        if not box.effects:
            first = group[0]
            here = box.scene(first["radius"])
            value = first["exact_mean"] * tails.density_at_zero(here, first["event"])
            short.plot([-DASH, DASH], [value, value], color=colour, lw=1.8, clip_on=False, zorder=5)
    for axes, end in ((whole, last), (short, LONGEST_SHORT)):
        times = np.linspace(0, end, 60)
        axes.plot(times, np.exp(-times), color=BLACK, ls=(0, (4, 2)), label=r"$e^{-t/\tau}$")
        axes.set(xlim=(0, end), ylabel=r"density $\tau\,p(t)$")
    whole.set(yscale="log", ylim=(low / 3, None))
    short.set(ylim=(0, None), xlabel=r"interval $t/\tau$")
    whole.legend(loc="upper right")
    panels.letter(whole, "a")
    panels.letter(short, "b")
    hop = rows[0]["event"].replace("_", " ")
    panels.name_box(whole, box, f",  {hop}s")
    return figure


def _scaled(rows, growth, fewest):
    """Return (edges, density, standard error) of one radius, in units of its exact mean."""
    mean = rows[0]["exact_mean"]
    edges, density, errors = joined(rows, growth, fewest)
    return edges / mean, density * mean, errors * mean


def joined(rows, growth, fewest):
    """Return (edges, density, standard error) with bins joined until as wide as ``growth`` × time.

    ``rows`` are those of one radius. The first joined bin with fewer than ``fewest`` intervals is
    left out, and all that come after it.
    """
    edges, counts, waiting = [rows[0]["left"]], [], 0
    for row in rows:
        waiting += row["count"]
        if row["right"] >= (1 + growth) * edges[-1]:
            if waiting < fewest:
                break
            edges.append(row["right"])
            counts.append(waiting)
            waiting = 0
    counts = np.array(counts, float)
    total = rows[0]["intervals"]
    share = total * np.diff(edges)
    return np.array(edges), counts / share, np.sqrt(counts * (1 - counts / total)) / share
