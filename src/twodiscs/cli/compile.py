"""Compile kernels once, before many jobs ask for them side by side: the job of rule ``compile``."""

from pathlib import Path

from twodiscs import parameters
from twodiscs.cli.arguments import Parser, run
from twodiscs.cli.arguments import parameters as read
from twodiscs.scene import EVENTS

#: A plain scene, with every choice of what is watched.
PLAIN = {"height": 1.0, "radius": 0.2, "width": 1.5}
PLAIN |= {"intervals": ("vertical_hop", 0.2), "trajectory": True}
CHOICES = (EVENTS, ("vertical_hop",), ("right_wall",), ("any_wall",))
QUANTITIES = (("volume",), ("volume", "top_wall_area"))


def dynamics(given):
    """Compile the kernels of molecular dynamics."""
    from twodiscs import dynamics

    scene = parameters.scene(given, given["radius"])
    for events in [given["mean_times"]] if "mean_times" in given else CHOICES:
        if events:
            dynamics.run_blocks(scene, events, 0, 0, 1, 1.0, replicas=1)
    if given["intervals"]:
        event, radius = given["intervals"]
        dynamics.hop_intervals(scene.with_radius(radius), event, 1, 0)
    if given["trajectory"]:
        dynamics.trajectory(scene, 0)


def montecarlo(given):
    """Compile the kernels of rejection sampling."""
    from twodiscs import montecarlo

    scene = parameters.scene(given, given["radius"])
    for quantities in [given["sampled"]] if "sampled" in given else QUANTITIES:
        montecarlo.better_point(scene, quantities, 1, 0.1, 0)
    if not scene.has_effects:
        montecarlo.conditioned_point(scene, ["volume"], 1, 0.1, 0)


KERNELS = {"dynamics": dynamics, "montecarlo": montecarlo}


def main():
    """Run the kernels on almost nothing, so that their compiled code is in the cache."""
    parser = Parser(description=__doc__)
    parser.add_argument("kernels", choices=sorted(KERNELS), help="whose kernels to compile")
    parser.add_argument("--parameters", help="of a scene, and what it watches; absent: plain")
    parser.add_argument("--output", required=True, help="an empty file that says it was done")
    options = parser.parse_args()
    names = ("effects", "height", "intervals", "mean_times", "radius", "sampled", "trajectory")
    given = read(options.parameters, *names, "width") if options.parameters else PLAIN
    KERNELS[options.kernels](given)
    Path(options.output).touch()


if __name__ == "__main__":
    run(main)
