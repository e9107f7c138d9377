"""Write stability.csv, or long_runs.csv: how every method behaves where arithmetic has it hard.

    python -m twodiscs.cli.stability stability --output stability.csv --parameters \\
        "{'width': 1.5, 'height': 1.0, 'seed': 1, 'ordinary': 1000000000, 'hard': 100000000}"
"""

from twodiscs import tables
from twodiscs.checks import whole
from twodiscs.cli import arguments
from twodiscs.scene import length

NEEDED = ("hard", "height", "ordinary", "seed", "width")


def main():
    parser = arguments.Parser(prog="twodiscs.cli.stability", description=__doc__.split("\n")[0])
    parser.add_argument("table", choices=["stability", "long_runs"])
    parser.add_argument("--parameters", required=True, help=f"a dict of {', '.join(NEEDED)}")
    parser.add_argument("--output", required=True, metavar="CSV")
    options = parser.parse_args()

    given = arguments.parameters(options.parameters, *NEEDED)
    box = length("width", given["width"]), length("height", given["height"])
    seed = whole("seed", given["seed"], 0)
    events = whole("ordinary", given["ordinary"]), whole("hard", given["hard"])

    from twodiscs import stability

    measure = stability.rows if options.table == "stability" else stability.dynamics_rows
    rows = list(measure(*box, seed, *events))
    tables.write(options.output, options.table, rows)
    for row in rows:
        if row["passed"] is False:
            where = "" if row["radius"] is None else f" at radius {row['radius']!r}"
            print(f"{row['part']}: {row['quantity']} ({row['case']}){where} is {row['value']!r}")


if __name__ == "__main__":
    arguments.run(main)
