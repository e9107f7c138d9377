"""A long run of the transmission coefficient: many hops at distances that no build goes down to.

    python -m twodiscs_paper.studies.passages.long_run --configuration FILE --output FOLDER

writes the counts, ``clusters.json``, and the table of them, ``passages.csv``.
"""

from pathlib import Path

import numpy as np
import yaml

from twodiscs.arguments import Parser, run
from twodiscs.comparison.measured.transmission import quiet_time
from twodiscs.dynamics.two.passages import REPLICAS, cluster_sizes
from twodiscs.model.box import Box
from twodiscs.points.digests import write_json
from twodiscs_paper.studies.passages import fits
from twodiscs_paper.studies.passages.measure import (
    NearThreshold,
    exponents,
    radius_at,
    thresholds,
)
from twodiscs_paper.studies.passages.study import Passages


def near(one, halvings):
    """Return the ``NearThreshold`` of a threshold ``one`` of the configuration."""
    box = Box(one["width"], one["height"])
    scene = box.scene(radius_at(thresholds(box)[one["hop"]], halvings))
    return NearThreshold(one["name"], scene, one["hop"], halvings, one["seed"])


def cases(one):
    """Return pairs (``NearThreshold``, pause) of a threshold ``one``, in the order of the counts.

    The ``pauses`` of the configuration are over that of the build.
    """
    places = [near(one, halvings) for halvings in range(one["first"], one["last"] + 1)]
    return [
        (here, pause * quiet_time(here.scene, here.hop))
        for here in places
        for pause in one.get("pauses", [1])
    ]


def counted(one):
    """Return {"events", "of", "sizes"} for each of the ``cases`` of a threshold ``one``.

    ``sizes`` are pairs [n, how many of the hops are in a cluster of n], without those of none;
    "of" is how many sizes are told apart.
    """
    found, blocks = [], -(-one["hops"] // REPLICAS)
    for here, gap in cases(one):
        sizes, events = cluster_sizes(here.scene, here.hop, gap, blocks, here.cluster_seed)
        pairs = [[n, int(hops)] for n, hops in enumerate(sizes) if hops]
        found.append({"events": int(events), "of": len(sizes), "sizes": pairs})
    return found


def rows(one, counts):
    """Return the rows of passages.csv on a threshold ``one`` from its ``counted`` hops."""
    measured, found = [], []
    for (here, gap), count in zip(cases(one), counts, strict=True):
        sizes = np.zeros(count["of"], np.int64)
        for n, hops in count["sizes"]:
            sizes[n] = hops
        kappa, own = here.of_sizes(sizes, count["events"], gap)
        measured.append((here, kappa))
        found += own
    table = [Passages.empty(**row) for row in found]
    if "pauses" in one:  # at one distance
        return table
    table += [Passages.empty(**row) for row in exponents(measured)]
    return table + [Passages.empty(**row) for row in fits.fits(table)]


def main():
    parser = Parser(prog=__spec__.name, description=__doc__)
    parser.add_argument("--configuration", required=True, metavar="YAML")
    parser.add_argument("--output", required=True, metavar="FOLDER")
    options = parser.parse_args()
    configuration = yaml.safe_load(Path(options.configuration).read_text(encoding="utf-8"))
    folder = Path(options.output)
    folder.mkdir(parents=True, exist_ok=True)
    counts = {one["name"]: counted(one) for one in configuration["thresholds"]}
    write_json(folder / "clusters.json", counts)
    of_all = [rows(one, counts[one["name"]]) for one in configuration["thresholds"]]
    Passages.write(folder / "passages.csv", [row for some in of_all for row in some])


if __name__ == "__main__":
    run(main)
