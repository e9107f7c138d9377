"""Mistakes in a configuration, before anything is built.

Without these tests a mistake in the configuration could be a traceback, or begin to build.
"""

import pytest
from checkout import folder

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


def assert_refused(place, said, *words):
    """Assert that a dry run ends with one sentence, which has the words ``said``."""
    before = place.results()
    run = place.snakemake("--dry-run", *words, passes=False)
    assert run.returncode != 0
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
    assert_refused(place, "config/config.yaml: must be UTF-8, which has no byte 0xe9 here")


def test_a_misspelt_target_gets_the_name_that_is_closest(unbuilt):
    run = unbuilt.snakemake("--dry-run", "mean_hop_times", passes=False)
    assert run.returncode != 0
    assert "'mean_hop_times' is no target; did you mean 'mean_hop_time'?" in run.stdout
