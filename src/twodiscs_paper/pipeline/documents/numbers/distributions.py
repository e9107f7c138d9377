"""How the times are distributed: intervals of chains, tails, and hazards."""

import math
from itertools import pairwise

from scipy.special import gammaincc

from twodiscs.comparison.estimates import density_of_chains_at_zero
from twodiscs_paper.pipeline.documents.numbers.agreement import scores
from twodiscs_paper.pipeline.documents.numbers.rounding import (
    Number,
    at_least,
    at_most,
    sides,
    significant,
    span,
    whole,
    with_error,
)

#: A hazard is constant for all that is seen where the chances of its χ² and trend exceed this.
LEVEL = 1e-3
#: A hazard whose late value is below this fraction of the fitted rate is compared with 3/t.
FALLEN = 0.75
#: Bins of fewer intervals say nothing of how errors of chains differ from those of counts.
WELL_FILLED = 1000


def chains(histogram):
    """Return by how much errors of bins exceed those of independent counts, at most and at least 1.

    ``histogram`` are rows of hop_histogram.csv.
    """
    factors = [1.0]
    for row in histogram:
        if row["count"] >= WELL_FILLED:
            fraction = row["count"] / row["intervals"]
            independent = math.sqrt(fraction * (1 - fraction) / row["intervals"])
            factors.append(row["stderr"] * (row["right"] - row["left"]) / independent)
    return {"chain_factor": at_most(factors)}


def densities(rows, histogram):
    """Return how well densities at zero agree, and what chains say where they agree least.

    ``rows`` are those of distributions.csv, ``histogram`` those of hop_histogram.csv: intervals of
    their own. Their density at zero is that of a parabola p(0) − at² through the first two bins.
    """
    compared = [
        row for row in rows if row["quantity"] == "density_at_zero" and row["z"] is not None
    ]
    scored = sorted(scores(compared))
    numbers = {
        "densities": whole(len(scored)),
        "densities_largest": at_most(scored),
        "densities_others": at_most(scored[:-1]),
    }
    for row in [row for row in compared if abs(row["z"]) == scored[-1]][:1]:
        same = {name: row[name] for name in ("scene", "event", "radius")} | {"bins": "equal"}
        bins = [other for other in histogram if same.items() <= other.items()][:2]
        numbers |= {
            "odd_density": with_error(row["estimate"], row["stderr"]),
            "odd_density_exact": significant(row["reference"], 5),
            "odd_density_box": sides(row["width"], row["height"]),
            "odd_density_radius": Number(row["radius"], repr(row["radius"])),
        }
        if len(bins) == 2:
            numbers["odd_density_chains"] = with_error(
                *density_of_chains_at_zero(
                    [row["density"] for row in bins], [row["stderr"] for row in bins]
                )
            )
    return numbers


def tails(rows):
    """Return the last well measured ratio to the law of each tail, and the fitted rate of decay.

    ``rows`` are those of tails.csv. Well measured is what has an error below a fifth.
    """
    numbers = {}
    for name, event in (("collisions", "disc_collision"), ("hops", "vertical_hop")):
        measured = [
            row
            for row in rows
            if row["event"] == event
            and row["method"] == "weighted"
            and row["law"] is not None
            and row["stderr"] is not None
            and row["stderr"] < 0.2 * row["estimate"]
        ]
        if measured:
            row = measured[-1]
            numbers |= {
                f"tail_{name}_ratio": with_error(
                    row["estimate"] / row["law"], row["stderr"] / row["law"]
                ),
                f"tail_{name}_time": significant(row["time"] / row["exact_mean"], 2),
                f"tail_{name}_probability": significant(row["estimate"], 2),
                f"tail_{name}_radius": significant(row["radius"], 3),
            }
            if name == "hops":  # a ratio of 1 + c (t/τ)^(−1/2)
                root = math.sqrt(row["time"] / row["exact_mean"])
                excess, error = row["estimate"] / row["law"] - 1, row["stderr"] / row["law"]
                numbers["tail_hops_approach"] = with_error(excess * root, error * root)
    for row in [row for row in rows if row["quantity"] == "rate"][:1]:
        mean = row["exact_mean"]
        numbers |= {
            "decay_rate": with_error(row["estimate"] * mean, row["stderr"] * mean),
            "decay_radius": significant(row["radius"], 3),
            "decay_first": significant(row["time"] / mean, 2),
            "decay_last": significant(row["until"] / mean, 2),
        }
        within = [
            other
            for other in rows
            if (other["event"], other["radius"]) == (row["event"], row["radius"])
            and (other["quantity"], other["method"]) == ("survival", "counted")
            and row["time"] * (1 - 1e-9) <= other["time"] <= row["until"] * (1 + 1e-9)
            and other["stderr"] is not None
        ]
        numbers |= constant_hazard(within)
    return numbers


