"""Fit power laws to the simulated mean times near the radius where an event dies out.

Near a limiting radius r_c a mean time goes like C δ^p with δ = r_c − r. For hops that become
blocked before the discs jam it diverges with p = −2. For other events it vanishes with p = 1 below
the largest radius (``theory.laws.threshold_time``). Straight lines are fitted to ln τ against ln δ
with the weights of the measured errors, in two forms: ``plain``, to the times as they are, and
``reduced``, to times over the regular factor τ_exact/(C δ^p), which tends to 1. A plain exponent
says how far the law itself holds at these radii; the same fit to the exact curve gives its expected
value. A reduced exponent is p, and its coefficient C, at all radii.
"""

import math

import numpy as np

from twodiscs.comparison.scores import chi2_p
from twodiscs.model.box import Box
from twodiscs.model.events import EVENTS
from twodiscs.points.estimates import LinearFit
from twodiscs.theory.laws import leading_law

#: Fits take radii within this relative distance of the limit, without another limit in between.
WIDTH = 0.2

#: The fewest points for a fit.
FEWEST = 3

#: The columns that a fit uses.
COLUMNS = ("radius", "estimate", "stderr", "exact")


def fits(law, quantity, radii, times, errors, exact):
    """Yield the fits to ``times`` at ``radii`` as rows of thresholds.csv, without scene and event.

    ``errors`` are standard errors of the times, ``exact`` the exact mean times. Fits to mean times
    are compared with the same fits to the exact curve; first passages have no exact curve.
    Coefficients are fitted at the exact power, to mean times only. Yields nothing for fewer than
    three points.
    """
    if len(radii) < FEWEST:
        return
    radii, times, errors, exact = (np.array(v, float) for v in (radii, times, errors, exact))
    x, y, relative = np.log(law.limit - radii), np.log(times), errors / times
    regular = np.log(exact / law(radii))
    for form, factor in (("plain", np.zeros(len(x))), ("reduced", regular)):
        curve = np.log(exact) - factor
        yield from _fit(law, quantity, form, x, y - factor, relative, curve)


def _fit(law, quantity, form, x, y, errors, curve):
    """Yield the rows of one fit."""
    deltas = np.exp(x)
    fit = {"quantity": quantity, "form": form, "limit_radius": law.limit, "points": len(x)}
    fit |= {"nearest": float(deltas.min()), "farthest": float(deltas.max())}
    line = LinearFit(x, y, errors)
    slope, error, chi2 = line.slope.value, line.slope.stderr, line.chi2
    due = LinearFit(x, curve, errors).slope.value if quantity == "mean_time" else None
    yield fit | _row("exponent", slope, error, due, law.power, chi2, len(x) - 2)
    if due is None:
        return
    weights = 1 / errors**2
    constant, due = (weights @ (v - law.power * x) / weights.sum() for v in (y, curve))
    chi2 = weights @ (y - constant - law.power * x) ** 2
    value, error = math.exp(constant), math.exp(constant) / math.sqrt(weights.sum())
    due = math.exp(due)
    yield fit | _row("coefficient", value, error, due, law.coefficient, chi2, len(x) - 1)


def _row(parameter, value, error, curve, law, chi2, degrees):
    return {
        "parameter": parameter,
        "estimate": float(value),
        "stderr": float(error),
        "curve": None if curve is None else float(curve),
        "law": float(law),
        "z": None if curve is None else float((value - curve) / error),
        "chi2": float(chi2),
        "degrees": degrees,
        "p": chi2_p(chi2, degrees),
    }


def start(box, law):
    """Return the smallest radius of a fit to the ``law`` of a ``Box``."""
    others = [limit for limit in box.thresholds if limit < law.limit]
    return max([(1 - WIDTH) * law.limit, *others])


def near(box, law, rows):
    """Return the ``rows`` with a standard error and near enough to the limit of the ``law``."""
    low = start(box, law)
    return [row for row in rows if low < row["radius"] < law.limit and row["stderr"]]


def passages(distributions, name, event):
    """Return the rows of distributions.csv on the mean first passages of a scene, without a cut."""
    wanted = name, event, "first_passage", None
    return [
        row
        for row in distributions
        if (row["scene"], row["event"], row["quantity"], row["last"]) == wanted
    ]


def strips(fit, times):
    """Return the row with the share of the ``times`` behind a row ``fit`` that are from strips."""
    share = sum(row["starts"] == "strip" for row in times) / len(times)
    names = "scene", "width", "height", "event", "quantity", "form", "limit_radius", "points"
    kept = {name: fit[name] for name in (*names, "nearest", "farthest")}
    return dict.fromkeys(fit) | kept | {"parameter": "strips", "estimate": share}


def rows(tables, scenes):
    """Yield the rows of thresholds.csv.

    ``scenes`` is {name: parameters of its box}. ``tables`` has the rows of distributions, for the
    first passages, and of <name>/mean_times for every scene that measures them.
    """
    for name, parameters in scenes.items():
        box = Box(**parameters)
        start = {"scene": name, "width": box.width, "height": box.height}
        for event in EVENTS:
            law = leading_law(box, event)
            if law is None:
                continue
            times = tables.get(f"{name}/mean_times", [])
            measured = {"mean_time": [row for row in times if row["event"] == event]}
            if law.power < 0:
                measured["first_passage"] = [
                    row | {"exact": row["exact_mean"]}
                    for row in passages(tables["distributions"], name, event)
                ]
            for quantity, found in measured.items():
                kept = near(box, law, found)
                values = [[row[c] for row in kept] for c in COLUMNS]
                fitted = [start | {"event": event} | row for row in fits(law, quantity, *values)]
                yield from fitted
                if fitted and quantity == "mean_time":
                    yield strips(fitted[0], kept)
