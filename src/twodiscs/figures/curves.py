"""Exact curves over the radius, dense where they bend and broken where they jump."""

from itertools import pairwise

import numpy as np

from twodiscs import theory
from twodiscs.figures.limits import limits
from twodiscs.scene import EVENTS, Scene

#: Closest approach to the limits of a regime, over its length.
CLOSEST = 1e-9

#: Radii in each regime: evenly spaced, and in geometric progression towards either end.
EVEN, GEOMETRIC = 60, 25


def branches(width, height):
    """Return one ascending array of radii for each regime of the box, none on its limits.

    The first one starts at 1e-4 of its length, where the law for small radii has long set in.
    """
    near = np.geomspace(CLOSEST, 1 / EVEN, GEOMETRIC)
    inner = np.linspace(0, 1, EVEN + 1)[1:-1]
    found = []
    for low, high in pairwise([0, *(radius for radius, _ in limits(width, height))]):
        start = np.geomspace(1e-4, 1 / EVEN, GEOMETRIC) if low == 0 else near
        fractions = np.unique(np.concatenate([start, inner, 1 - near]))
        radii = low + fractions * (high - low)
        found.append(np.unique(radii[(radii > low) & (radii < high)]))
    return found


def exact(width, height):
    """Return (radii, {quantity: values}) for a box; quantities are named as in theory.csv.

    Between two regimes stands a NaN, so that a line drawn through the values is never joined across
    a limit, where some of them jump; NaN also means that an event is impossible.
    """
    radii, rows = [], []
    for branch in branches(width, height):
        for radius in branch:
            scene = Scene(width, height, radius)
            values = {"volume": theory.volume(scene)}
            values |= {f"{event}_area": area for event, area in theory.areas(scene).items()}
            values |= {f"{event}_time": time for event, time in theory.mean_times(scene).items()}
            radii.append(radius)
            rows.append(values)
        radii.append(np.nan)
        rows.append({})
    names = ["volume", *(f"{event}_{kind}" for kind in ("area", "time") for event in EVENTS)]
    columns = {
        name: np.array([np.nan if row.get(name) is None else row[name] for row in rows])
        for name in names
    }
    return np.array(radii), columns
