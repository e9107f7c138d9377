"""More than two discs: counts of their events, by the classes of events that the kernels know.

The kernels are ``all_pairs`` for few discs and ``cell_list`` for ``LARGE`` numbers of them.
"""

import numpy as np

from twodiscs.dynamics import ensemble
from twodiscs.dynamics.many import all_pairs, cell_list
from twodiscs.dynamics.many.all_pairs import CLASSES, EVENT_CLASSES, many_disc_law, new_kicks
from twodiscs.dynamics.many.many_rates import block_replicas, usual_epoch
from twodiscs.model.events import HOPS
from twodiscs.sampling.many.many_initial_states import block_states, large_grid, make_initial


def run_blocks(scene, events, seed, first, stop, duration, **shape):
    """Return counts as ``event_counts.run_blocks`` does; few discs count hops in any case."""
    hops = any(event in HOPS for event in events)
    counts = run_classes(scene, seed, first, stop, duration, hops=hops, **shape)
    return combine_classes(*counts)


def run_classes(scene, seed, first, stop, duration, *, replicas=None, lanes=None, hops=True):
    """Count all classes of events of a ``Scene`` in the blocks ``first`` … ``stop`` − 1.

    A block is ``replicas`` states of the invariant measure from the stream ``seed``, successive
    ones of a chain if a chain draws them, each followed for ``duration``. Returns (sums, products)
    as ``count_events`` does: integers, which depend on neither lanes nor shards. ``LARGE`` numbers
    of discs have the kernel ``cell_list``, which leaves out hops if ``hops`` is not True.
    """
    n, replicas = len(CLASSES), replicas or block_replicas(scene)
    lanes = lanes or ensemble.LANES
    hops_x = None if "x" in scene.periodic or scene.height <= 4 * scene.radius else True
    law, grid, initial = many_disc_law(scene), large_grid(scene), make_initial(scene, chained=True)
    counts = np.zeros(n, np.int64), np.zeros((n, n), np.int64)
    for block in range(first, stop):
        states = block_states(initial, replicas, seed, block)
        given = states, np.uint64(seed), block * replicas
        kicks = new_kicks(scene, lanes if grid is None else 1)
        if grid is None:
            of_block = all_pairs.count_events(*given, lanes, duration, law, hops_x, kicks)
        else:
            hops_y = None if "y" in scene.periodic else True
            counted = (hops_y, hops_x) if hops else (None, None)
            given += duration, usual_epoch(scene), law, grid
            of_block = cell_list.count_events(*given, *counted, kicks)
        counts = tuple(map(np.add, counts, of_block))
    return counts


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
