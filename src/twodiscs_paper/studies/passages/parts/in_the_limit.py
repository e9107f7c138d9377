"""Smooth discs in the limit of a narrow neck: c of 1 − κ, and κ with kicks."""

import numpy as np

from twodiscs.dynamics.transmission import cluster_coefficient
from twodiscs.model.seeds import stream_seed
from twodiscs.points.estimates import Estimate
from twodiscs_paper.studies.passages.models import kicked_neck, limit
from twodiscs_paper.studies.passages.near import dense, sparse
from twodiscs_paper.studies.passages.parts.with_friction import B, scaling_law
from twodiscs_paper.study import row

#: Blocks of pairs of discs for c.
LIMIT_BLOCKS = 512


def in_the_limit(seed):
    """Yield the row of c, the number of 1 − κ = c σ^(2/3) ε^(1/3)/A for smooth discs."""
    c = limit.amplitude(LIMIT_BLOCKS, seed)
    yield row({"discs": 2, "quantity": "amplitude", "method": "limit"}, c, replicas=c.n)


def kicked_counts(scaled, blocks, seed):
    """Return ``sparse`` sizes of clusters at each of the ``scaled`` frictions x = γ√(εσ)."""
    streams = [np.uint64(stream_seed(seed, "kicked neck", "passages", repr(x))) for x in scaled]
    found = zip(scaled, streams, strict=True)
    return [sparse(kicked_neck.cluster_sizes(x, stream, 0, blocks)) for x, stream in found]


def kicked_rows(scaled, counts):
    """Yield the rows of κ beside ``scaling_law``, and of the coefficient of x² in this law."""
    start, left = {"discs": 2, "method": "limit"}, []
    for x, pairs in zip(scaled, counts, strict=True):
        kappa = cluster_coefficient(dense(pairs, kicked_neck.NECK_CLUSTER + 1))
        cells = {"quantity": "coefficient", "friction": x, "reference": scaling_law(x)}
        yield row(start | cells, kappa, replicas=kappa.n)
        inverse = 1 / (1 / kappa.value - 4 * x / 3)
        left.append((x**2, inverse - 1 - B * x, kappa.stderr * (inverse / kappa.value) ** 2))
    square, rest, error = np.array(left).T
    weight = np.sum((square / error) ** 2)
    second = Estimate(float(np.sum(square * rest / error**2) / weight), float(weight**-0.5), 1)
    yield row(start, second, quantity="scaling_second", replicas=len(left))
