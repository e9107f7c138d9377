"""`twodiscs run`: last lines, exit statuses and folders.

Without these tests ``twodiscs run`` could read files of others, or print another verdict.
"""

import json
import re
import subprocess
import sys

import pytest
import yaml
from checkout import Checkout, folder, fresh, run_twodiscs

from twodiscs_paper.configuration.new import new
from twodiscs_paper.configuration.yaml_files import read


@pytest.fixture
def place(unbuilt, tmp_path, monkeypatch):
    """A folder with a new configuration, as a user has it."""
    monkeypatch.chdir(tmp_path)
    new("my.yaml")
    return Checkout(tmp_path, unbuilt)


def run(place, *words, passes=True):
    """Return the completed process of ``twodiscs run my.yaml`` and more ``words``."""
    done = run_twodiscs(place, "my.yaml", *words)
    assert (done.returncode == 0) == passes, done.stderr
    return done


def last_lines(done):
    """Return the reason and the path of the log in the last lines of a run that failed."""
    *_, reason, log, advice = done.stderr.splitlines()
    assert advice.startswith("Remove the cause; the same command goes on")
    return reason.removeprefix("error: "), log.removeprefix("The log is ")


def test_files_of_another_project_in_the_folder_are_not_read_and_its_verdict_is_not_printed(place):
    """Its configuration and its profile have the names of ours, and modules those of others."""
    for name, text in {
        "config/config.yaml": "{seed: 42, results: theirs, samples: samples.tsv}\n",
        "profiles/default/config.yaml": "no-such-option: true\n",
        "results/check.passed": "old: 3 comparisons passed\n",
        "results/report.html": "",
        **{f"{name}.py": "raise SystemExit('mistaken')\n" for name in ("random", "json", "numpy")},
    }.items():
        (place.path / name).parent.mkdir(parents=True, exist_ok=True)
        (place.path / name).write_text(text)
    done = run(place, "results/configuration.json", "results/mine/grid.csv")
    written = json.loads((place.path / "results/configuration.json").read_text())
    assert written == read(place.path / "my.yaml")
    assert "4 of 4 steps (100%) done" in done.stderr
    assert "rule exact:" not in done.stderr
    assert "old" not in done.stdout
    assert "report" not in done.stdout


def test_a_read_only_home_a_notebook_and_a_profile_are_no_obstacles(place, monkeypatch):
    """A container has no home, a notebook's children its backend, which we may not have."""
    (place.path / "file").touch()
    (place.path / "profile").mkdir()
    (place.path / "profile" / "config.yaml").write_text("cores: 1\n")
    monkeypatch.setenv("HOME", str(place.path / "file" / "home"))
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setenv("MPLBACKEND", "module://a_backend.that_is_not_installed")
    monkeypatch.setenv("SNAKEMAKE_PROFILE", str(place.path / "profile"))
    done = run(place, "model")
    assert "Provided cores: 1 " in done.stderr
    assert (place.path / "results/mine/figures/model.pdf").exists()
    assert (place.path / ".snakemake/cache").exists()


#: A scene of two radii and two stages, which takes seconds.
SMALL = {
    "shared": [],
    "scenes": [
        {
            "name": "small",
            "box": {"width": 1.5, "height": 1.0},
            "radii": [0.1, 0.2],
            "watch": {"mean_times": ["any_wall"], "volume": True},
            "accuracy": 0.1,
            "monte_carlo": {"samples": 1e6},
        }
    ],
}


def test_a_run_that_fails_ends_with_the_reason_its_log_and_what_to_do(place):
    """A table that was cut, a point that was edited and one that was copied over another.

    All else stays, and the work of their jobs replaces them. test_build has a score too high.
    """
    (place.path / "my.yaml").write_text(yaml.safe_dump(SMALL))
    built = run(place, "check").stdout
    assert built.startswith(f"Results: {place.path}/results\n")
    scene, first = place.path / "results/small", place.results()
    table, point, other = (
        scene / name
        for name in ("check.csv", "points/dynamics/0.2.json", "points/dynamics/0.1.json")
    )
    remedy = "; delete it, and it is made again"

    table.write_text("".join(table.read_text().splitlines(keepends=True)[:2]))
    sentence = f"results/small/check.csv is not what its job wrote{remedy}"
    assert last_lines(run(place, "check", passes=False)) == (sentence, "results/logs/check.log")
    table.unlink()
    for text, wrong in (
        (point.read_text().replace("1", "2", 1), "is not what its job wrote"),
        (other.read_text(), "has radius 0.1, but its job asks for 0.2"),
    ):
        point.write_text(text)
        sentence, _ = last_lines(run(place, "check", passes=False))
        assert sentence == f"results/small/points/dynamics/0.2.json {wrong}{remedy}"
    point.unlink()
    assert "small: 8 comparisons passed" in run(place, "check").stdout
    now, again = place.results(), "small/points/dynamics/0.2.json"
    names = {name for name in first if name.endswith(".csv") or "points/" in name} - {again}
    assert len(names) == 4  # the table and three points
    assert {name: now[name] for name in names} == {name: first[name] for name in names}


def test_results_are_where_the_run_is_and_a_build_beside_the_file_is_named(place):
    """A new configuration is the report on mean times at three radii, with key figures."""
    (place.path / "elsewhere").mkdir()
    run(place, "results/configuration.json")
    done = run_twodiscs(Checkout(place.path / "elsewhere", place.home), "../my.yaml", "--dry-run")
    lines = done.stdout.splitlines()
    assert lines[0] == f"Results: {place.path}/elsewhere/results"
    assert lines[1].startswith("../results has a build of this configuration")
    jobs = dict(re.findall(r"^mine +(\w+) +(\d+) +output files have", done.stdout, re.MULTILINE))
    assert jobs == {"exact": "2", "dynamics": "3", "table": "3", "figure": "4"}


def test_an_environment_in_a_folder_with_a_blank_is_no_obstacle(tmp_path):
    """Its Python is a word of each job's command."""
    checkout = fresh(tmp_path / "my paper")
    folder(checkout.path, None, SMALL)
    venv = checkout.path / ".venv"
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", venv], check=True)
    (packages,) = venv.glob("lib/python*/site-packages")
    (packages / "all.pth").write_text(
        f"{checkout.path}/src\nimport sys; sys.path += {sys.path[1:]!r}\n"
    )
    words = "-m", "twodiscs", "run", "config/config.yaml", "results/small/grid.csv", "--cores", "1"
    run = subprocess.run([venv / "bin/python", *words], cwd=checkout.path, check=False)
    assert run.returncode == 0
