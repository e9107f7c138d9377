"""What each effect does to the mean times, and rough discs that never meet.

The scenes are those of the files in ``config/scenes``. Each is counted here as it is when it is
built alone, from the same seeds, and set beside plain discs in the same box.
"""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np

from twodiscs.comparison import estimates
from twodiscs.comparison.rows import exact_values, mean_time_rows
from twodiscs.dynamics import counting
from twodiscs.dynamics.ensemble import REPLICAS, new_rows, put_state, state_at
from twodiscs.dynamics.law import law_of
from twodiscs.dynamics.trajectory import time_to_next
from twodiscs.model.box import Box
from twodiscs.model.checks import ascending, whole
from twodiscs.model.radii import key, stream_seed
from twodiscs.model.scene import a_scene
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.starts import draw_any_starts, origins
from twodiscs.sampling.streams import open_stream
from twodiscs.theory import exact, tails

#: Blocks of starts, of ``REPLICAS`` each, that are followed until their discs meet, and the times
#: at which those are counted that have not.
BLOCKS = 1024
TIMES = (1e2, 1e3, 1e4)

#: Discs that meet by chance do so within so many mean times: only e^−20 of them have not.
BY_CHANCE = 20


# What is counted ----------------------------------------------------------------------------------


@compiled
def follow_survivors(seed, first, stop, replicas, times, law, draw, prism):
    """Return how many starts of blocks ``first`` … ``stop`` − 1 have no collision by each time.

    Starts, ``replicas`` a block, come from ``draw``, or from ``prism`` unless it is None. ``times``
    ascend.
    """
    rows, starts = new_rows(1, law), np.zeros((12, replicas))
    survivors = np.zeros(times.size, np.int64)
    for block in range(first, stop):
        draw_any_starts(open_stream(seed, block), draw, (0, 0), starts, prism)
        for i in range(replicas):
            put_state(rows, 0, starts[:, i], law)
            elapsed = time_to_next(state_at(rows, 0, law), law, False, times[-1])
            for k in range(times.size):
                survivors[k] += elapsed > times[k]
    return survivors


def survivors(scene, times, blocks, seed):
    """Return for how many starts of a ``Scene`` the discs have not met by each of ``times``.

    Of ``blocks`` × ``REPLICAS`` starts of the invariant measure, a list of integers. Raises
    ``InputError`` for anything that is not a ``Scene``, for ``times`` that do not ascend, and for a
    number out of range.
    """
    law, (draw, prism) = law_of(a_scene(scene)), origins(scene)
    values = ascending("times", times)
    blocks, seed = whole("blocks", blocks), np.uint64(whole("seed", seed, 0))
    found = follow_survivors(seed, 0, blocks, REPLICAS, np.array(values), law, draw, prism)
    return [int(n) for n in found]


def job(name, box, dynamics, seed, blocks=BLOCKS):
    """Return what is counted of a scene with effects, a dict for a JSON file.

    ``dynamics`` has radius, accuracy, event_budget and seed of each point, and ``seed`` is the root
    of the random numbers. Keys: the ``name``, the box (its parameters) and dynamics, the points;
    and unmet, for rough discs: how many of ``blocks`` × ``REPLICAS`` starts have not met by each of
    ``TIMES``, for the scene and for smooth discs, at the radii where meeting by chance takes much
    less.
    """
    points = [
        counting.count_events(
            box.scene(one["radius"]), one["accuracy"], one["event_budget"], one["seed"]
        )
        for one in dynamics
    ]
    scenes = [box.scene(point["radius"]) for point in points]
    rough = "moment_of_inertia" in box.effects
    return {
        "name": name,
        "box": box.parameters(),
        "dynamics": points,
        "unmet": list(_survivor_points(name, scenes, seed, blocks)) if rough else [],
    }


def _survivor_points(name, scenes, seed, blocks):
    """Yield the counts of starts that have not met, with rough discs and with smooth ones."""
    for rough in scenes:
        for scene in (rough, replace(rough, moment_of_inertia=None)):
            if BY_CHANCE * exact.mean_times(scene)["disc_collision"] <= TIMES[0]:
                stream = stream_seed(seed, name, "unmet", key(scene.radius))
                yield {
                    "radius": scene.radius,
                    "effects": scene.effects,
                    "starts": blocks * REPLICAS,
                    "counts": survivors(scene, TIMES, blocks, stream),
                }


# The table ----------------------------------------------------------------------------------------

#: What effects.csv has of a row of mean_times.csv.
KEPT = (
    "radius", "exact", "estimate", "stderr", "z", "count", "replicas", "duration", "status", "test",
    "starts", "share", "copies",
)  # fmt: skip


def rows(points):
    """Yield the rows of effects.csv, from the files of what ``job`` returned for each scene."""
    for one in (json.loads(Path(path).read_text(encoding="utf-8")) for path in points):
        box = Box(**one["box"])
        start = {"scene": one["name"], "width": box.width, "height": box.height}
        for row in _compared(box, one["dynamics"]):
            yield start | _mean_time_row(box, row)
        for point in one["unmet"]:
            for time, n in zip(TIMES, point["counts"], strict=True):
                yield start | _survivor_row(box, point, time, n)


def _compared(box, points):
    """Return the rows of mean_times.csv for the ``points`` of a scene."""
    radii = [point["radius"] for point in points]
    return mean_time_rows(box.scene(radii[0]), exact_values(exact.theory_rows(box, radii)), points)


def _plain(box, radius):
    """Return the plain ``Scene`` in the same sides, or None if its discs do not fit."""
    plain = Box(box.width, box.height)
    return plain.scene(radius) if plain.fits(radius) else None


def _mean_time_row(box, row):
    plain = _plain(box, row["radius"])
    return {name: row[name] for name in KEPT} | {
        "effects": repr(box.effects),
        "quantity": f"{row['event']}_time",
        "plain": exact.mean_times(plain)[row["event"]] if plain else None,
    }


def _law(plain, time):
    """Return the share of smooth starts that have not met by a long ``time``.

    Palm's relation makes it C/(2τt²) of the tail C/t³ of the times between collisions, of mean τ.
    """
    mean = exact.mean_times(plain)["disc_collision"]
    return tails.tail_constant(plain, "disc_collision") / (2 * mean * time**2)


def _survivor_row(box, point, time, count):
    """Return the row of the share of starts that have not met by a ``time``."""
    plain = _plain(box, point["radius"])
    share = estimates.binomial_estimate(count, point["starts"], 1.0)
    honest = count >= estimates.HONEST
    return {
        "effects": repr(point["effects"]),
        "radius": point["radius"],
        "quantity": "never_met_share",
        "exact": None,
        "plain": plain and _law(plain, time),
        "estimate": share and share.value,
        "stderr": share.stderr if honest else None,
        "z": None,
        "count": count,
        "replicas": point["starts"],
        "duration": time,
        "status": "sampled" if honest else "too-few" if count else "none-seen",
        "test": None,
        "starts": "invariant",
        "share": 1.0,
        "copies": 1,
    }
