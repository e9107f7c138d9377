"""Jobs of tables, studies and figures: the files that they read and write, and their errors."""

import csv
import json

import numpy as np
import pytest
from commands import command
from factory import BOX, RADII, Laws, scenes

from twodiscs.arguments import box_arguments
from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.comparison.tables.cost import Forecast
from twodiscs.model.checks import InputError
from twodiscs.points.digests import read_json, write_json
from twodiscs_paper.catalogue import STUDY_TABLES
from twodiscs_paper.pipeline.jobs import figure, study, table

WORDS = box_arguments(BOX)


@pytest.fixture
def run(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    return lambda job, *words: command(monkeypatch, job, *words)


@pytest.fixture
def points(run, tmp_path):
    """The arguments that name the exact values and fabricated points of some radii."""
    assert run(table, "theory", *WORDS, "--radii", *RADII, "--output", "theory.csv") == 0
    words, rng = ["--theory", "theory.csv"], np.random.default_rng(1)
    for stage in ("monte_carlo", "dynamics"):
        samples = {"monte_carlo": {"samples": 10**7}, "dynamics": {}}[stage]
        words.append(f"--{stage}")
        for scene in scenes():
            path = tmp_path / f"{stage}-{scene.radius}.json"
            getattr(Laws(scene), stage)(rng, **samples).write(path)
            words.append(path)
    return words


@pytest.mark.parametrize("name", ["volume", "areas", "mean_times", "check"])
def test_a_table_is_made_of_points(run, points, name):
    words = "--areas", "right_wall", "disc_collision", *points, "--output", f"{name}.csv"
    assert run(table, name, *WORDS, *words) == 0
    rows = SCENE_TABLES[name].read(f"{name}.csv")
    assert {row["radius"] for row in rows} >= {*RADII}
    assert run(table, "grid", *WORDS, "--radii", *RADII, "--output", "grid.csv") == 0
    assert [row["radius"] for row in SCENE_TABLES["grid"].read("grid.csv")] == [*RADII]


def test_cost_is_what_jobs_took_and_may_be_missing(run, points, tmp_path):
    """It stands in the files of the points, beside the digest, and is no part of their content."""
    took = {0.1: 2.5, 0.2: 4.5}
    for path in points[points.index("--dynamics") + 1 :]:
        content = read_json(path)
        write_json(path, content, took.get(content["radius"]))
        assert read_json(path) == content
    (tmp_path / "scene").mkdir()
    assert run(table, "cost", *WORDS, *points, "--output", "scene/cost.csv") == 0
    rows = {(r["stage"], r["radius"]): r for r in SCENE_TABLES["cost"].read("scene/cost.csv")}
    assert rows["dynamics", 0.1]["seconds"] == 2.5
    assert rows["dynamics", 0.2]["seconds"] == 4.5
    assert rows["dynamics", 0.3]["seconds"] is None
    assert rows["monte_carlo", 0.1]["events"] == 10**7
    forecast = {"scene": "scene", "stage": "dynamics", "radius": 0.2, "seconds": 1.5}
    Forecast.write(tmp_path / "forecast.csv", [Forecast.empty(**forecast)])
    words = "--forecast", "forecast.csv", "--output", "scene/cost.csv"
    assert run(table, "cost", *WORDS, *points, *words) == 0
    rows = {(r["stage"], r["radius"]): r for r in SCENE_TABLES["cost"].read("scene/cost.csv")}
    assert rows["dynamics", 0.2]["ratio"] == 3.0
    assert rows["total", None]["seconds"] == 4.5


def test_an_edited_point_is_refused_in_a_sentence(run, points, capsys):
    path = points[points.index("--dynamics") + 1]
    content = json.loads(path.read_text())
    content["counts"]["vertical_hop"] += 1
    path.write_text(json.dumps(content))
    assert run(table, "mean_times", *WORDS, *points, "--output", "a.csv") == 2
    said = capsys.readouterr().err
    assert said == f"error: {path} is not what its job wrote; delete it, and it is made again\n"


@pytest.mark.parametrize("stage", ["dynamics", "intervals"])
def test_a_point_of_another_stage_is_refused(run, points, capsys, stage):
    path = points[points.index("--monte_carlo") + 1]
    words = "--theory", "theory.csv", f"--{stage}", path, "--output", "a.csv"
    assert run(table, "check", *WORDS, *words) == 2
    assert f"{path} must be a point of {stage}, but was made" in capsys.readouterr().err


def test_a_mistake_of_a_study_keeps_its_place(run, monkeypatch):
    def rows(cls, box, seed):
        raise InputError("radius 3 does not fit")

    monkeypatch.setattr(STUDY_TABLES["errata"], "rows", classmethod(rows))
    given = json.dumps({"box": BOX.parameters(), "seed": 1})
    with pytest.raises(RuntimeError, match="errata") as caught:
        run(study, "errata", "--parameters", given, "--output", "errata.csv")
    assert isinstance(caught.value.__cause__, InputError)


def test_a_study_reads_tables_and_its_parameters(run, capsys):
    assert run(study, "errata", "--output", "errata.csv") == 0
    with open("errata.csv", newline="") as file:
        assert len([*csv.DictReader(file)]) > 10
    drawn = "--output", "largest_radius.pdf", "largest_radius.png"
    assert run(figure, "largest_radius", *WORDS, *drawn) == 0


@pytest.mark.parametrize(
    ("job", "words", "said"),
    [
        (study, ("errata", "--parameters", "{", "--output", "a.csv"), "must be a JSON object"),
        (study, ("errata", "--parameters", '{"a": 1}', "--output", "a.csv"), "of errata"),
        (study, ("thresholds", "--tables", "a=b.csv", "--output", "c.csv"), "one of the tables"),
        (table, ("volume", *WORDS, "--theory", "no.csv", "--output", "a.csv"), "no.csv: No such"),
        (figure, ("model", *WORDS, "--output", "model.txt"), "path must be a .pdf"),
        (figure, ("no", *WORDS, "--output", "a.pdf"), "invalid choice: 'no'"),
    ],
)
def test_a_mistake_is_one_sentence(run, capsys, job, words, said):
    assert run(job, *words) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1


def test_a_figure_says_what_made_it(run, points):
    assert run(table, "volume", *WORDS, *points, "--output", "volume.csv") == 0
    words = "--tables", "volume=volume.csv", "--origin", "scene paper, seed 1, code 12ab"
    assert run(figure, "volume", *WORDS, *words, "--output", "a.png", "a.pdf") == 0
    with open("a.png", "rb") as file:
        assert b"twodiscs: scene paper, seed 1, code 12ab, tables " in file.read()
