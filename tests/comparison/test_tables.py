"""Tables: what is written is what is read, and rows say honestly what the points hold."""

import math
import subprocess
import sys

import numpy as np
import pytest
from fabricated import BOX, RADII, Laws, command, scenes, store, theory_rows

from twodiscs.cli import tables as cli_tables
from twodiscs.comparison import estimates, rows, tables
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene
from twodiscs.theory import exact

SCENE = Scene(**BOX, radius=0.2)


@pytest.fixture(scope="module")
def exact():
    return rows.exact_values(theory_rows())


@pytest.fixture(scope="module")
def laws():
    return [Laws(scene) for scene in scenes()]


# Files ----------------------------------------------------------------------------------------

CHECK_ROW = {
    "comparison": "area",
    "quantity": "right_wall_area",
    "radius": 0.1,
    "method": "monte_carlo",
    "exact": 1 / 3,
    "estimate": None,
    "stderr": None,
    "z": -math.inf,
    "p": 0.0,
    "bound": 5,
    "passed": False,
    "status": "none-seen",
    "test": "exact-tail",
}
COST_ROW = {
    "stage": "dynamics",
    "radius": 1e-05,
    "events": 2**53 + 1,
    "seconds": 0.1 + 0.2,
    "forecast_seconds": None,
    "ratio": None,
}


def test_a_table_is_read_as_it_was_written(tmp_path):
    for name, row in (("check", CHECK_ROW), ("cost", COST_ROW)):
        tables.write(tmp_path / "x.csv", name, [row, row])
        assert tables.read(tmp_path / "x.csv", name) == [row, row]


def test_cells_have_all_digits_and_lines_end_alike(tmp_path):
    tables.write(tmp_path / "x.csv", "cost", [COST_ROW])
    assert (tmp_path / "x.csv").read_bytes() == (
        b"stage,radius,events,seconds,forecast_seconds,ratio\n"
        b"dynamics,1e-05,9007199254740993,0.30000000000000004,,\n"
    )
    tables.write(tmp_path / "x.csv", "check", [CHECK_ROW])
    assert (tmp_path / "x.csv").read_text().splitlines()[1] == (
        "area,right_wall_area,0.1,monte_carlo,0.3333333333333333,,,-inf,0.0,5.0,false,"
        "none-seen,exact-tail"
    )


def test_numpy_scalars_are_written_as_plain_numbers(tmp_path):
    row = {**COST_ROW, "events": np.int64(7), "seconds": np.float64(0.1)}
    tables.write(tmp_path / "x.csv", "cost", [row])
    assert (tmp_path / "x.csv").read_text().endswith("dynamics,1e-05,7,0.1,,\n")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"seconds": math.nan}, "seconds must be a float"),
        ({"seconds": "1.0"}, "seconds must be a float"),
        ({"seconds": True}, "seconds must be a float"),
        ({"events": 1.0}, "events must be a int"),
        ({"stage": ""}, "stage must be a str"),
        ({"stage": 3}, "stage must be a str"),
        ({"colour": 1}, "see colour"),
    ],
)
def test_a_wrong_cell_writes_nothing(tmp_path, change, message):
    with pytest.raises(ValueError, match=message):
        tables.write(tmp_path / "x.csv", "cost", [COST_ROW, {**COST_ROW, **change}])
    with pytest.raises(ValueError, match="see seconds"):
        tables.write(
            tmp_path / "x.csv",
            "cost",
            [{k: COST_ROW[k] for k in COST_ROW if k != "seconds"}],
        )
    with pytest.raises(ValueError, match="table must be one of"):
        tables.write(tmp_path / "x.csv", "costs", [COST_ROW])
    assert not (tmp_path / "x.csv").exists()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "must be a theory table"),
        ("radius,quantity\n", "must be a theory table"),
        ("radius,quantity,exact\n0.1,volume,1.0,\n", "line 2"),
        ("radius,quantity,exact\n0.1,volume,1.0\n0.1,volume\n", "line 3"),
        ("radius,quantity,exact\nr,volume,1.0\n", "line 2"),
        ("radius,quantity,exact\n0.1,volume,nan\n", "line 2"),
    ],
)
def test_a_wrong_file_is_named(tmp_path, text, message):
    (tmp_path / "theory.csv").write_text(text)
    with pytest.raises(ValueError, match=message):
        tables.read(tmp_path / "theory.csv", "theory")


