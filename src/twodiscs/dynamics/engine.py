"""The two engines, of two discs and of more: all that moves the discs of a scene and counts."""

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np

from twodiscs.dynamics.ensemble import CHAIN_HOPS, REPLICAS
from twodiscs.dynamics.two import event_counts, follow, hop_clusters, path, returns, two_rates
from twodiscs.theory import exact


class Engine(NamedTuple):
    """All that runs need of dynamics; ``find_engine`` returns one.

    The first argument of each function is a ``Scene``; comments name the others and the result.
    Expected values are exact for two discs, and some may be off by a few per cent for more. Work
    has the time of an event of the plain ensemble as its unit.
    """

    # Counts of events in blocks of replicas.
    expected_event_rate: Callable  # wall hits and collisions, in 1/time
    expected_rate: Callable  # (event): its rate over all discs and walls, in 1/time, 0 if unknown
    replica_duration: Callable  # (budget of events or None): the time T of a replica, 2ⁿ
    block_replicas: Callable  # (T, None for the usual one): the number of replicas of a block
    run_blocks: Callable  # (events, seed, first, stop, duration): (Σ N_e, Σ N_e N_f), integers
    cost_ratio: Callable  # the work of an event
    work_per_event: Callable  # the work of an event with its kicks and jumps, over ``cost_ratio``

    # Intervals between hops, in chains that share a block.
    mean_interval: Callable  # (hop): in time
    intervals_of_chain: Callable  # (hop): the least number of intervals that a chain records
    events_per_interval: Callable  # (hop): wall hits and collisions, weighted by their work
    chain_cost_ratio: Callable  # the work of an event of a chain, and of a cluster of hops
    interval_sums: int  # the number of sums of each bin
    record_intervals: Callable  # (hop, seed, first, stop, chains, bins, sums, going): times

    # Paths: one event by event, or all columns of an array of states at a time.
    path_rows: Callable  # (state, duration, seed, hops): an iterator of ``Rows``
    trajectory_rate: Callable  # (hops): the rows of a trajectory, in 1/time; of two discs no hops
    usual_duration: Callable  # the time of a trajectory, a power of two
    new_kicks: Callable  # (number): ``Kicks`` of friction that no state has begun, or None
    new_wraps: Callable  # (number): an array that counts jumps along periodic axes, zeros
    advance_all: Callable  # (states, wraps, time, kicks): changes these; centres stay in the cell
    unwrap: Callable  # (columns, wraps): undoes the jumps of the centres in {name: array}

    # Clusters of hops, see ``hop_clusters``.
    require_coefficient: Callable  # (hop): raises ``InputError`` if there is no coefficient
    neighbours: Callable  # (hop): mean time of two neighbours, pairs that share a disc with one
    hop_sums: Callable  # (hop, times, blocks, seed, first): (sums, events)
    cluster_sizes: Callable  # (hop, gap, blocks, seed, first): (sizes, events)


TWO_DISC_ENGINE = Engine(
    expected_event_rate=exact.event_rate,
    expected_rate=two_rates.expected_rate,
    replica_duration=lambda scene, budget=None: two_rates.replica_duration(scene),
    block_replicas=lambda scene, duration=None: REPLICAS,
    run_blocks=event_counts.run_blocks,
    cost_ratio=two_rates.cost_ratio,
    work_per_event=two_rates.work_per_event,
    chain_cost_ratio=lambda scene: 1.0,
    interval_sums=returns.INTERVAL_SUMS,
    mean_interval=lambda scene, hop: exact.mean_times(scene)[hop],
    intervals_of_chain=lambda scene, hop: CHAIN_HOPS,
    events_per_interval=exact.events_per_interval,
    record_intervals=returns.record_intervals,
    path_rows=path.path_rows,
    trajectory_rate=path.trajectory_rate,
    usual_duration=path.usual_duration,
    new_kicks=follow.new_kicks,
    new_wraps=lambda scene, number: np.zeros((3, number)),
    advance_all=path.advance_all,
    unwrap=path.unwrap,
    require_coefficient=hop_clusters.require_coefficient,
    neighbours=lambda scene, hop: (exact.mean_times(scene)[hop], 0),
    hop_sums=hop_clusters.hop_sums,
    cluster_sizes=hop_clusters.cluster_sizes,
)


@cache
def _many_discs():
    from twodiscs.dynamics.many import (
        all_pairs,
        class_counts,
        many_hop_clusters,
        many_intervals,
        many_paths,
        many_rates,
    )

    return Engine(
        expected_event_rate=many_rates.expected_event_rate,
        expected_rate=many_rates.expected_rate,
        replica_duration=many_rates.replica_duration,
        block_replicas=many_rates.block_replicas,
        run_blocks=class_counts.run_blocks,
        cost_ratio=many_rates.cost_ratio,
        work_per_event=many_rates.work_per_event,
        chain_cost_ratio=many_rates.cost_ratio,
        interval_sums=many_intervals.SUMS_WITH_COUNTS,
        mean_interval=many_intervals.mean_interval,
        intervals_of_chain=many_intervals.intervals_of_chain,
        events_per_interval=many_intervals.events_per_interval,
        record_intervals=many_intervals.record_intervals,
        path_rows=many_paths.path_rows,
        trajectory_rate=many_paths.trajectory_rate,
        usual_duration=many_paths.usual_duration,
        new_kicks=all_pairs.new_kicks,
        new_wraps=lambda scene, number: np.zeros((2 * scene.discs, number)),
        advance_all=many_paths.advance_all,
        unwrap=many_paths.unwrap,
        require_coefficient=many_hop_clusters.require_coefficient,
        neighbours=many_hop_clusters.neighbours,
        hop_sums=many_hop_clusters.hop_sums,
        cluster_sizes=many_hop_clusters.cluster_sizes,
    )


def find_engine(scene):
    """Return the ``Engine`` of a ``Scene``. Kernels of many discs are imported if needed."""
    return TWO_DISC_ENGINE if scene.discs == 2 else _many_discs()
