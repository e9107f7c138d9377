"""Compile kernels once, before many jobs ask for them side by side: the job of rule ``compile``."""

from pathlib import Path

from twodiscs import parameters
from twodiscs.cli import arguments
from twodiscs.scene import EVENTS, Scene

PLAIN = Scene(1.5, 1.0, 0.2)

#: The larger disc of a scene with effects, over the shortest side: every scene has room for it.
SMALL = 0.01


def dynamics():
    """Compile the kernels of molecular dynamics, for every choice of what is watched."""
    from twodiscs import dynamics

    for events in (EVENTS, ("vertical_hop",), ("right_wall",), ("any_wall",)):
        dynamics.run_blocks(PLAIN, events, 0, 0, 1, 1.0, replicas=1)
    dynamics.hop_intervals(PLAIN, "vertical_hop", 1, 0)
    dynamics.trajectory(PLAIN, 0)


def montecarlo():
    """Compile the kernels of rejection sampling, with and without shells."""
    from twodiscs import montecarlo

    for quantities in (["volume"], ["volume", "top_wall_area"]):
        montecarlo.sample_point(PLAIN, quantities, 1, 0.1, 0)
    montecarlo.conditioned_point(PLAIN, ["volume"], 1, 0.1, 0)


def scene_of(given):
    """Return a scene with the box and the effects of the parameters ``given``."""
    effects = given.get("effects", {})
    side = min(given["width"], given["height"], effects.get("depth", given["height"]))
    return parameters.scene(given, SMALL * side / max(1.0, effects.get("radius_ratio", 1.0)))


def scene_counts(given):
    """Compile the kernel that counts the events ``mean_times`` in the scene of ``given``."""
    from twodiscs import dynamics

    dynamics.run_blocks(scene_of(given), given["mean_times"], 0, 0, 1, 1.0, replicas=1)


def scene_intervals(given):
    """Compile the kernel that records intervals of the hop ``event`` in the scene of ``given``."""
    from twodiscs import dynamics

    dynamics.hop_intervals(scene_of(given), given["event"], 1, 0)


def scene_samples(given):
    """Compile the kernel that samples ``volume`` and ``areas`` in the scene of ``given``."""
    from twodiscs import montecarlo

    quantities = ["volume"] * given["volume"] + [f"{event}_area" for event in given["areas"]]
    montecarlo.better_point(scene_of(given), quantities, 1, 0.1, 0)


#: The kernels of plain scenes by module; those of one scene by the jobs that run them.
PLAIN_KERNELS = {"dynamics": dynamics, "montecarlo": montecarlo}
SCENE_KERNELS = {
    "dynamics": scene_counts,
    "intervals": scene_intervals,
    "monte_carlo": scene_samples,
}


def main():
    """Run the kernels on almost nothing, so that their compiled code is in the cache."""
    parser = arguments.Parser(description=__doc__)
    parser.add_argument("kernels", choices=sorted({*PLAIN_KERNELS, *SCENE_KERNELS}))
    parser.add_argument("--parameters", help="of a scene and what it watches; absent: plain")
    parser.add_argument("--output", required=True, help="an empty file that says it was done")
    options = parser.parse_args()
    if options.parameters is None:
        PLAIN_KERNELS[options.kernels]()
    else:
        SCENE_KERNELS[options.kernels](arguments.parameters(options.parameters))
    Path(options.output).touch()


if __name__ == "__main__":
    arguments.run(main)
