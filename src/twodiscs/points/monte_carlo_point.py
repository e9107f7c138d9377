"""Volume and areas by Monte Carlo at one radius, from hits or from weighted insertions."""

import math
from dataclasses import dataclass, field
from itertools import permutations
from typing import ClassVar, NamedTuple

import numpy as np

from twodiscs.model.scene import Scene
from twodiscs.points import estimates
from twodiscs.points.base import Point, reached
from twodiscs.points.estimates import Estimate

#: The areas of walls from which symmetry gives all others.
WALL_AREAS = ("right_wall_area", "top_wall_area")


def wall_weights(scene):
    """Return {area of one wall: weight} with which these areas add up to that of all walls."""
    walls = (area.removesuffix("_area") for area in WALL_AREAS)
    return {f"{wall}_area": float(scene.copies(wall)) for wall in walls if wall in scene.events}


class Sampled(NamedTuple):
    """One quantity: its estimate or None, the hits, and the least of hits and misses.

    ``epsilon`` is the thickness of its shell, None without one.
    """

    estimate: Estimate | None
    hits: int
    enough: float
    epsilon: float | None = None


class SampledPoint(Point):
    """The base of points of volume and areas."""

    stage: ClassVar[str] = "monte_carlo"

    @property
    def work(self):
        """The number of samples drawn."""
        return self.samples

    def moments(self):
        """Return the names of quantities, the means of their weights and their covariances.

        The weight of a sample in a set is 1.
        """
        names = [*self.quantities]
        means = np.array([self.mean_product(name) for name in names])
        joint = np.array([[self.mean_product(a, b) for b in names] for a in names])
        return names, means, (joint - np.outer(means, means)) / self.samples


@dataclass(frozen=True)
class Hits:
    """Samples in a set, whose size is ``measure`` × hits/samples; ``epsilon`` is a thickness."""

    hits: int
    measure: float
    epsilon: float | None


@dataclass(frozen=True)
class MonteCarloPoint(SampledPoint):
    """The hits among ``samples``, by quantity: "volume" or "<event>_area".

    ``method`` is monte_carlo or conditioned. ``right_and_top`` is the number of samples in both
    shells, for scenes in which all walls have four times the area of these two.
    """

    scene: Scene
    method: str
    samples: int
    quantities: dict[str, Hits]
    right_and_top: int | None = None
    components: dict | None = field(default=None, compare=False, repr=False)

    @classmethod
    def of(cls, scene, components):
        """Return the point of the ``components`` of a run: this one, or an ``InsertionPoint``.

        A quantity has the ``place`` of its hits among the sums, its measure and thickness.
        """
        component = components["all"]
        if component["method"] == InsertionPoint.METHOD:
            return InsertionPoint.of(scene, components)
        (hits,), blocks = reached(component["sums"])
        quantities = {
            name: Hits(int(hits[one["place"]]), one["measure"], one["epsilon"])
            for name, one in component["quantities"].items()
        }
        both = component["right_and_top"]
        return cls(
            scene,
            component["method"],
            blocks * component["samples"],
            quantities,
            None if both is None else int(hits[both]),
            components,
        )

    def sampled(self, quantity):
        """Return a quantity as ``Sampled``, None if the point does not have it."""
        if (part := self.quantities.get(quantity)) is None:
            return None
        estimate = estimates.binomial_estimate(part.hits, self.samples, part.measure)
        return Sampled(estimate, part.hits, min(part.hits, self.samples - part.hits), part.epsilon)

    def mean_product(self, *names):
        """Return the share of samples in all sets of these ``names``, one or two.

        All shells are parts of the volume. The overlap of two shells is known for the right and the
        top wall; others are taken as independent, which is right to the square of the thickness.
        """
        shares = {name: self.quantities[name].hits / self.samples for name in names}
        if len(shares) == 1 or "volume" in names:
            return min(shares.values())
        if {*names} == {*WALL_AREAS} and self.right_and_top is not None:
            return self.right_and_top / self.samples
        return math.prod(shares.values())

    def all_walls(self):
        """Return the area of all walls from two shells as ``Sampled``, or None."""
        if self.right_and_top is None:
            return None
        right, top = (self.quantities[wall] for wall in WALL_AREAS)
        estimate = estimates.combination(
            {"right": 4 * right.measure, "top": 4 * top.measure},
            {"right": right.hits, "top": top.hits},
            {"right*right": right.hits, "right*top": self.right_and_top, "top*top": top.hits},
            self.samples,
        )
        enough = min(self.sampled(wall).enough for wall in WALL_AREAS)
        both_hit = min(right.hits, top.hits) > 0
        return Sampled(estimate if both_hit else None, right.hits + top.hits, enough)


