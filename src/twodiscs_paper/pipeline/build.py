"""``twodiscs run``: Snakemake's own command line, and the last lines of a build.

The Snakefile imports this, so it must be quick.
"""

import json
import os
import shlex
import shutil
import signal
import sys
import tempfile
from collections import Counter
from datetime import datetime
from importlib import metadata
from pathlib import Path

import twodiscs
from twodiscs.figures.scene_figures import FIGURES
from twodiscs.measure.load import read_box
from twodiscs.model.checks import InputError, check_choice, check_integer
from twodiscs.model.formats import did_you_mean
from twodiscs_paper.catalogue import STUDIES, STUDY_FIGURES, read_table
from twodiscs_paper.configuration.yaml_files import ConfigError, check_results, load, read
from twodiscs_paper.pipeline.job_cost import missed

#: Targets by name, beside the figures and the studies.
TARGETS = (
    "all", "check", "paper", "report", "animation", "manifest", "provenance", "verify", "renew",
    "forecast", "explorer", "benchmark", *FIGURES, *STUDIES,
)  # fmt: skip

#: The path of the workflow of a wheel, below the folder of the installation. If pip has a --target,
#: this is the folder of the packages, and the paths in the wheel's records are wrong.
SNAKEFILE = "share/twodiscs/Snakefile"

#: The exit status of a command that Ctrl-C ended.
INTERRUPT_STATUS = 128 + signal.SIGINT

#: A disk with fewer free bytes is full.
LEAST_FREE_BYTES = 2**20

#: The target of a command without one: check, tables, figures and the report on them.
DEFAULT_TARGET = "report"


def snakefile():
    """Return the Snakefile of this package: in its checkout, or in the files of its wheel."""
    checkout = Path(twodiscs.__file__).parents[2] / "Snakefile"
    if checkout.is_file():
        return checkout
    try:
        files = metadata.files("twodiscs") or ()
    except metadata.PackageNotFoundError:
        files = ()
    installed = [Path(file.locate()) for file in files if file.as_posix().endswith(SNAKEFILE)]
    for path in (Path(twodiscs.__file__).parents[1] / SNAKEFILE, *installed):
        if path.is_file():
            return path.resolve()
    raise InputError("the workflow is not installed: twodiscs comes without its Snakefile here")


def check_code(folder):
    """Raise ``InputError`` if the sources in ``folder`` are not those that are imported.

    Texts of pages come from docstrings, so Python must not leave these out either.
    """
    here, imported = Path(folder, "src/twodiscs"), Path(twodiscs.__file__).parent
    if here.is_dir() and not here.samefile(imported):
        raise InputError(
            f"the code in {here.resolve()} would not run, because {imported} is installed; `make` "
            "there sets up an environment that runs it"
        )
    if sys.flags.optimize > 1:
        raise InputError(
            "PYTHONOPTIMIZE=2 must not be set: it removes docstrings, which the pages show"
        )


def command(path, targets, snakefile, cores=None, dry_run=False, unlock=False):
    """Return the words of the command that builds ``targets`` of the configuration at ``path``.

    It prints the progress, but not each job. Without ``targets`` it builds the report. It uses
    ``cores`` cores. If they are None, the user's profile of Snakemake chooses; without a profile it
    uses all. With ``dry_run`` it prints and does nothing, with ``unlock`` it removes the lock that
    a killed run left.

    Raises ``InputError`` for a target that is neither a name nor a path, and for ``cores`` that are
    no integer ≥ 1.
    """
    if cores is not None:
        cores = check_integer("cores", cores, 1)
    elif not os.environ.get("SNAKEMAKE_PROFILE"):
        cores = "all"
    for target in targets:
        if target not in TARGETS and "/" not in target:
            raise InputError(
                f"a target must be one of {', '.join(TARGETS)}, or the path of a file of results, "
                f"not {target!r}{did_you_mean(target, TARGETS)}"
            )
    here, found = Path("Snakefile"), []
    if not (here.exists() and here.samefile(snakefile)):
        # Snakemake would first look for a profile in this folder.
        profile = snakefile.with_name("profiles") / "default"
        found = ["--snakefile", str(snakefile), "--workflow-profile", str(profile)]
    words = ["snakemake", *found, *(["--cores", str(cores)] if cores is not None else [])]
    words += ["--quiet", "rules", "host"]
    words += ["progress", "reason"] if dry_run else []  # ``planned`` prints them by scene
    words += ["--dry-run"] * dry_run + ["--unlock"] * unlock + ["--configfile", str(path)]
    return [*words, "--", *(targets or [DEFAULT_TARGET])]


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


def check_writable(results):
    """Raise ``InputError`` unless the folder of the run and that of ``results`` are writable."""
    for folder in (Path.cwd(), Path(results).resolve()):
        while not folder.exists():
            folder = folder.parent
        if not os.access(folder, os.W_OK):
            raise InputError(f"{folder} must be a folder that can be written to")


