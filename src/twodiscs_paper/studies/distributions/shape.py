"""The shape of a hazard: constant within the errors, or falling, and how far."""

import math

#: A hazard is a plateau if the probabilities of its χ² and of its trend exceed this level.
LEVEL = 1e-3

#: A hazard that ends below this fraction of its fitted rate is compared with 3/t.
FALLEN = 0.75

#: Late bins begin beyond this fraction of the time that the data reach.
LATE = 0.6

#: The columns that identify one hop at one radius.
CASE = ("scene", "width", "height", "radius", "event", "exact_mean")


def is_drifted(row):
    """Return whether discs can avoid the hop of a ``row`` by a drift past each other."""
    side = row["height"] if row["event"] == "vertical_hop" else row["width"]
    return row["radius"] <= side / 4


def late_bins(rate, hazards):
    """Return the ``hazards`` with hops in the last two fifths of the time of a fitted ``rate``."""
    return [row for row in hazards if row["first"] >= LATE * rate["last"] and row["count"] > 0]


def late_hazard(late):
    """Return (hazard, standard error) of the bins ``late``: their hops over their time at risk."""
    hops = sum(row["count"] for row in late)
    hazard = hops / sum(row["count"] / row["estimate"] for row in late)
    return hazard, hazard / math.sqrt(hops)


def over_cubic(late):
    """Return the hops in the bins ``late`` over those expected from 3/t, as for a cubic tail."""
    expected = sum(
        6 * row["count"] / row["estimate"] / (row["first"] + row["last"]) for row in late
    )
    return sum(row["count"] for row in late) / expected


def shape(case):
    """Yield the rows on the shape of a hazard; ``case`` are the rows of one hop at one radius."""
    of = {row["quantity"]: row for row in case}
    if "rate" not in of:
        return
    rate, start = of["rate"], {name: of["rate"][name] for name in CASE}
    tests = [of[name]["p"] for name in ("rate", "trend") if name in of]
    if min(tests) > LEVEL:
        ends = {name: rate[name] for name in ("first", "last", "count", "estimate", "stderr")}
        yield start | ends | {"quantity": "plateau"}
        return
    late = late_bins(rate, [row for row in case if row["quantity"] == "hazard"])
    found = {"quantity": "falling" if is_drifted(rate) else "falling_without_drift"}
    if late:
        hazard, error = late_hazard(late)
        ends = {"first": late[0]["first"], "last": late[-1]["last"]}
        ends["count"] = sum(row["count"] for row in late)
        found |= ends | {"estimate": hazard, "stderr": error}
        if hazard < FALLEN * rate["estimate"]:
            ratio = {"quantity": "over_cubic", "estimate": over_cubic(late)}
            yield start | ends | ratio
    yield start | found


def shapes(rows):
    """Yield the rows on the shapes of all hazards in ``rows`` of distributions.csv."""
    cases = {}
    for row in rows:
        cases.setdefault(tuple(row[name] for name in CASE), []).append(row)
    for case in cases.values():
        yield from shape(case)
