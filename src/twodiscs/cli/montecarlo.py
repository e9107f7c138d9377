"""Sample the volume and areas of one radius: the job of rule ``monte_carlo``."""

from twodiscs.cli.arguments import run
from twodiscs.cli.points import arguments, timed, write_json


def main():
    """Read the parameters, sample, write the counts and what they cost."""
    point, scene, output, cost = arguments(__doc__, "areas", "samples", "shell", "volume")
    from twodiscs import montecarlo

    quantities = ["volume"] * point["volume"] + [f"{event}_area" for event in point["areas"]]
    shell = point["shell"] or 0.5
    result, seconds = timed(
        lambda: montecarlo.better_point(scene, quantities, point["samples"], shell, point["seed"])
    )
    write_json(output, result)
    if cost:
        write_json(cost, {"events": result["samples"], "seconds": seconds})


if __name__ == "__main__":
    run(main)
