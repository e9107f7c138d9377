"""Intervals between hops of one kind, drawn at one radius and counted in bins."""

import math
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import islice, pairwise
from typing import ClassVar, NamedTuple

from twodiscs.model.scene import Scene
from twodiscs.points import estimates
from twodiscs.points.base import Point, reached
from twodiscs.points.estimates import Estimate

#: The number of equal bins.
N_BINS = 512

#: The least width of a wide bin, over its left edge.
BIN_GROWTH = 0.08

#: The unit of the times of chains, over the width of a bin: times are integers in it.
TIME_GRAIN = 2.0**-52


def wide_edges(bins=N_BINS):
    """Return the edges of the wide bins, in units of the width of a bin.

    They begin at zero, and each is one bin wide or wider than ``BIN_GROWTH`` times its left edge.
    """
    edges = [0, 1]
    while (edge := math.ceil((1 + BIN_GROWTH) * edges[-1])) <= bins:
        edges.append(edge)
    return edges


class Bins(NamedTuple):
    """Sums over chains for bins between ``edges``, in units of the width of an equal bin.

    They are Σ c, Σ c² and Σ c n, with c of the n intervals of a chain in the bin.
    """

    edges: list[int]
    counts: list[int]
    squares: list[int]
    products: list[int]


class HistogramBin(NamedTuple):
    """A bin: "equal", "wide" or "own", its edges, its count, its density as an ``Estimate``."""

    bins: str
    left: float
    right: float
    count: int
    density: Estimate


@dataclass(frozen=True, kw_only=True)
class IntervalsPoint(Point):
    """Intervals of independent ``chains`` in ``equal`` bins from 0 on, ``overflow`` beyond them.

    ``wide`` bins, which widen with time, have the same intervals again. Bins of your own have None,
    and ``overflow`` is the number of intervals outside. ``mean`` is the mean of all
    ``intervals``, ``stderr`` its standard error over chains; ``intervals_squared`` is Σ n².
    """

    stage: ClassVar[str] = "intervals"

    scene: Scene
    event: str
    bin_width: float
    overflow: int
    equal: Bins
    wide: Bins | None
    intervals: int
    intervals_squared: int
    chains: int
    mean: float
    stderr: float
    components: dict | None = field(default=None, compare=False, repr=False)

    @classmethod
    def of(cls, scene, components):
        """Return the point of the ``components`` of a run, {"all": component}.

        Its sums are counts of the bins, equal ones, then wide ones, and Σ t and Σ t² over the times
        t of chains. If chains differ in their number n of intervals, there are Σ t n, Σ n and Σ n².
        """
        component = components["all"]
        unit = component["bin_width"]
        own = component.get("edges")
        edges = wide_edges() if own is None else [edge / unit for edge in own]
        n = N_BINS if own is None else len(edges) - 1
        (sums, moments), blocks = reached(component["sums"])
        rows = sums.tolist()
        chains, (total, squares, *more) = blocks * component["chains"], map(int, moments)
        if more:
            joint, intervals, intervals_squared = more
            mean = Fraction(total, intervals)
            spread = squares - 2 * mean * joint + mean**2 * intervals_squared
            error = math.sqrt(spread * chains / (chains - 1)) / intervals
            unit *= TIME_GRAIN
        else:
            each, mean = component["returns"], total / chains
            intervals, intervals_squared = chains * each, chains * each**2
            rows.append([each * count for count in rows[0]])
            variance = (chains * squares - total * total) / (chains * chains * (chains - 1))
            error, unit = math.sqrt(variance), unit * TIME_GRAIN / each
        equal = Bins([*range(n + 1)] if own is None else edges, *(row[:n] for row in rows))
        wide = None if own else Bins(edges, *(row[n + 1 : n + len(edges)] for row in rows))
        return cls(
            scene=scene,
            event=component["event"],
            bin_width=component["bin_width"],
            overflow=rows[0][n],
            equal=equal,
            wide=wide,
            intervals=intervals,
            intervals_squared=intervals_squared,
            chains=chains,
            mean=float(mean) * unit,
            stderr=error * unit,
            components=components,
        )

    @property
    def work(self):
        """The number of intervals drawn."""
        return self.intervals

    @property
    def density_at_zero(self):
        """The density at 0⁺ as an ``Estimate``, from the first two bins."""
        first = [one.density for one in islice(self.bins(), 2)]
        values, errors = zip(*((one.value, one.stderr) for one in first), strict=True)
        # With more than two discs another pair may hop next, so the density has a linear term.
        linear = self.scene.discs > 2
        value, error = estimates.density_of_chains_at_zero(values, errors, linear)
        return Estimate(value, error, self.chains)

    def bins(self):
        """Yield each ``HistogramBin``, the equal ones first; those of your own are one kind."""
        width = self.bin_width
        kinds = {"equal": self.equal, "wide": self.wide} if self.wide else {"own": self.equal}
        for kind, (edges, *columns) in kinds.items():
            for (left, right), count, *sums in zip(pairwise(edges), *columns, strict=True):
                density = self._density((right - left) * width, count, *sums)
                yield HistogramBin(kind, left * width, right * width, count, density)

    def _density(self, width, count, squares, product):
        """Return count/(intervals × width) as an ``Estimate``, from the spread between chains.

        The number of intervals of a chain may vary, which adds to the error.
        """
        per_chain = self.chains / (self.intervals * width)
        weights = {"n": per_chain, "all": -per_chain * count / self.intervals}
        totals = {"n": count, "all": self.intervals}
        products = {"n*n": squares, "n*all": product, "all*all": self.intervals_squared}
        error = estimates.combination(weights, totals, products, self.chains).stderr
        return Estimate(float(Fraction(per_chain) * count / self.chains), error, self.chains)
