"""Power laws of mean times below the radii at which their events die out."""

import numpy as np

from twodiscs.figures import drawing, panels
from twodiscs.figures.radius import NEAREST_END
from twodiscs.figures.style import BLACK, EVENT_LOOKS, GREY, event_name
from twodiscs.model.events import HOPS, SHELL_EVENTS
from twodiscs.theory.exact import mean_times
from twodiscs_paper.studies.estimates import columns
from twodiscs_paper.studies.thresholds.measure import leading_law, near, passages, start
from twodiscs_paper.study import select

#: The number of points on a curve.
CURVE_POINTS = 80


def draw(box, tables):
    """Draw mean_times.csv, if given, and the first passages of distributions.csv."""
    figure, (hops, ratios) = panels.stacked(hops=2.3, ratios=2.0)
    for event, (colour, marker) in EVENT_LOOKS.items():
        law = leading_law(box, event) if event in SHELL_EVENTS else None
        if law is None:
            continue
        rows = near(box, law, select(_mean_times(tables), event=event))
        end = 1 - start(box, law) / law.limit
        distances = np.geomspace(NEAREST_END, 0.999 * end, CURVE_POINTS)
        radii = law.limit * (1 - distances)
        exact = np.array([mean_times(box.scene(r))[event] for r in radii])
        style = panels.open_symbol(colour, marker)
        name = event_name(event)
        _points(ratios, law, rows, name, style, law)
        ratios.plot(distances, exact / law(radii), color=colour, zorder=2)
        if event in HOPS and law.power < 0:
            _points(hops, law, rows, name, style)
            hops.plot(distances, exact, color=colour, zorder=2)
            hops.plot(distances, law(radii), color=colour, lw=0.7, ls=(0, (4, 2)))
            first = next((row["scene"] for row in tables["distributions"]), None)
            rows_near = near(box, law, passages(tables["distributions"], first, event))
            _points(hops, law, rows_near, None, {"color": colour, "marker": "x", "markersize": 3})
    full = {"ls": "", "marker": "o", "markersize": 3.7}
    hops.plot([], [], "x", color=BLACK, markersize=3, label="first passages")
    hops.plot([], [], color=BLACK, label="exact")
    hops.plot([], [], color=BLACK, lw=0.7, ls=(0, (4, 2)), label="limiting law")
    for axes in (hops, ratios):
        axes.plot([], [], color=BLACK, label="from strips", **full)
    _slopes(hops)
    ratios.axhline(1, color=BLACK, lw=0.7, ls=(0, (4, 2)))
    for axes in (hops, ratios):
        axes.set(xscale="log", yscale="log", xlim=(NEAREST_END, 0.25))
    ratios.set(ylim=(0.7, 5))
    ratios.set_yticks([1, 2, 5], ["1", "2", "5"])
    ratios.yaxis.set_minor_formatter("")
    hops.set_ylabel("time between hops (length/speed)")
    ratios.set_ylabel(r"time / limiting law $\tau_0\,\delta^\gamma$")
    for axes in (hops, ratios):
        axes.set_xlabel(r"distance from the limit $\delta/r_{\rm c}$")
    hops.legend(loc="upper right", ncols=2)
    ratios.legend(loc="upper left")
    panels.title(hops, "a", box)
    return figure


def _mean_times(tables):
    """Return the rows of the mean_times.csv among ``tables``, or none without one."""
    measured = [rows for name, rows in tables.items() if name.endswith("mean_times")]
    return measured[0] if measured else []


def _points(axes, law, rows, name, style, unit=np.ones_like):
    """Draw measured times over ``unit`` of the radius; times from a strip have full symbols."""
    for group, look in panels.split_by_start(rows, style):
        radius, value, error = columns(group, "radius", "estimate", "stderr")
        scale = unit(radius)
        axes.errorbar(
            1 - radius / law.limit, value / scale, error / scale, ls="", elinewidth=0.6,
            label=name if look is style else None, zorder=3, **look,
        )  # fmt: skip


def _slopes(axes):
    """Draw the two powers that the figure compares."""
    x = np.array([4e-5, 1e-3])
    for power, name, up in ((-2, r"$\delta^{-2}$", -3), (-1.5, r"$\delta^{-3/2}$", 3)):
        y = 10 * (x / x[0]) ** power
        axes.plot(x, y, color=GREY, lw=0.8)
        drawing.label(axes, name, (x[1], y[1]), (3, up), ha="left", va="center", color=GREY)
