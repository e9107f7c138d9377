"""More than two discs: trajectories, event by event or many at a time."""

import numpy as np

from twodiscs.dynamics import ensemble
from twodiscs.dynamics import rows as kinds
from twodiscs.dynamics.law import crosses, crossing_time
from twodiscs.dynamics.many import all_pairs, cell_list
from twodiscs.dynamics.many.all_pairs import N_CLASSES, many_disc_law, new_kicks
from twodiscs.dynamics.many.many_rates import expected_event_rate, expected_rates, usual_epoch
from twodiscs.dynamics.rows import new_rows, put_event, start_row
from twodiscs.model.events import HOPS
from twodiscs.sampling.jit import compiled, inlined, optional
from twodiscs.sampling.many.cell_grid import make_grid
from twodiscs.sampling.many.many_initial_states import large_grid

#: Entries of a log before it is read.
LOG_ENTRIES = 2**14

#: The wall and disc events of a trajectory, and the most rows, with hops, because rows are long.
MANY_DISC_PATH_EVENTS, MOST_ROWS = 1500, 2**13


def new_wraps(scene, number):
    """Return no rounds of the discs along x and y, for a ``number`` of states."""
    return np.zeros((2 * scene.discs, number))


def advance_all(scene, states, wraps, time, kicks, hops=None):
    """Advance the columns of ``states`` (rows, replicas), see ``Engine``.

    The hops in x are added to ``hops`` (replicas,) unless it is None.
    """
    law, grid = many_disc_law(scene), large_grid(scene)
    if grid is None:
        return all_pairs.advance_states(states, wraps, time, law, kicks, hops)
    return cell_list.advance_all(states, wraps, time, usual_epoch(scene), law, grid, kicks, hops)


