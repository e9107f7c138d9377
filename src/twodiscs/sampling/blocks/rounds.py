"""Work in blocks whose sums are integers: by one process in rounds, or by many in pieces.

One process works in rounds until all errors are small enough (``in_rounds``), or does all planned
blocks without rounds (``all_at_once``). The number of planned blocks is known before anything runs.
Many processes can do ``pieces`` of the work, whose sums are then ``joined``. The bits depend
neither on the size of the pieces nor on the process that does a piece.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from twodiscs.model.checks import InputError
from twodiscs.sampling.blocks.threads import in_threads

#: Blocks of the first round, and the longest round over the work before it: an error from few
#: events predicts badly.
FIRST_ROUND = 32
GROWTH = 8.0

#: A round is longer than its prediction by this factor, so that no short round has to follow.
MARGIN = 1.05

#: Events of the plain ensemble in one call of a kernel, about, unless a block has more: some tenths
#: of a second. Between calls the progress bar moves, and Ctrl-C stops the work.
CALL = 2**24

#: Steps of the grid of planned blocks while their number doubles.
STEPS = 16


@dataclass(frozen=True)
class SequentialRun:
    """Work in blocks until the errors are small enough or a budget is spent.

    ``work(first, stop)`` returns the sums of a range of blocks, a tuple of integer arrays.
    ``excess_of(sums, blocks)`` returns the array of their errors over the errors asked for; if it
    is empty, one round is enough. ``events_of(sums)`` returns the number of events.
    ``block_events`` is the approximate number of events in a block, ``budget`` the largest number
    of events. ``planned`` is the number of blocks for many processes, known before anything runs.
    ``cost_ratio`` is the time of an event over the time of an event in the plain ensemble, and
    ``first_round`` the number of blocks in the first round.
    """

    work: Callable
    excess_of: Callable
    events_of: Callable
    block_events: float
    budget: float
    planned: int
    cost_ratio: float = 1.0
    first_round: int = FIRST_ROUND

    @property
    def block_work(self):
        """The work of a block, in events of the plain ensemble."""
        return self.block_events * self.cost_ratio


class Outcome(NamedTuple):
    """The result of a run: the sums of its blocks, the number of rounds, and the errors."""

    sums: list
    blocks: int
    rounds: int
    excess: np.ndarray


def fixed(work, blocks, block_events, cost_ratio=1.0):
    """Return the ``SequentialRun`` of exactly this number of ``blocks``."""
    return SequentialRun(
        work, lambda sums, done: np.array([]), lambda sums: 1, block_events, math.inf, blocks,
        cost_ratio, blocks,
    )  # fmt: skip


def _added(sums, part):
    return list(part) if sums is None else [a + b for a, b in zip(sums, part, strict=True)]


def _sums(run, stop, kept, cores, progress):
    """Return the sums of the blocks 0 … ``stop`` − 1, which continue the longest sums in ``kept``.

    ``kept`` is {blocks: their sums}; the new sums are added to it. One call of a thread does some
    blocks.
    """
    first = max((blocks for blocks in kept if blocks <= stop), default=0)
    sums = kept.get(first)
    step = max(1, int(CALL / run.block_work))
    calls = ((start, min(start + step, stop)) for start in range(first, stop, step))
    for done, part in enumerate(in_threads(run.work, calls, cores, lambda: progress(None)), 1):
        sums = _added(sums, part)
        progress(min(first + done * step, stop))
    kept[stop] = sums
    return sums


def all_at_once(run):
    """Do the planned blocks of a run in this process and return the ``Outcome``."""
    sums = _sums(run, run.planned, {}, 1, lambda blocks: None)
    return Outcome(sums, run.planned, 1, run.excess_of(sums, run.planned))


def in_rounds(run, progress=None, cores=1, kept=None):
    """Work in rounds until the errors are small enough or the budget is spent.

    The first round is small: it keeps to the budget, but has at least one block. The errors so far
    predict the length of each next round. If no error is asked for, there is one round.
    ``progress``, if given, is called repeatedly with the work that is done and the expected total,
    in events of the plain ensemble.

    ``kept`` has {blocks: sums} of the rounds of an earlier run to another error. This run does not
    repeat them, and the ``Outcome`` is the same as without. Its own rounds are added to ``kept``.
    """
    kept = {} if kept is None else kept
    blocks = int(max(1, min(run.first_round, run.budget / run.block_events)))
    last, done, rounds = max(blocks, min(run.planned, run.budget / run.block_events)), 0, 0

    def report(number):
        if progress is not None:
            progress(number if number is None else number * run.block_work, last * run.block_work)

    while True:
        done, rounds = done + blocks, rounds + 1
        sums = _sums(run, done, kept, cores, report)
        excess, simulated = run.excess_of(sums, done), run.events_of(sums)
        if not excess.size:
            break
        worst = float(np.max(excess))
        # The work that is missing for the error, and that the budget allows, over the work so far.
        missing, affordable = MARGIN * worst * worst - 1.0, run.budget / simulated - 1.0
        last = done * (1 + max(0.0, min(missing, affordable)))
        report(done)
        if worst <= 1.0 or affordable * done < 1.0:
            break
        blocks = math.ceil(min(missing, GROWTH) * done)
        blocks = min(blocks, math.floor(affordable * done))
    return Outcome(sums, done, rounds, excess)


class Sampler(NamedTuple):
    """Draws in blocks of ``block`` samples.

    ``count(first, stop)`` returns the counts of a range of blocks, and ``point(samples, counts)``
    the point, as ``sample_point`` does. ``cost_ratio`` is the time of a sample over the time of a
    sample of the prism.
    """

    block: int
    count: Callable
    point: Callable
    cost_ratio: float = 1.0


def all_in_rounds(parts, progress=None, cores=1, kept=None):
    """Return {name: ``Outcome``} of the runs in ``parts``, {name: run}, one after the other.

    ``progress`` is called with the work of all of them; ``kept`` has the argument ``kept`` of
    ``in_rounds`` for each name.
    """
    kept = {} if kept is None else kept
    reached, work = {}, {name: run.planned * run.block_work for name, run in parts.items()}

    def report(done, expected):
        work[name] = expected
        if progress is not None:
            before = sum(work[earlier] for earlier in reached)
            progress(done if done is None else before + done, sum(work.values()))

    for name, run in parts.items():
        reached[name] = in_rounds(run, report, cores, kept.setdefault(name, {}))
    return reached


# Pieces ------------------------------------------------------------------------------------------


def on_grid(blocks):
    """Return the next number of blocks on a grid of ``STEPS`` while it doubles, at least 1.

    A slightly smaller error then needs the same pieces, or a few more.
    """
    blocks = max(1, math.ceil(blocks))
    step = max(1, (1 << (blocks - 1).bit_length()) // (2 * STEPS))
    return -(-blocks // step) * step


def pieces(blocks, per_piece):
    """Return the pieces [(first, stop), …] of a number of ``blocks``, on an absolute grid.

    They begin at multiples of ``per_piece``, a power of two; the last one is cut at ``blocks``.
    """
    return [(first, min(first + per_piece, blocks)) for first in range(0, blocks, per_piece)]


def _narrow(sums):
    try:
        return np.array(sums, np.int64)
    except OverflowError:
        return sums


def joined(run, parts):
    """Return the ``Outcome`` of the planned blocks of a run, from the sums of its pieces.

    ``parts`` is a list of {"first", "stop", "sums"} in any order, without gap or overlap, the sums
    as nested lists of integers.
    """
    parts, stop, sums = sorted(parts, key=lambda part: part["first"]), 0, None
    for part in parts:
        if part["first"] != stop:
            break
        sums = _added(sums, (np.array(entry, object) for entry in part["sums"]))
        stop = part["stop"]
    else:
        if stop == run.planned:
            sums = [_narrow(entry) for entry in sums]
            return Outcome(sums, stop, 1, run.excess_of(sums, stop))
    given = ", ".join(f"{part['first']} to {part['stop']}" for part in parts) or "none"
    raise InputError(
        f"pieces must cover blocks 0 to {run.planned} without gap or overlap, not {given}"
    )
