"""More than two discs: counts, trajectories and intervals, their durations and costs.

The kernels are ``all_pairs`` for few discs and ``cell_list`` for ``LARGE`` numbers of them.
"""

import math
from functools import lru_cache

import numpy as np

from twodiscs.dynamics import ensemble
from twodiscs.dynamics.law import END_OF_TIME, crosses, crossing_time
from twodiscs.dynamics.many import all_pairs, cell_list
from twodiscs.dynamics.many.all_pairs import (
    ABOVE,
    BESIDE,
    CLASSES,
    COLLISIONS,
    N,
    law_of,
    new_kicks,
)
from twodiscs.model.checks import InputError
from twodiscs.model.events import HOPS, by_kind
from twodiscs.model.many_geometry import LARGE
from twodiscs.sampling.many import insertions
from twodiscs.sampling.many.cell_grid import grid_of
from twodiscs.sampling.many.chains import DENSEST, crowding
from twodiscs.sampling.many.many_initial_states import (
    draw_states,
    initial_of,
    large_grid,
    method,
    states_of,
)
from twodiscs.sampling.streams import open_stream
from twodiscs.theory import n_discs
from twodiscs.theory.virial import bulk_derivatives, rates

#: Events of a replica, and of a replica whose initial state takes as long as ten thousand events.
REPLICA_EVENTS, EVENTS_OF_CHAIN = 256, 8192

#: Events of each disc in a replica of ``LARGE`` numbers of discs, and the fewest replicas of a
#: block of crowded ones.
EVENTS_OF_DISC, FEWEST = 64, 8

#: The classes whose counts are those of an event, in the order of ``EVENTS``.
CLASSES_OF = by_kind(
    "dynamics/many/engine.py",
    {
        "hop": lambda event: ("vertical_hop" if event.axis == "y" else "horizontal_hop",),
        "collision": lambda event: ("disc_collision",),
        "wall": lambda event: ("right_wall" if event.axis == "x" else "top_wall",),
        "walls": lambda event: ("right_wall", "top_wall"),
    },
)

#: Entries of a log before it is read.
ENTRIES = 2**14

#: Numbers that are summed in each bin of intervals: Σ c, Σ c² and Σ c n.
INTERVAL_SUMS = 3

#: The time that a pair of discs adds to an event, over the time of an event of the plain ensemble.
#: Events of 3, 4 and 8 discs take 3.7, 5.9 and 22 times as long. Pairs of rough discs take longer.
PAIR_COST, ROUGH_PAIR_COST = 0.8, 1.3

#: The same for ``LARGE`` numbers of discs: the time of an event, and the time that each disc adds.
EVENT_COST, DISC_COST = 50.0, 0.25

#: The time of a kick for each of ``LARGE`` numbers of discs, over the time of an event. The time to
#: draw the velocity of a disc, over the time of an event of the plain ensemble.
KICK_COST, DRAW_COST = 0.45, 8.0

#: The largest factor by which the window of ``LARGE`` numbers of discs is longer.
LONGER = 64

#: The wall and disc events of a trajectory, and the most rows, with hops, because rows are long.
LONGEST_TRAJECTORY, MOST_ROWS = 1500, 2**13


# Rates and durations ------------------------------------------------------------------------------


@lru_cache(maxsize=256)
def expected_rates(scene):
    """Return {event: rate} of the events of a ``Scene`` of more than two discs.

    Rates are exact if that is known, and otherwise from some insertions (``insertions.expected``),
    within a few per cent. If insertions find no room, the rates of wall hits and collisions are
    guessed (``duration_of``), and so is one of them for which insertions give 0. For
    ``LARGE`` numbers of discs rates follow from an equation of state, within some ten per cent. It
    ends where discs are ``DENSEST``; there the guess, if it is more, takes its place.
    """
    known = n_discs.known_derivatives(scene)
    if known is None:
        known = insertions.expected(scene) if scene.discs < LARGE else bulk_derivatives(scene)
    guess = dict.fromkeys(("disc_collision", "any_wall"), _guessed_rate(scene) / 2)
    if known is None:
        return guess
    by_class = rates(scene, known)
    summed = {event: sum(by_class[name] for name in parts) for event, parts in CLASSES_OF.items()}
    by_event = guess | {e: rate for e, rate in summed.items() if rate and e in scene.events}
    if scene.discs >= LARGE and crowding(scene) == DENSEST and not n_discs.exact_method(scene):
        by_event |= {event: max(rate, by_event[event]) for event, rate in guess.items()}
    return by_event


