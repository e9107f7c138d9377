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
import signal
import sys
from contextlib import suppress
from io import TextIOWrapper
from multiprocessing import get_context
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import Mock, create_autospec

import pytest
from checkout import REPOSITORY
from commands import command, python, refused
from snakemake.jobs import Reason

import twodiscs
from twodiscs import EFFECTS, EVENTS, InputError, Scene, cli
from twodiscs.theory.exact import exact as exact_numbers
from twodiscs_paper.configuration.yaml_files import load, read
from twodiscs_paper.pipeline import build

BOX = ["--width", "1.5", "--height", "1"]


@pytest.fixture
def shell(monkeypatch, capsys):
    """A function that runs ``twodiscs`` in this process and returns what it prints."""

    def run(*words):
        assert command(monkeypatch, *words) == 0
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
    table = {row["quantity"]: row for row in csv.DictReader(io.StringIO(shell(*words, "--csv")))}
    assert {float(row["radius"]) for row in table.values()} == {0.3}
    for event, time in times.items():
        text = "impossible" if time is None else repr(time)
        assert rows[event] == [repr(numbers["areas"][event]), text]
        assert table[f"{event}_time"]["exact"] == ("" if time is None else text)


def test_every_form_of_a_trajectory_has_its_rows(shell):
    words, path = (*EXACT[1:], "--duration", "3"), twodiscs.trajectory(Scene(1.5, 1, 0.2), 3)
    table = [*csv.DictReader(io.StringIO(shell("trajectory", *words, "--csv")))]
    for rows in (table, json.loads(shell("trajectory", *words, "--json"))):
        assert [[*row] for row in rows] == [[*path]] * len(path)
        assert [float(row["x2"]) for row in rows] == path["x2"].tolist()
        assert rows[0]["second"] in ("", None)
    printed = [line.split() for line in shell("trajectory", *words).splitlines()[2:]]
    assert [row[5] for row in printed] == ["event", *path["event"]]


#: Arguments of functions that are options of their commands, and a value of each.
OPTIONS = {
    "error": 0.1, "duration": 5.0, "samples": 10**6, "budget": 10**7, "events": ["any_wall"],
    "quantities": ["volume"], "start": [0.0, 1.0], "errors": [0.1, "paper"], "shell": 0.1,
    "method": "rejection", "seed": 7, "name": "a", "cores": 2,
}  # fmt: skip


@pytest.mark.parametrize("name", ["simulate", "sample", "cost", "trajectory"])
def test_every_option_reaches_the_function(name, monkeypatch):
    """Without the options it has its own defaults."""
    usual = inspect.signature(getattr(twodiscs, name))
    given = {option: value for option, value in OPTIONS.items() if option in usual.parameters}
    function = create_autospec(getattr(twodiscs, name), side_effect=InputError("enough"))
    monkeypatch.setattr(twodiscs, name, function)
    words = [name, *BOX, "--radius", "0.2"]
    assert command(monkeypatch, *words) == 2
    for option, value in given.items():
        words += [f"--{option}", *(value if isinstance(value, list) else [value])]
    assert command(monkeypatch, *words) == 2
    scene = Scene(1.5, 1, 0.2)
    for call, options in zip(function.call_args_list, ({}, given), strict=True):
        found, right = usual.bind(*call.args, **call.kwargs), usual.bind(scene, **options)
        found.apply_defaults()
        right.apply_defaults()
        assert found == right


def test_cost_prints_times_of_errors_as_a_table_and_for_scripts(shell, monkeypatch):
    cost = twodiscs.cost(Scene(1.5, 1, 0.2), [1e-2, "paper"], shell=0.1)
    monkeypatch.setattr(twodiscs, "cost", lambda *_, **__: cost)
    words = "cost", *BOX, "--radius", "0.2"
    text = shell(*words)
    assert text.startswith(str(Scene(1.5, 1, 0.2)))
    assert " 1e-2 3e-4 " in re.sub(" +", " ", text)
    rows = json.loads(shell(*words, "--json"))
    table = [*csv.DictReader(io.StringIO(shell(*words, "--csv")))]
    assert [row["method"] for row in table] == [row["method"] for row in rows]
    (area,) = (row for row in rows if row["quantity"] == "top_wall_area" if "rej" in row["method"])
    assert 0.01 < area["floor"] < 0.02  # a fifth of it in usual shells
    assert area["seconds_0.0003"] is None
    assert {*rows[0]} >= {"c", "least_error", "least_seconds", "seconds_0.01", "seconds_0.0003"}


