"""Calls of kernels in threads, one after the other or on several cores.

A process works in threads: on several cores, and so that Ctrl-C stops it without delay. Kernels
release Python's lock, so threads can use all cores. Python handles no signal while a kernel runs.
If it handles one while numba prepares or ends a call, the KeyboardInterrupt is lost, or a
``SystemError`` takes its place. Python handles signals in the main thread only. The main thread
therefore waits, and other threads call the kernels.
"""

from collections import deque
from concurrent.futures import Future, wait
from itertools import islice
from queue import SimpleQueue
from threading import Thread

from twodiscs.model.checks import check_integer

#: The largest number of threads.
MOST_CORES = 1024


def _serve(work, calls):
    """Do the ``work`` of each (``Future``, arguments) in the queue ``calls``, until a None."""
    for future, given in iter(calls.get, None):
        if future.set_running_or_notify_cancel():
            try:
                future.set_result(work(*given))
            except BaseException as error:
                future.set_exception(error)
        del future, given  # results may be large, and the next call late


def map_in_threads(work, arguments, cores=1, waiting=None):
    """Yield ``work(*given)`` for each tuple in ``arguments``, in their order, by ``cores`` threads.

    With one core the calls run one after the other. Only a few calls begin before the caller asks
    for their result. When the generator ends or is interrupted, no further call begins.
    ``waiting()`` is called repeatedly during the wait for a result.
    """
    cores = check_integer("cores", cores, 1, MOST_CORES)
    given, calls, begun = iter(arguments), SimpleQueue(), deque()

    def begin(number):
        for some in islice(given, number):
            begun.append(Future())
            calls.put((begun[-1], some))

    try:
        # A call may take a minute. A script that ends does not wait for daemon threads, but would
        # wait for the threads of an executor.
        for _ in range(cores):
            Thread(target=_serve, args=(work, calls), daemon=True).start()
        begin(2 * cores)
        while begun:
            while not wait([begun[0]], 0.2).done:  # seconds between two calls of ``waiting``
                if waiting is not None:
                    waiting()
            yield begun.popleft().result()
            begin(1)
    finally:
        for future in begun:
            future.cancel()
        for _ in range(cores):
            calls.put(None)


def draw_in_calls(work, calls, number, progress, cores=1):
    """Do ``work`` in ``calls``; ``progress``, if given, gets what each returns, and ``number``."""
    for done in map_in_threads(work, calls, cores, lambda: progress and progress(None, number)):
        if progress is not None:
            progress(done, number)


def call_in_thread(work, *given):
    """Return ``work(*given)``, run in another thread: for a kernel that is called once."""
    (result,) = map_in_threads(work, [given])
    return result
