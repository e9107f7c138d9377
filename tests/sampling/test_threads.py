"""Calls in threads: order, errors and ends.

Without these tests threads could change the order, hide an error or keep a process from ending.
"""

import threading
import time

import pytest
from commands import python

from twodiscs.sampling.threads import map_in_threads


@pytest.mark.parametrize("cores", [1, 4])
def test_results_come_in_order_from_other_threads(cores):
    def work(number):
        time.sleep(0.002 * (number % 3))
        return number, threading.current_thread()

    found = [*map_in_threads(work, ((i,) for i in range(20)), cores)]
    assert [number for number, _ in found] == [*range(20)]
    threads = {thread for _, thread in found}
    assert threading.main_thread() not in threads
    assert len(threads) <= cores


def test_only_some_calls_are_begun_ahead_and_none_after_the_end():
    """Two calls for each core wait at most; when nobody asks on, those that work end alone."""
    begun, asked, go = [], iter(range(100)), threading.Event()

    def work(number):
        begun.append(threading.current_thread())
        return number < 9 or go.wait(60)

    results = map_in_threads(work, ((number,) for number in asked), 2)
    assert [next(results) for _ in range(9)] == [True] * 9
    assert next(asked) == 4 + 8
    results.close()
    go.set()
    for thread in {*begun}:
        thread.join(60)
    assert len(begun) <= 9 + 2


def test_errors_come_out_and_end_the_work():
    begun = []

    def work(number):
        begun.append(number)
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        list(map_in_threads(work, ((i,) for i in range(100))))
    assert len(begun) <= 2


#: A process that ends while a thread of it works, as at Ctrl-C.
ENDING = """
import contextlib, sys, time
from numba.core.compiler_lock import global_compiler_lock
from twodiscs.sampling import jit
from twodiscs.sampling.threads import map_in_threads

def work(seconds, compiling):
    with global_compiler_lock if compiling else contextlib.nullcontext():
        time.sleep(seconds)
        print("done", flush=True)

list(map_in_threads(work, [{call}], waiting=sys.exit))
"""


@pytest.mark.parametrize(("call", "said"), [((3600, False), ""), ((2, True), "done\n")])
def test_a_process_that_ends_waits_for_a_compilation_alone(call, said):
    run = python("-c", ENDING.format(call=call), timeout=60, check=True)
    assert (run.stdout, run.stderr) == (said, "")
