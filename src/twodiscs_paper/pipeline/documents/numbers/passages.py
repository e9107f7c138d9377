"""Which hops are passages, and what diffuses by them."""

import math

from twodiscs.comparison.estimates import LinearFit
from twodiscs.comparison.measured.transmission import QUIET
from twodiscs_paper.pipeline.documents.numbers.agreement import scores
from twodiscs_paper.pipeline.documents.numbers.rounding import (
    Number,
    at_most,
    in_words,
    significant,
    span,
    whole,
    with_error,
)

#: A power law is fitted to so many distances, each half of the one before: four octaves.
LAST = 5

#: Moments of inertia, in units of mr², by what the manuscript calls them; one half are solid discs.
HALF = 0.5
INERTIAS = {"one": 1.0, "half": HALF, "quarter": 0.25, "tenth": 0.1}


def _power_of_two(distance):
    return Number(distance, f"$2^({round(math.log2(distance))})$")


def _estimate(row):
    return with_error(row["estimate"], row["stderr"])


def _slope(rows, value):
    """Return the power of the distance that ``value`` of κ has over the last of ``rows``."""
    rows = sorted(rows, key=lambda row: -row["distance"])[-LAST:]
    if len(rows) < 2:
        return None
    fit = LinearFit(
        [math.log(row["distance"]) for row in rows],
        [math.log(value(row["estimate"])) for row in rows],
        [row["stderr"] / value(row["estimate"]) for row in rows],
    )
    return with_error(fit.slope.value, fit.slope.stderr)


def passages(rows, scene):
    """Return {name: ``Number``} on passages; ``rows`` are those of passages.csv.

    They are about the hop of the ``scene`` that is blocked first, on two walls and on a ring, and
    about the lattice.
    """
    judged = [row for row in rows if row["z"] is not None]
    numbers = {"passages": whole(len(judged)), "passages_largest": at_most(scores(judged))}
    boxed = [row for row in rows if row["scene"] == scene]
    if not boxed:
        return numbers
    hop = min(boxed, key=lambda row: row["radius"] / (1 - row["distance"]))["event"]

    def of(quantity, inertia=None, method=None):
        rows_of_hop = [
            row
            for row in boxed
            if (row["event"], row["quantity"]) == (hop, quantity)
            and row["moment_of_inertia"] == inertia
            and method in (None, row["method"])
        ]
        return sorted(rows_of_hop, key=lambda row: -row["distance"])

    smooth = of("coefficient")
    if smooth:
        first, last = smooth[0], smooth[-1]
        numbers |= {
            "passages_pause": whole(QUIET),
            "passages_first_distance": _power_of_two(first["distance"]),
            "passages_last_distance": _power_of_two(last["distance"]),
            "passages_first": _estimate(first),
            "passages_last": _estimate(last),
            "passages_exponent": _slope(smooth, lambda kappa: 1 - kappa),
        }
    for name, inertia in INERTIAS.items():
        rough = of("coefficient", inertia)
        if rough:
            numbers |= {
                f"passages_rough_{name}": _slope(rough, lambda kappa: kappa),
                "passages_rough_distance": _power_of_two(rough[-1]["distance"]),
            }
    for row in of("passage_exponent", HALF):
        numbers["passages_rough_half_power"] = _estimate(row)
    for name, inertia in (("smooth", None), ("rough", HALF)):
        ring = of("diffusion", inertia, "hops")
        if ring:
            numbers |= {
                f"passages_ring_{name}_first": _estimate(ring[0]),
                f"passages_ring_{name}_last": _estimate(ring[-1]),
                "passages_ring_first_distance": _power_of_two(ring[0]["distance"]),
                "passages_ring_last_distance": _power_of_two(ring[-1]["distance"]),
            }
    files = [r for r in boxed if r["quantity"] == "diffusion" and (r["discs"] or 0) > 2]
    if files:
        numbers |= {
            "passages_files": span([row["estimate"] for row in files]),
            "passages_files_error": at_most([row["stderr"] for row in files], 1),
            "passages_files_discs": Number(
                None, " and ".join(in_words(n).text for n in sorted({r["discs"] for r in files}))
            ),
        }
        rates = [row["estimate"] for row in boxed if row["quantity"] == "rate" and row["discs"] > 2]
        numbers["passages_files_rates"] = significant(max(rates) / min(rates), 2)
    for row in rows:
        if row["method"] == "lattice" and row["quantity"] == "single_file":
            numbers["passages_single_file"] = _estimate(row)
        if row["method"] == "lattice" and row["quantity"] == "diffusion":
            numbers.setdefault("passages_lattice_first", _estimate(row))
            numbers["passages_lattice_last"] = _estimate(row)
            numbers["passages_lattice_swap"] = significant(row["swap"], 2)
    return numbers
