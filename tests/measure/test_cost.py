"""The cost of an error: prices from pilots, and the forecast of a run.

Without it a forecast could promise an error or a time that no run has.
"""

import math
import platform
from dataclasses import replace
from functools import partial
from itertools import count
from unittest.mock import Mock, call

import pytest
from effect_scenes import SCENES

import twodiscs as td
from twodiscs.analysis.tables import shortfall
from twodiscs.dynamics import paths
from twodiscs.dynamics.engine import find_engine
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.dynamics.many import many_rates
from twodiscs.dynamics.runs import DAY_OF_EVENTS, DynamicsRun
from twodiscs.dynamics.two import two_rates
from twodiscs.measure import cost
from twodiscs.model.formats import format_seconds
from twodiscs.model.seeds import job_seed
from twodiscs.sampling import montecarlo
from twodiscs.sampling.many import insertions
from twodiscs.sampling.rounds import PLAN_STEPS, ROUND_MARGIN
from twodiscs.theory import exact
from twodiscs_paper.pipeline.forecast import forecast_dynamics

SCENE = td.Scene(1.5, 1.0, 0.2)

#: Next to the threshold of horizontal hops, which are rare and have strips.
NEAR = SCENE.with_radius(0.2499)

#: No larger discs fit.
LAST = SCENE.with_radius(math.nextafter(SCENE.largest_radius, 0))


def new_run(scene, error, budget=None):
    """Return the run of ``simulate(scene, error, budget=budget)``."""
    target = dict.fromkeys(scene.events, error)
    return DynamicsRun(scene, target, budget, job_seed(scene, "dynamics", 1, None))


@pytest.mark.parametrize("scene", [SCENE, NEAR, SCENES["rough"]])
def test_a_pilot_has_the_errors_of_a_run_of_the_same_blocks(blocks, scene):
    run, measured = new_run(scene, 1.0), td.simulate(scene, 1.0)
    found = forecast_dynamics(run, cost.pilots(run))
    assert found.seconds == pytest.approx(len(run.components) * 32e-3)
    planned = forecast_dynamics(run, cost.pilots(run), planned=True)
    assert planned.seconds == pytest.approx(sum(p.planned for p in run.components.values()) * 1e-3)
    for event, error in found.reached.items():
        assert error == pytest.approx(measured[f"{event}_time"].relative_stderr, rel=1e-3)


def test_a_pilot_has_the_replicas_of_the_budget(blocks):
    """A small budget has shorter replicas, and here 108 of them in a block in place of 25."""
    run = new_run(td.Scene(9.2, 9.2, 0.5, discs=64), 1.0, 1)
    pilot = cost.pilots(run)["all"]
    events = find_engine(run.scene).rates.expected_event_rate(run.scene) * run.replica_duration
    assert pilot.events / pilot.replicas == pytest.approx(events, rel=0.1)


def test_a_rare_hop_has_a_price_from_ordinary_states_too(blocks):
    found = td.cost(NEAR)
    strips, ordinary = (found["horizontal_hop_time", m] for m in ("strips", "dynamics"))
    assert ordinary.c > 1e4 * strips.c
    assert ordinary.least_seconds == 32e-3  # the 32 blocks of the smallest run
    # Few counts do not tell their variance; it then follows from the exact rate.
    block = td.rate(NEAR, "horizontal_hop") * two_rates.replica_duration(NEAR) * REPLICAS
    assert ordinary.c == pytest.approx(cost.CLUSTER_VARIANCE / block * 1e-3)
    # 144 are expected in 32 blocks, where 200 would tell.
    some = SCENE.with_radius(0.2485)
    error = cost.pilots(new_run(some, 1.0))["all"].errors["horizontal_hop"]
    block = td.rate(some, "horizontal_hop") * two_rates.replica_duration(some) * REPLICAS
    assert error == pytest.approx(math.sqrt(cost.CLUSTER_VARIANCE / block))


def test_a_strip_without_a_hop_in_its_pilot_has_the_error_that_was_planned(blocks):
    """The planned blocks reach the error that is asked for; one block has √planned times it."""
    run, hop = new_run(NEAR, 0.01), "horizontal_hop"
    run.components[hop] = replace(run.components[hop], error_over_target=lambda *_: [math.inf])
    due = 0.01 * math.sqrt(run.components[hop].planned)
    assert cost.pilots(run)[hop].errors == {hop: pytest.approx(due)}


