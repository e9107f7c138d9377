"""The forecast: the numbers of events, sums that add up, and its text."""

import json
import sys

import pytest

from twodiscs.comparison.tables.cost import Forecast
from twodiscs.dynamics.counting import CountingRun
from twodiscs.dynamics.intervals import CHAINS, RETURNS
from twodiscs.model.box import Box
from twodiscs.model.events import EVENTS
from twodiscs_paper.catalogue import STUDIES
from twodiscs_paper.configuration.load import load
from twodiscs_paper.pipeline import cost, forecast

BOX = {"width": 1.5, "height": 1.0}


def run(radius, accuracy, budget=10**9, events=EVENTS, discs=2, **effects):
    """Return the run of a job of dynamics."""
    scene = Box(1.5, 1.0, effects, discs).scene(radius)
    return CountingRun(scene, dict.fromkeys(events, accuracy), budget, 1)


@pytest.mark.parametrize("radius", [0.01, 0.1, 0.2, 0.24, 0.26, 0.36, 0.38])
@pytest.mark.parametrize("accuracy", [2e-2, 2e-3])
def test_events_are_those_of_the_job(radius, accuracy):
    """Within a half either way: the pilot is the first blocks of the job."""
    work = run(radius, accuracy, budget=10**8)
    assert 1 / 1.5 < work.run().events / forecast.pilot(work).events < 1.5


def test_a_scene_with_effects_is_forecast():
    work = run(0.2, 2e-3, 10**8, ["disc_collision"], periodic="xy")
    assert 1 / 1.5 < work.run().events / forecast.pilot(work).events < 1.5


@pytest.mark.parametrize(
    ("discs", "radius"),
    [(3, 0.1), (3, 0.26), (4, 0.1), pytest.param(4, 0.26, marks=pytest.mark.slow)],
)
def test_more_discs_are_forecast(discs, radius):
    """The price does not need an exact value, except for the first guess for four discs."""
    work = run(radius, 1e-2, 10**8, ["disc_collision", "top_wall"], discs=discs)
    assert 1 / 1.5 < work.run().events / forecast.pilot(work).events < 1.5
    block = {"discs": discs, "radii": [radius], "watch": {"mean_times": True, "volume": True}}
    asked = scene(**block, accuracy="draft", monte_carlo={"samples": 1e5})
    assert 1e-4 < cost.seconds(asked, "dynamics", radius) < 100
    assert cost.minutes(asked, "dynamics") >= cost.MINUTES
    assert cost.seconds(asked, "monte_carlo", radius) > 1e5 / cost.SAMPLES_PER_SECOND
    drawn = forecast.pilot(cost.run_of(asked, "monte_carlo", radius))
    assert drawn.events == pytest.approx(1e5, rel=0.05)


def test_a_budget_is_not_exceeded():
    assert forecast.pilot(run(0.2, 1e-6, budget=10**7)).events == pytest.approx(10**7, rel=0.1)
    assert forecast.pilot(run(0.2, 0.5, budget=1)).events < 10**6


def scene(**block):
    """Return the request of a scene."""
    (request,) = load({"shared": [], "scenes": [{"name": "a", "box": BOX} | block]}).scenes
    return request


def test_samples_and_intervals_come_in_blocks():
    drawn = {"radii": [0.2], "intervals": 1e5, "event": "horizontal_hop"}
    asked = scene(radii=[0.2], watch={"volume": True, "hop_histogram": drawn})
    pilot = forecast.pilot(cost.run_of(asked, "monte_carlo", 0.2))
    assert pilot.events == pytest.approx(asked.monte_carlo["samples"], rel=0.02)
    assert pilot.seconds > 0
    pilot = forecast.pilot(cost.run_of(asked, "intervals", 0.2))
    each = cost.run_of(asked, "intervals", 0.2).parts["all"].block_events / (CHAINS * RETURNS)
    assert pilot.events == pytest.approx(2 * CHAINS * RETURNS * each)


