"""What the figures of mean times share: rows of mean_times.csv, exact curves, limiting laws."""

import numpy as np

from twodiscs import theory
from twodiscs.figures import curves, panels
from twodiscs.scene import Scene, largest_radius

#: Reach of the limiting laws, over the largest radius: from r = 0, and down from the end.
SMALL, LAST = 0.4, 0.1


def series(scene, tables, events):
    """Return (radii of the curves, {event: ``Series``}) for those ``events`` that were simulated.

    ``events`` is {event: name in the legend}.
    """
    radii, exact = curves.exact(scene)
    found = {}
    for event, name in events.items():
        rows = [row for row in tables["mean_times"] if row["event"] == event]
        if rows:
            found[event] = panels.Series(name, rows, exact[f"{event}_time"])
    if not found:
        raise ValueError(f"mean_times.csv has no row of {', '.join(events)}")
    return radii, found


def small_law(axes, scene, event):
    """Draw the first-order law for small discs, which is known for plain scenes."""
    if "effects" in scene:
        return
    width, height = scene["width"], scene["height"]
    radii = np.linspace(0, SMALL, 41)[1:] * largest_radius(width, height)
    times = [theory.small_radius_time(width, height, event, r) for r in radii]
    panels.asymptote(axes, radii, times)


def last_law(axes, scene, event):
    """Draw the leading law below the largest radius, which is known for plain scenes."""
    if "effects" in scene:
        return
    end = largest_radius(scene["width"], scene["height"])
    radii = end * (1 - np.geomspace(LAST, 1e-6, 60))
    times = [theory.threshold_time(Scene(scene["width"], scene["height"], r), event) for r in radii]
    panels.asymptote(axes, radii, times)