def test_a_processor_has_the_name_that_the_system_tells(monkeypatch):
    told = Mock(side_effect=["vendor_id\t: A\nmodel name\t: B: C 1\nmodel name\t: D", OSError])
    monkeypatch.setattr(cost.Path, "read_text", told)
    assert cost.machine() == "B: C 1"
    assert cost.machine() == (platform.processor() or platform.machine())


def test_a_time_is_that_between_two_readings_of_a_clock(monkeypatch):
    for clock in ("thread_time", "perf_counter"):
        monkeypatch.setattr(cost.time, clock, count(1000.0).__next__)
    assert cost.timed(range, 5.5) == (range(5), 5, 1 / 5)
    assert cost.timed(range, 5.5, 7) == (range(7), 7, 1 / 7)
    assert td.cost(SCENE)["all exact values", "exact"].least_seconds == 1.0


@pytest.mark.parametrize("most", [1e7, 1e5])
def test_a_trajectory_has_a_price_for_its_rows_or_the_most(blocks, most, monkeypatch):
    monkeypatch.setattr(paths, "MOST_PATH_EVENTS", most)
    (price,) = (one for one in td.cost(NEAR).prices if one.quantity == "trajectory")
    rows = min(most, 1e6)
    assert float(price.method.removesuffix(" rows")) == rows
    # The 32 blocks of the pilot have about a thousand rows each.
    assert price.seconds(0.1) == price.seconds(1e-9) == pytest.approx(rows / 1e6, rel=0.7)


def test_a_time_is_c_over_the_square_of_the_error_between_the_smallest_run_and_the_floor():
    price = td.Price("any_wall_area", "shells", c=4e-6, least_seconds=0.01, floor=1e-3)
    assert price.least_error == pytest.approx(0.02)
    assert [price.seconds(error) for error in (1.0, 0.01, 1e-3)] == pytest.approx([0.01, 0.04, 4.0])
    assert price.seconds(0.99e-3) is None


def test_a_share_of_all_samples_prints_with_a_rounding_too_much(blocks):
    """The volume over that of the prism is 1 + 2e-16. In another unit its square is no double."""
    for unit in (1.0, 1e-50):
        assert "volume" in str(td.cost(td.Scene(unit, unit, unit * 1e-9), 1e-3))


@pytest.mark.parametrize("shell", [0.02, 0.3])
def test_a_price_of_samples_has_their_error_and_the_bias_of_their_shell(blocks, shell):
    """An error from n hits is known to 1/√n. Five times that is allowed."""
    measured, prices = td.sample(SCENE, 1, shell=shell).frame(), td.cost(SCENE, shell=shell)
    for name, row in measured.iterrows():
        floor = 0 if name == "volume" else abs(row["bias"] / row["exact"])
        method = "rejection" if name == "volume" else "shells, rejection"
        assert prices[name, method].floor == pytest.approx(floor, abs=1e-12)
        relative, samples = row["stderr"] / row["estimate"], montecarlo.SAMPLES_PER_BLOCK
        error = math.sqrt(prices[name, method].c / 1e-3 * samples / row["samples"])
        assert error == pytest.approx(relative, rel=5 * relative)


def test_a_budget_ends_a_run_at_the_error_that_the_forecast_says(blocks):
    for scene in (SCENE, NEAR):
        run = new_run(scene, 1e-5, 10**7)
        with pytest.warns(td.AccuracyWarning):
            measured = td.simulate(scene, 1e-5, budget=1e7)
        found = forecast_dynamics(run, cost.pilots(run))
        for event, error in found.reached.items():
            one = measured[f"{event}_time"]
            # Half a block more or less, and the noise of two errors from 32 blocks.
            assert error == pytest.approx(one.relative_stderr, rel=0.2)
        assert found.events == pytest.approx(1e7, rel=0.3)
        assert "budget of 1e7 events ends the run at" in found.shortfall(run)
        one = replace(run, target=dict.fromkeys(scene.events, 1.0) | {"top_wall": 1e-5})
        assert "(top_wall_time)" in found.shortfall(one)


