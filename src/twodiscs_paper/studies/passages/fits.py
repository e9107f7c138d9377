"""Fit κ, or 1 − κ, by a power of the distance over the last octaves before the threshold."""

import math

from twodiscs.points.estimates import LinearFit

#: The number of distances in a fit, each half of the one before: four octaves.
LAST = 5

#: The columns that identify one hop, near one threshold, of discs with one moment of inertia.
HOP = ("scene", "width", "height", "event", "discs", "moment_of_inertia")


def fits(rows):
    """Yield the fitted powers of ``rows`` of passages.csv, as rows without their empty cells.

    The power is fitted to 1 − κ for smooth discs, and to κ for rough discs, both without friction.
    A fit takes the last ``LAST`` distances of a hop. A hop has no fit if it has fewer than two
    distances, or if a value is not positive.
    """
    hops = {}
    for row in rows:
        if row["quantity"] == "coefficient" and row["friction"] is None:
            hops.setdefault(tuple(row[name] for name in HOP), []).append(row)
    for found in hops.values():
        last = sorted(found, key=lambda row: -row["distance"])[-LAST:]
        is_rough = last[0]["moment_of_inertia"] is not None
        values = [row["estimate"] if is_rough else 1 - row["estimate"] for row in last]
        if len(last) < 2 or min(values) <= 0:
            continue
        fit = LinearFit(
            [math.log(row["distance"]) for row in last],
            [math.log(value) for value in values],
            [row["stderr"] / value for row, value in zip(last, values, strict=True)],
        )
        kept = {name: last[-1][name] for name in (*HOP, "radius", "distance", "exact_mean")}
        yield kept | {
            "quantity": "last_exponent",
            "method": "fit",
            "estimate": fit.slope.value,
            "stderr": fit.slope.stderr,
            "replicas": len(last),
        }
