"""Counts of events of two discs in a fixed time, in lock step, with and without effects.

The mean count in a time T is rate × T exactly, for every T and without burn-in; the spread between
independent replicas gives its error.
"""

from typing import NamedTuple

import numpy as np

from twodiscs.dynamics.ensemble import LANES, REPLICAS, SWEEPS
from twodiscs.dynamics.law import DISC, END_OF_TIME, WALL_X1, WALL_X2, WALL_Y1, WALL_Y2, crosses
from twodiscs.dynamics.two.follow import follow
from twodiscs.model.events import DECLARED_EVENTS, EVENTS, HOPS, WALLS, by_kind
from twodiscs.sampling.initial_states import start_sampler
from twodiscs.sampling.jit import inlined, optional

#: Sweeps between two unpackings of the counts: a packed count must be below 256.
SWEEPS_PER_UNPACKING = 248

# How events are counted --------------------------------------------------------------------------

# Functions that say whether a flight has an event. They take the code of its end, the states before
# and after, ``identical`` (None for discs that differ) and ``field`` (None without a field).


def _hop_seen(event):
    k = "xy".index(event.axis)
    return lambda code, a, b, identical, field: crosses(a[k] - a[k + 2], b[k] - b[k + 2])


@optional(lambda code, first, second, identical: code == first)
def hit(code, first, second, identical):
    """Say whether disc 1 is on a wall, or any disc if they are ``identical``."""
    return (code == first) | (code == second)


@optional(lambda position, side, field: True)
def facing(position, side, field):
    """Say whether a disc at a ``position`` is at the wall of a ``side``, 1 or -1.

    Without a field the two walls of an axis count as one, and this is True.
    """
    return position * side > 0.0


# A wall event counts the hits of all pairs of a disc and a wall in ``Scene.copies``.


def _wall_seen(event):
    if event.axis == "x":
        return lambda code, a, b, identical, field: hit(code, WALL_X1, WALL_X2, identical)
    side = float(event.side)
    return lambda code, a, b, identical, field: (
        hit(code, WALL_Y1, WALL_Y2, identical)
        & facing(b[1] if code == WALL_Y1 else b[3], side, field)
    )


DETECTORS = by_kind(
    "dynamics/two/event_counts.py",
    {
        "hop": _hop_seen,
        "collision": lambda event: lambda code, a, b, identical, field: code == DISC,
        "wall": _wall_seen,
        # Collisions of the discs also count; see ``all_walls``.
        "walls": lambda event: lambda code, a, b, identical, field: code > END_OF_TIME,
    },
)

#: The entry of ``tracked`` for each kind: hops, walls, the hits of all walls, and collisions, which
#: are always tracked. An entry that is None is not compiled.
KIND_FLAGS = {"hop": 0, "wall": 1, "walls": 2, "collision": 3}

N_EVENTS = len(EVENTS)
DISC_COLLISION, ANY_WALL = EVENTS.index("disc_collision"), EVENTS.index("any_wall")
RIGHT_WALL, TOP_WALL = EVENTS.index("right_wall"), EVENTS.index("top_wall")

#: A lane counts in a double that holds this many fields of eight bits. A second double takes
#: the events that the first one has no room for. If each event had an array of its own, the loop
#: would load and store too many of them: for rough discs it took 193 ms in place of 62 ms.
COUNTS_PER_DOUBLE = 6
if N_EVENTS > 2 * COUNTS_PER_DOUBLE:
    raise TypeError(
        f"dynamics/two/event_counts.py has room for {2 * COUNTS_PER_DOUBLE} events, "
        f"not for {N_EVENTS}"
    )


def _and(add, event, unit):
    """Return ``add`` extended by an ``event``: a flight with it adds a ``unit`` to the count."""
    seen, k = inlined(DETECTORS[event]), KIND_FLAGS[DECLARED_EVENTS[event].kind]

    @optional(lambda count, code, before, after, identical, field, tracked: count)
    def add_one(count, code, before, after, identical, field, tracked):
        return count + (unit if seen(code, before, after, identical, field) else 0.0)

    @inlined
    def add_all(count, code, before, after, identical, field, tracked):
        count = add(count, code, before, after, identical, field, tracked)
        return add_one(count, code, before, after, identical, field, tracked[k])

    return add_all


def _word(events):
    """Return a function that adds the ``events`` of a flight to a packed ``count``."""
    add = inlined(lambda count, code, before, after, identical, field, tracked: count)
    for field, event in enumerate(events):
        add = _and(add, event, 256.0**field)
    return add