def test_ten_times_the_accuracy_takes_a_hundred_times_as_long(blocks):
    assert td.cost(NEAR, "draft").errors == [1e-2]
    found = td.cost(NEAR)
    assert found.errors == [1e-2, 1e-3, 1e-4, 1e-5, 1e-6]
    with pytest.raises(KeyError, match=r"volume.* is no \(quantity, method\) such as \('vertical"):
        found["volume", "strips"]
    assert found.seconds(1e-6) == pytest.approx(100 * found.seconds(1e-5))
    # All times take what the worst of those that share a run takes, and the strips beside it.
    costs = [p.c for p in found.prices if p.method == "dynamics" and "horizontal" not in p.quantity]
    strips = found["horizontal_hop_time", "strips"].c
    assert found.seconds(1e-5) == pytest.approx(ROUND_MARGIN * 1e10 * (max(costs) + strips))
    lines = [line.split() for line in str(found).splitlines()]
    for price in found.prices:
        names = f"{price.quantity} {price.method}".split()
        (line,) = (line for line in lines if line[: len(names)] == names)
        least = [price.least_error if 0 < price.least_error < 1 else "–"]
        errors = [*least, *[price.floor] * (price.floor > 0)]
        shown = [cell if cell == "–" else float(cell) for cell in line[-len(errors) :]]
        assert shown == [e if e == "–" else pytest.approx(e, rel=0.05) for e in errors]


def test_without_a_budget_a_run_has_a_day():
    easy = new_run(NEAR, 1e-3).components
    assert all(one.budget > 100 * one.planned * one.block_events for one in easy.values())
    for name, fine in new_run(NEAR, 2e-4).components.items():
        assert fine.planned == pytest.approx(25 * easy[name].planned, rel=1 / PLAN_STEPS)
    hard = new_run(NEAR, 1e-9)
    kicked = replace(NEAR, friction=4.0)
    each = find_engine(kicked).rates.work_per_event(kicked)
    for run, by in ((hard, 1), (new_run(kicked, 1e-9), each)):
        work = sum(component.budget * component.cost_ratio for component in run.components.values())
        assert work * by == pytest.approx(DAY_OF_EVENTS)
    paid = new_run(kicked, 1e-9, 10**9).components.values()
    assert sum(component.budget for component in paid) * each == pytest.approx(1e9)
    assert hard.most_events == DAY_OF_EVENTS
    many = new_run(td.Scene(2, 1.5, 0.1, discs=12), 1e-9)
    assert many.most_events * many_rates.cost_ratio(many.scene) == pytest.approx(DAY_OF_EVENTS)
    for component in hard.components.values():  # as many blocks, on the grid of planned ones
        events = component.planned * component.block_events
        assert 0.999 < events / component.budget < 1 + 1 / PLAN_STEPS
    # All components have the same fraction of their events.
    far = new_run(NEAR, 1e-9, 10**18).components
    shares = [component.budget / far[name].budget for name, component in hard.components.items()]
    assert shares == pytest.approx([shares[0]] * len(shares))
    for scene in (SCENE.with_radius(0.38), td.Scene(1.5, 1.0, 0.15, discs=3)):
        run = montecarlo.MonteCarloRun(scene, ("volume",), None, 0.02, 1, {"volume": 1e-3})
        day = run.components["all"]
        assert day.budget * day.cost_ratio == pytest.approx(montecarlo.DAY_OF_SAMPLES)
        assert day.block_work == replace(run, samples=1, target=None).components["all"].block_work
        assert day.error_over_target([0 * day.work(0, 1)[0]], 1) == [math.inf]  # without a hit


# Sentences ----------------------------------------------------------------------------------------


