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


def refused(monkeypatch, capsys, *words):
    """Return the one sentence that ``twodiscs`` prints when it refuses some ``words``."""
    assert command(monkeypatch, *words) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    (sentence,) = printed.err.splitlines()
    assert sentence.startswith("error: ")
    return sentence.removeprefix("error: ")


def python(*words, **options):
    """Return the completed process of Python with some ``words``, and what it printed."""
    usual = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    return subprocess.run([sys.executable, *map(str, words)], **usual | options)
