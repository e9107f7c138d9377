"""What the check tables of all scenes say together.

python -m twodiscs.pipeline.results.verdict results/paper/check.csv … --output check.passed
"""

import sys
from pathlib import Path

from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.pipeline.arguments import Parser, run


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


def verdict(tables):
    """Return (failures, text that sums up) of the check tables of scenes, {scene: rows}."""
    failures = [
        failure(scene, row)
        for scene, rows in tables.items()
        for row in rows
        if row["passed"] is False
    ]
    return failures, "".join(f"{summary(scene, rows)}\n" for scene, rows in tables.items())


def main():
    parser = Parser(prog="twodiscs.pipeline.results.verdict", description=__doc__.split("\n")[0])
    parser.add_argument("tables", nargs="*", type=Path, metavar="CSV", help="check.csv of scenes")
    parser.add_argument("--output", required=True, type=Path, metavar="FILE")
    options = parser.parse_args()
    tables = {path.parent.name: SCENE_TABLES["check"].read(path) for path in options.tables}
    failures, text = verdict(tables)
    if failures:
        print("\n".join(failures), file=sys.stderr)
        return 1
    print(text, end="")
    options.output.write_text(text, encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    run(main)
