"""Counts of events in a fixed time, from initial states of the invariant measure.

The mean count in a time T is rate × T exactly, for every T and without burn-in; the spread between
independent replicas gives its error. Each family of scenes has its kernel in ``families``.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from twodiscs.dynamics.ensemble import relative_errors
from twodiscs.model.checks import InputError, check_choice, check_error, check_integer
from twodiscs.model.events import EVENTS
from twodiscs.model.family import of_family
from twodiscs.model.scene import Scene, check_scene
from twodiscs.points.dynamics import DynamicsPoint
from twodiscs.sampling.blocks.rounds import SequentialRun, all_in_rounds, on_grid
from twodiscs.sampling.starts import require_room
from twodiscs.theory.exact import replicas_needed

COLLISIONS, ANY_WALLS = EVENTS.index("disc_collision"), EVENTS.index("any_wall")


def simulated_events(sums):
    """Return the number of wall hits and disc collisions among the counts of all events."""
    return int(sums[COLLISIONS] + sums[ANY_WALLS])


def expected_rate(scene, event):
    """Return the rate of an ``event``, exactly if the exact rate is known.

    For more than two discs it may be an estimate; it is 0 if nothing is known.
    """
    return of_family(scene, "dynamics", "expected_rate")(scene, event)


def expected_event_rate(scene):
    """Return the wall hits and disc collisions per unit of time, as ``expected_rate``."""
    return of_family(scene, "dynamics", "expected_event_rate")(scene)


def replica_duration(scene):
    """Return the time T of one replica, a power of two; see the kernel of its family."""
    return of_family(check_scene(scene), "dynamics", "replica_duration")(scene)


def run_blocks(scene, events, seed, first, stop, duration, **shape):
    """Count ``events`` in the blocks ``first`` … ``stop`` − 1 of the stream ``seed``.

    A block is some initial states (``block_replicas``), each followed for ``duration``. Returns
    (sums, products): Σ N_e (n) and Σ N_e N_f for e ≤ f (n, n), int64, in the order of EVENTS.
    """
    return of_family(scene, "dynamics", "run_blocks")(
        scene, events, seed, first, stop, duration, **shape
    )


def count_events(scene, target, budget, seed):
    """Count the events of a ``Scene`` in independent replicas until each is known well enough.

    ``target`` maps each tracked event to the relative standard error asked for (0 < target ≤ 1);
    blocked hops are counted, but their error is ignored. ``budget`` is the largest number of wall
    and disc events to simulate; the minimum is one block of replicas. Work goes in rounds (see
    ``sampling.blocks.rounds``).

    Hops that are rare because of a neck are also counted in strips (``strip``). The budget is
    divided in proportion to the events that each error needs.

    Returns a ``DynamicsPoint``. Raises ``InputError`` for an unknown event or a number out of
    range.
    """
    return CountingRun(scene, target, budget, seed).run()


@dataclass(frozen=True)
class CountingRun:
    """``count_events`` in blocks, with checked arguments."""

    scene: Scene
    target: dict
    budget: int
    seed: int

    def __post_init__(self):
        check_scene(self.scene)
        if not isinstance(self.target, dict) or not self.target:
            raise InputError(
                f"target must name at least one event, with its error, not {self.target!r}"
            )
        for event, target in self.target.items():
            check_error(f"target of {check_choice('event', event, EVENTS)}", target)
        check_integer("budget", self.budget)
        check_integer("seed", self.seed, 0)
        require_room(self.scene)

    def _family(self, function, *given, **named):
        return of_family(self.scene, "dynamics", function)(self.scene, *given, **named)

    @property
    def _events(self):
        return [event for event in EVENTS if event in self.target]

    @cached_property
    def _rare(self):
        return [hop for hop in self._family("rare_hops") if hop in self.target]

    @property
    def _waited(self):
        return [e for e in self._events if self.scene.is_possible(e) and e not in self._rare]

    @cached_property
    def parts(self):
        """Runs by name, ``SequentialRun``: "all" and the rare hops.

        The budget is divided in proportion to the events that the errors need. If it is too small
        for all of them, each has the same fraction of its events.
        """
        budget = max(1, int(self.budget / self._family("work_per_event")))
        runs = {"all": self._everything(budget)}
        for hop in self._rare:
            runs[hop] = self._family("rare_run", hop, self.target[hop], budget, self.seed)
        events = {name: run.planned * run.block_events for name, run in runs.items()}
        total = sum(events.values())
        most = min(1.0, budget / total)
        return {
            name: replace(
                run,
                budget=run.budget * events[name] / total,
                planned=on_grid(run.planned * most),
            )
            for name, run in runs.items()
        }

    def _everything(self, budget):
        scene, duration = self.scene, replica_duration(self.scene)
        each = self._family("block_replicas")
        index = [EVENTS.index(event) for event in self._waited]
        goals = np.array([self.target[event] for event in self._waited])
        replicas = (
            relative_variance(expected_rate(scene, event) * duration) / self.target[event] ** 2
            for event in self._waited
        )

        def work(first, stop):
            return self._family("run_blocks", self._events, self.seed, first, stop, duration)

        block_events = each * expected_event_rate(scene) * duration
        # Errors of bursts that the budget cannot reach are ignored.
        needed = np.array([replicas_needed(scene, e, self.target[e]) for e in self._waited])
        needed = needed / each
        needed = np.ceil(np.where(needed * block_events <= budget, needed, 0.0))
        planned = max(replicas, default=0.0) / each
        planned = max([planned, *needed])

        def excess_of(sums, blocks):
            errors = relative_errors(*sums, blocks * each)[index] / goals
            return np.maximum(errors, np.sqrt(needed / blocks))

        return SequentialRun(
            work,
            excess_of,
            lambda sums: max(1, simulated_events(sums[0])),
            block_events,
            budget,
            on_grid(self._family("planned", planned, budget / block_events)),
            self._family("cost_ratio"),
        )

    def point(self, outcomes):
        """Return the ``DynamicsPoint``, given {name: ``Outcome``} of all parts."""
        (sums, products), blocks, rounds, excess = outcomes["all"]
        strips = {hop: self._family("rare_summary", hop, outcomes[hop]) for hop in self._rare}
        tracked = [EVENTS.index(event) for event in self._events]
        status = dict.fromkeys(self._events, "impossible")
        for event, value in zip(self._waited, excess, strict=True):
            status[event] = "reached" if value <= 1.0 else "budget"
        return DynamicsPoint(
            radius=self.scene.radius,
            duration=replica_duration(self.scene),
            replicas=blocks * self._family("block_replicas"),
            rounds=rounds,
            events=simulated_events(sums) + sum(strip.events for strip in strips.values()),
            counts={EVENTS[e]: int(sums[e]) for e in tracked},
            products={
                f"{EVENTS[e]}*{EVENTS[f]}": int(products[e, f])
                for e in tracked
                for f in tracked
                if e <= f
            },
            target={event: self.target[event] for event in self._events},
            status=status | {hop: strip.status for hop, strip in strips.items()},
            strips=strips,
        )

    def run(self, progress=None, cores=1, kept=None):
        """Do all work in this process and return the ``DynamicsPoint`` (see ``all_in_rounds``)."""
        return self.point(all_in_rounds(self.parts, progress, cores, kept))


def relative_variance(count):
    """Return the largest variance to expect of a replica's count over its mean ``count`` squared.

    Random counts have a variance of less than 2⟨N⟩; discs that keep their motion for long add a
    fraction of ⟨N⟩². It is infinite if none is expected. Both numbers hold at all radii of the
    repository's boxes without effects. The fraction is up to 0.16 there, at a hundredth of the
    height and close to the largest radius.
    """
    return 2 / count + 1 / 6 if count else math.inf