first_word, second_word = _word(EVENTS[:COUNTS_PER_DOUBLE]), _word(EVENTS[COUNTS_PER_DOUBLE:])


@optional(lambda counts, rest: counts[RIGHT_WALL] + counts[TOP_WALL])
def all_walls(counts, rest):
    """Return the hits of all walls, from ``counts`` whose entry "any wall" has collisions too.

    If no entry counts all walls (``rest`` is None), it is the sum of the right and the top wall.
    """
    return counts[ANY_WALL] - counts[DISC_COLLISION]


class Counts(NamedTuple):
    """The experiment: how often each event happens in a ``duration``.

    ``tracked`` says which events are detected (see ``KIND_FLAGS``). ``identical`` discs and
    ``field`` are as in ``_wall_seen``. ``sums`` are Σ N_e over all replicas (n, int64), in the
    order of EVENTS, and ``products`` Σ N_e N_f for e ≤ f (n, n).
    """

    duration: float
    tracked: tuple
    identical: bool | None
    field: float | None
    packed: np.ndarray  # (lanes,), the first events
    packed_others: np.ndarray  # (lanes,), the others
    counts: np.ndarray  # (n, lanes), what was unpacked
    of_replica: np.ndarray  # (n,), working memory
    sums: np.ndarray
    products: np.ndarray
    both_ways: bool | None = None

    def begin(self, i, state):
        """Begin with a count that is zero: ``ended`` left it so."""
        return self.duration

    def note(self, i, before, after, code, time, left):
        """Add the events of a flight to the packed counts."""
        first_count, second_count = (
            self.packed[i],
            self.packed_others[i] if N_EVENTS > COUNTS_PER_DOUBLE else 0.0,
        )
        flight = code, before, after, self.identical, self.field, self.tracked
        self.packed[i] = first_word(first_count, *flight)
        if N_EVENTS > COUNTS_PER_DOUBLE:
            self.packed_others[i] = second_word(second_count, *flight)
        return left

    def swept(self, sweeps):
        """Unpack the counts before one of them is full."""
        if sweeps % SWEEPS_PER_UNPACKING == 0:
            for i in range(self.packed.size):
                unpack(self, i)

    def ended(self, i, replica, stretch):
        """Add the counts of a replica and their products."""
        unpack(self, i)
        for e in range(N_EVENTS):
            self.of_replica[e] = self.counts[e, i]
            self.counts[e, i] = 0
        self.of_replica[ANY_WALL] = all_walls(self.of_replica, self.tracked[2])
        for e in range(N_EVENTS):
            self.sums[e] += self.of_replica[e]
            for f in range(e, N_EVENTS):
                self.products[e, f] += self.of_replica[e] * self.of_replica[f]
        return 0.0


@inlined
def unpack(counting, i):
    """Move the packed counts of lane ``i`` of ``Counts`` to its ``counts``."""
    words = np.int64(counting.packed[i]), np.int64(counting.packed_others[i])
    counting.packed[i] = counting.packed_others[i] = 0.0
    for e in range(N_EVENTS):
        counting.counts[e, i] += (
            words[e // COUNTS_PER_DOUBLE] >> (8 * (e % COUNTS_PER_DOUBLE))
        ) & 255


def run_blocks(scene, events, seed, first, stop, duration, *, replicas=REPLICAS, lanes=LANES):
    """Count ``events`` in the blocks ``first`` … ``stop`` − 1 of the stream ``seed``.

    A block is ``replicas`` starts from the invariant measure, each followed for ``duration``. Only
    these ``events`` are detected: without a hop among them no crossing is searched. Returns (sums,
    products) as ``Counts`` does, integers that shards can add.
    """
    hops = any(event in HOPS for event in events) or None
    walls = any(event in WALLS for event in events) or None
    # If each of two axes has four pairs of a disc and a wall, these are all pairs.
    complete = scene.identical and not scene.field and scene.walled == ("x", "y")
    rest = None if walls and complete else True
    counting = Counts(
        duration=float(duration),
        tracked=(hops, walls, rest, True),
        identical=scene.identical or None,
        field=scene.field or None,
        packed=np.zeros(lanes),
        packed_others=np.zeros(lanes),
        counts=np.zeros((N_EVENTS, lanes), np.int64),
        of_replica=np.zeros(N_EVENTS, np.int64),
        sums=np.zeros(N_EVENTS, np.int64),
        products=np.zeros((N_EVENTS, N_EVENTS), np.int64),
    )
    sampler = start_sampler(scene)
    follow(counting, scene, sampler, seed, first, stop, replicas, lanes, SWEEPS)
    return counting.sums, counting.products
