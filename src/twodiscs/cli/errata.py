"""Write errata.csv: which formulas of the source are right, and what decides it.

    python -m twodiscs.cli.errata --scene "{'width': 1.5, 'height': 1.0}" \\
        --table theory=results/paper/theory.csv --table areas=… --output results/errata.csv
"""

from twodiscs import errata, tables
from twodiscs.cli import arguments

#: The tables of use here; each may be missing.
TAKES = ("theory", "volume", "areas", "mean_times")


def table(text):
    """Return (name, rows) of the table that the argument NAME=PATH speaks of."""
    name, mark, path = text.partition("=")
    if not mark or name not in TAKES:
        raise ValueError(f"table must be NAME=PATH with one of {', '.join(TAKES)}, not {text!r}")
    return name, tables.read(path, name)


def main():
    parser = arguments.Parser(
        prog="twodiscs.cli.errata", description="Judge the source's formulas."
    )
    parser.add_argument("--scene", required=True, help="dict with width and height of the tables")
    parser.add_argument("--table", action="append", default=[], metavar="NAME=CSV")
    parser.add_argument("--output", required=True, metavar="CSV")
    options = parser.parse_args()

    box = arguments.parameters(options.scene)
    if set(box) != {"width", "height"}:
        raise ValueError(f"scene must be a dict of width and height, not {options.scene!r}")
    read = dict(map(table, options.table))
    tables.write(options.output, "errata", errata.rows(read, **box))


if __name__ == "__main__":
    arguments.run(main)
