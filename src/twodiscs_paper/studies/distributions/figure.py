"""How the rate of hops depends on the time since the last one, and first passages."""

import numpy as np

from twodiscs.figures import panels
from twodiscs.figures.style import BLACK, GREY, SERIES, event_name
from twodiscs.model.events import HOPS
from twodiscs.model.scene import Box
from twodiscs.theory import laws
from twodiscs_paper.studies.estimates import columns
from twodiscs_paper.study import select

#: The longest time shown, in mean times, and the largest relative error of a rate.
LONGEST_INTERVAL, LARGEST_ERROR = 12, 0.15

#: Ends of the dashes that mark exact densities at 0, in mean times.
DASH = 0.0, 0.3

#: Hazards whose χ² or trend has a smaller p than this are not constant.
SMALLEST_P = 1e-3

#: The line of a fitted rate, {whether the hazards are constant: style}.
FIT_DASHES = {True: "-", False: (0, (1, 1))}


def draw(box, tables):
    """Draw the rows of distributions.csv on its first scene; without rows only name ``box``."""
    rows = tables["distributions"]
    rows = [row for row in rows if row["scene"] == rows[0]["scene"]]
    figure, (rates, passages) = panels.stacked(rates=2.4, passages=1.7)
    if not rows:
        panels.title(rates, "", box, ": hops are too rare to record intervals")
        for axes in (rates, passages):
            axes.set_axis_off()
        return figure
    _rates(rates, rows)
    _passages(passages, rows)
    first = rows[0]
    box = Box(first["width"], first["height"])
    panels.title(rates, "a", box, f",  {event_name(first['event'])}")
    return figure


def _rates(axes, rows):
    """Draw the hazard rates of the first radii, with the fitted rates and the limiting laws."""
    event = rows[0]["event"]
    box = Box(rows[0]["width"], rows[0]["height"])
    limit = box.threshold(event)
    radii = list(dict.fromkeys(row["radius"] for row in rows if row["event"] == event))
    # Rates are shown for radii below this fraction of the radius at which the hop becomes blocked.
    radii = [radius for radius in radii if radius < 0.83 * limit]
    kinds = set()
    for radius, (colour, marker) in zip(radii, SERIES, strict=False):
        own = select(rows, event=event, radius=radius)
        mean = own[0]["exact_mean"]
        hazards = select(own, quantity="hazard")
        hazards = [one for one in hazards if one["stderr"] < LARGEST_ERROR * one["estimate"]]
        if not hazards:
            continue
        first, last, value, error = columns(hazards, "first", "last", "estimate", "stderr")
        middle, value, error = (first + last) / 2 / mean, value * mean, error * mean
        style = panels.open_symbol(colour, marker, 0.8) | {"lw": 0.4, "elinewidth": 0.6}
        name = f"$r={panels.mathtext(radius)}$"
        axes.errorbar(middle, value, error, ls="-", label=name, **style)
        tests = [row for row in own if row["quantity"] in ("rate", "trend")]
        constant = all(row["p"] > SMALLEST_P for row in tests)
        for row in tests[:1]:
            ends = row["first"] / mean, min(row["last"] / mean, LONGEST_INTERVAL)
            fit = {"ls": FIT_DASHES[constant], "zorder": 2}
            kinds.add(constant)
            axes.plot(ends, [row["estimate"] * mean] * 2, color=colour, lw=1.4, **fit)
        zero = mean * laws.density_at_zero(box.scene(radius), event)
        axes.plot(DASH, [zero] * 2, color=colour, lw=1.8, clip_on=False, zorder=5)
    axes.axhline(1, color=BLACK, lw=0.7, ls=(0, (4, 2)), label="exponential")
    for constant in sorted(kinds, reverse=True):
        name = "constant rate" if constant else "constant rate, rejected"
        axes.plot([], [], color=GREY, lw=1.4, ls=FIT_DASHES[constant], label=name)
    late = np.linspace(6, LONGEST_INTERVAL, 40)
    axes.plot(late, 3 / late, color=GREY, lw=0.9, ls=(0, (6, 1.5, 1, 1.5)), label=r"$3\tau/t$")
    axes.set(xlim=(0, LONGEST_INTERVAL), ylim=(0, None), xlabel=r"time since the last hop $t/\tau$")
    axes.set_ylabel(r"rate of hops $\times\,\tau$")
    axes.legend(loc="upper right")


def _passages(axes, rows):
    """Draw mean first passages, measured and from the intervals, over the mean interval."""
    for (colour, marker), hop in zip(SERIES, HOPS, strict=False):
        own = select(rows, quantity="first_passage", event=hop, last=None)
        if not own:
            continue
        names = "radius", "exact_mean", "estimate", "stderr", "reference", "reference_stderr"
        radius, mean, value, error, other, spread = columns(own, *names)
        style = panels.open_symbol(colour, marker)
        axes.errorbar(
            radius, value / mean, error / mean, ls="", label=event_name(hop), zorder=3, **style
        )
        style = panels.open_symbol(colour, marker, 0.4) | {"markerfacecolor": colour}
        axes.errorbar(radius, other / mean, spread / mean, ls="", elinewidth=0.5, zorder=4, **style)
    axes.plot(
        [], [], ls="", marker=".", color=BLACK, label=r"from intervals, $(1+\mathrm{CV}^2)/2$"
    )
    axes.axhline(1, color=BLACK, lw=0.7, ls=(0, (4, 2)))
    axes.set(xlabel="radius $r$ (length)", ylabel=r"first passage $\langle F\rangle/\tau$")
    axes.legend(loc="upper left")