def row(event, error, status="budget", target=1e-5):
    return {"event": event, "relative_stderr": error, "status": status, "target": target}


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ([row("any_wall", 9e-6, "reached"), row("top_wall", None, "impossible")], None),
        ([row("any_wall", None, "too-few", 0.1)], None),
        ([row("any_wall", None, "counted", None)], None),
        (
            [row("any_wall", 2e-5), row("top_wall", 9e-5), row("right_wall", 8e-4, target=1e-4)],
            "You asked for an error of 1e-5, but the budget of 2e9 events ended the run at 9e-5 "
            "(top_wall_time). A budget of 2e11 is enough; it takes 27 min.",
        ),
        (
            [row("any_wall", 9e-5), row("top_wall", None, "too-few", 0.01)],
            "You asked for an error of 0.01, but the budget of 2e9 events ended the run with "
            "too few events top_wall for an error.",
        ),
        (
            [row("any_wall", None, "none-seen")],
            "You asked for an error of 1e-5, but the budget of 2e9 events ended the run with "
            "too few events any_wall for an error.",
        ),
    ],
)
def test_a_sentence_says_what_was_not_reached(rows, said):
    """And if a component had too small a share of the budget, or no budget was given."""
    assert shortfall(rows, 2 * 10**9, 2e9, 20.0) == said
    found = shortfall([row("any_wall", 1.004e-5)], 10**9, 1e8)
    assert "ended the run at 1.1e-5 (any_wall_time)" in found
    found = shortfall([row("any_wall", 2e-5)], 10**9, 1e8)
    assert found.endswith("ended the run at 2e-5 (any_wall_time). A budget of 4.8e9 is enough.")
    found = shortfall([row("any_wall", None, "too-few", 0.01) | {"replicas": 50}], 10**9, 1e8)
    assert found.endswith("50 of the 100 replicas that an error needs. A budget of 3e8 is enough.")
    few = [row("any_wall", None, "too-few", 0.01) | {"replicas": 2048}]
    for used, said in ((9e8, "the budget of 1e9 events ended the"), (1e8, "the run of 1e8 events")):
        found = shortfall(few, 10**9, used)
        assert found.startswith(f"You asked for an error of 0.01, but {said}")
    found = shortfall([row("any_wall", 2e-5)], None)
    assert found.endswith(", but the limit of a day ended the run at 2e-5 (any_wall_time).")


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (None, "–"), (math.inf, "–"), (3e-7, "0.3 µs"), (0.0123, "12 ms"), (59.4, "59 s"),
        (1200, "20 min"), (7200, "2 h"), (86400, "1 d"), (3.2e9, "100 years"),
    ],
)  # fmt: skip
def test_times_are_written_in_their_unit(seconds, text):
    assert format_seconds(seconds) == text


# Pilots -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("fewest", [7, 1])
def test_a_pilot_has_at_least_its_fewest_blocks(fewest, monkeypatch):
    """Six seconds on the clock are those of all blocks."""
    work, clock = Mock(side_effect=lambda first, stop: stop), Mock(side_effect=[3, 9] * 3)
    monkeypatch.setattr(cost.time, "thread_time", clock)
    assert cost.timed(work, 0.0, fewest) == (fewest, fewest, 6 / fewest)
    # The first call compiles, the second measures one block.
    assert work.mock_calls == [call(0, 1), call(0, 1), call(0, fewest)]


@pytest.mark.parametrize("periodic", ["", "xy"])
def test_prices_of_insertions_are_those_of_samples(blocks, periodic):
    """The errors of 32 blocks of another seed are known within some per cent."""
    three = td.Scene(1.5, 1.0, 0.15, discs=3, periodic=periodic)
    measured = td.sample(three, 32 * insertions.INSERTIONS_PER_BLOCK)
    prices = [*cost._prices_of_samples(three, 0.02)]
    assert {(price.quantity, price.method, price.floor) for price in prices} == {
        (quantity, "insertions", 0.0) for quantity in measured
    }
    for price in prices:
        due = 32e-3 * measured[price.quantity].relative_stderr ** 2
        assert price.c == pytest.approx(due, rel=0.2)
    few, many = (td.Scene(9.0, 9.0, 0.1, discs=n) for n in (64, 65))
    assert (cost.has_volume(few), [*cost._prices_of_samples(many, 0.02)]) == (True, [])


def test_all_walls_have_the_price_of_their_own_shell_with_effects():
    """The variance of a binomial count of the share of the samples that are in it."""
    (make,), wanted = montecarlo.samplers(SCENES["rough"]).values(), ["volume", "any_wall_area"]
    sampler = make(SCENES["rough"], [*wanted, "right_wall_area", "top_wall_area"], 0.02, 0)
    part = sampler.constants["quantities"]["any_wall_area"]
    due = exact.shell_expectation(SCENES["rough"], "any_wall", part["epsilon"]) / part["measure"]
    variance, _ = cost.variances(SCENES["rough"], sampler, None, 1)["any_wall_area"]
    assert variance * sampler.block == pytest.approx(1 / due - 1)


