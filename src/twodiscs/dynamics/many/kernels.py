"""The kernel of a scene of more than two discs: in lock step for few, with cells for many."""

import numpy as np

from twodiscs.dynamics.ensemble import LANES, RETURNS
from twodiscs.dynamics.kicks import opened
from twodiscs.dynamics.many import cells, lockstep
from twodiscs.sampling.many.initial import (
    draw_states,
    initial_of,
    large_grid,
    rows_of,
    states_of,
)
from twodiscs.sampling.streams import open_stream

#: Entries of a log before it is read.
ENTRIES = 2**14


def run_blocks(scene, seed, first, stop, duration, *, replicas=None, lanes=LANES, hops=True):
    """Count all classes of events of a ``Scene`` in the blocks ``first`` … ``stop`` − 1.

    A block is ``replicas`` states of the invariant measure from the stream ``seed``, each followed
    for ``duration``. Returns (sums, products) as ``count_events`` does: integers, which depend on
    neither lanes nor shards. ``LARGE`` numbers of discs have the kernel ``many.cells``, which
    leaves out hops if ``hops`` is not True.
    """
    replicas = replicas or lockstep.replicas_of(scene)
    hops_x = None if scene.periodic or scene.height <= 4 * scene.radius else True
    law, grid, initial = lockstep.law_of(scene), large_grid(scene), initial_of(scene)
    counts = None
    for block in range(first, stop):
        states = states_of(initial, replicas, seed, block)
        given = states, np.uint64(seed), block * replicas
        if grid is None:
            part = lockstep.count_events(
                *given, lanes, duration, law, hops_x, lockstep.new_kicks(scene, lanes)
            )
        else:
            part = cells.count_events(
                *given, duration, lockstep.epoch_of(scene), law, grid, True if hops else None,
                hops_x if hops else None, lockstep.new_kicks(scene, 1),
            )  # fmt: skip
        counts = part if counts is None else tuple(map(np.add, counts, part))
    return counts


def advance_scene(scene, states, laps, time, kicks):
    """Advance the columns of ``states`` (rows, replicas), as ``advance_states`` does."""
    law, grid = lockstep.law_of(scene), large_grid(scene)
    if grid is None:
        return lockstep.advance_states(states, laps, time, law, kicks)
    return cells.advance_all(states, laps, time, lockstep.epoch_of(scene), law, grid, kicks)


def kicks_of(scene, number, seed, block=0):
    """Return the ``Kicks`` of ``number`` states, see ``trajectory.kicks_of``."""
    return opened(lockstep.new_kicks(scene, number), seed, block)


class Followed:
    """One trajectory of ``LARGE`` numbers of discs, whose log is read in the order of time.

    ``counted`` names the hops that are logged.
    """

    def __init__(self, scene, counted):
        self.scene, self.law, self.grid = scene, lockstep.law_of(scene), large_grid(scene)
        self.epoch, self.laps = lockstep.epoch_of(scene), np.zeros(scene.discs)
        self.motion = cells.new_motion(scene.discs, self.grid, self.law.rough)
        self.log = cells.new_log(scene.discs, ENTRIES, rows_of(scene) // scene.discs)
        self.counts = np.zeros(lockstep.N, np.int64)
        self.hops = [True if hop in counted else None for hop in ("vertical_hop", "horizontal_hop")]

    def start(self, state, seed, replica=0):
        """Begin with a ``state``, a column of numbers, and the kicks of its stream."""
        self.kicks = kicks_of(self.scene, 1, seed, replica)
        self.log.origin[0] = self.laps[:] = 0.0
        cells.start_from(state, 0, self.motion, self.grid, self.law)

    def go_on(self, duration):
        """Yield the log, and the order of its entries, of one stretch after the other."""
        while duration > 0.0:
            self.log.size[0] = 0
            duration = cells.follow(
                duration, self.epoch, self.motion, self.laps, self.grid, self.law, self.counts,
                0, self.kicks, self.log, *self.hops,
            )  # fmt: skip
            yield self.log, np.argsort(self.log.times[: self.log.size[0]], kind="stable")


def record_intervals(scene, hop, seed, first, stop, chains, window, bins, sums, going):
    """Record the intervals between hops of any pair, see ``lockstep.record_intervals``."""
    if large_grid(scene) is None:
        return lockstep.run_intervals(
            scene, hop, seed, first, stop, chains, window, bins, sums, going
        )
    (width, wide), path, initial = bins, Followed(scene, (hop,)), initial_of(scene)
    totals, state = np.zeros((2, (stop - first) * chains)), np.zeros((initial.rows, 1))
    for chain in range(totals.shape[1]):
        if chain % chains == 0:
            stream = open_stream(np.uint64(seed), first + chain // chains)
        draw_states(stream, initial, state)
        path.start(state, seed, first * chains + chain)
        times, step = np.zeros(0), window
        # If there is a hop in the window, also the first one after it ends an interval.
        while step == window or (times.size and times[-1] < window):
            for log, order in path.go_on(step):
                if not going[0]:
                    return totals
                hops = order[log.classes[order] < lockstep.COLLISIONS]
                times = np.append(times, log.times[hops])
            step = window / RETURNS
        intervals = np.diff(times)[times[:-1] < window]
        index = np.minimum((intervals / width).astype(int), wide.size - 1)
        counts = np.bincount(np.append(index, wide[index]), minlength=sums.shape[1])
        totals[:, chain] = intervals.sum(), intervals.size
        sums += counts, counts**2, counts * intervals.size
    return totals
