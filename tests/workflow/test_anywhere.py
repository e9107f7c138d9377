"""The workflow in another folder, as a module, and in a storage.

Without these tests the workflow might build in its own folder only, or not as a module.

The configuration here is tiny, and what one build has made is copied for the others.
"""

import json
import shutil

import pytest
import yaml
from checkout import BELOW, Checkout, folder, fresh, one_scene, use

TINY = one_scene(
    *("tiny", ["errata", "report"]),
    radii=[0.1],
    watch={"areas": ["top_wall"], "mean_times": ["top_wall"]},
    accuracy=0.5,
    event_budget=1,
    monte_carlo={"samples": 1},
)

#: With blanks, quotes and a command: shell lines quote every path.
NAME = "a b $(touch X) 'c'"


def manifest(place, results="results"):
    """Return the fingerprints of all results that are the same bytes on every run."""
    return (place.path / results / "manifest.sha256").read_text()


@pytest.fixture(scope="module")
def own(tmp_path_factory):
    """A folder with a configuration of its own, in which everything is built.

    No shell may read its name, or that of the checkout which builds it, as a command.
    """
    home = fresh(tmp_path_factory.mktemp("home") / NAME)
    place = folder(tmp_path_factory.mktemp("place") / NAME, home, TINY)
    nowhere = Checkout(tmp_path_factory.mktemp("nowhere"), place.home)
    nowhere.snakemake("--directory", str(place.path), "--cores", "2")
    assert [*nowhere.path.iterdir()] == []
    return place


@pytest.mark.slow
def test_with_a_configuration_of_its_own_everything_is_built_in_that_folder(own):
    names = {*own.results()}
    assert {"check.passed", "report.html", "manifest.sha256", "tiny/areas.csv"} <= names
    assert "paper.pdf" not in names
    assert not (own.home.path / "results").exists()
    assert own.jobs() == []
    for parent in (own.path.parent, own.home.path.parent):
        assert not [*parent.rglob("X")]


def test_every_path_in_a_shell_line_is_quoted(tmp_path):
    """Jobs that take longer have these command lines, from a folder with such a name."""
    targets = "all", "explorer", "benchmark", "effects"
    dry = "--dry-run", "--forceall", "--printshellcmds", "--", *targets
    lines = fresh(tmp_path / "a b $(touch X)").snakemake(*dry).stdout
    shells = [line for line in lines.splitlines() if "Shell command:" in line]
    assert len(shells) > 10
    for line in shells:
        assert "touch X" not in "".join(line.split("'")[::2])


@pytest.mark.slow
def test_as_a_module_it_builds_in_a_folder_with_a_prefix(own, tmp_path):
    place = Checkout(tmp_path, own.home)
    use(place, TINY, BELOW)
    place.snakemake("--cores", "2", "--", "discs_all", "mine.txt")
    assert manifest(place, "below/results") == manifest(own)
    assert {*place.results("below/results")} == {*own.results()}
    assert (tmp_path / "mine.txt").read_text().startswith("tiny: ")
    assert json.loads((tmp_path / "below/results/configuration.json").read_text()) == TINY
    names = {"Snakefile", "mine.yaml", "mine.txt", "below", ".snakemake"}
    assert {path.name for path in tmp_path.iterdir()} == names
    # The configuration may come from the command, and a report needs no cores.
    place.replace("Snakefile", 'configfile: "mine.yaml"', "")
    assert place.jobs("--configfile", "mine.yaml", "--", "discs_all") == []
    place.snakemake("--configfile", "mine.yaml", "--report", "report.html")
    assert "check.csv" in (tmp_path / "report.html").read_text()


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("rsync") is None, reason="the plugin of the storage needs rsync")
def test_in_a_storage_it_makes_the_same_files(own, tmp_path):
    pytest.importorskip("snakemake_storage_plugin_fs", reason="the extra `cluster` is absent")
    store = Checkout(tmp_path / "store")
    place = folder(tmp_path / "place", own.home, TINY)
    storage = "--default-storage-provider", "fs", "--default-storage-prefix", str(store.path)
    place.snakemake("--cores", "2", *storage)
    assert manifest(store) == manifest(own)
    assert {*own.results()} == {*store.results()}
    assert place.jobs(*storage) == []
    (store.path / "results" / "tiny" / "check.csv").unlink()
    assert {"table", "check"} <= {rule for rule, _ in place.jobs(*storage)}


@pytest.mark.parametrize("more", ['config:\n        config["discs"]', ""])
def test_a_module_plans_every_job_of_the_default_configuration(unbuilt, planned, tmp_path, more):
    place = Checkout(tmp_path, unbuilt)
    use(place, yaml.safe_load(unbuilt.configuration.read_text()), more)
    alone = [(f"discs_{rule}", wildcards) for rule, wildcards in planned]
    assert place.jobs("discs_all") == sorted([*alone, ("discs_all", ())])
