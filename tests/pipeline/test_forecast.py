"""The forecast: events as they will be, sums that add up, and what it says."""

import json
import sys

import pytest

from twodiscs.comparison.scene_tables import Forecast
from twodiscs.dynamics import counting, intervals
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene
from twodiscs.pipeline import forecast
from twodiscs.pipeline.configuration.load import load
from twodiscs.pipeline.configuration.request import STAGES
from twodiscs.studies.catalogue import STUDIES

BOX = {"width": 1.5, "height": 1.0}


def job(radius, accuracy, budget=10**9, seed=1):
    return {
        "box": BOX, "radius": radius, "seed": seed, "event_budget": budget,
        "accuracy": dict.fromkeys(EVENTS, accuracy),
    }  # fmt: skip


@pytest.mark.parametrize("radius", [0.01, 0.1, 0.2, 0.24, 0.26, 0.36, 0.38])
@pytest.mark.parametrize("accuracy", [2e-2, 2e-3])
def test_events_are_those_of_the_job(radius, accuracy):
    """Within a half either way; pilot and job have random numbers of their own."""
    asked = job(radius, accuracy, budget=10**8)
    scene = Scene(1.5, 1.0, radius)
    spent = counting.count_events(scene, asked["accuracy"], asked["event_budget"], 1)["events"]
    assert 1 / 1.5 < spent / forecast.pilot_dynamics(asked).events < 1.5


def test_a_budget_is_not_exceeded():
    assert forecast.pilot_dynamics(job(0.2, 1e-6, budget=10**7)).events == 10**7
    assert forecast.pilot_dynamics(job(0.2, 0.5, budget=1)).events < 10**6


def test_a_blocked_hop_costs_a_first_round():
    asked = job(0.3, 1e-6) | {"accuracy": {"horizontal_hop": 1e-6}}
    first = forecast.pilot_dynamics(asked).events
    spent = counting.count_events(Scene(1.5, 1.0, 0.3), asked["accuracy"], 10**9, 1)["events"]
    assert abs(first / spent - 1) < 0.01


def test_samples_and_intervals_come_in_blocks():
    sampled = {"box": BOX, "radius": 0.2, "areas": ["top_wall"], "volume": True, "shell": 0.02}
    pilot = forecast.pilot_monte_carlo(sampled | {"samples": 1})
    assert pilot.events == 1 << 20
    assert pilot.seconds_per_million > 0
    drawn = {"box": BOX, "radius": 0.2, "event": "horizontal_hop", "intervals": 10**5}
    drawn["event_budget"] = 10**8
    assert forecast.pilot_intervals(drawn).events == 2 * intervals.CHAINS * intervals.RETURNS


CONFIGURATION = {
    "accuracy_cost": {"seconds": 7},
    "scenes": [
        {
            **{"name": "a", "box": BOX, "radii": [0.1, 0.2], "watch": {"mean_times": True}},
            "accuracy": 1e-4,  # worth a job for each radius
        },
        {"name": "b", "box": BOX, "radii": [0.3], "watch": {"volume": True, "trajectory": 0.2}},
    ],
}


STARTS = {kind: forecast.Start(0.5, 0.25) for kind in (*STAGES, "tables", "figures")}


@pytest.fixture
def quick(monkeypatch):
    """Pilots of 5 events at 2e5 s per million and starts of 0.5 s and 0.25 s, without any run."""
    monkeypatch.setattr(forecast, "run_samples", lambda kinds, cores: STARTS)
    monkeypatch.setattr(
        forecast, "run_pilots", lambda jobs, cores: [forecast.Pilot(5, 2e5) for _ in jobs]
    )


@pytest.fixture
def rows(quick):
    return forecast.rows(load(CONFIGURATION), 2)


def of(rows, **where):
    return [row for row in rows if all(row[key] == value for key, value in where.items())]


def test_every_job_has_a_row(rows):
    assert [row["radius"] for row in of(rows, scene="a", stage="dynamics")] == [0.1, 0.2, None]
    assert [row["radius"] for row in of(rows, scene="b", stage="monte_carlo")] == [0.3, None]
    assert not of(rows, scene="a", stage="monte_carlo")
    assert all(row["seconds"] == 1.5 for row in rows if row["radius"])


def test_sums_add_up(rows):
    (stage,) = of(rows, scene="a", stage="dynamics", radius=None)
    assert (stage["jobs"], stage["events"], stage["seconds"], stage["startup"]) == (2, 10, 3, 0.5)
    assert stage["wall_clock"] == 1.75
    for scene in ("a", "b"):
        parts = [row for row in of(rows, scene=scene, radius=None) if row["stage"] != "total"]
        (total,) = of(rows, scene=scene, stage="total")
        for name in ("jobs", "seconds", "startup"):
            assert total[name] == pytest.approx(sum(row[name] for row in parts))
    assert rows[-1]["scene"] == "all"
    assert rows[-1]["stage"] == "total"
    (comparison,) = of(rows, stage="accuracy_cost")
    other = load(CONFIGURATION | {"accuracy_cost": {"seconds": 9}})
    (longer,) = of(forecast.rows(other, 2), stage="accuracy_cost")
    assert longer["startup"] == comparison["startup"] + 2 > 7
    # One job does not go faster on two cores.
    assert comparison["wall_clock"] == comparison["seconds"] + comparison["startup"]


