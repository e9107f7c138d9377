"""Counts of events in a fixed time, from starts of the invariant measure.

The mean count in a time T is rate × T exactly, for every T and without burn-in; the spread between
independent replicas gives its error.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from twodiscs.dynamics import strip
from twodiscs.dynamics.ensemble import (
    LANES,
    PASSES,
    REPLICAS,
    find_events,
    nearest_power_of_two,
    new_rows,
    put_state,
    relative_errors,
    state_at,
)
from twodiscs.dynamics.law import (
    DISC,
    END_OF_TIME,
    WALL_X1,
    WALL_X2,
    WALL_Y1,
    WALL_Y2,
    after_event,
    crosses,
    law_of,
)
from twodiscs.model.checks import InputError, check_choice, check_error, check_integer
from twodiscs.model.events import DECLARED, EVENTS, HOPS, WALLS, by_kind
from twodiscs.model.scene import Scene, check_scene
from twodiscs.sampling.blocks.rounds import SequentialRun, all_in_rounds, on_grid
from twodiscs.sampling.jit import compiled, inlined, optional
from twodiscs.sampling.starts import COMPONENTS, draw_any_starts, origins, require_room
from twodiscs.sampling.streams import open_stream
from twodiscs.theory import exact

#: Looks at which lanes have ended between two unpackings of the counts: a packed count must stay
#: below 256.
LOOKS = 31

#: Wall and disc events that a replica is meant to last; fewer where an open hop happens less than
#: so many times in it.
EVENTS_PER_REPLICA = 256
HOPS_PER_REPLICA = 4
EVENTS_BETWEEN_RARE_HOPS = 64

#: What a pair of more than two discs adds to the time of an event, which it takes of the plain
#: ensemble: 3, 4 and 8 discs take 3.7, 5.9 and 22 times as long.
PAIR = 0.8

# How events are counted --------------------------------------------------------------------------

# How a flight shows an event, as a function of the code of its end, of the states before and after,
# of whether the discs are identical, and of gravity (None for both: they are not, there is none).


def _hop_seen(event):
    k = "xy".index(event.axis)
    return lambda code, a, b, identical, gravity: crosses(a[k] - a[k + 2], b[k] - b[k + 2])


@optional(lambda code, first, second, identical: code == first)
def hit(code, first, second, identical):
    """Say whether disc 1 is on a wall, or any disc if they are ``identical``."""
    return (code == first) | (code == second)


@optional(lambda position, side, gravity: True)
def facing(position, side, gravity):
    """Say whether a disc is on the wall of a ``side``, which matters in a field."""
    return position * side > 0.0


# Of a wall everything counts that ``Scene.multiplicity`` does.


def _wall_seen(event):
    if event.axis == "x":
        return lambda code, a, b, identical, gravity: hit(code, WALL_X1, WALL_X2, identical)
    side = float(event.side)
    return lambda code, a, b, identical, gravity: (
        hit(code, WALL_Y1, WALL_Y2, identical)
        & facing(b[1] if code == WALL_Y1 else b[3], side, gravity)
    )


SEEN = by_kind(
    "dynamics/counting.py",
    {
        "hop": _hop_seen,
        "collision": lambda event: lambda code, a, b, identical, gravity: code == DISC,
        "wall": _wall_seen,
        # Collisions of the discs too; see ``all_walls``.
        "walls": lambda event: lambda code, a, b, identical, gravity: code > END_OF_TIME,
    },
)

#: What is not tracked (None) is not compiled; this says which entry of ``tracked`` is that of a
#: kind: hops, walls, the hits of all walls, and what is always tracked.
TRACKED = {"hop": 0, "wall": 1, "walls": 2, "collision": 3}

N = len(EVENTS)
COLLISIONS, ANY_WALLS = EVENTS.index("disc_collision"), EVENTS.index("any_wall")
BESIDE, ABOVE = EVENTS.index("right_wall"), EVENTS.index("top_wall")

#: A lane counts in a double: fields of eight bits, so many of which it holds. A second double takes
#: the events that the first one has no room for.
FIELDS = 6
if N > 2 * FIELDS:
    raise TypeError(f"dynamics/counting.py has room for {2 * FIELDS} events, not for {N}")


def _and(add, event, unit):
    """Return ``add`` extended by an ``event``: it adds a ``unit`` to the count if that is seen."""
    seen, k = inlined(SEEN[event]), TRACKED[DECLARED[event].kind]

    @optional(lambda count, code, before, after, identical, gravity, tracked: count)
    def add_one(count, code, before, after, identical, gravity, tracked):
        return count + (unit if seen(code, before, after, identical, gravity) else 0.0)

    @inlined
    def add_all(count, code, before, after, identical, gravity, tracked):
        count = add(count, code, before, after, identical, gravity, tracked)
        return add_one(count, code, before, after, identical, gravity, tracked[k])

    return add_all


def _word(events):
    """Return a function that adds to a packed ``count`` what a flight shows of ``events``."""
    add = inlined(lambda count, code, before, after, identical, gravity, tracked: count)
    for field, event in enumerate(events):
        add = _and(add, event, 256.0**field)
    return add


first_word, second_word = _word(EVENTS[:FIELDS]), _word(EVENTS[FIELDS:])


@optional(lambda counts, rest: counts[BESIDE] + counts[ABOVE])
def all_walls(counts, rest):
    """Return the hits of all walls, which are those of either axis where both count them all."""
    return counts[ANY_WALLS] - counts[COLLISIONS]


@compiled
def unpack(packed, more, counts, lane):
    """Move the packed counts of a ``lane`` to ``counts`` (n, lanes)."""
    words = np.int64(packed[lane]), np.int64(more[lane])
    packed[lane] = more[lane] = 0.0
    for e in range(N):
        counts[e, lane] += (words[e // FIELDS] >> (8 * (e % FIELDS))) & 255


#: Counts of a replica are sorted by their octave, 0, 1, 2 to 3, 4 to 7 and so on.
OCTAVES = 40


@optional(lambda counts, octaves: None)
def sort_into_octaves(counts, octaves):
    """Add one replica to ``octaves`` (3, n, ``OCTAVES``): how many there are, Σ N and Σ N²."""
    for e in range(N):
        octave, rest = 0, counts[e]
        while rest > 0:
            octave, rest = octave + 1, rest >> 1
        octaves[0, e, octave] += 1
        octaves[1, e, octave] += counts[e]
        octaves[2, e, octave] += counts[e] * counts[e]


@compiled
def count_blocks(
    seed, first, stop, replicas, lanes, duration, law, draw, prism, sides, identical, hops, walls,
    rest, octaves,
):  # fmt: skip
    """Follow the starts of blocks ``first`` … ``stop`` − 1 for a ``duration`` and add their counts.

    Returns (sums, products): Σ N_e (n) and Σ N_e N_f for e ≤ f (n, n) over all replicas, int64, in
    the order of EVENTS. Starts come from ``draw`` with ``sides`` as in ``draw_configuration``, or
    from ``prism`` unless it is None. ``identical``, whether the discs are that, ``hops``, ``walls``
    and ``rest``, whether the hits of all walls need a counter, are True or None: what is None is
    not compiled. Nor are ``octaves``, if they are not an array for ``sort_into_octaves``.
    """
    rows, initial_states = new_rows(lanes, law), np.zeros((COMPONENTS, replicas))
    remaining, times, codes = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    packed, more = np.zeros(lanes), np.zeros(lanes)
    counts, replica_counts = np.zeros((N, lanes), np.int64), np.zeros(N, np.int64)
    sums, products = np.zeros(N, np.int64), np.zeros((N, N), np.int64)
    busy = np.zeros(lanes, np.bool_)
    block, used, running, looks = first, replicas, 0, 0
    tracked = hops, walls, rest, True

    while True:
        for i in range(lanes):
            if remaining[i] > 0.0:
                continue
            if busy[i]:
                unpack(packed, more, counts, i)
                for e in range(N):
                    replica_counts[e] = counts[e, i]
                    counts[e, i] = 0
                replica_counts[ANY_WALLS] = all_walls(replica_counts, rest)
                sort_into_octaves(replica_counts, octaves)
                for e in range(N):
                    sums[e] += replica_counts[e]
                    for f in range(e, N):
                        products[e, f] += replica_counts[e] * replica_counts[f]
                busy[i] = False
                running -= 1
            if used == replicas and block < stop:
                draw_any_starts(open_stream(seed, block), draw, sides, initial_states, prism)
                block, used = block + 1, 0
            if used < replicas:
                put_state(rows, i, initial_states[:, used], law)
                remaining[i] = duration
                busy[i] = True
                running += 1
                used += 1
        if running == 0:
            return sums, products

        for _ in range(PASSES):
            find_events(rows, remaining, times, codes, law)
            for i in range(lanes):
                # Everything is loaded before anything is stored.
                before, code, first_count = state_at(rows, i, law), codes[i], packed[i]
                second_count = more[i] if N > FIELDS else 0.0
                remaining[i] -= times[i]
                after = after_event(before, times[i], code, law)
                put_state(rows, i, after, law)
                packed[i] = first_word(
                    first_count, code, before, after, identical, law.gravity, tracked
                )
                if N > FIELDS:
                    more[i] = second_word(
                        second_count, code, before, after, identical, law.gravity, tracked
                    )
        looks += 1
        if looks == LOOKS:
            looks = 0
            for i in range(lanes):
                unpack(packed, more, counts, i)


def simulated_events(sums):
    """Return how many wall hits and disc collisions there are among the counts of all events."""
    return int(sums[COLLISIONS] + sums[ANY_WALLS])


def expected_rate(scene, event):
    """Return how often per time all that counts as ``event`` happens, exactly if that is known.

    Of more than two discs it may be an estimate; 0 where nothing is known of it.
    """
    if scene.discs > 2:
        from twodiscs.dynamics import many

        return many.expected_rates(scene).get(event, 0.0)
    return exact.rate(scene, event) * scene.multiplicity(event)


def expected_event_rate(scene):
    """Return the wall hits and disc collisions per unit of time, as ``expected_rate``."""
    if scene.discs > 2:
        from twodiscs.dynamics import many

        return many.expected_event_rate(scene)
    return exact.event_rate(scene)


def replica_duration(scene):
    """Return the time T of one replica, a power of two: some ``EVENTS_PER_REPLICA`` events.

    That is long enough for drawing a start to cost little. Where an open hop happens less than
    ``HOPS_PER_REPLICA`` times in it, the discs keep their sides for long, and counts remember them:
    then more and shorter replicas know the mean better for the same work.
    """
    if check_scene(scene).discs > 2:
        from twodiscs.dynamics import many  # a kernel that others have no use for

        return many.duration_of(scene.gas)
    rate = exact.event_rate(scene) * exact.work_per_event(scene)
    duration = nearest_power_of_two(EVENTS_PER_REPLICA / rate)
    times = exact.mean_times(scene)
    if any(scene.is_possible(hop) and HOPS_PER_REPLICA * times[hop] > duration for hop in HOPS):
        return nearest_power_of_two(EVENTS_BETWEEN_RARE_HOPS / rate)
    return duration


def run_blocks(
    scene, events, seed, first, stop, duration, *,
    replicas=REPLICAS, lanes=LANES, sides=(0, 0), octaves=None,
):  # fmt: skip
    """Count ``events`` in the blocks ``first`` … ``stop`` − 1 of the stream ``seed``.

    A block is ``replicas`` starts from the invariant measure, each followed for ``duration``;
    ``sides`` chooses the component (see ``draw_configuration``). Only what ``events`` asks for is
    detected: without a hop among them no crossing is looked for. Returns (sums, products)
    as ``count_blocks`` does. They are integers: two shards add up to the whole. ``octaves``, an
    array, is filled as ``sort_into_octaves`` does. More than two discs have a kernel of their own
    (``many``), which detects everything.
    """
    if scene.discs > 2:
        from twodiscs.dynamics import many

        shape = {"replicas": replicas, "lanes": lanes}
        return many.of_events(*many.run_blocks(scene.gas, seed, first, stop, duration, **shape))
    hops = any(event in HOPS for event in events) or None
    walls = any(event in WALLS for event in events) or None
    # Four pairs of a disc and a wall along each of two axes are all there are.
    complete = scene.identical and not scene.field and scene.walled == ("x", "y")
    rest = None if walls and complete else True
    return count_blocks(
        np.uint64(seed), first, stop, replicas, lanes, duration, law_of(scene), *origins(scene),
        sides, scene.identical or None, hops, walls, rest, octaves,
    )  # fmt: skip


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

        The budget is shared as the errors asked for take events: so the same part of what each of
        them takes is missing where it does not allow for all of them.
        """
        scene, budget = self.scene, max(1, int(self.budget / work_per_event(self.scene)))
        runs = {"all": self._everything(budget)}
        for hop in self._rare:
            runs[hop] = strip.run_of(scene, hop, self.target[hop], budget, self.seed)
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
            octaves = None if scene.moment_of_inertia is None else np.zeros((3, N, OCTAVES), int)
            sums = run_blocks(
                scene, self._events, self.seed, first, stop, duration, octaves=octaves
            )
            return sums if octaves is None else (*sums, octaves)

        planned = max(replicas, default=0.0) / REPLICAS
        block_events = REPLICAS * expected_event_rate(scene) * duration
        return SequentialRun(
            work,
            lambda sums, blocks: relative_errors(*sums[:2], blocks * REPLICAS)[index] / goals,
            lambda sums: max(1, simulated_events(sums[0])),
            block_events,
            budget,
            on_grid(min(planned, budget / block_events) if scene.discs > 2 else planned),
            cost_ratio(scene),
        )

    def point(self, outcomes):
        """Return the dict for a JSON file, given {name: ``Outcome``} of all parts."""
        (sums, products, *octaves), blocks, rounds, excess = outcomes["all"]
        strips = {hop: strip.summary(self.scene, hop, outcomes[hop]) for hop in self._rare}
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


