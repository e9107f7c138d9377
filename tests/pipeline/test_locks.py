"""Locks of runs: a signal does not wait for a lock that the code it interrupts holds."""

import subprocess
import sys

SCRIPT = """
import os, signal, threading
from twodiscs.pipeline.results.locks import end_aside

lock, ended = threading.Lock(), threading.Event()

def end(*received):
    with lock:
        ended.set()

signal.signal(signal.SIGTERM, end)
end_aside()
with lock:
    os.kill(os.getpid(), signal.SIGTERM)
    for _ in range(1000):
        pass
print(ended.wait(30))
"""


def test_a_signal_that_comes_while_the_lock_is_held_is_no_dead_end():
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT], capture_output=True, text=True, timeout=60
    )
    assert done.stdout == "True\n", done.stderr
