"""``twodiscs run``: Snakemake's own command line, and the last lines of a build.

The Snakefile imports this, so it must be quick.
"""

import os
import shlex
import shutil
import signal
import sys
from contextlib import suppress
from datetime import datetime
from difflib import get_close_matches
from importlib import metadata
from pathlib import Path

import twodiscs
from twodiscs.figures.catalogue import FIGURES
from twodiscs.model.checks import InputError, check_integer
from twodiscs_paper.catalogue import STUDIES
from twodiscs_paper.configuration.load import ConfigError, check_results, load, read

#: Targets by name, beside the figures and the studies.
TARGETS = (
    "all", "check", "paper", "report", "animation", "manifest", "provenance", "audit", "verify",
    "explorer", "forecast", "benchmark", *FIGURES, *STUDIES,
)  # fmt: skip

#: Bytes: if the disk has less space, a build may have failed for that reason.
SPACE = 10**8

#: The path of the workflow of a wheel, below the folder of the installation.
SHARED = "share/twodiscs/Snakefile"

#: The target of a command without one: check, tables, figures and the report on them.
DEFAULT = "report"


def snakefile():
    """Return the Snakefile of this package: in its checkout, or in the files of its wheel."""
    checkout = Path(twodiscs.__file__).parents[2] / "Snakefile"
    if checkout.is_file():
        return checkout
    try:
        files = metadata.files("twodiscs") or ()
    except metadata.PackageNotFoundError:
        files = ()
    for file in files:
        if file.as_posix().endswith(SHARED):
            return Path(file.locate()).resolve()
    raise InputError("the workflow is not installed: twodiscs comes without its Snakefile here")


def command(path, targets, snakefile, cores=None, dry_run=False):
    """Return the words of the command that builds ``targets`` of the configuration at ``path``.

    Without ``targets`` it builds the report. The command uses ``cores`` cores, or all. With
    ``dry_run`` it counts the jobs and does nothing.
    Raises ``InputError`` for a target that is neither a name nor a path, and for ``cores`` that are
    no integer ≥ 1.
    """
    cores = "all" if cores is None else check_integer("cores", cores, 1)
    for target in targets:
        if target not in TARGETS and "/" not in target:
            near = get_close_matches(target, TARGETS, n=1)
            hint = f"; did you mean {near[0]!r}?" if near else ""
            raise InputError(
                f"a target must be one of {', '.join(TARGETS)}, or the path of a file of results, "
                f"not {target!r}{hint}"
            )
    here, found = Path("Snakefile"), []
    if not (here.exists() and here.samefile(snakefile)):
        # Snakemake would first look for a profile in this folder.
        profile = snakefile.with_name("profiles") / "default"
        found = ["--snakefile", str(snakefile), "--workflow-profile", str(profile)]
    words = ["snakemake", *found, "--cores", str(cores), "--no-hooks"]
    words += [*(["--dry-run"] if dry_run else []), "--configfile", str(path)]
    return [*words, "--", *(targets or [DEFAULT])]


def report_of(words):
    """Return the path of Snakemake's own report after the command ``words``, or None without it.

    The report is about all built files, so only a build of all targets of the configuration has
    one. Configuration files are read here as the Snakefile reads them.
    """
    from snakemake.cli import get_argument_parser

    name, *arguments = words
    if Path(name).name not in ("snakemake", "__main__.py"):  # Snakemake as a library
        return None
    given, _ = get_argument_parser().parse_known_args(arguments)
    if given.dryrun or given.touch or not {*given.targets} <= {"all"}:
        return None
    if given.default_storage_provider:  # then there is no folder of results to write it to
        return None
    results = "results"
    for path in ("config/config.yaml", *(given.configfile or ())):
        with suppress(ConfigError):
            results = read(path).get("results", results)
    return f"{results}/report-workflow.html"


