"""What a job will take, asked in one place: events, seconds of a usual core, limits, shards.

The events that an error takes follow from the exact rates: a relative error ε of events that come
in clusters of K takes K/ε² of them. Rare hops are counted from strips, at a price of their own
(``dynamics.strip``).
"""

import math

from twodiscs.pipeline.jobs.point import STAGES
from twodiscs.theory import exact

#: What a core does in a second: events and configurations that are drawn, and how many times slower
#: effects make it, at most.
EVENTS_PER_SECOND, SAMPLES_PER_SECOND, SLOWER = 1e8, 1e8, 5.0

#: Counts that a relative error of one takes, and events of a strip: rounded up from what jobs took.
CLUSTER, STRIP = 2.0, 4.0

#: The limit of a job is so many times its price, and so many minutes more to start it.
PATIENCE, MINUTES = 4.0, 10.0

#: So many radii tell what many of them will take.
SOME = 100

DAY = 86400.0


def events(scene, stage, radius):
    """Return the events of dynamics, samples or intervals of the job at a ``radius``, roughly.

    ``scene`` is a ``SceneRequest``, ``stage`` monte_carlo, dynamics or intervals.
    """
    here = scene.box.scene(radius)
    if stage == "monte_carlo":
        return float(scene.monte_carlo["samples"])
    if stage == "intervals":
        each = exact.events_per_interval(here, scene.histogram["event"])
        return min(scene.histogram["intervals"], scene.histogram["event_budget"] / each)
    from twodiscs.dynamics.strip import rare_hops

    total, times, rare = exact.event_rate(here), exact.mean_times(here), rare_hops(here)
    strips = sum(STRIP / scene.target[hop] ** 2 for hop in rare if hop in scene.target)
    others = (
        CLUSTER * total * times[event] / here.multiplicity(event) / error**2
        for event, error in scene.target.items()
        if times[event] is not None and event not in rare
    )
    return min(scene.event_budget, max(others, default=0.0) + strips)


def seconds(scene, stage, radius):
    """Return the processor time of the job at a ``radius``, roughly, without its start."""
    number = events(scene, stage, radius)
    if stage == "intervals":
        number *= exact.events_per_interval(scene.box.scene(radius), scene.histogram["event"])
    return _seconds(scene, stage, number)


def _seconds(scene, stage, number):
    """Return the seconds that so many samples or events take."""
    speed = SAMPLES_PER_SECOND if stage == "monte_carlo" else EVENTS_PER_SECOND
    return number / speed * (SLOWER if scene.effects else 1.0)


def _most(scene, stage):
    """Return the samples or events that the job of one radius may take, by the budgets alone."""
    return {
        "monte_carlo": scene.monte_carlo["samples"],
        "dynamics": scene.event_budget,
        "intervals": scene.histogram["event_budget"],
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


def run_of(scene, stage, radius):
    """Return what the job of a ``SceneRequest`` at a ``radius`` runs."""
    return STAGES[stage](scene.box.scene(radius), **scene.arguments(stage, radius))


def shards(scene, stage, radius):
    """Return the shards (part, first, stop) of a point, blocks ``first`` … ``stop`` − 1 of a part.

    Without any it is one job. They depend on the exact rates alone, so they are known before any
    job runs; a smaller error asks for more of the same ones.
    """
    if _most(scene, stage) <= scene.shard_events:
        return []
    from twodiscs.sampling.blocks.rounds import pieces

    parts = run_of(scene, stage, radius).parts
    work = {name: run.block_events * run.cost_ratio for name, run in parts.items()}
    if sum(work[name] * run.planned for name, run in parts.items()) <= scene.shard_events:
        return []
    return [
        (name, *piece)
        for name, run in parts.items()
        for piece in pieces(
            run.planned, 1 << max(0, math.floor(math.log2(scene.shard_events / work[name])))
        )
    ]
