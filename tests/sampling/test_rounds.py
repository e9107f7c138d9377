"""Work in rounds of blocks, and in shards: sums, budgets and stopping.

Without these tests work in rounds or shards could give other sums, be done twice or go beyond its
budget.
"""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from effect_scenes import SCENES
from factory import BOX, all_reached, through_json
from hypothesis import given
from hypothesis import strategies as st

import twodiscs as td
from twodiscs.dynamics import runs
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.dynamics.two import event_counts
from twodiscs.points.base import added, reached
from twodiscs.sampling import montecarlo, rounds
from twodiscs.sampling.many import insertions
from twodiscs.theory import exact
from twodiscs_paper.pipeline import points


def done_in_shards(run, per_shard):
    """Return the shards of a run, last one first, by way of JSON."""
    ends = points.shard_ranges(run.planned, per_shard)[::-1]
    return points.check_coverage(run, through_json({each: run.work(*each) for each in ends}))


def fabricated(error, budget=math.inf, block_events=1000):
    """Return a ``SequentialRun`` whose block k has (7 k mod 11) counts, and errors of counts."""
    counts = np.arange(1 << 16) * 7 % 11

    def work(first, stop):
        return (np.array([counts[first:stop].sum()]),)

    run = rounds.SequentialRun(
        work,
        lambda sums, blocks: sums[0] ** -0.5 / error,
        lambda sums: 200 * int(sums[0][0]),
        block_events,
        budget,
        planned=1000,
    )
    return run, counts


@given(st.integers(0, 10**6), st.integers(4, 20))
def test_shards_are_those_of_an_absolute_grid(blocks, k):
    found = points.shard_ranges(blocks, 2**k)
    assert [first for first, _ in found] == [0, *(stop for _, stop in found[:-1])][: len(found)]
    assert all(first % 2**k == 0 and 0 < stop - first <= 2**k for first, stop in found)
    assert sum(stop - first for first, stop in found) == blocks
    # All but the last one are shards of more blocks, too.
    assert found[:-1] == points.shard_ranges(2 * blocks, 2**k)[: max(0, len(found) - 1)]


@given(st.floats(0.001, 1e12))
def test_the_grid_has_sixteen_steps_while_a_number_doubles(blocks):
    found = rounds.round_up_blocks(blocks)
    assert blocks <= found <= max(math.ceil(blocks), blocks * (1 + 1 / rounds.PLAN_STEPS) + 1)
    assert rounds.round_up_blocks(found) == found
    assert rounds.round_up_blocks(2 * found) in (2 * found, max(2 * found, 2))
    assert len({rounds.round_up_blocks(number) for number in range(65, 129)}) == rounds.PLAN_STEPS


@pytest.mark.parametrize(
    "ends", [[], [(0, 999)], [(1, 1000)], [(0, 500), (501, 1000)], [(0, 500), (400, 1000)],
             [(0, 1000), (0, 500)], [(0, 1000), (1000, 1001)]],
)  # fmt: skip
def test_shards_that_miss_or_repeat_a_block_are_refused(ends):
    run, counts = fabricated(0.01)
    ranges = {(a, b): [counts[a:b].sum()] for a, b in ends}
    with pytest.raises(ValueError, match=r"shards must cover blocks 0 to 1000 without gap or over"):
        points.check_coverage(run, ranges)


def test_sums_beyond_64_bits_are_exact():
    run, _ = fabricated(0.01)
    ranges = {(500 * i, 500 * (i + 1)): [np.array([2**62, i])] for i in range(2)}
    (sums,), _ = reached(through_json(points.check_coverage(run, ranges)))
    assert sums.tolist() == [2**63, 1]
    (sums,), _ = reached(through_json({(0, 1): [sums]}))
    assert sums.tolist() == [2**63, 1]


@pytest.mark.parametrize("budget", [1e12, 5e6])
def test_rounds_end_where_the_error_is_reached_or_the_budget_spent(budget):
    """Each round but the first is as long as the error before it says, up to eight times."""
    seen = []
    run, counts = fabricated(0.004, budget)
    done = rounds.run_in_rounds(run, lambda *given: seen.append(given))
    sums, blocks = reached(done)
    total = int(counts[:blocks].sum())
    assert int(sums[0][0]) == total
    assert (run.error_over_target(sums, blocks)[0] <= 1) == (budget == 1e12)
    assert 200 * total <= budget
    assert min(done) == (0, 32)
    for (_, before), (_, after) in pairwise(sorted(done) if budget == 1e12 else ()):
        (excess,) = run.error_over_target([counts[:before].sum()[None]], before)
        assert after - 1 < before * min(1.05 * excess**2, 9) <= after
    # The reported work grows to the whole work.
    known = [(now, all_of_it) for now, all_of_it in seen if now is not None]
    assert known == sorted(known, key=lambda pair: pair[0])
    assert blocks * run.block_work == known[-1][0] <= known[-1][1]