def constant_hazard(rows):
    """Return the χ² of one hazard between the times of ``rows``, which ascend, and its chance.

    Intervals longer than the next time are among those longer than this one, so that what is lost
    in between has the difference of their relative variances.
    """
    hazards, weights = [], []
    for row, later in pairwise(rows):
        time = later["time"] - row["time"]
        hazards.append(math.log(row["estimate"] / later["estimate"]) / time)
        relative = [(r["stderr"] / r["estimate"]) ** 2 for r in (later, row)]
        weights.append(time**2 / (relative[0] - relative[1]))
    if len(hazards) < 2:
        return {}
    mean = sum(w * h for w, h in zip(weights, hazards, strict=True)) / sum(weights)
    chi2 = sum(w * (h - mean) ** 2 for w, h in zip(weights, hazards, strict=True))
    return {
        "decay_chi2": significant(chi2, 3),
        "decay_degrees": whole(len(hazards) - 1),
        "decay_chance": significant(float(gammaincc((len(hazards) - 1) / 2, chi2 / 2)), 2),
    }


class Hazards:
    """The rows of distributions.csv by scene, event, radius and quantity."""

    def __init__(self, rows):
        self.rows = rows

    def of(self, case, quantity):
        """Return the rows of a ``quantity`` where ``case``, another row, belongs."""
        same = {name: case[name] for name in ("scene", "event", "radius")} | {"quantity": quantity}
        return [row for row in self.rows if same.items() <= row.items()]

    def first(self, case, quantity):
        """Return the first of these rows, None if there is none."""
        return next(iter(self.of(case, quantity)), None)

    def rates(self, **of):
        """Return the fitted rates of the cases that are so."""
        return [row for row in self.rows if {**of, "quantity": "rate"}.items() <= row.items()]

    def is_plateau(self, rate):
        """Say whether the hazard that ``rate`` was fitted to is constant for all that is seen."""
        trend = self.first(rate, "trend")
        return rate["p"] > LEVEL and (trend is None or trend["p"] > LEVEL)

    def late(self, rate):
        """Return (first, last, hops, time at risk) of the bins in the last two fifths of the time
        that the data reach, those with a hop."""
        return [
            (row["first"], row["last"], row["count"], row["count"] / row["estimate"])
            for row in self.of(rate, "hazard")
            if row["first"] >= 0.6 * rate["last"] and row["count"] > 0
        ]

    def over_cubic(self, rate):
        """Return late hops over those expected if the hazard were the 3/t of a cubic tail."""
        late = self.late(rate)
        expected = sum(6 * risk / (first + last) for first, last, _, risk in late)
        return sum(hops for _, _, hops, _ in late) / expected if late else None

    def has_fallen(self, rate):
        """Say whether the late hazard is less than three quarters of the fitted rate."""
        late = self.late_hazard(rate)
        return late is not None and late[0] < FALLEN * rate["estimate"] * rate["exact_mean"]

    def late_hazard(self, rate):
        """Return the late hazard in units of 1/τ, with its error, first and last time over τ."""
        late, mean = self.late(rate), rate["exact_mean"]
        if not late:
            return None
        hops = sum(bin[2] for bin in late)
        hazard = mean * hops / sum(bin[3] for bin in late)
        return hazard, hazard / math.sqrt(hops), late[0][0] / mean, late[-1][1] / mean


