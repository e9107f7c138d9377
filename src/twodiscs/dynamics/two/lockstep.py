"""Counts of events of two discs in a fixed time, in lock step, with and without effects.

The mean count in a time T is rate × T exactly, for every T and without burn-in; the spread between
independent replicas gives its error.
"""

import numpy as np

from twodiscs.dynamics.ensemble import (
    LANES,
    PASSES,
    REPLICAS,
    find_events,
    kick_lanes,
    nearest_power_of_two,
    new_kicks,
    new_rows,
    put_state,
    state_at,
)
from twodiscs.dynamics.kicks import open_kicks
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
from twodiscs.dynamics.two import strip
from twodiscs.model.events import DECLARED, EVENTS, HOPS, WALLS, by_kind
from twodiscs.sampling.jit import compiled, inlined, optional
from twodiscs.sampling.starts import COMPONENTS, draw_any_starts, origins
from twodiscs.sampling.streams import open_stream
from twodiscs.theory import exact

#: Searches for ended lanes between two unpackings of the counts: a packed count must be below 256.
LOOKS = 31

#: The mean number of wall and disc events in a replica, which is smaller if an open hop happens
#: less often in it than ``HOPS_PER_REPLICA``.
EVENTS_PER_REPLICA = 256
HOPS_PER_REPLICA = 4
EVENTS_BETWEEN_RARE_HOPS = 64

# How events are counted --------------------------------------------------------------------------

# Functions that say whether a flight has an event. They take the code of its end, the states before
# and after, ``identical`` (None for discs that differ) and ``gravity`` (None without a field).


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


# A wall event counts the hits of all pairs of a disc and a wall in ``Scene.multiplicity``.


def _wall_seen(event):
    if event.axis == "x":
        return lambda code, a, b, identical, gravity: hit(code, WALL_X1, WALL_X2, identical)
    side = float(event.side)
    return lambda code, a, b, identical, gravity: (
        hit(code, WALL_Y1, WALL_Y2, identical)
        & facing(b[1] if code == WALL_Y1 else b[3], side, gravity)
    )


SEEN = by_kind(
    "dynamics/two/lockstep.py",
    {
        "hop": _hop_seen,
        "collision": lambda event: lambda code, a, b, identical, gravity: code == DISC,
        "wall": _wall_seen,
        # Collisions of the discs count, too; see ``all_walls``.
        "walls": lambda event: lambda code, a, b, identical, gravity: code > END_OF_TIME,
    },
)

#: The entry of ``tracked`` for each kind: hops, walls, the hits of all walls, and collisions, which
#: are always tracked. An entry that is None is not compiled.
TRACKED = {"hop": 0, "wall": 1, "walls": 2, "collision": 3}

N = len(EVENTS)
COLLISIONS, ANY_WALLS = EVENTS.index("disc_collision"), EVENTS.index("any_wall")
BESIDE, ABOVE = EVENTS.index("right_wall"), EVENTS.index("top_wall")

#: A lane counts in a double that holds this many fields of eight bits. A second double takes
#: the events that the first one has no room for.
FIELDS = 6
if N > 2 * FIELDS:
    raise TypeError(f"dynamics/two/lockstep.py has room for {2 * FIELDS} events, not for {N}")


def _and(add, event, unit):
    """Return ``add`` extended by an ``event``: a flight with it adds a ``unit`` to the count."""
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
    """Return a function that adds the ``events`` of a flight to a packed ``count``."""
    add = inlined(lambda count, code, before, after, identical, gravity, tracked: count)
    for field, event in enumerate(events):
        add = _and(add, event, 256.0**field)
    return add


first_word, second_word = _word(EVENTS[:FIELDS]), _word(EVENTS[FIELDS:])


@optional(lambda counts, rest: counts[BESIDE] + counts[ABOVE])
def all_walls(counts, rest):
    """Return the hits of all walls. If both axes count all their hits, it is the sum of these."""
    return counts[ANY_WALLS] - counts[COLLISIONS]