def test_a_result_for_scripts_has_its_note_beside_it(monkeypatch, capsys, recwarn):
    words = "simulate", *BOX, "--radius", "0.2", "--events", "any_wall", "--error", "1e-4"
    for form, begin in (("--csv", "radius,"), ("--json", "{")):
        assert command(monkeypatch, *words, "--budget", "1e6", form) == 0
        shown = capsys.readouterr()
        assert shown.err.startswith("You asked for an error of 0.0001, but the budget of 1e6 ev")
        assert shown.out.startswith(begin)
        assert not recwarn  # it is not said twice


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


def test_no_stream_loses_a_result(shell, monkeypatch, capsys):
    """An encoding without its letters, a closed standard error, a full device."""
    expected = shell(*EXACT)
    for encoding in ("ascii", "cp1252"):
        output = TextIOWrapper(io.BytesIO(), encoding)
        with monkeypatch.context() as patch:
            patch.setattr(sys, "stdout", output)
            assert command(monkeypatch, *EXACT) == 0
        assert output.buffer.getvalue() == expected.encode(encoding, "backslashreplace")
    for words, status, result in ((EXACT, 0, expected), (("exact", *BOX), 2, "")):
        monkeypatch.setattr(sys, "stderr", None)
        assert command(monkeypatch, *words) == status
        assert capsys.readouterr().out == result
    with open("/dev/full", "w") as full:
        done = python("-X", "utf8", "-m", "twodiscs", *EXACT, stdout=full)
    assert done.returncode == 2
    assert done.stderr == f"{expected}error: standard output: No space left on device\n"


def test_a_closed_output_is_refused_before_the_work(monkeypatch, capsys):
    monkeypatch.setattr(sys, "stdout", None)
    monkeypatch.setattr(twodiscs, "simulate", None)
    assert refused(monkeypatch, capsys, "simulate", *EXACT[1:]) == "standard output is closed"


@pytest.mark.parametrize("words", [EXACT, ("--version",)])
def test_who_reads_may_stop_reading(words):
    reader, writer = os.pipe()
    os.close(reader)
    run = python("-m", "twodiscs", *words, stdout=writer)
    os.close(writer)
    assert run.stderr == ""


ERRORS = [(InputError("two\n  lines"), "two lines"), (OSError("broken"), "broken")]


@pytest.mark.parametrize(("error", "sentence"), ERRORS)
def test_an_error_is_a_sentence(error, sentence, capsys):
    with pytest.raises(SystemExit, match=r"^2$"):
        cli.run(Mock(side_effect=error))
    assert capsys.readouterr().err == f"error: {sentence}\n"


# Builds -----------------------------------------------------------------------------------------


