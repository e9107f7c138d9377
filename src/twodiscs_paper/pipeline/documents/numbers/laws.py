"""Power laws at thresholds, effects, and the corrections to the first solution."""

import re
from itertools import groupby

from twodiscs.comparison.estimates import sums_of_others
from twodiscs_paper.pipeline.documents.numbers.agreement import scores, tests
from twodiscs_paper.pipeline.documents.numbers.rounding import (
    Number,
    at_most,
    in_words,
    plain,
    significant,
    whole,
    with_error,
)

#: Words that a narrow table cuts in the names of events.
SHORT = {"vertical": "v.", "horizontal": "h.", "collision": "coll."}


def _mean_times(rows, scene):
    return [row for row in rows if row["scene"] == scene and row["quantity"] == "mean_time"]


def _is_from_strips(fit, times):
    """Say whether all mean times that a ``fit`` is of come from starts in strips."""
    if fit["farthest"] is None or fit["limit_radius"] is None:
        return False
    least = fit["limit_radius"] - fit["farthest"] * (1 + 1e-9)
    fitted = [
        row["starts"]
        for row in times
        if row["event"] == fit["event"] and least <= row["radius"] < fit["limit_radius"]
    ]
    return {*fitted} == {"strip"}


def powers(rows, scene, times):
    """Return {name: ``Number``} on fitted power laws of a scene.

    ``rows`` are those of thresholds.csv, and ``times`` those of mean_times.csv.
    """
    rows = _mean_times(rows, scene)
    times = [row for row in times if row["scene"] == scene]
    reduced = scores([row for row in rows if row["form"] == "reduced"])
    numbers = {"reduced_largest": at_most(reduced)}
    in_strips = [
        f"{row['event'].replace('_', ' ')}s"
        for row in rows
        if (row["form"], row["parameter"]) == ("plain", "exponent") and _is_from_strips(row, times)
    ]
    if in_strips:
        numbers["strip_powers"] = Number(None, " and ".join(in_strips))
    for row in rows:
        if (row["form"], row["parameter"]) == ("plain", "exponent"):
            event = row["event"].removesuffix("_hop")
            numbers[f"{event}_exponent"] = significant(row["estimate"], 3)
            if row["farthest"] is not None and row["limit_radius"] is not None:
                reach = 100 * row["farthest"] / row["limit_radius"]
                numbers[f"{event}_reach"] = significant(reach, 2)
    return numbers


def powers_table(rows, scene, check):
    """Return the cells of the table of power laws, {column: ``Number``} for each event.

    An event whose mean times are no tests of their own, in the rows ``check`` of check.csv, is left
    out, for its fit follows from those of others.
    """
    tested = {row["quantity"] for row in tests(check) if row["scene"] == scene}
    rows = {
        (row["event"], row["form"], row["parameter"]): row
        for row in _mean_times(rows, scene)
        if f"{row['event']}_time" in tested
    }

    def cell(event, form, parameter):
        row = rows[event, form, parameter]
        scale = 1 / row["law"] if parameter == "coefficient" else 1
        return with_error(row["estimate"] * scale, row["stderr"] * scale)

    return {
        event: {
            "event": Number(None, " ".join(SHORT.get(word, word) for word in event.split("_"))),
            "points": whole(rows[event, "plain", "exponent"]["points"]),
            "plain": cell(event, "plain", "exponent"),
            "curve": significant(rows[event, "plain", "exponent"]["curve"], 5),
            "reduced": cell(event, "reduced", "exponent"),
            "coefficient": cell(event, "reduced", "coefficient"),
        }
        for event in dict.fromkeys(event for event, _, _ in rows)
    }


def _not_sums(rows):
    """Return those rows of mean times whose count is not the sum of others' counts."""
    kept = []
    for _, some in groupby(rows, key=lambda row: (row["scene"], row["radius"])):
        of_event = {row["quantity"].removesuffix("_time"): row for row in some}
        summed = sums_of_others(
            {e: row["count"] for e, row in of_event.items() if row["starts"] == "invariant"}
        )
        kept += [row for event, row in of_event.items() if event not in summed]
    return kept


