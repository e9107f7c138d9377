"""Quantities over the radius: estimates against exact curves, for the figures in this folder."""

from dataclasses import replace

import numpy as np
from matplotlib.lines import Line2D

from twodiscs.figures.kit import curves, panels
from twodiscs.figures.kit.captions import is_judged, is_unknown
from twodiscs.figures.kit.limits import hop_ends
from twodiscs.figures.kit.style import SERIES
from twodiscs.model.checks import InputError
from twodiscs.theory.exact import mean_times
from twodiscs.theory.laws import small_radius_time, threshold_time

#: The range of the limiting laws, over the largest radius: from r = 0 up, and from the end down.
SMALL, LAST = 0.4, 0.1

#: Inches: the height of a lower panel, and with its margins.
APPROACH, ROOM = 1.4, 1.8

#: The events of walls, and their names in a legend.
WALLS = {
    "right_wall": "disc 1, right wall",
    "top_wall": "disc 1, top wall",
    "any_wall": "any disc, any wall",
}

#: The lower panel begins this close to the end, relatively; its law is drawn from there on.
CLOSEST, LAW = 1e-5, 0.3


def over_radius(
    box,
    tables,
    names,
    label,
    loc,
    single=None,
    rooted=False,
    laws=(),
    approach=False,
    looks=None,
):
    """Draw quantities of a ``Box`` over the radius, with the rows of the only table in ``tables``.

    ``names`` maps quantities, as theory.csv names them, to their names in the legend; the ones in
    the table are drawn. ``label`` is the label of the ordinate, which is logarithmic; if
    ``rooted``, square roots are drawn instead, from zero on. ``loc`` is the place of the legend,
    and ``single`` the name of the method if there is only one series. ``laws`` are the limiting
    laws of mean times to be drawn, "small" and "last". With ``approach`` a panel beneath shows the
    times over the distance from the radius of their end, unless no exact value is known. There is a
    panel of residuals if there are any. ``looks`` maps quantities to (colour, marker). Raises
    ``InputError`` if the table has none of the quantities, and for no table or several.
    """
    if len(tables) != 1:
        named = ", ".join(tables) or "none"
        raise InputError(f"tables must be the one of {', '.join(names)}, not {named}")
    ((table, rows),) = tables.items()
    radii, by_quantity = series_of(box, rows, names, looks or {})
    if not by_quantity:
        raise InputError(f"{table}.csv has no row of {', '.join(names)}")
    if rooted:
        by_quantity = {quantity: _rooted(part) for quantity, part in by_quantity.items()}
    series = list(by_quantity.values())
    drawn = [row for part in series for row in part.rows]
    judged, approach = any(map(is_judged, drawn)), approach and not is_unknown(drawn)
    figure, main, lower = panels.panels(box, label, ROOM if approach else 0, judged)
    panels.draw_series(main, lower, radii, series, single=bool(single))
    for quantity in by_quantity:
        _laws(main, box, quantity.removesuffix("_time"), laws)
    if rooted:
        main.set_ylim(0, None)
    else:
        panels.logarithmic(main, radii, series)
    more = [(panels.LAW_NAME, panels.LAW)] if laws and box.is_plain else []
    # ``loc`` fits if all quantities are drawn.
    place = loc if len(series) == len(names) else "best"
    panels.legend(main, box, series, place, single=single, more=more)
    if approach:
        panels.letter(main, "a")
        beneath = panels.add_panel(figure, panels.BOTTOM, APPROACH, name="approach")
        _approach(beneath, box, by_quantity)
    return figure


def series_of(box, rows, names, looks):
    """Return (radii of the curves, {quantity: ``Series``}) of the quantities in ``rows``."""
    radii, exact = curves.exact_curves(box)
    found = {}
    for quantity, name in names.items():
        shown = [row for row in rows if quantity_of(row) == quantity]
        if shown:
            found[quantity] = panels.Series(name, shown, exact[quantity], looks.get(quantity))
    return radii, found


def _rooted(series):
    """Return a ``Series`` of the square roots, with their standard errors."""

    def root(row):
        if not row["estimate"]:
            return row
        value = row["estimate"] ** 0.5
        error = row["stderr"] and row["stderr"] / (2 * value)
        return row | {"estimate": value, "stderr": error}

    return replace(series, rows=[*map(root, series.rows)], exact=np.sqrt(series.exact))


def quantity_of(row):
    """Return the quantity of a row of a table, as theory.csv names it."""
    return row["quantity"] if "quantity" in row else f"{row['event']}_time"


def _laws(axes, box, event, laws):
    """Draw laws for small discs and below the largest radius, known for boxes without effects."""
    if not box.is_plain:
        return
    end = box.largest_radius
    if "small" in laws:
        radii = np.linspace(0, SMALL, 41)[1:] * end
        panels.asymptote(axes, radii, [small_radius_time(box, event, r) for r in radii])
    if "last" in laws:
        radii = end * (1 - np.geomspace(LAST, 1e-6, 60))
        panels.asymptote(axes, radii, [threshold_time(box.scene(r), event) for r in radii])


def _approach(axes, box, by_quantity):
    """Draw the times over the distance from the radius at which the hop ends."""
    distances = np.geomspace(CLOSEST, 0.99, 70)
    ends = hop_ends(box)
    shown, handles = [], []
    for (colour, marker), (quantity, part) in zip(SERIES, by_quantity.items(), strict=False):
        event = quantity.removesuffix("_time")
        end, name = ends[event]
        scenes = [box.scene(float(end * (1 - d))) for d in distances]
        times = [mean_times(scene)[event] for scene in scenes]
        exact = np.array(times, float)
        axes.plot(distances, exact, color=colour, zorder=5)
        label = rf"{part.name}, $r_{{\mathrm{{c}}}}={name}$"
        if part.is_visible():
            handles.append(Line2D([], [], label=label, color=colour))
        shown += [time for time in times if time]
        if None in times:
            shown += [row["estimate"] for row in part.rows if row["estimate"]]
        if box.is_plain:
            near = distances < LAW
            laws = [threshold_time(scene, event) for scene in scenes]
            panels.asymptote(axes, distances[near], np.array(laws)[near])
        rows = [row | {"radius": 1 - row["radius"] / end} for row in part.rows]
        panels.estimates(axes, [row for row in rows if row["radius"] > 0], colour, marker)
    low, high = min(shown) / 3, 3 * max(shown)
    axes.set(xscale="log", yscale="log", xlim=(CLOSEST, 1), ylim=(low, high))
    panels.label_decades(axes.yaxis, high / low)
    axes.set_xlabel(r"relative distance from the end, $1-r/r_{\mathrm{c}}$")
    axes.set_ylabel(r"mean time $\tau$")
    if box.is_plain:
        handles.append(Line2D([], [], label=panels.LAW_NAME, **panels.LAW))
    loc = "upper right" if box.is_plain else "best"
    axes.legend(handles=handles, loc=loc, **panels.CLEAR)
    panels.letter(axes, "b")
