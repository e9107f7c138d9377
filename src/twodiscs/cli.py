"""``twodiscs``: exact numbers for people and scripts, without the workflow."""

import json

from twodiscs.model.effects import EFFECTS
from twodiscs.model.scene import Scene
from twodiscs.pipeline.arguments import Parser, number, run


def main():
    """Entry point of the command ``twodiscs``."""
    run(_main)


def _main():
    parser = Parser(prog="twodiscs", description="Two hard discs in a box.")
    commands = parser.add_subparsers(dest="command", required=True)
    exact = commands.add_parser(
        "exact",
        help="exact volume, areas and mean times of one scene",
        description="Exact volume, areas and mean times; disc 1 has mass 1, total energy is 1/2.",
    )
    for name in ("width", "height", "radius"):
        exact.add_argument(f"--{name}", type=number, required=True)
    effects = exact.add_argument_group("effects", "what the scene calls for besides")
    for name, effect in EFFECTS.items():
        kind = number if effect.is_number else str
        effects.add_argument(f"--{name.replace('_', '-')}", type=kind, help=effect.meaning)
    exact.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args()

    named = {name: getattr(options, name) for name in EFFECTS if getattr(options, name) is not None}
    scene = Scene(options.width, options.height, options.radius, **named)
    from twodiscs.theory.exact import exact as exact_numbers

    numbers = exact_numbers(scene)
    print(
        json.dumps(numbers, indent=2, allow_nan=False) if options.json else _table(scene, numbers)
    )


def _table(scene, numbers):
    times = {e: "impossible" if t is None else repr(t) for e, t in numbers["mean_times"].items()}
    effects = [f"{name.replace('_', ' '):<20}{value}" for name, value in scene.effects.items()]
    if effects:
        effects.append(f"{'velocity components':<20}{scene.velocity_components}")
    if scene.conserved:
        effects.append(f"{'total momentum':<20}0 along {', '.join(scene.conserved)}")
    what = "discs" if scene.depth is None else "balls"
    box = " × ".join(repr(scene.side(axis)) for axis in scene.axes)
    return "\n".join(
        [
            f"Two {what} of radius {scene.radius!r} in a box of {box}",
            "",
            *effects,
            f"{'regime':<20}{numbers['regime']}",
            f"{'ergodic components':<20}{numbers['ergodic_components']}",
            f"{'largest radius':<20}{numbers['largest_radius']!r}",
            f"{'volume':<20}{numbers['volume']!r}",
            "",
            f"{'event':<20}{'area':<24}mean time",
            *(f"{event:<20}{area!r:<24}{times[event]}" for event, area in numbers["areas"].items()),
        ]
    )


if __name__ == "__main__":
    main()
