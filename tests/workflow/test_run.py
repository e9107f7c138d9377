"""`twodiscs run`: last lines, exit statuses and folders.

Without these tests ``twodiscs run`` could read files of others, or print another verdict.
"""

import json
import os
import shutil
import subprocess
import sys

import pytest
import yaml
from checkout import Checkout, first

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
    return subprocess.run(
        [sys.executable, "-P", "-m", "twodiscs", "run", "my.yaml", *words],
        cwd=place.path,
        env=os.environ | {"PYTHONPATH": first(str(place.home.path / "src"))},
        capture_output=True,
        text=True,
        check=passes,
    )


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
        assert build(1, "mine", passes=False).returncode != 0
        logs = [path.read_text() for path in (place.path / "mine/logs/small").glob("*.log")]
        (said,) = (text for text in logs if text)
        sentence = said.splitlines()[-1]
        assert f"{target}.json has {wrong}" in sentence
        assert sentence.endswith("; delete it, and it is made again")
        now = place.results("mine")
        kept = {name for name in before if "points/" in name} - {f"small/points/{target}.json"}
        assert {name: now[name] for name in kept} == {name: before[name] for name in kept}
        (points / f"{target}.json").unlink()
        build(1, "mine")
        for name in ("mean_times", "volume"):
            assert place.results("mine")[f"small/{name}.csv"] == first[f"small/{name}.csv"]
