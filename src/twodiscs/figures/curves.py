"""Exact curves over the radius, dense where they bend and broken at the limits of a regime."""

from functools import cache
from itertools import pairwise
from math import isclose

import numpy as np

from twodiscs.analysis.tables import TheoryTable
from twodiscs.model.events import EVENT_AXES, EVENTS, HOPS

#: The name of the largest radius that fits, that of a smaller one beyond which a field allows no
#: scene, and the names of the radii at which hops become blocked.
R_MAX, R_F = r"r_{\mathrm{max}}", r"r_{\mathrm{f}}"
QUARTER_LABELS = {"x": "h/4", "y": "w/4"}

#: The names of radii of a box with effects: hops become blocked, disc 1 can no longer change sides,
#: in a field it can reach the top wall, on a periodic axis discs can no longer pass each other. If
#: two radii are the same, the name is that of a hop, or else the first.
R_V, R_H = r"r_{\mathrm{v}}", r"r_{\mathrm{h}}"
R_T, R_X, R_Y = r"r_{\mathrm{t}}", r"r_{\mathrm{x}}", r"r_{\mathrm{y}}"
RADIUS_STATES = {
    R_V: lambda scene: scene.vertical_hops,
    R_H: lambda scene: scene.horizontal_hops,
    R_T: lambda scene: scene.is_possible("top_wall"),
    R_X: lambda scene: scene.confined[0],
    R_Y: lambda scene: scene.confined[1],
    r"\sigma=h/2": lambda scene: _fills(scene, "y"),
    r"\sigma=w/2": lambda scene: _fills(scene, "x"),
}


@cache
def limits(box):
    """Return ((radius, name in mathtext), …) of a ``Box``, ascending.

    For two plain discs they are h/4 and w/4, if discs of these radii fit, and the largest radius.
    With effects, and for more discs, they are r_v and r_h, at which vertical and horizontal hops
    become blocked. In a field r_t is the radius from which on disc 1 can rise to the top wall. At
    r_x and r_y disc 1 loses its way to the other side of disc 2, if the hop is not blocked there.
    A periodic axis adds the radii at which σ = r1 + r2 is half of a side. The last one is the
    largest radius, or r_f if a field allows scenes only up to a smaller one.
    """
    names = {}
    if box.is_plain:
        for hop in sorted(HOPS, key=EVENT_AXES.get):
            radius, name = box.threshold(hop), QUARTER_LABELS[EVENT_AXES[hop]]
            names[radius] = f"{names[radius]}={name}" if radius in names else name
        names = {radius: name for radius, name in names.items() if radius in box.thresholds}
        return *sorted(names.items()), (box.largest_radius, R_MAX)
    largest = box.last_radius
    for name, state in RADIUS_STATES.items():
        first = state(box.scene(1e-6 * largest))
        radius = box.end(lambda here, s=state, f=first: s(here) == f)
        if radius in names and name == R_H:
            names[radius] += f"={name}"
        elif radius < largest:
            names.setdefault(radius, name)
    last = R_MAX if isclose(largest, box.largest_radius) else R_F
    return *sorted(names.items()), (largest, last)


def _fills(scene, axis):
    return bool(scene.periodic) and scene.reach(axis) <= scene.exact_contact


def hop_ends(box):
    """Return {hop: (radius at which it ends, its name)} of a ``Box``."""
    ends = limits(box)
    names = (QUARTER_LABELS["y"], QUARTER_LABELS["x"]) if box.is_plain else (R_V, R_H)
    return {
        hop: next((limit for limit in ends if name in limit[1].split("=")), ends[-1])
        for hop, name in zip(HOPS, names, strict=True)
    }


def branches(box, others=(), rows=()):
    """Return one ascending array of radii for each regime of a ``Box``, none on its limits.

    The first one starts at 1e-4 of its length, where the law for small radii holds. ``others`` are
    more limits, such as the limits of another box in the same figure. For more than three discs one
    radius may take minutes: there are no curves, and each radius of the ``rows`` is a branch.

    Radii are Chebyshev nodes, which are dense at both ends, where curves bend, and go on in
    geometric progression to the limits. Effects have fewer, because their theory takes longer.
    """
    if box.discs > 3:
        return [np.array([radius]) for radius in sorted({row["radius"] for row in rows})]
    own = [radius for radius, _ in limits(box)]
    ends = sorted({0, *own, *(radius for radius in others if radius < own[-1])})
    nodes, closest = (96, 1e-9) if box.is_plain else (32, 1e-5)
    inner = (1 - np.cos(np.pi * np.arange(1, nodes) / nodes)) / 2
    near = np.geomspace(closest, inner[0], 8)
    regimes = []
    for low, high in pairwise(ends):
        start = np.geomspace(1e-4, inner[0], 8) if low == 0 else near
        fractions = np.unique(np.concatenate([start, inner, 1 - near]))
        radii = low + fractions * (high - low)
        regimes.append(np.unique(radii[(radii > low) & (radii < high)]))
    return regimes


def exact_curves(box, others=(), rows=()):
    """Return (radii, {quantity: values}) along the exact curves of a ``Box``.

    Quantities are named as in theory.csv. A NaN between two regimes breaks a line through the
    values at a limit, where some of them jump. NaN also means that an event is impossible, or that
    no exact value is known. ``others`` are more limits, ``rows`` are of a result, as in
    ``branches``.
    """
    return _values_along(box, tuple(map(tuple, branches(box, others, rows))))


@cache
def _values_along(box, regimes):
    rows = TheoryTable.rows(box, [float(radius) for regime in regimes for radius in regime])
    known = {(row["radius"], row["quantity"]): row["exact"] for row in rows}
    radii = [radius for regime in regimes for radius in (*regime, np.nan)]
    names = ["volume", *(f"{event}_{kind}" for kind in ("area", "time") for event in EVENTS)]
    columns = {name: np.array([known.get((r, name)) for r in radii], float) for name in names}
    return np.array(radii), columns
