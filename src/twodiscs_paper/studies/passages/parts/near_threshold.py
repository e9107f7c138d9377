"""κ of smooth and of rough discs without friction, near the radius where their hop is blocked."""

from twodiscs.dynamics.transmission import quiet_time
from twodiscs.dynamics.two.hop_clusters import HOPS_PER_BLOCK
from twodiscs_paper.studies.passages.near import (
    FEWEST_HOPS,
    MOST_HOPS,
    NearThreshold,
    blocks_for,
    scene_at,
)

#: Distances below the radius where the hop becomes blocked: halved from the first to the last.
SMOOTH_HALVINGS, ROUGH_HALVINGS = range(3, 15), range(3, 10)

#: Replicas for κ over replicas for κ(t), and events for κ over events for other estimates: most
#: events for κ are in pauses, where they cost least.
RECORDED, IN_PAUSES = 4, 3


def one_hop(name, box, hop, halvings, inertia, events, seed):
    """Yield the rows of one hop of a plain ``Box`` at distances that are halved.

    ``inertia`` is the moment of inertia of rough discs, None for smooth discs. An estimate may take
    about ``events`` wall and disc events, κ ``IN_PAUSES`` times as many.
    """
    for n in halvings:
        scene = scene_at(box, hop, n, moment_of_inertia=inertia)
        near, both = NearThreshold(name, scene, hop, n, seed), 2 * quiet_time(scene, hop)
        blocks = blocks_for(scene, 2.0**-n, both, IN_PAUSES * events)
        kappa, rows = near.clusters(blocks)
        yield from rows
        yield from near.curve(max(blocks // RECORDED, FEWEST_HOPS // HOPS_PER_BLOCK), kappa)
        if inertia is None:
            yield from near.slope(MOST_HOPS // HOPS_PER_BLOCK)


def near_threshold(name, box, hop, inertias, events, seed):
    """Yield the rows of a ``hop`` of a plain ``Box`` near the radius where it becomes blocked.

    ``inertias`` are the moments of inertia of rough discs.
    """
    yield from one_hop(name, box, hop, SMOOTH_HALVINGS, None, events, seed)
    for inertia in inertias:
        yield from one_hop(name, box, hop, ROUGH_HALVINGS, inertia, events, seed)
