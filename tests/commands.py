"""Command lines, run in this process, and programs, run in another one."""

import json
import subprocess
import sys

from twodiscs.cli import run


def command(monkeypatch, module, *arguments):
    """Run the ``main`` of a ``module`` in this process and return its exit status.

    ``arguments`` are the arguments of the command line; a dict is spelled as JSON.
    """
    words = [json.dumps(a) if isinstance(a, dict) else str(a) for a in arguments]
    with monkeypatch.context() as patch:
        patch.setattr("sys.argv", [module.__name__, *words])
        try:
            run(module.main)
        except SystemExit as leave:
            return leave.code or 0


def python(*words, **options):
    """Return the completed process of Python with some ``words``, and what it printed."""
    words = [sys.executable, *map(str, words)]
    return subprocess.run(words, **{"capture_output": True, "text": True} | options)
