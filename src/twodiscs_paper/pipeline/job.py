"""The start of a job: each script of the workflow calls ``start`` after its imports."""

import gc
import os
import signal
import threading
import time

# matplotlib reads this when it is imported, so scripts that draw import this module first. A
# notebook sets it to its own backend, for its child processes too, and jobs may not have that.
os.environ["MPLBACKEND"] = "agg"

# Imported modules stay in memory, so collections during imports are wasted: a twelfth of the start
# of a job. Scripts of short jobs import this module first.
gc.disable()


def start(log):
    """Write what this process prints to the file ``log``, and end it with Snakemake.

    Snakemake ends its jobs, but not if it is killed itself. Ctrl-C ends the process without delay,
    because Python's handler does not interrupt a running kernel.
    """
    file = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o666)
    os.dup2(file, 1)
    os.dup2(file, 2)
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    threading.Thread(target=_end_after, args=(os.getppid(),), daemon=True).start()
    gc.freeze()
    gc.enable()


def _end_after(parent):
    while os.getppid() == parent:
        time.sleep(0.5)
    os.kill(os.getpid(), signal.SIGTERM)
