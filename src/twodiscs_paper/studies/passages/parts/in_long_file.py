"""Displacements in long files with and without friction, and D by the order of the discs."""

import math

from twodiscs.dynamics.transmission import hop_seed
from twodiscs.model.scene import Scene
from twodiscs.points.estimates import Estimate
from twodiscs_paper.studies.estimates import sample_mean
from twodiscs_paper.studies.passages.models import file
from twodiscs_paper.studies.passages.near import compared, hop_cells
from twodiscs_paper.study import row

#: Long files: the number of discs, and of replicas. The rate of kicks, and the time between
#: records, with the thermal speed and h as units. The number of records, and the lags in records.
LONG_FILE, LONG_REPLICAS = 128, 32
FILE_FRICTION, FILE_STEP, RECORDS, LAGS = 4.0, 0.5, 128, (1, 2, 4, 8, 16, 32, 64)

#: The lags between which displacements give F, and those between which they give D.
SINGLE, HOPPED = (16, 64), (16, 32)


def file_scene(box, discs, radius, inertia=None):
    """Return the ``Scene`` of ``discs`` on a ring, and the unit of its times, h over v_th."""
    scene = Scene(
        box.width / 2 * discs, box.height, radius, discs=discs, periodic="x",
        moment_of_inertia=inertia,
    )  # fmt: skip
    return scene, box.height / file.thermal_speed(scene)


def one_long_file(name, box, radius, frictions, seed, inertia=None, replicas=LONG_REPLICAS):
    """Yield the rows of one long file, which is open at a ``radius`` below h/4, else blocked.

    It is followed with each of ``frictions``: None, or the rate of kicks. Rough discs have an
    ``inertia``, I/(m r²), and no law, because their F is not known. Squares of lengths are over ℓ².
    An open file has a row of the ``density`` from its first motion, which is without kicks.
    """
    limit, per_disc = box.height / 4, box.width / 2
    is_open, variance = radius < limit, None
    scene, unit = file_scene(box, LONG_FILE, radius, inertia)
    start = hop_cells(name, scene, "horizontal_hop", 1 - radius / limit)
    for friction in frictions:
        rate = start["friction"] = None if friction is None else friction / unit
        kind = friction if inertia is None else f"rough {inertia}"
        stream = hop_seed(scene, "horizontal_hop", name, seed, f"long file {kind} states")

        def make_row(quantity, method, found, lag=None, **more):
            more["time"] = None if lag is None else lag * FILE_STEP * unit
            return row(start, found, quantity=quantity, method=method, replicas=found.n, **more)

        places, hops = file.recorded(scene, FILE_STEP * unit, RECORDS, replicas, stream, rate)
        numbers = file.order(places, scene.width)
        ordered = file.ordered_places(places, numbers, scene.width)
        moved, whole_file = (file.squares(x, LAGS) / per_disc**2 for x in (places, ordered))
        steps = file.squares(numbers, LAGS)
        if is_open and variance is None:
            variance = file.measured_density(scene, places)
            yield make_row("density", "states", variance)

        def law(lag, rate=rate, variance=variance and variance.value):
            if inertia or (rate is None and variance):
                return None
            return file.law(scene, rate, lag * FILE_STEP * unit, variance)

        for k, lag in enumerate(LAGS):
            yield make_row("displacement", "states", sample_mean(moved[k]), lag)
            if is_open:
                yield make_row("order", "states", sample_mean(steps[k]), lag)
            yield make_row("file", "states", sample_mean(whole_file[k]), lag, reference=law(lag))
        if rate is not None:
            early, late = (LAGS.index(lag) for lag in SINGLE)
            root = math.sqrt(SINGLE[0] * FILE_STEP * unit)
            found = sample_mean((whole_file[late] - whole_file[early]) / root)
            due = (law(SINGLE[1]) - law(SINGLE[0])) / root
            # F is ∝ √S.
            error = due * variance.stderr / variance.value / 2 if variance else 0.0
            cells = compared(found, Estimate(due, error, 1), found.n)
            yield make_row("single_file", "states", found, SINGLE[1], **cells)
        if is_open:
            per_time = hops / (RECORDS * FILE_STEP * unit)
            yield make_row("rate", "states", sample_mean(per_time))
            early, late = (LAGS.index(lag) for lag in HOPPED)
            walked = (steps[late] - steps[early]) / ((HOPPED[1] - HOPPED[0]) * FILE_STEP * unit)
            yield make_row("diffusion", "order", file.quotient(walked, per_time), HOPPED[1])


def in_long_file(name, box, blocked, seed):
    """Yield the rows of long files with friction that are blocked at the radii ``blocked``."""
    for radius in blocked:
        yield from one_long_file(name, box, radius, [FILE_FRICTION], seed)
