"""The audit: whatever was edited, cut short or deleted is named, and nothing else."""

import json

import pytest
from commands import command
from factory import BOX

from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.points.digests import write_json
from twodiscs_paper.configuration.load import load
from twodiscs_paper.pipeline.jobs.point import monte_carlo
from twodiscs_paper.pipeline.jobs.table import rows_of
from twodiscs_paper.pipeline.results import audit, manifest

CONFIGURATION = {
    "scenes": [
        {
            "name": "small",
            "box": BOX.parameters(),
            "radii": [0.1, 0.2],
            "watch": {"volume": True},
            "monte_carlo": {"samples": 1},
        }
    ]
}


@pytest.fixture
def results(tmp_path, monkeypatch):
    """A folder of results with its manifest."""
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "results"
    folder.mkdir()
    (folder / "configuration.json").write_text(json.dumps(CONFIGURATION))
    (scene,) = load(CONFIGURATION).scenes
    own = folder / "small"
    (own / "points" / "monte_carlo").mkdir(parents=True)
    points = []
    for key, radius in scene.keys["monte_carlo"].items():
        run = monte_carlo(BOX.scene(radius), **scene.arguments("monte_carlo", radius))
        points.append(run.run())
        points[-1].write(own / "points" / "monte_carlo" / f"{key}.json")
    theory = SCENE_TABLES["theory"].rows(BOX, scene.radii)
    given = {"box": BOX, "theory": theory, "areas": [], "points": {"monte_carlo": points}}
    given["points"] |= {"dynamics": [], "intervals": []}
    for name in ("volume", "check"):
        SCENE_TABLES[name].write(own / f"{name}.csv", rows_of(SCENE_TABLES[name], **given))
    (folder / "errata.csv").write_text("a\n")
    certify(folder)
    return folder


def certify(folder):
    files = sorted(folder.rglob("*.csv"))
    (folder / "manifest.sha256").write_text(manifest.manifest(folder, files))


def run(monkeypatch):
    return command(monkeypatch, audit, "--configuration", "results/configuration.json")


def test_undamaged_results_pass(results, monkeypatch, capsys):
    assert run(monkeypatch) == 0
    # Three tables and two points.
    assert capsys.readouterr().out == "all 5 files are what their jobs wrote\n"


@pytest.mark.parametrize(
    "name",
    ["small/volume.csv", "small/check.csv", "errata.csv", "small/points/monte_carlo/0.1.json"],
)
@pytest.mark.parametrize("harm", ["edited", "cut short", "deleted", "linked", "a folder"])
def test_damage_is_named(results, monkeypatch, capsys, name, harm):
    path = results / name
    if harm == "edited":
        path.write_text("x" + path.read_text()[1:])
    elif harm == "cut short":
        path.write_bytes(path.read_bytes()[:-2])
    elif harm == "linked":
        path.rename(results / "elsewhere")
        (results / "elsewhere").write_text("x" + (results / "elsewhere").read_text()[1:])
        path.symlink_to(results / "elsewhere")
    else:
        path.unlink()
        if harm == "a folder":
            path.mkdir()
    status = run(monkeypatch)
    said = capsys.readouterr().out
    assert status == 1
    gone = harm == "deleted" or (harm == "a folder" and "points" not in name)
    assert f"{path} {'is missing' if gone else 'is not what its job wrote'}" in said
    last = said.splitlines()[-1]
    assert last.endswith("not what their jobs wrote; delete them, and they are made again")
    assert last.startswith(f"{said.count(str(results))} of ")


@pytest.mark.parametrize("name", ["volume", "check"])
def test_a_table_that_was_edited_before_the_manifest_was_written_is_named(
    results, monkeypatch, capsys, name
):
    path = results / "small" / f"{name}.csv"
    lines = path.read_text().splitlines()
    lines[1] = lines[1].replace("sampled", "too-few")
    path.write_text("\n".join(lines) + "\n")
    certify(results)
    assert run(monkeypatch) == 1
    assert f"{path} is not what its job wrote" in capsys.readouterr().out


def test_a_shard_that_was_edited_is_named(results, monkeypatch, capsys):
    path = results / "small" / "shards" / "monte_carlo" / "0.1" / "all-0-1.json"
    path.parent.mkdir(parents=True)
    write_json(path, {"sums": [17]})
    assert run(monkeypatch) == 0
    path.write_text(path.read_text().replace("17", "18"))
    assert run(monkeypatch) == 1
    assert f"{path} is not what its job wrote" in capsys.readouterr().out


def test_a_scene_that_is_not_built_misses_nothing(results, monkeypatch, capsys):
    for path in results.glob("small/**/*.*"):
        path.unlink()
    certify(results)
    assert run(monkeypatch) == 0
    assert capsys.readouterr().out == "all 1 files are what their jobs wrote\n"


@pytest.mark.parametrize(
    ("text", "said"),
    [(None, "has no manifest.sha256: results are built by make"), ("a\n", "must have lines of a")],
)
def test_what_is_no_manifest_is_one_sentence(results, monkeypatch, capsys, text, said):
    path = results / "manifest.sha256"
    path.unlink() if text is None else path.write_text(text)
    assert run(monkeypatch) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1