@dataclass(frozen=True)
class Weights:
    """Σ w and Σ w² of insertions; ``measure`` is the value for a mean weight of 1."""

    sum: int
    squares: int
    measure: float


@dataclass(frozen=True)
class InsertionPoint(SampledPoint):
    """The weights of ``samples`` of more than two discs, by quantity: "volume" or "<event>_area".

    Sums are in units of 1/``unit``; ``products`` are Σ w_a w_b by "a*b" of each pair.
    """

    METHOD: ClassVar[str] = "insertion"

    scene: Scene
    method: str
    samples: int
    unit: int
    quantities: dict[str, Weights]
    products: dict[str, int]
    components: dict | None = field(default=None, compare=False, repr=False)

    @classmethod
    def of(cls, scene, components):
        """Return the point of the ``components`` of a run: Σ w, then the rows of Σ w_a w_b."""
        component = components["all"]
        ((sums, *products),), blocks = reached(component["sums"])
        sampled = component["quantities"]
        places = {name: one["place"] for name, one in sampled.items()}
        return cls(
            scene=scene,
            method=component["method"],
            samples=blocks * component["samples"],
            unit=component["unit"],
            quantities={
                name: Weights(int(sums[k]), int(products[k][k]), sampled[name]["measure"])
                for name, k in places.items()
            },
            # A file has its keys sorted; only products in the order of places were summed.
            products={
                f"{a}*{b}": int(products[i][k])
                for (a, i), (b, k) in permutations(places.items(), 2)
                if i <= k  # two walls of one axis have one place
            },
            components=components,
        )

    def _sums(self, quantity):
        weights = self.quantities[quantity]
        return weights.sum, weights.squares, self.unit, self.samples

    def sampled(self, quantity):
        """Return a quantity as ``Sampled``, None if the point does not have it.

        Its hits are the effective number of samples.
        """
        if quantity not in self.quantities:
            return None
        sums = self._sums(quantity)
        found = estimates.weighted_estimate(*sums, self.quantities[quantity].measure)
        return self._sampled(*found, estimates.effective_misses(*sums))

    def all_walls(self):
        """Return the area of all walls as ``Sampled``, or None."""
        weights = wall_weights(self.scene)
        if not weights or not weights.keys() <= self.quantities.keys():
            return None
        misses = min(estimates.effective_misses(*self._sums(wall)) for wall in weights)
        return self._sampled(*self.total(weights), misses)

    def _sampled(self, estimate, effective, misses):
        return Sampled(estimate, round(effective), min(effective, misses))

    def _joint(self, a, b):
        if a == b:
            return self.quantities[a].squares
        return self.products[f"{a}*{b}" if f"{a}*{b}" in self.products else f"{b}*{a}"]

    def mean_product(self, *names):
        """Return the mean weight of one of ``names``, or the mean product of two weights."""
        total = self._joint(*names) if len(names) == 2 else self.quantities[names[0]].sum
        return total / (self.unit * self.samples)

    def _moments(self, weights):
        """Return ⟨w⟩, ⟨w²⟩ and the effective number of samples of Σ_q weight × quantity.

        ``weights`` are {quantity: weight}. The effective number is the least of all quantities.
        """
        parts, samples = self.quantities, self.unit * self.samples
        scale = {name: weight * parts[name].measure for name, weight in weights.items()}
        mean = math.fsum(scale[a] * parts[a].sum for a in scale) / samples
        second = math.fsum(scale[a] * scale[b] * self._joint(a, b) for a in scale for b in scale)
        effective = min(estimates.weighted_estimate(*self._sums(a), 1.0)[1] for a in scale)
        return mean, second / samples, effective

    def total(self, weights):
        """Return (Σ_q weight × estimate of q as an ``Estimate`` or None, effective number).

        ``weights`` are {quantity: weight}; the covariance of the quantities is in the error.
        """
        mean, second, effective = self._moments(weights)
        if not mean:
            return None, 0.0
        error = math.sqrt(max(second - mean**2, 0.0) / self.samples)
        return Estimate(mean, error, self.samples), effective

    def ratio(self, weights):
        """Return (Σ_q weight × estimate of q)/(estimate of the volume) as an ``Estimate``.

        The error is propagated linearly, with the covariance of the quantities and the volume. The
        result is None if one of them has too few effective samples for an error.
        """
        volume, _, enough = self._moments({"volume": 1.0})
        area, _, effective = self._moments(weights)
        if estimates.why_no_error(min(enough, effective), "samples"):
            return None
        # The variance of Σ weight × q/area − volume/V, whose mean is 0.
        terms = {name: weight / area for name, weight in weights.items()} | {"volume": -1 / volume}
        variance = max(self._moments(terms)[1], 0.0)
        ratio = area / volume
        return Estimate(ratio, ratio * math.sqrt(variance / self.samples), self.samples)
