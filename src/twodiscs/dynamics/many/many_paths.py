"""More than two discs: trajectories, event by event or many at a time."""

import numpy as np

from twodiscs.dynamics import ensemble
from twodiscs.dynamics.law import END_OF_TIME, crosses, crossing_time
from twodiscs.dynamics.many import all_pairs, cell_list
from twodiscs.dynamics.many.all_pairs import BESIDE, COLLISIONS, N, many_disc_law, new_kicks
from twodiscs.dynamics.many.many_rates import expected_event_rate, expected_rates, usual_epoch
from twodiscs.model.events import HOPS
from twodiscs.sampling.many.cell_grid import make_grid
from twodiscs.sampling.many.many_initial_states import large_grid

#: Entries of a log before it is read.
ENTRIES = 2**14

#: The wall and disc events of a trajectory, and the most rows, with hops, because rows are long.
LONGEST_TRAJECTORY, MOST_ROWS = 1500, 2**13


def advance_all(scene, states, laps, time, kicks, hops=None):
    """Advance the columns of ``states`` (rows, replicas), see ``Engine``.

    The hops in x are added to ``hops`` (replicas,) unless it is None.
    """
    law, grid = many_disc_law(scene), large_grid(scene)
    if grid is None:
        return all_pairs.advance_states(states, laps, time, law, kicks, hops)
    return cell_list.advance_all(states, laps, time, usual_epoch(scene), law, grid, kicks, hops)


class Followed:
    """One trajectory by the kernel with cells, whose log is read in the order of time.

    ``counted`` names the hops that are logged, maybe those along a ring.
    """

    def __init__(self, scene, counted):
        self.scene, self.law, self.grid = scene, many_disc_law(scene), make_grid(scene)
        self.epoch, self.laps = usual_epoch(scene), np.zeros(scene.discs)
        self.motion = cell_list.new_motion(scene.discs, self.grid, self.law.rough)
        self.log = cell_list.new_log(scene.discs, ENTRIES, 4 if self.law.rough is None else 5)
        self.counts = np.zeros(N, np.int64)
        self.hops = [True if hop in counted else None for hop in ("vertical_hop", "horizontal_hop")]

    def start(self, state, seed, replica=0):
        """Begin a path with a ``state``, a column of numbers, and the kicks of its stream."""
        self.kicks = ensemble.open_block_kicks(new_kicks(self.scene, 1), seed, replica)
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


def unwrap(scene, columns, wraps):
    """Add the rounds that discs have made on a ring, see ``Engine``."""
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


def path_events(scene, state, duration, seed=0):
    """Yield (time, event, first, second, state) of more than two discs.

    ``state`` is a column of ``initial_states.states``; see ``paths.path_events``.
    """
    if large_grid(scene) is not None:
        yield from _logged(scene, np.array(state), duration, seed)
        return
    n, law, time = scene.discs, many_disc_law(scene), 0.0
    kicks = ensemble.open_block_kicks(new_kicks(scene, 1), seed)
    lanes = all_pairs.new_lanes(np.array(state)[:, None], np.full(1, float(duration)), law)
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
        is_kick = ensemble.kick_limit(lanes.remaining[0], 0, kicks) < lanes.remaining[0]
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
    """Yield ``path_events`` from the log of a path; a state is put together from all discs."""
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
