"""The cost of a job, in one place: its work, seconds of a usual core, limits of time, shards.

The work of a job is the work of its planned blocks. Their number follows from the exact rates and
the requested errors, their cost from their contents. Work is counted in events of the plain
ensemble. The shards of a point are these blocks. A job without shards stops when its errors are
reached, usually earlier.
"""

import math

from twodiscs.dynamics.runs import run_of

#: Events and samples per second of a core, and the largest factor by which effects slow it down.
EVENTS_PER_SECOND, SAMPLES_PER_SECOND, SLOWER = 1e8, 1e8, 5.0

#: The largest cost of an event of a budget, in events of the plain ensemble: an event from a strip,
#: with its draws.
DEAREST = 16.0

#: The cost of a sample of more than two discs, for each disc, in samples of the prism. The cost of
#: an event is proportional to the number of pairs.
DRAW = 10.0

#: The limit of time of a job is ``PATIENCE`` times its cost, and ``MINUTES`` more to start it.
PATIENCE, MINUTES = 4.0, 10.0

#: The number of radii from which the cost of all radii is estimated.
SOME = 100

DAY = 86400.0


def run_at(scene, stage, radius):
    """Return the run of the job of a ``SceneRequest`` at a ``radius``."""
    return run_of(stage, scene.box.scene(radius), scene.arguments(stage))


def _work(run):
    """Return the work of all planned blocks of a run."""
    return sum(part.planned * part.block_work for part in run.parts.values())


def seconds(scene, stage, radius):
    """Return roughly the processor time of a point with its shards, without the start of jobs."""
    return _seconds(scene, stage, _work(run_at(scene, stage, radius)))


def _seconds(scene, stage, work):
    """Return the seconds that ``work`` takes."""
    speed = SAMPLES_PER_SECOND if stage == "monte_carlo" else EVENTS_PER_SECOND
    return work / speed * (SLOWER if scene.box.effects else 1.0)


def _most(scene, stage):
    """Return the most work that one radius may take, by its budgets."""
    discs = scene.box.discs
    sample, event, interval = 1.0, DEAREST, 1.0
    if "discs" in scene.box.calls_for:
        sample, event = DRAW * discs, max(DEAREST, discs**2 / 2)
        interval = event
    return {
        "monte_carlo": sample * scene.monte_carlo["samples"],
        "dynamics": event * scene.event_budget,
        "intervals": interval * scene.histogram["event_budget"],
    }[stage]


def minutes(scene, stage):
    """Return the limit of time of a job of a ``stage``, point or shard, in minutes.

    It follows from the budgets, without theory.
    """
    most = min(_most(scene, stage), scene.shard_events)
    return math.ceil(MINUTES + PATIENCE * _seconds(scene, stage, most) / 60)


def study_seconds(study, configuration):
    """Return roughly the seconds that the tables of a ``Study`` take."""
    return study.seconds(configuration) if callable(study.seconds) else study.seconds


def study_minutes(study, configuration):
    """Return the limit of time of the job of a ``Study``, in minutes."""
    return math.ceil(MINUTES + PATIENCE * study_seconds(study, configuration) / 60)


def days(scenes):
    """Return the processor time of all jobs of ``scenes`` at their radii, roughly, in days.

    Theory is used only if the budgets allow for more than a day, and then at some of many radii.
    """
    total = 0.0
    for scene in scenes:
        for stage, keys in scene.keys.items():
            total += len(keys) * _seconds(scene, stage, _most(scene, stage)) / DAY
            if total > 1:
                return sum(_days(scene) for scene in scenes)
    return total


def _days(scene):
    total = 0.0
    for stage, keys in scene.keys.items():
        some = [*keys.values()][:: -(-len(keys) // SOME) or 1]
        taken = sum(seconds(scene, stage, radius) for radius in some)
        total += taken * len(keys) / max(1, len(some)) / DAY
    return total


def shards(scene, stage, radius):
    """Return the shards (part, first, stop) of a point, blocks ``first`` … ``stop`` − 1 of a part.

    A point without shards is one job. Shards depend only on the exact rates, so they are known
    before any job runs. A smaller error adds shards to the same ones.
    """
    if _most(scene, stage) <= scene.shard_events:
        return []
    from twodiscs.sampling.rounds import pieces

    run = run_at(scene, stage, radius)
    if _work(run) <= scene.shard_events:
        return []
    return [
        (name, *piece)
        for name, part in run.parts.items()
        for piece in pieces(part.planned, _per_shard(scene, part))
    ]


def _per_shard(scene, part):
    """Return the number of blocks in a shard of a part: a power of two, so that shards stay."""
    return 1 << max(0, math.floor(math.log2(scene.shard_events / part.block_work)))
