"""The record of the jobs: what changed since is found, named, made again and never certified."""

import json
import os
import shutil
from base64 import urlsafe_b64encode
from pathlib import Path

import pytest
from fabricated import BOX, command

from twodiscs.model.checks import InputError
from twodiscs.pipeline import jobs
from twodiscs.pipeline.results import manifest, record


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A folder with theory.csv and a figure that shows it, by their jobs."""
    given = {"box": BOX.parameters()}
    about = ("--about", "scene paper, seed 3", "--code", "0123")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("made"))
        os.mkdir("results")
        theory = ("table", "theory.exact", "--function", "theory_rows")
        words = [*theory, "--parameters", given | {"radii": [0.1]}, *about]
        assert command(patch, jobs, *words, "--output", "results/theory.csv") == 0
        words = ["figure", "figures.geometry.model", "--parameters", given, *about]
        words += ["--table", "theory=results/theory.csv"]
        assert command(patch, jobs, *words, "--output", "results/m.pdf", "results/m.png") == 0
        return Path("results").resolve()


@pytest.fixture
def results(made, tmp_path, monkeypatch):
    """A copy of that folder, below the working directory."""
    monkeypatch.chdir(tmp_path)
    return shutil.copytree(made, tmp_path / "results")


def rewrite(path, content):
    path.write_bytes(content)
    os.utime(path, ns=(1, 1))  # an older time stamp tells as much as a newer one


def test_a_record_says_what_made_a_file_and_a_figure_carries_it(results):
    found = record.read(results / "m.png")
    assert found["sha256"] == record.digest(results / "m.png")
    assert found["made_by"]["about"] == "scene paper, seed 3"
    assert found["made_by"]["parameters"] == {"box": BOX.parameters()}
    assert found["inputs"]["theory"]["files"] == ["theory.csv"]
    hashes = record.digest(results / "theory.csv")[:16]
    given = record.short(json.dumps({"box": BOX.parameters()}))
    line = f"twodiscs: scene paper, seed 3, code 0123, parameters {given}"
    for name in ("m.png", "m.pdf"):
        assert f"{line}, tables {hashes}".encode() in (results / name).read_bytes()


def test_nothing_changed_nothing_said(results):
    assert list(record.audit(results)) == []
    for path in results.glob("*.*"):
        path.touch()
    assert record.touched(results) == []
    assert list(record.audit(results)) == []


def test_what_changed_is_made_again_and_named(results, capsys):
    table, drawn = results / "theory.csv", results / "m.pdf"
    rewrite(table, table.read_bytes().replace(b"1", b"2"))
    rewrite(drawn, drawn.read_bytes()[:1000])
    record.notice("results")
    said = capsys.readouterr().err.splitlines()
    assert sorted(said) == [
        f"results/{name} is not what its job wrote; it is made again when needed."
        for name in ("m.pdf", "theory.csv")
    ]
    marks = {
        urlsafe_b64encode(f"results/{name}".encode()).decode() for name in ("m.pdf", "theory.csv")
    }
    assert {path.name for path in (results.parent / ".snakemake/incomplete").iterdir()} == marks
    assert sorted(record.audit(results)) == [
        f"{results}/m.pdf is not what its job wrote",
        f"{results}/m.png was made of another {results}/theory.csv",
        f"{results}/theory.csv is not what its job wrote",
    ]


@pytest.fixture
def bundled(results):
    """The folder of points that were made in two bundles."""
    points = results / "paper" / "points"
    (points / "dynamics" / "bundles").mkdir(parents=True)
    (points / "cost").mkdir()
    for name, keys in {"0001": ["0.1", "0.2"], "0002": ["0.11"]}.items():
        path = points / "dynamics" / "bundles" / f"{name}.json"
        path.write_text(json.dumps(dict.fromkeys(keys, "hash"), indent=1))
        record.write([path], {})
        for point in (f"{kind}{key}" for key in keys for kind in ("dynamics/", "cost/dynamics-")):
            (points / f"{point}.json").write_text("{}")
            record.write([points / f"{point}.json"], {})
    return points


def test_with_a_point_its_bundle_is_made_again(results, bundled, capsys):
    points = bundled
    rewrite(points / "dynamics" / "0.1.json", b"[]")
    folder = results.parent / ".snakemake/incomplete"
    bundle = "results/paper/points/dynamics/bundles/000{}.json".format
    record.notice("results")
    assert "paper/points/dynamics/0.1.json is not what its job wrote" in capsys.readouterr().err
    assert {path.name for path in folder.iterdir()} == {record.name_of(bundle(1))}
    rewrite(points / "cost" / "dynamics-0.11.json", b"[]")
    record.notice("results")
    assert record.name_of(bundle(2)) in {path.name for path in folder.iterdir()}
    # Points may have been bundled otherwise before.
    former = points / "dynamics" / "bundles" / "0.2.json"
    former.write_text('{"0.2": "hash"}')
    record.write([former], {})
    rewrite(points / "dynamics" / "0.2.json", b"[]")
    shutil.rmtree(folder)
    record.notice("results")
    both = {record.name_of(bundle(1)), record.name_of("results" / former.relative_to(results))}
    assert both <= {path.name for path in folder.iterdir()}


def test_a_bundle_goes_with_a_point_of_it(bundled):
    folder = bundled / "dynamics" / "bundles"
    record.notice("results")
    assert {path.name for path in folder.glob("*.json")} == {"0001.json", "0002.json"}
    (bundled / "cost" / "dynamics-0.11.json").unlink()
    record.notice("results")
    assert {path.name for path in folder.glob("*.json")} == {"0001.json"}


@pytest.mark.parametrize("damaged", ["", "{", "3", "[[]]", "[]"])
def test_a_bundle_takes_its_points_from_others_and_damaged_ones_have_none(bundled, damaged):
    folder = bundled / "dynamics" / "bundles"
    (folder / "0003.json").write_text(damaged)
    record.claim(folder / "0002.json", ["0.11"])
    assert {path.name for path in folder.glob("*.json")} == {
        *("0001.json", "0002.json", "0003.json"),
    }
    record.claim(folder / "0002.json", ["0.11", "0.2"])
    assert {path.name for path in folder.glob("*.json")} == {"0002.json", "0003.json"}
    assert not record.record_of(folder / "0001.json").exists()


def made_of(points, point):
    table = points.parent / "made.csv"
    table.write_text("radius\n")
    record.write([table], {"dynamics": [points / point]})
    return table


def stale():
    return record.stale("results", record.bundles("results"))


def test_what_was_made_of_a_point_is_stale_without_its_bundle(bundled):
    made_of(bundled, "dynamics/0.1.json")
    assert stale() == []
    (bundled / "dynamics" / "bundles" / "0001.json").unlink()
    assert stale() == [(Path("results/paper/made.csv"), "was made of a file that is gone")]


def test_what_was_made_of_a_file_of_the_workflow_is_not_stale_in_a_copy_of_the_results(results):
    scene, table = results.parent / "scene.yaml", results / "effects.csv"
    for path in (scene, table):
        path.write_text("")
    record.write([table], {"scene": [scene]})
    scene.unlink()
    assert stale() == []


def test_what_was_made_of_a_point_is_stale_when_that_was_made_again(bundled):
    table, cost = made_of(bundled, "cost/dynamics-0.1.json"), bundled / "cost/dynamics-0.1.json"
    later = table.stat().st_mtime_ns + 10**9
    os.utime(cost, ns=(later, later))
    assert stale() == []  # the same bytes
    cost.write_text('{"seconds": 2}')
    os.utime(cost, ns=(later, later))
    why = "was made of other points than are there now"
    assert stale() == [(Path("results/paper/made.csv"), why)]


def test_results_below_others_are_as_whole_as_those(results, bundled, capsys, monkeypatch):
    monkeypatch.setattr(record, "AGAIN", True)
    made_of(bundled, "dynamics/0.1.json")
    (results / "draft").mkdir()
    (results / "paper").rename(results / "draft" / "paper")
    record.notice("results")
    assert not capsys.readouterr().err
    (results / "draft/paper/points/dynamics/0.1.json").unlink()
    record.notice("results")
    assert not (results / "draft/paper/points/dynamics/bundles/0001.json").exists()


def test_an_edit_that_keeps_the_time_stamp_is_named_by_the_audit_and_never_certified(results):
    table = results / "theory.csv"
    stamp = table.stat().st_mtime_ns
    table.write_bytes(table.read_bytes() + b"\n")
    os.utime(table, ns=(stamp, stamp))
    assert f"{table} is not what its job wrote" in list(record.audit(results))
    with pytest.raises(InputError, match=r"theory\.csv is not what its job wrote; delete it"):
        manifest.manifest(results, [table])


def test_a_damaged_input_stops_a_job_with_its_name(results, monkeypatch, capsys):
    rewrite(results / "theory.csv", b"radius\n")
    words = ["figure", "figures.geometry.model", "--parameters", {"box": BOX.parameters()}]
    words += ["--table", "theory=results/theory.csv", "--output", "results/n.pdf"]
    assert command(monkeypatch, jobs, *words) == 2
    assert "results/theory.csv is not what its job wrote" in capsys.readouterr().err
    assert not (results / "n.pdf").exists()


@pytest.mark.parametrize("old", ['"inputs"', '"made_by"', '"seal"', "seed 3"])
def test_an_edited_record_is_a_damaged_one(results, old):
    path = results / ".record" / "theory.csv.json"
    text = path.read_text()
    assert text.count(old) == 1
    path.write_text(text.replace(old, old[::-1]))
    assert record.read(results / "theory.csv") is None
    assert f"{path} is damaged" in list(record.audit(results))


@pytest.mark.parametrize("text", ["1", "[]", '""', "null", "{}"])
def test_what_is_no_record_is_none(results, text):
    (results / ".record" / "theory.csv.json").write_text(text)
    assert record.read(results / "theory.csv") is None


def test_what_no_job_wrote_and_what_is_gone_is_named(results):
    (results / "own.csv").write_text("a\n")
    (results / "m.pdf").unlink()
    (results / ".record" / "m.png.json").write_text("{")
    assert sorted(record.audit(results)) == [
        f"{results}/.record/m.png.json is damaged",
        f"{results}/m.pdf is missing",
        f"{results}/own.csv was written by no job, or has lost its record",
    ]


def test_a_folder_above_may_have_any_name(results):
    home = results.parent / "points"
    home.mkdir()
    results.rename(home / "results")
    (home / "results" / "theory.csv").unlink()
    found = record.stale("points/results", {})
    assert sorted(path.name for path, _ in found) == ["m.pdf", "m.png"]


def test_with_what_is_gone_everything_made_of_it_is_made_again(results, capsys, monkeypatch):
    (results / "theory.csv").unlink()
    record.notice("results")
    assert not capsys.readouterr().err
    monkeypatch.setattr(record, "AGAIN", True)
    record.notice("results")
    assert sorted(capsys.readouterr().err.splitlines()) == [
        f"results/{name} was made of a file that is gone; it is made again when needed."
        for name in ("m.pdf", "m.png")
    ]
    marked = {path.name for path in (results.parent / ".snakemake/incomplete").iterdir()}
    assert marked == {record.name_of(f"results/{name}") for name in ("m.pdf", "m.png")}


def test_what_lost_its_record_is_made_again_without_a_word_on_what_is_somebodys_own(
    results, capsys
):
    for name in ("theory.csv", "own.csv"):
        (results / name).write_text("a\n")
        (results / ".record" / f"{name}.json").unlink(missing_ok=True)
    mark = urlsafe_b64encode(b"results/theory.csv").decode()
    known = results.parent / ".snakemake" / "metadata" / mark
    known.parent.mkdir(parents=True)
    known.touch()
    record.notice("results")
    said = "results/theory.csv has lost its record; it is made again when needed.\n"
    assert capsys.readouterr().err == said
    assert mark in [path.name for path in (known.parents[1] / "incomplete").iterdir()]


def test_a_folder_without_any_record_is_not_said_to_agree(tmp_path, monkeypatch, capsys):
    (tmp_path / "results" / "logs").mkdir(parents=True)
    monkeypatch.chdir(tmp_path)
    assert command(monkeypatch, record, "results") == 2
    assert (
        "results holds no results with a record: they are built by make" in capsys.readouterr().err
    )
