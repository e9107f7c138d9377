"""The cost of a job, in one place: its work, seconds of a usual core, limits of time, shards.

The work of a job is the work of its planned blocks. Their number follows from the exact rates and
the requested errors, their cost from their contents. Work is counted in events of the plain
ensemble. The shards of a point are these blocks. A job without shards stops when its errors are
reached, usually earlier. ``forecast`` measures the cost by pilots.
"""

import math
from itertools import groupby
from operator import itemgetter
from pathlib import Path

from twodiscs.analysis.tables import CostTable, MeanTimesTable, shortfall
from twodiscs.dynamics.stages import STAGES
from twodiscs.model.checks import InputError
from twodiscs.model.formats import format_number, format_seconds
from twodiscs.theory import exact
from twodiscs_paper.catalogue import STUDIES
from twodiscs_paper.pipeline.points import read_point, read_seconds, shard_ranges

#: Events and samples per second of a core, and the largest factor by which effects slow it down.
WORK_PER_SECOND, EFFECTS_FACTOR = 1e8, 5.0

#: The largest cost of an event of a budget, in events of the plain ensemble: an event from a strip,
#: with its draws.
DEAREST_EVENT = 16.0

#: The cost of a sample of more than two discs, for each disc, in samples of the prism. The cost of
#: an event is proportional to the number of pairs.
DRAW_COST = 10.0

#: The limit of time of a job is ``LIMIT_RATIO`` times its cost, and ``LIMIT_MINUTES`` more to start
#: it.
LIMIT_RATIO, LIMIT_MINUTES = 4.0, 10.0

#: The number of radii from which the cost of all radii is estimated.
TRIED_RADII = 100

#: Processor seconds of a pilot at one radius; the most sentences on accuracies not reached.
FORECAST_SECONDS, SENTENCES = 0.1, 8

DAY = 86400.0


def run_at(scene, stage, radius):
    """Return the run of the job of a ``SceneRequest`` at a ``radius``."""
    return STAGES[stage].run(scene.box.scene(radius), scene.arguments(stage))


def _work(run):
    """Return the work of all planned blocks of a run."""
    return sum(one.planned * one.block_work for one in run.components.values())


def seconds(scene, stage, radius):
    """Return roughly the processor time of a point with its shards, without the start of jobs."""
    return _seconds(scene, _work(run_at(scene, stage, radius)))


def _seconds(scene, work):
    """Return the seconds that ``work`` takes."""
    return work / WORK_PER_SECOND * (EFFECTS_FACTOR if scene.box.effects else 1.0)


def _most(scene, stage, radius=None):
    """Return the most work that one radius may take, by its budgets or for its accuracy.

    The work for the accuracy, or for the intervals of a histogram, is an upper bound from exact
    rates, if a ``radius`` is given.
    """
    discs = scene.box.discs
    sample, event, interval = 1.0, DEAREST_EVENT, 1.0
    if "discs" in scene.box.options:
        sample, event = DRAW_COST * discs, max(DEAREST_EVENT, discs**2 / 2)
        interval = event
    each, most, needed = {
        "monte_carlo": (sample, scene.monte_carlo["samples"], None),
        "dynamics": (event, scene.event_budget or DAY * WORK_PER_SECOND, _events),
        "intervals": (interval, scene.histogram["event_budget"], _interval_events),
    }[stage]
    return each * (min(most, needed(scene, radius)) if radius and needed else most)


def _events(scene, radius):
    """Return the planned events of the errors of dynamics without strips, inf if not known."""
    one = scene.box.scene(radius)
    if one.discs > 2 or one.moment_of_inertia is not None:
        return math.inf  # other numbers of replicas, and bursts
    every, most = exact.event_rate(one), 0.0
    for event, error in scene.target.items():
        if one.is_possible(event):
            rate = exact.rate(one, event) * one.copies(event)
            most = max(most, (2 * every / rate + 256 / 6) / error**2)
    return most


