"""Events that molecular dynamics counted at one radius, in independent replicas of a duration T."""

import math
from dataclasses import dataclass, field
from functools import cached_property
from itertools import combinations_with_replacement, product
from typing import ClassVar

import numpy as np

from twodiscs.model.checks import check_integer
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene
from twodiscs.points import estimates
from twodiscs.points.base import Point, reached
from twodiscs.points.estimates import stratified_mean
from twodiscs.theory import clusters


def simulated_events(sums):
    """Return the number of wall hits and disc collisions among the counts of all events."""
    return int(sums[EVENTS.index("disc_collision")] + sums[EVENTS.index("any_wall")])


@dataclass(frozen=True, kw_only=True)
class Count:
    """The counts of one event.

    ``count`` is Σ N and ``squares`` Σ N² over the ``replicas``, each of a ``duration`` T. Initial
    states come from an exactly known ``share`` of configuration space.
    """

    duration: float
    share: float
    replicas: int
    count: int
    squares: int

    #: A better estimate (⟨N⟩, error) than from these sums, None without one.
    mean = None

    @property
    def sums(self):
        """Σ N, Σ N² and the number of replicas."""
        return self.count, self.squares, self.replicas

    def time(self, copies=1):
        """Return the time T · copies/share; over ⟨N⟩ it is the mean time between events.

        ``copies`` is the number of events that count as one (``Scene.copies``).
        """
        return self.duration * copies / self.share

    def estimate(self, copies=1):
        """Return the mean time between events as an ``Estimate``, None if none was counted."""
        return estimates.mean_time(*self.sums, self.time(copies), self.mean)

    def bound(self):
        """Return a lower bound on the mean time, valid if no event was counted."""
        return estimates.mean_time_bound(self.replicas, self.time())


@dataclass(frozen=True, kw_only=True)
class StripCount(Count):
    """The counts of a rare hop in a time 2T from initial states next to its surface.

    ``events`` were simulated. ``strata`` are lists (n, m): exact probabilities, numbers of initial
    states, Σ N and Σ N².
    """

    events: int
    strata: tuple

    @classmethod
    def of(cls, component):
        """Return the counts of a component of a run."""
        (sums, events), blocks = reached(component["sums"])
        return cls(
            duration=component["duration"],
            share=component["share"],
            replicas=blocks * component["replicas"],
            count=int(sums[1].sum()),
            squares=int(sums[2].sum()),
            events=int(events),
            strata=(component["shares"], *sums.tolist()),
        )

    @cached_property
    def mean(self):
        """⟨N⟩ and its error, from the strata."""
        return stratified_mean(*self.strata)


@dataclass(frozen=True)
class DynamicsPoint(Point):
    """The counts of events in ``replicas`` of a ``duration`` T.

    ``events`` is the number of wall hits and disc collisions. ``counts`` is Σ N by event,
    ``products`` Σ N_a N_b by "a*b" of each pair in the order of ``EVENTS``, and ``target`` the
    relative error asked for by event, or None. ``strips`` are counts of rare hops from initial
    states next to their surface.
    """

    stage: ClassVar[str] = "dynamics"

    scene: Scene
    duration: float
    replicas: int
    events: int
    counts: dict[str, int]
    products: dict[str, int]
    target: dict[str, float | None]
    strips: dict[str, StripCount]
    components: dict | None = field(default=None, compare=False, repr=False)

    @classmethod
    def of(cls, scene, components):
        """Return the point of the ``components`` of a run: "all", and the rare hops in strips."""
        component = components["all"]
        (sums, products), blocks = reached(component["sums"])
        places = {event: k for k, event in enumerate(EVENTS) if event in component["target"]}
        strips = {name: StripCount.of(one) for name, one in components.items() if name != "all"}
        return cls(
            scene=scene,
            duration=component["duration"],
            replicas=blocks * component["replicas"],
            events=simulated_events(sums) + sum(strip.events for strip in strips.values()),
            counts={event: check_integer(event, int(sums[k]), 0) for event, k in places.items()},
            products={
                f"{a}*{b}": int(products[i, k])
                for (a, i), (b, k) in product(places.items(), repeat=2)
                if i <= k
            },
            target=component["target"],
            strips=strips,
            components=components,
        )

    @property
    def work(self):
        """The number of events simulated."""
        return self.events

    @property
    def counted(self):
        """The events counted, in the order of ``EVENTS``."""
        return [event for event in EVENTS if event in self.counts]

    @cached_property
    def spread_products(self):
        """The ``products``, plus what errors need for bursts that no sample shows.

        Rough discs stay in corners of walls (see ``clusters.corner_variance``). The counts of
        several walls have the same bursts.
        """
        burst_variance = {
            e: clusters.corner_variance(self.scene, e, self.duration) for e in self.counts
        }
        return {
            pair: total
            + round(
                self.replicas * math.sqrt(math.prod(burst_variance[e] for e in pair.split("*")))
            )
            for pair, total in self.products.items()
        }

    def everywhere(self, event):
        """Return the ``Count`` of an event from initial states in all of configuration space."""
        return Count(
            duration=self.duration,
            share=1.0,
            replicas=self.replicas,
            count=self.counts[event],
            squares=self.spread_products[f"{event}*{event}"],
        )

    def count(self, event):
        """Return the best ``Count`` of an event, from its strip if there is one."""
        return self.strips.get(event) or self.everywhere(event)

    def combination(self, weights):
        """Return Σ weight × ⟨N⟩ as an ``Estimate``, given {event: weight} (see ``estimates``)."""
        return estimates.combination(weights, self.counts, self.spread_products, self.replicas)

    def moments(self):
        """Return the names of mean times, the mean counts ⟨N⟩ and their covariances.

        They are of all events that are counted from initial states in all of configuration space.
        """
        events, n = [event for event in self.counted if event not in self.strips], self.replicas
        totals = [self.counts[event] for event in events]
        covariances = np.zeros((len(events), len(events)))
        for (i, a), (k, b) in combinations_with_replacement(enumerate(events), 2):
            spread = n * self.spread_products[f"{a}*{b}"] - totals[i] * totals[k]
            covariances[i, k] = covariances[k, i] = spread / (n * n * (n - 1))
        return [f"{event}_time" for event in events], np.array(totals) / n, covariances
