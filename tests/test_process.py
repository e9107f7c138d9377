"""The state of a user's process before and after calls.

Without these tests a user's process could be another one after a call: it is compared, in threads
too.

This file is also a program: ``python tests/test_process.py`` prints what changed.
"""

import decimal
import doctest
import gc
import inspect
import io
import json
import locale
import logging
import os
import random
import signal
import sys
import tempfile
import threading
import warnings
from concurrent.futures import ThreadPoolExecutor
from contextlib import chdir, contextmanager
from pathlib import Path

import matplotlib
import numba
import numpy as np
import scipy.integrate  # noqa: F401 - SciPy adds filters of warnings when it is imported
from commands import python

import twodiscs as td

EXPECTED = Path(__file__).parents[1] / "paper" / "expected"


def examples(function):
    """Return the examples of the docstring of a ``function`` as one program."""
    found = doctest.DocTestParser().get_examples(inspect.getdoc(function))
    return "".join(one.source for one in found if doctest.SKIP not in one.options)


#: {name: a program}: the examples of all functions, and uses of their results.
PROGRAMS = {n: examples(f) for n in td.__all__ if inspect.isfunction(f := getattr(td, n))} | {
    "load": f"td.load({str(EXPECTED)!r})['errata']",
    "a mistake": "try: td.load('no such folder')\nexcept td.InputError: pass",
    "results": """
md, mc = td.simulate(scene, 0.5, progress=True), td.sample(scene, 1, cores=2, progress=True)
td.mean_times(td.Scene(1.5, 1.0, 0.1, discs=3))
print(md, mc, md.frame(), mc["volume"].u, file=io.StringIO())
""",
}


def _active(handlers):
    """Return the handlers that do anything: many packages add a ``NullHandler`` of their own."""
    return [handler for handler in handlers if not isinstance(handler, logging.NullHandler)]


def look():
    """Return {setting of this process: its value}."""
    names = [None, *logging.root.manager.loggerDict]
    loggers = {str(name): logging.getLogger(name) for name in names}
    return {
        "garbage collector": (gc.isenabled(), gc.get_threshold(), gc.get_freeze_count()),
        "environment": dict(os.environ),
        "rcParams": dict(matplotlib.rcParams),
        "warnings": ([*warnings.filters], warnings.showwarning),
        "loggers": {
            name: (one.level, one.propagate, one.disabled, _active(one.handlers), [*one.filters])
            for name, one in loggers.items()
        },
        "signals": {s: signal.getsignal(s) for s in signal.valid_signals()},
        "random": random.getstate(),
        "numpy": repr(np.random.get_state(legacy=False)),
        "numpy errors": np.geterr(),
        "numba": {n: getattr(numba.config, n) for n in dir(numba.config) if n.isupper()},
        "path": [*sys.path],
        "folder": os.getcwd(),
        "locale": locale.setlocale(locale.LC_ALL),
        "decimal": repr(decimal.getcontext()),
        "hooks": (sys.excepthook, sys.displayhook, threading.excepthook),
        "streams": (sys.stdout, sys.stderr),
        "limits": (sys.getrecursionlimit(), sys.getswitchinterval(), sys.gettrace()),
        "print": np.get_printoptions(),
    }


def changes(before, after):
    """Return what differs between two looks. A logger that is new must have no settings."""
    new = {name: (0, True, False, [], []) for name in after["loggers"]}
    before = before | {"loggers": new | before["loggers"]}
    found = []
    for name, old in before.items():
        one, other = (x if isinstance(x, dict) else {"": x} for x in (old, after[name]))
        differ = [key for key in one | other if one.get(key) != other.get(key)]
        found += [f"{name} {key}: {one.get(key)!r} → {other.get(key)!r}" for key in differ]
    return found


@contextmanager
def entered():
    """Give the list of modules of the package that enter ``warnings.catch_warnings`` meanwhile.

    In threads it may leave its filters for good, before Python 3.14. pandas and SciPy enter it for
    themselves, so the filters are compared in one thread alone.
    """
    modules, enter = [], warnings.catch_warnings.__enter__

    def watched(self):
        caller = sys._getframe(1).f_globals["__name__"]
        if caller.startswith("twodiscs"):
            modules.append(caller)
        return enter(self)

    warnings.catch_warnings.__enter__ = watched
    try:
        yield modules
    finally:
        warnings.catch_warnings.__enter__ = enter


def found_by(program, threads):
    """Return what a program changes, in the main thread or in several threads."""

    def run():
        exec(program, {"td": td, "io": io, "scene": td.Scene(1.5, 1.0, 0.2)})

    before, failed = look(), []
    with entered() as modules:
        if threads == 1:
            run()
        else:
            with ThreadPoolExecutor(threads) as pool:
                several = [pool.submit(run) for _ in range(threads)]
            failed = [error for one in several if (error := one.exception())]
    after = look()
    if threads > 1:
        after["warnings"] = before["warnings"]
    return [*changes(before, after), *map(repr, failed), *modules]


def main():
    """Print {name: changes} of all ``PROGRAMS``, each in the main thread, then in two threads."""
    # Threads take turns often, so that what is not safe in threads shows.
    sys.setswitchinterval(1e-5)
    with tempfile.TemporaryDirectory() as folder, chdir(folder):
        print(json.dumps({n: [found_by(p, k) for k in (1, 2)] for n, p in PROGRAMS.items()}))


def test_a_process_is_left_as_it_was():
    done = python(__file__)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert all(PROGRAMS.values())
    assert {name: changed for name, changed in found.items() if changed != [[], []]} == {}


if __name__ == "__main__":
    main()
