"""A long run of files of several numbers of discs: ν, κ and D of the same motion."""

from functools import partial

import numpy as np

from twodiscs.measure.transmission import hop_seed, odd_clusters_per_passage, plateau
from twodiscs.model.scene import Box
from twodiscs_paper.studies.estimates import sample_mean
from twodiscs_paper.studies.passages.models import file
from twodiscs_paper.studies.passages.near import hop_cells, radius_at
from twodiscs_paper.studies.passages.parts.in_long_file import file_scene
from twodiscs_paper.study import row


def file_counts(one, run):
    """Return the counts of a file ``one`` of a long ``run``, a list for each replica.

    They are the hops of all pairs, and for each pause the passages, both between the margins; then
    the hops in all the time, and for both lags Σ n² over the discs and all pairs of times, n the
    places by which a disc has moved in the order.
    """
    box, found = Box(run["width"], run["height"]), []
    scene, unit = file_scene(box, one["discs"], radius_at(box.height / 4, one["halvings"]))
    rate = one["friction"] / unit if "friction" in one else None
    step, number = run["step"] * unit, run["records"]
    window = run["margin"] * unit, number * step - run["margin"] * unit
    kind = f"long run {one['discs']} {one.get('friction')}"
    seed = hop_seed(scene, "horizontal_hop", run["name"], run["seed"], kind)
    for places, times, pairs in file.logged(scene, step, number, one["replicas"], seed, rate):
        counted = [file.passages(times, pairs, window, gap * unit) for gap in run["pauses"]]
        numbers = file.order(places, scene.width)
        moved = [int(((numbers[lag:] - numbers[:-lag]) ** 2).sum()) for lag in run["lags"]]
        found.append([counted[0][0], [each for _, each in counted], times.size, moved])
    return found


def file_rows(one, run, counts):
    """Yield the rows of passages.csv on a file ``one`` of a long ``run`` from its ``counts``.

    κ is that of the first pause that is long against a flight, corrected for the passages of the
    pair and of its neighbours in it. D/(ν ℓ²) over κ is the last row.
    """
    box = Box(run["width"], run["height"])
    scene, unit = file_scene(box, one["discs"], radius_at(box.height / 4, one["halvings"]))
    start = hop_cells(run["name"], scene, "horizontal_hop", 2.0 ** -one["halvings"])
    start["friction"] = one["friction"] / unit if "friction" in one else None
    hops, passed, total, moved = (np.array([count[k] for count in counts]) for k in range(4))
    discs, duration = one["discs"], run["records"] * run["step"] * unit
    per_time = 2 * total / (discs * duration)
    rate = sample_mean(per_time)
    yield row(start, rate, quantity="rate", method="states", replicas=rate.n)
    steps = [
        moved[:, k] / (discs * (run["records"] + 1 - lag)) for k, lag in enumerate(run["lags"])
    ]
    walked = (steps[1] - steps[0]) / ((run["lags"][1] - run["lags"][0]) * run["step"] * unit)
    moves = file.quotient(walked, per_time)
    time = run["lags"][1] * run["step"] * unit
    yield row(start, moves, quantity="diffusion", method="order", time=time, replicas=moves.n)
    for k, pause in enumerate(run["pauses"]):
        found = file.quotient(passed[:, k], hops)
        # Two discs take part in a hop, and each has two neighbours.
        kappa = plateau(
            found, pause * unit, 2 / rate.value, partial(odd_clusters_per_passage, others=2)
        )
        if kappa:
            cells = {"method": "clusters", "time": pause * unit, "replicas": kappa.n}
            yield row(start, kappa, quantity="coefficient", uncorrected=found.value, **cells)


def long_files(files, **run):
    """Yield the rows of a long ``run`` of ``files`` of several numbers of discs on a ring."""
    for one in files:
        yield from file_rows(one, run, file_counts(one, run))
