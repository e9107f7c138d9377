"""Work in rounds, and its pieces: how much is done, and what may be done elsewhere.

Work is a row of blocks whose sums are integers. One job does it in rounds (``in_rounds``). Where it
is more than one job should do, it is cut into pieces of an absolute grid (``pieces``), which depend
on neither the errors nor the budget, and is looked at on a grid of its own, 32 to 64 times while
the work doubles (``next_look``): the first look at which all is known well enough is the end. So
the result is the same bits however large pieces are and whoever does them, and more of the same
work starts where the last one ended.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

#: Blocks of the first round, and how many times the work done so far a round may be: an error seen
#: in few events predicts badly.
FIRST_ROUND = 32
GROWTH = 8.0

#: A round is this much longer than it seems to need, so that it need not come back for a little.
MARGIN = 1.05

#: The first piece is so much smaller than the largest ones: it says how many of those it takes.
FIRST_PIECE = 32


class Run(NamedTuple):
    """Work on one thing until it is known well enough or a budget is spent.

    ``work(first, stop)`` returns the sums of a range of blocks, a tuple of integer arrays;
    ``excess_of(sums, blocks)`` their errors over those asked for, an array, which is empty where
    there is nothing to wait for; ``events_of(sums)`` the events simulated. ``block_events`` is
    about what a block has, ``budget`` the most of them there may be.
    """

    work: Callable
    excess_of: Callable
    events_of: Callable
    block_events: float
    budget: int


def as_many(work, blocks, block_events):
    """Return the ``Run`` of so many ``blocks``, or a few more of them: up to the next look."""
    return Run(
        work,
        lambda sums, done: np.sqrt([blocks / done]),
        lambda sums: 1,
        block_events,
        math.inf,
    )


class Done(NamedTuple):
    """What a ``Run`` has found: sums of so many blocks after so many rounds, and their errors."""

    sums: list
    blocks: int
    rounds: int
    excess: np.ndarray


def _added(sums, part):
    return list(part) if sums is None else [a + b for a, b in zip(sums, part, strict=True)]


def in_rounds(run, report=None):
    """Return what is ``Done`` when all is known well enough or the budget is spent.

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
    return Done(sums, done, rounds, excess)


# Pieces ------------------------------------------------------------------------------------------


def next_look(done):
    """Return after how many blocks a run is looked at next that has ``done`` some."""
    step = 1 << max(0, done.bit_length() - 6)
    return max(FIRST_ROUND, (done // step + 1) * step)


def pieces(run, events, blocks):
    """Return the pieces (first, stop) that hold the first ``blocks`` of a run.

    The largest ones have about so many ``events``, and the first one a 32nd of them; each other
    doubles what there is until that is as large. Their numbers of blocks are powers of two.
    """
    largest = max(FIRST_ROUND, 1 << round(math.log2(max(1.0, events / run.block_events))))
    first, stop, found = 0, max(FIRST_ROUND, largest // FIRST_PIECE), []
    while first < blocks:
        found.append((first, stop))
        first, stop = stop, stop + min(stop, largest)
    return found


def piece(run, first, stop):
    """Return the sums of a piece between looks: a list of {"first", "stop", "sums"}, for JSON."""
    found = []
    while first < stop:
        end = min(next_look(first), stop)
        sums = [np.asarray(part).tolist() for part in run.work(first, end)]
        found.append({"first": first, "stop": end, "sums": sums})
        first = end
    return found


def followed(run, found):
    """Return (what is ``Done``, the blocks it needs in all) of a run, given the sums ``found``.

    Those are what ``piece`` returns, of any pieces in any order. A run that has ended needs what is
    done; one that has not needs more, and is done as far as pieces reach.
    """
    at = {part["first"]: part for part in found}
    done, needed = Done(None, 0, 0, np.array([])), 1
    while True:
        stop, sums, place = next_look(done.blocks), done.sums, done.blocks
        while place < stop and place in at:
            sums = _added(sums, (np.array(part, np.int64) for part in at[place]["sums"]))
            place = at[place]["stop"]
        if place != stop:
            return done, needed
        done = Done(sums, stop, done.rounds + 1, run.excess_of(sums, stop))
        worst = float(np.max(done.excess, initial=0.0))
        affordable = run.budget / run.events_of(sums) * stop
        if worst <= 1.0 or affordable < next_look(stop):
            return done, stop
        needed = math.ceil(min(worst * worst * stop, GROWTH * stop, affordable))
        needed = max(needed, next_look(stop))
