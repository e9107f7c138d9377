"""The speed of the engines side by side.

    snakemake --cores 2 benchmark

All variants of a benchmark take turns, repeatedly, and their medians are compared. If the machine
slows down, all variants slow down. All numbers are processor times of one core, except the speed-up
of two processes, which is wall-clock time. The scene is the paper's box at r = 0.2.
"""

import math
import multiprocessing
import time
from dataclasses import replace
from functools import partial
from statistics import median

import numpy as np

from twodiscs.dynamics import runs
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.dynamics.many import engine
from twodiscs.dynamics.runs import hop_intervals
from twodiscs.model.events import EVENTS, SHELLS
from twodiscs.model.scene import Scene
from twodiscs.sampling import montecarlo
from twodiscs.sampling.separations import separation_sampler
from twodiscs.sampling.starts import states
from twodiscs.theory.exact import event_rate
from twodiscs_paper.studies.accuracy_cost import scalar
from twodiscs_paper.studies.effects.cost import (
    BLOCKS,
    SCENE,
    compared,
    in_turns,
    interleaved,
    lockstep,
    medians,
    timed,
)
from twodiscs_paper.studies.effects.cost import rows as cost_rows
from twodiscs_paper.studies.estimates import mean_of


def lockstep_of_many(discs, blocks=BLOCKS // 8):
    """Count all events of ``discs`` discs with the kernel of N discs, which also takes two."""
    scene = Scene(SCENE.width, SCENE.height, SCENE.radius / 2, discs=discs)
    duration = engine.duration_of(scene)
    counted, seconds = timed(lambda: engine.run_classes(scene, 1, 0, blocks, duration))
    return engine.simulated_events(counted[0]), seconds


def in_long_box(discs, hops, events=1_000_000):
    """Count about ``events`` of N discs in a box of 0.75 N × 1, without initial states."""
    scene = Scene(0.75 * discs, 1.0, SCENE.radius / 2, discs=discs)
    each = engine.block_replicas(scene)
    duration = engine.duration_of(scene, max(256, events / each))

    def counted(time):
        return timed(lambda: engine.run_classes(scene, 1, 0, 1, time, hops=hops))

    (sums, _), seconds = counted(duration)
    return engine.simulated_events(sums), seconds - counted(duration / 2**20)[1]


def lockstep_intervals(intervals=5_000_000):
    """Record exact intervals between vertical hops; events are their time times the event rate."""
    summary, seconds = timed(lambda: hop_intervals(SCENE, "vertical_hop", intervals, 1))
    return summary.intervals * summary.mean * event_rate(SCENE), seconds


def scalar_engine(blocks=BLOCKS // 8):
    """Do the same as ``lockstep``, one trajectory after the other."""
    duration = runs.replica_duration(SCENE)
    draw = separation_sampler(SCENE)
    arguments = (REPLICAS, duration, SCENE.contact_distance, draw, (0, 0))
    counted, seconds = timed(lambda: scalar.count_blocks(np.uint64(1), 0, blocks, *arguments))
    return scalar.simulated_events(counted[0]), seconds


def plain_python(replicas=200):
    """Do the same without a compiler."""
    starts = [tuple(map(float, state)) for state in states(SCENE, replicas, 1)[:8].T]
    end = runs.replica_duration(SCENE), SCENE.range_x / 2, SCENE.range_y / 2, 0.4
    counts, seconds = timed(lambda: [scalar.count_replica.py_func(*s, *end) for s in starts])
    return sum(map(scalar.simulated_events, counts)), seconds


QUANTITIES = ("volume", *(f"{event}_area" for event in EVENTS))


def sampling_engine(blocks=100):
    """Sample the volume and all shells with the compiled kernel."""
    samples = blocks * montecarlo.BLOCK
    point, seconds = timed(lambda: montecarlo.sample_point(SCENE, QUANTITIES, samples, 0.02, 1))
    return point.samples, seconds


def numpy_sampler(chunks=1000, chunk=16384):
    """Sample the same sets with numpy, in chunks that stay in the cache: the fastest known way."""
    range_x, range_y, sigma = SCENE.range_x, SCENE.range_y, SCENE.contact_distance
    ranges = {"x": range_x, "y": range_y}
    ends = montecarlo.shell_ends(
        [montecarlo.shell_thickness(SCENE, event, 0.02) for event in SHELLS],
        lambda thick: (sigma + thick) ** 2,
        lambda axis, side, thick: 1 - thick / ranges[axis] if side > 0 else thick / ranges[axis],
    )
    generator = np.random.Generator(np.random.SFC64(1))
    hits = np.zeros(1 + len(SHELLS), np.int64)

    def sample():
        for _ in range(chunks):
            x1, x2, y1, y2 = generator.random((4, chunk))
            uu, vv = ((x1 - x2) * range_x) ** 2, ((y1 - y2) * range_y) ** 2
            square = uu + vv
            free = square >= sigma**2
            sample_in = (uu, vv), square, (x1, y1), ends
            shells = [free & montecarlo.IN_SHELL[event](*sample_in) for event in SHELLS]
            hits[:] += [np.count_nonzero(members) for members in (free, *shells)]

    _, seconds = timed(sample)
    return chunks * chunk, seconds


def count_until(error):
    """Return (events, processor seconds) until counting gives the mean hop time to ``error``."""
    result, seconds = timed(lambda: runs.count_events(SCENE, {"vertical_hop": error}, 10**11, 1))
    return result.events, seconds


def intervals_until(error):
    """Return (intervals, processor seconds) until intervals give their mean to ``error``."""

    def work():
        intervals = 500_000
        while True:
            summary = hop_intervals(SCENE, "vertical_hop", intervals, 1)
            excess = summary.stderr / summary.mean / error
            if excess <= 1:
                return summary
            intervals = math.ceil(1.05 * excess**2 * summary.intervals)

    summary, seconds = timed(work)
    return summary.intervals, seconds


def _shard(blocks, ready, go, done):
    lockstep(1)
    ready.release()
    go.acquire()
    lockstep(blocks)
    done.release()


def shards_in_parallel(processes, blocks):
    """Return wall-clock seconds in which ``processes`` processes do ``blocks`` blocks each."""
    context = multiprocessing.get_context("spawn")
    ready, go, done = (context.Semaphore(0) for _ in range(3))
    workers = [
        context.Process(target=_shard, args=(blocks, ready, go, done)) for _ in range(processes)
    ]
    for worker in workers:
        worker.start()
    for _ in workers:
        ready.acquire()
    start = time.perf_counter()
    for _ in workers:
        go.release()
    for _ in workers:
        done.acquire()
    seconds = time.perf_counter() - start
    for worker in workers:
        worker.join()
    return seconds


def two_process_speedup(repetitions=5, blocks=600):
    """Return how much faster two processes do two shards than one process does both."""
    ratios = []
    for _ in range(repetitions):
        one_process = shards_in_parallel(1, 2 * blocks)
        ratios.append(one_process / shards_in_parallel(2, blocks))
    return median(ratios)


#: The engine of two discs, and the kernel of N with two, three, four and eight at half the radius.
MANY = {"lockstep": partial(lockstep, BLOCKS // 8, replace(SCENE, radius=SCENE.radius / 2))}
MANY |= {f"discs_{discs}": partial(lockstep_of_many, discs) for discs in (2, 3, 4, 8)}

#: Numbers of discs in a box of 0.75 × 1 for each, at half the radius: few in lock step, and many in
#: cells. Variants with hops have one of these names, variants without hops the other one.
FEW, LARGE = (3, 8, 16), (64, 256, 1024)
WITH_HOPS, WITHOUT_HOPS = "discs_{}", "discs_{}_without_hops"
BY_NUMBER = {"lockstep": MANY["lockstep"]} | {
    name.format(discs): partial(in_long_box, discs, name == WITH_HOPS)
    for name in (WITH_HOPS, WITHOUT_HOPS)
    for discs in (*FEW, *LARGE)
}


def exponent_rows(speeds):
    """Yield the rows of the powers of N with which the time per event grows.

    ``speeds`` are lists, {variant of ``BY_NUMBER``: speeds}. The power is fitted in each turn, and
    the error comes from the differences between turns.
    """
    for numbers, variant, names in (
        (FEW, "few_discs", WITH_HOPS),
        (LARGE, "many_discs", WITH_HOPS),
        (LARGE, "many_discs_without_hops", WITHOUT_HOPS),
    ):
        times = -np.log([speeds[names.format(discs)] for discs in numbers])
        power = mean_of(np.polyfit(np.log(numbers), times, 1)[0])
        yield {
            "benchmark": "exponent_of_time_by_number", "variant": variant, "value": power.value,
            "unit": "1", "stderr": power.stderr,
        }  # fmt: skip


def benchmarks(scenes):
    """Run everything and return the rows of benchmark.csv; ``scenes`` as in ``cost.rows``."""
    rows = cost_rows(scenes)

    def add(*arguments, **options):
        rows.extend(compared(*arguments, **options))

    speeds = interleaved(
        {
            "lockstep": lockstep,
            "lockstep_intervals": lockstep_intervals,
            "scalar": scalar_engine,
            "python": plain_python,
        }
    )
    add("md_events_per_second", speeds, "1/s", "scalar")
    add(
        "mc_samples_per_second",
        interleaved({"engine": sampling_engine, "numpy": numpy_sampler}),
        "1/s",
        "numpy",
    )
    add("md_events_per_second_of_many", interleaved(MANY), "1/s", "lockstep")
    by_number = in_turns(BY_NUMBER)
    add("md_events_per_second_by_number", medians(by_number), "1/s", "lockstep")
    rows.extend(exponent_rows(by_number))
    for error in (1e-3, 1e-4):
        events = count_until(error)[0]
        seconds = {
            "lockstep": median(count_until(error)[1] for _ in range(5)),
            "lockstep_intervals": median(intervals_until(error)[1] for _ in range(5)),
        }
        baseline = "lockstep"
        if error == 1e-3:
            scalar_blocks = math.ceil(events / (scalar_engine(1)[0]))
            seconds["scalar"] = median(scalar_engine(scalar_blocks)[1] for _ in range(5))
            baseline = "scalar"
            # A run of a minute or more: its length follows from the speed measured above.
            seconds["python"] = events / speeds["python"]
        add(f"seconds_to_relative_error_{error:g}", seconds, "s", baseline, larger_is_better=False)
    speedup = two_process_speedup()
    rows.append(
        {"benchmark": "two_process_speedup", "variant": "lockstep", "value": speedup, "unit": "1",
         "ratio": speedup}
    )  # fmt: skip
    return rows
