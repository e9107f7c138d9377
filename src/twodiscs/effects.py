"""What each effect does to the mean times, and rough discs that never meet.

The scenes are those of the files in ``config/scenes``. Each is counted here as it is when it is
built alone, from the same seeds, and set beside plain discs in the same box.
"""

from dataclasses import replace

import numpy as np

from twodiscs import comparison, config, parameters, statistics, theory
from twodiscs.checks import a_scene, whole
from twodiscs.dynamics import (
    REPLICAS,
    count_events,
    draw_any_starts,
    new_rows,
    origins,
    put_state,
    state_at,
)
from twodiscs.events import DISC, after_event, law_of, next_event
from twodiscs.grid import key, stream_seed
from twodiscs.jit import compiled
from twodiscs.scene import Scene, fits, length
from twodiscs.streams import open_stream

#: Blocks of starts, of ``REPLICAS`` each, that are followed until their discs meet, and the times
#: at which those are counted that have not.
BLOCKS = 1024
TIMES = (1e2, 1e3, 1e4)

#: Discs that meet by chance do so within so many mean times: only e^−20 of them have not.
BY_CHANCE = 20


def read(path, seed):
    """Return the ``SceneRequest`` of the file ``path``, which asks for one scene with effects.

    The root ``seed`` is for a file that names none, as that of the configuration is for a file laid
    over it. Raises ``ValueError`` for any other file, ``OSError`` for one that cannot be read.
    """
    scenes = config.load({"seed": seed} | config.read(path)).scenes
    if len(scenes) != 1 or not scenes[0].effects or not scenes[0].watch.mean_times:
        raise ValueError(f"{path} must hold one scene, with effects, that watches mean times")
    return scenes[0]


# What is counted ----------------------------------------------------------------------------------


@compiled
def follow_unmet(seed, first, stop, replicas, times, law, draw, prism):
    """Return how many starts of blocks ``first`` … ``stop`` − 1 have no collision by each time.

    Starts, ``replicas`` a block, come from ``draw``, or from ``prism`` unless it is None. ``times``
    ascend.
    """
    rows, starts = new_rows(1, law), np.zeros((12, replicas))
    unmet = np.zeros(times.size, np.int64)
    for block in range(first, stop):
        draw_any_starts(open_stream(seed, block), draw, (0, 0), starts, prism)
        for i in range(replicas):
            put_state(rows, 0, starts[:, i], law)
            elapsed = 0.0
            while elapsed <= times[-1]:
                state = state_at(rows, 0, law)
                time, code = next_event(state, np.inf, law)
                elapsed += time
                if code == DISC:
                    break
                put_state(rows, 0, after_event(state, time, code, law), law)
            for k in range(times.size):
                unmet[k] += elapsed > times[k]
    return unmet


def unmet(scene, times, blocks, seed):
    """Return for how many starts of a ``Scene`` the discs have not met by each of ``times``.

    Of ``blocks`` × ``REPLICAS`` starts of the invariant measure, a list of integers. Raises
    ``ValueError`` for anything that is not a ``Scene``, for ``times`` that do not ascend, and for a
    number out of range.
    """
    law, (draw, prism) = law_of(a_scene(scene)), origins(scene)
    values = [length("time", time) for time in times]
    if not values or sorted(set(values)) != values:
        raise ValueError(f"times must ascend, and there must be some, not {values!r}")
    blocks, seed = whole("blocks", blocks), np.uint64(whole("seed", seed, 0))
    found = follow_unmet(seed, 0, blocks, REPLICAS, np.array(values), law, draw, prism)
    return [int(n) for n in found]


def count(request, blocks=BLOCKS):
    """Return what is counted of a ``SceneRequest``, a dict for a JSON file.

    Its name, box (with the effects) and dynamics, the points of ``count_events``; and unmet, for
    rough discs: how many of ``blocks`` × ``REPLICAS`` starts have not met by each of ``TIMES``, for
    the scene and for smooth discs, at the radii where meeting by chance takes much less.
    """
    jobs = map(request.dynamics_parameters, request.dynamics_keys)
    points = [
        count_events(
            request.scene(job["radius"]), job["accuracy"], job["event_budget"], job["seed"]
        )
        for job in jobs
    ]
    rough = "moment_of_inertia" in request.effects
    return {
        "name": request.name,
        "box": request.box_parameters(),
        "dynamics": points,
        "unmet": list(_unmet_points(request, blocks)) if rough else [],
    }


def _unmet_points(request, blocks):
    """Yield the counts of starts that have not met, with rough discs and with smooth ones."""
    for radius in request.radii:
        rough = request.scene(radius)
        for scene in (rough, replace(rough, moment_of_inertia=None)):
            if BY_CHANCE * theory.mean_times(scene)["disc_collision"] <= TIMES[0]:
                seed = stream_seed(request.seed, request.name, "unmet", key(radius))
                yield {
                    "radius": radius,
                    "effects": scene.effects,
                    "starts": blocks * REPLICAS,
                    "counts": unmet(scene, TIMES, blocks, seed),
                }


# The table ----------------------------------------------------------------------------------------


def rows(found):
    """Return the rows of effects.csv of one scene, from what ``count`` returned."""
    box = found["box"]
    start = {"scene": found["name"], "width": box["width"], "height": box["height"]}
    times = [_mean_time_row(box, row) for row in _compared(box, found["dynamics"])]
    shares = [
        _unmet_row(box, point, time, n)
        for point in found["unmet"]
        for time, n in zip(TIMES, point["counts"], strict=True)
    ]
    return [start | row for row in (*times, *shares)]


def _compared(box, points):
    """Return the rows of mean_times.csv for the ``points`` of a scene."""
    scenes = [parameters.scene(box, point["radius"]) for point in points]
    exact = {
        (scene.radius, f"{event}_time"): time
        for scene in scenes
        for event, time in theory.mean_times(scene).items()
    }
    return comparison.mean_time_rows(scenes[0], exact, points)


def _plain(box, radius):
    """Return the plain ``Scene`` in the same box, or None if its discs do not fit."""
    sides = box["width"], box["height"]
    return Scene(*sides, radius) if fits(*sides, radius) else None


def _mean_time_row(box, row):
    plain = _plain(box, row["radius"])
    kept = ("radius", "exact", "estimate", "stderr", "z", "count", "replicas", "duration", "status")
    return {name: row[name] for name in kept} | {
        "effects": repr(box["effects"]),
        "quantity": f"{row['event']}_time",
        "plain": theory.mean_times(plain)[row["event"]] if plain else None,
        "test": row["test"],
    }


def _law(plain, time):
    """Return the share of smooth starts that have not met by a long ``time``.

    Palm's relation makes it C/(2τt²) of the tail C/t³ of the times between collisions, of mean τ.
    """
    mean = theory.mean_times(plain)["disc_collision"]
    return theory.tail_constant(plain, "disc_collision") / (2 * mean * time**2)


def _unmet_row(box, point, time, count):
    """Return the row of the share of starts that have not met by a ``time``."""
    plain = _plain(box, point["radius"])
    share = statistics.binomial_estimate(count, point["starts"], 1.0)
    honest = count >= statistics.HONEST
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
    }
