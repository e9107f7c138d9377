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
from typing import NamedTuple

import numpy as np

from twodiscs.model.checks import check_choice
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Box
from twodiscs.points.estimates import Estimate
from twodiscs.theory.laws import threshold_time
from twodiscs_paper.studies.estimates import LinearFit, chi2_p, columns
from twodiscs_paper.study import row, select

#: Fits take radii within this relative distance of the limit, without another limit in between.
FITTED_RANGE = 0.2

#: The columns that a fit uses.
COLUMNS = ("radius", "estimate", "stderr", "exact")


class PowerLaw(NamedTuple):
    """C δ^p with δ the distance below a limiting radius: the leading law of a mean time."""

    limit: float
    power: int
    coefficient: float

    def __call__(self, radius):
        return self.coefficient * (self.limit - radius) ** self.power


def leading_law(box, event):
    """Return the ``PowerLaw`` of a mean time in a plain ``Box``, or None if it stays finite."""
    limit = box.threshold(check_choice("event", event, EVENTS))
    near, far = (box.scene(limit * (1 - 2.0**-k)) for k in (21, 20))
    times = [threshold_time(scene, event) for scene in (near, far)]
    power = round(math.log2(times[1] / times[0]))
    if not power:
        return None
    return PowerLaw(limit, power, times[0] / (limit - near.radius) ** power)


def fits(start, law, quantity, radii, times, errors, exact):
    """Yield the fits to ``times`` at ``radii`` as rows of thresholds.csv.

    ``start`` has the columns that name scene and event. ``errors`` are standard errors of the
    times, ``exact`` the exact mean times. Fits to mean times are compared with the same fits to the
    exact curve; first passages have no exact curve. Coefficients are fitted at the exact power, to
    mean times only. Yields nothing for fewer than three points.
    """
    # The fewest points for a fit.
    if len(radii) < 3:
        return
    x, relative = np.log(law.limit - radii), errors / times
    regular = np.log(exact / law(radii))
    start = start | {"quantity": quantity, "points": len(x)}
    for form, factor in (("plain", np.zeros(len(x))), ("reduced", regular)):
        y, curve = np.log(times) - factor, None
        if quantity == "mean_time":
            curve = np.log(exact) - factor
        yield from _fit(start | {"form": form}, law, x, y, relative, curve)


def _fit(start, law, x, y, errors, curve):
    """Yield the rows of one fit, and of the same fit to the exact ``curve`` if there is one."""
    line = LinearFit(x, y, errors)
    due = None if curve is None else LinearFit(x, curve, errors).slope.value
    yield _row(start, "exponent", line.slope, due, law.power, line.chi2, len(x) - 2)
    if curve is None:
        return
    weights = 1 / errors**2
    constant, due = (weights @ (v - law.power * x) / weights.sum() for v in (y, curve))
    chi2 = weights @ (y - constant - law.power * x) ** 2
    value = math.exp(constant)
    found = Estimate(value, value / math.sqrt(weights.sum()), len(x))
    yield _row(start, "coefficient", found, math.exp(due), law.coefficient, float(chi2), len(x) - 1)


def _row(start, parameter, found, curve, law, chi2, degrees):
    """Return the row on a parameter that was ``found``, against its value for the exact curve."""
    z = None if curve is None else (found.value - curve) / found.stderr
    cells = {"law": float(law), "z": z, "chi2": chi2, "degrees": degrees}
    return row(start, found, parameter=parameter, curve=curve, p=chi2_p(chi2, degrees), **cells)


def start(box, law):
    """Return the smallest radius of a fit to the ``law`` of a ``Box``."""
    others = [limit for limit in box.thresholds if limit < law.limit]
    return max([(1 - FITTED_RANGE) * law.limit, *others])


def near(box, law, rows):
    """Return the ``rows`` with a standard error and near enough to the limit of the ``law``."""
    low = start(box, law)
    return [one for one in rows if low < one["radius"] < law.limit and one["stderr"]]


def passages(distributions, name, event):
    """Return the rows of distributions.csv on the mean first passages of a scene, without a cut."""
    return select(distributions, scene=name, event=event, quantity="first_passage", last=None)


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
            measured = {"mean_time": select(times, event=event)}
            if law.power < 0:
                measured["first_passage"] = [
                    one | {"exact": one["exact_mean"]}
                    for one in passages(tables["distributions"], name, event)
                ]
            for quantity, found in measured.items():
                values = columns(near(box, law, found), *COLUMNS)
                yield from fits(start | {"event": event}, law, quantity, *values)
