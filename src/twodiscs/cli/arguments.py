"""What the command lines share: arguments that are dicts, and errors that are one sentence."""

import argparse
import ast
import sys


class Parser(argparse.ArgumentParser):
    """An argument parser that answers a mistake with one sentence and exit status 2."""

    def __init__(self, **options):
        super().__init__(allow_abbrev=False, **options)

    def error(self, message):
        fail(message)


def parameters(text, *names, optional=()):
    """Return the dict that ``text`` spells as a Python literal; raise ``ValueError`` otherwise.

    If ``names`` are given, they must be its keys, all of them and no others but the ``optional``.
    """
    try:
        value = ast.literal_eval(text)
    except (ValueError, SyntaxError, TypeError, MemoryError, RecursionError):
        value = None
    if not isinstance(value, dict):
        raise ValueError(f"parameters must be a Python dict of plain values, not {text!r}")
    if names and value.keys() - set(optional) != set(names):
        found = ", ".join(map(str, value)) or "none"
        raise ValueError(f"parameters must be {', '.join(sorted(names))}, not {found}")
    return value


def number(text):
    """Return ``text`` as a float, for ``type=`` of an argument."""
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be a number, not {text!r}") from None


def fail(message):
    """Print ``message`` on one line of standard error and exit with status 2."""
    print(f"error: {' '.join(str(message).split())}", file=sys.stderr)
    raise SystemExit(2)


def run(main):
    """Call ``main()`` and exit with the status that it returns (None means 0).

    A ``ValueError`` or ``OSError`` becomes one sentence on standard error and exit status 2.
    """
    try:
        status = main()
    except OSError as error:
        fail(f"{error.filename}: {error.strerror}" if error.filename else error)
    except ValueError as error:
        fail(error)
    raise SystemExit(status)
