"""Mistakes in a configuration, before anything is built.

Without these tests a mistake in the configuration could be a traceback, or begin to build.
"""

import shutil

import pytest
from checkout import Checkout, folder, one_scene

#: One mistake for each place that can find one; other tests check the sentences.
MISTAKES = {
    "a key given twice": ("seed: 1\nseed: 2\n", "second time"),
    "no room for starts": (
        "scenes: [{name: a, box: {width: 1, height: 1}, effects: {field: 900}}]\n",
        "of all positions, and at least",
    ),
    "results in a file": ("results: Snakefile\n", "results must be"),
}


def assert_refused(place, said, *words):
    """Assert that a dry run ends with one sentence, which has the words ``said``."""
    before = place.results()
    run = place.snakemake("--dry-run", *words, passes=False)
    (sentence,) = (line for line in run.stderr.splitlines() if line.startswith("Configuration: "))
    assert said in sentence
    assert "Traceback" not in run.stdout + run.stderr
    assert place.results() == before
    return run.stderr


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_one_sentence(unbuilt, mistake, tmp_path):
    text, said = MISTAKES[mistake]
    (tmp_path / "bad.yaml").write_text(text)
    (unbuilt.path / "results").mkdir(exist_ok=True)
    shown = assert_refused(unbuilt, said, "--configfile", str(tmp_path / "bad.yaml"))
    assert shown.splitlines()[-1].startswith("Configuration: ")


def test_a_file_that_cannot_be_read_and_a_mistake_on_the_command_line(unbuilt, tmp_path):
    """The file is read before Snakemake reads it."""
    assert_refused(unbuilt, "seed must be", "--config", "seed=abc")
    place = folder(tmp_path, unbuilt, {})
    place.configuration.write_text("seed: caf\udce9\n", errors="surrogateescape")
    assert_refused(place, "config/config.yaml, line 1: save the file as UTF-8, which has no")


#: A scene that takes days, and does not reach its accuracy.
LONG = {"watch": {"mean_times": ["any_wall"]}, "accuracy": 1e-7, "event_budget": 1e13}


def test_a_dry_run_names_the_closest_target_the_days_and_accuracies_not_reached(unbuilt, tmp_path):
    place = folder(tmp_path, unbuilt, one_scene("a", radii=[0.2], **LONG))
    run = place.snakemake("--dry-run", "mean_wall_times", "--report", "report.zip", passes=False)
    assert "'mean_wall_times' is no target; did you mean 'mean_wall_time'?" in run.stdout
    assert run.stdout.count("is no target") == 1
    assert "This configuration takes about 1.2 days of processor time." in run.stdout
    assert "a, radius 0.2: You asked for an error of 1e-7, but the budget of 1e13" in run.stdout


def test_the_code_beside_the_workflow_is_the_code_that_runs(unbuilt, tmp_path):
    """In a second checkout, with the environment of the first, nothing runs."""
    for part in ("workflow", "config", "src/twodiscs"):
        shutil.copytree(unbuilt.path / part, tmp_path / part)
    code = f"the code in {tmp_path}/src/twodiscs would not run, because {unbuilt.path}/src/twodiscs"
    snakefile = "--snakefile", str(tmp_path / "workflow/Snakefile")
    place = Checkout(tmp_path, unbuilt)
    for run in (
        place.snakemake(*snakefile, "--dry-run", "all", passes=False),
        place.twodiscs_run("config/config.yaml", passes=False),
    ):
        assert run.stderr.splitlines()[-1].removeprefix("error: ").startswith(code)


def test_the_cache_of_snakemake_is_refused(unbuilt):
    """It would take the grid of a scene for its exact values: wildcards are no parameters."""
    run = unbuilt.snakemake("--dry-run", "--cache", "exact", "--", "all", passes=False)
    assert run.stderr.splitlines()[-1].startswith("--cache must not be given")