def expected_event_rate(scene):
    """Return the wall hits and collisions per time, as ``expected_rates``."""
    expected = expected_rates(scene)
    return expected["any_wall"] + expected["disc_collision"]


def duration_of(scene, events=None):
    """Return a power of two in which about ``events`` happen, within a factor of two.

    The rate is guessed from the wall hits of an ideal gas and from the distance to the largest
    radius. By default ``events`` is 256, or ``EVENTS_OF_CHAIN`` if an initial state takes a chain
    of moves. ``LARGE`` numbers of discs have ``EVENTS_OF_DISC`` each, more if replicas are fewer.
    """
    if events is None and scene.discs >= LARGE:
        events = EVENTS_OF_DISC * scene.discs * _roomy_replicas(scene) // block_replicas(scene)
    events = events or (EVENTS_OF_CHAIN if method(scene) == "chain" else REPLICA_EVENTS)
    return ensemble.nearest_power_of_two(events / _guessed_rate(scene))


def _guessed_rate(scene):
    room = scene.largest_radius - scene.radius
    return math.sqrt(scene.discs) * (0.5 / scene.range_x + 0.5 / scene.range_y + 0.35 / room)


def replica_duration(scene):
    """Return the time T of one replica, a power of two, see ``duration_of``.

    With friction it is shorter, so that kicks do not add to the work.
    """
    return ensemble.nearest_power_of_two(duration_of(scene) / work_per_event(scene))


def block_replicas(scene):
    """Return the number of replicas of a block.

    ``LARGE`` numbers of discs have fewer replicas. If their initial states take many contacts, they
    have still fewer, which last longer.
    """
    if scene.discs < LARGE:
        return ensemble.REPLICAS
    usual = _roomy_replicas(scene)
    return min(usual, max(FEWEST, usual >> (math.frexp(crowding(scene))[1] - 1)))


def _roomy_replicas(scene):
    return ensemble.REPLICAS >> (scene.discs.bit_length() - 5)


def epoch_of(scene):
    """Return a time in which each disc of a ``Scene`` has some ``EVENTS_OF_DISC`` events."""
    return duration_of(scene, EVENTS_OF_DISC * scene.discs)


# Counts -------------------------------------------------------------------------------------------


def expected_rate(scene, event):
    """Return the rate of all events that count as ``event``; 0 if it is not known."""
    return expected_rates(scene).get(event, 0.0)


def run_blocks(scene, events, seed, first, stop, duration, **shape):
    """Return counts as ``two.event_counts.run_blocks`` does; few discs count hops in any case."""
    hops = any(event in HOPS for event in events)
    counts = run_classes(scene, seed, first, stop, duration, hops=hops, **shape)
    return of_events(*counts)


def run_classes(scene, seed, first, stop, duration, *, replicas=None, lanes=None, hops=True):
    """Count all classes of events of a ``Scene`` in the blocks ``first`` … ``stop`` − 1.

    A block is ``replicas`` states of the invariant measure from the stream ``seed``, each followed
    for ``duration``. Returns (sums, products) as ``count_events`` does: integers, which depend on
    neither lanes nor shards. ``LARGE`` numbers of discs have the kernel ``many.cells``, which
    leaves out hops if ``hops`` is not True.
    """
    replicas, lanes = replicas or block_replicas(scene), lanes or ensemble.LANES
    hops_x = None if scene.periodic or scene.height <= 4 * scene.radius else True
    law, grid, initial = law_of(scene), large_grid(scene), initial_of(scene)
    counts = np.zeros(N, np.int64), np.zeros((N, N), np.int64)
    for block in range(first, stop):
        states = states_of(initial, replicas, seed, block)
        given = states, np.uint64(seed), block * replicas
        kicks = new_kicks(scene, lanes if grid is None else 1)
        if grid is None:
            of_block = all_pairs.count_events(*given, lanes, duration, law, hops_x, kicks)
        else:
            counted = (True, hops_x) if hops else (None, None)
            given += duration, epoch_of(scene), law, grid
            of_block = cell_list.count_events(*given, *counted, kicks)
        counts = tuple(map(np.add, counts, of_block))
    return counts


