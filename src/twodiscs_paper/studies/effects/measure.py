"""How each effect changes the mean times, and rough discs that never meet.

The scenes are in the files of ``config/scenes``. Their mean times, measured as for any scene, are
compared with the exact mean times of plain discs in the same box.
"""

import json
from dataclasses import replace

import numpy as np

from twodiscs.dynamics.ensemble import REPLICAS, new_rows, put_state, state_at
from twodiscs.dynamics.law import law_of
from twodiscs.dynamics.two.path import time_to_next
from twodiscs.model.box import Box
from twodiscs.model.checks import check_ascending, check_integer
from twodiscs.model.radii import key, stream_seed
from twodiscs.model.scene import check_scene
from twodiscs.points import estimates
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.starts import draw_any_starts, origins
from twodiscs.sampling.streams import open_stream
from twodiscs.theory import exact, tails

#: Blocks of ``REPLICAS`` starts that are followed until their discs meet, and the times at which
#: the starts without a meeting are counted.
BLOCKS = 256
TIMES = (1e2, 1e3, 1e4)

#: Discs with chaotic motion meet within this many mean times, except for a fraction e^−20.
MEAN_TIMES = 20


# Counts -------------------------------------------------------------------------------------------


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
    """Return how many starts of a ``Scene`` have no meeting of the discs by each of ``times``.

    The result is a list of integers, from ``blocks`` × ``REPLICAS`` starts of the invariant
    measure. Raises ``InputError`` for anything that is not a ``Scene``, for ``times`` that do not
    ascend, and for a number out of range.
    """
    law, (draw, prism) = law_of(check_scene(scene)), origins(scene)
    values = check_ascending("times", times)
    blocks, seed = check_integer("blocks", blocks), np.uint64(check_integer("seed", seed, 0))
    counts = follow_survivors(seed, 0, blocks, REPLICAS, np.array(values), law, draw, prism)
    return [int(n) for n in counts]


# The table ----------------------------------------------------------------------------------------

#: The columns that effects.csv takes from mean_times.csv.
KEPT = (
    "radius", "exact", "estimate", "stderr", "z", "count", "replicas", "duration", "status", "test",
    "starts", "share", "copies",
)  # fmt: skip


def rows(tables, scenes, seed, blocks=BLOCKS):
    """Yield the rows of effects.csv.

    ``scenes`` is {name: parameters of its box}, ``tables`` has the rows of <name>/mean_times of
    each. Rough discs are also followed until they meet, from ``blocks`` × ``REPLICAS`` starts at
    each radius of their table, with random streams of the root ``seed``.
    """
    for name, parameters in scenes.items():
        box, times = Box(**parameters), tables[f"{name}/mean_times"]
        start = {"scene": name, "width": box.width, "height": box.height}
        for row in times:
            yield start | _mean_time_row(box, row)
        if "moment_of_inertia" in box.effects:
            for radius in dict.fromkeys(row["radius"] for row in times):
                for row in _survivors_rows(name, box.scene(radius), seed, blocks):
                    yield start | row


def _survivors_rows(name, rough, seed, blocks):
    """Yield the rows on starts without a meeting, for rough discs and for smooth discs.

    A scene has no rows unless chaotic discs meet well before the first of ``TIMES``.
    """
    for scene in (rough, replace(rough, moment_of_inertia=None)):
        if MEAN_TIMES * exact.mean_times(scene)["disc_collision"] <= TIMES[0]:
            stream = stream_seed(seed, name, "unmet", key(scene.radius))
            counts = survivors(scene, TIMES, blocks, stream)
            for time, count in zip(TIMES, counts, strict=True):
                yield _survivors_row(scene, blocks * REPLICAS, time, count)


def _plain(box, radius):
    """Return the plain ``Scene`` in a box with the same sides, or None if its discs do not fit."""
    plain = Box(box.width, box.height)
    return plain.scene(radius) if plain.fits(radius) else None


def _mean_time_row(box, row):
    plain = _plain(box, row["radius"])
    return {name: row[name] for name in KEPT} | {
        "effects": json.dumps(box.effects),
        "quantity": f"{row['event']}_time",
        "plain": exact.mean_times(plain)[row["event"]] if plain else None,
    }


def _law(plain, time):
    """Return the fraction of starts of smooth discs without a meeting by a long ``time`` t.

    By Palm's relation it is C/(2τt²), if times between collisions have the mean τ and the tail
    C/t³.
    """
    mean = exact.mean_times(plain)["disc_collision"]
    return tails.tail_constant(plain, "disc_collision") / (2 * mean * time**2)


def _survivors_row(scene, starts, time, count):
    """Return the row on the fraction of ``starts`` without a meeting by ``time``."""
    plain = _plain(Box.of(scene), scene.radius)
    fraction = estimates.binomial_estimate(count, starts, 1.0)
    enough = count >= estimates.MIN_EVENTS
    return {
        "effects": json.dumps(scene.effects),
        "radius": scene.radius,
        "quantity": "never_met_share",
        "exact": None,
        "plain": plain and _law(plain, time),
        "estimate": fraction and fraction.value,
        "stderr": fraction.stderr if enough else None,
        "z": None,
        "count": count,
        "replicas": starts,
        "duration": time,
        "status": "sampled" if enough else "too-few" if count else "none-seen",
        "test": None,
        "starts": "invariant",
        "share": 1.0,
        "copies": 1,
    }
