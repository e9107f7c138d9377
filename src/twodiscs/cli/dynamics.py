"""Count the events of one radius by molecular dynamics: the job of rule ``dynamics``."""

import sys
import time

from twodiscs.cli.arguments import run
from twodiscs.cli.points import arguments, timed, write_json


def progress(start):
    """Return a reporter that logs events done, error reached and time left."""

    def report(state):
        spent = time.process_time() - start
        left = spent * max(state["needed"], 0.0) / state["events"]
        print(
            f"{state['events']:.3g} events, error {state['error']:.2f} of the target, "
            f"about {left:.0f} s left",
            file=sys.stderr,
        )

    return report


def main():
    """Read the parameters, simulate, write the counts and what they cost."""
    point, scene, output, cost = arguments(__doc__, "accuracy", "event_budget")
    from twodiscs import dynamics

    report = progress(time.process_time())
    result, seconds = timed(
        lambda: dynamics.count_events(
            scene, point["accuracy"], point["event_budget"], point["seed"], report
        )
    )
    write_json(output, result)
    if cost:
        write_json(cost, {"events": result["events"], "seconds": seconds})


if __name__ == "__main__":
    run(main)
