"""One trajectory of more than two discs, event by event."""

import numpy as np

from twodiscs.dynamics.ensemble import before_kick, nearest_power_of_two
from twodiscs.dynamics.law import END_OF_TIME, crosses, crossing_time
from twodiscs.dynamics.many.cells import KICKS
from twodiscs.dynamics.many.engine import (
    Followed,
    expected_event_rate,
    expected_rates,
    kicks_of,
)
from twodiscs.dynamics.many.engine import advance_all as advance_all
from twodiscs.dynamics.many.lockstep import (
    BESIDE,
    COLLISIONS,
    HORIZONTAL,
    VERTICAL,
    N,
    advance,
    find_events,
    kick_lanes,
    law_of,
)
from twodiscs.model.checks import InputError
from twodiscs.model.events import HOPS
from twodiscs.model.two import ENERGY
from twodiscs.sampling.many.initial import large_grid
from twodiscs.sampling.starts import ROUNDING, given_state

#: The wall and disc events of a trajectory, and the most rows, with hops, because rows are long.
LONGEST_TRAJECTORY, MOST_ROWS = 1500, 2**13


def new_wraps(scene, number):
    """Return the rounds that ``number`` states have made on a ring, all 0."""
    return np.zeros((scene.discs, number))


def unwrap(scene, columns, wraps):
    """Add the rounds that discs have made on a ring, see ``trajectory.path_of``."""
    for disc, laps in enumerate(wraps, 1):
        columns[f"x{disc}"] += scene.width * laps


def trajectory_rate(scene):
    """Return the rows of a trajectory per time: wall hits, collisions, hops and kicks."""
    known = expected_rates(scene)
    hops = sum(known.get(hop, 0.0) for hop in HOPS)
    return expected_event_rate(scene) + hops + scene.friction


def usual_duration(scene):
    """Return the time of some ``LONGEST_TRAJECTORY`` events, a power of two."""
    times = (
        LONGEST_TRAJECTORY / expected_event_rate(scene),
        MOST_ROWS / trajectory_rate(scene),
    )
    return nearest_power_of_two(min(times))


def events_of(scene, state, duration, seed=0):
    """Yield (time, event, first, second, state) of more than two discs.

    ``state`` is a column of ``starts.states``; see ``trajectory.events_of``.
    """
    if large_grid(scene) is not None:
        yield from _logged(scene, np.array(state), duration, seed)
        return
    n, law, time, kicks = scene.discs, law_of(scene), 0.0, kicks_of(scene, 1, seed)
    x, y, u, v, *s = (np.array(part)[:, None] for part in np.reshape(state, (-1, n)))
    spins = s[0] if s else None
    ring = law.ring[0] if law.ring else None
    # The distance of centres beyond the cell in which the kernel keeps them.
    beyond = ring * np.round(x / ring) if ring else np.zeros_like(x)
    x -= beyond
    old_x, old_y, counts = np.zeros_like(x), np.zeros_like(y), np.zeros((N, 1))
    remaining, times, codes, speeds = (np.full(1, float(duration)) for _ in range(4))
    pairs = [(j, i) for i in range(n) for j in range(i)]
    along = ((n, "vertical_hop"), (0, "horizontal_hop"))
    along = [(start, hop) for start, hop in along if hop in scene.events]
    yield time, "start", None, None, np.ravel([x + beyond, y, u, v, *s])
    while True:
        before, speed = np.ravel([x + beyond, y]), np.ravel([u, v, *s])
        is_kick = before_kick(remaining[0], 0, kicks) < remaining[0]
        find_events(x, y, u, v, remaining, times, codes, speeds, law, kicks)
        flight, code = float(times[0]), int(codes[0])
        advance(x, y, u, v, old_x, old_y, remaining, times, codes, counts, law, True, spins)
        kick_lanes(u, v, spins, times, law, kicks)
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
    names = {VERTICAL: "vertical_hop", HORIZONTAL: "horizontal_hop"}
    names |= {COLLISIONS: "disc_collision", KICKS: "kick"}
    yield 0.0, "start", None, None, state
    for log, order in path.go_on(duration):
        for k in order:
            time, kind, (i, j) = float(log.times[k]), int(log.classes[k]), log.discs[k].tolist()
            if kind not in (VERTICAL, HORIZONTAL):
                at[:, i], at[:, j] = log.states[k]
                since[[i, j]] = time
            if kind == KICKS and i < scene.discs - 1:
                continue
            first, second = min(i, j) + 1, max(i, j) + 1 if i != j else None
            name = names.get(kind) or f"wall_{'x' if kind == BESIDE else 'y'}{first}"
            first = None if kind == KICKS else first
            yield time, name, first, second, _then(at, time - since)
    yield float(duration), "end", None, None, _then(at, duration - since)


def _then(at, lag):
    """Return the state of discs that were ``at`` (4 or 5, N) places ``lag`` (N,) ago."""
    return np.concatenate([np.ravel(at[:2] + at[2:4] * lag), *at[2:]])


def state_of(scene, start):
    """Return ``start`` as an array of numbers, see ``trajectory.state_of``."""
    n, state = scene.discs, np.array(given_state(scene, start))
    (x, y), velocities = state[: 2 * n].reshape(2, n), state[2 * n :]
    for axis in scene.walled:
        centres = x if axis == "x" else y
        most = scene.side(axis) / 2 - scene.radius
        if (disc := int(np.argmax(np.abs(centres)))) >= 0 and abs(centres[disc]) > most + (
            ROUNDING * scene.side(axis)
        ):
            raise InputError(
                f"start must have disc {disc + 1} inside the box, with {axis}{disc + 1} between "
                f"{-most!r} and {most!r}, not {float(centres[disc])!r}"
            )
    dx = x[:, None] - x
    if scene.periodic:
        dx -= scene.width * np.round(dx / scene.width)
    apart = np.hypot(dx, y[:, None] - y)[np.triu_indices(n, 1)].min()
    if apart < scene.contact_distance * (1 - ROUNDING):
        raise InputError(
            f"start must have the discs apart, with {scene.contact_distance!r} or more between "
            f"their centres, not {float(apart)!r}"
        )
    weights = np.repeat([1.0, scene.moment_of_inertia or 1.0], [2 * n, velocities.size - 2 * n])
    if abs((energy := float(weights @ velocities**2) / 2) - ENERGY) > ROUNDING:
        raise InputError(f"start must have a total energy of {ENERGY}, not {energy!r}")
    return state
