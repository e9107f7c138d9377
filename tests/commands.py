"""Command lines, run in this process."""

import json

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
