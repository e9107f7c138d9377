"""Animate one trajectory: the job of rule ``animate``.

    python -m twodiscs.cli.animation --scene "{'width': 1.5, 'height': 1.0, 'radius': 0.24}" \\
        --trajectory results/paper/trajectory.csv --output animation.gif animation.png
"""

from twodiscs import tables
from twodiscs.cli import arguments


def main():
    """Read the trajectory, draw the frames, write the files."""
    parser = arguments.Parser(prog="twodiscs.cli.animation", description="Animate a trajectory.")
    parser.add_argument("--scene", required=True, help="dict with width, height, radius")
    parser.add_argument("--trajectory", required=True, metavar="CSV")
    parser.add_argument("--output", nargs="+", required=True, metavar="FILE", help=".gif, .png")
    options = parser.parse_args()

    scene = arguments.parameters(options.scene, "height", "radius", "width")
    rows = tables.read(options.trajectory, "trajectory")
    from twodiscs.figures import animation, style

    with style.context():
        animation.animate(scene, rows, options.output)


if __name__ == "__main__":
    arguments.run(main)
