"""Write grid.csv: the radii of a scene, with the regime that each of them is in."""

from twodiscs import tables
from twodiscs.cli import arguments
from twodiscs.scene import Scene


def rows(width, height, radii):
    """Return the rows of grid.csv for a box of ``width`` × ``height``, one for each radius."""
    scenes = [Scene(width, height, radius) for radius in radii]
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
    parser.add_argument("--parameters", required=True, help="a dict of height, radii, width")
    parser.add_argument("--output", required=True, help="grid.csv")
    options = parser.parse_args()
    given = arguments.parameters(options.parameters, "height", "radii", "width")
    tables.write(options.output, "grid", rows(**given))


if __name__ == "__main__":
    arguments.run(main)
