"""The speed of the engines side by side.

    snakemake --cores 2 benchmark

All variants of a benchmark take turns, repeatedly, and their medians are compared. If the machine
slows down, all variants slow down. All numbers are processor times of one core. The scene is the
paper's box at r = 0.2.
"""

import math
from dataclasses import replace
from functools import partial

import numpy as np

from twodiscs.dynamics import runs
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.dynamics.many import class_counts, many_rates
from twodiscs.dynamics.two import two_rates
from twodiscs.model.events import EVENTS, SHELL_EVENTS
from twodiscs.model.many_geometry import CELL_DISCS
from twodiscs.model.scene import Scene
from twodiscs.sampling import montecarlo
from twodiscs.sampling.conditioned import conditioned_sampler
from twodiscs.sampling.initial_states import states
from twodiscs.theory.exact import event_rate
from twodiscs_paper.studies.accuracy_cost import scalar
from twodiscs_paper.studies.effects.price import (
    PRICE_BLOCKS,
    SCENE,
    compared,
    interleaved,
    lockstep,
    timed,
)
from twodiscs_paper.studies.effects.price import rows as cost_rows


def count_in_square(discs, packing, periodic, with_states):
    """Count the events of a block of N discs in a square, with the time for their states or not."""
    side = math.sqrt(discs * math.pi / packing) * SCENE.radius
    scene = Scene(side, side, SCENE.radius, discs=discs, periodic=periodic)
    duration, replicas = many_rates.replica_duration(scene), many_rates.block_replicas(scene)
    if discs >= CELL_DISCS and not with_states:  # one state, whose time does not depend on ``time``
        duration, replicas = duration * replicas, 1

    def counted(time):
        return timed(lambda: class_counts.run_classes(scene, 1, 0, 1, time, replicas=replicas))

    (sums, _), seconds = counted(duration)
    if not with_states:
        seconds -= counted(duration / 2**20)[1]
    return class_counts.simulated_events(sums), seconds


def lockstep_intervals(intervals=5_000_000):
    """Record exact intervals between vertical hops; events are their time times the event rate."""
    summary, seconds = timed(lambda: runs.IntervalsRun(SCENE, "vertical_hop", intervals, 1).run())
    return summary.intervals * summary.mean * event_rate(SCENE), seconds


def scalar_engine(blocks=PRICE_BLOCKS // 8):
    """Do the same as ``lockstep``, one trajectory after the other."""
    duration = two_rates.replica_duration(SCENE)
    draw = conditioned_sampler(SCENE)
    arguments = (REPLICAS, duration, SCENE.contact_distance, draw)
    counted, seconds = timed(lambda: scalar.count_blocks(np.uint64(1), 0, blocks, *arguments))
    return scalar.simulated_events(counted[0]), seconds


def plain_python(replicas=200):
    """Do the same without a compiler."""
    starts = [tuple(map(float, state)) for state in states(SCENE, replicas, 1)[:8].T]
    end = two_rates.replica_duration(SCENE), SCENE.range_x / 2, SCENE.range_y / 2, 0.4
    counts, seconds = timed(lambda: [scalar.count_replica.py_func(*s, *end) for s in starts])
    return sum(map(scalar.simulated_events, counts)), seconds


SAMPLED_QUANTITIES = ("volume", *(f"{event}_area" for event in EVENTS))


def sampling_engine(blocks=100):
    """Sample the volume and all shells with the compiled kernel."""
    sampler = montecarlo.prism_sampler(SCENE, SAMPLED_QUANTITIES, 0.02, 1)
    _, seconds = timed(lambda: sampler.count(0, blocks))
    return blocks * montecarlo.SAMPLES_PER_BLOCK, seconds


def numpy_sampler(chunks=1000, chunk=16384):
    """Sample the same sets with numpy, in chunks that stay in the cache: the fastest known way."""
    range_x, range_y, sigma = SCENE.range_x, SCENE.range_y, SCENE.contact_distance
    ranges = {"x": range_x, "y": range_y}
    ends = montecarlo.shell_ends(
        [montecarlo.shell_thickness(SCENE, event, 0.02) for event in SHELL_EVENTS],
        lambda thick: (sigma + thick) ** 2,
        lambda axis, side, thick: 1 - thick / ranges[axis] if side > 0 else thick / ranges[axis],
    )
    generator = np.random.Generator(np.random.SFC64(1))
    hits = np.zeros(1 + len(SHELL_EVENTS), np.int64)

    def sample():
        for _ in range(chunks):
            x1, x2, y1, y2 = generator.random((4, chunk))
            uu, vv = ((x1 - x2) * range_x) ** 2, ((y1 - y2) * range_y) ** 2
            square = uu + vv
            free = square >= sigma**2
            sample_in = (uu, vv), square, (x1, y1), ends
            shells = [free & montecarlo.SHELL_TESTS[event](*sample_in) for event in SHELL_EVENTS]
            hits[:] += [np.count_nonzero(members) for members in (free, *shells)]

    _, seconds = timed(sample)
    return chunks * chunk, seconds


#: Numbers of discs in a square box or torus, 8 in lock step and more in cells, and their packing
#: fractions. All hops are counted, with initial states as in a call of ``simulate``, and without:
#: the share of time of initial states is 1 − called/kernel.
DISC_NUMBERS, PACKINGS = (8, 64, 256, 1024, 4096), (0.3, 0.6)
TWO_DISC_SCENE = replace(SCENE, radius=SCENE.radius / 2)
RATES_BY_NUMBER = {"lockstep": partial(lockstep, PRICE_BLOCKS // 8, TWO_DISC_SCENE)} | {
    f"discs_{discs}_packing_{packing}{shape}_{name}": partial(
        count_in_square, discs, packing, periodic, with_states
    )
    for discs in DISC_NUMBERS
    for packing in PACKINGS
    for shape, periodic in (("", ""), ("_torus", "xy"))
    for name, with_states in (("called", True), ("kernel", False))
}


def benchmarks(scenes):
    """Run everything and return the rows of benchmark.csv; ``scenes`` as in ``cost.rows``."""
    of_engines = {
        "lockstep": lockstep,
        "lockstep_intervals": lockstep_intervals,
        "scalar": scalar_engine,
        "python": plain_python,
    }
    of_samplers = {"engine": sampling_engine, "numpy": numpy_sampler}
    return [
        *cost_rows(scenes),
        *compared("md_events_per_second", interleaved(of_engines), "scalar"),
        *compared("mc_samples_per_second", interleaved(of_samplers), "numpy"),
        *compared("md_events_per_second_by_number", interleaved(RATES_BY_NUMBER, 3), "lockstep"),
    ]