def _cases(rates):
    """Return the sentence on which hops and radii these are."""
    parts = []
    for event in ("vertical_hop", "horizontal_hop"):
        radii = [significant(row["radius"], 5).text for row in rates if row["event"] == event]
        if radii:
            parts.append(f"{event.replace('_', ' ')}s at $r =$ {', '.join(radii)}")
    return Number(None, "; ".join(parts)) if parts else None


def hazards(rows, scene):
    """Return what is said of hazards in the first ``scene``, its name, and elsewhere."""
    data = Hazards(rows)
    rates = data.rates(scene=scene)
    plateaus = [rate for rate in rates if data.is_plateau(rate)]
    falling = [rate for rate in rates if not data.is_plateau(rate)]
    passages = [row for row in rows if row["scene"] == scene and row["quantity"] == "first_passage"]
    fallen = [rate for rate in falling if data.has_fallen(rate)]
    numbers = {
        "hazards": whole(len(rates)),
        "plateaus": whole(len(plateaus)),
        "plateau_cases": _cases(plateaus),
        "plateau_rates": span([rate["estimate"] * rate["exact_mean"] for rate in plateaus]),
        "rates_nearest": at_least(scores(rates)),
        "falling_cases": _cases(falling),
        "fallen_cases": _cases(fallen),
        "over_cubic": span([data.over_cubic(rate) for rate in fallen]),
        "first_passage_largest": at_most(scores(passages)),
    }
    # Hazards that are not constant although no drift avoids the hop.
    others = [
        rate
        for rate in data.rates(event="vertical_hop")
        if rate["scene"] != scene
        and rate["radius"] > rate["height"] / 4
        and not data.is_plateau(rate)
    ]
    for rate in others[-1:]:
        numbers |= {
            "elsewhere_box": sides(rate["width"], rate["height"]),
            "elsewhere_radius": Number(rate["radius"], repr(rate["radius"])),
        }
        if late := data.late_hazard(rate):
            hazard, error, first, last = late
            numbers |= {
                "elsewhere_hazard": with_error(hazard, error),
                "elsewhere_first": significant(first, 2),
                "elsewhere_last": significant(last, 2),
            }
    return numbers


def rates_table(rows, scene):
    """Return the cells of the table of rates, {column: ``Number``} for each hop and radius."""
    data, cells = Hazards(rows), {}

    def estimate(row, power):
        if row is None:
            return None
        scale = row["exact_mean"] ** power
        return with_error(row["estimate"] * scale, row["stderr"] * scale)

    def chance(row):
        if row is None:
            return None
        return significant(row["p"], 1) if row["p"] > LEVEL else Number(row["p"], "$0$")

    for case in rows:
        if case["scene"] == scene and case["quantity"] == "mean":
            rate = data.first(case, "rate")
            uncut = [row for row in data.of(case, "first_passage") if row["last"] is None]
            cells[f"{case['event']}_{case['radius']}"] = {
                "hop": Number(None, case["event"][0]),
                "radius": Number(case["radius"], repr(case["radius"])),
                "density": estimate(data.first(case, "density_at_zero"), 1),
                "rate": estimate(rate, 1),
                "reach": rate and significant(rate["last"] / rate["exact_mean"], 2),
                "chi2": chance(rate),
                "trend": chance(data.first(case, "trend")),
                "squared_cv": estimate(data.first(case, "squared_cv"), 0),
                "first_passage": estimate(next(iter(uncut), None), -1),
            }
    return cells
