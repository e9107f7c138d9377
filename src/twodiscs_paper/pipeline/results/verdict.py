"""The verdict: do the scores z of all comparisons agree with theory?"""

from twodiscs.analysis.scores import FALSE_ALARM, bonferroni_bound

#: The columns that name a comparison, as far as its table has them.
NAMES = (
    "comparison", "scene", "discs", "quantity", "event", "method", "moment_of_inertia", "friction",
    "radius", "time",
)  # fmt: skip


def verdict(tables):
    """Return (sentences on the comparisons that fail, a line on each table) of [(name, rows)].

    A row fails if its |z| is over its bound. The rows of a scene have a column ``bound``. In a
    table of a study the bound follows from the number of scores (``bonferroni_bound``). A table
    without a score also fails, and so does a verdict without a table.
    """
    failures, lines = [] if tables else ["nothing is compared"], []
    for name, rows in tables:
        tested = [row for row in rows if row["z"] is not None]
        common = bonferroni_bound(len(tested), FALSE_ALARM) if tested else None
        for row in tested:
            bound = row.get("bound", common)
            if not abs(row["z"]) <= bound:  # which is also true of NaN
                failures.append(
                    f"{name}: {_named(row)} has z = {row['z']:.3g}, beyond the bound {bound:.3g}"
                )
        if tested:
            lines.append(f"{name}: {_summary(rows, tested)}\n")
        else:
            failures.append(f"{name}: nothing is compared")
    return failures, "".join(lines)


def _named(row):
    """Return the name of a comparison for a sentence."""
    return ", ".join(f"{name} {row[name]}" for name in NAMES if row.get(name) is not None)


def _summary(rows, tested):
    """Return how many comparisons there are, and how many of them say little."""
    largest = f"largest |z| {max(abs(row['z']) for row in tested):.3g}"
    if "status" not in tested[0]:
        return f"{len(tested)} comparisons passed, {largest}"
    tests = sum(bool(row["independent"]) for row in tested)
    few = sum(row["status"] in ("too-few", "none-seen") for row in tested)
    less = {
        "had too few events for an error": few,
        "more could not be compared": len(rows) - len(tested),
    }
    notes = [f"{number} {text}" for text, number in less.items() if number]
    passed = f"{len(tested)} comparisons passed, {tests} of them tests, {largest}"
    return "; ".join([passed, *notes])
