"""Powers of the distance that κ, or 1 − κ, has over the last octaves before the threshold."""

import math

from twodiscs.comparison.estimates import LinearFit

#: A power is fitted to this many distances, each half of the one before: four octaves.
LAST = 5

#: Rows of one hop, near one threshold, of discs with one moment of inertia.
HOP = ("scene", "width", "height", "event", "discs", "moment_of_inertia")


def fits(rows):
    """Yield the fitted powers of ``rows`` of passages.csv, as rows without their empty cells.

    For smooth discs the power is that of 1 − κ, for rough ones that of κ. A fit takes the last
    ``LAST`` distances of a hop. A hop with fewer than two distances has no fit, and so has one
    where κ is not between 0 and 1.
    """
    hops = {}
    for row in rows:
        if row["quantity"] == "coefficient":
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
