"""A long run of files of several numbers of discs: ν and D of the same motion, by two estimators.

D/(ν ℓ²) is 1 + 2Σ⟨s₀ s_k⟩ over all hops of a disc, s their directions. Hops with the same disc
undo each other. A pair that passes takes its gap from its neighbours, which then pass more often:
hops with others go on in the same direction. Both parts grow with the time, and their sum does
not once the time is longer than a flight through the neck, from h over the thermal speed on.
"""

import numpy as np

from twodiscs.dynamics.transmission import hop_seed
from twodiscs.model.scene import Box
from twodiscs_paper.studies.estimates import sample_mean
from twodiscs_paper.studies.passages.models import file
from twodiscs_paper.studies.passages.near import compared, hop_cells, radius_at
from twodiscs_paper.studies.passages.parts.in_long_file import file_scene
from twodiscs_paper.study import row


def file_motion(one, run):
    """Return (``Scene`` of a file ``one``, the unit of its times, its rate of kicks or None)."""
    box = Box(run["width"], run["height"])
    scene, unit = file_scene(box, one["discs"], radius_at(box.height / 4, one["halvings"]))
    return scene, unit, one["friction"] / unit if "friction" in one else None


def file_counts(one, run):
    """Return the counts of a file ``one`` of a long ``run``, a list for each replica, seed by seed.

    They are those of ``file.hop_correlations``; then the hops in all the time, and for both lags
    Σ n² over the discs and all pairs of times, n the places by which a disc has moved in the order.
    """
    (scene, unit, rate), found = file_motion(one, run), []
    step, number, sums = run["step"] * unit, run["records"], [lag * unit for lag in run["sums"]]
    kind = f"long run {one['discs']} {one.get('friction')}"
    for seed in run["seeds"]:
        stream = hop_seed(scene, "horizontal_hop", run["name"], seed, kind)
        for places, times, pairs in file.logged(scene, step, number, one["replicas"], stream, rate):
            until = number * step - sums[-1]
            counted = file.hop_correlations(places[0, :, 0], times, pairs, sums, until)
            numbers = file.order(places, scene.width)
            moved = [int(((numbers[lag:] - numbers[:-lag]) ** 2).sum()) for lag in run["lags"]]
            found.append([*counted, times.size, moved])
    return found


def file_rows(one, run, counts):
    """Yield the rows of passages.csv on a file ``one`` of a long ``run`` from its ``counts``.

    The sums over hops are compared with D by the order of the discs, of the same motion.
    """
    scene, unit, friction = file_motion(one, run)
    start = hop_cells(run["name"], scene, "horizontal_hop", 2.0 ** -one["halvings"])
    start["friction"] = friction
    hops, same, other, total, moved = (np.array([each[k] for each in counts]) for k in range(5))
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
    for k, lag in enumerate(run["sums"]):
        cells = {"quantity": "correlation", "time": lag * unit, "replicas": moves.n}
        found = file.quotient(hops + 2 * (same + other)[:, k], hops)
        yield row(start | cells, found, method="all_hops", **compared(found, moves))
        for method, part in (
            ("same_pair", hops + 2 * same[:, k]),
            ("other_pairs", 2 * other[:, k]),
        ):
            yield row(start | cells, file.quotient(part, hops), method=method)


def long_files(files, **run):
    """Yield the rows of a long ``run`` of ``files`` of several numbers of discs on a ring."""
    for one in files:
        yield from file_rows(one, run, file_counts(one, run))
