"""Without these tests ``twodiscs run`` could read files of others, or print another verdict."""

import json
import os
import subprocess
import sys

import pytest
from checkout import Checkout, first

from twodiscs_paper.configuration.new import new
from twodiscs_paper.configuration.yaml_files import read


@pytest.fixture
def place(unbuilt, tmp_path, monkeypatch):
    """A folder with a new configuration, as a user has it."""
    monkeypatch.chdir(tmp_path)
    new("my.yaml")
    return Checkout(tmp_path, unbuilt)


def run(place, *words):
    """Return the completed process of ``twodiscs run my.yaml`` and more ``words``."""
    return subprocess.run(
        [sys.executable, "-P", "-m", "twodiscs", "run", "my.yaml", *words],
        cwd=place.path,
        env=os.environ | {"PYTHONPATH": first(str(place.home.path / "src"))},
        capture_output=True,
        text=True,
        check=True,
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
