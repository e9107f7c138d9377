"""What a configuration is going to take, before it is paid for.

The events that a mean time takes follow from its rate, which is known exactly, and from how evenly
or in what clusters they come, which a pilot at each radius says. The pilots also say how fast this
machine is, with as many of them at once as there will be jobs. What a job takes besides, to start
Python, to load compiled code, to draw a figure, is seen by running one job of each kind.
"""

import json
import math
import os
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from statistics import fmean
from typing import NamedTuple

from twodiscs.comparison.scene_tables import Forecast
from twodiscs.figures.catalogue import FIGURES
from twodiscs.model.box import Box
from twodiscs.model.checks import whole
from twodiscs.model.radii import key
from twodiscs.pipeline.arguments import Parser, end_with_workflow, parameters, run
from twodiscs.pipeline.configuration.request import STAGES
from twodiscs.studies.catalogue import STUDIES

#: Random numbers of the pilots, other than those of the jobs.
SEED = 5

#: Blocks of a pilot: of replicas as in the first round of a job, of samples.
SAMPLE_BLOCKS = 8

#: Pilots of a stage of a scene, evenly spread over its radii where there are more of them; wall and
#: disc events of one that records intervals.
MOST_PILOTS, FEW_EVENTS = 64, 4e6

#: Fewer counts than this say nothing about clusters; then as many events count as one. Hops are
#: that rare just below their thresholds only, where runs found between 1.1 and 1.3.
FEWEST, CLUSTER = 1000, 1.2

#: A job asks for this much more than it seems to need, so that it need not come back for a little.
MARGIN = 1.05

#: One job of each kind, at a radius of the paper's box: small, for its start is what counts.
PLACE = {"box": {"width": 1.5, "height": 1.0}, "radius": 0.2, "seed": SEED}
SAMPLES = {
    "monte_carlo": PLACE | {"areas": ["top_wall"], "samples": 1, "shell": 0.02, "volume": True},
    "dynamics": PLACE | {"accuracy": {"vertical_hop": 0.5}, "event_budget": 1},
    "intervals": PLACE | {"event": "vertical_hop", "intervals": 1},
}

#: Times each sample job runs, after a first one that may find its code not compiled.
TRIALS = 2

#: Seconds of the documents; round figures.
DOCUMENTS = {"paper": 1.5, "report": 1.5}

#: Seconds in which the kernels are compiled.
COMPILATION = 12.0


class Pilot(NamedTuple):
    """What one job will take: its events (samples, intervals), and seconds for each million."""

    events: int
    seconds_per_million: float


class Start(NamedTuple):
    """What a job takes besides its events: seconds to load code, seconds before and after."""

    loading: float
    startup: float


# Pilots -----------------------------------------------------------------------------------------


def _timed(work, units):
    """Return (result, processor seconds per million units) of ``work()``, once it is compiled."""
    start = time.process_time()
    result = work()
    return result, 1e6 * (time.process_time() - start) / units(result)


def _scene(job):
    return Box(**job["box"]).scene(job["radius"])


def pilot_monte_carlo(job):
    """Return the ``Pilot`` of a job of Monte Carlo, given its parameters."""
    from twodiscs.sampling import montecarlo

    scene = _scene(job)
    quantities = ["volume"] * job["volume"] + [f"{event}_area" for event in job["areas"]]

    def sample(samples):
        return montecarlo.better_point(scene, quantities, samples, job["shell"], SEED)

    sample(1)
    done = min(job["samples"], SAMPLE_BLOCKS * montecarlo.BLOCK)
    _, cost = _timed(lambda: sample(done), lambda point: point["samples"])
    return Pilot(montecarlo.plan(scene, job["samples"])[1], cost)


