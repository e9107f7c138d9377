"""From the files of points to the tables of a scene, and mistakes that name the file."""

import json

import numpy as np
import pytest
from fabricated import BOX, RADII, Laws, command, scenes, store, theory_rows

from twodiscs.comparison import gather, rows
from twodiscs.comparison.check import check_rows, comparisons
from twodiscs.comparison.scene_tables import SCENE_TABLES, Forecast, Theory
from twodiscs.model.radii import key
from twodiscs.pipeline import jobs

STAGES = {
    "volume": ["monte_carlo"],
    "areas": ["monte_carlo"],
    "mean_times": ["dynamics"],
    "hop_histogram": ["intervals"],
    "check": ["monte_carlo", "dynamics", "intervals"],
}


@pytest.fixture(scope="module")
def points():
    rng, laws = np.random.default_rng(6), [Laws(scene) for scene in scenes()]
    return {
        "monte_carlo": [law.monte_carlo(rng, 10**7) for law in laws],
        "dynamics": [law.dynamics(rng, replicas=256, relative=1e-2) for law in laws],
        "intervals": [law.intervals(rng) for law in laws[:3]],
    }


@pytest.fixture
def folder(tmp_path, points):
    """The folder of the points of a scene, beside its theory.csv."""
    Theory.write(tmp_path / "theory.csv", theory_rows())
    for stage, some in points.items():
        store(tmp_path / "points" / stage, {key(point["radius"]): point for point in some})
    return tmp_path / "points"


def keys_of(points, stages):
    return {stage: [key(point["radius"]) for point in points[stage]] for stage in stages}


def gathered(monkeypatch, folder, name, keys, **more):
    """Gather a table by the job of the workflow; return its exit status and the file."""
    output = folder.parent / f"{name}.csv"
    status = command(
        monkeypatch, jobs, "table", "comparison.gather", "--function", f"{name}_rows",
        "--parameters", {"box": BOX.parameters(), "keys": keys, **more}, "--points", folder,
        "--table", f"theory={folder.parent / 'theory.csv'}", "--output", output,
    )  # fmt: skip
    return status, output


@pytest.mark.parametrize("name", STAGES)
def test_tables_are_the_rows_of_the_points_in_whatever_order(monkeypatch, folder, points, name):
    theory = rows.exact_values(theory_rows())
    scene = BOX.scene(RADII[0])
    made = {
        "volume": rows.volume_rows(theory, points["monte_carlo"]),
        "areas": rows.area_rows(scene, theory, points["monte_carlo"]),
        "mean_times": rows.mean_time_rows(scene, theory, points["dynamics"]),
        "hop_histogram": rows.histogram_rows(theory, points["intervals"]),
    }
    made["check"] = check_rows(comparisons(scene, *made.values(), points["dynamics"]))
    keys, written = keys_of(points, STAGES[name]), []
    for order in (1, -1):
        some = {stage: names[::order] for stage, names in keys.items()}
        status, output = gathered(monkeypatch, folder, name, some)
        assert status == 0
        written.append(output.read_bytes())
    assert written[0] == written[1]
    assert b"\r" not in written[0]
    assert SCENE_TABLES[name].read(output) == made[name]


def test_only_watched_areas_are_gathered(monkeypatch, folder, points):
    keys = keys_of(points, ["monte_carlo"])
    status, output = gathered(monkeypatch, folder, "areas", keys, watched=["any_wall"])
    assert status == 0
    found = SCENE_TABLES["areas"].read(output)
    assert {row["quantity"] for row in found} == {"any_wall_area"}
    assert len(found) == len(RADII)


# What jobs took -------------------------------------------------------------------------------


@pytest.fixture
def costs(tmp_path):
    """The folder of the points of the scene ``a``, with what three jobs took."""
    cost = {"events": 5, "seconds": 0.5}
    names = ("monte_carlo-0.1", "dynamics-0.1", "dynamics-0.2")
    store(tmp_path / "a" / "points" / "cost", dict.fromkeys(names, cost))
    return tmp_path / "a" / "points"


COST_KEYS = {"monte_carlo": ["0.1"], "dynamics": ["0.2", "0.1"]}


def cost_table(monkeypatch, folder, *tables):
    output = folder.parent / "cost.csv"
    given = {"box": BOX.parameters(), "keys": COST_KEYS, "watched": []}
    status = command(
        monkeypatch, jobs, "table", "comparison.gather", "--function", "cost_rows",
        "--parameters", given, "--points", folder, "--table", *tables, "--output", output,
    )  # fmt: skip
    assert status == 0
    return output.read_text()


def test_cost_is_by_stage_and_radius(monkeypatch, costs):
    assert cost_table(monkeypatch, costs) == (
        "stage,radius,events,seconds,forecast_seconds,ratio\n"
        "dynamics,0.1,5,0.5,,\n"
        "dynamics,0.2,5,0.5,,\n"
        "monte_carlo,0.1,5,0.5,,\n"
    )


