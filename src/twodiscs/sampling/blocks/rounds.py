"""Work in blocks whose sums are integers: by one process in rounds, or by many in pieces.

One process works in rounds until all is known well enough (``in_rounds``), or does the blocks that
are planned in one go (``all_at_once``). Many processes do the ``pieces`` of as many blocks as are
planned before anything runs, and their sums are ``joined``: the same bits however large the pieces
are and whoever does them.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from twodiscs.model.checks import InputError
from twodiscs.sampling.blocks.threads import in_threads

#: Blocks of the first round, and how many times the work done so far a round may be: an error seen
#: in few events predicts badly.
FIRST_ROUND = 32
GROWTH = 8.0

#: A round is this much longer than it seems to need, so that it need not come back for a little.
MARGIN = 1.05

#: Events of the plain ensemble that one call of a kernel does, about, unless a block has more: some
#: tenths of a second. So who waits sees how far it is, and can stop it.
CALL = 2**24

#: Steps of the grid of planned blocks while their number doubles.
STEPS = 16


@dataclass(frozen=True)
class SequentialRun:
    """Work on one thing until it is known well enough or a budget is spent.

    ``work(first, stop)`` returns the sums of a range of blocks, a tuple of integer arrays;
    ``excess_of(sums, blocks)`` their errors over those asked for, an array, which is empty where
    there is nothing to wait for; ``events_of(sums)`` the events simulated. ``block_events`` is
    about what a block has, ``budget`` the most of them there may be. ``planned`` is the number of
    blocks for many processes, known before anything runs, ``cost_ratio`` the time of an event over
    that of one of the plain ensemble, and ``first_round`` the blocks of the first round.
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
    """The result of a run: the sums of its blocks, how many rounds they took, and their errors."""

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
    """Return the sums of the blocks 0 … ``stop`` − 1, from those in ``kept`` that come nearest.

    ``kept`` is {blocks: their sums}; these are added to it. Threads do some blocks a call.
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
    """Return the ``Outcome`` when the planned blocks of a run are done, in this process."""
    sums = _sums(run, run.planned, {}, 1, lambda blocks: None)
    return Outcome(sums, run.planned, 1, run.excess_of(sums, run.planned))


def in_rounds(run, progress=None, cores=1, kept=None):
    """Return the ``Outcome`` when all is known well enough or the budget is spent.

    The first round is small, no more than the budget affords or one block, the next ones as long as
    the errors seen so far predict; without anything to wait for it is the only one. ``progress``,
    if given, is called now and then with the work that is done and about how much it will be, in
    events of the plain ensemble.

    ``kept``, {blocks: sums} of the rounds of an earlier run to another error, saves what it has:
    the result is the same without. The rounds of this one are added.
    """
    kept = {} if kept is None else kept
    blocks = int(max(1, min(run.first_round, run.budget / run.block_events)))
    last, done, rounds = max(blocks, min(run.planned, run.budget / run.block_events)), 0, 0

    def seen(number):
        if progress is not None:
            progress(number if number is None else number * run.block_work, last * run.block_work)

    while True:
        done, rounds = done + blocks, rounds + 1
        sums = _sums(run, done, kept, cores, seen)
        excess, simulated = run.excess_of(sums, done), run.events_of(sums)
        if not excess.size:
            break
        worst = float(np.max(excess))
        # In units of the work done so far: what the error asks for, and what the budget allows.
        missing, affordable = MARGIN * worst * worst - 1.0, run.budget / simulated - 1.0
        last = done * (1 + max(0.0, min(missing, affordable)))
        seen(done)
        if worst <= 1.0 or affordable * done < 1.0:
            break
        blocks = math.ceil(min(missing, GROWTH) * done)
        blocks = min(blocks, math.floor(affordable * done))
    return Outcome(sums, done, rounds, excess)


class Sampler(NamedTuple):
    """Draws in blocks of ``block`` samples.

    ``count(first, stop)`` returns the counts of a range of blocks, and ``point(samples, counts)``
    what is found, as ``sample_point`` does. ``cost_ratio`` is the time of a sample over that of one
    of the prism.
    """

    block: int
    count: Callable
    point: Callable
    cost_ratio: float = 1.0


def all_in_rounds(parts, progress=None, cores=1, kept=None):
    """Return {name: ``Outcome``} of the runs in ``parts``, {name: run}, one after the other.

    ``progress`` sees the work of all of them; ``kept`` holds that of ``in_rounds`` by name.
    """
    kept = {} if kept is None else kept
    reached, work = {}, {name: run.planned * run.block_work for name, run in parts.items()}

    def seen(done, expected):
        work[name] = expected
        if progress is not None:
            before = sum(work[earlier] for earlier in reached)
            progress(done if done is None else before + done, sum(work.values()))

    for name, run in parts.items():
        reached[name] = in_rounds(run, seen, cores, kept.setdefault(name, {}))
    return reached


# Pieces ------------------------------------------------------------------------------------------


def on_grid(blocks):
    """Return the next number of blocks on a grid of ``STEPS`` while it doubles, at least 1.

    So a somewhat tighter accuracy asks for the same pieces, or for some more of them.
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

    ``parts`` is a list of {"first", "stop", "sums"} in any order, the sums as nested lists of
    integers. Raises ``InputError`` unless they cover all planned blocks without gap or overlap.
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
