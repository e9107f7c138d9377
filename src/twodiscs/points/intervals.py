"""Intervals between hops of one kind, drawn at one radius and counted in bins."""

from dataclasses import dataclass
from itertools import pairwise, repeat
from typing import ClassVar, NamedTuple

from twodiscs.model.checks import InputError, check_choice
from twodiscs.points import estimates
from twodiscs.points.base import Point, require_positive
from twodiscs.points.estimates import Estimate


@dataclass(frozen=True, kw_only=True)
class Bins:
    """Sums over chains for each bin: Σ c and Σ c², with c the intervals of a chain in the bin.

    If the number n of intervals differs from chain to chain, ``products`` are Σ c n.
    """

    counts: list[int]
    squares: list[int]
    products: list[int] | None = None


@dataclass(frozen=True, kw_only=True)
class WideBins(Bins):
    """Bins that widen with time, between ``edges`` in units of the width of an equal bin."""

    edges: list[int]


class Bin(NamedTuple):
    """One bin: "equal" or "wide", its edges, its count, and the density as an ``Estimate``."""

    bins: str
    left: float
    right: float
    count: int
    density: Estimate


@dataclass(frozen=True, kw_only=True)
class IntervalsPoint(Bins, Point):
    """Intervals of independent ``chains`` in equal bins from 0 on, ``overflow`` beyond them.

    ``wide`` has the same intervals again. ``mean`` is the mean of all ``intervals``, ``stderr`` its
    standard error over chains; ``intervals_squared`` is Σ n² if n differs.
    """

    stage: ClassVar[str] = "intervals"

    radius: float
    event: str
    bin_width: float
    overflow: int
    wide: WideBins
    intervals: int
    chains: int
    mean: float
    stderr: float
    intervals_squared: int | None = None

    def __post_init__(self):
        require_positive(self, "bin_width", "intervals", "chains", "mean")
        varies = self.intervals_squared is not None
        numbers = {"": len(self.counts), "wide.": len(self.wide.edges) - 1}
        for (name, bins), some in zip(numbers.items(), (self, self.wide), strict=True):
            if (some.products is not None) != varies:
                raise InputError(f"{name}products must be there if intervals_squared is")
            lists = some.counts, some.squares, *([some.products] if varies else [])
            if bins < 2 or any(len(one) != bins for one in lists):
                raise InputError(f"{name}counts must be of two bins or more, as squares")
        if any(right <= left for left, right in pairwise(self.wide.edges)):
            raise InputError("wide.edges must be ascending")

    def estimate(self, name="mean"):
        """Return an ``Estimate`` by name: the "mean", or the "density_at_zero"."""
        check_choice("name", name, ("mean", "density_at_zero"))
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
        """Yield each ``Bin``, the equal ones first."""
        width, equal = self.bin_width, range(len(self.counts) + 1)
        for bins, edges, some in (("equal", equal, self), ("wide", self.wide.edges, self.wide)):
            columns = some.counts, some.squares, some.products or repeat(None)
            for (left, right), count, *sums in zip(pairwise(edges), *columns, strict=False):
                density = self._density((right - left) * width, count, *sums)
                yield Bin(bins, left * width, right * width, count, density)

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