def test_every_column_is_documented():
    text = tables.documentation()
    for name, table in tables.TABLES.items():
        assert f"## {name}.csv" in text
        assert len(set(table.names)) == len(table.names)
        for column in table.columns:
            meaning = column.meaning.replace("|", "\\|").replace("<", "&lt;")
            assert f"| `{column.name}` | {column.unit or '–'} | {meaning} |" in text
    for line in text.splitlines():
        if line.startswith("|"):
            assert line.replace("\\|", "").count("|") == 4
    assert "How to read check.csv" in text


def test_contract_columns_are_there():
    contract = {
        "mean_times": "radius,event,exact,estimate,stderr,z,count,ergodic_components",
        "volume": "radius,quantity,method,exact,estimate,stderr,z,samples",
        "areas": "radius,quantity,method,exact,estimate,stderr,z,samples",
        "cost": "stage,radius,events,seconds,forecast_seconds",
    }
    for name, columns in contract.items():
        assert set(columns.split(",")) <= set(tables.TABLES[name].names)


@pytest.mark.parametrize(
    ("module", "absent"),
    [
        ("twodiscs.tables", ("numpy", "scipy", "pandas")),
        ("twodiscs.cli.check", ("numpy", "scipy", "pandas")),
        ("twodiscs.cli.tables", ("scipy.stats", "pandas", "numba", "matplotlib")),
    ],
)
def test_imports_stay_light(module, absent):
    code = f"import sys, {module}; print(*(m for m in {absent!r} if m in sys.modules))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == ""


# Monte Carlo ----------------------------------------------------------------------------------


def test_rows_of_monte_carlo(exact, laws):
    rng = np.random.default_rng(1)
    points = [law.monte_carlo(rng, 10**8) for law in laws]
    volume = rows.volume_rows(exact, points[::-1])
    assert [row["radius"] for row in volume] == list(RADII)
    areas = rows.area_rows(SCENE, exact, points[::-1])
    assert [(row["radius"], row["quantity"]) for row in areas] == [
        (radius, f"{event}_area") for radius in RADII for event in EVENTS
    ]
    for row in volume + areas:
        if row["status"] == "sampled":
            assert row["estimate"] == pytest.approx(row["expectation"], abs=6 * row["stderr"])
            assert abs(row["z"]) < 6
        assert row["bias"] == row["expectation"] - row["exact"]
    for row in areas:
        blocked = row["exact"] == 0
        assert (row["status"] == "impossible") == blocked
        hop = row["quantity"].removesuffix("_area")
        assert blocked == (not Scene(**BOX, radius=row["radius"]).is_possible(hop))


def test_the_whole_wall_area_is_four_times_right_and_top(exact, laws):
    point = laws[1].monte_carlo(np.random.default_rng(2), 10**7)
    rows = {r["quantity"]: r for r in rows.area_rows(SCENE, exact, [point])}
    right, top, whole = (rows[f"{e}_area"] for e in ("right_wall", "top_wall", "any_wall"))
    assert whole["estimate"] == pytest.approx(4 * (right["estimate"] + top["estimate"]), rel=1e-14)
    assert whole["expectation"] == 4 * (right["expectation"] + top["expectation"])
    # In these points the two shells are hit independently, so variances add up.
    assert whole["stderr"] == pytest.approx(
        4 * math.hypot(right["stderr"], top["stderr"]), rel=1e-2
    )
    correlated = {**point, "right_and_top": min(right["hits"], top["hits"])}
    rows = {r["quantity"]: r for r in rows.area_rows(SCENE, exact, [correlated])}
    assert rows["any_wall_area"]["stderr"] > 1.1 * whole["stderr"]


def test_only_watched_areas_have_rows(exact, laws):
    point = laws[1].monte_carlo(np.random.default_rng(2), 10**6)
    rows = rows.area_rows(SCENE, exact, [point], ("any_wall", "vertical_hop"))
    assert [row["quantity"] for row in rows] == ["vertical_hop_area", "any_wall_area"]
    assert rows.volume_rows(exact, [{**point, "quantities": {}}]) == []


