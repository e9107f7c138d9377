"""Powers of κ and of 1 − κ, fitted to rows of passages.csv."""

import math
from itertools import pairwise

import numpy as np

from twodiscs_paper.studies.estimates import LinearFit
from twodiscs_paper.study import row

#: The number of distances in a fit, each half of the one before: four octaves.
FIT_DISTANCES = 5

#: c of 1 − κ = c σ^(2/3) ε^(1/3)/A, as ``models.limit`` finds it: the row "amplitude" of the table.
AMPLITUDE = 0.769

#: The largest distance at which the law has two orders: at w/4 χ² is 4 for 6 degrees of freedom,
#: and 35 for 7 with one distance more.
LAW_FROM = 2.0**-13

#: The columns that identify one hop, near one threshold, of discs with one moment of inertia.
HOP_COLUMNS = ("scene", "width", "height", "event", "discs", "moment_of_inertia")


def fits(rows):
    """Yield the powers of ``rows`` of passages.csv, as powers of the distance.

    The power is that of 1 − κ for smooth discs, and of κ for rough discs, both without friction. It
    is taken from each distance of a hop and the one before, and from the last ``FIT_DISTANCES``
    distances. There is no power if a value is not positive.
    """
    hops = {}
    for one in rows:
        if one["quantity"] == "coefficient" and one["friction"] is None:
            hops.setdefault(tuple(one[name] for name in HOP_COLUMNS), []).append(one)
    for found in hops.values():
        found.sort(key=lambda one: -one["distance"])
        steps = [("exponent", pair) for pair in pairwise(found)]
        for quantity, last in [*steps, ("last_exponent", found[-FIT_DISTANCES:])]:
            is_rough = last[0]["moment_of_inertia"] is not None
            values = [one["estimate"] if is_rough else 1 - one["estimate"] for one in last]
            if len(last) < 2 or min(values) <= 0:
                continue
            x = [math.log(one["distance"]) for one in last]
            y = [math.log(value) for value in values]
            errors = [one["stderr"] / value for one, value in zip(last, values, strict=True)]
            kept = {
                name: last[-1][name] for name in (*HOP_COLUMNS, "radius", "distance", "exact_mean")
            }
            slope = LinearFit(x, y, errors).slope
            yield row(kept, slope, quantity=quantity, method="fit", replicas=len(last))


def law_powers(rows):
    """Yield the power of 1 − κ that the law has over the last distances of ``rows``, and χ².

    (1 − κ) A/(σ² ε)^(1/3) = c + a δ^(1/6) + b δ^(1/3), fitted to κ of one hop of smooth discs.
    """
    distance, values, errors, scales = np.array([
        (one["distance"], 1 - one["estimate"], one["stderr"], law_scale(one))
        for one in sorted(rows, key=lambda one: -one["distance"])
        if one["quantity"] == "coefficient" and one["distance"] <= LAW_FROM
    ]).T  # fmt: skip
    x = distance ** (1 / 6)
    terms, weights = np.array([x, x * x]).T, 1 / (errors * scales)
    reduced = weights * (values * scales - AMPLITUDE)
    factors, (chi2,), *_ = np.linalg.lstsq(weights[:, None] * terms, reduced)
    law = (AMPLITUDE + terms @ factors) / scales
    last = slice(-FIT_DISTANCES, None)
    slope = LinearFit(np.log(distance[last]), np.log(law[last]), (errors / values)[last]).slope
    kept = {name: rows[-1][name] for name in (*HOP_COLUMNS, "radius", "distance", "exact_mean")}
    for quantity, value in (("law_exponent", slope.value), ("law_chi2", float(chi2))):
        yield row(kept, quantity=quantity, estimate=value, method="fit", replicas=len(values))


def law_scale(row):
    """Return A/(σ² ε)^(1/3) of the hop of a ``row``."""
    along, across = row["width"], row["height"]
    if row["event"] == "vertical_hop":
        along, across = across, along
    sigma = 2 * row["radius"]
    return (along - sigma) / (sigma**2 * (across - 2 * sigma)) ** (1 / 3)
