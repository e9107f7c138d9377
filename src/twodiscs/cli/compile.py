"""Compile the kernels once, before many jobs ask for them: the job of rule ``compile``."""

from pathlib import Path

from twodiscs.cli.arguments import Parser, run
from twodiscs.scene import Scene


def main():
    """Run every kernel on almost nothing, so that its compiled code is in the cache."""
    parser = Parser(description=__doc__)
    parser.add_argument("--output", required=True, help="an empty file that says it was done")
    given = parser.parse_args()
    from twodiscs import dynamics, montecarlo

    scene = Scene(1.5, 1.0, 0.2)
    for events in (("any_wall",), ("right_wall",), ("vertical_hop",), ("vertical_hop", "top_wall")):
        dynamics.run_blocks(scene, events, 0, 0, 1, 1.0, replicas=1)
    dynamics.hop_intervals(scene, "vertical_hop", 1, 0)
    dynamics.trajectory(scene, 0)
    for quantities in (["volume"], ["volume", "top_wall_area"]):
        montecarlo.sample_point(scene, quantities, 1, 0.1, 0)
    Path(given.output).touch()


if __name__ == "__main__":
    run(main)
