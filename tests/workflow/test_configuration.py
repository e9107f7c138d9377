"""Mistakes in the configuration: one sentence, before anything runs, and nothing is changed."""

import pytest
from checkout import Checkout

#: Of every place where one is found one: what each sentence says is tested where it is written.
MISTAKES = {
    "an unknown key": ("seeed: 1\n", "unknown key 'seeed'"),
    "a key given twice": ("seed: 1\nseed: 2\n", "second time"),
    "no room for starts": (
        "scenes: [{name: a, box: {width: 1, height: 1}, effects: {field: 900}}]\n",
        "needs more room",
    ),
    "results in a file": ("results: Snakefile\n", "results must be"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_one_sentence(unbuilt, mistake, tmp_path):
    text, said = MISTAKES[mistake]
    (tmp_path / "bad.yaml").write_text(text)
    (unbuilt.path / "results").mkdir(exist_ok=True)
    before = unbuilt.results()
    run = unbuilt.snakemake(
        "--cores", "1", "--configfile", str(tmp_path / "bad.yaml"), passes=False
    )
    assert run.returncode != 0
    sentences = [line for line in run.stderr.splitlines() if line.startswith("Configuration: ")]
    assert len(sentences) == 1
    assert said in sentences[0]
    assert run.stderr.rstrip().endswith(sentences[0])
    assert "Traceback" not in run.stdout + run.stderr
    assert unbuilt.results() == before


@pytest.mark.parametrize(
    ("own", "text", "said"),
    [
        (False, "results: a\nscenes: [\n", ", line 3: expected the node content"),
        (True, "results: a\nseed: caf\udce9\n", ", line 2: must be UTF-8, not the byte 0xe9"),
    ],
)
def test_a_file_that_cannot_be_read(unbuilt, tmp_path, own, text, said):
    """It is read before Snakemake reads it, the one of ``--configfile`` and that of the folder."""
    folder = Checkout(tmp_path, unbuilt)
    (tmp_path / "config").mkdir()
    path = tmp_path / "config" / ("config.yaml" if own else "other.yaml")
    path.write_text(text, errors="surrogateescape")
    words = [] if own else ["--configfile", str(path)]
    run = folder.snakemake("-n", *words, passes=False)
    assert run.returncode != 0
    assert run.stderr.splitlines()[-1].startswith(f"Configuration: {path}{said}")
    assert "Traceback" not in run.stdout + run.stderr


def test_a_mistake_on_the_command_line(unbuilt):
    run = unbuilt.snakemake("--dry-run", "--config", "seed=abc", passes=False)
    assert run.returncode != 0
    assert "Configuration: seed must be" in run.stderr
