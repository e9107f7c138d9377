"""Counts of events in a fixed time, from initial states of the invariant measure.

The mean count in a time T is rate × T exactly, for every T and without burn-in; the spread between
independent replicas gives its error. ``two.lockstep`` follows two discs, ``many`` more of them.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from twodiscs.dynamics.ensemble import relative_errors
from twodiscs.dynamics.two import strip
from twodiscs.model.checks import InputError, check_choice, check_error, check_integer
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene, check_scene
from twodiscs.points.dynamics import DynamicsPoint, simulated_events
from twodiscs.sampling.blocks.rounds import SequentialRun, all_in_rounds, on_grid
from twodiscs.sampling.starts import require_room
from twodiscs.theory.exact import replicas_needed


def engine_of(scene):
    """Return the module that counts the events of a ``Scene``: of two discs, or of many."""
    if check_scene(scene).discs > 2:
        from twodiscs.dynamics.many import experiments as engine
    else:
        from twodiscs.dynamics.two import lockstep as engine
    return engine


def expected_event_rate(scene):
    """Return the wall hits and disc collisions per unit of time, exactly if the rate is known.

    For more than two discs it may be an estimate.
    """
    return engine_of(scene).expected_event_rate(scene)


def replica_duration(scene):
    """Return the time T of one replica, a power of two."""
    return engine_of(scene).replica_duration(scene)


def run_blocks(scene, events, seed, first, stop, duration, **shape):
    """Count ``events`` in the blocks ``first`` … ``stop`` − 1 of the stream ``seed``.

    A block is some initial states (``block_replicas``), each followed for ``duration``. Returns
    (sums, products): Σ N_e (n) and Σ N_e N_f for e ≤ f (n, n), int64, in the order of EVENTS.
    """
    return engine_of(scene).run_blocks(scene, events, seed, first, stop, duration, **shape)


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

    @property
    def _events(self):
        return [event for event in EVENTS if event in self.target]

    @cached_property
    def _rare(self):
        return [hop for hop in strip.rare_hops(self.scene) if hop in self.target]

    @property
    def _waited(self):
        return [e for e in self._events if self.scene.is_possible(e) and e not in self._rare]

    @cached_property
    def parts(self):
        """Runs by name, ``SequentialRun``: "all" and the rare hops.

        The budget is divided in proportion to the events that the errors need. If it is too small
        for all of them, each has the same fraction of its events.
        """
        budget = max(1, int(self.budget / engine_of(self.scene).work_per_event(self.scene)))
        runs = {"all": self._everything(budget)}
        for hop in self._rare:
            runs[hop] = strip.run_of(self.scene, hop, self.target[hop], budget, self.seed)
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
        scene, engine = self.scene, engine_of(self.scene)
        duration, each = engine.replica_duration(scene), engine.block_replicas(scene)
        index = [EVENTS.index(event) for event in self._waited]
        goals = np.array([self.target[event] for event in self._waited])
        replicas = (
            relative_variance(engine.expected_rate(scene, event) * duration)
            / self.target[event] ** 2
            for event in self._waited
        )

        def work(first, stop):
            return engine.run_blocks(scene, self._events, self.seed, first, stop, duration)

        block_events = each * engine.expected_event_rate(scene) * duration
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
            on_grid(engine.planned(planned, budget / block_events)),
            engine.cost_ratio(scene),
        )

    def point(self, pieces):
        """Return the ``DynamicsPoint``, given {name: pieces} of all parts."""
        engine = engine_of(self.scene)
        constants = {
            "duration": engine.replica_duration(self.scene),
            "replicas": engine.block_replicas(self.scene),
            "target": self._target,
        }
        parts = {"all": constants | {"sums": pieces["all"]}}
        for hop in self._rare:
            parts[hop] = strip.constants(self.scene, hop) | {"sums": pieces[hop]}
        return DynamicsPoint.of(self.scene.radius, parts)

    @property
    def _target(self):
        return {event: self.target[event] for event in self._events}

    def run(self, progress=None, cores=1, kept=None):
        """Do all work in this process and return the ``DynamicsPoint``.

        ``kept`` are the parts of an earlier run, which are not done again (see ``all_in_rounds``).
        """
        return self.point(all_in_rounds(self.parts, progress, cores, kept))


def relative_variance(count):
    """Return the largest variance to expect of a replica's count over its mean ``count`` squared.

    Random counts have a variance of less than 2⟨N⟩; discs that keep their motion for long add a
    fraction of ⟨N⟩². It is infinite if none is expected. Both numbers hold at all radii of the
    repository's boxes without effects. The fraction is up to 0.16 there, at a hundredth of the
    height and close to the largest radius.
    """
    return 2 / count + 1 / 6 if count else math.inf
