"""``twodiscs``: exact numbers for people and scripts, without the workflow."""

import json

from twodiscs.cli import arguments
from twodiscs.scene import EVENTS, Scene


def main():
    """Entry point of the command ``twodiscs``."""
    arguments.run(_main)


def _main():
    parser = arguments.Parser(prog="twodiscs", description="Two hard discs in a box.")
    commands = parser.add_subparsers(dest="command", required=True)
    exact = commands.add_parser(
        "exact",
        help="exact volume, areas and mean times of one scene",
        description="Exact volume, areas and mean times, for unit masses and total energy 1/2.",
    )
    for name in ("width", "height", "radius"):
        exact.add_argument(f"--{name}", type=arguments.number, required=True)
    exact.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args()

    scene = Scene(options.width, options.height, options.radius)
    from twodiscs import theory

    numbers = theory.exact(scene)
    print(
        json.dumps(numbers, indent=2, allow_nan=False) if options.json else _table(scene, numbers)
    )


def _table(scene, numbers):
    times = {e: "impossible" if t is None else repr(t) for e, t in numbers["mean_times"].items()}
    return "\n".join(
        [
            f"Two discs of radius {scene.radius!r} in a box of {scene.width!r} × {scene.height!r}",
            "",
            f"{'regime':<20}{numbers['regime']}",
            f"{'ergodic components':<20}{numbers['ergodic_components']}",
            f"{'largest radius':<20}{numbers['largest_radius']!r}",
            f"{'volume':<20}{numbers['volume']!r}",
            "",
            f"{'event':<20}{'area':<24}mean time",
            *(f"{event:<20}{numbers['areas'][event]!r:<24}{times[event]}" for event in EVENTS),
        ]
    )


if __name__ == "__main__":
    main()
