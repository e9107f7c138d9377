"""A small soak: a build that is killed and damaged, and one that does not recover."""

import sys

import pytest
from checkout import REPOSITORY

from twodiscs.pipeline import soak

TINY = {
    "shared": [],
    "scenes": [
        {
            "name": "one",
            "box": {"width": 1.5, "height": 1.0},
            "radii": [0.2],
            "watch": {"volume": True},
            "monte_carlo": {"samples": 1},
        }
    ],
}
SNAKEMAKE = [sys.executable, "-m", "snakemake", "--snakefile", str(REPOSITORY / "Snakefile")]

#: Writes a table unless there is one, whatever it holds.
CARELESS = """
import pathlib
from twodiscs.pipeline.results import record
path = pathlib.Path("results/a.csv")
path.parent.mkdir(exist_ok=True)
if not path.exists():
    path.write_text("a\\n1\\n")
    record.write([path], {})
"""


@pytest.mark.slow
def test_a_small_build_survives(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("PYTHONPATH", str(REPOSITORY / "src"))
    command = [*SNAKEMAKE, "--cores", "2", "results/one/grid.csv", "results/one/theory.csv"]
    build = soak.Soak(tmp_path / "build", command, 3, TINY)
    strikes = (
        (how.__name__, how(*words))
        for how, *words in ((build.kill, "SIGKILL", "session"), (build.damage, "edited"))
    )
    assert soak.soak(strikes, 600) == 0, capsys.readouterr().err
    assert "damage                       1 of 1 survived" in capsys.readouterr().out


def test_what_does_not_recover_is_told(tmp_path, capsys):
    build = soak.Soak(tmp_path / "build", [sys.executable, "-c", CARELESS], 1)
    assert soak.soak([("edit", build.damage("edited"))], 600) == 1
    assert "; .record/a.csv.json differs" in capsys.readouterr().err


def test_a_build_that_fails_undisturbed_is_no_start(tmp_path):
    with pytest.raises(RuntimeError, match="the undisturbed build fails:\nno luck"):
        soak.Soak(tmp_path / "build", [sys.executable, "-c", "exit('no luck')"], 1)


def test_what_a_failed_job_left_is_not_finished():
    """Snakemake writes its metadata all the same, and a job may outlive its shell."""
    said = """
[Sun Nov 22 08:00:00 2026]
rule grid:
    output: results/one/grid.csv
    jobid: 2

[Sun Nov 22 08:00:01 2026]
Error in rule figure:
    message: None
    jobid: 3
    output: results/one/figures/model.pdf, results/one/figures/model.png
    log: results/logs/one/figure-model.log (check log file(s) for error details)
"""
    figures = "results/one/figures"
    assert soak.failed(said) == {f"{figures}/model.pdf", f"{figures}/model.png"}
    assert soak.failed("") == set()
