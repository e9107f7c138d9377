"""The command line `twodiscs`: numbers, options and results.

Without these tests a number could lose digits, an option or a result could get lost on its way.

Mistakes in words are in ``test_bad_input.py``.
"""

import csv
import inspect
import io
import json
import math
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import Mock

import pytest
from checkout import REPOSITORY
from commands import command, python
from snakemake.jobs import Reason

import twodiscs
from twodiscs import cli
from twodiscs.model.checks import InputError
from twodiscs.model.effects import EFFECTS
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene
from twodiscs.theory.exact import exact as exact_numbers
from twodiscs_paper.configuration.yaml_files import load, read
from twodiscs_paper.pipeline import build

BOX = ["--width", "1.5", "--height", "1"]


@pytest.fixture
def shell(monkeypatch, capsys):
    """A function that runs ``twodiscs`` in this process and returns what it prints."""

    def run(*words):
        assert command(monkeypatch, cli, *words) == 0
        return capsys.readouterr().out

    return run


def test_every_form_of_exact_numbers_holds_every_digit(shell):
    words = "exact", *BOX, "--radius", "0.3"
    numbers = exact_numbers(Scene(1.5, 1, 0.3))
    times, printed = numbers["mean_times"], json.loads(shell(*words, "--json"))
    assert printed == numbers
    assert list(printed["areas"]) == list(printed["mean_times"]) == list(EVENTS)
    assert times["horizontal_hop"] is None
    rows = {line.split()[0]: line.split()[1:] for line in shell(*words).splitlines() if line}
    assert rows["volume"] == [repr(numbers["volume"]), "length⁴"]
    assert rows["event"] == ["area", "(length³)", "mean", "time", "(time)"]
    table = {row["quantity"]: row for row in csv.DictReader(io.StringIO(shell(*words, "--csv")))}
    assert {float(row["radius"]) for row in table.values()} == {0.3}
    for event, time in times.items():
        text = "impossible" if time is None else repr(time)
        assert rows[event] == [repr(numbers["areas"][event]), text]
        assert table[f"{event}_time"]["exact"] == ("" if time is None else text)


@pytest.mark.parametrize(
    ("name", "given"),
    [
        (
            "simulate",
            {
                "error": 0.1, "duration": 5.0, "budget": 10**6, "events": ["any_wall"],
                "method": "dynamics",
            },
        ),
        (
            "sample",
            {
                "samples": 10**6, "error": 0.1, "budget": 10**7, "quantities": ["volume"],
                "shell": 0.1, "method": "rejection",
            },
        ),
        ("trajectory", {"duration": 5.0, "start": [0.0, 1.0]}),
    ],
)  # fmt: skip
def test_every_option_reaches_the_function(name, given, monkeypatch):
    """Without the options it has its own defaults."""
    given |= {"seed": 7, "name": "a"} | ({} if name == "trajectory" else {"cores": 2})
    taken = {}

    def function(scene, **options):
        taken.update(options)
        raise InputError("enough")

    usual = inspect.signature(getattr(twodiscs, name)).parameters
    monkeypatch.setattr(twodiscs, name, function)
    words = ["--radius", "0.2"]
    for option, value in given.items():
        words += [f"--{option}", *(value if isinstance(value, list) else [value])]
    assert command(monkeypatch, cli, name, *BOX, *map(str, words)) == 2
    assert taken == given
    assert command(monkeypatch, cli, name, *BOX, *words[:2]) == 2
    assert taken == {name: usual[name].default for name in given}


def test_cost_prints_times_of_errors_as_a_table_and_for_scripts(shell):
    words = "cost", *BOX, "--radius", "0.2", "--errors", "1e-2", "paper", "--shell", "0.1"
    text = shell(*words)
    assert text.startswith(str(Scene(1.5, 1, 0.2)))
    assert " 0.01 0.0003 " in re.sub(" +", " ", text)
    rows = json.loads(shell(*words, "--json"))
    table = [*csv.DictReader(io.StringIO(shell(*words, "--csv")))]
    assert [row["method"] for row in table] == [row["method"] for row in rows]
    (area,) = (row for row in rows if row["quantity"] == "top_wall_area" if "rej" in row["method"])
    assert 0.01 < area["floor"] < 0.02  # a fifth of it in usual shells
    assert area["seconds_0.0003"] is None
    assert {*rows[0]} >= {"c", "least_error", "least_seconds", "seconds_0.01", "seconds_0.0003"}


