"""Figures over the radius: volume, areas, mean times and pressures against exact curves."""

from dataclasses import replace

import numpy as np
from matplotlib.lines import Line2D

from twodiscs.analysis.tables import row_quantity
from twodiscs.figures import curves, panels
from twodiscs.figures.curves import hop_ends
from twodiscs.figures.scene_figures import FIGURES, Curves
from twodiscs.figures.style import BLACK, EVENT_LOOKS, SERIES, event_name, new_figure
from twodiscs.theory import virial
from twodiscs.theory.exact import mean_times, rate
from twodiscs.theory.laws import small_radius_time, threshold_time

#: The law for small discs is drawn up to this radius over the largest one, the limiting law from
#: this relative distance to the end of a hop on.
SMALL_RANGE, LAW_RANGE = 0.4, 0.3

#: The relative distance to the end of a hop at which the panel of distances begins.
NEAREST_END = 5e-7


def _every(kind, label):
    """Return the ``Curves`` of one kind of quantity, "time" or "area", for all events."""
    names = {f"{event}_{kind}": event_name(event) for event in EVENT_LOOKS}
    looks = {f"{event}_{kind}": look for event, look in EVENT_LOOKS.items()}
    return Curves(names, label, looks=looks)


#: The figures by their names. ``mean_times`` and ``areas`` show all events in one panel.
CURVES = {name: entry.curves for name, entry in FIGURES.items() if entry.curves} | {
    "mean_times": _every("time", r"mean time $\tau$ (length/speed)"),
    "areas": _every("area", "area $S$ (length$^3$)"),
}


def draw(name, box, rows):
    """Draw one of ``CURVES`` for a ``Box``, with the ``rows`` of its table.

    There is a panel of residuals if there are any, and no curve if no exact value is known. For
    more than three discs one radius may take minutes, so nothing is drawn towards the end of a hop.
    """
    kind = CURVES[name]
    radii, by_quantity = select_series(box, rows, kind.names, kind.looks or {})
    drawn = [row for part in by_quantity.values() for row in part.rows]
    # Without any exact value nothing approaches an end.
    measured = [row for row in drawn if row.get("estimate") is not None]
    known = not measured or any(row.get("exact") is not None for row in measured)
    beneath = kind.approach and known and box.discs <= 3
    figure, main, residuals, approach = panels.radius_panels(
        box, kind.label, any(map(panels.is_judged, drawn)), beneath
    )
    for quantity in by_quantity:
        _laws(main, box, quantity.removesuffix("_time"), kind.laws)
    series = _draw_series(main, residuals, radii, kind, by_quantity)
    laws = [(panels.LAW_NAME, panels.LAW_LOOK)] if kind.laws and box.is_plain else []
    panels.legend(main, series, kind.single, laws)
    if beneath:
        _approach(approach, box, by_quantity)
    return figure


def _draw_series(main, lower, radii, kind, by_quantity):
    """Draw the ``Series`` {quantity: series} that ``kind``, a ``Curves``, names; return them."""
    series = [part for quantity, part in by_quantity.items() if quantity in kind.names]
    if kind.rooted:
        series = [_rooted(part) for part in series]
    panels.draw_series(main, lower, radii, series, bool(kind.single))
    if kind.rooted:
        main.set_ylim(0, None)
    elif series:
        panels.logarithmic(main, radii, series)
    return series


#: The figures that ``draw_areas`` shows beside and beneath each other.
AREA_FIGURES = ("collision_area", "wall_area", "vertical_hop_area", "horizontal_hop_area")


