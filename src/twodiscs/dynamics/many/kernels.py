"""The kernel of a scene of more than two discs: in lock step for few, with cells for many."""

import numpy as np

from twodiscs.dynamics.ensemble import LANES
from twodiscs.dynamics.many import cells, lockstep
from twodiscs.sampling.many.initial import initial_of, large_grid


def run_blocks(scene, seed, first, stop, duration, *, replicas=None, lanes=LANES, hops=True):
    """Count all classes of events of a ``Scene`` in the blocks ``first`` … ``stop`` − 1.

    A block is ``replicas`` states of the invariant measure from the stream ``seed``, each followed
    for ``duration``. Returns (sums, products) as ``count_blocks`` does: integers, which depend on
    neither lanes nor shards. ``LARGE`` numbers of discs have the kernel ``many.cells``, which
    leaves out hops if ``hops`` is not True.
    """
    replicas = replicas or lockstep.replicas_of(scene)
    hops_x = None if scene.periodic or scene.height <= 4 * scene.radius else True
    seed, law = np.uint64(seed), lockstep.law_of(scene)
    initial, grid = initial_of(scene), large_grid(scene)
    if grid is None:
        return lockstep.count_blocks(
            seed, first, stop, replicas, lanes, duration, scene.discs, law, initial, hops_x
        )
    return cells.count_blocks(
        seed, first, stop, replicas, duration, lockstep.epoch_of(scene), law, initial, grid,
        True if hops else None, hops_x if hops else None,
    )  # fmt: skip


def advance_scene(scene, states, laps, time):
    """Advance the columns of ``states`` (4N, replicas), as ``advance_states`` does."""
    law, grid = lockstep.law_of(scene), large_grid(scene)
    if grid is None:
        return lockstep.advance_states(states, laps, time, law)
    return cells.advance_all(states, laps, time, lockstep.epoch_of(scene), law, grid)
