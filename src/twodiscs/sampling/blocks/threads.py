"""Work in threads: on a number of cores, and so that Ctrl-C is heard without delay.

Kernels release Python's lock, so threads are enough for all cores. A kernel hears of no signal
while it runs, and when Python's handler strikes in the middle of what numba does before and after,
the KeyboardInterrupt is lost, or a ``SystemError`` takes its place. Signals are for the main thread
alone: it waits, and others call the kernels.
"""

from collections import deque
from itertools import islice
from queue import SimpleQueue
from threading import Thread

from twodiscs.model.checks import check_integer

#: Seconds between two calls of ``waiting`` while a result is waited for.
LOOK = 0.2

#: No more threads than that.
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


def in_threads(work, arguments, cores=1, waiting=None):
    """Yield ``work(*given)`` for each tuple in ``arguments``, in their order, by ``cores`` threads.

    With one of them the calls come one after the other. Only some are begun ahead of what is asked
    for; those that have not begun when this ends, or is interrupted, never are. ``waiting()`` is
    called now and then while a result is waited for.
    """
    from concurrent.futures import Future, wait

    cores = check_integer("cores", cores, 1, MOST_CORES)
    given, calls, begun = iter(arguments), SimpleQueue(), deque()

    def begin(number):
        for some in islice(given, number):
            begun.append(Future())
            calls.put((begun[-1], some))

    try:
        # A call may take a minute. A script that ends does not wait for daemons, as it would for
        # the threads of an executor.
        for _ in range(cores):
            Thread(target=_serve, args=(work, calls), daemon=True).start()
        begin(2 * cores)
        while begun:
            while not wait([begun[0]], LOOK).done:
                if waiting is not None:
                    waiting()
            yield begun.popleft().result()
            begin(1)
    finally:
        for future in begun:
            future.cancel()
        for _ in range(cores):
            calls.put(None)


def in_a_thread(work, *given):
    """Return ``work(*given)``, done by another thread: for a kernel that is called once."""
    (result,) = in_threads(work, [given])
    return result