def part_row(hits, samples, expectation=0.5, exact=0.5):
    part = {"hits": hits, "measure": 1.0, "epsilon": 0.1}
    point = {"radius": 0.1, "method": "monte_carlo", "samples": samples, "quantities": {"it": part}}
    return rows._sampled_row(point, "it", exact, expectation)


@pytest.mark.parametrize(
    ("hits", "status"),
    [(0, "none-seen"), (1, "too-few"), (99, "too-few"), (100, "sampled"), (900, "sampled"),
     (901, "too-few"), (1000, "too-few")],
)  # fmt: skip
def test_few_hits_or_misses_show_no_error(hits, status):
    row = part_row(hits, 1000)
    assert row["status"] == status
    assert (row["estimate"] is None) == (hits == 0)
    assert (row["stderr"] is None) == (status != "sampled")
    assert row["test"] == "exact-tail"
    assert row["z"] is not None


def test_the_shell_of_a_blocked_hop_must_be_as_empty_as_it_is():
    assert part_row(0, 1000, 0.0, 0.0)["z"] == 0
    assert part_row(1, 1000, 0.0, 0.0)["z"] == math.inf
    # A thick shell reaches beyond the blocked surface itself.
    row = part_row(500, 1000, 0.5, 0.0)
    assert (row["status"], row["bias"]) == ("impossible", 0.5)
    assert abs(row["z"]) < 1


# Molecular dynamics ---------------------------------------------------------------------------


def time_row(event="vertical_hop", radius=0.37, exact=50.0, **change):
    point = {
        "radius": radius,
        "duration": 10.0,
        "eligible": {event: 2048},
        "counts": {event: 0},
        "products": {f"{event}*{event}": 0},
        "target": {event: 3e-4},
        "status": {event: "budget"},
    }
    for key, value in change.items():
        point[key] = value if key == "duration" else {**point[key], **value}
    exact = {(radius, f"{event}_time"): exact}
    (row,) = rows.mean_time_rows(Scene(**BOX, radius=radius), exact, [point])
    return row


def counted(total, squares, event="vertical_hop"):
    return {"counts": {event: total}, "products": {f"{event}*{event}": squares}}


def test_rows_of_mean_times(exact, laws):
    rng = np.random.default_rng(3)
    points = [law.dynamics(rng) for law in laws]
    rows = rows.mean_time_rows(SCENE, exact, points[::-1])
    assert [(row["radius"], row["event"]) for row in rows] == [
        (r, e) for r in RADII for e in EVENTS
    ]
    for row in rows:
        scene = Scene(**BOX, radius=row["radius"])
        assert row["ergodic_components"] == scene.ergodic_components
        if scene.is_possible(row["event"]):
            assert row["status"] == "reached"
            assert row["estimate"] == pytest.approx(row["exact"], abs=6 * row["stderr"])
            assert row["relative_stderr"] == pytest.approx(row["stderr"] / row["estimate"])
            assert row["relative_stderr"] < 4e-4
            assert row["bound"] is None
            t = (row["estimate"] - row["exact"]) / row["stderr"]
            assert row["z"] == pytest.approx(t, abs=0.03)  # Student's law, and the count's side
        else:
            assert row["status"] == "impossible"
            assert row["z"] == row["count"] == 0
            assert row["estimate"] is row["stderr"] is row["exact"] is None


def test_a_wall_that_half_the_replicas_reach_counts_those(exact, laws):
    law = laws[RADII.index(0.3)]
    point = law.dynamics(np.random.default_rng(4))
    assert point["eligible"]["right_wall"] == point["replicas"] // 2
    rows = {row["event"]: row for row in rows.mean_time_rows(SCENE, exact, [point])}
    assert rows["right_wall"]["replicas"] == 512
    assert abs(rows["right_wall"]["z"]) < 5
    # Averaged over all initial conditions the right wall is hit half as often.
    assert rows["right_wall"]["exact"] == pytest.approx(0.5 / exact.rate(law.scene, "right_wall"))