def test_many_radii_have_some_pilots_near_by():
    radii = [round(0.01 + i * 1e-4, 4) for i in range(1001)]
    some, near = forecast.thinned(radii)
    assert len(some) <= forecast.MOST_PILOTS
    assert {*near} == {*some} <= {*radii}
    assert max(abs(a - b) for a, b in zip(near, radii, strict=True)) < 2e-3


CONFIGURATION = {
    "shared": ["paper", "report"],
    "accuracy_cost": {"seconds": 7},
    "scenes": [
        {"name": "a", "box": BOX, "radii": [0.1, 0.2], "watch": {"mean_times": True}},
        {"name": "b", "box": BOX, "radii": [0.3], "watch": {"volume": True, "trajectory": 0.2}},
    ],
}


@pytest.fixture
def quick(monkeypatch):
    """Pilots of 5 events in a second and starts of 0.25 s, without any run."""
    starts = dict.fromkeys(forecast.NOTHING, 0.25)
    monkeypatch.setattr(forecast, "starts", lambda: starts)
    monkeypatch.setattr(
        forecast, "run_pilots", lambda jobs, cores: [forecast.Pilot(5, 1.0) for _ in jobs]
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
    assert all(row["seconds"] == 1.0 for row in rows if row["radius"])


def test_sums_add_up(rows):
    (stage,) = of(rows, scene="a", stage="dynamics", radius=None)
    assert (stage["jobs"], stage["events"], stage["seconds"], stage["startup"]) == (2, 10, 2, 0.5)
    assert stage["wall_clock"] == 1.25
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
    assert lines[1].split() == ["a", "dynamics", "2", "10", "2.5", "s", "1.2", "s"]
    assert lines[-1].startswith("all             total")
    assert (tmp_path / "forecast.csv").exists()


def test_durations_as_people_say_them():
    assert [forecast.duration(s) for s in (1, 99, 100, 7200)] == [
        "1.0 s",
        "99.0 s",
        "1.7 min",
        "2.0 h",
    ]


@pytest.mark.parametrize(("shared", "drawings"), [(["report"], 0), (["paper", "report"], 5)])
def test_figures_are_those_of_the_build(quick, shared, drawings):
    asked = load(CONFIGURATION | {"shared": shared, "scenes": CONFIGURATION["scenes"][:1]})
    (row,) = of(forecast.rows(asked, 2), scene="a", stage="figures")
    assert row["jobs"] == drawings + 4


@pytest.mark.parametrize("cores", [0, -1, 1.5, True])
def test_no_cores(quick, cores):
    with pytest.raises(ValueError, match="cores must be an integer"):
        forecast.rows(load(CONFIGURATION), cores)


def test_jobs_that_do_nothing_run():
    assert all(seconds > 0 for seconds in forecast.starts().values())


@pytest.mark.parametrize("names", [[], ["report", "errata"], ["accuracy_cost"]])
def test_what_is_built_once_is_forecast_if_asked_for(quick, names):
    asked = load(CONFIGURATION | {"shared": names})
    found = [row["stage"] for row in of(forecast.rows(asked, 1), scene="all")]
    assert found == ["compile", *asked.shared, "total"]


def test_all_that_is_built_once_has_a_time(rows):
    shared = {row["stage"]: row for row in of(rows, scene="all")}
    assert {*STUDIES, *forecast.DOCUMENTS, "compile", "total"} == {*shared}
    assert all(row["startup"] > 0 for row in shared.values())


def test_a_point_in_shards_is_as_many_jobs(quick):
    block = {"name": "a", "box": BOX, "radii": [0.3], "watch": {"mean_times": True}}
    block |= {"accuracy": 1e-4, "event_budget": 1e12}
    (request,) = load({"shared": [], "shard_events": 1e8, "scenes": [block]}).scenes
    shards = cost.shards(request, "dynamics", 0.3)
    assert len(shards) > 3
    (row,) = of(forecast.scene_rows(request, 0, 4, forecast.starts()), radius=0.3)
    assert row["jobs"] == len(shards) + 1
    assert row["startup"] == 0.25 * row["jobs"]
