"""The base of the command line: arguments, and one sentence for each mistake."""

import argparse
import os
import signal
import sys
from io import TextIOWrapper

from twodiscs.model.box import Box
from twodiscs.model.checks import InputError, decimal_hint, did_you_mean, format_number
from twodiscs.model.effects import EFFECTS


class Parser(argparse.ArgumentParser):
    """An argument parser that prints one sentence for a mistake and exits with status 2."""

    def __init__(self, **options):
        super().__init__(allow_abbrev=False, **options)
        self.words = []

    def add(self, *names, completer=None, **options):
        """Add an argument, whose values a shell completes by ``completer``, if that is given."""
        argument = self.add_argument(*names, **options)
        if completer is not None:
            argument.completer = completer

    def parse_known_args(self, args=None, namespace=None):
        self.words = sys.argv[1:] if args is None else [*args]
        return super().parse_known_args(args, namespace)

    def error(self, message):
        # argparse first looks for missing arguments. The user may have misspelt one of them.
        if "are required" in message:
            names = (word.partition("=")[0] for word in self.words if word.startswith("--"))
            unknown = [name for name in names if name not in self._option_string_actions]
            if unknown:
                message = unrecognized(unknown, [action.dest for action in self._actions])
        fail(message)


def unrecognized(words, names):
    """Return the message about unknown ``words``, with the nearest option of ``names``."""
    hint = did_you_mean(words[0].strip("-").partition("=")[0], names)
    hint = hint.replace("mean ", "mean --").replace("_", "-")
    return f"unrecognized arguments: {' '.join(words)}{hint}"


def number(text):
    """Return ``text`` as a float, for ``type=`` of an argument."""
    try:
        return float(text)
    except ValueError:
        message = f"must be a number, not {text!r}{decimal_hint(text)}"
        raise argparse.ArgumentTypeError(message) from None


def whole_number(text):
    """Return ``text``, such as 12 or 1e7, as an integer, for ``type=`` of an argument."""
    try:
        return int(text)
    except ValueError:
        value = number(text)
    if not value.is_integer():
        raise argparse.ArgumentTypeError(f"must be an integer, not {text!r}")
    return int(value)


def add_scene(parser):
    """Add the arguments of a ``Scene``: sides, a radius, the number of discs and effects."""
    for length in ("width", "height", "radius"):
        parser.add_argument(f"--{length}", type=number, required=True, help="a length")
    parser.add_argument(
        "--discs", type=whole_number, default=2, help="their number (2), at most 1024"
    )
    effects = parser.add_argument_group("effects", "absent by default")
    for effect in EFFECTS.values():
        kind = {"type": number} if effect.is_number else {"nargs": "+", "metavar": "AXIS"}
        option = effects.add_argument(
            f"--{effect.name.replace('_', '-')}", help=_help(effect), **kind
        )
        if not effect.is_number:
            option.completer = lambda **_: "xyz"


def _help(effect):
    """Return the meaning of an effect, with its unit, its range and its default."""
    notes = [effect.unit] if effect.unit else []
    ends = (format_number(end, "g") for end in (effect.low, effect.high) if effect.is_number)
    notes += [" to ".join(ends) or "x, y or z"]
    notes += [f"{effect.default} without it"] if effect.default else []
    return f"{effect.meaning} ({'; '.join(notes)})"


def scene_of(options):
    """Return the ``Scene`` of the arguments of ``add_scene``."""
    named = {name: getattr(options, name) for name in EFFECTS if getattr(options, name) is not None}
    if "periodic" in named:
        named["periodic"] = "".join(named["periodic"])
    return Box(options.width, options.height, named, options.discs).scene(options.radius)


def fail(message):
    """Print each line of ``message`` on standard error and exit with status 2."""
    for line in str(message).strip().split("\n"):
        print(f"error: {' '.join(line.split())}", file=sys.stderr)
    raise SystemExit(2)


def write(text):
    """Print a result. If standard output has no space, it goes to standard error.

    Raises ``OSError`` in this case.
    """
    try:
        print(text, flush=True)
    except BrokenPipeError:
        raise
    except OSError as error:
        print(text, file=sys.stderr)
        raise OSError(error.errno, error.strerror, "standard output") from None


def _prepare_streams():
    """Make standard output and error take every character; refuse a closed output before work."""
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w")  # noqa: SIM115
    if sys.stdout is None:
        fail("standard output is closed")
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def run(main):
    """Call ``main()`` and exit with the status that it returns (None means 0).

    A user's mistake, an ``InputError`` or a file that cannot be read, becomes one sentence on
    standard error and exit status 2. Any other exception keeps its traceback. Ctrl-C ends the
    process without delay, because Python's handler does not interrupt a running kernel. If the
    reader of the output stops, like ``head``, the rest is discarded without a message.
    """
    _prepare_streams()
    usual = signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        status = main()
        sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        status = 0
    except OSError as error:
        fail(f"{error.filename}: {error.strerror}" if error.filename else error)
    except (InputError, UnicodeDecodeError) as error:
        fail(error)
    finally:
        signal.signal(signal.SIGINT, usual)
    raise SystemExit(status)
