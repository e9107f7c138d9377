"""Calls with extreme scenes end, in bounded time and memory.

Without these tests a scene could be accepted and then take hours or all memory, though little is
asked for.

Effects are at their ends, radii close to the largest, rings of every aspect. A call runs in a
process of its own, with limits on processor time and memory. The first call may compile, so that
a call that takes too long is tried once more.
"""

import resource

import pytest
from commands import python

#: The most processor time of a call with its imports, in seconds, and the most memory in MB.
SECONDS, MEMORY = 20, 1000

#: {name: (width, height, number of discs, distance to the largest radius over it, effects)}.
SCENES = {
    "plain": (1.5, 1.0, 2, 1e-9, {}),
    "long box": (1e6, 1.0, 2, 0.5, {}),
    "kicked": (1.5, 1.0, 2, 0.5, {"friction": 9e5}),
    "three": (1.5, 1.0, 3, 1e-9, {}),
    "three, ring": (0.7, 1.0, 3, 1e-9, {"periodic": "x"}),
    "three, rough": (1.5, 1.0, 3, 1e-3, {"moment_of_inertia": 1e-3}),
    "19, kicked": (5.0, 4.0, 19, 0.5, {"friction": 2e5}),
    "19, rough ring": (1.0, 20.0, 19, 1e-2, {"periodic": "x", "moment_of_inertia": 1.0}),
    "20": (5.0, 4.0, 20, 1e-9, {}),
    "20, little room": (5.0, 4.0, 20, 1e-2, {}),
    "20, short ring": (0.54, 5.0, 20, 1e-9, {"periodic": "x"}),
    "20, rough": (5.0, 4.0, 20, 1e-9, {"moment_of_inertia": 1e-3}),
    "28": (0.1429, 0.1054, 28, 5e-3, {}),
    "64, kicked ring": (48.0, 1.0, 64, 0.3, {"periodic": "x", "friction": 9e5}),
    "80, short ring": (1.0, 48.0, 80, 0.48, {"periodic": "x"}),
    "256, short ring": (0.55, 60.0, 256, 0.01, {"periodic": "x"}),
    "1023, dense": (40.0, 26.0, 1023, 0.3, {}),
    "1024, short ring": (1.0, 500.0, 1024, 0.3, {"periodic": "x"}),
    "1024, long ring": (1000.0, 1.0, 1024, 1e-9, {"periodic": "x"}),
}

#: Small requests. Ten events or kicks are due in a trajectory and in an average.
CALLS = {
    "starts": "td.starts(scene, 1)",
    "simulate": "td.simulate(scene, budget=1)",
    "observe": "td.observe(scene, lambda start, now: now['x1'], [0, 10 / rate], 1)",
    "trajectory": "td.trajectory(scene, 10 / rate)",
}

#: The process prints its processor time and peak memory itself, in seconds and MB.
CODE = """
import atexit, sys, time
import twodiscs as td
from twodiscs.dynamics.engine import find_engine

@atexit.register
def print_spent():
    with open("/proc/self/status") as status:
        peak = next(int(line.split()[1]) for line in status if line.startswith("VmHWM"))
    print(time.process_time(), peak / 1024)

width, height, discs, distance, effects = {scene!r}
box = td.Box(width, height, discs=discs, **effects)
largest = box.largest_radius
try:
    scene = td.Scene(width, height, largest * (1 - distance), discs=discs, **effects)
    rate = find_engine(scene).paths.trajectory_rate(scene)
    {call}
except td.InputError as error:
    sys.exit(f"refused: {{error}}")
"""


def limit():
    """Let a process end after some time, instead of taking the machine with it."""
    resource.setrlimit(resource.RLIMIT_CPU, (8 * SECONDS, 8 * SECONDS))
    resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))


def spent(scene, call):
    """Return (seconds, MB, exit status, standard error) of a call on a scene, in a process."""
    run = python("-c", CODE.format(scene=scene, call=call), preexec_fn=limit)
    seconds, memory = map(float, run.stdout.split())
    return seconds, memory, run.returncode, run.stderr


@pytest.mark.slow
@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize("scene", SCENES)
def test_it_ends_soon(scene, call):
    """The processor time is that of one process, whatever else runs."""
    given = SCENES[scene], CALLS[call]
    seconds, memory, status, error = spent(*given)
    if seconds > SECONDS:
        seconds, memory, status, error = spent(*given)
    refused = error.startswith("refused: ") and error.count("\n") == 1
    assert status == 0 or refused, error
    assert seconds < SECONDS, (seconds, error)
    assert memory < MEMORY, (memory, error)
