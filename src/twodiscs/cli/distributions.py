"""Write distributions.csv: how the times to the next hop are distributed.

    python -m twodiscs.cli.distributions --output results/distributions.csv --parameters \\
        "{'events': 1000000, 'scenes': [{'name': 'paper', 'width': 1.5, 'height': 1.0,
          'event': 'vertical_hop', 'radii': [0.1]}], 'seed': 1}"
"""

from twodiscs import tables
from twodiscs.cli import arguments

NEEDED = ("events", "scenes", "seed")


def main():
    parser = arguments.Parser(
        prog="twodiscs.cli.distributions", description="Measure times to the next hop."
    )
    parser.add_argument("--parameters", required=True, help=f"a dict of {', '.join(NEEDED)}")
    parser.add_argument("--output", required=True, metavar="CSV")
    options = parser.parse_args()
    parameters = arguments.parameters(options.parameters, *NEEDED)

    from twodiscs import distributions

    tables.write(options.output, "distributions", distributions.rows(**parameters))


if __name__ == "__main__":
    arguments.run(main)
