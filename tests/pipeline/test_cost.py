"""Plans of jobs: their work, limits of time and shards.

Without these tests a job could be killed at its limit, or blocks be counted twice or never.
"""

from dataclasses import replace

import pytest
from factory import write_rows

from twodiscs.analysis.tables import CostTable, MeanTimesTable
from twodiscs.points.base import file_content, write_json
from twodiscs_paper.catalogue import STUDIES
from twodiscs_paper.configuration.yaml_files import load
from twodiscs_paper.pipeline import job_cost

BLOCK = {"name": "a", "box": {"width": 1.5, "height": 1.0}}


def scene(**keys):
    """Return the request of a scene with these ``keys`` in its block, or in the configuration."""
    top = {name: keys.pop(name) for name in ("shard_events",) if name in keys}
    return load({"shared": [], **top, "scenes": [BLOCK | {"radii": [0.24, 0.3]} | keys]}).scenes[0]


def test_a_limit_is_above_the_price():
    """This holds for a job that only has hops in a strip, too, whose events cost more."""
    whole = scene(accuracy=1e-5, event_budget=1e12)
    keys = {"accuracy": 1e-8, "radii": [0.24, 0.24999975, 0.3]}
    requests = [
        scene(event_budget=budget, watch={"mean_times": watched}, **keys)
        for budget in (1e8, 1e9, 5e9, 2e10, 9e10)
        for watched in (["horizontal_hop"], ["horizontal_hop", "top_wall"])
    ]
    for request in (whole, *requests):
        for stage in ("monte_carlo", "dynamics"):
            limit = 60 * job_cost.minutes(request, stage)
            for radius in request.keys[stage].values():
                jobs = len(job_cost.shards(request, stage, radius)) or 0.5
                assert limit > job_cost.seconds(request, stage, radius) / jobs
    # Shards do not last longer if the budget is larger.
    more, less = (scene(accuracy=1e-5, event_budget=budget) for budget in (1e14, 1e8))
    limits = [job_cost.minutes(one, "dynamics") for one in (less, whole, more)]
    assert limits[0] < limits[1] == limits[2]


def test_days_are_those_of_the_jobs_of_all_radii_or_of_some_times_their_number(monkeypatch):
    radii = [round(0.1 + 0.001 * i, 3) for i in range(21)]
    request = scene(accuracy=1e-7, event_budget=1e15, radii=radii, watch={"mean_times": True})
    whole = sum(job_cost.seconds(request, "dynamics", radius) for radius in radii) / 86400
    for some, worst in ((21, 1e-6), (7, 0.1)):
        monkeypatch.setattr(job_cost, "TRIED_RADII", some)
        assert job_cost.days([request]) == pytest.approx(whole, rel=worst)
    assert job_cost.days([scene()]) < 0.1


def test_without_a_budget_the_events_of_a_radius_may_take_a_day():
    request = scene()
    most = job_cost._most(request, "dynamics") / job_cost.DEAREST_EVENT
    assert job_cost._seconds(request, most) == 86400


@pytest.mark.parametrize(("discs", "event"), [(3, job_cost.DEAREST_EVENT), (64, 2048)])
def test_an_event_of_many_discs_costs_as_much_as_their_pairs(discs, event):
    request = scene(discs=discs, radii=[0.05], event_budget=1e9, monte_carlo={"samples": 1e6})
    assert job_cost._most(request, "dynamics") == event * 1e9
    assert job_cost._most(request, "monte_carlo") == job_cost.DRAW_COST * discs * 1e6


@pytest.mark.parametrize("stage", ["monte_carlo", "dynamics", "intervals"])
def test_shards_cover_all_blocks_once(stage):
    request = scene(
        shard_events=1e7, accuracy=1e-3, event_budget=1e12, monte_carlo={"samples": 1e9},
        watch={"volume": True, "mean_times": True,
               "hop_histogram": {"radii": [0.24], "intervals": 1e7}},
    )  # fmt: skip
    components = job_cost.run_at(request, stage, 0.24).components
    shards = job_cost.shards(request, stage, 0.24)
    assert {component for component, *_ in shards} == {*components}
    for component, run in components.items():
        ranges = sorted((first, stop) for name, first, stop in shards if name == component)
        starts, stops = zip(*ranges, strict=True)
        assert (*starts, run.planned) == (0, *stops)
        most = max(stop - first for first, stop in ranges)
        assert most == 1 or most * run.block_events * run.cost_ratio <= request.shard_events


@pytest.mark.parametrize(("error", "times"), [(1e-3, 1.01), (7e-5, 1.5), (1e-4, 10.0)])
def test_a_tighter_accuracy_keeps_the_shards_but_the_last(error, times):
    """They are ranges of one grid: of each component all but the last one stay."""
    found = [
        job_cost.shards(scene(shard_events=1e8, accuracy=e, event_budget=1e15), "dynamics", 0.24)
        for e in (error, error / times)
    ]
    for component in ("all", "horizontal_hop"):
        coarse, fine = ([shard for shard in some if shard[0] == component] for some in found)
        assert {*coarse[:-1]} <= {*fine}


def test_the_limit_of_a_study_grows_with_what_is_asked_of_it():
    def limit(seconds):
        configuration = load({"accuracy_cost": {"seconds": seconds}, "scenes": [BLOCK]})
        return job_cost.study_minutes(STUDIES["accuracy_cost"], configuration)

    assert 60 * limit(1e6) > 1e6
    assert limit(1) < 60


# Errors of a forecast and of a run ----------------------------------------------------------------


