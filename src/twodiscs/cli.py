"""``twodiscs``: exact numbers, measurements and trajectories for people and scripts."""

import argparse
import csv
import json
import os
import signal
import sys
from functools import partial
from inspect import signature
from io import StringIO, TextIOWrapper
from warnings import simplefilter

import argcomplete
from argcomplete.completers import ChoicesCompleter

import twodiscs
from twodiscs.measure.load import plugin
from twodiscs.model.checks import NAMED_ERRORS, InputError, parse_number
from twodiscs.model.effects import EFFECTS
from twodiscs.model.events import EVENTS
from twodiscs.model.formats import did_you_mean, format_number
from twodiscs.model.scene import Scene

# Arguments, and one sentence for each mistake -----------------------------------------------------


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
    word = words[0].partition("=")[0]
    name = word.strip("-")
    if word.startswith("--") and name.replace("-", "_") in names:
        hint = "; options follow the command"
    else:
        hint = did_you_mean(name, names).replace("mean ", "mean --").replace("_", "-")
    return f"unrecognized arguments: {' '.join(words)}{hint}"


def value(text):
    """Return ``text`` as a number, or unchanged, for ``type=`` of an argument; the face checks."""
    if not text.isascii() or "_" in text:  # Python has numbers in all digits, and 1_000
        return text
    try:
        return parse_number(text)
    except ValueError:
        return text


def add_scene(parser):
    """Add the arguments of a ``Scene``: sides, a radius, the number of discs and effects."""
    for length in ("width", "height", "radius"):
        parser.add_argument(f"--{length}", type=value, required=True, help="in any unit of length")
    parser.add_argument("--discs", type=value, default=2, help="number of discs, 2 to 16384 (2)")
    effects = parser.add_argument_group("effects", "absent by default")
    for effect in EFFECTS.values():
        kind = {"type": value} if effect.is_number else {"nargs": "+", "metavar": "AXIS"}
        name = effect.name.replace("_", "-")
        option = effects.add_argument(f"--{name}", help=_help(effect), **kind)
        if not effect.is_number:
            option.completer = lambda **_: "xyz"


def _help(effect):
    """Return the meaning of an effect, with its unit, its range and its default."""
    notes = [effect.unit] if effect.unit else []
    ends = (format_number(end, "g") for end in (effect.low, effect.high) if effect.is_number)
    notes += [" to ".join(ends) or "x, y or z"]
    notes += [f"{effect.default} without it"] if effect.default else []
    return f"{effect.meaning} ({'; '.join(notes)})"


def parsed_scene(options):
    """Return the ``Scene`` of the arguments of ``add_scene``."""
    named = {name: getattr(options, name) for name in EFFECTS if getattr(options, name) is not None}
    if "periodic" in named:
        named["periodic"] = "".join(named["periodic"])
    return Scene(options.width, options.height, options.radius, discs=options.discs, **named)


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


# The commands -------------------------------------------------------------------------------------


#: The scene of the examples in ``--help``.
EXAMPLE = "--width 1.5 --height 1 --radius 0.2"

#: {option that several commands have: its settings}
SHARED_OPTIONS = {
    "--seed": {"type": value, "default": 1, "help": "seed of the random numbers (1)"},
    "--name": {"help": "name of a scene in a configuration, for the same numbers"},
    "--cores": {"type": value, "default": 1, "help": "number of cores (1)"},
    "--method": {"help": "one of those that twodiscs cost prints (the fastest)"},
    "--shell": {"type": value, "default": 0.02, "help": "relative thickness (0.02)"},
}


def main():
    """Entry point of the command ``twodiscs``."""
    run(_main)


def _main():
    parser = _parser()
    argcomplete.autocomplete(parser, always_complete_options="long")
    options, rest = parser.parse_known_args()
    if options.command == "run" and not any(word.startswith("-") for word in rest):
        options.targets += rest  # argparse does not find targets behind an option
    elif rest:
        places = "command", "work", "configuration", "targets"  # which are no options
        parser.error(unrecognized(rest, [name for name in vars(options) if name not in places]))
    if options.command is None:
        parser.print_help()
        return
    if options.command in ("run", "new"):
        return options.work(options)
    text, table, numbers = options.work(parsed_scene(options), options)
    if options.csv:
        write(table().rstrip("\n"))
    elif options.json:
        write(json.dumps(numbers(), indent=2, allow_nan=False))
    else:
        write(text())


