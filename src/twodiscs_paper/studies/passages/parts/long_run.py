"""A long run of κ by clusters, at distances that no build goes down to."""

from twodiscs.dynamics.two.hop_clusters import HOPS_PER_BLOCK, cluster_sizes
from twodiscs.model.scene import Box
from twodiscs_paper.studies.passages.near import NearThreshold, dense, scene_at, sparse
from twodiscs_paper.studies.passages.parts.in_the_limit import kicked_counts, kicked_rows
from twodiscs_paper.studies.passages.parts.with_friction import (
    cluster_pause,
    local_exponents,
    scaling_fits,
)
from twodiscs_paper.studies.passages.powers import fits, law_powers


def long_run_thresholds(one):
    """Yield pairs (``NearThreshold``, pause) of a threshold ``one`` of a long run.

    The distance is halved ``every`` times from one to the next, once if this is not given. The
    ``pauses`` of the configuration are over that of the build.
    """
    box = Box(one["width"], one["height"])
    for halvings in range(one["first"], one["last"] + 1, one.get("every", 1)):
        effects = {"friction": one.get("friction", 0.0), "moment_of_inertia": one.get("inertia")}
        scene = scene_at(box, one["hop"], halvings, **effects)
        near = NearThreshold(one["name"], scene, one["hop"], halvings, one["seed"])
        for pause in one.get("pauses", [1]):
            yield near, pause * cluster_pause(scene, near.hop)


def cluster_counts(one):
    """Return {"events", "of", "sizes"} for each of the distances of a threshold ``one``.

    ``sizes`` are pairs [n, how many of the hops are in a cluster of n], without those of none;
    "of" is how many sizes are told apart.
    """
    found, blocks = [], -(-one["hops"] // HOPS_PER_BLOCK)
    for near, gap in long_run_thresholds(one):
        sizes, events = cluster_sizes(near.scene, near.hop, gap, blocks, near.cluster_seed)
        found.append({"events": int(events), "of": len(sizes), "sizes": sparse(sizes)})
    return found


def cluster_rows(one, counts):
    """Return the rows of passages.csv on a threshold ``one`` from its ``cluster_counts``."""
    measured, found = [], []
    for (near, gap), count in zip(long_run_thresholds(one), counts, strict=True):
        sizes = dense(count["sizes"], count["of"])
        kappa, own = near.cluster_rows(sizes, count["events"], gap)
        measured.append((near, kappa))
        found += own
    if "pauses" in one:  # at one distance
        return found
    if "friction" in one:
        return [*found, *local_exponents(measured)]
    law = [] if "inertia" in one else law_powers(found)
    return [*found, *fits(found), *law]


def long_run(thresholds, limit):
    """Return the rows of many hops at ``thresholds``, at distances that no build goes down to.

    The last rows are of κ with kicks in the ``limit``, the parameters of ``kicked_counts``.
    """
    counts = {one["name"]: cluster_counts(one) for one in thresholds}
    return long_run_rows(thresholds, limit, counts | {"limit": kicked_counts(**limit)})


def long_run_rows(thresholds, limit, counts):
    """Return the rows of passages.csv of a ``long_run`` from {name of a threshold: its counts}."""
    found = [row for one in thresholds for row in cluster_rows(one, counts[one["name"]])]
    return [*found, *scaling_fits(found), *kicked_rows(limit["scaled"], counts["limit"])]
