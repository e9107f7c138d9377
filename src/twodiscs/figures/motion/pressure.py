"""Pressures on the walls, and the virials of the walls and of the collisions of the discs."""

import numpy as np

from twodiscs.figures.kit import curves, panels
from twodiscs.figures.kit.looks import name_of
from twodiscs.figures.kit.style import BLACK, SERIES
from twodiscs.theory import virial
from twodiscs.theory.exact import rate
from twodiscs.theory.laws import threshold_time

WALLS = ("right_wall", "top_wall")

#: The law below the largest radius is drawn up to this relative distance from it.
LAST = 0.12


def draw(box, rows):
    """Draw the pressures from the rows of mean_times.csv, and the terms of the virial."""
    radii = np.concatenate([np.append(branch, np.nan) for branch in curves.branches(box)])
    summed = virial.weights(box.tiny) is not None
    events = [event for event in WALLS if any(row["event"] == event for row in rows)]
    series = [
        _series(f"disc 1, {name_of(event)}", box, event, rows, radii, virial.pressure_factor)
        for event in events
    ]
    label = "pressure over that of an ideal gas"
    judged = any(panels.is_judged(row) for part in series for row in part.rows)
    figure, main, lower, beneath = panels.panels(box, label, judged, summed)
    panels.draw_series(main, lower, radii, series)
    ideal = {"color": BLACK, "lw": 0.7, "ls": (0, (1, 1.5))}
    main.axhline(1, **ideal)
    more = [("ideal gas", ideal)]
    if box.is_plain:
        more.append((panels.LAW_NAME, panels.LAW))
        end = box.largest_radius
        farthest = min(LAST, 1 - max(box.thresholds, default=0) / end)
        near = [box.scene(float(r)) for r in end * (1 - np.geomspace(0.99 * farthest, 1e-6))]
        for event in events:
            laws = [
                virial.pressure_factor(scene, event) * scene.share(event) / time
                for scene in near
                for time in [threshold_time(scene, event)]
            ]
            main.plot([scene.radius for scene in near], laws, **panels.LAW)
    panels.logarithmic(main, radii, series)
    main.set_ylim(min(main.get_ylim()[0], 0.97), None)
    panels.legend(main, series, more=more)
    if summed:
        _virials(beneath, box, rows, radii)
    return figure


def _series(name, box, event, rows, radii, factor):
    """Return the ``Series`` of ``factor`` (scene, event) times the rate of an event."""
    scenes = [None if np.isnan(radius) else box.scene(float(radius)) for radius in radii]
    rates = [None if s is None else rate(s, event) for s in scenes]
    exact = [
        np.nan if n is None else factor(s, event) * n for s, n in zip(scenes, rates, strict=True)
    ]
    shown = []
    for row in rows:
        if row["event"] == event and row["stderr"] is not None:
            scene, time = box.scene(row["radius"]), row["estimate"]
            value = factor(scene, event) * scene.share(event) / time
            # If the time is too long, the rate is too low.
            measured = {"estimate": value, "stderr": value * row["stderr"] / time}
            measured["z"] = None if row["z"] is None else -row["z"]
            shown.append(row | measured)
    return panels.Series(name, shown, np.array(exact))


def _virials(axes, box, rows, radii):
    """Draw the sizes of the terms of the virial over 2⟨K⟩, exact and measured."""
    names = {
        "right_wall": "right and left walls",
        "top_wall": "top and bottom walls",
        "disc_collision": "disc collisions, subtracted",
    }
    series = [
        _series(name, box, event, rows, radii, lambda scene, e: abs(virial.weights(scene)[e]))
        for event, name in names.items()
    ]
    for (colour, marker), part in zip(SERIES, series, strict=False):
        axes.plot(radii, part.exact, color=colour, zorder=5)
        panels.estimates(axes, part.rows, colour, marker)
    axes.set(xlim=(0, 1.02 * box.last_radius), xlabel="radius $r$")
    axes.set_ylabel(r"virial$\,/\,2\langle E_{\mathrm{k}}\rangle$")
    panels.logarithmic(axes, radii, series)
    axes.set_ylim(0.01, None)
    panels.legend(axes, series)
