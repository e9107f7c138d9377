"""A long run of two tails: of one that falls as a power, to later times, and of one without drift.

    python -m twodiscs_paper.studies.tails.long_run --configuration FILE --output FOLDER

writes ``tails.csv``. Each run of the ``counted`` tail has its own random streams and the same
number of replicas. Counts are the estimates times 8 times all replicas.
"""

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import yaml

from twodiscs.arguments import Parser, run
from twodiscs.model.box import Box
from twodiscs.points.estimates import Estimate
from twodiscs.theory import exact, tails
from twodiscs_paper.studies.tails import fits, measure
from twodiscs_paper.studies.tails.study import Tails


def _start(one):
    """Return (scene, what all rows of a tail ``one`` of the configuration share)."""
    scene = Box(one["width"], one["height"]).scene(one["radius"])
    mean = exact.mean_times(scene)[one["event"]]
    return scene, {"event": one["event"], "radius": one["radius"], "exact_mean": mean}


def weighted(one):
    """Return the rows of a tail that falls as a power, at the ``times`` over the mean."""
    scene, start = _start(one)
    times = [time * start["exact_mean"] for time in one["times"]]
    estimates = measure.tail(scene, one["event"], times, one["samples"], one["seed"])
    constant = tails.tail_constant(scene, one["event"])
    rows = [
        start
        | {"quantity": "survival", "method": "weighted", "time": time, "until": None}
        | {"estimate": e.value, "stderr": e.stderr, "law": constant / time**3}
        for time, e in zip(times, estimates, strict=True)
    ]
    return rows + [fits.approach(row) for row in rows]


def counted(one):
    """Return the rows of a tail by plain counting, and of its rate between any two ``times``."""
    scene, start = _start(one)
    mean, runs = start["exact_mean"], one["runs"]
    times = [time * mean for time in one["times"]]
    found = [
        measure.counted(scene, one["event"], times, one["replicas"], one["seed"] + i)
        for i in range(runs)
    ]
    joined = [
        Estimate(
            float(np.mean([e.value for e in same])),
            math.sqrt(sum(e.stderr**2 for e in same)) / runs,
            runs * one["replicas"],
        )
        for same in zip(*found, strict=True)
    ]
    rows = [
        start
        | {"quantity": "survival", "method": "counted", "time": time, "until": None}
        | {"estimate": e.value, "stderr": e.stderr, "law": None}
        for time, e in zip(times, joined, strict=True)
    ]
    return rows + [_rate(*pair) for pair in pairwise(rows)]


def _rate(row, later):
    """Return the row on the rate between the times of two rows.

    The variance of its logarithm is the difference of their relative variances, for the intervals
    of the later row are among those of the first.
    """
    time = later["time"] - row["time"]
    late, early = ((r["stderr"] / r["estimate"]) ** 2 for r in (later, row))
    return row | {
        "quantity": "rate",
        "until": later["time"],
        "estimate": math.log(row["estimate"] / later["estimate"]) / time,
        "stderr": math.sqrt(late - early) / time,
        "law": 1 / row["exact_mean"],
    }


def main():
    parser = Parser(prog=__spec__.name, description=__doc__)
    parser.add_argument("--configuration", required=True, metavar="YAML")
    parser.add_argument("--output", required=True, metavar="FOLDER")
    options = parser.parse_args()
    configuration = yaml.safe_load(Path(options.configuration).read_text(encoding="utf-8"))
    folder = Path(options.output)
    folder.mkdir(parents=True, exist_ok=True)
    rows = weighted(configuration["weighted"]) + counted(configuration["counted"])
    Tails.write(folder / "tails.csv", [Tails.empty(**row) for row in rows])


if __name__ == "__main__":
    run(main)
