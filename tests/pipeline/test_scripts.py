"""The scripts of jobs.

Without these tests a script could join wrong shards, or take an edited file for a result.
"""

import gc
import json
import re
import runpy
from pathlib import Path
from types import SimpleNamespace

import pytest
from checkout import REPOSITORY, one_scene
from snakemake.iocontainers import Namedlist

from twodiscs.analysis.tables import SCENE_TABLES
from twodiscs.dynamics.stages import STAGES
from twodiscs.model.checks import InputError
from twodiscs.points.base import digest, read_json, write_json
from twodiscs_paper.configuration.yaml_files import load
from twodiscs_paper.pipeline import job
from twodiscs_paper.pipeline.points import read_point

gc.enable()  # a job begins without

WATCHED = {"volume": True, "areas": ["top_wall"], "mean_times": ["vertical_hop", "top_wall"]}
REQUEST = load(
    {"seed": 7}
    | one_scene(
        "a",
        radii=[0.2],
        watch=WATCHED | {"hop_histogram": {"radii": [0.2], "intervals": 3 << 16}},
        accuracy={"vertical_hop": 0.01, "top_wall": 0.1},
        event_budget=1e7,
        monte_carlo={"samples": 3e6, "shell": 0.1},
    )
).scenes[0]
BOX, WORK = REQUEST.box, {stage: REQUEST.arguments(stage) for stage in STAGES}


@pytest.fixture
def run(monkeypatch, tmp_path):
    """Run a script with inputs, outputs, params and wildcards in a separate folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(job, "start", lambda log: None)

    def run(script, params, wildcards=None, files=None, **output):
        snakemake = SimpleNamespace(
            input=Namedlist(fromdict=files or {}), output=Namedlist(fromdict=output),
            params=Namedlist(fromdict=params), wildcards=Namedlist(fromdict=wildcards or {}),
            log=["job.log"],
        )  # fmt: skip
        runpy.run_path(REPOSITORY / f"workflow/scripts/{script}.py", {"snakemake": snakemake})

    return run


def point(run, stage, output, shards=(), radius=0.2):
    """Make a point, of ``shards`` if there are any."""
    params = {"box": BOX.parameters(), "work": WORK[stage]}
    params["shard_work"] = REQUEST.shard_arguments(stage)
    where = {"stage": stage, "radius": f"{radius}"}
    run("point", params, where, {"shards": [*shards]}, point=output)
    return read_point(output, STAGES[stage], BOX.scene(radius), WORK[stage])


def shards(run, stage, ranges):
    """Make shards of a point; return their files."""
    files = []
    for first, stop in ranges:
        files.append(f"all-{first}-{stop}.json")
        where = {"stage": stage, "radius": "0.2", "component": "all", "first": first, "stop": stop}
        params = {"box": BOX.parameters(), "work": REQUEST.shard_arguments(stage)}
        run("point", params, where, point=files[-1])
    return files


@pytest.mark.parametrize("stage", WORK)
def test_a_point_does_not_depend_on_its_shards(run, stage):
    stop = STAGES[stage].run(BOX.scene(0.2), WORK[stage]).components["all"].planned
    assert stop >= 3
    one = point(run, stage, "one.json", shards(run, stage, [(0, stop)]))
    some = shards(run, stage, [(i, i + 1) for i in range(stop)][::-1])
    assert point(run, stage, "some.json", some) == one
    if stage != "dynamics":  # which ends when its errors are reached
        assert point(run, stage, "alone.json") == one


def test_the_time_of_a_point_includes_that_of_its_shards(run):
    (file,) = shards(run, "monte_carlo", [(0, 3)])
    write_json(file, read_json(file), 1000.0)
    point(run, "monte_carlo", "a.json", [file])
    assert json.loads(Path("a.json").read_text())["seconds"] >= 1000


@pytest.mark.parametrize(
    ("settings", "name", "wrong"),
    [
        ({"seed": 8}, "all-0-3.json", "has seed 8, but its job asks for 7"),
        ({"extra": 1}, "all-0-3.json", "has extra 1, but its job asks for None"),
        # Its first block is that of the name, its last one is not.
        ({}, "all-0-2.json", "all-0-2.json has the blocks all-0-3"),
    ],
)
def test_a_shard_of_other_work_is_refused(run, settings, name, wrong):
    (file,) = shards(run, "monte_carlo", [(0, 3)])
    content = read_json(file)
    write_json(name, content | {"settings": content["settings"] | settings})
    with pytest.raises(InputError, match=re.escape(f"{wrong}; delete it, and it is made again")):
        point(run, "monte_carlo", "a.json", [name])


def test_a_part_of_a_point_that_is_missing_is_named(run):
    files = shards(run, "monte_carlo", [(0, 1), (2, 3)])
    with pytest.raises(InputError, match="gap or overlap, not 0 to 1, 2 to 3"):
        point(run, "monte_carlo", "a.json", files)


@pytest.fixture
def points(run):
    """The files of points at three radii."""
    files = {"intervals": []}
    for stage in ("monte_carlo", "dynamics"):
        Path(stage).mkdir()
        files[stage] = [f"{stage}/{radius}.json" for radius in (0.1, 0.2, 0.3)]
        for path in files[stage]:
            point(run, stage, path, radius=float(Path(path).stem))
    return files


MADE = {"box": BOX.parameters(), "given": {}, "work": WORK}


def test_cost_is_the_time_of_the_jobs_and_may_be_missing(run, points):
    """It stands in the files of the points, beside the digest, and is no part of their content."""
    took = {0.1: 2.5, 0.2: 4.5}
    for path in points["dynamics"]:
        content = read_json(path)
        write_json(path, content, took.get(content["scene"]["radius"]))
        assert read_json(path) == content
    run("table", MADE, files=points, table="cost.csv")
    rows = {(r["stage"], r["radius"]): r for r in SCENE_TABLES["cost"].read("cost.csv")}
    assert [rows["dynamics", radius]["seconds"] for radius in (0.1, 0.2, 0.3)] == [2.5, 4.5, None]
    assert rows["monte_carlo", 0.1]["events"] == 3 * 2**20


def test_a_figure_names_its_code_and_its_tables(run, points, tmp_path):
    run("table", MADE, files=points, table="volume.csv")
    Path("sums").write_text("the code\n")
    params = {"box": BOX.parameters(), "names": ["volume"], "radius": None, "seed": 1}
    files = {"tables": ["volume.csv"], "code": ["figure.py", "sums"], "own_code": []}
    run("figure", params, {"scene": "a", "figure": "volume"}, files, png="a.png")
    origin = f"twodiscs: scene a, seed 1, code {digest('sums')[:16]}, tables "
    assert f"{origin}{digest('volume.csv')[:16]}".encode() in Path("a.png").read_bytes()