@pytest.mark.parametrize(("more", "rel"), [(["volume"], 0.02), ([], 0.15)])
def test_all_walls_have_the_price_of_two_shells_that_overlap(more, rel):
    """Samples in one shell are valid, so more of them are in the other one than of all samples."""
    scene, asked = td.Scene(1.5, 1.0, 0.3), ["right_wall_area", "top_wall_area", *more]
    sampler = montecarlo.samplers(scene)["rejection"](scene, asked, 0.5, 0)
    variance, _ = cost.variances(scene, sampler, None, 1)["any_wall_area"]
    found = td.sample(scene, 1e6, quantities=[*asked, "any_wall_area"], shell=0.5)
    due = found["any_wall_area"].relative_stderr ** 2 * found.rows[0]["samples"]
    assert variance * sampler.block == pytest.approx(due, rel=rel)


def test_a_run_has_its_first_round_whatever_is_asked_and_the_replicas_of_bursts():
    pilot = cost.Pilot(1e-3, 1e5, 1024, {"disc_collision": 0.1}, 32)
    for error, blocks in ((1.0, 32), (0.1, 32), (0.02, 32), (0.001, ROUND_MARGIN * 1e4)):
        found = cost.blocks_wanted(SCENE, {"all": pilot}, {"disc_collision": error})
        assert found == {"all": pytest.approx(blocks)}
    both = pilot._replace(errors={"disc_collision": 0.1, "top_wall": 0.01})
    found = cost.blocks_wanted(SCENE, {"all": both}, {"disc_collision": 0.1, "top_wall": 1e-4})
    assert found == {"all": pytest.approx(ROUND_MARGIN * 1e4)}
    rough = td.Scene(1.5, 1.0, 0.24999, moment_of_inertia=0.1)
    needed = exact.replicas_needed(rough, "disc_collision", 0.02) / 1024
    assert needed > 8
    # A run plans them if its budget can pay for all of them, and none if it can pay for some.
    run = partial(DynamicsRun, rough, {"disc_collision": 0.02}, seed=1)
    planned = [run(budget=budget).components["all"].planned for budget in (10**6, 10**14)]
    assert planned == [1, math.ceil(needed)]
    # Initial states in a strip are in the neck, so it needs no others.
    errors = dict.fromkeys(("disc_collision", "top_wall", "horizontal_hop"), 0.01)
    pilot = pilot._replace(first_round=8, errors=errors)
    pilots = {"all": pilot, "horizontal_hop": pilot}
    found = cost.blocks_wanted(rough, pilots, dict.fromkeys(pilot.errors, 0.02))
    assert found == {"all": pytest.approx(needed), "horizontal_hop": 8}


def test_an_event_that_no_pilot_counted_has_no_price_and_no_forecast():
    errors = {"disc_collision": 0.1, "horizontal_hop": math.inf}
    pilot = cost.Pilot(1e-3, 1e5, 1024, errors, 32)
    (price,) = cost._prices_of_times(SCENE, {"all": pilot})
    assert price.quantity == "disc_collision_time"
    run = DynamicsRun(SCENE, dict.fromkeys(errors, 1e-3), 10**7, 1)
    found = forecast_dynamics(run, {"all": pilot})
    assert found.events == pytest.approx(run.components["all"].budget)
    assert found.shortfall(run).endswith("with too few events horizontal_hop for an error.")
    blocked = cost.pilots(new_run(SCENE.with_radius(0.3), 1.0))["all"].errors
    assert {*td.EVENTS} - {*blocked} == {"horizontal_hop"}


@pytest.mark.parametrize(
    ("scene", "floor"),
    [(LAST, 1e-15), (td.Scene(1.5, 1.0, 0.15, discs=3), 1e-14),
     (td.Scene(4.0, 1.0, 0.3, discs=4), 1e-12)],
)  # fmt: skip
def test_exact_values_have_the_precision_of_their_theory(scene, floor, monkeypatch):
    """Those of another scene are timed, because none of its values is in a cache."""
    monkeypatch.setattr(exact, "exact", calls := Mock())
    assert [*cost._price_of_exact(td.Scene(1.5, 1.0, 0.12, discs=4))] == []
    (price,) = cost._price_of_exact(scene)
    assert [one.args[0] == scene for one in calls.call_args_list] == [True, False]
    assert (price.floor, price.c) == (floor, floor**2 * price.least_seconds)
    assert price.seconds(floor * 1.01) == price.least_seconds
