"""Runs: counts of events to an error or in a time, and intervals between hops.

A run has its work as ``SequentialRun`` of blocks, its ``components``, and makes the point of their
sums. The kernels are those of an ``Engine``, of two discs or of many.

The mean count in a time T is rate × T exactly, for every T and without burn-in; the spread between
independent replicas gives its error.

Intervals are exact draws. Chains start on the surface of a hop, weighted by the flux through it,
and record the next returns. No interval is cut off by a window. Chains of more than two discs start
in the invariant measure, and record to their end all intervals that begin within a window of time.
This has no bias: by Palm's formula, the mean sum of these intervals over their mean number is the
mean interval.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from twodiscs.dynamics.engine import find_engine
from twodiscs.dynamics.ensemble import CHAIN_HOPS, MOST_RUN_EVENTS, nearest_power_of_two
from twodiscs.dynamics.two import strip
from twodiscs.model.checks import InputError, check_choice
from twodiscs.model.events import EVENTS
from twodiscs.model.formats import format_number
from twodiscs.model.scene import Scene, why_absent
from twodiscs.model.seeds import job_seed
from twodiscs.points.dynamics_point import DynamicsPoint, simulated_events
from twodiscs.points.estimates import relative_variance
from twodiscs.points.intervals_point import N_BINS, TIME_GRAIN, IntervalsPoint, wide_edges
from twodiscs.sampling.initial_states import require_initial_states
from twodiscs.sampling.rounds import FinishedComponents, Run, SequentialRun, fixed, round_up_blocks
from twodiscs.theory.clusters import corner_variance
from twodiscs.theory.exact import replicas_needed

#: Chains of intervals that share a stream.
CHAINS_PER_BLOCK = 256

#: The work of a day, the most without a budget, in events of the plain ensemble: 1e8 a second.
DAY_OF_EVENTS = 86400 * 10**8

# Counts -----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class DynamicsRun(Run):
    """Counts of the events of a ``Scene`` in independent replicas until each is known well enough.

    ``target`` maps each tracked event to the relative standard error asked for (0 < target ≤ 1);
    blocked hops are counted, but their error is ignored. ``budget`` is the largest number of wall
    and disc events to simulate, None for the work of a day; the minimum is one block of replicas.
    Work goes in rounds (see ``sampling.rounds``).

    Hops that are rare because of a neck are also counted in strips (``strip``), unless the
    ``method`` is "dynamics". The budget is divided in proportion to the events that each error
    needs.

    With a ``duration`` there are whole blocks of replicas, at least one, until all replicas
    together have it, whatever their errors. All events are then counted in the same replicas. Rare
    hops have no strips, because trajectories in a strip have another duration. Raises
    ``InputError`` for a duration with more than ``budget`` expected events.
    """

    scene: Scene
    target: dict
    budget: int | None
    seed: int
    method: str | None = None
    duration: float | None = None

    @classmethod
    def of(cls, scene, settings):
        """Return the run of ``settings`` of ``simulate``."""
        seed = job_seed(scene, DynamicsPoint.stage, settings["seed"], settings["name"])
        error, budget = settings["error"], settings["budget"]
        # With a duration there is no error; 1 is the largest one that a run takes.
        own = error if isinstance(error, dict) else dict.fromkeys(settings["events"], error or 1.0)
        return cls(scene, own, budget, seed, settings.get("method"), settings.get("duration"))

    def __post_init__(self):
        require_initial_states(self.scene)
        if self.method is not None:
            check_choice("method", self.method, ["dynamics", *["strips"] * bool(self._rare)])
        if self.duration is None:
            return
        rate = find_engine(self.scene).rates.expected_event_rate(self.scene)
        if self.duration * rate > self.most_events:
            raise InputError(
                f"duration must be below {format_number(self.most_events / rate, '.3g')}, where "
                f"the budget of {format_number(self.most_events, 'g')} events is spent, not "
                f"{format_number(self.duration, 'g')}"
            )

    @property
    def most_events(self):
        """The budget, or without one the number of events of a day, roughly."""
        return self.budget or DAY_OF_EVENTS / find_engine(self.scene).rates.cost_ratio(self.scene)

    @cached_property
    def replica_duration(self):
        """The time T of a replica."""
        return find_engine(self.scene).rates.replica_duration(self.scene, self.budget)

    @property
    def _events(self):
        return [event for event in EVENTS if event in self.target]

    @cached_property
    def _rare(self):
        ordinary = self.method == "dynamics" or self.duration
        rare = () if ordinary else strip.rare_hops(self.scene)
        return [hop for hop in rare if hop in self.target]

    @property
    def _ordinary_events(self):
        return [e for e in self._events if self.scene.is_possible(e) and e not in self._rare]

    @cached_property
    def components(self):
        """Runs by name, ``SequentialRun``: "all" and the rare hops.

        The budget is divided in proportion to the events that the errors need. If it is too small
        for all of them, each has the same fraction of its events. Without a budget, this is true of
        the work of a day.
        """
        if self.duration:
            run, time = self._everything(self.most_events), self.replica_duration
            replicas = find_engine(self.scene).rates.block_replicas(self.scene, time)
            blocks = max(1, math.ceil(self.duration / (replicas * time)))
            return {"all": fixed(run.work, blocks, run.block_events, run.cost_ratio)}
        each = find_engine(self.scene).rates.work_per_event(self.scene)
        budget = max(1, int(self.most_events / each))
        runs = {"all": self._everything(budget)}
        for hop in self._rare:
            runs[hop] = strip.strip_run(self.scene, hop, self.target[hop], budget, self.seed)
        events = {name: run.planned * run.block_events for name, run in runs.items()}
        total = sum(events.values())
        if self.budget is None:
            work = sum(run.planned * run.block_work for run in runs.values())
            total = budget * work * each / DAY_OF_EVENTS
        most = min(1.0, budget / total)
        return {
            name: replace(
                run,
                budget=run.budget * events[name] / total,
                planned=round_up_blocks(run.planned * most),
            )
            for name, run in runs.items()
        }

    def _everything(self, budget):
        scene, engine = self.scene, find_engine(self.scene)
        duration = self.replica_duration
        each = engine.rates.block_replicas(scene, duration)
        index = [EVENTS.index(event) for event in self._ordinary_events]
        goals = np.array([self.target[event] for event in self._ordinary_events])
        replicas = (
            relative_variance(engine.rates.expected_rate(scene, event) * duration)
            / self.target[event] ** 2
            for event in self._ordinary_events
        )

        def work(first, stop):
            return engine.counts.run_blocks(scene, self._events, self.seed, first, stop, duration)

        block_events = each * engine.rates.expected_event_rate(scene) * duration
        # Errors of bursts that the budget cannot reach are ignored.
        needed = [replicas_needed(scene, e, self.target[e]) for e in self._ordinary_events]
        needed = np.array(needed) / each
        needed = np.ceil(np.where(needed * block_events <= budget, needed, 0.0))
        planned = max([max(replicas, default=0.0) / each, *needed])
        if scene.discs > 2:
            # A rate that is not known is 0; rare hops of two discs have their own components.
            planned = min(planned, budget / block_events)

        burst_variance = np.array([corner_variance(scene, event, duration) for event in EVENTS])

        def error_over_target(sums, blocks):
            errors = relative_errors(*sums, blocks * each, burst_variance)[index] / goals
            return np.maximum(errors, np.sqrt(needed / blocks))

        return SequentialRun(
            work,
            error_over_target,
            lambda sums: max(1, simulated_events(sums[0])),
            block_events,
            budget,
            round_up_blocks(planned),
            engine.rates.cost_ratio(scene),
        )

    def run(self, progress=None, cores=1, resume_from=None):
        """Return the point; replicas of another duration, from another budget, are done again."""
        old = None if isinstance(resume_from, FinishedComponents) else resume_from
        if old and old["all"]["duration"] != self.replica_duration:
            resume_from = None
        return super().run(progress, cores, resume_from)

    def point(self, ranges):
        """Return the ``DynamicsPoint``, given {component: ranges of blocks with their sums}."""
        engine = find_engine(self.scene)
        constants = {
            "duration": self.replica_duration,
            "replicas": engine.rates.block_replicas(self.scene, self.replica_duration),
            "target": {e: None if self.duration else self.target[e] for e in self._events},
        }
        components = {"all": constants | {"sums": ranges["all"]}}
        for hop in self._rare:
            components[hop] = strip.constants(self.scene, hop) | {"sums": ranges[hop]}
        return DynamicsPoint.of(self.scene, components)


def relative_errors(sums, products, replicas, burst_variance=0.0):
    """Return the relative standard error of each mean count (n), inf without a count.

    Replicas are independent, so the error is √(var N / R) / ⟨N⟩. The variance has a part that is
    ``burst_variance`` in samples (see ``clusters.corner_variance``).
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = sums / replicas
        variance = np.maximum(np.diag(products) / replicas - mean**2, 0.0) + burst_variance
        errors = np.sqrt(variance / replicas) / mean
    return np.where(sums > 0, errors, np.inf)


