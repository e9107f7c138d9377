"""Work in blocks whose sums are integers: by one process in rounds, or by many in pieces.

One process works in rounds until all is known well enough (``in_rounds``), or does the blocks that
are planned at once (``all_at_once``). Many processes do the ``pieces`` of as many blocks as are
planned before anything runs, and their sums are ``joined``: the same bits however large the pieces
are and whoever does them.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from twodiscs.model.checks import InputError

#: Blocks of the first round, and how many times the work done so far a round may be: an error seen
#: in few events predicts badly.
FIRST_ROUND = 32
GROWTH = 8.0

#: A round is this much longer than it seems to need, so that it need not come back for a little.
MARGIN = 1.05

#: Steps of the grid of planned blocks while their number doubles.
STEPS = 16


@dataclass(frozen=True)
class SequentialRun:
    """Work on one thing until it is known well enough or a budget is spent.

    ``work(first, stop)`` returns the sums of a range of blocks, a tuple of integer arrays;
    ``excess_of(sums, blocks)`` their errors over those asked for, an array, which is empty where
    there is nothing to wait for; ``events_of(sums)`` the events simulated. ``block_events`` is
    about what a block has, ``budget`` the most of them there may be. ``planned`` is the number of
    blocks for many processes, known before anything runs, and ``cost_ratio`` the time of an event
    over that of one of the plain ensemble.
    """

    work: Callable
    excess_of: Callable
    events_of: Callable
    block_events: float
    budget: float
    planned: int
    cost_ratio: float = 1.0


class Progress(NamedTuple):
    """What a run has found: sums of so many blocks after so many rounds, and their errors."""

    sums: list
    blocks: int
    rounds: int
    excess: np.ndarray


def fixed(work, blocks, block_events, cost_ratio=1.0):
    """Return the ``SequentialRun`` of exactly so many ``blocks``."""
    return SequentialRun(
        work, lambda sums, done: np.array([]), lambda sums: 1, block_events, math.inf, blocks,
        cost_ratio,
    )  # fmt: skip


def _added(sums, part):
    return list(part) if sums is None else [a + b for a, b in zip(sums, part, strict=True)]


def all_at_once(run):
    """Return the ``Progress`` when the planned blocks of a run are done, in this process."""
    sums = list(run.work(0, run.planned))
    return Progress(sums, run.planned, 1, run.excess_of(sums, run.planned))


def in_rounds(run, report=None):
    """Return the ``Progress`` when all is known well enough or the budget is spent.

    The first round is small, no more than the budget affords or one block, the next ones as long as
    the errors seen so far predict; without anything to wait for it is the only one. ``report``, if
    given, is called after each round with a text on what is done and the work that is left, over
    that done.
    """
    blocks = max(1, min(FIRST_ROUND, int(run.budget / run.block_events)))
    sums, done, rounds = None, 0, 0
    while True:
        sums = _added(sums, run.work(done, done + blocks))
        done, rounds = done + blocks, rounds + 1
        excess, simulated = run.excess_of(sums, done), run.events_of(sums)
        if not excess.size:
            break
        worst = float(np.max(excess))
        # In units of the work done so far: what the error asks for, and what the budget allows.
        missing, affordable = MARGIN * worst * worst - 1.0, run.budget / simulated - 1.0
        if report is not None:
            done_so_far = f"{simulated:.3g} events, error {worst:.2f} of the target"
            report(done_so_far, max(0.0, min(missing, affordable)))
        if worst <= 1.0 or affordable * done < 1.0:
            break
        blocks = math.ceil(min(missing, GROWTH) * done)
        blocks = min(blocks, math.floor(affordable * done))
    return Progress(sums, done, rounds, excess)


# Pieces ------------------------------------------------------------------------------------------


def on_grid(blocks):
    """Return the next number of blocks on a grid of ``STEPS`` while it doubles, at least 1.

    So a somewhat tighter accuracy asks for the same pieces, or for some more of them.
    """
    blocks = max(1, math.ceil(blocks))
    step = max(1, (1 << (blocks - 1).bit_length()) // (2 * STEPS))
    return -(-blocks // step) * step


def pieces(blocks, per_piece):
    """Return the pieces [(first, stop), …] of so many ``blocks``, on an absolute grid.

    They begin at multiples of ``per_piece``, a power of two; the last one is cut at ``blocks``.
    """
    return [(first, min(first + per_piece, blocks)) for first in range(0, blocks, per_piece)]


def _narrow(sums):
    try:
        return np.array(sums, np.int64)
    except OverflowError:
        return sums


def joined(run, parts):
    """Return the ``Progress`` of the planned blocks of a run, from the sums of its pieces.

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
            return Progress(sums, stop, 1, run.excess_of(sums, stop))
    given = ", ".join(f"{part['first']} to {part['stop']}" for part in parts) or "none"
    raise InputError(
        f"pieces must cover blocks 0 to {run.planned} without gap or overlap, not {given}"
    )
