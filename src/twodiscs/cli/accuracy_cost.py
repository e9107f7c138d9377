"""Measure what accuracy costs by every method: the job of rule ``accuracy_cost``."""

import sys
import time

from twodiscs.cli.arguments import Parser, fail, number, run
from twodiscs.tables import write


def progress(start):
    """Return a reporter that logs repetitions done and time left."""

    def report(done, repetitions):
        left = (time.perf_counter() - start) / done * (repetitions - done)
        print(f"{done} of {repetitions} repetitions, about {left:.0f} s left", file=sys.stderr)

    return report


def main():
    """Measure and write the table."""
    parser = Parser(prog="python -m twodiscs.cli.accuracy_cost", description=__doc__)
    parser.add_argument("--seconds", type=number, help="processor time to spend, 30 by default")
    parser.add_argument("--output", required=True, help="accuracy_cost.csv")
    options = parser.parse_args()
    from twodiscs import accuracy_cost

    seconds = accuracy_cost.USUAL_SECONDS if options.seconds is None else options.seconds
    if not 1 <= seconds <= 1e6:
        fail(f"--seconds must lie between 1 and 1e6, not {seconds!r}")
    rows = accuracy_cost.rows(seconds, report=progress(time.perf_counter()))
    write(options.output, "accuracy_cost", rows)


if __name__ == "__main__":
    run(main)