def of_events(sums, products):
    """Return (sums, products) of ``EVENTS``, given the sums and products of ``CLASSES``.

    In every replica, the hits of all walls are the hits of the two classes of walls together.
    """
    counted = [[name in parts for name in CLASSES] for parts in CLASSES_OF.values()]
    matrix = np.array(counted, np.int64)
    whole = products + np.triu(products, 1).T
    return matrix @ sums, np.triu(matrix @ whole @ matrix.T)


def simulated_events(sums):
    """Return how many wall hits and collisions there are among the counts of all classes."""
    return int(sums[COLLISIONS] + sums[BESIDE] + sums[ABOVE])


# Costs --------------------------------------------------------------------------------------------


def work_per_event(scene):
    """Return the cost of an event over the usual cost, with kicks.

    For few discs a kick costs an event and the draw of all velocities. For ``LARGE`` numbers of
    discs it costs ``KICK_COST`` events for each disc.
    """
    few = scene.discs < LARGE
    kick = 1.0 + DRAW_COST * scene.discs / cost_ratio(scene) if few else KICK_COST * scene.discs
    return 1.0 + kick * scene.friction / expected_event_rate(scene)


def cost_ratio(scene):
    """Return the time of an event over the time of an event of the plain ensemble."""
    if scene.discs >= LARGE:
        return EVENT_COST + DISC_COST * scene.discs
    pair = PAIR_COST if scene.moment_of_inertia is None else ROUGH_PAIR_COST
    return 1 + pair * scene.discs * (scene.discs - 1) / 2


# Trajectories -------------------------------------------------------------------------------------


def advance_all(scene, states, laps, time, kicks, hops=None):
    """Advance the columns of ``states`` (rows, replicas), see ``trajectory.path_of``.

    The hops in x are added to ``hops`` (replicas,) unless it is None.
    """
    law, grid = law_of(scene), large_grid(scene)
    if grid is None:
        return all_pairs.advance_states(states, laps, time, law, kicks, hops)
    return cell_list.advance_all(states, laps, time, epoch_of(scene), law, grid, kicks, hops)


def kicks_of(scene, number, seed, block=0):
    """Return the ``Kicks`` of ``number`` states, see ``trajectory.path_of``."""
    return ensemble.opened(new_kicks(scene, number), seed, block)


class Followed:
    """One trajectory by the kernel with cells, whose log is read in the order of time.

    ``counted`` names the hops that are logged, maybe those along a ring.
    """

    def __init__(self, scene, counted):
        self.scene, self.law, self.grid = scene, law_of(scene), grid_of(scene)
        self.epoch, self.laps = epoch_of(scene), np.zeros(scene.discs)
        self.motion = cell_list.new_motion(scene.discs, self.grid, self.law.rough)
        self.log = cell_list.new_log(scene.discs, ENTRIES, 4 if self.law.rough is None else 5)
        self.counts = np.zeros(N, np.int64)
        self.hops = [True if hop in counted else None for hop in ("vertical_hop", "horizontal_hop")]

    def start(self, state, seed, replica=0):
        """Begin a path with a ``state``, a column of numbers, and the kicks of its stream."""
        self.kicks = kicks_of(self.scene, 1, seed, replica)
        self.log.origin[0] = self.laps[:] = 0.0
        cell_list.start_from(state, 0, self.motion, self.grid, self.law)

    def go_on(self, duration):
        """Yield the log of one stretch after the other, with the order of its entries in time."""
        while duration > 0.0:
            self.log.size[0] = 0
            duration = cell_list.follow_discs(
                duration, self.epoch, self.motion, self.laps, self.grid, self.law, self.counts,
                0, self.kicks, self.log, *self.hops,
            )  # fmt: skip
            yield self.log, np.argsort(self.log.times[: self.log.size[0]], kind="stable")


def new_wraps(scene, number):
    """Return the rounds that ``number`` states have made on a ring, all 0."""
    return np.zeros((scene.discs, number))


def unwrap(scene, columns, wraps):
    """Add the rounds that discs have made on a ring, see ``two.path.unwrap``."""
    for disc, laps in enumerate(wraps, 1):
        columns[f"x{disc}"] += scene.width * laps


