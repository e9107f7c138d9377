"""Write theory.csv: exact volumes, areas and mean times at every radius of a scene."""

from twodiscs import tables, theory
from twodiscs.cli import arguments
from twodiscs.scene import Scene


def rows(width, height, radii):
    """Return the rows of theory.csv for a box of ``width`` × ``height``, radius by radius."""
    found = []
    for radius in radii:
        exact = theory.exact(Scene(width, height, radius))
        values = {"volume": exact["volume"]}
        values |= {f"{event}_area": area for event, area in exact["areas"].items()}
        values |= {f"{event}_time": time for event, time in exact["mean_times"].items()}
        found += [{"radius": radius, "quantity": q, "exact": x} for q, x in values.items()]
    return found


def main():
    parser = arguments.Parser(prog="python -m twodiscs.cli.theory", description=__doc__)
    parser.add_argument("--parameters", required=True, help="a dict of height, radii, width")
    parser.add_argument("--output", required=True, help="theory.csv")
    options = parser.parse_args()
    given = arguments.parameters(options.parameters, "height", "radii", "width")
    tables.write(options.output, "theory", rows(**given))


if __name__ == "__main__":
    arguments.run(main)
