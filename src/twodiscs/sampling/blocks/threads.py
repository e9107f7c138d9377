"""Work in threads: on so many cores as are given, and so that Ctrl-C is heard at once.

Kernels release Python's lock, so threads are enough for all cores. A kernel hears of no signal
while it runs, and when Python's handler strikes in the middle of what numba does afterwards, a
``SystemError`` takes the place of the KeyboardInterrupt. Signals are for the main thread alone: it
waits, and others call the kernels.
"""

from collections import deque
from itertools import islice

from twodiscs.model.checks import whole

#: Seconds between two looks of who waits: so often a watch is told that time goes by.
LOOK = 0.2

#: No more threads than that.
MOST_CORES = 1024


def in_threads(work, arguments, cores=1, waiting=None):
    """Yield ``work(*given)`` for each tuple in ``arguments``, in their order, by so many threads.

    With one of them the calls come one after the other. Only some are begun ahead of what is asked
    for; those that have not begun when this ends, or is interrupted, never are. ``waiting()`` is
    called now and then while a result is waited for.
    """
    from concurrent.futures import ThreadPoolExecutor, wait

    cores = whole("cores", cores, 1, MOST_CORES)
    calls = iter(arguments)
    pool = ThreadPoolExecutor(cores)
    try:
        begun = deque(pool.submit(work, *given) for given in islice(calls, 2 * cores))
        while begun:
            while not wait([begun[0]], LOOK).done:
                if waiting is not None:
                    waiting()
            yield begun.popleft().result()
            begun.extend(pool.submit(work, *given) for given in islice(calls, 1))
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
