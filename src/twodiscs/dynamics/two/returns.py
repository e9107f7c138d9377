"""Intervals between the hops of two discs: chains that start on the surface of a hop."""

import numpy as np

from twodiscs.dynamics.ensemble import (
    LANES,
    PASSES,
    RETURNS,
    across,
    find_events,
    kick_lanes,
    new_kicks,
    new_rows,
    put_state,
    state_at,
)
from twodiscs.dynamics.kicks import open_kicks
from twodiscs.dynamics.law import after_event, crosses, crossing_time, law_of
from twodiscs.model.scene import hopping_along
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.starts import COMPONENTS, origins, start_on_surface
from twodiscs.sampling.streams import open_stream
from twodiscs.theory import exact

#: Numbers that are summed in each bin: Σ c and Σ c².
INTERVAL_SUMS = 2


@compiled
def record_returns(
    seed,
    first,
    stop,
    chains,
    lanes,
    returns,
    law,
    draw,
    prism,
    horizontal,
    width,
    wide,
    sums,
    going,
    kicks,
):
    """Run the chains of blocks ``first`` … ``stop`` − 1 for ``returns`` hops each.

    The hops are vertical ones, or horizontal ones if ``horizontal`` is True instead of None. The
    initial states come from ``prism`` or, if that is None, from ``draw``, which is for vertical
    hops only. With c intervals of a chain in a bin, Σ c and Σ c² over the chains are added to
    ``sums`` (2, bins; int64). There are bins of ``width`` from 0 on, one for longer intervals, and
    wide bins; ``wide`` has the wide bin of each of the others. ``kicks`` are those of the lanes,
    None without friction. Returns the total time of each chain, (stop − first) × ``chains`` doubles
    in order.
    """
    rows, start = new_rows(lanes, law), np.zeros((COMPONENTS, 1))
    times, codes, intervals = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    endless, left = np.full(lanes, np.inf), np.zeros(lanes)
    age, elapsed = np.zeros(lanes), np.zeros(lanes)
    chain, finished, lane_of = (
        np.full(lanes, -1),
        np.zeros(lanes + 1),
        np.zeros(lanes + 1, np.int64),
    )
    totals, counts = np.zeros((stop - first) * chains), np.zeros((lanes, sums.shape[1]), np.int64)
    per_width, last_bin, wanted = 1.0 / width, wide.size - 1, np.float64(returns)
    surface = 1 if horizontal is None else 0
    state = open_stream(seed, first)
    started, running = 0, 0

    while True:
        for i in range(lanes):
            if left[i] > 0.0:
                continue
            if chain[i] >= 0:
                totals[chain[i]] = elapsed[i]
                for k in range(sums.shape[1]):
                    sums[0, k] += counts[i, k]
                    sums[1, k] += counts[i, k] * counts[i, k]
                    counts[i, k] = 0
                chain[i] = -1
                running -= 1
            if started == totals.size:
                continue
            if started % chains == 0:
                state = open_stream(seed, first + started // chains)
            start_on_surface(state, draw, surface, start, prism)
            put_state(rows, i, start[:, 0], law)
            open_kicks(i, seed, first * chains + started, kicks)
            chain[i], elapsed[i], age[i] = started, 0.0, 0.0
            # A start with Δ̇ < 0 crosses the surface at time 0 by its sign; that is not a return.
            _, rising = across(state_at(rows, i, law), horizontal)
            left[i] = wanted + (1.0 if rising < 0.0 else 0.0)
            started += 1
            running += 1
        if running == 0 or not going[0]:
            return totals

        for _ in range(PASSES):
            find_events(rows, endless, times, codes, law, kicks)
            for i in range(lanes):
                before, time, waited = state_at(rows, i, law), times[i], age[i]
                after = after_event(before, time, codes[i], law)
                put_state(rows, i, after, law)
                apart, rising = across(before, horizontal)
                hop = crosses(apart, across(after, horizontal)[0])
                until, to_come = crossing_time(apart, rising), left[i]
                recorded = hop & (to_come > 0.0) & (to_come <= wanted)
                interval = waited + until
                intervals[i] = interval if recorded else -1.0
                elapsed[i] += interval if recorded else 0.0
                age[i] = time - until if hop else waited + time
                left[i] = to_come - 1.0 if hop else to_come
            kick_lanes(rows, times, law, kicks)
            n = 0
            for i in range(lanes):
                finished[n], lane_of[n] = intervals[i], i
                n += 1 if intervals[i] >= 0.0 else 0
            for k in range(n):
                index = min(np.int64(finished[k] * per_width), last_bin)
                counts[lane_of[k], index] += 1
                counts[lane_of[k], wide[index]] += 1


def record_intervals(scene, hop, seed, first, stop, chains, returns, bins, sums, going):
    """Record the intervals between hops as ``record_returns`` does; ``bins`` are (width, wide)."""
    if scene.is_plain:  # initial states are drawn on the surface of vertical hops only
        scene, hop = hopping_along(scene, hop, "y")
    return record_returns(
        np.uint64(seed), first, stop, chains, LANES, returns, law_of(scene), *origins(scene),
        True if hop == "horizontal_hop" else None, *bins, sums, going, new_kicks(scene, LANES),
    )  # fmt: skip


def mean_interval(scene, hop):
    """Return the mean time between two hops of one kind, exactly."""
    return exact.mean_times(scene)[hop]


def intervals_of_chain(scene, hop):
    """Return the number of intervals that a chain records."""
    return RETURNS


def interval_cost(scene):
    """Return the time of an event over the time of an event of the plain ensemble."""
    return 1.0


def events_per_interval(scene, hop):
    """Return the mean number of wall and disc events between two hops, weighted by their work."""
    return exact.events_per_interval(scene, hop)