def test_the_table_takes_them(rows, tmp_path):
    Forecast.write(tmp_path / "forecast.csv", rows)
    assert Forecast.read(tmp_path / "forecast.csv") == rows


def test_what_is_printed(rows, monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(forecast, "rows", lambda configuration, cores: rows)
    arguments = ["forecast", "--configuration", json.dumps(CONFIGURATION), "--cores", "2"]
    monkeypatch.setattr(sys, "argv", [*arguments, "--output", str(tmp_path / "forecast.csv")])
    forecast.main()
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split() == ["scene", "stage", "jobs", "events", "one", "core", "2", "cores"]
    assert lines[1].split() == ["a", "dynamics", "2", "10", "3.5", "s", "1.8", "s"]
    assert lines[-1].startswith("all             total")
    assert (tmp_path / "forecast.csv").exists()


def test_durations_as_people_say_them():
    assert [forecast.duration(s) for s in (1, 99, 100, 7200)] == [
        "1.0 s",
        "99.0 s",
        "1.7 min",
        "2.0 h",
    ]


@pytest.mark.parametrize("cores", [0, -1, 1.5, True])
def test_no_cores(cores):
    with pytest.raises(ValueError, match="cores must be an integer"):
        forecast.rows(load(CONFIGURATION), cores)


def test_a_sample_job_runs():
    start = forecast._run_sample("tables")
    assert start.loading == 0
    assert start.startup > 0


@pytest.mark.parametrize("names", [[], ["report", "errata"], ["accuracy_cost"]])
def test_what_is_built_once_is_forecast_if_asked_for(quick, names):
    asked = load(CONFIGURATION | {"shared": names})
    found = [row["stage"] for row in of(forecast.rows(asked, 1), scene="all")]
    assert found == ["compile", *asked.shared, "total"]


def test_all_that_is_built_once_has_a_time(rows):
    shared = {row["stage"]: row for row in of(rows, scene="all")}
    studies = [name for name, study in STUDIES.items() if study.shared]
    assert {*studies, *forecast.DOCUMENTS, "compile", "total"} == {*shared}
    assert all(row["startup"] > 0 for row in shared.values())


def test_a_scene_with_effects_is_forecast():
    """Events as in the job; tables and figures are those that have a place on a torus."""
    torus = {"box": BOX | {"effects": {"periodic": "xy"}}, "radius": 0.2, "seed": 1}
    asked = torus | {"accuracy": {"disc_collision": 2e-3}, "event_budget": 10**8}
    scene = Scene(1.5, 1.0, 0.2, periodic="xy")
    spent = counting.count_events(scene, asked["accuracy"], 10**8, 1)["events"]
    assert 1 / 1.5 < spent / forecast.pilot_dynamics(asked).events < 1.5
    sampled = {"areas": ["disc_collision"], "volume": True, "shell": 0.02, "samples": 3 << 20}
    assert forecast.pilot_monte_carlo(torus | sampled).events == 3 << 20
    (request,) = load(
        {"scenes": [{"name": "a", "box": BOX, "effects": {"periodic": ["x", "y"]}}]}
    ).scenes
    rows = forecast.scene_rows(
        request,
        [forecast.Pilot(1, 1.0) for _ in forecast.jobs_of(request)],
        STARTS,
        1,
    )
    # Grid, theory, volume, areas, mean times, check and cost; and a figure of each of three.
    assert [row["jobs"] for row in rows if row["stage"] == "tables"] == [7]
    assert [row["jobs"] for row in rows if row["stage"] == "figures"] == [3]


def test_a_point_in_shards_is_as_many_jobs():
    """What is under ``shard_events`` is one job; ten shards keep four cores busy."""
    scene = {"name": "a", "box": BOX, "radii": [0.1], "event_budget": 1e9}
    for limit, jobs, cores in ((1e9, 1, 1), (1e8, 10, 4)):
        (request,) = load({"shard_events": limit, "scenes": [scene]}).scenes
        pilots = [
            forecast.Pilot(10**9 if stage == "dynamics" else 1, 1.0)
            for stage, _ in forecast.jobs_of(request)
        ]
        rows = forecast.scene_rows(request, pilots, STARTS, 4)
        (row,) = (row for row in rows if row["stage"] == "dynamics" and row["radius"])
        assert row["jobs"] == jobs
        start = STARTS["dynamics"]
        assert row["seconds"] == 1000 + jobs * start.loading
        assert row["startup"] == jobs * start.startup
        assert row["wall_clock"] == (row["seconds"] + row["startup"]) / cores


def test_a_bundle_is_one_job_that_starts_once():
    scene = {"name": "a", "box": BOX, "watch": {"mean_times": ["top_wall"]}}
    scene |= {"radii": [round(0.01 + i * 1e-4, 4) for i in range(1001)]}
    (request,) = load({"scenes": [scene]}).scenes
    pilots = [forecast.Pilot(10**6, 1.0) for _ in forecast.jobs_of(request)]
    rows = forecast.scene_rows(request, pilots, STARTS, 4)
    (whole,) = (row for row in rows if row["stage"] == "dynamics" and row["radius"] is None)
    jobs, start = len(request.bundles["dynamics"]), STARTS["dynamics"]
    assert whole["jobs"] == jobs < 100
    assert whole["startup"] == pytest.approx(jobs * start.startup)
    assert whole["seconds"] == pytest.approx(1001 + jobs * start.loading)
