"""The price of jobs: what limits them, how it scales, and which shards they take."""

from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from twodiscs_paper.configuration.load import load
from twodiscs_paper.pipeline import cost


def scene(**keys):
    """Return the request of a scene with these ``keys`` in its block, or in the configuration."""
    block = {"name": "a", "box": {"width": 1.5, "height": 1.0}, "radii": [0.24, 0.3]}
    top = {name: keys.pop(name) for name in ("shard_events",) if name in keys}
    return load({"shared": [], **top, "scenes": [block | keys]}).scenes[0]


@pytest.mark.parametrize("stage", ["monte_carlo", "dynamics"])
def test_a_limit_is_above_the_price(stage):
    request = scene(accuracy=1e-5, event_budget=1e12)
    for radius in request.keys[stage].values():
        jobs = max(1, len(cost.shards(request, stage, radius)))
        assert 60 * cost.minutes(request, stage) > cost.seconds(request, stage, radius) / jobs


@pytest.mark.parametrize("radius", [0.24, 0.24999975, 0.3])
def test_a_limit_is_above_the_price_of_a_job_whose_budget_ends_it(radius):
    """This holds for a job that only has hops in a strip, too, whose events cost more."""
    for budget in (1e8, 1e9, 5e9, 2e10, 9e10):
        for watched in (["horizontal_hop"], ["horizontal_hop", "top_wall"]):
            request = scene(accuracy=1e-8, event_budget=budget, watch={"mean_times": watched})
            if not cost.shards(request, "dynamics", radius):
                limit = 60 * cost.minutes(request, "dynamics")
                assert limit > 2 * cost.seconds(request, "dynamics", radius)


def test_ten_times_the_accuracy_takes_a_hundred_times_the_work():
    coarse, fine = (scene(accuracy=error, event_budget=1e15) for error in (1e-3, 1e-4))
    ratio = cost.seconds(fine, "dynamics", 0.3) / cost.seconds(coarse, "dynamics", 0.3)
    assert ratio == pytest.approx(100, rel=0.1)
    budget = cost.seconds(scene(accuracy=1e-5, event_budget=1e9), "dynamics", 0.3)
    assert budget == pytest.approx(10, rel=0.1)


def test_the_price_of_a_point_is_that_of_its_shards():
    request = scene(shard_events=1e8, accuracy=1e-4, event_budget=1e12)
    parts = cost.run_at(request, "dynamics", 0.24).parts
    work = sum(
        (stop - first) * parts[name].block_events * parts[name].cost_ratio
        for name, first, stop in cost.shards(request, "dynamics", 0.24)
    )
    assert cost.seconds(request, "dynamics", 0.24) == pytest.approx(work / 1e8)


def test_days_are_those_of_the_jobs():
    request = scene(accuracy=1e-7, event_budget=1e15, watch={"mean_times": True})
    whole = sum(cost.seconds(request, "dynamics", radius) for radius in request.radii)
    assert cost.days([request]) == pytest.approx(whole / 86400)
    assert cost.days([scene()]) < 0.1


def test_days_of_many_radii_are_those_of_some_times_their_number(monkeypatch):
    radii = [round(0.1 + 0.001 * i, 3) for i in range(21)]
    request = scene(accuracy=1e-7, event_budget=1e15, radii=radii, watch={"mean_times": True})
    whole = cost.days([request])
    monkeypatch.setattr(cost, "SOME", 7)
    assert cost.days([request]) == pytest.approx(whole, rel=0.1)


def test_what_one_job_can_do_has_no_shards():
    assert cost.shards(scene(), "dynamics", 0.24) == []
    # The budget allows for more than a shard, and the accuracy does not take it.
    assert cost.shards(scene(accuracy=0.1, event_budget=1e15), "dynamics", 0.24) == []


@pytest.mark.parametrize("stage", ["monte_carlo", "dynamics", "intervals"])
def test_shards_cover_all_blocks_once(stage):
    request = scene(
        shard_events=1e7, accuracy=1e-3, event_budget=1e12, monte_carlo={"samples": 1e9},
        watch={"volume": True, "mean_times": True,
               "hop_histogram": {"radii": [0.24], "intervals": 1e7}},
    )  # fmt: skip
    parts = cost.run_at(request, stage, 0.24).parts
    shards = cost.shards(request, stage, 0.24)
    assert {part for part, *_ in shards} == {*parts}
    for part, run in parts.items():
        pieces = sorted((first, stop) for name, first, stop in shards if name == part)
        assert pieces[0][0] == 0
        assert pieces[-1][1] == run.planned
        assert all(a[1] == b[0] for a, b in pairwise(pieces))
        most = max(stop - first for first, stop in pieces)
        assert most == 1 or most * run.block_events * run.cost_ratio <= request.shard_events


@settings(max_examples=30)
@given(st.floats(1e-5, 1e-3), st.floats(1.01, 10))
def test_a_tighter_accuracy_keeps_the_shards_but_the_last(error, times):
    """They are pieces of one grid: of each part all but the last one stay."""
    found = [
        cost.shards(scene(shard_events=1e8, accuracy=e, event_budget=1e15), "dynamics", 0.24)
        for e in (error, error / times)
    ]
    coarse, fine = ({part: [s for s in some if s[0] == part] for part in ("all", "horizontal_hop")}
                    for some in found)  # fmt: skip
    for part, shards in coarse.items():
        assert {*shards[:-1]} <= {*fine[part]}


def test_the_limit_of_a_study_grows_with_what_is_asked_of_it():
    from twodiscs_paper.catalogue import STUDIES

    def limit(seconds):
        configuration = load({"accuracy_cost": {"seconds": seconds}, "scenes": [BLOCK]})
        return cost.study_minutes(STUDIES["accuracy_cost"], configuration)

    assert 60 * limit(1e6) > 1e6
    assert limit(1) < 60


BLOCK = {"name": "a", "box": {"width": 1.5, "height": 1.0}}
