"""More than two discs: how theory, Monte Carlo and dynamics agree."""

from twodiscs.model.events import SHELLS
from twodiscs_paper.pipeline.documents.numbers.agreement import scores
from twodiscs_paper.pipeline.documents.numbers.rounding import (
    Number,
    at_most,
    significant,
    whole,
    with_error,
)


def more_discs(rows):
    """Return {name: ``Number``} on more than two discs; ``rows`` are those of more_discs.csv."""
    judged = [row for row in rows if row["z"] is not None]
    exact = [row for row in judged if row["exact"] is not None and row["event"] != "virial"]
    sums = [row for row in judged if row["event"] == "virial"]
    numbers = {
        "more_discs": whole(len(judged)),
        "more_discs_exact": whole(len(exact)),
        "more_discs_sums": whole(len(sums)),
        "more_discs_largest": at_most(scores(judged)),
    }
    if judged:
        row = max(judged, key=lambda row: row["discs"])
        numbers["more_discs_most"] = whole(row["discs"])
        numbers["more_discs_width"] = significant(row["width"] / row["discs"], 3)
    return numbers


def _cell(row):
    if row is None or row["dynamics"] is None:
        return None
    if row["exact"] is not None:
        return significant(row["exact"], 5)
    return with_error(row["dynamics"], row["dynamics_stderr"])


def more_discs_table(rows):
    """Return the cells of the table of mean times, {column: ``Number``} for each box and radius.

    Times are exact where a theory is known, and those of the dynamics with their errors elsewhere.
    """
    gases = {}
    for row in rows:
        gases.setdefault((row["radius"], row["discs"]), {})[row["event"]] = row
    cells = {}
    for i, ((radius, discs), times) in enumerate(sorted(gases.items())):
        some = next(iter(times.values()))
        cells[f"{i:02}"] = {
            "radius": significant(radius, 3),
            "discs": whole(discs),
            "theory": Number(None, some["theory"].replace("none", "--")),
            **{event: _cell(times.get(event)) for event in SHELLS},
            "largest": at_most(scores(row for row in times.values() if row["z"] is not None)),
        }
    return cells
