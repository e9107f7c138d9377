"""The verdict on the check tables of all scenes: do theory, Monte Carlo and dynamics agree?

    python -m twodiscs.cli.check results/paper/check.csv … --output results/check.passed

Writes a summary, a line a scene, and exits with 0 if every comparison passed. Otherwise it writes
nothing, prints one line for each failure on standard error and exits with 1.
"""

import sys
from pathlib import Path

from twodiscs import tables
from twodiscs.cli import arguments


def _name(path):
    """Return the name of the scene, which is that of the folder."""
    return Path(path).resolve().parent.name


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
    few = sum(row["status"] in ("too-few", "none-seen") for row in tested)
    largest = max((abs(row["z"]) for row in tested), default=0.0)
    return (
        f"{scene}: {len(tested)} comparisons passed, largest |z| {largest:.3g}; {few} of them had "
        f"too few events for an error, {len(rows) - len(tested)} more could not be compared"
    )


def main():
    parser = arguments.Parser(prog="twodiscs.cli.check", description="Judge the check tables.")
    parser.add_argument("tables", nargs="+", metavar="CSV")
    parser.add_argument("--output", required=True, metavar="FILE")
    options = parser.parse_args()

    failures, summaries = [], []
    for path in options.tables:
        rows = tables.read(path, "check")
        failures += [failure(_name(path), row) for row in rows if row["passed"] is False]
        summaries.append(summary(_name(path), rows))
    if failures:
        print("\n".join(failures), file=sys.stderr)
        return 1
    text = "\n".join(summaries) + "\n"
    print(text, end="")
    Path(options.output).write_text(text, encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    arguments.run(main)