def test_cost_is_set_against_the_forecast_of_its_scene(monkeypatch, costs, tmp_path):
    blank = {"jobs": 1, "events": 5, "startup": 1.0, "cores": 2, "wall_clock": 1.0}
    forecasts = [
        {"scene": scene, "stage": stage, "radius": radius, "seconds": seconds, **blank}
        for scene, stage, radius, seconds in (
            ("b", "dynamics", 0.1, 7.0),
            ("a", "dynamics", 0.1, 0.25),
            ("a", "monte_carlo", 0.1, 1.0),
            ("a", "dynamics", None, 0.25),
            ("a", "total", None, 1.25),
        )
    ]
    Forecast.write(tmp_path / "forecast.csv", forecasts)
    assert cost_table(monkeypatch, costs, f"forecast={tmp_path / 'forecast.csv'}") == (
        "stage,radius,events,seconds,forecast_seconds,ratio\n"
        "dynamics,0.1,5,0.5,0.25,2.0\n"
        "dynamics,0.2,5,0.5,,\n"
        "monte_carlo,0.1,5,0.5,1.0,0.5\n"
        "total,,10,1.0,1.25,0.8\n"
    )


# Mistakes -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", "is not the file of a point"),
        ('{"quantities": NaN}', "is not the file of a point"),
        ("[1]", "is not the file of a point: it holds no JSON object"),
        ("{}", "is not a file of monte_carlo: it has no radius, method, samples, quantities"),
        (
            json.dumps({"radius": 0.1, "method": "monte_carlo", "quantities": {}}),
            "is not a file of monte_carlo: it has no samples",
        ),
        (
            json.dumps({"radius": 0.1, "method": "", "samples": 1, "quantities": [1]}),
            "is not a file of monte_carlo: quantities is not an object",
        ),
    ],
)
def test_a_file_that_is_no_point_is_named(tmp_path, text, message):
    store(tmp_path / "monte_carlo", {"0.1": {}})
    (tmp_path / "monte_carlo" / "0.1.json").write_text(text)
    with pytest.raises(ValueError, match=rf"monte_carlo/0\.1\.json {message}"):
        gather.read_points(tmp_path, {"monte_carlo": ["0.1"]})


STRATA = {"shares": [[0.5, 0.5]], "starts": [[9, 9]], "counts": [[1, 2]], "squares": [[1, 4]]}
STRIP = {
    "duration": 0.1, "share": 0.5, "replicas": 18, "count": 3, "squares": 5, "status": "reached",
    "strata": STRATA,
}  # fmt: skip


@pytest.mark.parametrize(
    ("strip", "message"),
    [
        (STRIP, None),
        (1, "is not an object"),
        ({name: STRIP[name] for name in STRIP if name != "strata"}, "has no strata"),
        (STRIP | {"strata": None}, "has wrong strata: "),
        (STRIP | {"strata": {}}, "has wrong strata: "),
        (STRIP | {"strata": STRATA | {"starts": [[9]]}}, "has wrong strata: strata must be"),
        (STRIP | {"strata": STRATA | {"shares": [[0.5, 0.6]]}}, "has wrong strata: shares"),
        (STRIP | {"replicas": 19}, "has replicas 19, but in its strata 18"),
        (STRIP | {"count": 4}, "has count 4, but in its strata 3"),
    ],
)
def test_a_damaged_strip_is_named(tmp_path, points, strip, message):
    point = points["dynamics"][1] | {"strips": {"vertical_hop": strip}}
    store(tmp_path / "dynamics", {"0.1": point})
    keys = {"dynamics": ["0.1"]}
    if message is None:
        assert gather.read_points(tmp_path, keys)["dynamics"] == [point]
        return
    said = rf"dynamics/0\.1\.json is not a file of dynamics: its strip of vertical_hop {message}"
    with pytest.raises(ValueError, match=said):
        gather.read_points(tmp_path, keys)


@pytest.mark.parametrize("stage", ["monte_carlo", "dynamics", "intervals"])
def test_the_point_of_another_stage_is_named(tmp_path, points, stage):
    for other, some in points.items():
        store(tmp_path / stage, {"0.1": some[1]})
        keys = {stage: ["0.1"]}
        if other == stage:
            found = gather.read_points(tmp_path, keys)
            assert found.pop(stage) == [some[1]]
            assert list(found.values()) == [[], []]
        else:
            with pytest.raises(ValueError, match=rf"{stage}/0\.1\.json is not a file of {stage}"):
                gather.read_points(tmp_path, keys)


def test_what_a_job_took_is_checked_too(tmp_path):
    store(tmp_path / "cost", {"dynamics-0.1": {"events": 5}})
    with pytest.raises(ValueError, match=r"cost/dynamics-0\.1\.json is not .* it has no seconds"):
        gather.cost_rows({}, [tmp_path], {"dynamics": ["0.1"]})


@pytest.mark.parametrize(
    ("name", "keys", "message"),
    [
        ("volume", {"monte_carlo": ["negative"]}, "hits must be"),
        ("volume", {"sampling": ["0.1"]}, "stage must be one of monte_carlo, dynamics, int"),
        ("areas", {}, "keys must name one point at least"),
    ],
)
def test_mistakes_are_one_sentence(monkeypatch, capsys, folder, points, name, keys, message):
    part = {"hits": -1, "measure": 1.0, "epsilon": None}
    wrong = points["monte_carlo"][1] | {"quantities": {"volume": part}}
    store(folder / "monte_carlo", {"negative": wrong})
    status, output = gathered(monkeypatch, folder, name, keys)
    error = capsys.readouterr().err
    assert status == 2
    assert error.startswith("error: ")
    assert message in error
    assert error.count("\n") == 1
    assert not output.exists()
