"""Counts of events in a fixed time, from initial states of the invariant measure.

The mean count in a time T is rate × T exactly, for every T and without burn-in; the spread between
independent replicas gives its error. Each family of scenes has its kernel in ``families``.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from twodiscs.dynamics.ensemble import OCTAVES, REPLICAS, relative_errors
from twodiscs.model.checks import InputError, check_choice, check_error, check_integer
from twodiscs.model.events import EVENTS
from twodiscs.model.family import of_family
from twodiscs.model.scene import Scene, check_scene
from twodiscs.sampling.blocks.rounds import SequentialRun, all_in_rounds, on_grid
from twodiscs.sampling.starts import require_room
from twodiscs.theory.exact import replicas_needed

COLLISIONS, ANY_WALLS = EVENTS.index("disc_collision"), EVENTS.index("any_wall")


def simulated_events(sums):
    """Return how many wall hits and disc collisions there are among the counts of all events."""
    return int(sums[COLLISIONS] + sums[ANY_WALLS])


def expected_rate(scene, event):
    """Return how often per time all that counts as ``event`` happens, exactly if that is known.

    For more than two discs it may be an estimate; it is 0 where nothing is known.
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

    A block is ``REPLICAS`` initial states, each followed for ``duration``. Returns (sums,
    products): Σ N_e (n) and Σ N_e N_f for e ≤ f (n, n), int64, in the order of EVENTS.
    """
    return of_family(scene, "dynamics", "run_blocks")(
        scene, events, seed, first, stop, duration, **shape
    )


def count_events(scene, target, budget, seed):
    """Count the events of a ``Scene`` in independent replicas until each is known well enough.

    ``target`` maps each tracked event to the relative standard error asked for (0 < target ≤ 1);
    blocked hops are counted but not waited for. ``budget`` is the largest number of wall and disc
    events to simulate; a block of replicas is the least that is. Work goes in rounds: see
    ``sampling.blocks.rounds``.

    Hops that are rare because of a neck are waited for in strips of their own (``strip``), which
    get of the budget what their errors take of all events; what starts anywhere see of them is
    counted, too.

    Returns a dict for a JSON file: radius, duration T and number of replicas, rounds, wall and disc
    events simulated, and for each tracked event its count ΣN, its target and status (reached,
    budget or impossible); products hold ΣN_a N_b of each pair, strips what ``strip.summary``
    returns for each rare hop, and octaves of rough discs by event what ``sort_into_octaves`` does.
    Raises ``InputError`` for an unknown event or a number out of range.
    """
    return CountingRun(scene, target, budget, seed).run()


@dataclass(frozen=True)
class CountingRun:
    """``count_events`` in blocks: frozen, its arguments checked."""

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

        The budget is shared as the errors asked for take events: so the same part of what each of
        them takes is missing where it does not allow for all of them.
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
        index = [EVENTS.index(event) for event in self._waited]
        goals = np.array([self.target[event] for event in self._waited])
        replicas = (
            relative_variance(expected_rate(scene, event) * duration) / self.target[event] ** 2
            for event in self._waited
        )

        def work(first, stop):
            # Rough discs that hardly pass each other collide in bursts, of a size without bound.
            octaves = (
                None
                if scene.moment_of_inertia is None
                else np.zeros((3, len(EVENTS), OCTAVES), int)
            )
            sums = self._family(
                "run_blocks", self._events, self.seed, first, stop, duration, octaves=octaves
            )
            return sums if octaves is None else (*sums, octaves)

        block_events = REPLICAS * expected_event_rate(scene) * duration
        # Crowds that the budget has no chance to show are not waited for.
        needed = np.array([replicas_needed(scene, e, self.target[e]) for e in self._waited])
        needed = needed / REPLICAS
        needed = np.ceil(np.where(needed * block_events <= budget, needed, 0.0))
        planned = max(replicas, default=0.0) / REPLICAS
        planned = max([planned, *needed])

        def excess_of(sums, blocks):
            errors = relative_errors(*sums[:2], blocks * REPLICAS)[index] / goals
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
        """Return the dict for a JSON file, given {name: ``Outcome``} of all parts."""
        (sums, products, *octaves), blocks, rounds, excess = outcomes["all"]
        strips = {hop: self._family("rare_summary", hop, outcomes[hop]) for hop in self._rare}
        tracked = [EVENTS.index(event) for event in self._events]
        status = dict.fromkeys(self._events, "impossible")
        for event, value in zip(self._waited, excess, strict=True):
            status[event] = "reached" if value <= 1.0 else "budget"
        by_octave = {EVENTS[e]: part[:, e].tolist() for part in octaves for e in tracked}
        return {
            "radius": self.scene.radius,
            "duration": replica_duration(self.scene),
            "replicas": blocks * REPLICAS,
            "rounds": rounds,
            "events": simulated_events(sums) + sum(strips[hop]["events"] for hop in strips),
            "counts": {EVENTS[e]: int(sums[e]) for e in tracked},
            "products": {
                f"{EVENTS[e]}*{EVENTS[f]}": int(products[e, f])
                for e in tracked
                for f in tracked
                if e <= f
            },
            "target": {event: self.target[event] for event in self._events},
            "status": status | {hop: strips[hop]["status"] for hop in strips},
            "strips": strips,
        } | ({"octaves": by_octave} if by_octave else {})

    def run(self, progress=None, cores=1, kept=None):
        """Return the dict for a JSON file, all done in this process (see ``all_in_rounds``)."""
        return self.point(all_in_rounds(self.parts, progress, cores, kept))


def relative_variance(count):
    """Return the largest variance to expect of a mean ``count`` of a replica, over its square.

    Chance has a variance of less than 2⟨N⟩; discs that keep their motion for long add a part of
    ⟨N⟩². It is infinite where none is expected. Both numbers hold at all radii of the repository's
    boxes without effects, where the second one is up to 0.16: at a hundredth of the height, and
    close to the largest radius.
    """
    return 2 / count + 1 / 6 if count else math.inf
