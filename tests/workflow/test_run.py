"""`twodiscs run`: last lines, exit statuses and folders.

Without these tests ``twodiscs run`` could read files of others, or print another verdict.
"""

import json
import os
import re
import shlex
import shutil

import pytest
import yaml
from checkout import Checkout, first, one_scene
from commands import python

import twodiscs as td
from twodiscs.points.base import require_logged
from twodiscs_paper.configuration.new import new
from twodiscs_paper.configuration.yaml_files import read


@pytest.fixture
def place(unbuilt, tmp_path, monkeypatch):
    """A folder with a new configuration, as a user has it."""
    monkeypatch.chdir(tmp_path)
    new("my.yaml")
    return Checkout(tmp_path, unbuilt)


def test_files_of_another_project_a_read_only_home_a_notebook_and_a_profile_are_no_obstacles(place):
    """Its configuration and its profile have the names of ours, and modules those of others.

    A container has no home, a notebook's children its backend, which we may not have.
    """
    for name, text in {
        "config/config.yaml": "{seed: 42, results: theirs, samples: samples.tsv}\n",
        "profiles/default/config.yaml": "no-such-option: true\n",
        "profile/config.yaml": "cores: 1\n",
        "results-my/check.passed": "old: 3 comparisons passed\n",
        "results-my/report.html": "",
        "file": "",
        **{f"{name}.py": "raise SystemExit('mistaken')\n" for name in ("random", "json", "numpy")},
    }.items():
        place.edit(name, text)
    environment = {name: text for name, text in os.environ.items() if name != "XDG_CACHE_HOME"} | {
        "HOME": str(place.path / "file" / "home"),
        "MPLBACKEND": "a_backend_that_is_not_installed",
        "PYTHONPATH": first(str(place.home.path / "src")),
        "SNAKEMAKE_PROFILE": str(place.path / "profile"),
    }
    targets = "results-my/configuration.json", "results-my/mine/grid.csv", "model"
    done = python("-P", "-m", "twodiscs", "run", "my.yaml", *targets, env=environment)
    assert done.returncode == 0, done.stderr
    written = json.loads((place.path / "results-my/configuration.json").read_text())
    assert written == read(place.path / "my.yaml")
    assert "Provided cores: 1 " in done.stderr
    assert "7 of 7 steps (100%) done" in done.stderr
    assert "rule exact:" not in done.stderr
    assert "old" not in done.stdout
    assert "report" not in done.stdout
    assert (place.path / "results-my/mine/figures/model.pdf").exists()
    assert (place.path / ".snakemake/cache").exists()


def test_a_run_that_fails_ends_with_the_reason_its_log_and_what_to_do(built):
    """A table that was cut, and a point that was copied over another.

    All else stays, and the work of their jobs replaces them. test_build has a score too high.
    """
    configuration, results, before = "config/config.yaml", built.path / "results", built.results()
    table, again = results / "full/check.csv", "full/points/dynamics/0.3.json"
    cut = "results/full/check.csv is not what its job wrote; delete it, and it is made again"

    def last_lines():
        return built.twodiscs_run(configuration, "check", passes=False).stderr.splitlines()[-3:]

    # A picture that another one was copied over is not believed.
    one, other = (results / f"full/figures/{name}.pdf" for name in ("mean_hop_time", "volume"))
    shutil.copy(one, other)
    with pytest.raises(td.InputError, match=r"volume\.pdf is not what its job wrote"):
        require_logged(other)
    other.unlink()
    table.write_text("".join(table.read_text().splitlines(keepends=True)[:2]))
    reason, log, advice = last_lines()
    assert (reason, log) == (f"error: {cut}", "The log is results/logs/check.log")
    assert advice.startswith("Remove the cause; the same command goes on")
    # It is in no manifest, and not loaded.
    run = built.snakemake("--cores", "1", "manifest", passes=False)
    assert cut in run.stdout + run.stderr
    with pytest.raises(td.InputError, match=cut):
        td.load(table.parent)
    table.unlink()
    shutil.copy(results / "full/points/dynamics/0.2.json", results / again)
    reason, *_ = last_lines()
    wrong = f"results/{again} has radius 0.2, but its job asks for 0.3"
    assert reason == f"error: {wrong}; delete it, and it is made again"
    (results / again).unlink()
    done = built.twodiscs_run(configuration, "check").stdout
    assert done.startswith(f"Results: {results}\n")
    assert before["check.passed"].decode() in done.replace("\n  ", "\n")
    now = built.results()
    names = {name for name in before if re.match(r"full/(\w+.csv|points)", name)} - {again}
    assert {name: now[name] for name in names} == {name: before[name] for name in names}


def test_results_are_where_the_run_is_and_a_build_beside_the_file_is_named(place):
    """A new configuration is the report on mean times at three radii, with key figures."""
    (place.path / "elsewhere").mkdir()
    place.edit("results-my/configuration.json", json.dumps(read("my.yaml")))
    done = Checkout(place.path / "elsewhere", place.home).twodiscs_run("../my.yaml", "--dry-run")
    lines = done.stdout.splitlines()
    assert lines[0] == f"Results: {place.path}/elsewhere/results-my"
    assert lines[1].startswith("../results-my has a build of this configuration")
    jobs = dict(re.findall(r"^mine +(\w+) +(\d+) +output files have", done.stdout, re.MULTILINE))
    assert jobs == {"exact": "2", "dynamics": "3", "table": "3", "figure": "4"}


@pytest.mark.slow
def test_every_command_of_a_report_runs_where_the_report_was_made(built):
    """One report is of the folder's configuration, the other of the reader's own file there."""
    scene = one_scene("own", radii=[0.3], accuracy=1e-2, watch={"mean_times": ["right_wall"]})
    built.edit("my.yaml", yaml.safe_dump(scene | {"results": "results-my"}))
    built.twodiscs_run("my.yaml")
    for folder, number in (("results", 3), ("results-my", 1)):
        page = (built.path / folder / "report.html").read_text(encoding="utf-8")
        commands = re.findall(r"<code>((?:snakemake|twodiscs) .*?)</code>", page)
        assert len(commands) == number
        for line in commands:
            built.completed(True, *shlex.split(line))
