"""Jobs of one radius: their files, shards that add up to the same bytes, their errors."""

import json
from pathlib import Path

import pytest
from commands import command

from twodiscs.model.scene import Scene
from twodiscs.points.digests import read_json, write_json
from twodiscs_paper.pipeline.jobs import point

SCENE = Scene(1.5, 1.0, 0.2)
BOX = ("--width", 1.5, "--height", 1, "--radius", 0.2)
WORK = {
    "monte_carlo": ("--quantities", "volume", "top_wall_area", "--samples", "3e6", "--shell", 0.1),
    "dynamics": ("--target", "vertical_hop=0.01", "top_wall=0.1", "--budget", "1e7"),
    "intervals": ("--event", "vertical_hop", "--intervals", 3 << 16, "--budget", "1e9"),
}  # fmt: skip

#: The arguments of a shard: it does not depend on accuracy or budget.
SHARD = {
    "monte_carlo": ("--quantities", "volume", "top_wall_area", "--samples", 1, "--shell", 0.1),
    "dynamics": ("--target", "vertical_hop=0.5", "top_wall=0.5", "--budget", "1"),
    "intervals": ("--event", "vertical_hop", "--intervals", 1, "--budget", "1e15"),
}  # fmt: skip


@pytest.fixture
def run(monkeypatch, tmp_path):
    """Run a job in a separate folder; return its exit status."""
    monkeypatch.chdir(tmp_path)
    return lambda stage, *words: command(monkeypatch, point, stage, *BOX, "--seed", 7, *words)


def shards(run, stage, pieces, part="all"):
    """Do shards of a point; return their files."""
    files = []
    for first, stop in pieces:
        files.append(f"{part}-{first}-{stop}.json")
        words = "--part", part, "--blocks", first, stop, "--output", files[-1]
        assert run(stage, *SHARD[stage], *words) == 0
    return files


@pytest.mark.parametrize("stage", WORK)
def test_a_point_is_the_same_again(run, stage):
    for name in ("a.json", "b.json"):
        assert run(stage, *WORK[stage], "--shards", "--output", name) == 0
    assert read_json("a.json") == read_json("b.json")
    assert read_json("a.json")["radius"] == 0.2


@pytest.mark.parametrize("stage", ["monte_carlo", "intervals"])
def test_work_of_known_length_gives_the_same_point_in_shards(run, stage):
    assert run(stage, *WORK[stage], "--output", "alone.json") == 0
    files = shards(run, stage, [(2, 3), (0, 2)])
    assert run(stage, *WORK[stage], "--shards", *files, "--output", "joined.json") == 0
    assert read_json("joined.json") == read_json("alone.json")


def test_counts_are_the_same_in_any_number_of_shards(run):
    stop = (
        point.dynamics(SCENE, {"vertical_hop": 0.01, "top_wall": 0.1}, 10**7, 7)
        .parts["all"]
        .planned
    )
    assert stop >= 3
    cuts = {"one": [(0, stop)], "some": [(i, i + 1) for i in range(stop)][::-1]}
    for name, pieces in cuts.items():
        files = shards(run, "dynamics", pieces)
        words = *WORK["dynamics"], "--shards", *files, "--output", f"{name}.json"
        assert run("dynamics", *words) == 0
    assert read_json("one.json") == read_json("some.json")


def test_what_is_missing_of_a_point_is_said(run, capsys):
    files = shards(run, "monte_carlo", [(0, 1), (2, 3)])
    assert run("monte_carlo", *WORK["monte_carlo"], "--shards", *files, "--output", "a.json") == 2
    said = capsys.readouterr().err
    assert said.startswith("error: ")
    assert said.count("\n") == 1


def test_an_edited_shard_is_refused(run, capsys):
    (file,) = shards(run, "monte_carlo", [(0, 3)])
    content = json.loads(Path(file).read_text())
    content["sums"][0][0] += 1
    Path(file).write_text(json.dumps(content))
    assert run("monte_carlo", *WORK["monte_carlo"], "--shards", file, "--output", "a.json") == 2
    assert "all-0-3.json is not what its job wrote; delete it" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("stage", "words", "said"),
    [
        ("dynamics", ("--target", "hop=1e-3", "--budget", "1e6"), "event must be one of"),
        ("dynamics", ("--target", "1e-3", "--budget", "1e6"), "must be NAME=NUMBER"),
        ("dynamics", ("--target", "top_wall=1e-3"), "dynamics needs --budget"),
        ("dynamics", (*SHARD["dynamics"], "--part", "none", "--blocks", 0, 1), "part must be one"),
        ("monte_carlo", ("--samples", "1e6"), "monte_carlo needs --quantities"),
        ("intervals", ("--event", "top_wall", "--intervals", 9, "--budget", 9), "event must be"),
    ],
)
def test_a_mistake_is_one_sentence(run, capsys, stage, words, said):
    assert run(stage, *words, "--output", "a.json") == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1


def test_a_job_whose_log_is_a_file_says_nothing(run, capsys):
    assert run("dynamics", *WORK["dynamics"], "--output", "a.json") == 0
    assert capsys.readouterr() == ("", "")


def test_a_point_that_another_program_wrote_is_no_shard(run, capsys):
    write_json("a.json", {"radius": 0.2})
    assert run("dynamics", *WORK["dynamics"], "--shards", "a.json", "--output", "b.json") == 2
    assert "a.json" in capsys.readouterr().err