def work_per_event(scene):
    """Return how many times as much an event costs as usual, at most, with the draws of starts.

    A start is drawn by proposals, of which ``strip.PROPOSALS_PER_EVENT`` are in what an event costs
    anyhow.
    """
    return max(exact.work_per_event(scene), _proposals(scene) / strip.PROPOSALS_PER_EVENT)


def cost_ratio(scene):
    """Return the time of an event over that of one of the plain ensemble, starts included."""
    if scene.discs > 2:
        return 1 + PAIR * scene.discs * (scene.discs - 1) / 2
    return 1 + strip.PROPOSAL * _proposals(scene)


def _proposals(scene):
    """Return the proposals of starts for each event, with effects; without, they are few."""
    if scene.discs > 2 or not scene.has_effects:
        return 0.0
    events = exact.event_rate(scene) * replica_duration(scene)
    return 1 / exact.free_fraction(scene) / events


def relative_variance(count):
    """Return the largest variance to expect of a mean ``count`` of a replica, over its square.

    Chance has a variance of less than 2⟨N⟩; discs that keep their motion for long add a part of
    ⟨N⟩². It is infinite where none is expected. Both numbers hold at all radii of the repository's
    boxes without effects, where the second one is up to 0.16: at a hundredth of the height, and
    close to the largest radius.
    """
    return 2 / count + 1 / 6 if count else math.inf
