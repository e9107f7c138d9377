"""Write grid.csv: the radii of a scene, with the regime that each of them is in."""

from twodiscs import parameters, tables
from twodiscs.cli import arguments


def rows(given):
    """Return the rows of grid.csv for the parameters ``given``, one for each radius."""
    scenes = [parameters.scene(given, radius) for radius in given["radii"]]
    return [
        {
            "radius": scene.radius,
            "regime": scene.regime,
            "ergodic_components": scene.ergodic_components,
            "largest_radius": scene.largest_radius,
        }
        for scene in scenes
    ]


def main():
    parser = arguments.Parser(prog="python -m twodiscs.cli.grid", description=__doc__)
    parser.add_argument(
        "--parameters", required=True, help="a dict of height, radii, width; effects"
    )
    parser.add_argument("--output", required=True, help="grid.csv")
    options = parser.parse_args()
    names = ("height", "radii", "width")
    given = arguments.parameters(options.parameters, *names, optional=["effects"])
    tables.write(options.output, "grid", rows(given))


if __name__ == "__main__":
    arguments.run(main)
