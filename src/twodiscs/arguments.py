"""The base of all command lines: arguments as JSON, and one sentence for each mistake."""

import argparse
import json
import os
import select
import signal
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path

from twodiscs.model.box import Box
from twodiscs.model.checks import InputError, decimal_hint, format_number
from twodiscs.model.effects import EFFECTS


class Parser(argparse.ArgumentParser):
    """An argument parser that prints one sentence for a mistake and exits with status 2.

    It makes the folder of ``--output`` first, so that no work is lost if that is impossible.
    """

    def __init__(self, **options):
        super().__init__(allow_abbrev=False, **options)

    def parse_args(self, *args, **options):
        parsed = super().parse_args(*args, **options)
        outputs = getattr(parsed, "output", None) or []
        for output in outputs if isinstance(outputs, list) else [outputs]:
            Path(output).parent.mkdir(parents=True, exist_ok=True)
        return parsed

    def error(self, message):
        fail(message)


def parameters(text):
    """Return the object in the JSON ``text``, or in the file that it names as @path.

    Raises ``InputError`` for anything else, ``OSError`` for a file that cannot be read.
    """
    if text.startswith("@"):
        text = Path(text[1:]).read_text(encoding="utf-8")
    try:
        value = json.loads(text, parse_constant=_no_number)
    except (ValueError, RecursionError):
        value = None
    if not isinstance(value, dict):
        raise InputError(f"parameters must be a JSON object, not {text[:80]!r}")
    return value


def _no_number(text):
    raise InputError(f"{text} is no number")


def named(texts, what):
    """Return {name: value} from arguments NAME=VALUE; raise ``InputError`` for another form."""
    words = {}
    for text in texts:
        name, mark, value = text.partition("=")
        if not mark or not name or not value:
            raise InputError(f"{what} must be given as NAME=VALUE, not {text!r}")
        words[name] = value
    return words


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


def assignment(text):
    """Return (name, number) of ``text`` such as "vertical_hop=1e-3", for ``type=``."""
    name, mark, value = text.partition("=")
    if not mark:
        raise argparse.ArgumentTypeError(f"must be NAME=NUMBER, not {text!r}")
    return name, number(value)


def add_box(parser, required=True):
    """Add the arguments of a ``Box``: sides, the number of discs and effects."""
    for side in ("width", "height"):
        parser.add_argument(f"--{side}", type=number, required=required, help="a length")
    parser.add_argument(
        "--discs", type=whole_number, default=2, help="their number (2), at most 1024"
    )
    effects = parser.add_argument_group("effects", "absent by default")
    for effect in EFFECTS.values():
        kind = {"type": number} if effect.is_number else {"nargs": "+", "metavar": "AXIS"}
        option = effects.add_argument(_option(effect.name), help=_help(effect), **kind)
        if not effect.is_number:
            option.completer = lambda **_: "xyz"


def _help(effect):
    """Return the meaning of an effect, with its unit, its range and its default."""
    notes = [effect.unit] if effect.unit else []
    ends = (format_number(end, "g") for end in (effect.low, effect.high) if effect.is_number)
    notes += [" to ".join(ends) or "x, y or z"]
    notes += [f"{effect.default} without it"] if effect.default else []
    return f"{effect.meaning} ({'; '.join(notes)})"


def box_of(options):
    """Return the ``Box`` of the arguments of ``add_box``, None without a width."""
    if options.width is None:
        return None
    named = {name: getattr(options, name) for name in EFFECTS if getattr(options, name) is not None}
    if "periodic" in named:
        named["periodic"] = "".join(named["periodic"])
    return Box(options.width, options.height, named, options.discs)


def add_scene(parser):
    """Add the arguments of a ``Scene``: those of its ``Box``, and a radius."""
    add_box(parser)
    parser.add_argument("--radius", type=number, required=True, help="a length")


def scene_of(options):
    """Return the ``Scene`` of the arguments of ``add_scene``."""
    return box_of(options).scene(options.radius)


def box_arguments(box):
    """Return the arguments of a ``Box``, a list of words."""
    return words({"width": box.width, "height": box.height, **box.calls_for})


def words(given):
    """Return arguments, {name: value}, as a list of words for a shell, without quotes."""
    return [text for name, value in given.items() for text in (_option(name), *_texts(value))]


def _texts(value):
    """Return the texts of a value, a list or a dict of values."""
    if isinstance(value, dict):
        return [f"{name}={item!r}" for name, item in value.items()]
    return [*map(str, value)] if isinstance(value, list | tuple) else [str(value)]


def _option(name):
    return f"--{name.replace('_', '-')}"


def fail(message):
    """Print each line of ``message`` on standard error and exit with status 2."""
    for line in str(message).strip().split("\n"):
        print(f"error: {' '.join(line.split())}", file=sys.stderr)
    raise SystemExit(2)


#: The names of the commands that run a build.
BUILDS = {"snakemake", "twodiscs"}


def end_with_workflow():
    """End this process when the workflow that started it ends, for whatever reason.

    The workflow is the nearest Snakemake among the parent processes; without one nothing happens.
    """
    with suppress(OSError, ValueError):  # a process may end before we read its state
        for pid, words in _ancestors():
            if not BUILDS.isdisjoint(os.path.basename(word) for word in words[:4]):
                threading.Thread(target=_end_after, args=(pid,), daemon=True).start()
                return


def _ancestors():
    """Yield (id, words of its command) of all parent processes, the nearest first."""
    if sys.platform != "linux":
        with suppress(ImportError):
            import psutil  # comes with Snakemake; it takes ten times as long as /proc

            yield from ((process.pid, process.cmdline()) for process in psutil.Process().parents())
        return
    pid = os.getppid()
    while pid > 1:
        folder = Path("/proc", str(pid))
        yield pid, (folder / "cmdline").read_text(errors="replace").split("\0")
        pid = int((folder / "stat").read_text(errors="replace").rpartition(")")[2].split()[1])


def _end_after(pid):
    try:
        ended = os.pidfd_open(pid)
    except ProcessLookupError:
        pass
    except (AttributeError, OSError):  # not on Linux, or not allowed
        with suppress(ProcessLookupError):
            while True:
                os.kill(pid, 0)
                time.sleep(0.5)
    else:
        select.select([ended], [], [])
    os.kill(os.getpid(), signal.SIGTERM)


def run(main):
    """Call ``main()`` and exit with the status that it returns (None means 0).

    A user's mistake, an ``InputError`` or a file that cannot be read, becomes one sentence on
    standard error and exit status 2. Any other exception keeps its traceback. Ctrl-C ends the
    process without delay, because Python's handler does not interrupt a running kernel. If the
    reader of the output stops, like ``head``, the rest is discarded without a message.
    """
    end_with_workflow()
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
