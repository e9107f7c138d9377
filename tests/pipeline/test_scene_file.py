"""A file of config/scenes, as the study of effects counts it: like a build of it alone."""

import inspect
import json
from pathlib import Path

import pytest
import yaml
from fabricated import command

from twodiscs.pipeline.configuration import scene_file
from twodiscs.pipeline.configuration.load import load
from twodiscs.pipeline.configuration.reading import read
from twodiscs.studies.effects import measure

FILES = sorted((Path(__file__).resolve().parents[2] / "config" / "scenes").glob("*.yaml"))
SCENE = {
    "name": "heavy",
    "box": {"width": 1.5, "height": 1},
    "effects": {"mass_ratio": 3},
    "radii": [0.1, 0.2],
    "watch": {"mean_times": True},
}


def write(folder, *scenes, **top):
    path = folder / "scene.yaml"
    path.write_text(yaml.safe_dump({"scenes": list(scenes), **top}))
    return path


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_the_jobs_are_those_of_the_scene_built_alone(path):
    (scene,) = load({"seed": 1908} | read(path)).scenes
    found = scene_file.effects_job(path, 1908)
    assert (found["name"], found["box"]) == (path.stem, scene.box.parameters())
    alone = [scene.job("dynamics", key) for key in scene.keys["dynamics"]]
    assert [{"box": found["box"]} | job for job in found["dynamics"]] == alone
    inspect.signature(measure.job).bind(**found)


def test_the_seed_of_a_file_wins(tmp_path):
    seeds = [
        scene_file.effects_job(write(tmp_path, SCENE, **top), seed)["seed"]
        for top, seed in (({}, 5), ({}, 6), ({"seed": 7}, 5))
    ]
    assert seeds == [5, 6, 7]


def test_the_command_prints_json(tmp_path, monkeypatch, capsys):
    path = write(tmp_path, SCENE)
    assert command(monkeypatch, scene_file, path, "--seed", "5") == 0
    printed = capsys.readouterr().out
    assert json.loads(printed) == scene_file.effects_job(path, 5)
    assert printed.count("\n") == 1


ALONE = "must hold one scene, with effects, that watches mean times"


@pytest.mark.parametrize(
    ("scenes", "sentence"),
    [
        ([SCENE | {"effects": {}}], ALONE),
        ([SCENE | {"watch": {"volume": True}}], ALONE),
        ([SCENE, SCENE | {"name": "other"}], ALONE),
        ([], "scenes must be a non-empty list"),
        ([SCENE | {"effects": {"wind": 1}}], "has an unknown key 'wind'"),
    ],
)
def test_another_file_is_refused_in_one_sentence(tmp_path, monkeypatch, capsys, scenes, sentence):
    assert command(monkeypatch, scene_file, write(tmp_path, *scenes), "--seed", "5") == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    assert sentence in shown.err
    assert shown.err.count("\n") == 1


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["no.yaml", "--seed", "5"], "no.yaml: No such file or directory"),
        (["no.yaml"], "the following arguments are required: --seed"),
        (["no.yaml", "--seed", "x"], "argument --seed: invalid int value: 'x'"),
    ],
)
def test_a_mistake_in_the_arguments_is_one_sentence(monkeypatch, capsys, words, sentence):
    assert command(monkeypatch, scene_file, *words) == 2
    assert capsys.readouterr().err == f"error: {sentence}\n"
