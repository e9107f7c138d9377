"""c of 1 − κ for smooth discs, in the limit of a narrow neck."""

from twodiscs_paper.studies.passages.models import limit
from twodiscs_paper.study import row

#: Blocks of pairs of discs for c.
LIMIT_BLOCKS = 512


def in_the_limit(seed):
    """Yield the row of c, the number of 1 − κ = c σ^(2/3) ε^(1/3)/A for smooth discs."""
    c = limit.amplitude(LIMIT_BLOCKS, seed)
    yield row({"discs": 2, "quantity": "amplitude", "method": "limit"}, c, replicas=c.n)
