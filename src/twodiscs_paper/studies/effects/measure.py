"""How each effect changes the mean times, and rough discs that never meet.

The scenes are in the files of ``config/scenes``. Their mean times, measured as for any scene, are
compared with the exact mean times of plain discs in the same box.
"""

import json
from dataclasses import replace

import numpy as np

from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.dynamics.law import two_disc_law
from twodiscs.dynamics.two.follow import new_rows, put_state, state_at
from twodiscs.model.scene import Box
from twodiscs.model.seeds import key, stream_seed
from twodiscs.points import estimates
from twodiscs.sampling.initial_states import draw_states, start_sampler
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.streams import open_stream
from twodiscs.theory import exact
from twodiscs_paper.studies.single import tail_constant, time_to_next
from twodiscs_paper.study import row

#: Blocks of ``REPLICAS`` starts that are followed until their discs meet, and the times at which
#: the starts without a meeting are counted.
MEETING_BLOCKS = 256
TIMES = (1e2, 1e3, 1e4)

#: Discs with chaotic motion meet within this many mean times, except for a fraction e^−20.
MEAN_TIMES = 20


# Counts -------------------------------------------------------------------------------------------


@compiled
def follow_survivors(seed, first, stop, replicas, times, law, sampler):
    """Return how many starts of blocks ``first`` … ``stop`` − 1 have no collision by each time.

    Starts, ``replicas`` a block, come from a ``StartSampler``. ``times`` ascend.
    """
    rows, starts = new_rows(1, law), np.zeros((12, replicas))
    survivors = np.zeros(times.size, np.int64)
    for block in range(first, stop):
        draw_states(open_stream(seed, block), sampler, starts)
        for i in range(replicas):
            put_state(rows, 0, starts[:, i], law)
            elapsed = time_to_next(state_at(rows, 0, law), law, False, times[-1])
            for k in range(times.size):
                survivors[k] += elapsed > times[k]
    return survivors


def survivors(scene, times, blocks, seed):
    """Return how many starts of a ``Scene`` have no meeting of the discs by each of ``times``.

    The result is a list of integers, from ``blocks`` × ``REPLICAS`` starts of the invariant
    measure. The times ascend.
    """
    law, sampler = two_disc_law(scene), start_sampler(scene)
    counts = follow_survivors(np.uint64(seed), 0, blocks, REPLICAS, np.array(times), law, sampler)
    return [int(n) for n in counts]


# The table ----------------------------------------------------------------------------------------

#: The columns that effects.csv takes from mean_times.csv.
KEPT_COLUMNS = (
    "radius", "exact", "estimate", "stderr", "z", "count", "replicas", "duration", "status", "test",
    "starts", "share",
)  # fmt: skip


def plain_time(box, radius, event):
    """Return the exact mean time of plain discs in the same box, None if there is none."""
    plain = Box(box.width, box.height)
    return exact.mean_times(plain.scene(radius))[event] if plain.fits(radius) else None


def rows(tables, scenes, seed, blocks=MEETING_BLOCKS):
    """Yield the rows of effects.csv.

    ``scenes`` is {name: parameters of its box}, ``tables`` has the rows of <name>/mean_times of
    each. Rough discs are also followed until they meet, from ``blocks`` × ``REPLICAS`` starts at
    each radius of their table, with random streams of the root ``seed``.
    """
    for name, parameters in scenes.items():
        box, times = Box(**parameters), tables[f"{name}/mean_times"]
        start = {"scene": name, "width": box.width, "height": box.height}
        for time in times:
            event = time["event"]
            yield row(
                start | {column: time[column] for column in KEPT_COLUMNS},
                effects=json.dumps(box.effects, sort_keys=True),
                quantity=f"{event}_time",
                plain=plain_time(box, time["radius"], event),
            )
        if "moment_of_inertia" in box.effects:
            for radius in dict.fromkeys(time["radius"] for time in times):
                rough = box.scene(radius)
                for scene in (rough, replace(rough, moment_of_inertia=None)):
                    yield from share_rows(start, scene, seed, blocks)


def share_rows(start, scene, seed, blocks):
    """Yield the rows on the share of starts without a meeting by each of ``TIMES``.

    A scene has no rows unless chaotic discs meet well before the first of them. Smooth discs have a
    law at long times t: by Palm's relation their share is C/(2τt²), if times between collisions
    have the mean τ and the tail C/t³.
    """
    if MEAN_TIMES * exact.mean_times(scene)["disc_collision"] > TIMES[0]:
        return
    starts, box = blocks * REPLICAS, Box(scene.width, scene.height)
    stream = stream_seed(seed, start["scene"], "unmet", key(scene.radius))
    for time, count in zip(TIMES, survivors(scene, TIMES, blocks, stream), strict=True):
        share = estimates.binomial_estimate(count, starts, 1.0)
        enough = not estimates.why_no_error(count, "hits")
        yield row(
            start,
            effects=json.dumps(scene.effects),
            radius=scene.radius,
            quantity="never_met_share",
            plain=share_law(box.scene(scene.radius), time) if box.fits(scene.radius) else None,
            estimate=share and share.value,
            stderr=share.stderr if enough else None,
            count=count,
            replicas=starts,
            duration=time,
            status="sampled" if enough else "too-few" if count else "none-seen",
            starts="invariant",
            share=1.0,
        )


def share_law(plain, time):
    """Return the share of starts of plain discs without a meeting by a long ``time``."""
    mean = exact.mean_times(plain)["disc_collision"]
    return tail_constant(plain, "disc_collision") / (2 * mean * time**2)
