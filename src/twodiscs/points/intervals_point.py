"""Intervals between hops of one kind, drawn at one radius and counted in bins."""

import math
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import pairwise, repeat
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
    while (edge := max(edges[-1] + 1, math.ceil((1 + BIN_GROWTH) * edges[-1]))) <= bins:
        edges.append(edge)
    return edges


class Bins(NamedTuple):
    """Sums over chains for bins between ``edges``, in units of the width of an equal bin.

    They are Σ c and Σ c², with c the intervals of a chain in the bin. If the number n of intervals
    differs from chain to chain, ``products`` are Σ c n.
    """

    edges: list[int]
    counts: list[int]
    squares: list[int]
    products: list[int] | None = None


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
    ``intervals``, ``stderr`` its standard error over chains; ``intervals_squared`` is Σ n² if n
    differs.
    """

    stage: ClassVar[str] = "intervals"

    scene: Scene
    event: str
    bin_width: float
    overflow: int
    equal: Bins
    wide: Bins | None
    intervals: int
    chains: int
    mean: float
    stderr: float
    intervals_squared: int | None = None
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
        chains, (total, squares, *more) = blocks * component["chains"], map(int, moments)
        if more:
            joint, intervals, intervals_squared = more
            mean = Fraction(total, intervals)
            spread = squares - 2 * mean * joint + mean**2 * intervals_squared
            error = math.sqrt(spread * chains / (chains - 1)) / intervals
            unit *= TIME_GRAIN
        else:
            intervals, intervals_squared, mean = chains * component["returns"], None, total / chains
            variance = (chains * squares - total * total) / (chains * chains * (chains - 1))
            error, unit = math.sqrt(variance), unit * TIME_GRAIN / component["returns"]
        rows = sums.tolist()
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

    def estimate(self, name="mean"):
        """Return an ``Estimate`` by name: the "mean", or the "density_at_zero"."""
        if name == "mean":
            return Estimate(self.mean, self.stderr, self.chains)
        first = [one.density for one in list(self.bins())[:2]]
        # With more than two discs another pair may hop next, so the density has a linear term.
        value, error = estimates.density_of_chains_at_zero(
            [one.value for one in first],
            [one.stderr for one in first],
            linear=self.intervals_squared is not None,
        )
        return Estimate(value, error, self.chains)

    def bins(self):
        """Yield each ``HistogramBin``, the equal ones first; those of your own are one kind."""
        width = self.bin_width
        kinds = {"equal": self.equal, "wide": self.wide} if self.wide else {"own": self.equal}
        for kind, (edges, counts, squares, products) in kinds.items():
            columns = counts, squares, products or repeat(None)
            for (left, right), count, *sums in zip(pairwise(edges), *columns, strict=False):
                density = self._density((right - left) * width, count, *sums)
                yield HistogramBin(kind, left * width, right * width, count, density)

    def _density(self, width, count, squares, product):
        """Return count/(intervals × width) as an ``Estimate``, from the spread between chains."""
        per_chain = self.chains / (self.intervals * width)
        weights, totals, products = {"n": per_chain}, {"n": count}, {"n*n": squares}
        density = estimates.combination(weights, totals, products, self.chains)
        if product is None:
            return density
        # The number of intervals of a chain varies.
        weights |= {"all": -per_chain * count / self.intervals}
        products |= {"n*all": product, "all*all": self.intervals_squared}
        totals |= {"all": self.intervals}
        error = estimates.combination(weights, totals, products, self.chains).stderr
        return Estimate(density.value, error, self.chains)