def _parser():
    parser = Parser(
        prog="twodiscs",
        description="Two hard discs in a box: exact times between events, Monte Carlo and molecular"
        " dynamics. Use any unit of length. Mass 1 and a total energy of 1/2 set the speed to 1, so"
        " a time has the same number as a length. Help has default values in brackets.",
        epilog=f"Example: twodiscs exact {EXAMPLE}. More on a command: twodiscs exact --help.",
    )
    version = f"%(prog)s {twodiscs.__version__}"
    parser.add_argument("--version", action="version", version=version)
    commands = parser.add_subparsers(dest="command", title="commands", metavar="COMMAND")

    def command(name, work, text, **options):
        description = f"{text[0].upper()}{text[1:]}."
        command = commands.add_parser(name, help=text, description=description, **options)
        command.set_defaults(work=work)
        return command

    def of_scene(name, work, text):
        command_of_scene = command(name, work, text)
        add_scene(command_of_scene)
        form = command_of_scene.add_mutually_exclusive_group()
        form.add_argument("--json", action="store_true", help="print JSON")
        form.add_argument("--csv", action="store_true", help="print CSV, as the tables of results")
        return command_of_scene.add

    of_scene("exact", _exact, "exact volume, areas and mean times of one scene")
    text = "mean times by molecular dynamics, beside the exact ones"
    add = of_scene("simulate", _measure, text)
    text = f"relative standard error, or {', '.join(NAMED_ERRORS)} (1e-3)"
    add("--error", type=value, help=text, completer=ChoicesCompleter(NAMED_ERRORS))
    add("--duration", type=value, help="the time to simulate, instead of an error")
    add("--budget", type=value, help="largest number of events (about a day)")
    text = f"some of {', '.join(EVENTS)} (all)"
    add("--events", nargs="+", metavar="EVENT", help=text, completer=ChoicesCompleter(EVENTS))
    _add_shared(add, "--method", "--seed", "--name", "--cores")
    text = "volume and areas by Monte Carlo, beside the exact ones"
    add = of_scene("sample", _measure, text)
    add("--samples", type=value, help="number of samples, rounded up to whole blocks (1e7)")
    text = f"relative standard error, or {', '.join(NAMED_ERRORS)}, instead of samples"
    add("--error", type=value, help=text, completer=ChoicesCompleter(NAMED_ERRORS))
    add("--budget", type=value, help="with an error, the largest number of samples (about a day)")
    known = ChoicesCompleter(("volume", *(f"{event}_area" for event in EVENTS)))
    text = "some of volume and <event>_area (all)"
    add("--quantities", nargs="+", metavar="QUANTITY", help=text, completer=known)
    _add_shared(add, "--shell", "--method", "--seed", "--name", "--cores")
    text = "the processor time to reach relative errors, by each method"
    add = of_scene("cost", _cost, text)
    add("--errors", type=value, nargs="+", help="relative errors (1e-2 1e-3 1e-4 1e-5 1e-6)")
    _add_shared(add, "--shell")
    add = of_scene("trajectory", _trajectory, "one trajectory, event by event")
    add("--duration", type=value, help="simulated time (that of some hops of the rarer kind)")
    add("--start", type=value, nargs="+", metavar="X", help="initial state: x1 y1 x2 y2 u1 v1 …")
    _add_shared(add, "--seed", "--name")

    epilog = None
    if sys.argv[1:2] == ["run"]:
        try:
            epilog = f"Targets: {', '.join(_targets())}."
        except InputError as missing:  # the workflow is not installed
            epilog = f"{missing}."
    text = "build a configuration with Snakemake in the current folder, or some of it"
    add = command("run", _run, text, epilog=epilog).add
    yaml = argcomplete.FilesCompleter(("yaml", "yml"))
    add("configuration", help="a YAML file; twodiscs new writes one", completer=yaml)
    text = "name or file of what to build (report)"
    add("targets", nargs="*", default=[], metavar="TARGET", help=text, completer=_targets)
    text = "number of cores (all, or that of SNAKEMAKE_PROFILE)"
    add("--cores", type=value, help=text)
    text = "print a table of the jobs, but run nothing"
    add("-n", "--dry-run", action="store_true", help=text)
    text = "run nothing, but remove the lock that a killed run left in this folder"
    add("--unlock", action="store_true", help=text)
    add("--force", action="store_true", help="replace the build of other scenes in its folder")
    new = command("new", _new, "write a commented configuration")
    new.add("configuration", help="a new file")
    return parser


