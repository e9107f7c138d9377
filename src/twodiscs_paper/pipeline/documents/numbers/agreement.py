"""How simulations agree with the exact theory, and what they took: numbers of all boxes."""

import math
import statistics

from twodiscs_paper.pipeline.documents.numbers.rounding import (
    Number,
    at_least,
    at_most,
    in_words,
    sides,
    significant,
    span,
    whole,
)


def compared(check):
    """Return the rows of check.csv that have a verdict."""
    return [row for row in check if row["passed"] is not None]


def tests(check):
    """Return the rows of check.csv that could fail and follow from no other."""
    return [row for row in compared(check) if row["independent"]]


def scores(rows, *methods):
    """Return all |z| of ``rows``, of these ``methods`` if any are named."""
    return [
        abs(row["z"])
        for row in rows
        if row["z"] is not None and (not methods or row["method"] in methods)
    ]


def agreement(tables, scenes):
    """Return {name: ``Number``} on how all scenes agree with the theory."""
    check = tables["check"]
    unseen = sum(row["status"] == "none-seen" for row in tests(check))
    of_name = {
        name: [row for row in compared(check) if row["comparison"] == name]
        for name in ("sum_rule", "mean_time")
    }
    return {
        "scenes": in_words(len(scenes)),
        "radii": whole(len(tables["grid"])),
        "comparisons": whole(len(compared(check))),
        "tests": whole(len(tests(check))),
        "tests_largest": at_most(scores(tests(check))),
        "tests_none_seen": whole(unseen) if unseen else None,
        "bounds": span([row["bound"] for row in tests(check) if row["bound"] is not None], 3),
        "sum_rule_radii": whole(len(of_name["sum_rule"])),
        "sum_rule_largest": at_most(scores(of_name["sum_rule"])),
        "mean_time_largest": at_most(scores(of_name["mean_time"])),
        "monte_carlo_largest": at_most(scores(check, "monte_carlo", "conditioned")),
    }


def correlation(rows, first, second):
    """Return Pearson's correlation of the scores z of two mean times over the radii of all scenes.

    ``rows`` are tests of mean times by the dynamics; None if fewer than three radii have both.
    """
    z = {(row["scene"], row["radius"], row["quantity"]): row["z"] for row in rows}
    pairs = [
        (value, z[scene, radius, f"{second}_time"])
        for (scene, radius, quantity), value in z.items()
        if quantity == f"{first}_time" and (scene, radius, f"{second}_time") in z
    ]
    return statistics.correlation(*zip(*pairs, strict=True)) if len(pairs) > 2 else None


def correlations(check):
    """Return {name: ``Number``} on what tests share: those of the dynamics with a normal law."""
    rows = [
        row
        for row in tests(check)
        if (row["comparison"], row["method"], row["test"]) == ("mean_time", "dynamics", "normal")
    ]
    if not rows:
        return {}
    mean_square = statistics.fmean(row["z"] ** 2 for row in rows)
    walls = correlation(rows, "right_wall", "top_wall")
    hops = correlation(rows, "vertical_hop", "disc_collision")
    return {
        "dynamics_tests": whole(len(rows)),
        "dynamics_mean_square": significant(mean_square, 2),
        # Of as many independent squares of standard normal deviates.
        "dynamics_spread": significant(math.sqrt(2 / len(rows)), 1),
        "correlation_walls": None if walls is None else significant(walls, 2),
        "correlation_hops": None if hops is None else significant(hops, 2),
    }


def mean_scores(check, scenes):
    """Return {name: ``Number``} on the largest mean score of a quantity over the radii of a box."""
    rows = [row for row in check if row["comparison"] == "z_mean"]
    if not rows:
        return {}
    row = max(rows, key=lambda row: abs(row["z"]))
    scene = next(scene for scene in scenes if scene["name"] == row["scene"])
    return {
        "mean_scores": whole(len(rows)),
        "mean_scores_largest": at_most([abs(row["z"])]),
        "mean_scores_quantity": Number(None, row["quantity"].replace("_", " ")),
        "mean_scores_box": sides(scene["width"], scene["height"]),
    }


def events(cost, stage):
    """Return the events of a stage in all rows of cost.csv."""
    return sum(row["events"] for row in cost if row["stage"] == stage)


def effort(tables):
    """Return {name: ``Number``} on what was sampled and simulated."""

    def column(table, name, **of):
        rows = [row for row in tables[table] if of.items() <= row.items()]
        return [row[name] for row in rows if row[name] is not None]

    strips = column("mean_times", "exact", starts="strip")
    return {
        "configurations": significant(events(tables["cost"], "monte_carlo"), 2),
        "samples": span(column("volume", "samples")),
        "epsilon": span(column("areas", "epsilon")),
        "events": significant(events(tables["cost"], "dynamics"), 2),
        "duration": span(column("mean_times", "duration", starts="invariant"), 3),
        "replicas": span(column("mean_times", "replicas", starts="invariant")),
        "target": span(column("mean_times", "target")),
        "strips": in_words(len(strips)) if strips else None,
        "strips_longest": significant(max(strips), 2) if strips else None,
    }


def long_run(rows):
    """Return {name: ``Number``} on the long run; ``rows`` are those of its mean_times.csv."""
    if not rows:
        return {}
    count = {row["event"]: row["count"] for row in rows}
    rare = max(rows, key=lambda row: row["exact"])
    return {
        "long_run_events": significant(float(count["any_wall"] + count["disc_collision"]), 2),
        "long_run_radius": Number(rows[0]["radius"], repr(rows[0]["radius"])),
        "long_run_error": at_least([row["relative_stderr"] for row in rows], 1),
        "long_run_rare": significant(rare["exact"], 2),
        "long_run_rare_error": at_most([rare["relative_stderr"]], 1),
        "long_run_largest": at_most(scores(rows)),
    }


def agreement_table(tables, scenes):
    """Return the cells of the table of agreement, {column: ``Number``} for each scene."""
    rows = {}
    for scene in scenes:
        name = scene["name"]
        check, grid, cost = (
            [row for row in tables[table] if row["scene"] == name]
            for table in ("check", "grid", "cost")
        )
        if check:
            rows[name] = {
                "box": sides(scene["width"], scene["height"]),
                "radii": whole(len(grid)),
                "events": significant(events(cost, "dynamics"), 2),
                "comparisons": whole(len(compared(check))),
                "tests": whole(len(tests(check))),
                "failed": whole(sum(not row["passed"] for row in compared(check))),
                "largest": at_most(scores(check)),
            }
    return rows