def _interval_events(scene, radius):
    """Return a bound on the events of the intervals of a histogram, inf if none is known."""
    one = scene.box.scene(radius)
    if one.discs > 3 or exact.event_rate(one) is None:
        return math.inf
    # Blocks of 2^16 are full, and a window of three discs has up to twice as many intervals.
    most = 2 * (scene.histogram["intervals"] + 2**16)
    return most * exact.events_per_interval(one, scene.histogram["event"])


def minutes(scene, stage):
    """Return the limit of time of a job of a ``stage``, point or shard, in minutes.

    It follows from the budgets, without theory.
    """
    most = min(_most(scene, stage), scene.shard_events)
    return math.ceil(LIMIT_MINUTES + LIMIT_RATIO * _seconds(scene, most) / 60)


def study_seconds(study, configuration):
    """Return roughly the seconds that the tables of a ``Study`` take."""
    return study.seconds(configuration) if callable(study.seconds) else study.seconds


def study_minutes(study, configuration):
    """Return the limit of time of the job of a ``Study``, in minutes."""
    return math.ceil(LIMIT_MINUTES + LIMIT_RATIO * study_seconds(study, configuration) / 60)


def days(scenes):
    """Return the processor time of all jobs of ``scenes`` at their radii, roughly, in days.

    Plans are made only if their upper bounds allow for more than a day, at some of many radii.
    """
    total = 0.0
    for scene in scenes:
        for stage, keys in scene.keys.items():
            most = (_most(scene, stage, radius) for radius in keys.values())
            total += sum(_seconds(scene, work) for work in most) / DAY
            if total > 1:
                return sum(_days(scene) for scene in scenes)
    return total


