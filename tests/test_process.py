"""The state of a user's process before and after calls.

Without these tests a user's process could be another one after a call: it is compared, in threads
too.

This file is also a program: ``python tests/test_process.py`` prints what changed.
"""

import decimal
import gc
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
from contextlib import contextmanager
from inspect import isfunction
from pathlib import Path

import matplotlib
import numba
import numpy as np
import pytest
import scipy.integrate  # noqa: F401 - SciPy adds filters of warnings when it is imported
from commands import python

import twodiscs as td

SCENE = {"width": 1.5, "height": 1.0, "radius": 0.2}

EXPECTED = Path(__file__).parents[1] / "paper" / "expected"

#: {name: a call of a public function, with a scene, and a use of its result}
CALLS = {
    "a mistake": lambda s: _refused(),
    "animate": lambda s: td.animate(td.trajectory(s, 0.1), _file("gif")),
    "areas": lambda s: td.areas(s),
    "cost": lambda s: _used(td.cost(s, 1e-3)),
    "diffusion": lambda s: td.diffusion(td.Scene(**SCENE, periodic="x"), [0.1], 8),
    "exact": lambda s: td.exact(s),
    "exact_table": lambda s: td.exact_table(1.5, 1.0, [0.2]),
    "free_energy": lambda s: td.free_energy(s),
    "intervals": lambda s: td.intervals(s, "vertical_hop", 100).frame(),
    "load": lambda s: td.load(EXPECTED)["errata"],
    "load_result": lambda s: td.load_result(_saved(td.sample(s, 1))).more(2),
    "mean_times": lambda s: td.mean_times(s),
    "frames": lambda s: td.frames(s, [0.1], 8)["x"],
    "observe": lambda s: td.observe(s, lambda _, now: now["u1"] ** 2, [0.1], 8).frame(),
    "plot": lambda s: td.plot(td.trajectory(s, 2), _file("pdf")),
    "pressure": lambda s: td.pressure(s),
    "rate": lambda s: td.rate(s, "vertical_hop"),
    "sample": lambda s: td.sample(s, 1, cores=2, progress=True)["volume"].u,
    "scan": lambda s: td.scan(1.5, 1.0, [0.2], 0.5, cores=2).frame(),
    "simulate": lambda s: td.simulate(s, 0.5, progress=True).frame(),
    "starts": lambda s: td.starts(s, 2),
    "trajectory": lambda s: td.trajectory(s, 2).positions([1.0]),
    "transmission": lambda s: td.transmission(s, "vertical_hop", 1).frame(),
    "volume": lambda s: td.volume(s),
}


def _used(cost):
    return str(cost), cost.frame(), cost.prices[0].seconds(0.1)


def _refused():
    with pytest.raises(td.InputError):
        td.load("no such folder")


def _file(kind):
    return tempfile.mkstemp(suffix=f".{kind}")[1]


def _saved(result):
    path = _file("json")
    result.save(path)
    return path


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


def found_by(call, scene, threads):
    """Return what a call changes, in the main thread or in several threads."""
    before, failed = look(), []
    with entered() as modules:
        if threads == 1:
            call(scene)
        else:
            several = [threading.Thread(target=call, args=(scene,)) for _ in range(threads)]
            usual, threading.excepthook = threading.excepthook, failed.append
            for one in several:
                one.start()
            for one in several:
                one.join()
            threading.excepthook = usual
    after = look()
    if threads > 1:
        after["warnings"] = before["warnings"]
    return [*changes(before, after), *map(repr, failed), *modules]


def main():
    """Print {name: changes} of all ``CALLS``, each in the main thread, then in two threads."""
    scene = td.Scene(**SCENE)
    # Threads take turns often, so that what is not safe in threads shows.
    sys.setswitchinterval(1e-5)
    print(json.dumps({n: [found_by(c, scene, k) for k in (1, 2)] for n, c in CALLS.items()}))


def test_a_process_is_left_as_it_was():
    done = python(__file__)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert {*found} > {name for name in td.__all__ if isfunction(getattr(td, name))}
    assert {name: changed for name, changed in found.items() if changed != [[], []]} == {}


if __name__ == "__main__":
    main()