def pilot_intervals(job):
    """Return the ``Pilot`` of a job of hop intervals, given its parameters."""
    from twodiscs.dynamics import intervals
    from twodiscs.theory import exact

    scene, block = _scene(job), intervals.CHAINS * intervals.RETURNS
    events = exact.events_per_interval(scene, job["event"])
    chains = max(1, min(intervals.CHAINS, int(FEW_EVENTS / events / intervals.RETURNS)))
    returns = max(1, min(intervals.RETURNS, int(FEW_EVENTS / events)))

    def record():
        return intervals.recorded(scene, job["event"], 1, chains, returns, SEED)

    record()
    _, cost = _timed(record, lambda _: chains * returns)
    wanted = min(job["intervals"], job["event_budget"] / events)
    return Pilot(math.ceil(wanted / block) * block, cost)


def pilot_dynamics(job):
    """Return the ``Pilot`` of a job of molecular dynamics, given its parameters."""
    from twodiscs.dynamics import counting, strip
    from twodiscs.sampling.rounds import FIRST_ROUND

    scene = _scene(job)
    duration = counting.replica_duration(scene)
    rare = [hop for hop in strip.rare_hops(scene) if hop in job["accuracy"]]
    job = job | {"event_budget": job["event_budget"] // (1 + len(rare))}

    def count(blocks):
        return counting.run_blocks(scene, tuple(job["accuracy"]), SEED, 0, blocks, duration)

    def events(counted):
        return counting.simulated_events(counted[0])

    count(1)
    counted, cost = _timed(lambda: count(FIRST_ROUND), events)
    pilots = [Pilot(events_of_job(scene, job, counted, events(counted), rare), cost)]
    pilots += [pilot_strip(scene, hop, job) for hop in rare]
    total = sum(pilot.events for pilot in pilots)
    return Pilot(total, sum(math.prod(pilot) for pilot in pilots) / total)


def pilot_strip(scene, hop, job):
    """Return the ``Pilot`` of a rare ``hop`` of a job."""
    from twodiscs.dynamics import strip
    from twodiscs.sampling.rounds import FIRST_ROUND

    place = strip.strip_of(scene, hop)

    def count(blocks):
        return strip.run_blocks(scene, hop, place, SEED, 0, blocks)

    count(1)
    (found, events), cost = _timed(lambda: count(FIRST_ROUND), lambda sums: sums[1])
    error = strip.relative_error(strip.fractions_of(scene, hop, place), found)
    excess = error / job["accuracy"][hop]
    needed = min(max(1.0, MARGIN * excess**2) * events, job["event_budget"])
    return Pilot(round(needed), cost)


def events_of_job(scene, job, counted, done, rare=()):
    """Return the wall and disc events that a job of molecular dynamics will simulate.

    ``counted`` are (sums, products) of a pilot of ``done`` events. A relative error ε takes f/ε²
    events of its kind, with f measured by the pilot where it saw enough of them. ``rare`` hops are
    not waited for.
    """
    from twodiscs.dynamics import counting, ensemble
    from twodiscs.model.events import EVENTS
    from twodiscs.sampling.rounds import FIRST_ROUND
    from twodiscs.theory import exact

    errors = ensemble.relative_errors(*counted, FIRST_ROUND * ensemble.REPLICAS)
    total = exact.event_rate(scene)
    needed = 0.0
    for event, error in job["accuracy"].items():
        if not scene.is_possible(event) or event in rare:
            continue
        i = EVENTS.index(event)
        if counted[0][i] >= FEWEST:
            alone = done * float(errors[i]) ** 2
        else:
            time = exact.mean_times(scene)[event] / scene.copies(event)
            alone = CLUSTER * total * time
        needed = max(needed, alone / error**2)
    usual = ensemble.REPLICAS * counting.EVENTS_PER_REPLICA
    blocks = max(1, min(FIRST_ROUND, job["event_budget"] // usual))
    first = blocks * ensemble.REPLICAS * counting.replica_duration(scene) * total
    if needed > first:
        needed *= MARGIN
    return round(max(first, min(needed, job["event_budget"])))


PILOTS = {
    "monte_carlo": pilot_monte_carlo,
    "dynamics": pilot_dynamics,
    "intervals": pilot_intervals,
}


def _run_pilot(stage_and_job):
    stage, job = stage_and_job
    return PILOTS[stage](job)


def run_pilots(jobs, cores):
    """Return the ``Pilot`` of each of ``jobs``, pairs (stage, parameters), ``cores`` at a time."""
    with ProcessPoolExecutor(cores, get_context("spawn"), end_with_workflow) as pool:
        return list(pool.map(_run_pilot, jobs))


# Starts -----------------------------------------------------------------------------------------


def _run_sample(kind):
    """Run one small job of a ``kind`` in a process of its own and return its ``Start``."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        cost = place / f"{kind}-0.2.json"
        command = [sys.executable, "-m", "twodiscs.pipeline.jobs"]
        if kind in SAMPLES:
            command += ["point", STAGES[kind], "--parameters", json.dumps(SAMPLES[kind])]
            command += ["--output", place / "point.json", "--cost", cost]
        elif kind == "tables":
            (place / "cost").mkdir()
            (place / "cost" / "dynamics-0.2.json").write_text('{"events": 1, "seconds": 1.0}')
            command += ["table", "comparison.gather", "--function", "cost_rows", "--points", place]
            command += ["--parameters", '{"keys": {"dynamics": ["0.2"]}}']
            command += ["--output", place / "cost.csv"]
        else:
            given = json.dumps({"box": PLACE["box"]})
            command += ["figure", "figures.geometry.model", "--parameters", given]
            command += ["--output", place / "model.pdf", place / "model.png"]
        start = time.perf_counter()
        subprocess.run(command, check=True, env=os.environ, stdout=subprocess.DEVNULL)
        seconds = time.perf_counter() - start
        loading = json.loads(cost.read_text())["seconds"] if cost.exists() else 0.0
    return Start(loading, max(0.0, seconds - loading))


def run_samples(kinds, cores):
    """Return {kind: Start} of stages, ``tables`` and ``figures``, ``cores`` jobs at a time."""
    with ThreadPoolExecutor(cores) as pool:
        list(pool.map(_run_sample, kinds))
        found = list(pool.map(_run_sample, [*kinds] * TRIALS))
    trials = {kind: found[i :: len(kinds)] for i, kind in enumerate(kinds)}
    return {kind: Start(*map(fmean, zip(*starts, strict=True))) for kind, starts in trials.items()}


# The forecast -----------------------------------------------------------------------------------


def jobs_of(request):
    """Return the jobs of a ``SceneRequest``: pairs (stage, parameters)."""
    return [(stage, request.job(stage, key)) for stage in STAGES for key in request.keys[stage]]


def stand_ins(jobs):
    """Return for each of ``jobs`` the index of the one whose pilot tells of it.

    That is itself unless a stage has more than ``MOST_PILOTS``, then one near by.
    """
    found = []
    for stage in STAGES:
        places = [i for i, (name, _) in enumerate(jobs) if name == stage]
        step = -(-len(places) // MOST_PILOTS) or 1
        found += [
            places[min(n - n % step + step // 2, len(places) - 1)] for n in range(len(places))
        ]
    return found


def row(scene, stage, cores, jobs, events=None, seconds=0.0, startup=0.0, radius=None):
    """Return a row of forecast.csv."""
    return {
        "scene": scene,
        "stage": stage,
        "radius": radius,
        "jobs": jobs,
        "events": events,
        "seconds": seconds,
        "startup": startup,
        "cores": cores,
        "wall_clock": (seconds + startup) / min(cores, max(1, jobs)),
    }


def summed(scene, stage, cores, rows):
    """Return the row that is the sum of ``rows``."""
    events = [one["events"] for one in rows if one["events"] is not None]
    return row(
        scene, stage, cores, sum(one["jobs"] for one in rows),
        sum(events) if events else None,
        sum(one["seconds"] for one in rows), sum(one["startup"] for one in rows),
    )  # fmt: skip


def scene_rows(request, pilots, starts, cores):
    """Return the rows of one scene: every job, its stages and their total."""
    jobs, sums = [], []
    most = {s: request.shard_events if request.is_sharded(s) else math.inf for s in STAGES}
    first = {s: {keys[0] for keys in request.bundles[s].values()} for s in STAGES}
    for (stage, job), pilot in zip(jobs_of(request), pilots, strict=True):
        # The first point of a bundle starts the job of all of them.
        starting = key(job["radius"]) in first[stage]
        count = max(1, math.ceil(pilot.events / most[stage])) if starting else 0
        seconds = count * starts[stage].loading + pilot.events * pilot.seconds_per_million / 1e6
        startup = count * starts[stage].startup
        jobs.append(
            row(request.name, stage, cores, count, pilot.events, seconds, startup, job["radius"])
        )
    for stage in STAGES:
        found = [one for one in jobs if one["stage"] == stage]
        if found:
            sums.append(summed(request.name, stage, cores, found))
    watched, effects = request.watch.quantities, request.effects
    figures = sum(figure.is_called(watched, effects) for figure in FIGURES.values())
    for kind, count in (("tables", len(request.tables)), ("figures", figures)):
        sums.append(row(request.name, kind, cores, count, startup=count * sum(starts[kind])))
    return [*jobs, *sums, summed(request.name, "total", cores, sums)]


def rows(configuration, cores):
    """Return the rows of forecast.csv for a ``Configuration`` on ``cores`` ≥ 1 cores.

    Raises ``InputError`` for another number of them.
    """
    cores = whole("cores", cores)
    requests = configuration.scenes
    jobs = [jobs_of(request) for request in requests]
    kinds = [stage for stage in STAGES if any(stage == s for one in jobs for s, _ in one)]
    starts = run_samples([*kinds, "tables", "figures"], cores)
    places = [(n, i) for n, one in enumerate(jobs) for i in stand_ins(one)]
    flown = list(dict.fromkeys(places))
    pilots = dict(zip(flown, run_pilots([jobs[n][i] for n, i in flown], cores), strict=True))
    found, sums = [], []
    for n, request in enumerate(requests):
        found += scene_rows(request, [pilots[p] for p in places if p[0] == n], starts, cores)
        sums.append(found[-1])
    shared = [row("all", "compile", cores, 1, startup=COMPILATION)]
    for name in configuration.shared:
        seconds = STUDIES[name].seconds if name in STUDIES else DOCUMENTS[name]
        seconds = seconds(configuration) if callable(seconds) else seconds
        shared.append(row("all", name, cores, 1, startup=seconds))
    return [*found, *shared, summed("all", "total", cores, [*sums, *shared])]


def duration(seconds):
    """Return ``seconds`` as people say it."""
    if seconds < 100:
        return f"{seconds:.1f} s"
    return f"{seconds / 60:.1f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"


def sentences(rows):
    """Return the lines to print: every stage of every scene, without its single jobs."""
    cores = rows[-1]["cores"]
    on = "1 core" if cores == 1 else f"{cores} cores"
    lines = [f"{'scene':<16}{'stage':<16}{'jobs':>6}{'events':>10}{'one core':>12}{on:>12}"]
    for row in rows:
        if row["radius"] is None:
            events = f"{row['events']:.2g}" if row["events"] is not None else ""
            alone = duration(row["seconds"] + row["startup"])
            lines.append(
                f"{row['scene']:<16}{row['stage']:<16}{row['jobs']:>6}{events:>10}{alone:>12}"
                f"{duration(row['wall_clock']):>12}"
            )
    return lines


def main():
    """Forecast, write the table and print its sums."""
    parser = Parser(prog="twodiscs.pipeline.forecast", description=__doc__.split("\n")[0])
    parser.add_argument("--configuration", required=True, help="the configuration, JSON or @path")
    parser.add_argument("--cores", required=True, type=int, help="how many jobs run at once")
    parser.add_argument("--output", required=True, help="forecast.csv")
    options = parser.parse_args()
    from twodiscs.pipeline.configuration.load import load

    found = rows(load(parameters(options.configuration)), options.cores)
    Forecast.write(options.output, found)
    print("\n".join(sentences(found)))


if __name__ == "__main__":
    run(main)
