"""Compile kernels once, before many jobs ask for them side by side: the job of rule ``compile``."""

from pathlib import Path

from twodiscs.cli.arguments import Parser, run
from twodiscs.scene import EVENTS, Scene

SCENE = Scene(1.5, 1.0, 0.2)


def dynamics():
    """Compile the kernels of molecular dynamics, for every choice of what is watched."""
    from twodiscs import dynamics

    for events in (EVENTS, ("vertical_hop",), ("right_wall",), ("any_wall",)):
        dynamics.run_blocks(SCENE, events, 0, 0, 1, 1.0, replicas=1)
    dynamics.hop_intervals(SCENE, "vertical_hop", 1, 0)
    dynamics.trajectory(SCENE, 0)


def montecarlo():
    """Compile the kernels of rejection sampling, with and without shells."""
    from twodiscs import montecarlo

    for quantities in (["volume"], ["volume", "top_wall_area"]):
        montecarlo.sample_point(SCENE, quantities, 1, 0.1, 0)
    montecarlo.conditioned_point(SCENE, ["volume"], 1, 0.1, 0)


KERNELS = {"dynamics": dynamics, "montecarlo": montecarlo}


def main():
    """Run the kernels on almost nothing, so that their compiled code is in the cache."""
    parser = Parser(description=__doc__)
    parser.add_argument("kernels", choices=sorted(KERNELS), help="whose kernels to compile")
    parser.add_argument("--output", required=True, help="an empty file that says it was done")
    given = parser.parse_args()
    KERNELS[given.kernels]()
    Path(given.output).touch()


if __name__ == "__main__":
    run(main)