#: A scene of each rule that ends a run, and its events or quantities; None are all.
BRANCHES = {
    "two discs": (BOX.scene(0.2), None),
    "strip": (BOX.scene(0.2499), ["horizontal_hop"]),
    "both": (BOX.scene(0.24), None),
    "friction": (td.Scene(1.5, 1.0, 0.2, friction=2.0), None),
    "rough": (td.Scene(1.5, 1.0, 0.2, moment_of_inertia=0.5), ["disc_collision", "right_wall"]),
    "effects": (SCENES["combination"], None),
    "three discs": (td.Scene(1.5, 1.0, 0.15, discs=3), None),
    "ring": (td.Scene(1.5, 1.0, 0.15, discs=4, periodic="x"), None),
    "rejection": (BOX.scene(0.3), ["volume", "disc_collision_area", "any_wall_area"]),
    "conditioned": (BOX.scene(0.38), ["volume", "vertical_hop_area", "any_wall_area"]),
    "insertions": (td.Scene(1.5, 1.0, 0.15, discs=3), ["volume", "vertical_hop_area"]),
}


@pytest.mark.parametrize("name", BRANCHES)
def test_without_a_budget_a_run_ends_with_the_first_round_that_reaches_every_error(name):
    """One error that is asked for, of another event with each seed, is just not reached at once."""
    scene, names = BRANCHES[name]
    kind, call, what = "event", td.simulate, {"events": names}
    if names and "volume" in names:
        kind, call, what = "quantity", td.sample, {"quantities": names}
    for seed in range(4 if kind == "event" else 3):
        first = call(scene, error=1.0, seed=seed, **what)
        errors = {row[kind]: row["relative_stderr"] for row in first.rows}
        possible = [event for event, error in errors.items() if error]
        late = possible[seed % len(possible)]
        asked = {event: 2 * (error or 0.5) for event, error in errors.items()}
        found = first.more(error=asked | {late: 0.98 * errors[late]})
        for row in found.rows:
            assert row["status"] == ("reached" if row[kind] in possible else "impossible")
            assert row["status"] == "impossible" or row["relative_stderr"] <= row["target"]
        for component, content in found.components.items():
            begun, *later = sorted(content["sums"])
            assert begun == (0, 32)
            waits = component == (late if late in found.components else "all")
            assert 0 < len(later) <= 2 if waits else not later


def test_the_work_of_runs_one_after_the_other_ends_at_their_total():
    seen = []
    components = {name: fabricated(0.01, 1e12)[0] for name in ("all", "vertical_hop")}
    done = rounds.run_all_in_rounds(components, lambda *given: seen.append(given))
    work = [reached(ranges)[1] * components[name].block_work for name, ranges in done.items()]
    assert seen[-1] == (sum(work), sum(work))
    # The plan of the second one counts before it has begun.
    assert seen[0][1] == sum(run.planned * run.block_work for run in components.values())
    # Sums of floats, whose order counts, are told block by block.
    run = rounds.fixed(lambda first, stop, *_: [[1.0]] * (stop - first), 3, 10.0, join=added)
    rounds.run_in_rounds(run, lambda *given: seen.append(given))
    assert seen[-3:] == [(10.0, 30.0), (20.0, 30.0), (30.0, 30.0)]


@pytest.mark.parametrize("budget", [55, 325, 1005, 2890, 12345])
def test_a_budget_has_as_many_whole_blocks_as_it_can_pay(budget):
    """A block has ten events, and the error is never reached."""
    run = replace(
        fabricated(1e-9, budget, 10)[0],
        work=lambda first, stop: (np.array([stop - first]),),
        simulated_in=lambda sums: 10 * int(sums[0][0]),
    )
    assert reached(rounds.run_in_rounds(run))[1] == budget // 10


@pytest.mark.parametrize(("cores", "call"), [(1, 7000), (3, 7000), (3, rounds.EVENTS_PER_CALL)])
def test_an_error_asked_for_later_has_the_sums_of_one_asked_for_at_once(monkeypatch, cores, call):
    monkeypatch.setattr(rounds, "EVENTS_PER_CALL", call)
    kept = {}
    for error in (0.1, 0.03, 0.01, 0.003, 0.02):
        run, _ = fabricated(error, 1e12)
        kept = rounds.run_in_rounds(run, None, cores, kept)
        (later, blocks), (at_once, known) = reached(kept), reached(rounds.run_in_rounds(run))
        assert blocks == known
        assert later[0].tolist() == at_once[0].tolist()


