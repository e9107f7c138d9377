"""The RO-Crate of results: the library reads it back."""

import json
import warnings

import pytest
from checkout import REPOSITORY
from commands import command
from factory import BOX

from twodiscs.arguments import box_arguments
from twodiscs.points.digests import digest
from twodiscs_paper.pipeline.documents import crate
from twodiscs_paper.pipeline.jobs import figure, table

pytest.importorskip("rocrate", reason="rocrate, of the extra workflow, is not installed")

FILES = ("theory.csv", "figures/model.pdf", "figures/model.png", "configuration.json")
MADE = {
    "commit": "0123456789ab",
    "changed_since_the_commit": True,
    "versions": {"python": "3.11.7", "snakemake": "9.27.1"},
    "first_file": "2026-01-02T03:04:05+00:00",
    "last_file": "2026-01-02T03:14:15+00:00",
}


@pytest.fixture
def results(tmp_path, monkeypatch):
    """A folder of results, by their jobs."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "results" / "figures").mkdir(parents=True)
    box = box_arguments(BOX)
    words = "theory", *box, "--radii", 0.1, "--output", "results/theory.csv"
    assert command(monkeypatch, table, *words) == 0
    drawn = [f"results/{name}" for name in FILES if "figures" in name]
    assert command(monkeypatch, figure, "model", *box, "--output", *drawn) == 0
    (tmp_path / "results" / "configuration.json").write_text("{}")
    (tmp_path / "results" / "provenance.json").write_text(json.dumps(MADE))
    return tmp_path / "results"


def make(monkeypatch):
    words = [f"results/{name}" for name in FILES]
    workflow = REPOSITORY / "workflow"
    words += ["--texts", workflow / "Snakefile", workflow / "rules" / "scenes.smk"]
    words += ["--provenance", "results/provenance.json"]
    words += ["--citation", REPOSITORY / "CITATION.cff"]
    words += ["--output", "results/ro-crate-metadata.json"]
    return command(monkeypatch, crate, *map(str, words))


def read(folder):
    """Return the crate as the library reads it; every file in it is there and has its hash."""
    from rocrate.rocrate import ROCrate

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = ROCrate(folder)
    for one in found.data_entities:
        path = folder / one.id
        assert one["sha256"] == digest(path), one.id
        assert one["contentSize"] == str(path.stat().st_size), one.id
    return found


def test_the_library_reads_what_made_what(results, monkeypatch):
    assert make(monkeypatch) == 0
    found = read(results)
    texts = {"_workflow/Snakefile", "_workflow/scenes.smk"}
    assert {one.id for one in found.data_entities} == {*FILES, *texts}
    assert found.mainEntity.id == "_workflow/Snakefile"
    assert found.mainEntity["version"].endswith("commit 0123456789ab with changes")
    assert found.root_dataset["license"].id == "https://spdx.org/licenses/MIT"
    assert found.root_dataset["author"]["name"] == "the twodiscs authors"
    action = found.root_dataset["mentions"]
    assert action["instrument"] is found.mainEntity
    assert action["object"].id == "configuration.json"
    assert sorted(one.id for one in action["result"]) == sorted(FILES[:3])
    assert (action["startTime"], action["endTime"]) == (MADE["first_file"], MADE["last_file"])
    assert found.get("theory.csv")["description"].startswith("One row per radius")


def test_the_same_results_give_the_same_bytes(results, monkeypatch):
    assert make(monkeypatch) == 0
    before = (results / "ro-crate-metadata.json").read_bytes()
    assert make(monkeypatch) == 0
    assert (results / "ro-crate-metadata.json").read_bytes() == before