def check_owner(results, scenes):
    """Raise ``InputError`` if the folder ``results`` holds a build of none of these ``scenes``.

    That build would lose its report, its check and its configuration, but keep its tables and its
    manifest.
    """
    try:
        text = Path(results, "configuration.json").read_text(encoding="utf-8")
        built = [scene["name"] for scene in json.loads(text)["scenes"]]
    except (OSError, ValueError, LookupError, TypeError):  # no build, or one that is damaged
        return
    if not {*built} & {scene.name for scene in scenes}:
        raise InputError(
            f"results must be the folder of no other build, not {results!r}, which has the scenes "
            f"{', '.join(built)}; with --force this build replaces their report and their check"
        )


def build(path, targets, cores=None, dry_run=False, unlock=False, force=False):
    """Run ``command`` with these arguments in Snakemake; return its exit status.

    With ``force`` it may replace the build of other scenes.
    """
    check_code(".")
    from snakemake import cli, workflow

    try:
        configuration = load(read(path))
    except ConfigError as error:
        # Errors of reading name their file already.
        sentences = str(error).split("\n")
        raise InputError(*(s if str(path) in s else f"{path}: {s}" for s in sentences)) from None
    check_results(configuration.results, ".")
    check_targets(path, targets, configuration)
    check_writable(configuration.results)
    if not (dry_run or unlock or force):
        check_owner(configuration.results, configuration.scenes)
    # With --quiet the Snakefile prints no last lines; they are printed below in every case.
    words = command(path, targets, snakefile(), cores, dry_run, unlock)
    print(*places(path, configuration.results), shlex.join(words), sep="\n", flush=True)
    # Snakemake runs in this process. Its profile reads sys.argv, and it cleans up after Ctrl-C.
    sys.argv = words
    interrupts = []

    def interrupt(number, frame):
        interrupts.append(INTERRUPT_STATUS)
        raise KeyboardInterrupt

    signal.signal(signal.SIGINT, interrupt)
    _find_a_cache()
    try:
        cli.main()
    except SystemExit as end:
        # Snakemake ends a stopped run as a failed one.
        status = max([end.code or 0, *interrupts])
    except KeyboardInterrupt:
        status = INTERRUPT_STATUS
    # Snakemake keeps the last workflow of a process among the names of a Snakefile.
    if status:
        run = getattr(workflow, "workflow", None)
        print(failure(run, status, configuration.results), end="", file=sys.stderr)
    elif not unlock:
        dag, scenes = workflow.workflow.dag, configuration.described()
        print(
            planned(dag) if dry_run else closing(configuration.results, dag, [path], scenes), end=""
        )
    return status