def test_what_is_kept_is_not_done_again():
    """A run of shards does only the first round and the rest: the ranges between them join up."""
    run, counts = fabricated(0.003, 1e12)
    shards, done, told, work = done_in_shards(run, 256), [], [], run.work
    run = replace(run, work=lambda *ends: done.append(ends) or work(*ends))
    kept = rounds.run_in_rounds(run, lambda *now: told.append(now), resume_from=shards)
    assert {stop * run.block_work for _, stop in done} <= {now for now, _ in told}
    (sums,), blocks = reached(kept)
    assert blocks > 1000
    assert sums.tolist() == [counts[:blocks].sum()]
    assert sum(stop - first for first, stop in done) < blocks - 700
    done.clear()
    assert rounds.run_in_rounds(run, resume_from=kept) == kept
    assert done == []


#: A wall and all of them: the kernel is the one that counts everything.
TARGET = {"horizontal_hop": 0.01, "top_wall": 0.01, "any_wall": 0.003}


def test_counts_in_pieces_are_those_of_their_blocks_and_reach_what_is_asked():
    """This holds for rare hops, too, which are counted from separate starts."""
    scene = BOX.scene(0.24)
    run = runs.DynamicsRun(scene, TARGET, 4 * 10**7, 3)
    assert {*run.components} == {"all", "horizontal_hop"}
    found = [
        run.point({name: done_in_shards(one, n) for name, one in run.components.items()})
        for n in (16, 1024)
    ]
    assert found[0] == found[1]
    blocks = found[0].replicas // REPLICAS
    assert blocks == run.components["all"].planned
    sums, _ = event_counts.run_blocks(scene, [*TARGET], 3, 0, blocks, found[0].duration)
    assert [*found[0].counts.values()] == [sums[td.EVENTS.index(e)] for e in found[0].counts]
    assert all_reached(found[0])
    for hop, one in found[0].strips.items():
        assert one.estimate().relative_stderr <= TARGET[hop]


#: {what is counted: (number in a block, run of at least a number)}
WHOLE = {
    "intervals": (2**16, lambda n: runs.IntervalsRun(BOX.scene(0.1), "vertical_hop", n, 5)),
    "time": (2.0**16, lambda t: timed(BOX.scene(0.2), t)),
    "samples": (montecarlo.SAMPLES_PER_BLOCK, lambda n: sampling(BOX.scene(0.2), n)),
    "conditioned": (64 * montecarlo.PROPOSALS_PER_BLOCK, lambda n: sampling(BOX.scene(0.38), n)),
    "weighted": (montecarlo.SAMPLES_PER_BLOCK, lambda n: sampling(SCENES["field"], n)),
    "insertions": (
        insertions.INSERTIONS_PER_BLOCK,
        lambda n: sampling(td.Scene(1.5, 1.0, 0.1, discs=3), n),
    ),
}


def timed(scene, duration):
    return runs.DynamicsRun(scene, {"any_wall": 1.0}, None, 1, duration=duration)


def sampling(scene, number):
    return montecarlo.MonteCarloRun(scene, ("volume",), number, 0.02, 1)


@pytest.mark.parametrize("what", WHOLE)
def test_a_number_that_is_asked_for_is_rounded_up_to_whole_blocks(what):
    each, run = WHOLE[what]
    for blocks in (1, 2, 5):
        for more, due in ((-1, blocks), (0, blocks), (1, blocks + 1)):
            component = run(blocks * each + more).components["all"]
            assert (component.planned, component.first_round) == (due, due)
            assert not component.error_over_target(None, due).size


@pytest.mark.parametrize("blocks", [1, 2.01, 2.99])
def test_a_budget_of_intervals_has_the_whole_blocks_that_it_can_pay(blocks):
    scene, hop = BOX.scene(0.1), "vertical_hop"
    events = 2**16 * exact.mean_times(scene)[hop] * exact.event_rate(scene)
    budget = math.ceil(blocks * events)
    assert runs.IntervalsRun(scene, hop, 10**9, 5, budget).components["all"].planned == int(blocks)
    with pytest.raises(td.InputError, match=r"^budget must allow for 65536 intervals"):
        runs.IntervalsRun(scene, hop, 10**9, 5, int(0.999 * events))
    # An error starts with the number that it needs if intervals spread as much as their mean.
    wanted = {"hop": hop, "seed": 5, "name": "", "number": 7, "budget": 10**12}
    numbers = [runs.IntervalsRun.of(scene, wanted | {"error": e}).intervals for e in (None, 0.125)]
    assert numbers == [7, 64]
