"""Without these tests a mistake in the configuration could be a traceback, or begin to build."""

import re

import pytest
from checkout import Checkout

#: One mistake for each place that can find one; other tests check the sentences.
MISTAKES = {
    "an unknown key": ("seeed: 1\n", "unknown key 'seeed'"),
    "a key given twice": ("seed: 1\nseed: 2\n", "second time"),
    "no room for starts": (
        "scenes: [{name: a, box: {width: 1, height: 1}, effects: {field: 900}}]\n",
        "of all positions, and at least",
    ),
    "results in a file": ("results: Snakefile\n", "results must be"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_one_sentence(unbuilt, mistake, tmp_path):
    text, said = MISTAKES[mistake]
    (tmp_path / "bad.yaml").write_text(text)
    (unbuilt.path / "results").mkdir(exist_ok=True)
    before = unbuilt.results()
    run = unbuilt.snakemake("--dry-run", "--configfile", str(tmp_path / "bad.yaml"), passes=False)
    assert run.returncode != 0
    sentences = [line for line in run.stderr.splitlines() if line.startswith("Configuration: ")]
    assert len(sentences) == 1
    assert said in sentences[0]
    assert run.stderr.rstrip().endswith(sentences[0])
    assert "Traceback" not in run.stdout + run.stderr
    assert unbuilt.results() == before


def test_a_file_that_cannot_be_read(unbuilt, tmp_path):
    """It is read before Snakemake reads it."""
    folder = Checkout(tmp_path, unbuilt)
    folder.configuration.parent.mkdir()
    folder.configuration.write_text("results: a\nseed: caf\udce9\n", errors="surrogateescape")
    run = folder.snakemake("-n", passes=False)
    assert run.returncode != 0
    said = "Configuration: config/config.yaml: must be UTF-8, which has no byte 0xe9 here"
    assert said in run.stderr.splitlines()
    assert "Traceback" not in run.stdout + run.stderr


def test_a_mistake_on_the_command_line(unbuilt):
    run = unbuilt.snakemake("--dry-run", "--config", "seed=abc", passes=False)
    assert run.returncode != 0
    assert "Configuration: seed must be" in run.stderr


def test_a_misspelt_target_gets_the_name_that_is_closest(unbuilt):
    run = unbuilt.snakemake("--dry-run", "mean_hop_times", passes=False)
    assert run.returncode != 0
    assert "'mean_hop_times' is no target; did you mean 'mean_hop_time'?" in run.stdout


def test_days_of_processor_time_are_written_without_an_exponent(unbuilt, tmp_path):
    path = tmp_path / "long.yaml"
    path.write_text(
        "shard_events: 1e15\n"
        "scenes: [{name: a, box: {width: 1.5, height: 1}, radii: [0.1, 0.2, 0.3],"
        " watch: {mean_times: true}, accuracy: 2e-7, event_budget: 1e15}]\n"
    )
    run = unbuilt.snakemake("--dry-run", "--configfile", str(path), "--", "results/a/theory.csv")
    (days,) = re.findall(r"takes about (\S+) days of processor time", run.stdout + run.stderr)
    assert len(days) == 3
    assert 100 < int(days) < 1000