def test_a_result_for_scripts_has_its_note_beside_it(monkeypatch, capsys):
    words = "simulate", *BOX, "--radius", "0.2", "--events", "any_wall", "--error", "1e-4"
    assert command(monkeypatch, cli, *words, "--budget", "1e6", "--csv") == 0
    shown = capsys.readouterr()
    assert shown.err.startswith("0.0001 asked for; the budget of 1e6 events ended it at ")
    assert shown.out.startswith("radius,")


def test_effects_are_options_with_their_meanings(shell):
    named = {"radius_ratio": 0.5, "mass_ratio": 2.0, "field": 0.5}
    words = "exact", *BOX, "--radius", "0.1"
    some = *words, "--radius-ratio", "0.5", "--mass-ratio", "2", "--field", ".5"
    assert json.loads(shell(*some, "--json")) == exact_numbers(Scene(1.5, 1, 0.1, **named))
    text = shell(*some)
    assert all(f"{name.replace('_', ' '):<20}{value}" in text for name, value in named.items())
    balls = shell(*words, "--depth", "1.2")
    assert balls.startswith("Two balls of radius 0.1 in a box of 1.5 × 1.0 × 1.2\n")
    assert "\nvelocity components 6\n" in balls
    torus = shell(*words, "--periodic", "yx")
    assert "\nvelocity components 2\ntotal momentum      0 along x, y\n" in torus
    assert "velocity components" not in shell(*words)
    page = shell("exact", "--help")
    for name, effect in EFFECTS.items():
        assert f"--{name.replace('_', '-')}" in page
        assert effect.meaning in " ".join(page.split())


# Standard output ---------------------------------------------------------------------------------

EXACT = ("exact", *BOX, "--radius", "0.2")


def installed(*words, redirected="", **environment):
    """Return the completed process of ``twodiscs`` in a shell, with streams ``redirected``."""
    line = shlex.join([str(Path(sys.executable).with_name("twodiscs")), *words])
    return subprocess.run(
        f"{line} {redirected}", shell=True, capture_output=True, check=False,
        env={**os.environ, "PYTHONIOENCODING": "utf-8", **environment},
    )  # fmt: skip


def test_no_stream_loses_a_result(shell):
    """An encoding without its letters, a closed standard error, a full device."""
    expected = shell(*EXACT)
    for encoding in ("ascii", "cp1252"):
        done = installed(*EXACT, PYTHONIOENCODING=encoding)
        assert (done.returncode, done.stderr) == (0, b"")
        assert done.stdout == expected.encode(encoding, "backslashreplace")
    assert installed(*EXACT, redirected="2>&-").stdout.decode() == expected
    done = installed("exact", *BOX, redirected="2>&-")
    assert (done.returncode, done.stdout) == (2, b"")
    done = installed(*EXACT, redirected="> /dev/full")
    *result, error = done.stderr.decode().splitlines()
    assert done.returncode == 2
    assert error == "error: standard output: No space left on device"
    assert result == expected.splitlines()


def test_a_closed_output_is_refused_before_the_work():
    done = installed("simulate", *BOX, "--radius", "0.2", "--error", "1e-9", redirected=">&-")
    assert (done.returncode, done.stderr) == (2, b"error: standard output is closed\n")


@pytest.mark.parametrize("words", [EXACT, ("--version",)])
def test_who_reads_may_stop_reading(words):
    reader, writer = os.pipe()
    os.close(reader)
    to = {"stdout": writer, "stderr": subprocess.PIPE, "capture_output": False}
    run = python("-m", "twodiscs", *words, **to)
    os.close(writer)
    assert run.stderr == ""


def test_run_turns_an_error_into_a_sentence_and_a_result_into_its_status(capsys):
    for main, status, sentence in (
        (Mock(side_effect=InputError("two\n  lines")), 2, "error: two lines\n"),
        (Mock(side_effect=FileNotFoundError(2, "No file", "a.csv")), 2, "error: a.csv: No file\n"),
        (Mock(side_effect=OSError("broken")), 2, "error: broken\n"),
        (Mock(return_value=None), None, ""),
        (Mock(return_value=1), 1, ""),
    ):
        with pytest.raises(SystemExit) as caught:
            cli.run(main)
        assert (caught.value.code, capsys.readouterr().err) == (status, sentence)


