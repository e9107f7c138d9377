"""More than two discs: counts of their events, by the classes of events that the kernels know.

The kernels are ``all_pairs`` for few discs and ``cell_list`` for ``CELL_DISCS`` or more.
"""

import math

import numpy as np

from twodiscs.dynamics import ensemble
from twodiscs.dynamics.many import all_pairs, cell_list
from twodiscs.dynamics.many.all_pairs import CLASSES, EVENT_CLASSES, many_disc_law, new_kicks
from twodiscs.dynamics.many.many_rates import block_replicas, events_per_disc, usual_epoch
from twodiscs.model.events import HOPS
from twodiscs.sampling.many.many_initial_states import draw_states, large_grid, make_initial
from twodiscs.sampling.streams import open_stream

#: The events of each disc in successive replicas of a chain whose counts are added for their
#: variance, and the least number of such batches in a block.
BATCH_EVENTS, FEWEST_BATCHES = 48, 10


def run_blocks(scene, events, seed, first, stop, duration, **shape):
    """Return counts as ``event_counts.run_blocks`` does; few discs count hops in any case."""
    hops = any(event in HOPS for event in events)
    counts = run_classes(scene, seed, first, stop, duration, hops=hops, **shape)
    return combine_classes(*counts)


def run_classes(scene, seed, first, stop, duration, *, replicas=None, lanes=None, hops=True):
    """Count all classes of events of a ``Scene`` in the blocks ``first`` … ``stop`` − 1.

    A block is ``replicas`` states of the invariant measure from the stream ``seed``, successive
    ones of a chain if a chain draws them, each followed for ``duration``. Returns (sums, products)
    as ``count_events`` does: integers, which depend on neither lanes nor shards. ``CELL_DISCS``
    discs or more have the kernel ``cell_list``, which leaves out hops if ``hops`` is not True.
    Their chain goes on from the end of each trajectory, which has moved the discs as well, and the
    products of short replicas are those of ``spread_of_batches``.
    """
    n, replicas = len(CLASSES), replicas or block_replicas(scene, duration)
    lanes = lanes or ensemble.LANES
    hops_x = None if "x" in scene.periodic or scene.height <= 4 * scene.radius else True
    hops_y = None if "y" in scene.periodic else True
    counted = (hops_y, hops_x) if hops else (None, None)
    law, grid = many_disc_law(scene), large_grid(scene)
    # The exact rates of few discs may take seconds, and are not needed here.
    each = math.inf if grid is None else events_per_disc(scene, duration)
    initial = make_initial(scene, contacts=each)
    counts = np.zeros(n, np.int64), np.zeros((n, n), np.int64)
    states = np.zeros((initial.rows, replicas if grid is None else 1))
    batch = 1
    if grid is not None and initial.cells is None and initial.chain.between > 0:
        batch = min(math.ceil(BATCH_EVENTS / each), replicas // FEWEST_BATCHES)
    for block in range(first, stop):
        stream, rows = open_stream(np.uint64(seed), block), []
        kicks = new_kicks(scene, lanes if grid is None else 1)
        for k in range(0, replicas, states.shape[1]):
            draw_states(stream, initial, states, k)
            given = states, np.uint64(seed), block * replicas + k
            if grid is None:
                found = all_pairs.count_events(*given, lanes, duration, law, hops_x, kicks)
            else:
                epoch = usual_epoch(scene)
                found = cell_list.count_events(*given, duration, epoch, law, grid, *counted, kicks)
            rows.append(found)
        sums, products = map(np.array, zip(*rows, strict=True))
        of_block = products.sum(0) if batch <= 1 else spread_of_batches(sums, batch)
        counts = counts[0] + sums.sum(0), counts[1] + of_block
    return counts


def spread_of_batches(counts, batch):
    """Return Σ N_e N_f of ``counts`` (replicas, n), as if successive ones were independent.

    The variance is that of the sums of a ``batch`` of successive replicas, over their number, so
    that it has their correlation (overlapping batch means; M. S. Meketon and B. W. Schmeiser, Proc.
    1984 Winter Simul. Conf., 227). Above the diagonal, like the products of kernels.
    """
    replicas, total = len(counts), counts.sum(0)
    batches = sum(np.roll(counts, k, 0) for k in range(batch))
    mean = np.outer(total, total) / replicas
    spread = batches.T @ batches / batch - batch * mean
    products = mean + (replicas - 1) / (replicas - batch) * spread
    return np.triu(np.rint(products).astype(np.int64))


def combine_classes(sums, products):
    """Return (sums, products) of ``EVENTS``, given the sums and products of ``CLASSES``.

    In every replica, the hits of all walls are the hits of the two classes of walls together.
    """
    counted = [[name in parts for name in CLASSES] for parts in EVENT_CLASSES.values()]
    matrix = np.array(counted, np.int64)
    whole = products + np.triu(products, 1).T
    return matrix @ sums, np.triu(matrix @ whole @ matrix.T)


def simulated_events(sums):
    """Return how many wall hits and collisions there are among the counts of all classes."""
    return int(sums[all_pairs.COLLISIONS :].sum())