# Intervals --------------------------------------------------------------------------------------


def record_blocks(scene, event, seed, first, stop, going, edges=None):
    """Return (times of the chains, sums in bins) of the blocks ``first`` … ``stop`` − 1.

    Each block has ``CHAINS_PER_BLOCK`` chains of ``CHAIN_HOPS`` intervals, see
    ``record_intervals``. ``going`` is an array to stop it with. Bins are between ``edges``, or
    equal and wide ones.
    """
    n, unions = (N_BINS, wide_edges()) if edges is None else (len(edges) - 1, [0])
    # Intervals beyond all bins, or in the last ones that fill no wide bin, have no wide bin.
    last = n + len(unions)
    wide = np.full(n + 1, last)
    wide[: unions[-1]] = n + np.repeat(np.arange(1, len(unions)), np.diff(unions))
    edges = None if edges is None else np.array(edges)
    engine, bins = find_engine(scene), (_width(scene, event), edges, wide)
    return engine.intervals.record_intervals(
        scene, event, seed, first, stop, CHAINS_PER_BLOCK, bins, going
    )


@dataclass(frozen=True)
class IntervalsRun(Run):
    """Intervals between hops of one kind, each one exact, counted in bins.

    ``event`` is a hop that the ``Scene`` allows; ``intervals`` is the least number of intervals,
    within the ``budget`` of wall and disc events. Chains of ``CHAIN_HOPS`` successive
    intervals start on the hop's surface with the flux-weighted measure. The map from hop to hop
    preserves it, so every interval of a chain has the law of the interval between hops. Intervals
    within a chain are correlated, chains are independent.

    Bins have a power of two near τ/16 as width. Chains of more than two discs differ in their
    number of intervals. Bins of your own have their ``edges``. With an ``error``, the relative
    standard error of the mean, blocks are added until it is reached. Raises ``InputError`` for a
    hop that is blocked, and for one whose mean time is not known.
    """

    scene: Scene
    event: str
    intervals: int
    seed: int
    budget: int = MOST_RUN_EVENTS
    edges: list | None = None
    error: float | None = None

    @classmethod
    def of(cls, scene, settings):
        """Return the run of the ``settings`` of ``intervals``."""
        seed = job_seed(scene, IntervalsPoint.stage, settings["seed"], settings["name"])
        error = settings.get("error")
        # An interval spreads about as much as its mean.
        number = settings["number"] if error is None else math.ceil(error**-2)
        budget, edges = settings["budget"], settings.get("bins")
        return cls(scene, settings["hop"], number, seed, budget, edges, error)

    def __post_init__(self):
        scene = self.scene
        if not scene.is_possible(self.event):
            why = why_absent(scene, self.event) or f": it is blocked at radius {scene.radius!r}"
            raise InputError(f"event {self.event!r} has no intervals{why}")
        require_initial_states(scene)
        if not self._blocks:
            raise InputError(
                f"budget must allow for {self._each} intervals, at radius {scene.radius!r} "
                f"of {self._events:.2g} events each, not {self.budget!r}"
            )

    @property
    def _events(self):
        return find_engine(self.scene).intervals.events_per_interval(self.scene, self.event)

    @property
    def _each(self):
        """The number of intervals of a block."""
        intervals = find_engine(self.scene).intervals
        return CHAINS_PER_BLOCK * intervals.per_chain(self.scene, self.event)

    @property
    def _blocks(self):
        wanted = -(-self.intervals // self._each)
        return min(wanted, int(self.budget / (self._each * self._events)))

    @cached_property
    def _going(self):
        """A flag that long kernels read: false when no thread waits for their result."""
        return np.ones(1, np.bool_)

    @cached_property
    def components(self):
        """The ``SequentialRun`` of all blocks, {"all": run}.

        Sums are the sums of ``record_intervals``, and Σ t and Σ t² over the times of chains, in
        grains. Chains of more than two discs differ in their number n of intervals. They also have
        Σ t n, Σ n and Σ n².
        """

        def work(first, stop):
            totals, sums = record_blocks(
                self.scene, self.event, self.seed, first, stop, self._going, self.edges
            )
            totals, *numbers = np.atleast_2d(totals)
            # Integers in the finest unit that doubles have.
            times = [int(time) for time in totals / (_width(self.scene, self.event) * TIME_GRAIN)]
            moments = [sum(times), sum(time * time for time in times)]
            for number in numbers:
                n = [int(each) for each in number]
                joint = sum(time * each for time, each in zip(times, n, strict=True))
                moments += [joint, sum(n), sum(each * each for each in n)]
            return sums, np.array(moments, object)

        def error_over_target(sums, blocks):
            found = self.point({"all": {(0, blocks): sums}})
            return np.array([found.stderr / found.mean / self.error])

        ratio = find_engine(self.scene).rates.chain_cost_ratio(self.scene)
        run = fixed(work, self._blocks, self._each * self._events, ratio)
        if self.error is not None:
            run = replace(run, error_over_target=error_over_target, budget=self.budget)
        return {"all": run}

    def point(self, ranges):
        """Return the ``IntervalsPoint``, given {"all": ranges of blocks with their sums}."""
        component = {
            "event": self.event,
            "bin_width": _width(self.scene, self.event),
            "chains": CHAINS_PER_BLOCK,
            "returns": CHAIN_HOPS,
            "sums": ranges["all"],
        }
        if self.edges is not None:
            component["edges"] = self.edges
        return IntervalsPoint.of(self.scene, {"all": component})

    def run(self, progress=None, cores=1, resume_from=None):
        """Return the ``IntervalsPoint``; stop long kernels if nobody waits any more."""
        try:
            return super().run(progress, cores, resume_from)
        except BaseException:
            self._going[0] = False
            raise


def _width(scene, event):
    return nearest_power_of_two(find_engine(scene).intervals.mean_interval(scene, event) / 16)