def draw_areas(box, rows):
    """Draw the areas of all events of a plain ``Box``, each with its residuals beneath.

    The panels are those of the figures of single areas.
    """
    names = {q: name for figure in AREA_FIGURES for q, name in CURVES[figure].names.items()}
    radii, by_quantity = select_series(box, rows, names, {})
    figure = new_figure(5.4, 7.0, layout="constrained")
    heights = [panels.MAIN_HEIGHT, panels.RESIDUALS_HEIGHT]
    axes = figure.subplots(4, 2, height_ratios=heights * 2, squeeze=False)
    for i, name in enumerate(AREA_FIGURES):
        main, lower = axes[2 * (i // 2) : 2 * (i // 2) + 2, i % 2]
        kind = CURVES[name]
        main.set_label(name)
        lower.set_label(f"residuals of {name}")
        series = _draw_series(main, lower, radii, kind, by_quantity)
        # The name of a root is too long beside a panel of this height.
        panels.over_radius(box, kind.label.rpartition(", ")[2], main, lower)
        panels.legend(main, series, kind.single)
        panels.title(main, "abcd"[i], box if i == 0 else None, up=panels.TITLE_PAD)
    return figure


def add(axes, box, rows, names):
    """Draw the quantities among ``names`` into ``axes``, which may have other curves.

    Every call takes unused colours and markers. Names in the legend include the box, because
    ``axes`` may show several.
    """
    kinds = [CURVES["volume"], CURVES["mean_times"], CURVES["areas"]]
    present = {*map(row_quantity, rows)} & {*names}
    kind = next(one for one in kinds if present & {*one.names})
    before, looks = len(axes.get_legend_handles_labels()[1]), [*EVENT_LOOKS.values()]
    texts = {q: text for one in kinds for q, text in one.names.items() if q in present}
    names = {q: ", ".join([text, *panels.heading(box)]) for q, text in texts.items()}
    looks = {q: looks[(before + i) % len(looks)] for i, q in enumerate(texts)}
    radii, by_quantity = select_series(box, rows, names, looks)
    series, ends = [*by_quantity.values()], axes.get_ylim()
    panels.draw_series(axes, None, radii, series)
    for part in series:
        axes.plot([], [], label=part.name, **panels.legend_style(part, *part.look))
    panels.logarithmic(axes, radii, series)
    if before:
        low, high = zip(ends, axes.get_ylim(), strict=True)
        axes.set_ylim(min(low), max(high))
    else:
        axes.set(xlabel="radius $r$ (length)", ylabel=kind.label)
    axes.legend()


def select_series(box, rows, names, looks):
    """Return (radii of the curves, {quantity: ``Series``}) of the quantities in ``rows``.

    Rows of exact values alone have a curve, but no symbol.
    """
    radii, exact = curves.exact_curves(box, rows=rows)
    by_quantity = {}
    for quantity, name in names.items():
        own = [row for row in rows if row_quantity(row) == quantity]
        if own:
            measured = [row for row in own if "estimate" in row]
            look = looks.get(quantity)
            by_quantity[quantity] = panels.Series(name, measured, exact[quantity], look)
    return radii, by_quantity


def _rooted(series):
    """Return a ``Series`` of square roots with their standard errors.

    No sample can be in the shell of a blocked hop: this exact result is a symbol at 0.
    """

    def root(row):
        if row["exact"] == 0 and row.get("hits") == 0:
            return row | {"estimate": 0.0, "stderr": 0.0}
        if not row["estimate"]:
            return row
        value = row["estimate"] ** 0.5
        return row | {"estimate": value, "stderr": row["stderr"] and row["stderr"] / (2 * value)}

    return replace(series, rows=[*map(root, series.rows)], exact=np.sqrt(series.exact))


def _laws(axes, box, event, laws):
    """Draw laws for small discs and below the largest radius, known for boxes without effects."""
    if not box.is_plain:
        return
    end = box.largest_radius
    if "small" in laws:
        radii = np.linspace(0, SMALL_RANGE, 41)[1:] * end
        axes.plot(radii, [small_radius_time(box, event, r) for r in radii], **panels.LAW_LOOK)
    if "last" in laws:
        radii = end * (1 - np.geomspace(0.1, 1e-6, 60))
        axes.plot(radii, [threshold_time(box.scene(r), event) for r in radii], **panels.LAW_LOOK)


def _approach(axes, box, by_quantity):
    """Draw the times over the distance from the radius at which the hop ends."""
    distances = np.geomspace(NEAREST_END, 0.99, 80)
    ends = hop_ends(box)
    shown, handles = [], []
    for (colour, marker), (quantity, part) in zip(SERIES, by_quantity.items(), strict=False):
        event = quantity.removesuffix("_time")
        end, name = ends[event]
        scenes = [box.scene(float(end * (1 - d))) for d in distances]
        times = [mean_times(scene)[event] for scene in scenes]
        axes.plot(distances, times, color=colour, zorder=5)
        label = rf"{part.name}, $r_{{\mathrm{{c}}}}={name}$"
        handles.append(Line2D([], [], label=label, color=colour))
        shown += times
        if box.is_plain:
            near = distances < LAW_RANGE
            laws = [threshold_time(scene, event) for scene in scenes]
            axes.plot(distances[near], np.array(laws)[near], **panels.LAW_LOOK)
        rows = [row | {"radius": 1 - row["radius"] / end} for row in part.rows]
        panels.draw_estimates(axes, [row for row in rows if row["radius"] > 0], colour, marker)
    low, high = min(shown) / 3, 3 * max(shown)
    axes.set(xscale="log", yscale="log", xlim=(NEAREST_END, 1), ylim=(low, high))
    panels.label_decades(axes.yaxis, high / low)
    axes.set_xlabel(r"relative distance from the end, $1-r/r_{\mathrm{c}}$")
    axes.set_ylabel(r"mean time $\tau$ (length/speed)")
    if box.is_plain:
        handles.append(Line2D([], [], label=panels.LAW_NAME, **panels.LAW_LOOK))
    axes.legend(handles=handles, loc="best")


# Pressures ----------------------------------------------------------------------------------------


def draw_pressure(box, rows):
    """Draw the pressures from the rows of mean_times.csv, and the terms of the virial."""
    radii = [radius for branch in curves.branches(box, rows=rows) for radius in (*branch, np.nan)]
    radii, summed = np.array(radii), virial.has_theorem(box)
    counted = {row["event"] for row in rows}
    names = {e: f"disc 1, {event_name(e)}" for e in ("right_wall", "top_wall") if e in counted}
    series = _pressure_series(names, box, rows, radii, virial.pressure_factor)
    label = "pressure over that of an ideal gas"
    judged = any(panels.is_judged(row) for part in series for row in part.rows)
    figure, main, lower, beneath = panels.radius_panels(box, label, judged, summed)
    panels.draw_series(main, lower, radii, series)
    ideal = {"color": BLACK, "lw": 0.7, "ls": (0, (1, 1.5))}
    main.axhline(1, **ideal)
    more = [("ideal gas", ideal)]
    if box.is_plain:
        more.append((panels.LAW_NAME, panels.LAW_LOOK))
        end = box.largest_radius
        farthest = min(0.12, 1 - max(box.thresholds, default=0) / end)
        near = [box.scene(float(r)) for r in end * (1 - np.geomspace(0.99 * farthest, 1e-6))]
        for event in names:
            laws = [
                virial.pressure_factor(scene, event) * scene.accessible_fraction(event) / time
                for scene in near
                for time in [threshold_time(scene, event)]
            ]
            main.plot([scene.radius for scene in near], laws, **panels.LAW_LOOK)
    panels.logarithmic(main, radii, series)
    main.set_ylim(min(main.get_ylim()[0], 0.97), None)
    panels.legend(main, series, more=more)
    if summed:
        _virials(beneath, box, rows, radii)
    return figure


def _pressure_series(names, box, rows, radii, factor):
    """Return a ``Series`` of ``factor`` (scene, event) times the rate of each event {event: name}.

    ``radii`` are those of the curves.
    """
    scenes, series = [None if np.isnan(r) else box.scene(float(r)) for r in radii], []
    for event, name in names.items():
        rates = [None if scene is None else rate(scene, event) for scene in scenes]
        pairs = zip(scenes, rates, strict=True)
        exact = [np.nan if n is None else factor(scene, event) * n for scene, n in pairs]
        shown = []
        for row in rows:
            if row["event"] == event and row["stderr"] is not None:
                scene, time = box.scene(row["radius"]), row["estimate"]
                value = factor(scene, event) * scene.accessible_fraction(event) / time
                # If the time is too long, the rate is too low.
                measured = {"estimate": value, "stderr": value * row["stderr"] / time}
                measured["z"] = None if row["z"] is None else -row["z"]
                shown.append(row | measured)
        series.append(panels.Series(name, shown, np.array(exact)))
    return series


def _virials(axes, box, rows, radii):
    """Draw the sizes of the terms of the virial over 2⟨K⟩, exact and measured."""
    names = {
        "right_wall": "right and left walls",
        "top_wall": "top and bottom walls",
        "disc_collision": "disc collisions, subtracted",
    }

    def weight(scene, event):
        return abs(virial.weights(scene)[event])

    series = _pressure_series(names, box, rows, radii, weight)
    panels.draw_series(axes, None, radii, series)
    axes.set(xlim=(0, 1.02 * box.last_radius), xlabel="radius $r$ (length)")
    axes.set_ylabel(r"virial$\,/\,2\langle E_{\mathrm{k}}\rangle$")
    panels.logarithmic(axes, radii, series)
    axes.set_ylim(0.01, None)
    panels.legend(axes, series)