# Builds -----------------------------------------------------------------------------------------


def test_a_new_configuration_is_one_and_is_not_written_over(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert not command(monkeypatch, cli, "new", "my.yaml")
    said = "my.yaml is written. To build it: twodiscs run my.yaml\n"
    assert capsys.readouterr().out == said
    (scene,) = load(read("my.yaml")).scenes
    assert scene.name == "mine"
    # The configuration may contain the lines in its comments.
    text = Path("my.yaml").read_text()
    for line in re.findall(r"# (\w+: .*)", text):
        assert re.match(r"(seed|shared|effects|watch|monte_carlo): ", line), line
    Path("all.yaml").write_text(re.sub(r"# (\w+: )", r"\1", text))
    assert load(read("all.yaml")).scenes[0].effects == {"radius_ratio": 0.5}
    # The commands in its first lines have targets.
    targets = re.findall(r"^# twodiscs run my.yaml *(\w*)", text, re.MULTILINE)
    assert targets[0] == ""
    assert {*targets[1:]} <= {*build.TARGETS}
    assert command(monkeypatch, cli, "new", "my.yaml") == 2
    assert capsys.readouterr().err == "error: my.yaml exists already and is not overwritten\n"
    assert Path("my.yaml").read_text() == text


@pytest.mark.parametrize(
    ("name", "absent", "needed"),
    [
        ("new", "", "the package twodiscs_paper"),
        ("run", "", "the package twodiscs_paper"),
        ("run", "snakemake", "Snakemake: pip install '.[workflow]' in the repository"),
    ],
)
def test_a_library_alone_says_what_it_lacks(name, absent, needed, monkeypatch, capsys):
    monkeypatch.setattr(cli, "plugin", lambda name: None)
    monkeypatch.setitem(sys.modules, absent, None)  # which makes its import fail
    assert command(monkeypatch, cli, name, "my.yaml") == 2
    assert capsys.readouterr().err == f"error: twodiscs {name} needs {needed}\n"


def test_a_run_is_a_line_of_snakemake(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("SNAKEMAKE_PROFILE", raising=False)
    words = build.command("my.yaml", ["volume", "results/check.passed"], Path("/a/Snakefile"))
    assert words == [
        *("snakemake", "--snakefile", "/a/Snakefile"),
        *("--workflow-profile", "/a/profiles/default", "--cores", "all"),
        *("--quiet", "rules", "host"),
        *("--configfile", "my.yaml", "--", "volume", "results/check.passed"),
    ]
    monkeypatch.chdir(build.snakefile().parent)
    assert "--snakefile" not in build.command("my.yaml", [], build.snakefile())
    words = build.command("my.yaml", [], build.snakefile(), 3, True)
    options = ["--cores", "3", "--quiet", "rules", "host", "progress", "reason"]
    assert words[1:] == [*options, "--dry-run", "--configfile", "my.yaml", "--", "report"]
    monkeypatch.setenv("SNAKEMAKE_PROFILE", "cluster")  # which chooses the cores
    assert "--cores" not in build.command("my.yaml", [], Path("Snakefile"))
    assert "--cores 2" in " ".join(build.command("my.yaml", [], Path("Snakefile"), 2))
    with pytest.raises(InputError, match="cores must be"):
        build.command("my.yaml", [], Path("Snakefile"), 0)
    with pytest.raises(InputError, match="not 'volme'; did you mean 'volume'"):
        build.command("my.yaml", ["volme"], Path("Snakefile"))


def test_what_cannot_be_built_is_refused(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    scene = "{name: a, box: {width: 1, height: 1}, effects: {field: 1}, watch: {mean_times: true}}"
    Path("a.yaml").write_text(f"scenes: [{scene}]\n")
    said = dict.fromkeys(
        ("tails", "paper", "model"), "is about a scene without effects, and a.yaml has none"
    )
    said["volume"] = "cannot be drawn: no scene of a.yaml has its quantities in `watch`"
    for target, reason in said.items():
        assert command(monkeypatch, cli, "run", "a.yaml", target) == 2
        assert capsys.readouterr().err == f"error: {target} {reason}\n"
    build.check_targets("a.yaml", ["mean_hop_time", "effects", "check"], load(read("a.yaml")))
    Path("a.yaml").write_text(f"seeed: 1\nseed: x\nscenes: [{scene}]\n")
    assert command(monkeypatch, cli, "run", "a.yaml") == 2
    assert re.fullmatch(
        r"error: a.yaml: the configuration has an unknown key 'seeed'.*\n"
        r"error: a.yaml: seed must be an integer .*, not 'x'\n",
        capsys.readouterr().err,
    )
    Path("a.yaml").write_text(f"results: a.yaml\nscenes: [{scene}]\n")
    assert command(monkeypatch, cli, "run", "a.yaml") == 2
    assert capsys.readouterr().err.startswith("error: results must be ")
    assert command(monkeypatch, cli, "run", "b.yaml") == 2
    assert capsys.readouterr().err == "error: b.yaml: No such file or directory\n"


def test_targets_may_stand_behind_options(monkeypatch, capsys):
    given = []
    monkeypatch.setattr(build, "build", lambda path, **words: given.append((path, words)))
    assert not command(
        monkeypatch, cli, "run", "my.yaml", "volume", "-n", "pressure", "--cores", "2"
    )
    options = {"targets": ["volume", "pressure"], "cores": 2, "dry_run": True, "unlock": False}
    assert given == [("my.yaml", options)]


def _dag(targets, made):
    """Return what ``closing`` asks of Snakemake: jobs that are targets, and all jobs."""
    jobs = [SimpleNamespace(output=list(map(str, paths))) for paths in made]
    return SimpleNamespace(
        targetjobs=[
            SimpleNamespace(rule=SimpleNamespace(name=name), output=output, input=files)
            for name, output, files in targets
        ],
        jobs=jobs,
    )


def test_a_build_ends_with_its_own_verdict_and_report(tmp_path, monkeypatch):
    """Those of another build may be in the folder. They say so if the configuration is newer."""
    passed, report, mine, other = (
        tmp_path / n for n in ("check.passed", "report.html", "my.yaml", "other.yaml")
    )
    passed.write_text("a: 3 comparisons passed\n")
    report.touch()
    mine.touch()
    os.utime(mine, (0, 0))
    assert build.closing(tmp_path, _dag([], [["a.png"]]), [mine]) == ""
    assert "report" not in build.closing(tmp_path, _dag([], [[passed], ["a.png"]]), [mine])
    lines = build.closing(tmp_path, _dag([], [[passed], [report]]), [mine]).splitlines()
    assert lines[0].startswith(f"{passed}, of 2")
    assert lines[1:] == ["  a: 3 comparisons passed", f"The report is {report}"]
    os.utime(passed, (1, 1))
    os.utime(mine, (2, 2))
    other.touch()
    os.utime(other, (0, 0))
    old = f"{passed} is older than the configuration; the target check renews it\n"
    for paths in ([mine], [mine, other], [other, mine]):
        assert build.closing(tmp_path, _dag([], []), paths) == old
    assert old not in build.closing(tmp_path, _dag([], [[passed]]), [mine])
    # Accuracies that were not reached, of the scenes whose times were built.
    monkeypatch.setattr(build, "missed", lambda results, scene: [f"{scene['name']}: missed"])
    dag, scenes = _dag([], [[tmp_path / "a" / "mean_times.csv"]]), [{"name": "a"}, {"name": "b"}]
    assert build.closing(tmp_path, dag, [mine], scenes) == f"{old}a: missed\n"


KILLED = "error: the job ended without a word: it was killed, or no memory was left"
RAISED = "twodiscs.model.checks.InputError: a is cut"


@pytest.mark.parametrize(
    ("log", "lines"),
    [
        (None, [KILLED]),
        (" \n", [KILLED]),
        (f"Traceback (most recent call last):\n  in\n{RAISED}\n", ["error: a is cut"]),
        (f"1\n2\n3\n{RAISED}\n5\n6", [f"error: {n}" for n in (2, 3, "a is cut", 5, 6)]),
    ],
)
def test_a_run_with_failed_jobs_ends_with_their_reasons(log, lines, tmp_path, monkeypatch):
    """A group of jobs, as on a cluster, has those of each; so has a full disk."""
    path = tmp_path / "a.log"
    if log is not None:
        path.write_text(log)
    lines = [*lines, f"The log is {path}"]
    again = "Remove the cause; the same command goes on, and keeps the files that are finished."
    job = SimpleNamespace(log=[path])
    for failed in (job, SimpleNamespace(jobs=[job])):
        workflow = SimpleNamespace(scheduler=SimpleNamespace(failed=[failed]))
        assert build.failure(workflow, 1, tmp_path).splitlines() == [*lines, again]
    assert build.failure(None, 1, tmp_path) == ""  # Snakemake ended with the reason
    monkeypatch.setattr(build, "FULL", math.inf)
    full = f"error: no space is left on the disk of {tmp_path}"
    for one, reasons in ((workflow, lines), (None, [])):
        assert build.failure(one, 1, tmp_path).splitlines() == [full, *reasons, again]


@pytest.mark.parametrize(
    ("end", "status", "said"),
    [(KeyboardInterrupt, 130, "Stopped; the same"), (SystemExit(3), 3, "")],
)
def test_a_run_has_the_status_of_its_end(end, status, said, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("snakemake.cli.main", Mock(side_effect=end))
    monkeypatch.setattr("snakemake.workflow.workflow", None, raising=False)
    Path("a.yaml").write_text("scenes: [{name: a, box: {width: 1, height: 1}}]\n")
    assert command(monkeypatch, cli, "run", "a.yaml") == status
    assert capsys.readouterr().err.startswith(said)


def test_a_dry_run_counts_the_jobs_of_a_scene_and_names_a_reason():
    edited, missing = Reason(), Reason()
    edited.updated_input.update(["b.py", "a.py"])
    missing.missing_output.add("c.json")
    long = {"scene": "long"}
    jobs = [
        SimpleNamespace(rule=SimpleNamespace(name=rule), wildcards=of, why=why)
        for rule, of, why in [("dynamics", long, missing)] * 2
        + [("table", long, edited), ("code", {}, missing)]
    ]
    dag = SimpleNamespace(needrun_jobs=lambda exclude_finished: jobs, reason=lambda job: job.why)
    assert [" ".join(line.split()) for line in build.planned(dag).splitlines()[2:]] == [
        "code 1 output files have to be generated",
        "long dynamics 2 output files have to be generated",
        "long table 1 updated input files: a.py",
    ]
    jobs.clear()
    assert build.planned(dag) == "All files are up to date.\n"


def test_a_build_ends_with_the_files_of_its_targets(tmp_path):
    targets = [("pressure", [], ["a.pdf", "a.png"]), ("explorer", ["e.html"], ["e.js"])]
    targets += [("report", ["r.html"], []), ("default", [], ["r.html"]), ("check", ["c"], [])]
    lines = build.closing(tmp_path, _dag(targets, []), [])
    assert lines == "pressure: a.pdf, a.png\nexplorer: e.html\n"


#: {line: what a shell proposes}.
COMPLETED = {
    "twodiscs si": "simulate",
    "twodiscs simulate --ev": "--events",
    "twodiscs simulate --events vert": "vertical_hop",
    "twodiscs exact --periodic x y": "y",
    "twodiscs run config/d": "config/draft.yaml",
    "twodiscs run LICEN": "",
    "twodiscs run my.yaml volu": "volume",
}

#: Completes each line in a copy of the process.
COMPLETE = """
import os, sys
from twodiscs.cli import main

for line in sys.argv[2:]:
    if not os.fork():
        os.environ |= {"COMP_LINE": line, "COMP_POINT": str(len(line))}
        main()
    os.wait()
    with open(sys.argv[1]) as proposed:
        print(*proposed)
"""


def test_a_shell_completes(tmp_path):
    shell = {
        "_ARGCOMPLETE": "1", "_ARGCOMPLETE_IFS": "\n", "_ARGCOMPLETE_SUPPRESS_SPACE": "1",
        "_ARGCOMPLETE_STDOUT_FILENAME": str(tmp_path / "proposed"), "COMP_TYPE": "9",
    }  # fmt: skip
    words = "-c", COMPLETE, tmp_path / "proposed", *COMPLETED
    found = python(*words, timeout=60, env=os.environ | shell, cwd=REPOSITORY, check=True).stdout
    assert found.splitlines() == [*COMPLETED.values()]
