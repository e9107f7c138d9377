"""The two engines, of two discs and of more: all that moves the discs of a scene and counts."""

from types import ModuleType
from typing import NamedTuple

from twodiscs.dynamics.two import event_counts, hop_clusters, path, returns, two_rates


class Engine(NamedTuple):
    """All that runs need of dynamics: five modules, which have these functions in both engines.

    The first argument of each function is a ``Scene``. Expected values are exact for two discs, and
    some may be off by a few per cent for more. Work has the time of an event of the plain ensemble
    as its unit.

    ``rates``: what is expected, and its work.

    - ``expected_event_rate()``: wall hits and collisions, in 1/time
    - ``expected_rate(event)``: its rate over all discs and walls, in 1/time, 0 if unknown
    - ``replica_duration(budget)``: the time T of a replica, 2ⁿ; a budget of events or None
    - ``block_replicas(duration)``: the replicas of a block, each of a time T; None for the usual T
    - ``cost_ratio()``: the work of an event
    - ``work_per_event()``: that of an event with its kicks and jumps, over ``cost_ratio``
    - ``chain_cost_ratio()``: the work of an event of a chain, and of a cluster of hops

    ``counts``: events in blocks of replicas.

    - ``run_blocks(events, seed, first, stop, duration)``: (Σ N_e, Σ N_e N_f), integers

    ``intervals``: those between hops, in chains that share a block.

    - ``mean_interval(hop)``: in time
    - ``per_chain(hop)``: the least number of intervals that a chain records
    - ``events_per_interval(hop)``: wall hits and collisions, weighted by their work
    - ``record_intervals(hop, seed, first, stop, chains, bins, going)``: times, sums in bins

    ``paths``: one event by event, or all columns of an array of states at a time.

    - ``path_rows(state, duration, seed, hops)``: an iterator of ``Rows``
    - ``trajectory_rate(hops)``: the rows of a trajectory, in 1/time; of two discs no hops
    - ``usual_duration()``: the time of a trajectory, a power of two
    - ``new_kicks(lanes)``: ``Kicks`` of friction that no state has begun, or None
    - ``new_wraps(number)``: an array that counts jumps along periodic axes, zeros
    - ``advance_all(states, wraps, time, kicks)``: changes these; centres stay in the cell
    - ``unwrap(columns, wraps)``: undoes the jumps of the centres in {name: array}

    ``clusters``: those of hops, see ``hop_clusters``.

    - ``require_coefficient(hop)``: raises ``InputError`` if there is no coefficient
    - ``neighbours(hop)``: mean time of two neighbours, pairs that share a disc with one
    - ``hop_sums(hop, times, blocks, seed, first)``: (sums, events)
    - ``cluster_sizes(hop, gap, blocks, seed, first)``: (sizes, events)
    """

    rates: ModuleType
    counts: ModuleType
    intervals: ModuleType
    paths: ModuleType
    clusters: ModuleType


def find_engine(scene):
    """Return the ``Engine`` of a ``Scene``. Kernels of many discs are imported if needed."""
    if scene.discs == 2:
        return Engine(two_rates, event_counts, returns, path, hop_clusters)
    from twodiscs.dynamics.many import (
        class_counts,
        many_hop_clusters,
        many_intervals,
        many_paths,
        many_rates,
    )

    return Engine(many_rates, class_counts, many_intervals, many_paths, many_hop_clusters)