def places(path, results):
    """Return sentences on where the files of a build are, for its first lines.

    ``results`` are below the folder of the run, which may not be that of the configuration at
    ``path``. If that one has results of the same configuration, a sentence names them.
    """
    lines, beside = [f"Results: {Path(results).resolve()}"], Path(path).parent / results
    try:
        built = json.loads((beside / "configuration.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return lines
    if built == read(path) and not (Path(results).exists() and beside.samefile(results)):
        lines += [f"{beside} has a build of this configuration: to go on with it, run there"]
    return lines


def failure(workflow, status, results):
    """Return the last lines of a run of a ``Workflow`` of Snakemake that ended with a ``status``.

    They are the reasons in the words of each failed job, the path of its log, and what to do. If
    the disk of the ``results`` is full, this is also a reason.
    """
    again = "the same command goes on, and keeps the files that are finished"
    scheduler = workflow and workflow.scheduler
    folder = Path(results if Path(results).exists() else ".").resolve()
    is_full = shutil.disk_usage(folder).free < LEAST_FREE_BYTES
    if scheduler is None and status != INTERRUPT_STATUS and not is_full:
        if workflow and workflow.persistence and workflow.persistence.locked:
            return (
                "Another run works in this folder, or one was killed there. If none works, run the "
                f"command once with --unlock; then {again}.\n"
            )
        return ""  # Snakemake ended with the reason
    failed = scheduler.failed if scheduler else ()
    lines = [f"error: no space is left on the disk of {folder}"] * is_full
    for job in sorted((job for one in failed for job in getattr(one, "jobs", [one])), key=str):
        for log in job.log:
            lines += [f"error: {sentence}" for sentence in reasons(log)] + [f"The log is {log}"]
    lines.append(f"{'Remove the cause' if lines else 'Stopped'}; {again}.")
    return "".join(f"{line}\n" for line in lines)


def reasons(log):
    """Return the sentences with which a job ended: the last lines of its ``log``."""
    try:
        lines = Path(log).read_text(encoding="utf-8", errors="replace").split("\n")
    except OSError:
        lines = []
    lines = [line.strip() for line in lines if line.strip()]
    if not lines:
        return ["the job ended without a word: it was killed, or no memory was left"]
    is_traceback = any(line.startswith("Traceback ") for line in lines)
    last = lines[-1:] if is_traceback else lines[-5:]
    return [line.removeprefix(f"{InputError.__module__}.InputError: ") for line in last]


def planned(dag):
    """Return a table of the jobs that Snakemake would run: scene, rule, their number, a reason.

    A row has the most frequent reason of its jobs.
    """
    from tabulate import tabulate

    reasons = {}
    for job in dag.needrun_jobs(exclude_finished=False):
        row = job.wildcards.get("scene", ""), job.rule.name
        reasons.setdefault(row, []).append(_reason(dag.reason(job)))
    rows = [
        (*row, len(of_row), Counter(of_row).most_common(1)[0][0])
        for row, of_row in sorted(reasons.items())
    ]
    table = tabulate(rows, headers=["scene", "rule", "jobs", "reason"])
    return f"{table}\n" if rows else "All files are up to date.\n"


def _reason(reason):
    """Return why a job runs, with an input that was edited if that is why."""
    name = next(reason.get_names(), "")
    edited = sorted(reason.updated_input - reason.updated_input_run)
    return f"{name}: {edited[0]}" if edited and "updated" in name else name


def _find_a_cache():
    """Give Snakemake and its jobs a folder for caches here, if the one in the home is read-only."""
    from snakemake.common import get_appdirs

    try:
        folder = get_appdirs().user_cache_dir
        Path(folder).mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        os.environ["XDG_CACHE_HOME"] = str(Path(".snakemake/cache").resolve())


def closing(results, dag, configured, scenes=()):
    """Return the last lines of a build.

    They are the files of its targets, the verdict of the check in the folder of ``results``, and
    the path of the report. If the check or the report were not built and are older than a file of
    ``configured``, the paths of the configuration, a line names it. The last lines are about
    accuracies of ``scenes``, as described, that were not reached.
    """
    made = {str(path) for job in dag.jobs for path in job.output}
    lines = []
    for job in dag.targetjobs:
        has_figures = job.rule.name in (*FIGURES, *STUDIES, "animation")
        paths = job.input if has_figures else job.output
        if paths and job.rule.name not in ("check", "report"):
            lines.append(f"{job.rule.name}: {', '.join(map(str, paths))}")
    passed, report = Path(results, "check.passed"), Path(results, "report.html")
    if str(passed) in made:
        when = datetime.fromtimestamp(passed.stat().st_mtime)
        lines += [f"{passed}, of {when:%Y-%m-%d %H:%M}:"]
        lines += [f"  {line}" for line in passed.read_text(encoding="utf-8").splitlines()]
    if str(report) in made:
        lines += [f"The report is {report.resolve()}"]
    last = max((Path(path).stat().st_mtime for path in configured), default=0.0)
    for path in (passed, report):
        if str(path) not in made and path.exists() and path.stat().st_mtime < last:
            lines += [f"{path} is older than the configuration; the target {path.stem} renews it"]
    for scene in scenes:
        if f"{results}/{scene['name']}/mean_times.csv" in made:
            lines += missed(results, scene)
    return "".join(f"{line}\n" for line in lines)


def draw_study(frame, figure):
    """Return a ``figure`` of a study that shows a loaded table, the first one without a name.

    The other tables of the figure lie beside it, as a build writes them.
    """
    table, folder = frame.attrs["table"], Path(frame.attrs["path"]).parent
    fitting = [n for n, one in STUDY_FIGURES.items() if table in (*one.tables, *one.long_runs)]
    if not fitting:
        raise InputError(f"result must be a table with a figure, but {table!r} has none")
    name = fitting[0] if figure is None else check_choice("figure", figure, fitting)
    entry, scenes = STUDY_FIGURES[name], (frame.attrs["configuration"] or {}).get("scenes", [])
    boxes = {scene["name"]: read_box({"scenes": [scene]}) for scene in scenes}
    main = next((scene for scene, box in boxes.items() if box and box.is_plain), None)
    if main is None and entry.main_tables:
        raise InputError(
            f"result must be of a build with a scene of two plain discs for the figure {name}"
        )
    paths = {one: folder / main / f"{one}.csv" for one in entry.main_tables}
    paths |= {one: folder / f"{one}.csv" for one in entry.tables}
    paths |= {one: snakefile().parent / path for one, path in entry.long_runs.items()}
    del paths[table]
    try:
        tables = {one: read_table(path) for one, path in paths.items()}
    except OSError as error:
        raise InputError(
            f"result must lie beside the other tables of the figure {name}, but {error.filename} "
            "cannot be read"
        ) from None
    from twodiscs_paper.draw import DRAW  # which imports what studies measure with

    rows = frame.astype(object).where(frame.notna(), None).to_dict("records")
    return DRAW[name](boxes.get(main), tables | {table: rows})
