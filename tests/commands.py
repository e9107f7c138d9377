"""Command lines, run in this process, and programs, run in another one."""

import subprocess
import sys

from twodiscs import cli


def command(monkeypatch, *words):
    """Run ``twodiscs`` with some ``words`` in this process and return its exit status."""
    with monkeypatch.context() as patch:
        patch.setattr("sys.argv", ["twodiscs", *map(str, words)])
        try:
            cli.run(cli.main)
        except SystemExit as leave:
            return leave.code or 0


def python(*words, **options):
    """Return the completed process of Python with some ``words``, and what it printed."""
    words = [sys.executable, *map(str, words)]
    return subprocess.run(words, **{"capture_output": True, "text": True} | options)
