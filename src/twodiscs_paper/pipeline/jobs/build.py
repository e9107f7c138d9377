"""``twodiscs run`` and ``new``: Snakemake's own command line, and the last lines of a build.

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
from twodiscs_paper.pipeline.configuration.files import Files
from twodiscs_paper.pipeline.configuration.load import check_results, load
from twodiscs_paper.pipeline.configuration.reading import ConfigError, read

#: Targets by name, beside the figures and the studies.
TARGETS = (
    "all", "check", "paper", "report", "animation", "manifest", "provenance", "audit", "verify",
    "explorer", "forecast", "benchmark", "crate", *FIGURES, *STUDIES,
)  # fmt: skip

#: Bytes: if the disk has less space, a build may have failed for that reason.
SPACE = 10**8

#: The path of the workflow of a wheel, below the folder of the installation.
SHARED = "share/twodiscs/Snakefile"

#: The file that ``twodiscs new`` writes: keys with a default are comments.
NEW = """\
# The configuration. config/README.md of the repository has every key, its unit and its default.
# Lengths are in any one unit; masses are one and the total energy is 1/2, so times are lengths
# over a speed of one.

results: results # the folder that everything is built in
# Another seed repeats every simulation independently.
# seed: 1908
# Documents and studies beside the scenes; [paper, report] for the manuscript and all studies.
# shared: [report]

scenes:
  - name: mine # also the name of its folder in results
    box: {width: 1.5, height: 1.0}
    # The relative error of mean times: draft is 1e-2, paper 3e-4, reference 1e-4; or a number.
    accuracy: draft
    monte_carlo: {samples: 1e7}
    # Without radii there is a grid of radii up to the largest that fits.
    # radii: [0.1, 0.2, 0.3]
    # Also mass_ratio, periodic: [x], field, moment_of_inertia; a depth in the box makes balls.
    # effects: {radius_ratio: 0.5}
    # Without watch, all quantities of the scene are computed.
    # watch: {mean_times: true, trajectory: 0.24}
"""


def new(path):
    """Write a commented configuration to ``path``; raise ``InputError`` if there is a file."""
    try:
        with open(path, "x", encoding="utf-8", newline="\n") as file:
            file.write(NEW)
    except FileExistsError:
        raise InputError(f"{path} exists already and is not overwritten") from None
    print(f"{path} is written. To build it: twodiscs run {shlex.quote(str(path))}")


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

    The command uses ``cores`` cores, or all. With ``dry_run`` it lists the jobs and does nothing.
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
    here = Path("Snakefile")
    found = [] if here.exists() and here.samefile(snakefile) else ["--snakefile", str(snakefile)]
    words = ["snakemake", *found, "--cores", str(cores), "--no-hooks"]
    words += [*(["--dry-run"] if dry_run else []), "--configfile", str(path)]
    return [*words, "--", *targets] if targets else words


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
    results = "results"
    for path in ("config/config.yaml", *(given.configfile or ())):
        with suppress(ConfigError):
            results = read(path).get("results", results)
    return f"{results}/report-workflow.html"


def check_targets(path, targets, configuration):
    """Raise ``InputError`` for a target without anything to build in a ``Configuration``."""
    files = Files(configuration, {scene.name: scene for scene in configuration.scenes})
    for target in targets:
        about_plain = target == "paper" or (target in STUDIES and STUDIES[target].about_plain)
        if about_plain and configuration.main is None:
            raise InputError(f"{target} is about a scene without effects, and {path} has none")
        if target in FIGURES and not any(target in files.figures(name) for name in files.scenes):
            raise InputError(f"{target} cannot be drawn: no scene of {path} has its quantities")


def build(path, targets, cores=None, dry_run=False):
    """Run ``command`` with these arguments in Snakemake; return its exit status."""
    from snakemake.cli import main as snakemake

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
    signal.signal(signal.SIGINT, signal.default_int_handler)
    sys.argv = words
    folders = [str(Path(sys.executable).parent), os.environ.get("PATH", os.defpath)]
    os.environ["PATH"] = os.pathsep.join(folders)  # jobs find the same python
    try:
        snakemake()
    except SystemExit as end:
        status = end.code
    if status == 0 and not dry_run:
        print(closing(configuration.results), end="")
    return status


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
