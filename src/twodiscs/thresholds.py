"""Power laws of the mean times where an event dies out, fitted to what was simulated.

Near a limiting radius r_c a mean time goes like C δ^p with δ = r_c − r: hops that become blocked
before the discs jam diverge with p = −2, what is left vanishes with p = 1 below the largest radius
(``theory.threshold_time``). Straight lines are fitted to ln τ against ln δ with the weights of the
measured errors, in two forms: ``plain``, to the times as they are, and ``reduced``, to times over
the regular factor τ_exact/(C δ^p), which tends to 1. A plain exponent says how far the law itself
holds at the radii at hand, and the same fit to the exact curve says what it should come to; a
reduced one is p, and its coefficient C, wherever it is measured.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.special import gammaincc

from twodiscs import grid, theory
from twodiscs.checks import one_of
from twodiscs.scene import EVENTS, HOPS, Scene, largest_radius, length

#: Fits take radii this close to the limit, relative to it, and no other limit in between.
WIDTH = 0.2

#: A line through fewer points is not fitted.
FEWEST = 3


#: What a fit takes of the rows of a table.
COLUMNS = ("radius", "estimate", "stderr", "exact")


class Law(NamedTuple):
    """C δ^p below a limiting radius: the leading law of a mean time."""

    limit: float
    power: int
    coefficient: float

    def __call__(self, radius):
        return self.coefficient * (self.limit - radius) ** self.power


def leading_law(width, height, event):
    """Return the ``Law`` of a mean time in a box, or None where it stays finite.

    Raises ``ValueError`` for what makes no box, and an event that is not one of ``EVENTS``.
    """
    width, height = length("width", width), length("height", height)
    one_of("event", event, EVENTS)
    limit = largest_radius(width, height)
    if event in HOPS:
        blocked = (width if event == "vertical_hop" else height) / 4
        limit = min(limit, blocked)
    near, far = (Scene(width, height, limit * (1 - 2.0**-k)) for k in (21, 20))
    times = [theory.threshold_time(scene, event) for scene in (near, far)]
    power = round(math.log2(times[1] / times[0]))
    if not power:
        return None
    return Law(limit, power, times[0] / (limit - near.radius) ** power)


def line(x, y, errors):
    """Fit y = c + s x to arrays by weighted least squares; return (c, s, error of s, χ²).

    Raises ``ValueError`` unless there are three points at least.
    """
    if len(x) < FEWEST:
        raise ValueError(f"x must have at least {FEWEST} points, not {len(x)}")
    weights = 1 / errors**2
    middle = weights @ x / weights.sum()
    spread = weights @ (x - middle) ** 2
    slope = weights @ ((x - middle) * y) / spread
    constant = weights @ y / weights.sum() - slope * middle
    return constant, slope, 1 / math.sqrt(spread), weights @ (y - constant - slope * x) ** 2


def fits(law, quantity, radii, times, errors, exact):
    """Yield the fits to ``times`` at ``radii`` as rows of thresholds.csv, without scene and event.

    ``errors`` are standard errors of the times, ``exact`` the exact mean times. The mean time
    itself is compared with what the exact curve gives; the first passage has no exact curve.
    Coefficients are those at the exact power, and of mean times alone. Yields nothing for fewer
    than three points.
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
    _, slope, error, chi2 = line(x, y, errors)
    _, due, _, _ = line(x, curve, errors)
    if quantity != "mean_time":
        yield fit | _row("exponent", slope, error, None, law.power, chi2, len(x) - 2)
        return
    yield fit | _row("exponent", slope, error, due, law.power, chi2, len(x) - 2)
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
        "p": float(gammaincc(degrees / 2, chi2 / 2)),
    }


def start(width, height, law):
    """Return the radius from which on times are fitted by the ``law`` of a box."""
    others = [limit for limit in grid.thresholds(width, height) if limit < law.limit]
    return max([(1 - WIDTH) * law.limit, *others])


def near(width, height, law, rows):
    """Return those of ``rows`` near enough to the limit of the ``law``, with an honest error."""
    low = start(width, height, law)
    return [row for row in rows if low < row["radius"] < law.limit and row["stderr"]]


def rows(scenes, mean_times, distributions):
    """Yield the rows of thresholds.csv.

    ``scenes`` is {name: (width, height)}, ``mean_times`` {name: rows of its mean_times.csv} and
    ``distributions`` the rows of distributions.csv, for the first passages.
    """
    for name, (width, height) in scenes.items():
        box = {"scene": name, "width": width, "height": height}
        for event in EVENTS:
            law = leading_law(width, height, event)
            if law is None:
                continue
            seen = [row for row in mean_times.get(name, []) if row["event"] == event]
            passages = [
                row | {"exact": row["exact_mean"]}
                for row in distributions
                if (row["scene"], row["event"]) == (name, event)
                and row["quantity"] == "first_passage"
                and row["last"] is None
            ]
            for quantity, found in (("mean_time", seen), ("first_passage", passages)):
                if quantity == "first_passage" and law.power > 0:
                    continue
                kept = near(width, height, law, found)
                values = [[row[c] for row in kept] for c in COLUMNS]
                for row in fits(law, quantity, *values):
                    yield box | {"event": event} | row
