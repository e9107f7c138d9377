"""What the check tables of all scenes say together, and the scores z in the tables of studies.

python -m twodiscs_paper.pipeline.results.verdict results/paper/check.csv … --output check.passed
"""

import sys
from pathlib import Path

from twodiscs.arguments import Parser, run
from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs_paper.catalogue import STUDY_TABLES

#: What names a row of a study, as far as its table has these columns.
NAMES = (
    "scene", "discs", "event", "quantity", "method", "moment_of_inertia", "swap", "radius", "time",
)  # fmt: skip


def failure(scene, row):
    """Return the sentence on a comparison that failed, naming quantity and radius."""
    where = "over all radii" if row["radius"] is None else f"at radius {row['radius']!r}"
    return (
        f"{scene}: {row['comparison']} of {row['quantity']} {where} by {row['method']} has "
        f"z = {row['z']:.3g}, beyond the bound {row['bound']:.3g}"
    )


def summary(scene, rows):
    """Return the sentence on a scene that passed, with how much of it says little."""
    tested = [row for row in rows if row["passed"] is not None]
    tests = sum(row["independent"] for row in tested)
    few = sum(row["status"] in ("too-few", "none-seen") for row in tested)
    largest = max((abs(row["z"]) for row in tested), default=0.0)
    return (
        f"{scene}: {len(tested)} comparisons passed, {tests} of them tests, "
        f"largest |z| {largest:.3g}; {few} had too few events for an error, "
        f"{len(rows) - len(tested)} more could not be compared"
    )


def study_failure(study, row):
    """Return the sentence on a comparison of a study that failed, naming its row."""
    named = ", ".join(f"{name} {row[name]}" for name in NAMES if row.get(name) is not None)
    return f"{study}: {named} has z = {row['z']:.3g}, beyond the bound {row['bound']:.3g}"


def study_summary(study, rows):
    """Return the sentence on a study that passed."""
    tested = [abs(row["z"]) for row in rows if row["z"] is not None]
    largest = max(tested, default=0.0)
    return f"{study}: {len(tested)} comparisons passed, largest |z| {largest:.3g}"


def verdict(tables, studies):
    """Return (failures, text that sums up) of tables, each {name: rows}.

    ``tables`` are the check tables of scenes. ``studies`` have scores z without verdicts: each
    study fails by chance as seldom as a scene does, by Bonferroni's bound.
    """
    from twodiscs.comparison import check, scores  # which need numpy and scipy

    studies = {name: check.judged(rows, scores.FALSE_ALARM) for name, rows in studies.items()}
    failures = [
        sentence(name, row)
        for sentence, judgements in ((failure, tables), (study_failure, studies))
        for name, rows in judgements.items()
        for row in rows
        if row.get("passed") is False
    ]
    lines = [summary(scene, rows) for scene, rows in tables.items()]
    lines += [study_summary(study, rows) for study, rows in studies.items()]
    return failures, "".join(f"{line}\n" for line in lines)


def main():
    parser = Parser(prog=__spec__.name, description=__doc__.split("\n")[0])
    parser.add_argument("tables", nargs="*", type=Path, metavar="CSV", help="check.csv of scenes")
    parser.add_argument(
        "--studies", nargs="*", default=[], type=Path, metavar="CSV", help="tables with scores z"
    )
    parser.add_argument("--output", required=True, type=Path, metavar="FILE")
    options = parser.parse_args()
    tables = {path.parent.name: SCENE_TABLES["check"].read(path) for path in options.tables}
    studies = {path.stem: STUDY_TABLES[path.stem].read(path) for path in options.studies}
    failures, text = verdict(tables, studies)
    if failures:
        print("\n".join(failures), file=sys.stderr)
        return 1
    print(text, end="")
    options.output.write_text(text, encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    run(main)