def trajectory_rate(scene):
    """Return the rows of a trajectory per time: wall hits, collisions, hops and kicks."""
    known = expected_rates(scene)
    hops = sum(known.get(hop, 0.0) for hop in HOPS)
    return expected_event_rate(scene) + hops + scene.friction


def usual_duration(scene):
    """Return the time of some ``LONGEST_TRAJECTORY`` events, a power of two."""
    times = (LONGEST_TRAJECTORY / expected_event_rate(scene), MOST_ROWS / trajectory_rate(scene))
    return ensemble.nearest_power_of_two(min(times))


def events_of(scene, state, duration, seed=0):
    """Yield (time, event, first, second, state) of more than two discs.

    ``state`` is a column of ``starts.states``; see ``trajectory.events_of``.
    """
    if large_grid(scene) is not None:
        yield from _logged(scene, np.array(state), duration, seed)
        return
    n, law, time, kicks = scene.discs, law_of(scene), 0.0, kicks_of(scene, 1, seed)
    lanes = all_pairs.lanes_of(np.array(state)[:, None], np.full(1, float(duration)), law)
    x, y, u, v, *s = (part for part in lanes[:5] if part is not None)
    ring = law.ring[0] if law.ring else None
    # The distance of centres beyond the cell in which the kernel keeps them.
    beyond = ring * np.round(x / ring) if ring else np.zeros_like(x)
    x -= beyond
    pairs = [(j, i) for i in range(n) for j in range(i)]
    along = ((n, "vertical_hop"), (0, "horizontal_hop"))
    along = [(start, hop) for start, hop in along if hop in scene.events]
    yield time, "start", None, None, np.ravel([x + beyond, y, u, v, *s])
    while True:
        before, speed = np.ravel([x + beyond, y]), np.ravel([u, v, *s])
        is_kick = ensemble.before_kick(lanes.remaining[0], 0, kicks) < lanes.remaining[0]
        all_pairs.find_events(lanes, law, kicks)
        flight, code = float(lanes.times[0]), int(lanes.codes[0])
        all_pairs.advance(lanes, law, True)
        all_pairs.kick_lanes(lanes, law, kicks)
        if ring:
            beyond = ring * np.round(((before + flight * speed[: 2 * n])[:n, None] - x) / ring)
        after, hops = np.ravel([x + beyond, y]), []
        for start, name in along:
            for i, j in pairs:
                a, b = start + i, start + j
                apart = before[a] - before[b]
                if crosses(apart, after[a] - after[b]):
                    hops.append((crossing_time(apart, speed[a] - speed[b]), name, i, j))
        for until, name, i, j in sorted(hops):
            then = before + until * speed[: 2 * n]
            yield time + until, name, i + 1, j + 1, np.concatenate([then, speed])
        time, now = time + flight, np.ravel([x + beyond, y, u, v, *s])
        if code == int(END_OF_TIME) and is_kick:
            yield time, "kick", None, None, now
        elif code == int(END_OF_TIME):
            yield float(duration), "end", None, None, now
            return
        if code > 2 * n:
            i, j = pairs[code - 2 * n - 1]
            yield time, "disc_collision", i + 1, j + 1, now
        elif code > 0:
            disc = (code - 1) // 2 + 1
            yield time, f"wall_{'xy'[(code - 1) % 2]}{disc}", disc, None, now


def _logged(scene, state, duration, seed):
    """Yield ``events_of`` from the log of a path; a state is put together from all discs."""
    path = Followed(scene, scene.events)
    rounds = np.round(state[: scene.discs] / scene.width) if scene.periodic else 0.0
    inside = state.copy()
    inside[: scene.discs] -= rounds * scene.width
    path.start(inside[:, None], seed)
    path.laps[:] = rounds
    # The last known place of each disc, and its time.
    at, since = np.reshape(state, (-1, scene.discs)).copy(), np.zeros(scene.discs)
    names = {all_pairs.VERTICAL: "vertical_hop", all_pairs.HORIZONTAL: "horizontal_hop"}
    names |= {COLLISIONS: "disc_collision", cell_list.KICKS: "kick"}
    yield 0.0, "start", None, None, state
    for log, order in path.go_on(duration):
        for k in order:
            time, kind, (i, j) = float(log.times[k]), int(log.classes[k]), log.discs[k].tolist()
            if kind not in (all_pairs.VERTICAL, all_pairs.HORIZONTAL):
                at[:, i], at[:, j] = log.states[k]
                since[[i, j]] = time
            if kind == cell_list.KICKS and i < scene.discs - 1:
                continue
            first, second = min(i, j) + 1, max(i, j) + 1 if i != j else None
            name = names.get(kind) or f"wall_{'x' if kind == BESIDE else 'y'}{first}"
            first = None if kind == cell_list.KICKS else first
            yield time, name, first, second, _then(at, time - since)
    yield float(duration), "end", None, None, _then(at, duration - since)


