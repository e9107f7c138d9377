"""What a digit costs, and where arithmetic has it hard."""

import math
from statistics import median_high

from twodiscs_paper.pipeline.documents.numbers.rounding import (
    Number,
    at_most,
    percent_at_least,
    percent_at_most,
    significant,
    with_error,
)

#: The fitted powers that are quoted: (part, method, quantity) in accuracy_cost.csv.
POWERS = {
    "power_rejection": ("volume", "rejection", "volume"),
    "power_surface": ("area", "surface", "disc_collision_area"),
    "power_balanced_shell": ("area", "balanced_shell", "disc_collision_area"),
    "power_sobol_volume": ("volume", "sobol", "volume"),
    "power_sobol_area": ("area", "sobol", "disc_collision_area"),
    "power_lockstep": ("time", "lockstep", "vertical_hop_time"),
    "power_scalar": ("time", "scalar", "vertical_hop_time"),
}


def _only(rows, **of):
    return [row for row in rows if of.items() <= row.items()]


def pace(rows, method):
    """Return the events a second of a method: the median over its rows of accuracy_cost.csv."""
    paces = [row["work"] / row["seconds"] for row in _only(rows, part="time", method=method)]
    return median_high(paces) if paces else None


def _faster(rows, method, other):
    first, second = pace(rows, method), pace(rows, other)
    return Number(first / second, f"${first / second:.1f}$") if first and second else None


def floors(rows, quantity):
    """Return pairs of a setting and the error that no work removes, settings ascending."""
    floor = _only(rows, part="floor", quantity=quantity)
    return sorted((row["setting"], row["error"]) for row in floor)


def accuracy_cost(rows):
    """Return {name: ``Number``} on the price of a digit; ``rows`` are of accuracy_cost.csv."""
    numbers = {}
    for name, (part, method, quantity) in POWERS.items():
        fitted = _only(rows, part=part, method=method, quantity=quantity)
        for row in [row for row in fitted if row["slope"] is not None][:1]:
            numbers[name] = with_error(row["slope"], row["slope_stderr"])
    for epsilon, error in floors(rows, "disc_collision_area")[-1:]:
        numbers["shell_floor"] = significant(error, 2)
        numbers["shell_epsilon"] = significant(epsilon, 2)
    steps = [
        f"{significant(error, 2).text} at $Delta t =$ {significant(step, 2).text}"
        for step, error in reversed(floors(rows, "vertical_hop_time"))
    ]
    numbers["step_floors"] = Number(None, ", ".join(steps)) if steps else None
    seconds = [row["seconds"] for row in _only(rows, method="exact")]
    numbers["evaluation_seconds"] = significant(max(seconds), 1) if seconds else None
    numbers["lockstep_faster"] = _faster(rows, "lockstep", "scalar")
    numbers["single_faster"] = _faster(rows, "single_precision", "lockstep")
    by_radius = _only(rows, part="radius")
    errors = [row["error"] for row in by_radius if row["error"] is not None]
    numbers["price_error"] = significant(min(errors), 1) if errors else None
    numbers["strip_seconds"] = at_most([r["seconds"] for r in _only(by_radius, method="strip")], 1)
    return numbers


def stability(rows):
    """Return {name: ``Number``} on hard cases; ``rows`` are those of stability.csv."""

    def values(part, *quantities, **of):
        return [
            row["value"]
            for row in _only(rows, part=part, **of)
            if row["value"] is not None
            and math.isfinite(row["value"])
            and (not quantities or row["quantity"] in quantities)
        ]

    runs = [row["count"] for row in _only(rows, part="dynamics")]
    accepted = values("sampling", "accepted_share", method="conditioned")
    return {
        "theory_error": at_most(values("theory", "volume", "areas", "mean_times", method="stable")),
        "accepted_least": percent_at_least(accepted),
        "longest_run": significant(max(runs, default=0), 2),
        "energy_error": at_most(values("dynamics", "energy_error")),
        "overlap": at_most([-gap for gap in values("dynamics", "smallest_gap")]),
        "contact_time": at_most(values("times", "contact_time")),
        "coverage_least": percent_at_least(values("coverage")),
        "coverage_most": percent_at_most(values("coverage")),
    }