def _days(scene):
    total = 0.0
    for stage, keys in scene.keys.items():
        some = [*keys.values()][:: -(-len(keys) // TRIED_RADII) or 1]
        taken = sum(seconds(scene, stage, radius) for radius in some)
        total += taken * len(keys) / max(1, len(some)) / DAY
    return total


def shards(scene, stage, radius):
    """Return the shards of a point, (component, first, stop): its blocks ``first`` … ``stop`` − 1.

    A point without shards is one job. Shards depend only on the exact rates, so they are known
    before any job runs. A smaller error adds shards to the same ones.
    """
    # The bound by budgets is quick, the bound by rates is not.
    if any(_most(scene, stage, by) <= scene.shard_events for by in (None, radius)):
        return []
    run = run_at(scene, stage, radius)
    if _work(run) <= scene.shard_events:
        return []
    return [
        (name, *ends)
        for name, one in run.components.items()
        for ends in shard_ranges(one.planned, _per_shard(scene, one))
    ]


def _per_shard(scene, run):
    """Return the number of blocks in a shard of a ``SequentialRun``: a power of two."""
    return 1 << max(0, math.floor(math.log2(scene.shard_events / run.block_work)))


# Pilots -------------------------------------------------------------------------------------------


def forecast(scene, stage, radius):
    """Return the ``Forecast`` of a job from a pilot, and its run."""
    from twodiscs.measure import cost
    from twodiscs_paper.pipeline.forecast import Forecast, forecast_dynamics, forecast_samples

    run = run_at(scene, stage, radius)
    in_shards = bool(shards(scene, stage, radius))
    if stage == "dynamics":
        return forecast_dynamics(run, cost.pilots(run, FORECAST_SECONDS), in_shards), run
    if stage == "monte_carlo":
        return forecast_samples(run, FORECAST_SECONDS), run
    one = run.components["all"]
    each = cost.timed(one.work, FORECAST_SECONDS)[-1]
    return Forecast(each * one.planned, {}), run


def _is_short(scene, radius):
    """Return whether the budget of dynamics at a ``radius`` may end it before its accuracy."""
    runs = run_at(scene, "dynamics", radius).components.values()
    return any(one.budget <= 1.1 * one.planned * one.block_events for one in runs)


def _measured_shortfall(scene, radius, path):
    """Return a sentence on the accuracy that the point at ``path`` did not reach, "" if it did.

    The result is None if there is no point of the same settings.
    """
    settings = scene.arguments("dynamics")
    try:
        point = read_point(path, STAGES["dynamics"], scene.box.scene(radius), settings)
    except (InputError, OSError):
        return None
    rows = MeanTimesTable.rows([point])
    return shortfall(rows, scene.event_budget, point.work, read_seconds(path)) or ""


def shortfalls(configuration):
    """Return sentences on the accuracies that budgets keep the scenes from.

    They are about the points that are built, and from pilots about the others. Only pilots import
    kernels.
    """
    short, lines = [], []
    for scene in configuration.scenes:
        paths = configuration.points(scene.name, "mean_times")["dynamics"]
        for radius, path in zip(scene.keys["dynamics"].values(), paths, strict=True):
            if not scene.event_budget or _events(scene, radius) > scene.event_budget:
                text = _measured_shortfall(scene, radius, path)
                if text or (text is None and _is_short(scene, radius)):
                    short.append((scene, radius, text))
    for scene, radius, text in short[:SENTENCES]:
        if text is None:
            one, run = forecast(scene, "dynamics", radius)
            text = one.shortfall(run)
        if text:
            lines.append(f"{scene.name}, radius {radius!r}: {text}")
    if len(short) > SENTENCES:
        lines.append(f"{len(short) - SENTENCES} more radii may stop early: see the target forecast")
    return lines


def taken(results, scene):
    """Return {stage: ({radius: (events, seconds)}, events per second)} of the jobs of a build.

    ``scene`` is one of ``Configuration.described``, whose tables are in the folder ``results``. The
    speed is that of the fastest job: the first jobs compile.
    """
    path, found = Path(results, scene["name"], "cost.csv"), {}
    for row in CostTable.read(path) if path.exists() else ():
        jobs = found.setdefault(row["stage"], {})
        jobs[row["radius"]] = row["events"], row["seconds"]
    return {
        stage: (jobs, max((n / s for n, s in jobs.values() if s), default=None))
        for stage, jobs in found.items()
    }


def missed(results, scene):
    """Return sentences on the accuracies that the dynamics of a build did not reach.

    The arguments are those of ``taken``.
    """
    path, found = Path(results, scene["name"], "mean_times.csv"), []
    jobs, speed = taken(results, scene).get("dynamics", ({}, None))
    table = MeanTimesTable.read(path) if path.exists() else ()
    for radius, rows in groupby(table, itemgetter("radius")):
        events, _ = jobs.get(radius, (None, None))
        seconds = events / speed if events and speed else None
        if text := shortfall([*rows], scene["event_budget"], events, seconds):
            found.append(f"{scene['name']}, radius {radius!r}: {text}")
    return found


def table(configuration):
    """Return the forecast of a ``Configuration`` as text: a row for each job, and their sum."""
    from tabulate import tabulate

    from twodiscs.measure.cost import machine

    rows, lines, total = [], [], 0.0
    for scene in configuration.scenes:
        for stage, keys in scene.keys.items():
            for radius in keys.values():
                one, run = forecast(scene, stage, radius)
                worst = max(one.reached, key=one.reached.get, default="")
                asked = format_number(scene.target[worst], "g") if stage == "dynamics" else ""
                error = format_number(one.reached[worst], ".1e") if worst else ""
                taken = format_seconds(one.seconds)
                rows.append((scene.name, stage, repr(radius), taken, asked, error, worst))
                total += one.seconds
                if stage == "dynamics" and (text := one.shortfall(run)):
                    lines.append(f"{scene.name}, radius {radius!r}: {text}")
    studies = [STUDIES[name] for name in configuration.shared if name in STUDIES]
    of_studies = sum(study_seconds(study, configuration) for study in studies)
    headers = ("scene", "stage", "radius", "time", "asked", "reached", "by")
    lines.append(
        f"{format_seconds(total)} on one core of {machine()}, without the start of {len(rows)} jobs"
        + (f"; and {format_seconds(of_studies)} of studies" if studies else "")
    )
    return "\n".join([tabulate(rows, headers, disable_numparse=True), "", *lines])