def effects(rows):
    """Return {name: ``Number``} on what effects do; ``rows`` are those of effects.csv."""
    shares = [
        row for row in rows if row["quantity"] == "never_met_share" and row["estimate"] is not None
    ]
    times = [row for row in rows if row["quantity"] != "never_met_share"]
    judged = _not_sums(row for row in times if row["z"] is not None)
    numbers = {
        "effects": whole(sum(row["status"] != "impossible" for row in judged)),
        "effect_scenes": in_words(len({row["scene"] for row in times})),
        "effects_largest": at_most(scores(judged)),
    }
    rough = [row for row in shares if "inertia" in row["effects"]]
    if rough:
        worst = max(rough, key=lambda row: (row["duration"], row["estimate"]))
        numbers |= {
            "never_met_rough": significant(worst["estimate"], 2),
            "never_met_time": significant(worst["duration"], 2),
            "never_met_radius": Number(worst["radius"], repr(worst["radius"])),
        }
        same = ("radius", "duration")
        for row in shares:
            if row not in rough and all(row[name] == worst[name] for name in same):
                text = f"a share of {significant(row['estimate'], 1).text}"
                numbers.setdefault("never_met_smooth", Number(row["estimate"], text))
        numbers.setdefault("never_met_smooth", Number(0.0, "none"))
    return numbers


def errata(rows):
    """Return {name: ``Number``} on the first solution; ``rows`` are those of errata.csv."""
    return {
        "statements": whole(len(rows)),
        "statements_right": whole(sum(row["verdict"] == "right" for row in rows)),
        "statements_major": whole(sum(row["severity"] == "major" for row in rows)),
    }


def errata_table(rows):
    """Return the cells of the table of corrections, {column: ``Number``} for each."""
    cells = {}
    for i, row in enumerate(rows):
        if row["verdict"] != "right":
            in_range = "" if row["verdict"] == "wrong" else ", in range"
            methods = [
                letter
                for method, letter in (("Monte Carlo", "C"), ("dynamics", "D"))
                if method in row["decided_by"]
            ]
            ratio = None
            if row["ratio"] is not None:
                ratio = significant(row["ratio"], 3)
                if row["radius"] is not None:
                    at = significant(row["radius"], 3).text
                    ratio = Number(ratio.value, f"{ratio.text} at {at}")
            cells[f"{i:02}"] = {
                "number": Number(None, plain(row["number"] or "")),
                "label": Number(None, plain(row["label"] or "")),
                "section": Number(None, plain(row["place"] or "")),
                "severity": Number(None, f"{row['severity']}{in_range}"),
                "ratio": ratio,
                "by": Number(None, " ".join(methods)) if methods else None,
                "right": Number(None, formulas(row["correction"] or "")),
            }
    return cells


def formulas(text):
    """Return a correction as markup: between its backticks is mathematics, as in plain text."""
    parts = text.split("`")
    parts[::2] = [plain(part) for part in parts[::2]]
    parts[1::2] = [_formula(part) for part in parts[1::2]]
    return "".join(parts)


def _formula(text):
    text = text.replace("−", "-")
    text = re.sub(r"√(\d)", r" sqrt(\1)", text).replace("√", " sqrt")
    text = re.sub("[²³⁴]", lambda match: "^" + str("  ²³⁴".index(match[0])), text)

    def letters(match):
        word = match[0]
        return word if word in ("sqrt", "arcsin", "min", "max") else f" {' '.join(word)} "

    text = re.sub("[A-Za-z]+", letters, text).replace(" _", "_")
    text = re.sub(r" *([‖|]) *", r"\1", text).replace("/", r"\/")
    return f"${text.strip()}$"
