"""Work in blocks whose sums are integers: by one process in rounds, or by many in shards.

One process works in rounds until all errors are small enough (``run_in_rounds``). Many processes
can each do a shard, a range of the planned blocks, whose number is known before anything runs. The
bits depend neither on the size of a shard nor on the process that does it. The sums of ranges of
blocks are {(first, stop): sums}, as in ``points.base``.

A process works in ``threads``.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from twodiscs.model.checks import InputError
from twodiscs.model.scene import Scene
from twodiscs.points.base import added, reached
from twodiscs.points.monte_carlo_point import MonteCarloPoint
from twodiscs.sampling.threads import map_in_threads

#: Blocks of the first round, and the longest round over the work before it: an error from few
#: events predicts badly.
FIRST_ROUND = 32
LONGEST_ROUND = 8.0

#: A round is longer than its prediction by this factor, so that no short round has to follow.
ROUND_MARGIN = 1.05

#: Events of the plain ensemble in one call of a kernel, about, unless a block has more: some tenths
#: of a second. Between calls the progress bar moves, and Ctrl-C stops the work.
EVENTS_PER_CALL = 2**24

#: Steps of the grid of planned blocks while their number doubles.
PLAN_STEPS = 16


@dataclass(frozen=True)
class SequentialRun:
    """Work in blocks until the errors are small enough or a budget is spent.

    ``work(first, stop)`` returns the sums of a range of blocks, a tuple of integer arrays. If sums
    are floats, there is a function ``join(sums, more)``, which adds those of a block; sums are None
    at first. ``work(first, stop, cores, waiting)`` then yields the sums of one block after the
    other (see ``threads.map_in_threads``).
    ``error_over_target(sums, blocks)`` returns the array of their errors over the errors asked for;
    if it is empty, one round is enough. ``simulated_in(sums)`` returns the number of events; it is
    None if all blocks have the same number.
    ``block_events`` is the approximate number of events in a block, ``budget`` the largest number
    of events. ``planned`` is the number of blocks for many processes, known before anything runs.
    ``cost_ratio`` is the time of an event over the time of an event in the plain ensemble, and
    ``first_round`` the number of blocks in the first round.
    """

    work: Callable
    error_over_target: Callable
    simulated_in: Callable | None
    block_events: float
    budget: float
    planned: int
    cost_ratio: float = 1.0
    first_round: int = FIRST_ROUND
    join: Callable | None = None

    @property
    def block_work(self):
        """The work of a block, in events of the plain ensemble."""
        return self.block_events * self.cost_ratio


def fixed(work, blocks, block_events, cost_ratio=1.0, join=None):
    """Return the ``SequentialRun`` of exactly this number of ``blocks``."""
    return SequentialRun(
        work, lambda sums, done: np.array([]), None, block_events, math.inf, blocks,
        cost_ratio, blocks, join,
    )  # fmt: skip


def _done(run, stop, ranges, cores, progress):
    """Return the sums of all blocks before ``stop``; those that ``ranges`` lack are simulated.

    The sums of the new blocks are added to ``ranges``. Each call of a thread does a few blocks.
    """
    sums, first = reached(ranges, stop)
    if first == stop:
        return sums
    if run.join:  # sums of floats depend on the order, so a range begins at block 0
        blocks = run.work(first, stop, cores, lambda: progress(None))
        for done, more in enumerate(blocks, first + 1):
            sums = run.join(sums, more)
            progress(done)
        ranges[0, stop] = sums
        return sums
    step, new = max(1, int(EVENTS_PER_CALL / run.block_work)), None
    calls = ((start, min(start + step, stop)) for start in range(first, stop, step))
    for done, more in enumerate(map_in_threads(run.work, calls, cores, lambda: progress(None)), 1):
        new = added(new, more)
        progress(min(first + done * step, stop))
    ranges[first, stop] = new
    return added(sums, new)


def run_in_rounds(run, progress=None, cores=1, resume_from=None):
    """Work in rounds until the errors are small enough or the budget is spent; return the sums.

    The first round is small: it keeps to the budget, but has at least one block. The errors so far
    predict the length of each next round. If no error is asked for, there is one round.
    ``progress``, if given, is called repeatedly with the work that is done and the expected total,
    in events of the plain ensemble.

    Sums are those of ranges of blocks, {(first, stop): sums}. ``resume_from`` are sums of an
    earlier run to another error. This run does not repeat them, and its sums are the same.
    """
    ranges = dict(resume_from or {})
    blocks = int(max(1, min(run.first_round, run.budget / run.block_events)))
    last, done = max(blocks, min(run.planned, run.budget / run.block_events)), 0

    def report(number):
        if progress is not None:
            progress(number if number is None else number * run.block_work, last * run.block_work)

    while True:
        done += blocks
        sums = _done(run, done, ranges, cores, report)
        excess = run.error_over_target(sums, done)
        simulated = run.simulated_in(sums) if run.simulated_in else done * run.block_events
        if not excess.size:
            break
        worst = float(np.max(excess))
        # The work that is missing for the error, and that the budget allows, over the work so far.
        missing, affordable = ROUND_MARGIN * worst * worst - 1.0, run.budget / simulated - 1.0
        last = done * (1 + max(0.0, min(missing, affordable)))
        report(done)
        if worst <= 1.0 or affordable * done < 1.0:
            break
        blocks = math.ceil(min(missing, LONGEST_ROUND) * done)
        blocks = min(blocks, math.floor(affordable * done))
    return {ends: sums for ends, sums in ranges.items() if ends[1] <= done}


class Sampler(NamedTuple):
    """Draws in blocks of ``block`` samples.

    ``count(first, stop)`` returns the counts of a range of blocks, ``constants`` are those of the
    component of a ``MonteCarloPoint`` of the ``scene``. ``cost_ratio`` is the time of a sample over
    the time of a sample of the prism.
    """

    scene: Scene
    block: int
    count: Callable
    constants: dict
    cost_ratio: float = 1.0

    def point(self, ranges):
        """Return the ``MonteCarloPoint`` of a run, given {(first, stop): sums}."""
        return MonteCarloPoint.of(self.scene, {"all": self.constants | {"sums": ranges}})


class FinishedComponents(dict):
    """The components of a run that has ended: no more work is done than they have."""

    def ranges(self, name, run):
        """Return the sums of a ``run``; raise ``InputError`` if blocks are missing."""
        _, stop = reached(ranges := self[name]["sums"])
        if stop < 1 or (run.budget == math.inf and stop != run.planned):
            raise InputError(f"{name} must have all blocks from 0 on, not {stop} of {run.planned}")
        return ranges


def run_all_in_rounds(components, progress=None, cores=1, resume_from=None):
    """Return {name: sums} of the runs in ``components``, {name: run}, one after the other.

    ``progress`` is called with the work of all of them; ``resume_from`` are the components of an
    earlier run. If they are ``FinishedComponents``, nothing is computed.
    """
    if isinstance(resume_from, FinishedComponents):
        return {name: resume_from.ranges(name, run) for name, run in components.items()}
    resume_from = {} if resume_from is None else resume_from
    done, work = {}, {name: run.planned * run.block_work for name, run in components.items()}

    def report(number, expected):
        work[name] = expected
        if progress is not None:
            before = sum(work[earlier] for earlier in done)
            progress(number if number is None else before + number, sum(work.values()))

    for name, run in components.items():
        done[name] = run_in_rounds(run, report, cores, resume_from.get(name, {}).get("sums"))
    return done


class Run:
    """Work in ``components``, {name: SequentialRun}; ``point`` makes the point of {name: sums}.

    A class of a stage has a method ``of(scene, settings)``. It makes the run of the arguments of
    the stage's call, for the face and for a job.
    """

    def run(self, progress=None, cores=1, resume_from=None):
        """Do all work in this process and return the point.

        ``resume_from`` are the components of an earlier run, which are not done again (see
        ``run_all_in_rounds``).
        """
        return self.point(run_all_in_rounds(self.components, progress, cores, resume_from))


# Shards ------------------------------------------------------------------------------------------


def round_up_blocks(blocks):
    """Return the next number of blocks on a grid of ``PLAN_STEPS`` while it doubles, at least 1.

    A slightly smaller error then needs the same shards, or a few more.
    """
    blocks = max(1, math.ceil(blocks))
    step = max(1, (1 << (blocks - 1).bit_length()) // (2 * PLAN_STEPS))
    return -(-blocks // step) * step
