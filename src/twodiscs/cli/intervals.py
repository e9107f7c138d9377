"""Draw the intervals between hops at one radius: the job of rule ``intervals``."""

from twodiscs.cli.arguments import run
from twodiscs.cli.points import arguments, timed, write_json


def main():
    """Read the parameters, simulate, write the histogram and what it cost."""
    point, scene, output, cost = arguments(__doc__, "event", "intervals")
    from twodiscs import dynamics

    result, seconds = timed(
        lambda: dynamics.hop_intervals(scene, point["event"], point["intervals"], point["seed"])
    )
    write_json(output, result)
    if cost:
        write_json(cost, {"events": result["intervals"], "seconds": seconds})


if __name__ == "__main__":
    run(main)
