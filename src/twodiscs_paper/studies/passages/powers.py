"""Powers of κ and of 1 − κ, fitted to rows of passages.csv."""

import math
from itertools import pairwise

from twodiscs_paper.studies.estimates import LinearFit
from twodiscs_paper.study import row

#: The number of distances in a fit, each half of the one before: four octaves.
LAST = 5

#: The columns that identify one hop, near one threshold, of discs with one moment of inertia.
HOP = ("scene", "width", "height", "event", "discs", "moment_of_inertia")


def fits(rows):
    """Yield the powers of ``rows`` of passages.csv, as powers of the distance.

    The power is that of 1 − κ for smooth discs, and of κ for rough discs, both without friction. It
    is taken from each distance of a hop and the one before, and from the last ``LAST`` distances.
    There is no power if a value is not positive.
    """
    hops = {}
    for one in rows:
        if one["quantity"] == "coefficient" and one["friction"] is None:
            hops.setdefault(tuple(one[name] for name in HOP), []).append(one)
    for found in hops.values():
        found.sort(key=lambda one: -one["distance"])
        steps = [("exponent", pair) for pair in pairwise(found)]
        for quantity, last in [*steps, ("last_exponent", found[-LAST:])]:
            is_rough = last[0]["moment_of_inertia"] is not None
            values = [one["estimate"] if is_rough else 1 - one["estimate"] for one in last]
            if len(last) < 2 or min(values) <= 0:
                continue
            x = [math.log(one["distance"]) for one in last]
            y = [math.log(value) for value in values]
            errors = [one["stderr"] / value for one, value in zip(last, values, strict=True)]
            kept = {name: last[-1][name] for name in (*HOP, "radius", "distance", "exact_mean")}
            slope = LinearFit(x, y, errors).slope
            yield row(kept, slope, quantity=quantity, method="fit", replicas=len(last))