def check_targets(path, targets, configuration):
    """Raise ``InputError`` for a target without anything to build in a ``Configuration``."""
    figures = [name for scene in configuration.scenes for name in configuration.figures(scene.name)]
    for target in targets:
        about_plain = (
            target == "paper"
            or (target in STUDIES and STUDIES[target].about_plain)
            or (target in FIGURES and not FIGURES[target].needs)
        )
        if about_plain and configuration.main is None:
            raise InputError(f"{target} is about a scene without effects, and {path} has none")
        if target in FIGURES and target not in figures:
            raise InputError(
                f"{target} cannot be drawn: no scene of {path} has its quantities in `watch`"
            )


def build(path, targets, cores=None, dry_run=False):
    """Run ``command`` with these arguments in Snakemake; return its exit status."""
    from snakemake.cli import main as snakemake
    from snakemake_interface_logger_plugins.registry import LoggerPluginRegistry

    from twodiscs_paper.pipeline.jobs import lines

    try:
        configuration = load(read(path))
    except ConfigError as error:
        # Errors of reading name their file already.
        sentences = str(error).split("\n")
        raise InputError(*(s if str(path) in s else f"{path}: {s}" for s in sentences)) from None
    check_results(configuration.results, ".")
    check_targets(path, targets, configuration)
    # The Snakefile prints the verdict only if it had something to do; here it is always printed.
    words = command(path, targets, snakefile(), cores, dry_run)
    print(shlex.join(words), flush=True)

    # Snakemake runs in this process, so a signal ends both. Its profile reads sys.argv.
    def interrupt(*signal_and_frame):
        lines.INTERRUPTED.set()
        raise KeyboardInterrupt

    signal.signal(signal.SIGINT, interrupt)
    sys.argv = [*words]
    if dry_run or not sys.stdout.isatty():
        LoggerPluginRegistry().register_plugin("snakemake_logger_plugin_lines", lines)
        sys.argv[1:1] = ["--logger", "lines"]
    folders = [str(Path(sys.executable).parent), os.environ.get("PATH", os.defpath)]
    os.environ["PATH"] = os.pathsep.join(folders)  # jobs find the same python
    try:
        snakemake()
    except SystemExit as end:
        status = end.code
    if lines.INTERRUPTED.is_set():
        print("Interrupted. The same command goes on from here.")
    elif status == 0 and not dry_run:
        made = dict(files(configuration, targets))
        if not targets or {*targets} - {*made, "forecast", "benchmark"}:
            print(closing(configuration.results), end="")
        for name, paths in made.items():
            print(f"{name}: {', '.join(paths)}")
    return status


def files(configuration, targets):
    """Yield (target, paths) of the figures, studies and the explorer among ``targets``."""
    for name in targets:
        if name == "explorer":
            yield name, [f"{configuration.results}/explorer.html"]
        elif name in STUDIES:
            made = configuration.study(name)
            yield name, [path if isinstance(path, str) else path[0] for path in made]
        elif name in FIGURES:
            drawn = (configuration.figures(scene.name) for scene in configuration.scenes)
            yield name, [figures[name][0] for figures in drawn if name in figures]


def closing(results):
    """Return the verdict of the check in a folder of ``results``, and the path of the report."""
    lines, passed, report = [], Path(results, "check.passed"), Path(results, "report.html")
    if passed.exists():
        when = datetime.fromtimestamp(passed.stat().st_mtime)
        lines += [f"{passed}, of {when:%Y-%m-%d %H:%M}:"]
        lines += [f"  {line}" for line in passed.read_text(encoding="utf-8").splitlines()]
    if report.exists():
        lines += [f"The report is {report.resolve()}"]
    return "".join(f"{line}\n" for line in lines)


def failing(results, targets):
    """Return a sentence if the disk of a failed build is full, else "".

    If the ``targets`` build anything, the verdict on the old results is removed.
    """
    folder = Path(results)
    if not {*targets} & {"audit", "verify"}:
        (folder / "check.passed").unlink(missing_ok=True)
    free = shutil.disk_usage(folder).free if folder.is_dir() else SPACE
    if free >= SPACE:
        return ""
    return f"The disk of {results} has {free / 1e6:.3g} MB left; if it is full, logs are empty\n"
