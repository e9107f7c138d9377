"""Forecast the processor time of a configuration.

A pilot at each radius does the first blocks of a job. It measures the speed of this machine and the
number of blocks that the requested errors need. As many pilots run in parallel as there will be
jobs. A point in shards takes all its planned blocks. The time to start Python and to load compiled
code is measured by a job that does nothing.
"""

import subprocess
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import NamedTuple

from twodiscs.arguments import Parser, end_with_workflow, parameters, run
from twodiscs.comparison.tables.cost import Forecast
from twodiscs.model.checks import check_integer
from twodiscs_paper.catalogue import STUDIES
from twodiscs_paper.configuration.load import load
from twodiscs_paper.pipeline import cost

#: The most events or samples of a pilot, unless one block has more.
EVENTS = 4e7

#: The most pilots of a stage of a scene, evenly spread over its radii.
MOST_PILOTS = 64

#: The seconds of the documents, and of the compiler: round figures.
DOCUMENTS = {"paper": 1.5, "report": 5.0}
COMPILATION = 12.0

#: Jobs with almost no work, for each kind of job, as arguments of ``python -m``.
NOTHING = {
    "jobs": (
        "twodiscs_paper.pipeline.jobs.point dynamics --width 1.5 --height 1 --radius 0.2 --budget 1"
        " --target vertical_hop=0.5 --seed 1 --part all --blocks 0 1 --output {}/point.json"
    ),
    "tables": (
        "twodiscs_paper.pipeline.jobs.table theory --width 1.5 --height 1 --radii 0.2"
        " --output {}/theory.csv"
    ),
    "figures": (
        "twodiscs_paper.pipeline.jobs.figure model --width 1.5 --height 1"
        " --output {0}/a.pdf {0}/a.png"
    ),
}


class Pilot(NamedTuple):
    """The forecast of one job: its events (samples, intervals), and processor time in seconds."""

    events: int
    seconds: float


def pilot(work, in_shards=False):
    """Return the ``Pilot`` of a point from its run ``work`` (see ``jobs.point``)."""
    from twodiscs.sampling.blocks.rounds import FIRST_ROUND, MARGIN

    events = seconds = 0.0
    for part in work.parts.values():
        part.work(0, 1)  # compiles the kernel, or loads it
        affordable = part.budget / part.block_events
        blocks = int(max(1, min(FIRST_ROUND, EVENTS / part.block_events, affordable)))
        start = time.process_time()
        sums = part.work(0, blocks)
        taken = time.process_time() - start
        excess = part.excess_of(sums, blocks)
        if len(excess) and not in_shards:
            needed = max(FIRST_ROUND / blocks, MARGIN * max(excess) ** 2)
            times = max(1.0, min(needed, affordable / blocks))
        else:
            times = part.planned / blocks
        events += times * blocks * part.block_events
        seconds += times * taken
    return Pilot(round(events), seconds)


def _run_pilot(job):
    return pilot(cost.run_of(*job), in_shards=bool(cost.shards(*job)))


def run_pilots(jobs, cores):
    """Return the ``Pilot`` of each of ``jobs`` (scene, stage, radius), ``cores`` at a time."""
    with ProcessPoolExecutor(cores, get_context("spawn"), end_with_workflow) as pool:
        return list(pool.map(_run_pilot, jobs))


def starts():
    """Return {kind: seconds} that jobs take in addition to their work."""
    seconds = {}
    with tempfile.TemporaryDirectory() as folder:
        for kind, words in NOTHING.items():
            command = [sys.executable, "-m", *words.format(folder).split()]
            for _ in range(2):  # the first run may compile
                start = time.perf_counter()
                subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
                seconds[kind] = time.perf_counter() - start
    return seconds


def thinned(radii):
    """Return the radii of the pilots, and for each of all ``radii`` the radius of its pilot."""
    step = -(-len(radii) // MOST_PILOTS) or 1
    near = [radii[min(n - n % step + step // 2, len(radii) - 1)] for n in range(len(radii))]
    return list(dict.fromkeys(near)), near


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
    events = [part["events"] for part in rows if part["events"] is not None]
    return row(
        scene, stage, cores, sum(part["jobs"] for part in rows),
        sum(events) if events else None,
        sum(part["seconds"] for part in rows), sum(part["startup"] for part in rows),
    )  # fmt: skip


def scene_rows(scene, figures, cores, started):
    """Return the rows of a ``SceneRequest``: every job, the stages and their total.

    ``figures`` is the number of its figures that are built.
    """
    jobs, sums = [], []
    for stage, keys in scene.keys.items():
        radii, near = thinned([*keys.values()])
        pilots = run_pilots([(scene, stage, radius) for radius in radii], cores)
        known, own = dict(zip(radii, pilots, strict=True)), []
        for radius, other in zip(keys.values(), near, strict=True):
            number = 1 + len(cost.shards(scene, stage, radius))
            taken = *known[other], number * started["jobs"], radius
            own.append(row(scene.name, stage, cores, number, *taken))
        jobs += own
        sums += [summed(scene.name, stage, cores, own)] if own else []
    for kind, number in (("tables", len(scene.tables)), ("figures", figures)):
        sums.append(row(scene.name, kind, cores, number, startup=number * started[kind]))
    return [*jobs, *sums, summed(scene.name, "total", cores, sums)]


def rows(configuration, cores):
    """Return the rows of forecast.csv for a ``Configuration`` on ``cores`` ≥ 1 cores.

    Raises ``InputError`` for another number of cores.
    """
    cores, started = check_integer("cores", cores), starts()
    forecast, sums = [], []
    for scene in configuration.scenes:
        forecast += scene_rows(scene, len(configuration.shown(scene.name)), cores, started)
        sums.append(forecast[-1])
    shared = [row("all", "compile", cores, 1, startup=COMPILATION)]
    for name in configuration.shared:
        study = STUDIES.get(name)
        seconds = cost.study_seconds(study, configuration) if study else DOCUMENTS[name]
        shared.append(row("all", name, cores, 1, startup=seconds))
    return [*forecast, *shared, summed("all", "total", cores, [*sums, *shared])]


def duration(seconds):
    """Return ``seconds`` as text, in seconds, minutes or hours."""
    if seconds < 100:
        return f"{seconds:.1f} s"
    return f"{seconds / 60:.1f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"


def sentences(rows):
    """Return the lines to print: every stage of every scene, without single jobs."""
    cores = rows[-1]["cores"]
    on = "1 core" if cores == 1 else f"{cores} cores"
    lines = [f"{'scene':<16}{'stage':<16}{'jobs':>6}{'events':>10}{'one core':>12}{on:>12}"]
    for row in rows:
        if row["radius"] is None:
            events = f"{row['events']:.2g}" if row["events"] is not None else ""
            one_core = duration(row["seconds"] + row["startup"])
            lines.append(
                f"{row['scene']:<16}{row['stage']:<16}{row['jobs']:>6}{events:>10}{one_core:>12}"
                f"{duration(row['wall_clock']):>12}"
            )
    return lines


def main():
    """Forecast, write the table and print its sums."""
    parser = Parser(prog=__spec__.name, description=__doc__.split("\n")[0])
    parser.add_argument("--configuration", required=True, help="the configuration, JSON")
    parser.add_argument("--cores", required=True, type=int, help="how many jobs run in parallel")
    parser.add_argument("--output", required=True, type=Path, help="forecast.csv")
    options = parser.parse_args()
    forecast = rows(load(parameters(options.configuration)), options.cores)
    Forecast.write(options.output, forecast)
    print("\n".join(sentences(forecast)))


if __name__ == "__main__":
    run(main)
