"""The end of a tail: its last ratio to the exact law, and the test for a constant rate of decay."""

import math
from itertools import pairwise

from twodiscs.comparison.scores import chi2_p

#: A ratio is well measured if its relative error is below this one.
WELL_MEASURED = 0.2

#: Hops approach the law as 1 + c (t/τ)^(−1/2); collisions have no such term.
APPROACHES = ("vertical_hop", "horizontal_hop")


def last_ratios(rows):
    """Yield the rows on the last well measured ratio of each tail to its law, and its approach."""
    last = {
        row["event"]: row
        for row in rows
        if row["method"] == "weighted" and row["law"] and row["stderr"]
        if row["stderr"] < WELL_MEASURED * row["estimate"]
    }
    for event, row in last.items():
        ratio, error = row["estimate"] / row["law"], row["stderr"] / row["law"]
        start = row | {"method": "fit", "law": None}
        yield start | {"quantity": "last_ratio", "estimate": ratio, "stderr": error}
        if event in APPROACHES:
            yield approach(row)


def approach(row):
    """Return the row on the c of the ratio 1 + c (t/τ)^(−1/2) of a ``row`` to its law."""
    root = math.sqrt(row["time"] / row["exact_mean"])
    ratio, error = row["estimate"] / row["law"], row["stderr"] / row["law"]
    found = {"estimate": (ratio - 1) * root, "stderr": error * root}
    return row | {"quantity": "approach", "method": "fit", "law": None} | found


def constant_hazard(rows):
    """Return (χ², degrees of freedom) of a constant hazard between the times of ``rows``, or None.

    ``rows`` are survival probabilities at ascending times. Intervals that last longer than one time
    are among those that last longer than the time before. Therefore the variance of the hazard
    between the two times is the difference of their relative variances, over the time squared.
    """
    hazards, weights = [], []
    for row, later in pairwise(rows):
        time = later["time"] - row["time"]
        hazards.append(math.log(row["estimate"] / later["estimate"]) / time)
        relative = [(r["stderr"] / r["estimate"]) ** 2 for r in (later, row)]
        weights.append(time**2 / (relative[0] - relative[1]))
    if len(hazards) < 2:
        return None
    mean = sum(w * h for w, h in zip(weights, hazards, strict=True)) / sum(weights)
    chi2 = sum(w * (h - mean) ** 2 for w, h in zip(weights, hazards, strict=True))
    return chi2, len(hazards) - 1


def constancy(rows):
    """Yield the rows that test whether a rate of decay is constant over the times of its fit."""
    for rate in [row for row in rows if row["quantity"] == "rate"]:
        within = [
            row
            for row in rows
            if (row["event"], row["radius"]) == (rate["event"], rate["radius"])
            and (row["quantity"], row["method"]) == ("survival", "counted")
            and rate["time"] * (1 - 1e-9) <= row["time"] <= rate["until"] * (1 + 1e-9)
            and row["stderr"] is not None
        ]
        if found := constant_hazard(within):
            start = rate | {"method": "fit", "law": None, "stderr": None}
            chi2, degrees = found
            for quantity, value in (
                ("chi2", chi2),
                ("degrees", float(degrees)),
                ("chance", chi2_p(chi2, degrees)),
            ):
                yield start | {"quantity": quantity, "estimate": value}


def fits(rows):
    """Yield the rows of tails.csv that follow from its other ``rows``."""
    yield from last_ratios(rows)
    yield from constancy(rows)
