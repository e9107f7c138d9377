"""What a job will take, asked in one place: its work, seconds of a usual core, limits, shards.

The work of a job is that of the blocks that are planned for it: they follow from the exact rates
and the errors asked for, and their price from what they are made of. It is counted in events of
the plain ensemble, and the shards of a point are those blocks. A job that does not run in shards
stops when its errors are reached, mostly earlier.
"""

import math

from twodiscs_paper.pipeline.jobs.point import STAGES

#: What a core does in a second: events and configurations that are drawn, and how many times slower
#: effects make it, at most.
EVENTS_PER_SECOND, SAMPLES_PER_SECOND, SLOWER = 1e8, 1e8, 5.0

#: What an event of a budget takes at most, as events of the plain ensemble: one from a strip with
#: its draws.
DEAREST = 16.0

#: What a sample of more than two discs takes for each of them, as samples of the prism. An event of
#: theirs takes their pairs.
DRAW = 10.0

#: The limit of a job is so many times its price, and so many minutes more to start it.
PATIENCE, MINUTES = 4.0, 10.0

#: So many radii tell what many of them will take.
SOME = 100

DAY = 86400.0


def run_of(scene, stage, radius):
    """Return what the job of a ``SceneRequest`` at a ``radius`` runs.

    ``stage`` is monte_carlo, dynamics or intervals.
    """
    return STAGES[stage](scene.box.scene(radius), **scene.arguments(stage, radius))


def _work(run):
    """Return the work of all planned blocks of a run."""
    return sum(part.planned * part.block_work for part in run.parts.values())


def seconds(scene, stage, radius):
    """Return the processor time of a point, its shards included, roughly, without any start."""
    return _seconds(scene, stage, _work(run_of(scene, stage, radius)))


def _seconds(scene, stage, work):
    """Return the seconds that so much work takes."""
    speed = SAMPLES_PER_SECOND if stage == "monte_carlo" else EVENTS_PER_SECOND
    return work / speed * (SLOWER if scene.box.effects else 1.0)


def _most(scene, stage):
    """Return the work that one radius may take, by the budgets alone."""
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

    It follows from the budgets: no theory is asked.
    """
    most = min(_most(scene, stage), scene.shard_events)
    return math.ceil(MINUTES + PATIENCE * _seconds(scene, stage, most) / 60)


def study_seconds(study, configuration):
    """Return what the tables of a ``Study`` take, roughly."""
    return study.seconds(configuration) if callable(study.seconds) else study.seconds


def study_minutes(study, configuration):
    """Return the limit of time of the job of a ``Study``, in minutes."""
    return math.ceil(MINUTES + PATIENCE * study_seconds(study, configuration) / 60)


def days(scenes):
    """Return the processor time of all jobs of ``scenes`` at their radii, roughly, in days.

    Theory is asked only where the budgets alone allow for a day, and at some of many radii.
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

    Without any it is one job. They depend on the exact rates alone, so they are known before any
    job runs; a smaller error asks for more of the same ones.
    """
    if _most(scene, stage) <= scene.shard_events:
        return []
    from twodiscs.sampling.blocks.rounds import pieces

    run = run_of(scene, stage, radius)
    if _work(run) <= scene.shard_events:
        return []
    return [
        (name, *piece)
        for name, part in run.parts.items()
        for piece in pieces(part.planned, _per_shard(scene, part))
    ]


def _per_shard(scene, part):
    """Return how many blocks of a part a shard has: a power of two, so that shards stay."""
    return 1 << max(0, math.floor(math.log2(scene.shard_events / part.block_work)))