def _add_shared(add, *options):
    """Add options that several commands have."""
    for option in options:
        add(option, **SHARED_OPTIONS[option])


def _targets(**_):
    """Return the targets that a shell can complete."""
    return _build().TARGETS


def _run(options):
    given = _arguments(options, ("targets", "cores", "dry_run", "unlock", "force"))
    return _build().build(options.configuration, **given)


def _new(options):
    if (new := plugin("new")) is None:
        raise InputError("twodiscs new needs the package twodiscs_paper")
    new(options.configuration)


def _build():
    """Return the module that builds; raise ``InputError`` if only the library is installed."""
    try:
        import snakemake  # noqa: F401
    except ImportError:
        raise InputError(
            "twodiscs run needs Snakemake: pip install '.[workflow]' in the repository"
        ) from None
    if (build := plugin("build")) is None:
        raise InputError("twodiscs run needs the package twodiscs_paper")
    return build


# A command about a scene returns three functions without arguments: of the text that it prints, of
# the text of its CSV table, and of its content in JSON.


def _exact(scene, options):
    from twodiscs.analysis.tables import TheoryTable
    from twodiscs.theory.exact import exact

    numbers = exact(scene)
    return (
        partial(_table, scene, numbers),
        lambda: _csv(TheoryTable.rows(scene, [scene.radius])),
        lambda: numbers,
    )


def _result(scene, options):
    """Return what the function of the face with the name of the command returns."""
    function = getattr(twodiscs, options.command)
    names = signature(function).parameters.keys() & vars(options).keys()
    return function(scene, **_arguments(options, names))


def _arguments(options, names):
    return {name: getattr(options, name) for name in names}


def _measure(scene, options):
    simplefilter("ignore", twodiscs.AccuracyWarning)  # the note has the same sentence
    result = _result(scene, options)
    if result.note and (options.csv or options.json):
        print(result.note, file=sys.stderr)
    by_name = {row.get("event") or row["quantity"]: row for row in result.rows}
    return partial(str, result), partial(_csv, result.rows), lambda: by_name


def _cost(scene, options):
    found = _result(scene, options)
    return partial(str, found), partial(_csv, found.rows), lambda: found.rows


def _trajectory(scene, options):
    path = _result(scene, options)
    heading = f"{scene}; times in time, positions in length"
    return (
        lambda: f"{heading}\n\n{path.to_string(index=False)}",
        partial(path.to_csv, index=False),
        partial(path.to_dict, "records"),
    )


def _csv(rows):
    text = StringIO()
    table = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    table.writeheader()
    table.writerows(rows)
    return text.getvalue()


def _known(value):
    """Return the text of an exact number, which may be None."""
    return "not known" if value is None else repr(value)


def _table(scene, numbers):
    times = {
        event: "impossible" if not scene.is_possible(event) else _known(time)
        for event, time in numbers["mean_times"].items()
    }
    effects = [f"{name.replace('_', ' '):<20}{value}" for name, value in scene.options.items()]
    if effects:
        effects.append(f"{'velocity components':<20}{scene.velocity_components}")
    if scene.conserved:
        effects.append(f"{'total momentum':<20}0 along {', '.join(scene.conserved)}")
    volume, area = scene.unit("volume"), scene.unit("area")
    return "\n".join(
        [
            str(scene).partition(",")[0],
            "",
            *effects,
            f"{'regime':<20}{numbers['regime']}",
            f"{'ergodic components':<20}{_known(numbers['ergodic_components'])}",
            f"{'largest radius':<20}{numbers['largest_radius']!r:<24}length",
            f"{'volume':<20}{_known(numbers['volume']):<24}{volume}",
            "",
            f"{'event':<20}{f'area ({area})':<24}mean time (time)",
            *(
                f"{event:<20}{_known(area):<24}{times[event]}"
                for event, area in numbers["areas"].items()
            ),
        ]
    )


if __name__ == "__main__":
    main()