class Followed:
    """One trajectory by the kernel with cells, whose log is read in the order of time.

    ``counted`` names the hops that are logged, maybe those along a ring.
    """

    def __init__(self, scene, counted):
        self.scene, self.law, self.grid = scene, many_disc_law(scene), make_grid(scene)
        self.epoch, self.laps = usual_epoch(scene), np.zeros((2, scene.discs))
        self.motion = cell_list.new_motion(scene.discs, self.grid, self.law.rough)
        self.log = cell_list.new_log(LOG_ENTRIES, self.law.rough)
        self.counts = np.zeros(N_CLASSES, np.int64)
        axes = ("vertical_hop", self.grid.y), ("horizontal_hop", self.grid.x)
        self.bands = [
            cell_list.new_bands(scene.discs, borders, True if hop in counted else None)
            for hop, borders in axes
        ]

    def start(self, state, seed, replica=0):
        """Begin a path with a ``state``, a column of numbers, and the kicks of its stream."""
        self.kicks = ensemble.open_block_kicks(new_kicks(self.scene, 1), seed, replica)
        self.log.origin[0] = self.laps[:] = 0.0
        cell_list.start_from(state, 0, self.motion, self.grid, self.law, *self.bands)
        sizes = [np.diff(bands.first) for bands in self.bands if bands is not None]
        self.log.pending[0] = sum(int((n * (n - 1) // 2).sum()) for n in sizes)

    def go_on(self, duration):
        """Yield the log of one stretch after the other, with the order of its entries in time."""
        while duration > 0.0:
            self.log.size[0] = 0
            entries = LOG_ENTRIES + 2 * (int(self.log.pending[0]) + self.scene.discs)
            if entries > self.log.times.size:
                kept = {"origin": self.log.origin, "pending": self.log.pending}
                self.log = cell_list.new_log(entries, self.law.rough)._replace(**kept)
            duration = cell_list.follow_discs(
                duration, self.epoch, self.motion, self.laps, self.grid, self.law, self.counts,
                0, self.kicks, self.log, *self.bands,
            )  # fmt: skip
            yield self.log, np.argsort(self.log.times[: self.log.size[0]], kind="stable")


def unwrap(scene, columns, wraps):
    """Add the rounds that discs have made along periodic axes, see ``Engine``."""
    for axis in scene.periodic:
        for disc, laps in enumerate(np.split(wraps, 2)["xy".index(axis)], 1):
            columns[f"{axis}{disc}"] += scene.side(axis) * laps


def whole_rounds(scene, state):
    """Return the rounds (2, N) after which a ``state`` is, 0 between walls."""
    rounds = np.zeros((2, scene.discs))
    for axis in scene.periodic:
        k = "xy".index(axis)
        rounds[k] = np.round(state[k * scene.discs : (k + 1) * scene.discs] / scene.side(axis))
    return rounds


def trajectory_rate(scene, hops=True):
    """Return the rows of a trajectory per time: wall hits, collisions, kicks and maybe ``hops``."""
    known = expected_rates(scene)
    rate = sum(known.get(hop, 0.0) for hop in HOPS) if hops else 0.0
    return expected_event_rate(scene) + rate + scene.friction


def usual_duration(scene):
    """Return the time of some ``MANY_DISC_PATH_EVENTS`` events, a power of two."""
    times = (MANY_DISC_PATH_EVENTS / expected_event_rate(scene), MOST_ROWS / trajectory_rate(scene))
    return ensemble.nearest_power_of_two(min(times))


def path_rows(scene, state, duration, seed=0, hops=True):
    """Yield the ``Rows`` of a trajectory of more than two discs, see ``Engine``."""
    follow = _follow_few if large_grid(scene) is None else _follow_large
    yield from follow(scene, np.array(state), float(duration), seed, scene.events if hops else ())


@compiled
def put_states(states, n, at, lags):
    """Set column ``n`` of ``states`` to discs that were ``at`` (4 or 5, N) their ``lags`` ago."""
    discs = lags.size
    for i in range(discs):
        states[i, n] = at[0, i] + at[2, i] * lags[i]
        states[discs + i, n] = at[1, i] + at[3, i] * lags[i]
        for part in range(2, at.shape[0]):
            states[part * discs + i, n] = at[part, i]


# Few discs ----------------------------------------------------------------------------------------


@optional(lambda beyond, i, then, x, ring: None)
def count_turns(beyond, i, then, x, ring):
    """Set how far ``beyond`` its cell, where it is at ``x``, disc ``i`` has come, to ``then``."""
    beyond[i] = ring * np.floor((then - x) / ring + 0.5)


@optional(lambda at, spins: None)
def keep_spins(at, spins):
    """Set the last row of ``at`` to the ``spins`` (N, 1)."""
    for i in range(spins.shape[0]):
        at[4, i] = spins[i, 0]


@inlined
def keep_discs(at, lanes, beyond):
    """Set ``at`` (4 or 5, N) to the discs of the only lane, which are ``beyond`` their cells."""
    for i in range(beyond.shape[1]):
        at[0, i], at[1, i] = lanes.x[i, 0] + beyond[0, i], lanes.y[i, 0] + beyond[1, i]
        at[2, i], at[3, i] = lanes.u[i, 0], lanes.v[i, 0]
    keep_spins(at, lanes.spins)


@compiled
def sort_hops(before, after, velocities, kind, times, hops, count):
    """Add the hops of a flight along one axis to the ``count`` there are; return their number.

    ``times`` are in order, ``hops`` are (kind, disc, disc).
    """
    for i in range(before.size):
        for j in range(i + 1, before.size):
            apart = before[i] - before[j]
            if crosses(apart, after[i] - after[j]):
                until, k = crossing_time(apart, velocities[i] - velocities[j]), count
                while k > 0 and times[k - 1] > until:
                    times[k] = times[k - 1]
                    for part in range(3):
                        hops[k, part] = hops[k - 1, part]
                    k -= 1
                times[k], hops[k, 0], hops[k, 1], hops[k, 2] = until, kind, i + 1, j + 1
                count += 1
    return count


@compiled
def record_rows(lanes, beyond, clock, duration, law, kicks, hops, rows):
    """Fill ``rows`` with the next events of the only lane, whose time is ``clock[0]``.

    Discs are ``beyond`` (2, N) their cells. ``hops`` says whether vertical hops are rows, and
    whether horizontal ones are. Returns the number of rows; the last one is the end if the
    ``duration`` is over.
    """
    discs, n = beyond.shape[1], 0
    most, parts = discs * (discs - 1), rows.states.shape[0] // discs
    old, new, lags = np.empty((parts, discs)), np.empty((parts, discs)), np.empty(discs)
    times, found = np.empty(most), np.empty((most, 3), np.int64)
    while n + most < rows.times.size and (n == 0 or rows.kinds[n - 1] != kinds.END):
        keep_discs(old, lanes, beyond)
        kicked = ensemble.kick_limit(lanes.remaining[0], 0, kicks) < lanes.remaining[0]
        all_pairs.find_events(lanes, law, kicks)
        flight, code = lanes.times[0], np.int64(lanes.codes[0])
        all_pairs.advance(lanes, law, True)
        all_pairs.kick_lanes(lanes, law, kicks)
        for i in range(discs):
            count_turns(beyond[0], i, old[0, i] + flight * old[2, i], lanes.x[i, 0], law.ring_x)
            count_turns(beyond[1], i, old[1, i] + flight * old[3, i], lanes.y[i, 0], law.ring_y)
        keep_discs(new, lanes, beyond)
        count = 0
        if hops[1]:
            count = sort_hops(old[0], new[0], old[2], kinds.HORIZONTAL_HOP, times, found, count)
        if hops[0]:
            count = sort_hops(old[1], new[1], old[3], kinds.VERTICAL_HOP, times, found, count)
        for k in range(count):
            put_event(rows, n, clock[0] + times[k], found[k, 0], found[k, 1], found[k, 2])
            lags[:] = times[k]
            put_states(rows.states, n, old, lags)
            n += 1
        clock[0] += flight
        if code >= 0:
            kind, first, second = kinds.KICK if kicked else kinds.END, 0, 0
            if code > 2 * discs:
                kind, first, second = kinds.COLLISION, code - 2 * discs, 2
                while first >= second:
                    first, second = first - second + 1, second + 1
            elif code > 0:
                first = (code - 1) // 2 + 1
                kind = kinds.WALL + 3 * (first - 1) + (code - 1) % 2
            put_event(rows, n, duration if kind == kinds.END else clock[0], kind, first, second)
            lags[:] = 0.0
            put_states(rows.states, n, new, lags)
            n += 1
    return n


def _follow_few(scene, state, duration, seed, counted):
    law, clock = many_disc_law(scene), np.zeros(1)
    kicks = ensemble.open_block_kicks(new_kicks(scene, 1), seed)
    # The distance of centres beyond the cell in which the kernel keeps them.
    beyond = whole_rounds(scene, state) * np.array([[scene.width], [scene.height]])
    inside, places = state.copy(), slice(2 * scene.discs)
    inside[places] -= beyond.ravel()
    state[places] = inside[places] + beyond.ravel()
    yield start_row(state)
    lanes = all_pairs.new_lanes(inside[:, None], np.full(1, duration), law)
    hops, rows = tuple(hop in counted for hop in HOPS), None
    while rows is None or rows.kinds[-1] != kinds.END:
        rows = new_rows(state.size, scene.discs**2)
        number = record_rows(lanes, beyond, clock, duration, law, kicks, hops, rows)
        rows = rows.first(number)
        yield rows


# Large numbers of discs ---------------------------------------------------------------------------


@compiled
def read_log(log, order, entry, at, since, rows):
    """Fill ``rows`` with the entries of a log from the number ``entry`` of their ``order`` on.

    The discs were last known ``at`` (4 or 5, N) places at the times ``since``. Returns the number
    of the next entry and of rows.
    """
    discs, n, lags = since.size, 0, np.empty(since.size)
    while entry < order.size and n < rows.times.size:
        e = order[entry]
        time, event, i, j = log.times[e], log.classes[e], log.discs[e, 0], log.discs[e, 1]
        entry += 1
        hop = (event == all_pairs.VERTICAL_HOPS) | (event == all_pairs.HORIZONTAL_HOPS)
        if not hop:
            for part in range(at.shape[0]):
                at[part, i], at[part, j] = log.states[e, 0, part], log.states[e, 1, part]
            since[i] = since[j] = time
        first, second = min(i, j) + 1, max(i, j) + 1
        if hop:
            kind = kinds.VERTICAL_HOP if event == all_pairs.VERTICAL_HOPS else kinds.HORIZONTAL_HOP
        elif event == all_pairs.COLLISIONS:
            kind = kinds.COLLISION
        elif event == cell_list.KICK_CLASS:
            if i < discs - 1:
                continue
            kind, first, second = kinds.KICK, 0, 0
        else:
            kind, second = kinds.WALL + 3 * (first - 1) + event - all_pairs.X_WALLS, 0
        put_event(rows, n, time, kind, first, second)
        for k in range(discs):
            lags[k] = time - since[k]
        put_states(rows.states, n, at, lags)
        n += 1
    return entry, n


def _follow_large(scene, state, duration, seed, counted):
    yield start_row(state)
    path = Followed(scene, counted)
    rounds, inside = whole_rounds(scene, state), state.copy()
    inside[: 2 * scene.discs] -= (rounds * np.array([[scene.width], [scene.height]])).ravel()
    path.start(inside[:, None], seed)
    path.laps[:] = rounds
    at, since = np.reshape(state, (-1, scene.discs)).copy(), np.zeros(scene.discs)
    for log, order in path.go_on(duration):
        entry = 0
        while entry < order.size:
            rows = new_rows(state.size)
            entry, number = read_log(log, order, entry, at, since, rows)
            yield rows.first(number)
    rows = new_rows(state.size)
    put_states(rows.states, 0, at, duration - since)
    put_event(rows, 0, duration, kinds.END, 0, 0)
    yield rows.first(1)
