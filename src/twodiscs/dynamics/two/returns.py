"""Intervals between the hops of two discs: chains that start on the surface of a hop."""

from typing import NamedTuple

import numpy as np

from twodiscs.dynamics.ensemble import CHAIN_HOPS, LANES, SWEEPS, find_bin
from twodiscs.dynamics.law import crosses, crossing_time
from twodiscs.dynamics.two.follow import follow, relative_motion
from twodiscs.model.scene import hopping_along
from twodiscs.sampling.initial_states import start_sampler
from twodiscs.theory import exact


class Returns(NamedTuple):
    """The experiment: the intervals between the next ``wanted`` hops of each chain, in bins.

    The hops are vertical, or horizontal if ``horizontal`` is True instead of None. With c intervals
    of a chain in a bin, ``sums`` are Σ c and Σ c² over the chains (2, bins; int64). There are bins
    between ``edges``, one for all other intervals, and wide bins; ``wide`` has the wide bin of each
    of the others. ``totals`` are the times of the chains, in order, from the chain ``first`` on.
    """

    horizontal: bool | None
    wanted: float
    width: float  # of bins from 0 on
    edges: np.ndarray | None  # of the bins, ascending, if they have no width
    wide: np.ndarray
    to_come: np.ndarray  # (lanes,), hops until the end of a chain
    age: np.ndarray  # (lanes,), the time since the last hop
    interval: np.ndarray  # (lanes,), an interval that ends in this sweep, else −1
    elapsed: np.ndarray  # (lanes,), the sum of the intervals of a chain
    finished: np.ndarray  # (lanes + 1,), the intervals that end in this sweep
    lane_of: np.ndarray  # (lanes + 1,), and their lanes
    counts: np.ndarray  # (lanes, bins)
    sums: np.ndarray
    totals: np.ndarray
    first: int
    both_ways: bool | None = None

    def begin(self, i, state):
        """Begin a chain; its time has no end, its hops have."""
        self.elapsed[i] = self.age[i] = 0.0
        # A start with Δ̇ < 0 crosses the surface at time 0 by its sign; that is not a return.
        rising = relative_motion(state, self.horizontal)[1]
        self.to_come[i] = self.wanted + (1.0 if rising < 0.0 else 0.0)
        return np.inf

    def note(self, i, before, after, code, time, left):
        """Close an interval if the flight has a hop."""
        waited, to_come = self.age[i], self.to_come[i]
        apart, rising = relative_motion(before, self.horizontal)
        hop = crosses(apart, relative_motion(after, self.horizontal)[0])
        until = crossing_time(apart, rising)
        recorded = hop & (to_come > 0.0) & (to_come <= self.wanted)
        self.interval[i] = waited + until if recorded else -1.0
        self.age[i] = time - until if hop else waited + time
        to_come -= 1.0 if hop else 0.0
        self.to_come[i] = to_come
        return left if to_come > 0.0 else 0.0

    def swept(self, sweeps):
        """Count the intervals that have ended in their bins."""
        n = 0
        for i in range(self.interval.size):
            self.finished[n], self.lane_of[n] = self.interval[i], i
            n += 1 if self.interval[i] >= 0.0 else 0
        for k in range(n):
            i = self.lane_of[k]
            self.elapsed[i] += self.finished[k]
            index = find_bin(self.finished[k], self.width, self.wide.size - 1, self.edges)
            self.counts[i, index] += 1
            self.counts[i, self.wide[index]] += 1

    def ended(self, i, replica, stretch):
        """Add the counts of a chain and their squares."""
        for k in range(self.sums.shape[1]):
            self.sums[0, k] += self.counts[i, k]
            self.sums[1, k] += self.counts[i, k] * self.counts[i, k]
            self.counts[i, k] = 0
        self.totals[replica - self.first] = self.elapsed[i]
        return 0.0


def mean_interval(scene, hop):
    """Return the exact mean time between two hops."""
    return exact.mean_times(scene)[hop]


def per_chain(scene, hop):
    """Return the number of intervals of a chain."""
    return CHAIN_HOPS


def events_per_interval(scene, hop):
    """Return the exact wall and disc events per interval, with their work."""
    return exact.events_per_interval(scene, hop)


def record_intervals(
    scene, hop, seed, first, stop, chains, bins, going, *, returns=CHAIN_HOPS, lanes=LANES
):
    """Return (the time of each chain, Σ c and Σ c² of each bin) of some blocks, see ``Returns``.

    Each block has ``chains`` chains of as many intervals as ``returns``; ``bins`` are (width,
    edges, wide). ``going`` is an array to stop it with.
    """
    width, edges, wide = bins
    sums = np.zeros((2, wide.max() + 1), np.int64)
    if scene.is_plain:  # initial states are drawn on the surface of vertical hops only
        scene, hop = hopping_along(scene, hop, "y")
    horizontal = True if hop == "horizontal_hop" else None
    finished, lane_of = np.zeros(lanes + 1), np.zeros(lanes + 1, np.int64)
    counts, totals = np.zeros((lanes, sums.shape[1]), np.int64), np.zeros((stop - first) * chains)
    recorded = Returns(
        horizontal, float(returns), width, edges, wide, *np.zeros((4, lanes)),
        finished, lane_of, counts, sums, totals, first * chains,
    )  # fmt: skip
    sampler = start_sampler(scene, surface=1 if horizontal is None else 0)
    follow(recorded, scene, sampler, seed, first, stop, chains, lanes, SWEEPS, going)
    return totals, sums
