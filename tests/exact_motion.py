"""Motion of two discs in 50 digits, by textbook formulas, for comparison with the event law."""

import math
from itertools import islice, pairwise

from mpmath import mp, mpf

from twodiscs.dynamics.engine import find_engine
from twodiscs.theory.exact import event_rate

WALLS = ("wall_x1", "wall_y1", "wall_x2", "wall_y2")


def path_events(scene, state, duration, seed=0):
    """Yield (time, event, first, second, state) of each row of the engine within ``duration``."""
    for rows in find_engine(scene).paths.path_rows(scene, state, duration, seed):
        yield from rows.events()


def exact_path(scene, state):
    """Yield (time, name) of all events, hops included, for ever.

    ``state`` is (x1, y1, x2, y2, u1, v1, u2, v2); it and the ranges of the centres are doubles,
    taken without rounding. Names are as in ``path_events``. If events have the same time,
    walls come first. Call it under ``mp.workdps``.
    """
    x, v = [mpf(float(q)) for q in state[:4]], [mpf(float(q)) for q in state[4:]]
    limits = [mpf(scene.range_x / 2), mpf(scene.range_y / 2)] * 2
    sigma, now = mpf(scene.contact_distance), mpf(0)
    while True:
        times = {}
        for i, name in enumerate(WALLS):
            if v[i]:
                times[name] = (limits[i] - x[i] if v[i] > 0 else -limits[i] - x[i]) / v[i]
        dx, dy, du, dv = x[0] - x[2], x[1] - x[3], v[0] - v[2], v[1] - v[3]
        a, b, c = du**2 + dv**2, dx * du + dy * dv, dx**2 + dy**2 - sigma**2
        if b < 0 and b**2 > a * c:
            times["disc_collision"] = max((-b - mp.sqrt(b**2 - a * c)) / a, mpf(0))
        name = min(times, key=times.get)
        time = times[name]
        both = ("vertical_hop", dy, dv), ("horizontal_hop", dx, du)
        hops = [(-gap / u, hop) for hop, gap, u in both if (gap < 0) != (gap + u * time < 0)]
        yield from ((now + until, hop) for until, hop in sorted(hops))
        now += time
        x = [q + u * time for q, u in zip(x, v, strict=True)]
        if name == "disc_collision":
            dx, dy = x[0] - x[2], x[1] - x[3]
            exchange = (dx * du + dy * dv) / (dx**2 + dy**2)
            for i, kick in enumerate((-dx, -dy, dx, dy)):
                v[i] += exchange * kick
        else:
            v[WALLS.index(name)] *= -1
        yield now, name


def compare(scene, state, number):
    """Compare ``number`` events with the exact ones; return on how many they agree.

    They must be the same at the same times: none missed, none twice. Errors grow exponentially, and
    the comparison ends where the clocks are a hundredth of the mean time between events apart.
    Events within 1e-10 of it from one another may come in either order.
    """
    unit = 1 / event_rate(scene)
    with mp.workdps(50):
        exact = list(islice(exact_path(scene, state), number))
        found = [row[:2] for row in islice(path_events(scene, state, math.inf), number + 1)][1:]
        ends = [k for k in range(1, number) if exact[k][0] - exact[k - 1][0] > 1e-10 * unit]
        for begin, end in pairwise([0, *ends, number]):
            due, seen = exact[begin:end], found[begin:end]
            if max(abs(t - s) for (t, _), (s, _) in zip(due, seen, strict=True)) > 0.01 * unit:
                return begin
            names = [sorted(name for _, name in path) for path in (due, seen)]
            assert names[0] == names[1], (begin, due, seen)
        return number
