"""Exact curves over the radius, dense where they bend and broken where they jump."""

from itertools import pairwise

import numpy as np

from twodiscs.comparison.tables.theory import Theory
from twodiscs.figures.kit.limits import limits
from twodiscs.model.events import EVENTS

#: The closest approach to the limits of a regime, over its length; ``FARTHER`` is for effects.
CLOSEST, FARTHER = 1e-9, 1e-5

#: The number of radii in each regime. They are Chebyshev nodes, which are dense at both ends, where
#: curves bend, and go on in geometric progression to the limits. Effects have fewer, because their
#: theory takes longer, and four or more discs have the fewest: one radius takes up to a minute.
NODES, FEWER, FEWEST, GEOMETRIC = 96, 56, 24, 8


def branches(box, others=()):
    """Return one ascending array of radii for each regime of a ``Box``, none on its limits.

    The first one starts at 1e-4 of its length, where the law for small radii holds. ``others`` are
    more limits, such as the limits of another box in the same figure.
    """
    own = [radius for radius, _ in limits(box)]
    ends = sorted({0, *own, *(radius for radius in others if radius < own[-1])})
    nodes = NODES if box.is_plain else FEWER if box.discs < 4 else FEWEST
    inner = (1 - np.cos(np.pi * np.arange(1, nodes) / nodes)) / 2
    near = np.geomspace(CLOSEST if box.is_plain else FARTHER, inner[0], GEOMETRIC)
    regimes = []
    for low, high in pairwise(ends):
        start = np.geomspace(1e-4, inner[0], GEOMETRIC) if low == 0 else near
        end = 1 - near if box.discs < 4 else []
        fractions = np.unique(np.concatenate([start, inner, end]))
        radii = low + fractions * (high - low)
        regimes.append(np.unique(radii[(radii > low) & (radii < high)]))
    return regimes


def exact_curves(box, others=()):
    """Return (radii, {quantity: values}) along the exact curves of a ``Box``.

    Quantities are named as in theory.csv. A NaN between two regimes breaks a line through the
    values at a limit, where some of them jump. NaN also means that an event is impossible, or that
    no exact value is known. ``others`` are more limits, as in ``branches``.
    """
    radii, rows = [], []
    for branch in branches(box, others):
        for radius in map(float, branch):
            radii.append(radius)
            rows.append({row["quantity"]: row["exact"] for row in Theory.rows(box, [radius])})
        radii.append(np.nan)
        rows.append({})
    names = ["volume", *(f"{event}_{kind}" for kind in ("area", "time") for event in EVENTS)]
    columns = {name: np.array([row.get(name) for row in rows], float) for name in names}
    return np.array(radii), columns
