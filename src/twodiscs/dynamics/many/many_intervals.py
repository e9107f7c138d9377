"""More than two discs: intervals between the hops of any pair, in a window of time."""

import math

import numpy as np

from twodiscs.dynamics import ensemble
from twodiscs.dynamics.many import all_pairs, many_rates
from twodiscs.dynamics.many.all_pairs import COLLISIONS, many_disc_law, new_kicks
from twodiscs.dynamics.many.many_paths import Followed
from twodiscs.model.checks import InputError
from twodiscs.model.many_geometry import CELL_DISCS
from twodiscs.sampling.many import many_initial_states
from twodiscs.sampling.many.many_initial_states import block_states, large_grid, make_initial
from twodiscs.sampling.streams import open_stream


def mean_interval(scene, hop):
    """Return the mean time between two hops of any pair, maybe within a few per cent only."""
    if not (rate := many_rates.expected_rates(scene).get(hop)):
        raise InputError(
            f"radius {scene.radius!r} is so large for {scene.discs} discs that the time between "
            f"two events {hop} is not known"
        )
    return 1 / rate


def _window(scene, hop):
    """Return a time in which ``CHAIN_HOPS`` intervals begin, or up to twice as many.

    ``CELL_DISCS`` discs or more have a longer window, the duration of a replica, but at most
    64 times the usual one. Their initial states take as much time to draw.
    """
    window = 2.0 ** math.ceil(math.log2(ensemble.CHAIN_HOPS * mean_interval(scene, hop)))
    if scene.discs < CELL_DISCS:
        return window
    return min(max(window, many_rates.replica_duration(scene)), 64 * window)


def per_chain(scene, hop):
    """Return the least number of intervals of a chain; its window has up to twice as many."""
    return max(ensemble.CHAIN_HOPS, int(_window(scene, hop) / mean_interval(scene, hop) / 2))


def events_per_interval(scene, hop):
    """Return the most wall and disc events per interval, with their work."""
    window = _window(scene, hop)
    events = window * many_rates.expected_event_rate(scene) * many_rates.work_per_event(scene)
    return events / per_chain(scene, hop)


def record_intervals(scene, hop, seed, first, stop, chains, bins, going, *, window=None):
    """Return ((times, intervals) of chains, Σ c, Σ c² and Σ c n of each bin) of some blocks.

    Intervals that begin within the ``window`` of time are counted, see ``all_pairs``.
    """
    (width, edges, wide), window = bins, window or _window(scene, hop)
    sums = np.zeros((3, wide.max() + 1), np.int64)
    if large_grid(scene) is None:
        hops_x, kicks = True if hop == "horizontal_hop" else None, new_kicks(scene, ensemble.LANES)
        given = window, many_disc_law(scene), hops_x, bins, sums, going, kicks
        initial, totals = make_initial(scene), []
        for block in range(first, stop):
            states = block_states(initial, chains, seed, block)
            seeds = np.uint64(seed), block * chains
            totals.append(all_pairs.record_intervals(states, *seeds, *given))
        return np.hstack(totals), sums
    path, initial = Followed(scene, (hop,)), make_initial(scene)
    totals, state = np.zeros((2, (stop - first) * chains)), np.zeros((initial.rows, 1))
    for chain in range(totals.shape[1]):
        if chain % chains == 0:
            stream = open_stream(np.uint64(seed), first + chain // chains)
        many_initial_states.draw_states(stream, initial, state)
        path.start(state, seed, first * chains + chain)
        times, step = np.zeros(0), window
        # If there is a hop in the window, also the first one after it ends an interval.
        while step == window or (times.size and times[-1] < window):
            for log, order in path.go_on(step):
                if not going[0]:
                    return totals, sums
                hops = order[log.classes[order] < COLLISIONS]
                times = np.append(times, log.times[hops])
            step = window / ensemble.CHAIN_HOPS
        intervals = np.diff(times)[times[:-1] < window]
        edges = width * np.arange(wide.size) if edges is None else edges
        index = (np.searchsorted(edges, intervals, side="right") - 1) % edges.size
        counts = np.bincount(np.append(index, wide[index]), minlength=sums.shape[1])
        totals[:, chain] = intervals.sum(), intervals.size
        sums += counts, counts**2, counts * intervals.size
    return totals, sums