def test_none_seen_gives_a_bound_and_no_estimate():
    row = time_row(exact=5e4)
    assert row["status"] == "none-seen"
    assert row["estimate"] is row["stderr"] is row["relative_stderr"] is None
    assert row["bound"] == estimates.mean_time_bound(2048, 10.0)
    assert abs(row["z"]) < 2
    # Where 400 were due, even four to a replica, to see none is wrong.
    assert time_row(exact=51.2)["z"] > 10
    nobody = time_row("right_wall", eligible={"right_wall": 0})
    assert nobody["status"] == "none-seen"
    assert nobody["z"] is nobody["bound"] is None


def test_too_few_events_show_no_error():
    row = time_row(exact=20480 / 60, **counted(60, 90))
    assert row["status"] == "too-few"
    assert row["estimate"] == pytest.approx(20480 / 60)
    assert row["stderr"] is row["relative_stderr"] is row["bound"] is None
    assert (row["z"], row["test"]) == (0.0, "cluster-bound")
    # 180 events in clusters of three are as good as 60.
    assert time_row(**counted(180, 540))["status"] == "too-few"
    row = time_row(**counted(300, 350))
    assert row["status"] == "budget"
    assert row["test"] == "cluster-bound"
    assert row["stderr"] > 0
    assert time_row(**counted(2000, 3000))["test"] == "normal"


def test_few_replicas_show_no_error():
    few = counted(10**6, 2 * 10**10)
    assert time_row(eligible={"vertical_hop": 99}, **few)["status"] == "too-few"


def test_a_blocked_hop_that_is_seen_has_an_infinite_score():
    row = time_row(radius=0.38, exact=None, **counted(1, 1))
    assert (row["status"], row["z"], row["count"]) == ("impossible", -math.inf, 1)


# Histogram and cost ---------------------------------------------------------------------------


def test_rows_of_the_histogram(exact, laws):
    rng = np.random.default_rng(5)
    points = [laws[i].intervals(rng) for i in (2, 1)]
    rows = rows.histogram_rows(exact, points)
    assert [row["radius"] for row in rows] == [0.1] * 12 + [0.2] * 12
    for row in rows:
        tau = row["exact_mean"]
        left, right = row["left"], row["right"]
        density = (math.exp(-left / tau) - math.exp(-right / tau)) / (right - left)
        assert row["density"] == pytest.approx(density, abs=5 * row["stderr"])
        assert abs(row["z"]) < 5
        assert row["z"] == pytest.approx((row["mean"] - tau) / row["mean_stderr"], rel=0.02)
    empty = {**points[0], "counts": [0, 5]}
    first, second = rows.histogram_rows(exact, [empty])
    assert (first["density"], first["stderr"]) == (0.0, None)
    assert second["stderr"] > 0
    few = rows.histogram_rows(exact, [{**points[0], "chains": 99}])
    assert few[0]["z"] is few[0]["mean_stderr"] is None


def test_cost_is_by_stage_and_radius(tmp_path, monkeypatch):
    cost = {"events": 5, "seconds": 0.5}
    paths = store(
        tmp_path, dict.fromkeys(("monte_carlo-0.1", "dynamics-0.1", "dynamics-1e-05"), cost)
    )
    (tmp_path / "a").mkdir()
    out = tmp_path / "a" / "cost.csv"
    arguments = ("cost", "--scene", BOX, "--points", *paths, "--output", out)
    assert command(monkeypatch, cli_tables, *arguments) == 0
    assert out.read_text() == (
        "stage,radius,events,seconds,forecast_seconds,ratio\n"
        "dynamics,1e-05,5,0.5,,\n"
        "dynamics,0.1,5,0.5,,\n"
        "monte_carlo,0.1,5,0.5,,\n"
    )


def test_cost_is_set_against_the_forecast_of_its_scene(tmp_path, monkeypatch):
    cost = {"events": 5, "seconds": 0.5}
    paths = store(
        tmp_path, dict.fromkeys(("monte_carlo-0.1", "dynamics-0.1", "dynamics-0.2"), cost)
    )
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
    tables.write(tmp_path / "forecast.csv", "forecast", forecasts)
    (tmp_path / "a").mkdir()
    out = tmp_path / "a" / "cost.csv"
    arguments = ("cost", "--scene", BOX, "--points", *paths, "--output", out)
    forecast = ("--forecast", tmp_path / "forecast.csv")
    assert command(monkeypatch, cli_tables, *arguments, *forecast) == 0
    assert out.read_text() == (
        "stage,radius,events,seconds,forecast_seconds,ratio\n"
        "dynamics,0.1,5,0.5,0.25,2.0\n"
        "dynamics,0.2,5,0.5,,\n"
        "monte_carlo,0.1,5,0.5,1.0,0.5\n"
        "total,,10,1.0,1.25,0.8\n"
    )