def _then(at, lag):
    """Return the state of discs that were ``at`` (4 or 5, N) places ``lag`` (N,) ago."""
    return np.concatenate([np.ravel(at[:2] + at[2:4] * lag), *at[2:]])


# Intervals ----------------------------------------------------------------------------------------


def mean_interval(scene, hop):
    """Return the mean time between two hops of any pair, maybe within a few per cent only."""
    if not (rate := expected_rates(scene).get(hop)):
        raise InputError(
            f"radius {scene.radius!r} is so large for {scene.discs} discs that the time between "
            f"two events {hop} is not known"
        )
    return 1 / rate


def _window(scene, hop):
    """Return a time in which ``RETURNS`` intervals begin, or up to twice as many.

    ``LARGE`` numbers of discs have a longer window, the duration of a replica, but at most
    ``LONGER`` times the usual one. Their initial states take as much time to draw.
    """
    window = 2.0 ** math.ceil(math.log2(ensemble.RETURNS * mean_interval(scene, hop)))
    if scene.discs < LARGE:
        return window
    return min(max(window, replica_duration(scene)), LONGER * window)


def intervals_of_chain(scene, hop):
    """Return the least number of intervals of a chain; its window has up to twice as many."""
    return max(ensemble.RETURNS, int(_window(scene, hop) / mean_interval(scene, hop) / 2))


def events_per_interval(scene, hop):
    """Return the most wall and disc events per interval, with their work."""
    window = _window(scene, hop)
    events = window * expected_event_rate(scene) * work_per_event(scene)
    return events / intervals_of_chain(scene, hop)


def record_intervals(scene, hop, seed, first, stop, chains, bins, sums, going):
    """Add the intervals between hops to ``sums`` and return the times of the chains."""
    window = _window(scene, hop)
    return record_within(window, scene, hop, seed, first, stop, chains, bins, sums, going)


def record_within(window, scene, hop, seed, first, stop, chains, bins, sums, going):
    """Add the intervals that begin within a ``window`` of time, see ``all_pairs``."""
    if large_grid(scene) is None:
        hops_x, kicks = True if hop == "horizontal_hop" else None, new_kicks(scene, ensemble.LANES)
        given = window, law_of(scene), hops_x, bins, sums, going, kicks
        initial, totals = initial_of(scene), []
        for block in range(first, stop):
            states = states_of(initial, chains, seed, block)
            seeds = np.uint64(seed), block * chains
            totals.append(all_pairs.record_intervals(states, *seeds, *given))
        return np.hstack(totals)
    (width, wide), path, initial = bins, Followed(scene, (hop,)), initial_of(scene)
    totals, state = np.zeros((2, (stop - first) * chains)), np.zeros((initial.rows, 1))
    for chain in range(totals.shape[1]):
        if chain % chains == 0:
            stream = open_stream(np.uint64(seed), first + chain // chains)
        draw_states(stream, initial, state)
        path.start(state, seed, first * chains + chain)
        times, step = np.zeros(0), window
        # If there is a hop in the window, also the first one after it ends an interval.
        while step == window or (times.size and times[-1] < window):
            for log, order in path.go_on(step):
                if not going[0]:
                    return totals
                hops = order[log.classes[order] < COLLISIONS]
                times = np.append(times, log.times[hops])
            step = window / ensemble.RETURNS
        intervals = np.diff(times)[times[:-1] < window]
        index = np.minimum((intervals / width).astype(int), wide.size - 1)
        counts = np.bincount(np.append(index, wide[index]), minlength=sums.shape[1])
        totals[:, chain] = intervals.sum(), intervals.size
        sums += counts, counts**2, counts * intervals.size
    return totals
