"""Write theory.csv: exact volumes, areas and mean times at every radius of a scene."""

from twodiscs import parameters, tables, theory
from twodiscs.cli import arguments


def rows(given):
    """Return the rows of theory.csv for the parameters ``given``, radius by radius."""
    found = []
    for radius in given["radii"]:
        exact = theory.exact(parameters.scene(given, radius))
        values = {"volume": exact["volume"]}
        values |= {f"{event}_area": area for event, area in exact["areas"].items()}
        values |= {f"{event}_time": time for event, time in exact["mean_times"].items()}
        found += [{"radius": radius, "quantity": q, "exact": x} for q, x in values.items()]
    return found


def main():
    parser = arguments.Parser(prog="python -m twodiscs.cli.theory", description=__doc__)
    parser.add_argument(
        "--parameters", required=True, help="a dict of height, radii, width; effects"
    )
    parser.add_argument("--output", required=True, help="theory.csv")
    options = parser.parse_args()
    names = ("height", "radii", "width")
    given = arguments.parameters(options.parameters, *names, optional=["effects"])
    tables.write(options.output, "theory", rows(given))


if __name__ == "__main__":
    arguments.run(main)
