"""`twodiscs run`: last lines, exit statuses and folders.

Without these tests ``twodiscs run`` could read files of others, or print another verdict.
"""

import json
import shutil
import subprocess
import sys

import pytest
import yaml
from checkout import Checkout, folder, fresh, run_twodiscs

from twodiscs.points.base import digest_line
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


def test_a_new_configuration_is_the_report_on_mean_times(place):
    found = place.jobs("--configfile", "my.yaml", "--", "report")
    rules = {rule for rule, _ in found}
    assert rules == {"exact", "dynamics", "table", "figure", "check", "configuration", "report"}
    assert {f"figure={name}" for name in ("mean_hop_time", "mean_collision_time")} < {
        wildcard for _, wildcards in found for wildcard in wildcards
    }


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


def test_a_point_of_other_work_that_was_copied_in_place_is_refused(place):
    """It has another radius, seed or method. All else stays, and its own work replaces it."""

    def build(seed, results, **options):
        (place.path / "my.yaml").write_text(
            yaml.safe_dump(SMALL | {"seed": seed, "results": results})
        )
        tables = (f"{results}/small/{name}.csv" for name in ("mean_times", "volume"))
        return run(place, *tables, **options)

    for seed, results in ((1, "mine"), (2, "theirs")):
        build(seed, results)
    first, points = place.results("mine"), place.path / "mine/small/points"
    for source, target, wrong in (
        ("mine/small/points/dynamics/0.2", "dynamics/0.1", "radius 0.2, but its job asks for 0.1"),
        ("theirs/small/points/dynamics/0.1", "dynamics/0.1", "seed 2, but its job asks for 1"),
        ("mine/small/points/dynamics/0.2", "monte_carlo/0.2", "kind 'simulate', but its job asks"),
    ):
        before = place.results("mine")
        shutil.copy(place.path / f"{source}.json", points / f"{target}.json")
        sentence, _ = last_lines(build(1, "mine", passes=False))
        assert f"{target}.json has {wrong}" in sentence
        assert sentence.endswith("; delete it, and it is made again")
        now = place.results("mine")
        kept = {name for name in before if "points/" in name} - {f"small/points/{target}.json"}
        assert {name: now[name] for name in kept} == {name: before[name] for name in kept}
        (points / f"{target}.json").unlink()
        build(1, "mine")
        for name in ("mean_times", "volume"):
            assert place.results("mine")[f"small/{name}.csv"] == first[f"small/{name}.csv"]


def test_a_run_that_fails_ends_with_the_reason_its_log_and_what_to_do(place):
    """A table that was cut, a score that is too high, and a point that was edited."""
    (place.path / "my.yaml").write_text(yaml.safe_dump(SMALL))
    built = run(place, "check").stdout
    assert built.startswith(f"Results: {place.path}/results\n")
    scene, edited = place.path / "results/small", "is not what its job wrote; delete it, and it is"
    table, point = scene / "check.csv", scene / "points/dynamics/0.2.json"

    header, row, *rows = table.read_text().splitlines(keepends=True)
    table.write_text("".join([header, row]))
    of_check = "results/logs/check.log"
    expected = f"results/small/check.csv {edited} made again", of_check
    assert last_lines(run(place, "check", passes=False)) == expected
    cells = dict(zip(header.split(","), row.split(","), strict=True)) | {"z": "77"}
    table.write_text("".join([header, ",".join(cells.values()), *rows]))
    (place.path / "results/logs/small/check.log").write_text(digest_line(table))
    reason, log = last_lines(run(place, "check", passes=False))
    assert reason.startswith(
        "small: comparison volume, quantity volume, method monte_carlo, radius"
    )
    assert log == of_check
    table.unlink()
    point.write_text(point.read_text().replace("1", "2", 1))
    expected = f"results/small/points/dynamics/0.2.json {edited} made again"
    assert last_lines(run(place, "check", passes=False))[0] == expected
    point.unlink()
    assert "small: 8 comparisons passed" in run(place, "check").stdout


def test_results_are_where_the_run_is_and_a_build_beside_the_file_is_named(place):
    (place.path / "elsewhere").mkdir()
    run(place, "results/configuration.json")
    words = "../my.yaml", "--dry-run", "check"
    lines = run_twodiscs(Checkout(place.path / "elsewhere", place.home), *words).stdout.splitlines()
    assert lines[0] == f"Results: {place.path}/elsewhere/results"
    assert lines[1].startswith("../results has a build of this configuration")


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