# Command line ---------------------------------------------------------------------------------


@pytest.fixture
def scene_files(tmp_path, laws):
    rng = np.random.default_rng(6)
    tables.write(tmp_path / "theory.csv", "theory", theory_rows())
    keys = [repr(radius) for radius in RADII]
    points = {
        "monte_carlo": [law.monte_carlo(rng, 10**7) for law in laws],
        "dynamics": [law.dynamics(rng, replicas=256, relative=1e-2) for law in laws],
        "intervals": [law.intervals(rng) for law in laws[:3]],
    }
    return {
        kind: store(tmp_path / kind, dict(zip(keys, found, strict=False)))
        for kind, found in points.items()
    }


def test_the_order_of_files_does_not_matter(tmp_path, monkeypatch, scene_files):
    for name, kinds in cli_tables.TAKES.items():
        if name == "cost":
            continue
        paths = [path for kind in kinds for path in scene_files[kind]]
        written = []
        for order in (paths, paths[::-1]):
            out = tmp_path / f"{name}.csv"
            status = command(
                monkeypatch, cli_tables, name, "--scene", BOX, "--theory", tmp_path / "theory.csv",
                "--points", *order, "--output", out,
            )  # fmt: skip
            assert status == 0
            written.append(out.read_bytes())
        assert written[0] == written[1]
        assert b"\r" not in written[0]
        assert tables.read(out, name)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"name": "area"}, "area"),
        ({"--scene": "{'width': 1.5}"}, "height"),
        ({"--scene": "{'width': -1.5, 'height': 1.0}"}, "width must be"),
        ({"--scene": "width"}, "dict"),
        ({"--theory": "absent.csv"}, "absent.csv"),
        ({"--theory": None}, "needs --theory"),
        ({"--points": "absent.json"}, "absent.json"),
        ({"--points": "broken.json"}, "broken.json is not the file of a point"),
        ({"--points": "nan.json"}, "nan.json is not the file of a point"),
        ({"--points": "list.json"}, "list.json is not the file of a point"),
        ({"--points": "thin.json"}, "samples"),
        ({"--points": "other.json"}, "no volume at radius 0.11"),
        ({"--points": "negative.json"}, "hits must be"),
        ({"name": "mean_times"}, "of no use to mean_times.csv"),
        ({"name": "cost", "--points": "cost.json"}, "must be called"),
        ({"--points": "twice"}, "radius 0.1 twice"),
    ],
)
def test_mistakes_get_one_sentence(tmp_path, monkeypatch, capsys, change, message):
    tables.write(tmp_path / "theory.csv", "theory", theory_rows())
    part = {"hits": 5, "measure": 1.0, "epsilon": None}
    point = {"radius": 0.1, "samples": 10, "quantities": {"volume": part}}
    good = store(tmp_path, {"good": point, "again": point})
    wrong = {
        "other": {**point, "radius": 0.11},
        "thin": {"radius": 0.1, "quantities": {"volume": part}},
        "negative": {**point, "quantities": {"volume": {**part, "hits": -1}}},
        "cost": {"events": 1, "seconds": 1.0},
        "list": [1],
    }
    store(tmp_path, wrong)
    (tmp_path / "broken.json").write_text("{")
    (tmp_path / "nan.json").write_text('{"quantities": NaN}')
    out = tmp_path / "out.csv"
    options = {"name": "volume", "--scene": BOX, "--theory": "theory.csv", "--points": good[0]}
    options |= change
    line = [options.pop("name"), "--output", out]
    for option, value in options.items():
        if value == "twice":
            line += [option, *good]
        elif value is not None:
            line += [option, value]
    monkeypatch.chdir(tmp_path)
    assert command(monkeypatch, cli_tables, *line) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1
    assert "Traceback" not in error
    assert not out.exists()