@pytest.mark.parametrize("radius", [0.01, 0.2, 0.24, 0.3, 0.38])
def test_the_bound_on_the_events_of_an_accuracy_is_not_below_the_plan(radius):
    for accuracy in (1e-2, 1e-4, {"default": 1e-2, "top_wall": 1e-4}):
        request = scene(radii=[radius], accuracy=accuracy, event_budget=1e15)
        components = job_cost.run_at(request, "dynamics", radius).components
        events = components["all"].planned * components["all"].block_events
        assert job_cost._events(request, radius) * 1.07 + components["all"].block_events >= events
    assert job_cost._events(request, radius) < float("inf")
    for effects in ({"discs": 3}, {"effects": {"moment_of_inertia": 0.5}}):
        assert job_cost._events(scene(radii=[0.1], **effects), 0.1) == float("inf")
    channel = {"box": {"width": 4.0, "height": 1.0}, "radii": [0.28], "discs": 4}
    assert job_cost._interval_events(scene(**channel), 0.28) == float("inf")
    for discs in (2, 3) if radius < 0.25 else ():
        histogram = {"hop_histogram": {"radii": [radius], "intervals": 1e5}}
        request = scene(radii=[radius], discs=discs, watch=histogram)
        run = job_cost.run_at(request, "intervals", radius).components["all"]
        work = run.planned * run.block_work
        assert work <= job_cost._most(request, "intervals", radius) < request.shard_events


def test_a_dry_run_says_which_accuracies_are_not_reached(blocks, monkeypatch, tmp_path):
    """Those of points that are built are measured, so no pilot runs."""
    monkeypatch.chdir(tmp_path)
    short = scene(accuracy=1e-5, event_budget=2e9, radii=[0.2, 0.3])
    others = scene(name="b", accuracy=1e-2), scene(name="c", event_budget=1e12)
    configuration = replace(load({"scenes": [BLOCK]}), scenes=(short, *others))
    lines = job_cost.shortfalls(configuration)
    assert [line.partition(":")[0] for line in lines] == ["a, radius 0.2", "a, radius 0.3"]
    assert all("of 1e-5, but the budget of 2e9 events ends the run at" in line for line in lines)
    assert "(horizontal_hop_time). A budget of" in lines[0]
    monkeypatch.setattr(job_cost, "SENTENCES", 1)
    more = "1 more radii may stop early: see the target forecast"
    assert job_cost.shortfalls(configuration) == [lines[0], more]
    for radius, error in ((0.2, 1e-5), (0.3, 1e-2)):
        point = job_cost.run_at(scene(accuracy=1e-2), "dynamics", radius).run()
        parts = {"all": point.components["all"] | {"target": dict.fromkeys(point.target, error)}}
        path = tmp_path / f"results/a/points/dynamics/{radius}.json"
        path.parent.mkdir(parents=True, exist_ok=True)
        settings = short.arguments("dynamics")
        write_json(path, file_content("simulate", point.scene.parameters(), settings, parts))
    changed = scene(accuracy=2e-5, event_budget=2e9, radii=[0.2])
    (line,) = job_cost.shortfalls(replace(configuration, scenes=(changed,)))
    assert "of 2e-5, but the budget of 2e9 events ends the run" in line
    monkeypatch.setattr(job_cost, "run_at", None)
    (line,) = job_cost.shortfalls(replace(configuration, scenes=(short,)))
    assert line.startswith("a, radius 0.2: You asked for an error of 1e-5, but the budget")


def test_a_forecast_has_a_row_for_each_job_and_their_sum(blocks):
    keys = {"volume": True, "mean_times": True, "hop_histogram": [0.2]}
    block = BLOCK | {"radii": [0.2, 0.3], "watch": keys, "monte_carlo": {"samples": 1e7}}
    block |= {"accuracy": 1e-5, "event_budget": 2e9}
    lines = job_cost.table(load({"shared": ["stability"], "scenes": [block]})).splitlines()
    rows = [line.split() for line in lines[2:7]]
    assert [row[:3] for row in rows] == [
        ["a", "monte_carlo", "0.2"], ["a", "monte_carlo", "0.3"], ["a", "dynamics", "0.2"],
        ["a", "dynamics", "0.3"], ["a", "intervals", "0.2"],
    ]  # fmt: skip
    # Ten blocks of 2^20 samples, of a millisecond each; the error is that of the exact fraction.
    assert rows[0][3:5] == ["10", "ms"]
    assert rows[0][-1] == "volume"
    assert rows[2][-3] == "1e-5"
    assert [line for line in lines if line.startswith("a, radius")] != []
    assert "without the start of 5 jobs; and " in lines[-1]


DESCRIBED = {"name": "a", "event_budget": 2 * 10**9}


def test_a_build_says_which_accuracies_it_did_not_reach(tmp_path):
    folder, names = tmp_path / "a", ("radius", "event", "relative_stderr", "status")
    assert job_cost.missed(tmp_path, DESCRIBED) == []
    rows = [
        (0.2, "any_wall", 0.9e-5, "reached"), (0.2, "top_wall", 1e-5, "reached"),
        (0.3, "any_wall", 2e-5, "budget"), (0.3, "top_wall", 3e-5, "budget"),
    ]  # fmt: skip
    write_rows(folder, MeanTimesTable, names, rows, target=1e-5)
    (line,) = job_cost.missed(tmp_path, DESCRIBED)
    assert line == (
        "a, radius 0.3: You asked for an error of 1e-5, but the budget of 2e9 events ended the run "
        "at 3e-5 (top_wall_time)."
    )
    # The speed is that of the fastest job: the first ones compile.
    jobs = (0.2, 10**9, 10.0), (0.3, 2 * 10**9, 99.0)
    write_rows(folder, CostTable, ("radius", "events", "seconds"), jobs, stage="dynamics")
    (line,) = job_cost.missed(tmp_path, DESCRIBED)
    assert line.endswith("(top_wall_time). A budget of 2.2e10 is enough; it takes 3 min.")