@compiled
def unpack(packed, more, counts, lane):
    """Move the packed counts of a ``lane`` to ``counts`` (n, lanes)."""
    words = np.int64(packed[lane]), np.int64(more[lane])
    packed[lane] = more[lane] = 0.0
    for e in range(N):
        counts[e, lane] += (words[e // FIELDS] >> (8 * (e % FIELDS))) & 255


@compiled
def count_blocks(
    seed, first, stop, replicas, lanes, duration, law, draw, prism, order, identical, hops, walls,
    rest, kicks,
):  # fmt: skip
    """Follow the starts of blocks ``first`` … ``stop`` − 1 for a ``duration`` and add their counts.

    Returns (sums, products): Σ N_e (n) and Σ N_e N_f for e ≤ f (n, n) over all replicas, int64, in
    the order of EVENTS. Starts come from ``draw`` in an ``order`` as in ``draw_configuration``, or
    from ``prism`` unless it is None. ``identical`` discs, ``hops``, ``walls`` and ``rest`` (the
    hits of all walls need a counter) are True or None. ``kicks`` are those of the lanes, None
    without friction. Nothing is compiled for None.
    """
    rows, initial_states = new_rows(lanes, law), np.zeros((COMPONENTS, replicas))
    remaining, times, codes = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    packed, more = np.zeros(lanes), np.zeros(lanes)
    counts, replica_counts = np.zeros((N, lanes), np.int64), np.zeros(N, np.int64)
    sums, products = np.zeros(N, np.int64), np.zeros((N, N), np.int64)
    busy, block, used, running, looks = np.zeros(lanes, np.bool_), first, replicas, 0, 0
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
                for e in range(N):
                    sums[e] += replica_counts[e]
                    for f in range(e, N):
                        products[e, f] += replica_counts[e] * replica_counts[f]
                busy[i] = False
                running -= 1
            if used == replicas and block < stop:
                draw_any_starts(open_stream(seed, block), draw, order, initial_states, prism)
                block, used = block + 1, 0
            if used < replicas:
                put_state(rows, i, initial_states[:, used], law)
                open_kicks(i, seed, (block - 1) * replicas + used, kicks)
                remaining[i] = duration
                busy[i] = True
                running += 1
                used += 1
        if running == 0:
            return sums, products

        for _ in range(PASSES):
            find_events(rows, remaining, times, codes, law, kicks)
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
            kick_lanes(rows, times, law, kicks)
        looks += 1
        if looks == LOOKS:
            looks = 0
            for i in range(lanes):
                unpack(packed, more, counts, i)


def expected_rate(scene, event):
    """Return the exact rate of all events that count as ``event``."""
    return exact.rate(scene, event) * scene.multiplicity(event)


def replica_duration(scene):
    """Return the time T of one replica, a power of two: some ``EVENTS_PER_REPLICA`` events.

    T is so long that the draw of a start costs little. If an open hop happens less than
    ``HOPS_PER_REPLICA`` times in it, the discs keep their sides for long, and counts are
    correlated. More and shorter replicas then give a smaller error for the same work.
    """
    rate = exact.event_rate(scene) * exact.work_per_event(scene)
    duration = nearest_power_of_two(EVENTS_PER_REPLICA / rate)
    times = exact.mean_times(scene)
    if any(scene.is_possible(hop) and HOPS_PER_REPLICA * times[hop] > duration for hop in HOPS):
        return nearest_power_of_two(EVENTS_BETWEEN_RARE_HOPS / rate)
    return duration


def expected_event_rate(scene):
    """Return the exact rate of wall hits and disc collisions."""
    return exact.event_rate(scene)


def block_replicas(scene):
    """Return the number of replicas of a block."""
    return REPLICAS


def run_blocks(
    scene, events, seed, first, stop, duration, *,
    replicas=REPLICAS, lanes=LANES, order=(0, 0),
):  # fmt: skip
    """Count ``events`` in the blocks ``first`` … ``stop`` − 1 of the stream ``seed``.

    A block is ``replicas`` starts from the invariant measure, each followed for ``duration``;
    ``order`` chooses the component (see ``draw_configuration``). Only these ``events`` are
    detected: without a hop among them no crossing is searched. Returns (sums, products) as
    ``count_blocks`` does, integers that shards can add.
    """
    hops = any(event in HOPS for event in events) or None
    walls = any(event in WALLS for event in events) or None
    # If each of two axes has four pairs of a disc and a wall, these are all pairs.
    complete = scene.identical and not scene.field and scene.walled == ("x", "y")
    rest = None if walls and complete else True
    return count_blocks(
        np.uint64(seed), first, stop, replicas, lanes, duration, law_of(scene), *origins(scene),
        order, scene.identical or None, hops, walls, rest, new_kicks(scene, lanes),
    )  # fmt: skip


def planned(needed, affordable):
    """Return the number of planned blocks, the number ``needed``: rare hops have own parts."""
    return needed


def cost_ratio(scene):
    """Return the time of an event, with the draws of starts, over its time in the plain scene."""
    return 1 + strip.PROPOSAL * proposals_per_event(scene)


def proposals_per_event(scene):
    """Return the proposals of initial states for each event; 0 in plain scenes, with few."""
    if scene.is_plain:
        return 0.0
    return 1 / exact.free_fraction(scene) / (exact.event_rate(scene) * replica_duration(scene))


def work_per_event(scene):
    """Return an upper bound on the cost of an event over the usual cost, with the draws of starts.

    A start is drawn by proposals. The usual cost of an event includes ``strip.PROPOSALS_PER_EVENT``
    of them.
    """
    proposals = proposals_per_event(scene) / strip.PROPOSALS_PER_EVENT
    return max(exact.work_per_event(scene), proposals)