def test_a_new_configuration_is_one_and_is_not_written_over(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert not command(monkeypatch, "new", "my.yaml")
    said = "my.yaml is written. To build it: twodiscs run my.yaml\n"
    assert capsys.readouterr().out == said
    configuration = load(read("my.yaml"))
    (scene,) = configuration.scenes
    assert (scene.name, configuration.results) == ("mine", "results-my")
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
    said = "my.yaml exists already and is not overwritten"
    assert refused(monkeypatch, capsys, "new", "my.yaml") == said
    assert Path("my.yaml").read_text() == text
    for name, run in {"b c": "'b c.yaml'", "FOLDER": "FOLDER.yaml", "RUN": "RUN.yaml"}.items():
        assert not command(monkeypatch, "new", f"{name}.yaml")
        assert load(read(f"{name}.yaml")).results == f"results-{name.replace(' ', '-')}"
        assert Path(f"{name}.yaml").read_text().startswith(f"# twodiscs run {run}\n")


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
    assert refused(monkeypatch, capsys, name, "my.yaml") == f"twodiscs {name} needs {needed}"


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
    with pytest.raises(InputError, match="not 'volme'; did you mean volume"):
        build.command("my.yaml", ["volme"], Path("Snakefile"))


def test_what_cannot_be_built_is_refused(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    scene = "{name: a, box: {width: 1, height: 1}, effects: {field: 1}, watch: {mean_times: true}}"
    Path("a.yaml").write_text(f"scenes: [{scene}]\n")
    of_plain_scenes = "is about a scene without effects, and a.yaml has none"
    said = dict.fromkeys(("tails", "paper", "model"), of_plain_scenes)
    said["volume"] = "cannot be drawn: no scene of a.yaml has its quantities in `watch`"
    for target, reason in said.items():
        assert refused(monkeypatch, capsys, "run", "a.yaml", target) == f"{target} {reason}"
    build.check_targets("a.yaml", ["mean_hop_time", "effects", "check"], load(read("a.yaml")))
    Path("a.yaml").write_text(f"seeed: 1\nseed: x\nscenes: [{scene}]\n")
    assert command(monkeypatch, "run", "a.yaml") == 2
    assert re.fullmatch(
        r"error: a.yaml: the configuration has an unknown key 'seeed'.*\n"
        r"error: a.yaml: seed must be an integer .*, not 'x'\n",
        capsys.readouterr().err,
    )
    Path("a.yaml").write_text(f"results: a.yaml\nscenes: [{scene}]\n")
    assert refused(monkeypatch, capsys, "run", "a.yaml").startswith("results must be ")
    assert refused(monkeypatch, capsys, "run", "b.yaml") == "b.yaml: No such file or directory"


def test_targets_may_stand_behind_options(monkeypatch, capsys):
    given = []
    monkeypatch.setattr(build, "build", lambda path, **words: given.append((path, words)))
    words = "run", "my.yaml", "volume", "-n", "pressure", "--cores", "2"
    assert not command(monkeypatch, *words)
    options = {"targets": ["volume", "pressure"], "cores": 2}
    flags = {"dry_run": True, "unlock": False, "force": False}
    assert given == [("my.yaml", options | flags)]


def dag(*targets, made=()):
    """Return what ``closing`` asks of Snakemake: jobs that are targets, and the files made."""
    jobs = [
        SimpleNamespace(rule=SimpleNamespace(name=name), output=output, input=files)
        for name, output, files in targets
    ]
    return SimpleNamespace(targetjobs=jobs, jobs=[SimpleNamespace(output=made)])


def test_a_build_ends_with_what_is_older_than_its_configuration_or_missed(tmp_path, monkeypatch):
    """The verdict of another build may be in the folder; test_build has one of its own."""
    passed, mine, other = (tmp_path / name for name in ("check.passed", "my.yaml", "other.yaml"))
    (tmp_path / "report.html").touch()
    for path, moment in ((passed, 1), (mine, 2), (other, 0)):
        path.touch()
        os.utime(path, (moment, moment))
    old = f"{passed} is older than the configuration; the target check renews it\n"
    for configured in ([mine], [mine, other], [other, mine]):
        assert build.closing(tmp_path, dag(), configured) == old
    assert old not in build.closing(tmp_path, dag(made=[passed]), [mine])
    # Accuracies that were not reached, of the scenes whose times were built.
    monkeypatch.setattr(build, "missed", lambda results, scene: [f"{scene['name']}: missed"])
    made, scenes = [tmp_path / "a" / "mean_times.csv"], [{"name": "a"}, {"name": "b"}]
    assert build.closing(tmp_path, dag(made=made), [mine], scenes) == f"{old}a: missed\n"


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
    monkeypatch.setattr(build, "LEAST_FREE_BYTES", math.inf)
    full = f"error: no space is left on the disk of {tmp_path}"
    for one, reasons in ((workflow, lines), (None, [])):
        assert build.failure(one, 1, tmp_path).splitlines() == [full, *reasons, again]


def _interrupted():
    """As Snakemake does: it ends its jobs after Ctrl-C, then itself."""
    with suppress(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)
    sys.exit(1)


@pytest.fixture
def run(tmp_path, monkeypatch):
    """A function that runs scene a in an empty folder, with another ``main`` of Snakemake."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("snakemake.workflow.workflow", None, raising=False)
    Path("a.yaml").write_text("scenes: [{name: a, box: {width: 1, height: 1}}]\n")

    def run(main, *words):
        monkeypatch.setattr("snakemake.cli.main", Mock(side_effect=main))
        return command(monkeypatch, "run", "a.yaml", *words)

    return run


@pytest.mark.parametrize(
    ("end", "status", "said"), [(_interrupted, 130, "Stopped; the same"), (SystemExit(3), 3, "")]
)
def test_a_run_has_the_status_of_its_end(end, status, said, run, capsys):
    assert run(end) == status
    assert capsys.readouterr().err.startswith(said)


def test_a_run_keeps_the_build_of_other_scenes(run, capsys):
    Path("results").mkdir()
    kept, end = Path("results/configuration.json"), SystemExit(3)  # which is after the check
    for text, status in (('{"scenes": [{"name": "b"}]}', 2), ('{"scenes": [{"name": "a"}]}', 3)):
        kept.write_text(text)
        assert run(end) == status
    assert "not 'results', which has the scenes b; with --force" in capsys.readouterr().err
    kept.write_text('{"scenes": [{"name": "b"}]}')
    for option in ("--force", "--dry-run", "--unlock"):
        assert run(end, option) == 3
    for text in ("[]", "{", '{"scenes": [1]}'):
        kept.write_text(text)
        assert run(end) == 3


@pytest.mark.parametrize("closed", ["", "results"])
def test_a_run_says_which_folder_cannot_be_written_to(closed, run, tmp_path, monkeypatch, capsys):
    (tmp_path / closed).mkdir(exist_ok=True)
    monkeypatch.setattr(os, "access", lambda path, mode: Path(path) != tmp_path / closed)
    assert run(SystemExit(3)) == 2
    said = f"error: {tmp_path / closed} must be a folder that can be written to\n"
    assert capsys.readouterr().err == said


def test_a_dry_run_names_the_first_file_that_was_edited():
    """test_run has a dry run after which files are missing."""
    reason, jobs = Reason(), [SimpleNamespace(rule=SimpleNamespace(name="table"), wildcards={})]
    reason.updated_input.update(["b.py", "a.py"])
    dag = SimpleNamespace(needrun_jobs=lambda exclude_finished: jobs, reason=lambda job: reason)
    assert build.planned(dag).endswith(" updated input files: a.py\n")
    jobs.clear()
    assert build.planned(dag) == "All files are up to date.\n"


def test_a_build_ends_with_the_files_of_its_targets(tmp_path):
    targets = [("pressure", [], ["a.pdf", "a.png"]), ("explorer", ["e.html"], ["e.js"])]
    targets += [("report", ["r.html"], []), ("default", [], ["r.html"]), ("check", ["c"], [])]
    lines = build.closing(tmp_path, dag(*targets), [])
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


@pytest.mark.parametrize("line", COMPLETED)
def test_a_shell_completes(line, tmp_path, monkeypatch):
    """In a copy of this process, which ends without a word."""
    monkeypatch.chdir(REPOSITORY)
    for name, value in {
        "_ARGCOMPLETE": "1", "_ARGCOMPLETE_IFS": "\n", "_ARGCOMPLETE_SUPPRESS_SPACE": "1",
        "_ARGCOMPLETE_STDOUT_FILENAME": str(tmp_path / "proposed"), "COMP_TYPE": "9",
        "COMP_LINE": line, "COMP_POINT": str(len(line)),
    }.items():  # fmt: skip
        monkeypatch.setenv(name, value)
    copy = get_context("fork").Process(target=cli.main)
    copy.start()
    copy.join(60)
    assert (tmp_path / "proposed").read_text() == COMPLETED[line]
