"""Ctrl-C, and the stop button of a notebook.

Without these tests Ctrl-C, or the stop button of a notebook, could leave a call running.

Each call would take most of an hour, except starts and a trajectory, which are bounded: minutes.
The answer takes a few tenths of a second, and may not depend on the work that is left.
"""

import signal
import subprocess
import sys
import time

from commands import python

#: The program of a child process: of each call first a small one, for which everything is compiled,
#: then a long one. A call that goes on ends the process after a minute.
CHILD = """
import faulthandler
import twodiscs as td

scene = td.Scene(1.5, 1.0, 0.2)
field = td.Scene(1.5, 1.0, 0.2, field=0.3)
rare = td.Scene(1.5, 1.0, 0.2495)

for call in [{calls}]:
    call(False)
    faulthandler.dump_traceback_later(60, exit=True)
    print("ready", flush=True)
    try:
        call(True)
    except KeyboardInterrupt:
        print("stopped", flush=True)
    faulthandler.cancel_dump_traceback_later()
"""

CALLS = [
    "td.simulate(scene, 1e-7 if large else 0.5, budget=1e13 if large else 1)",
    "td.simulate(field, 1e-7 if large else 0.5, budget=1e13)",
    "td.simulate(scene, 1e-7 if large else 0.5, budget=1e13, cores=2)",
    "td.sample(scene, 1e13 if large else 1)",
    "td.intervals(scene, 'vertical_hop', 1e12 if large else 1)",
    "td.starts(td.Scene(1.5, 1.0, 0.34, field=0.1), 10**7 if large else 1)",
    "td.trajectory(scene, duration=2.5e6 if large else 3)",
    "td.transmission(rare, 'horizontal_hop', 1e9 if large else 1)",
    "td.observe(scene, lambda a, b: a['x1'], [0, 1], 1e9 if large else 1)",
    "td.frames(scene, [1e5 if large else 1], 2e5 if large else 1)",
]


def stop(code, seconds=0.1):
    """Run ``code``, interrupt it some seconds after each "ready"; return its status and output."""
    with subprocess.Popen(
        [sys.executable, "-c", code],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # A parent that runs the tests in the background may ignore the signal.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    ) as child:
        printed = []
        for line in child.stdout:
            printed.append(line)
            if line == "ready\n":
                time.sleep(seconds)
                child.send_signal(signal.SIGINT)
        return child.wait(60), printed, child.stderr.read()


def test_a_call_stops_at_once():
    calls = ", ".join(f"lambda large: {call}" for call in CALLS)
    assert stop(CHILD.format(calls=calls)) == (0, ["ready\n", "stopped\n"] * len(CALLS), "")


def test_a_command_stops_at_once():
    words = "simulate --error 1e-7 --budget 1e13"
    code = (
        "import sys; from twodiscs import cli; print('ready', flush=True); sys.argv[1:] = "
        f"{[*words.split(), '--width', '1.5', '--height', '1', '--radius', '0.2']!r}; cli.main()"
    )
    assert stop(code, 1.0) == (-signal.SIGINT, ["ready\n"], "")


#: Names the kernels that the main thread calls, each by its first call.
WATCHED = """
import threading
from numba.core.dispatcher import Dispatcher

usual = Dispatcher._compile_for_args

def first_call(self, *arguments, **words):
    if threading.current_thread() is threading.main_thread():
        print(self.py_func.__name__)
    return usual(self, *arguments, **words)

Dispatcher._compile_for_args = first_call
import twodiscs as td

td.starts(td.Scene(1.5, 1, 0.2), 1)
td.starts(td.Scene(8, 1, 0.3, discs=8), 1)
dense = td.Scene(1.5, 1, 0.195, discs=8)
td.starts(dense, 1)
td.trajectory(dense, duration=0.01)
td.simulate(td.Scene(1.5, 1, 0.1, discs=8), 1, budget=1)
"""


def test_the_thread_that_hears_signals_calls_no_kernel():
    """A KeyboardInterrupt in what numba does about a call may be lost, or be a SystemError."""
    run = python("-c", WATCHED)
    assert (run.returncode, run.stdout) == (0, ""), run.stderr
