"""One trajectory, event by event, for people to look at."""

import math

from twodiscs.dynamics.ensemble import across, nearest_power_of_two
from twodiscs.dynamics.law import (
    DISC,
    END_OF_TIME,
    WALL_X1,
    WALL_X2,
    WALL_Y1,
    WALL_Y2,
    WALL_Z1,
    WALL_Z2,
    WRAP_X,
    WRAP_Y,
    WRAP_Z,
    after_event,
    crosses,
    crossing_time,
    law_of,
    next_event,
)
from twodiscs.model.box import Box
from twodiscs.model.checks import whole
from twodiscs.model.events import HOPS
from twodiscs.model.scene import a_scene
from twodiscs.sampling.starts import states
from twodiscs.theory import exact

#: Wall and disc events that a trajectory lasts at most, on average.
LONGEST_TRAJECTORY = 6000

#: Names of what ends a flight, by code; only disc 1 on the right and on top has a name as an event.
_NAMES = {
    END_OF_TIME: "end",
    WALL_X1: "wall_x1",
    WALL_Y1: "wall_y1",
    WALL_X2: "wall_x2",
    WALL_Y2: "wall_y2",
    DISC: "disc_collision",
    WALL_Z1: "wall_z1",
    WALL_Z2: "wall_z2",
    WRAP_X: "wrap_x",
    WRAP_Y: "wrap_y",
    WRAP_Z: "wrap_z",
}


def _row(time, event, state, scene):
    """Return (time, x1, y1, x2, y2, event, z1, z2), None for z in the plane."""
    return (time, *state[:4], event, *((None, None) if scene.depth is None else state[8:10]))


def follow(scene, state, duration):
    """Yield (time, x1, y1, x2, y2, event, z1, z2) for all that happens within ``duration``.

    ``state`` of the ``Scene`` is as in ``law``; z1 and z2 are None in the plane. Hops are events
    here, reported where they occur in a flight; walls are named by disc and axis, and the places
    after a jump of a periodic separation follow the name of its axis; the first row is the start,
    the last one the end.
    """
    law, time = law_of(scene), 0.0
    yield _row(time, "start", state, scene)
    while True:
        flight, code = next_event(state, duration - time, law)
        after = after_event(state, flight, code, law)
        hops = []
        for name, horizontal in (("vertical_hop", None), ("horizontal_hop", True)):
            before, rising = across(state, horizontal)
            passed = crosses(before, across(after, horizontal)[0])
            if name in scene.events and passed:
                hops.append((crossing_time(before, rising), name))
        for until, name in sorted(hops):
            yield _row(time + until, name, after_event(state, until, END_OF_TIME, law), scene)
        time, state = time + flight, after
        yield _row(time, _NAMES[code], state, scene)
        if code == END_OF_TIME:
            return


def trajectory(scene, seed):
    """Return one trajectory of a ``Scene`` from the invariant measure, as rows of ``follow``.

    It lasts some eight mean times of the rarest hop that is open, but no longer than
    ``LONGEST_TRAJECTORY`` wall and disc events on average. Raises ``InputError`` for anything that
    is not a ``Scene``, and for a seed that is not an integer ≥ 0.
    """
    start = states(a_scene(scene), 1, whole("seed", seed, 0))
    components = 8 + 4 * (scene.depth is not None) + 2 * (scene.moment_of_inertia is not None)
    start = tuple(map(float, start[:components, 0]))
    rate = exact.event_rate(scene) * exact.work_per_event(scene)
    hops = [exact.mean_times(scene)[hop] for hop in HOPS if scene.is_possible(hop)]
    duration = min(8 * max(hops, default=math.inf), LONGEST_TRAJECTORY / rate)
    return list(follow(scene, start, nearest_power_of_two(duration)))


def rows(box, radius, seed):
    """Return the rows of trajectory.csv, as dicts."""
    names = ("time", "x1", "y1", "x2", "y2", "event", "z1", "z2")
    return [dict(zip(names, row, strict=True)) for row in trajectory(box.scene(radius), seed)]


def compile_kernels():
    """Compile what follows a trajectory of a plain scene."""
    trajectory(Box(1.5, 1.0).scene(0.2), 0)
