"""Diffusion of two discs on a ring, by correlations of hops and by displacements."""

from twodiscs_paper.studies.passages.near import ONE_INERTIA, NearThreshold, scene_at

#: Distances below h/4: halved from the first to the last.
RING = range(3, 7)


def one_ring(name, box, inertia, events, seed):
    """Yield the rows of diffusion along x, where a ``Box`` is closed to a ring."""
    for n in RING:
        scene = scene_at(box, "horizontal_hop", n, periodic="x", moment_of_inertia=inertia)
        yield from NearThreshold(name, scene, "horizontal_hop", n, seed).diffusion(events)


def on_ring(name, box, events, seed):
    """Yield the rows of two discs on a ring, smooth and rough."""
    for inertia in (None, ONE_INERTIA):
        yield from one_ring(name, box, inertia, 6 * events, seed)
