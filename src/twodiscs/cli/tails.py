"""Write tails.csv: how probable long intervals are.

    python -m twodiscs.cli.tails --output results/tails.csv \\
        --parameters "{'width': 1.5, 'height': 1.0, 'samples': 300, 'replicas': 400000, 'seed': 1}"
"""

from twodiscs import tables
from twodiscs.cli import arguments

KEYS = {"width", "height", "samples", "replicas", "seed"}


def main():
    parser = arguments.Parser(prog="twodiscs.cli.tails", description="Measure long intervals.")
    parser.add_argument("--parameters", required=True, help=f"dict of {', '.join(sorted(KEYS))}")
    parser.add_argument("--output", required=True, metavar="CSV")
    options = parser.parse_args()
    parameters = arguments.parameters(options.parameters)
    if set(parameters) != KEYS:
        raise ValueError(f"parameters must be a dict of {', '.join(sorted(KEYS))}")

    from twodiscs import tails

    tables.write(options.output, "tails", tails.rows(**parameters))


if __name__ == "__main__":
    arguments.run(main)
