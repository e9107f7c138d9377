"""Work in pieces: the same bits however it is cut, and nothing is done twice."""

import math
from itertools import chain, pairwise

import numpy as np
import pytest

from twodiscs.dynamics import counting, intervals
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.model.box import Box
from twodiscs.sampling import montecarlo, rounds
from twodiscs.sampling.strata import mean_of

PAPER = Box(1.5, 1.0)
UNEQUAL = Box(1.5, 1.0, {"radius_ratio": 0.6, "mass_ratio": 3.0})


def planned(runs, events, order=1):
    """Return (what is ``Done`` of each run, all pieces) of plans in rounds; ``order`` may be −1."""
    found = {name: {} for name in runs}
    while True:
        done = {
            name: rounds.followed(run, [*chain(*found[name].values())])
            for name, run in runs.items()
        }
        new = {
            name: [p for p in rounds.pieces(run, events, done[name][1]) if p not in found[name]]
            for name, run in runs.items()
        }
        if not any(new.values()):
            return {name: one[0] for name, one in done.items()}, found
        for name, places in new.items():
            for place in places[::order]:
                found[name] |= {place: rounds.piece(runs[name], *place)}


def fabricated(error, budget=math.inf, block_events=1000):
    """Return a ``Run`` whose block k has (7 k mod 11) counts, and errors of counts."""
    counts = np.arange(1 << 16) * 7 % 11
    done = []

    def work(first, stop):
        done.append((first, stop))
        return (np.array([counts[first:stop].sum()]),)

    run = rounds.Run(
        work,
        lambda sums, blocks: sums[0] ** -0.5 / error,
        lambda sums: 200 * int(sums[0][0]),
        block_events,
        budget,
    )
    return run, counts, done


@pytest.mark.parametrize("blocks", [1, 32, 33, 1000, 12345])
@pytest.mark.parametrize("events", [1.0, 3e4, 1e5, 1e6, 1e9])
def test_pieces_are_powers_of_two_of_an_absolute_grid(events, blocks):
    run = fabricated(0.1)[0]
    found = rounds.pieces(run, events, blocks)
    assert [first for first, _ in found] == [0, *(stop for _, stop in found[:-1])]
    assert found[-1][0] < blocks <= found[-1][1]
    for first, stop in found:
        size = stop - first
        assert size == 1 << (size.bit_length() - 1)
        assert first % size == 0
        assert size <= max(rounds.FIRST_ROUND, math.sqrt(2) * events / run.block_events)
    assert found == rounds.pieces(run, events, 10 * blocks)[: len(found)]


@pytest.mark.parametrize("events", [1.0, 1e5, 1e6, 1e9])
@pytest.mark.parametrize("order", [1, -1])
@pytest.mark.parametrize(
    ("error", "budget"), [(0.5, math.inf), (0.01, math.inf), (0.005, 2e6), (1e-9, 5e6)]
)
def test_the_first_look_that_is_good_enough_is_the_end(error, budget, events, order):
    run, counts, _ = fabricated(error, budget)
    done = planned({"all": run}, events, order)[0]["all"]
    looks, n = [], 0
    while n < counts.size:
        n = rounds.next_look(n)
        looks.append(n)
    sums = np.cumsum(counts)
    for n, following in pairwise(looks):
        total = int(sums[n - 1])
        if total**-0.5 <= error or budget / (200 * total) * n < following:
            break
    assert (done.blocks, int(done.sums[0][0]), done.rounds) == (n, total, looks.index(n) + 1)
    assert 200 * total <= budget


def test_looks_are_close_and_at_every_power_of_two():
    done, looks = rounds.FIRST_ROUND, []
    while done < 1 << 20:
        assert done < rounds.next_look(done) <= done * (1 + 1 / 32)
        looks.append(done := rounds.next_look(done))
    assert {1 << k for k in range(6, 21)} <= {*looks}


def test_more_of_the_same_starts_where_the_last_one_ended():
    found = {}
    for error in (0.02, 0.005):
        run, _, done = fabricated(error)
        found[error] = (planned({"all": run}, 1e5)[1]["all"], done)
    assert found[0.02][0].items() <= found[0.005][0].items()
    starts = [first for first, _ in found[0.005][1]]
    assert len(starts) == len({*starts})


def test_there_may_be_nothing_to_wait_for():
    run, _, done = fabricated(0.1)
    run = run._replace(excess_of=lambda sums, blocks: np.array([]))
    assert planned({"all": run}, 1.0)[0]["all"].blocks == rounds.FIRST_ROUND
    assert max(stop for _, stop in done) == rounds.FIRST_ROUND


#: A wall and all of them: the kernel is the one that counts everything.
COUNTED = {
    "accuracy": {"horizontal_hop": 0.01, "top_wall": 0.01, "any_wall": 0.003},
    "event_budget": 4 * 10**7,
}


@pytest.mark.parametrize(("box", "radius"), [(PAPER, 0.24), (UNEQUAL, 0.15)])
def test_counts_in_shards_are_those_of_their_blocks(box, radius):
    """Of rare hops, too, which are counted from starts of their own."""
    job = COUNTED | {"seed": 3}
    runs = counting.runs(box, radius, **job)
    assert {*runs} == ({"all", "horizontal_hop"} if box is PAPER else {"all"})
    found = [counting.merged(box, radius, done=planned(runs, n)[0], **job) for n in (1e7, 1e9)]
    assert found[0] == found[1]
    blocks = found[0]["replicas"] // REPLICAS
    scene = box.scene(radius)
    sums, _ = counting.run_blocks(scene, [*job["accuracy"]], 3, 0, blocks, found[0]["duration"])
    assert [*found[0]["counts"].values()] == [
        sums[counting.EVENTS.index(event)] for event in found[0]["counts"]
    ]
    assert {*found[0]["status"].values()} == {"reached"}
    for hop, one in found[0]["strips"].items():
        mean, error = mean_of(**one["strata"])
        assert error / mean <= job["accuracy"][hop]


@pytest.mark.parametrize(("box", "radius"), [(PAPER, 0.2), (PAPER, 0.3838), (UNEQUAL, 0.15)])
def test_samples_in_shards_are_those_of_one_job(box, radius):
    job = {"areas": ["right_wall"], "volume": True, "shell": 0.02, "seed": 5}
    found = [
        montecarlo.merged(
            box,
            radius,
            done=planned(montecarlo.runs(box, radius, samples=n, **job), 1e7)[0],
            samples=n,
            **job,
        )
        for n in (1, 2**20)
    ]
    assert found[0] == found[1]
    samples = found[0]["samples"]
    if found[0]["method"] == "conditioned":
        samples *= montecarlo.DEARER
    assert found[0] == montecarlo.job(box, radius, samples=samples, **job)


@pytest.mark.parametrize(("box", "radius"), [(PAPER, 0.1), (UNEQUAL, 0.15)])
def test_intervals_in_shards_are_those_of_one_job(box, radius):
    """But for the times of chains, which are rounded to a 16th of a bin where they are summed up.

    The rounding of a chain is at most half of that, so the mean is as close; the error is as far
    off as such a rounding in every chain could make it.
    """
    job = {"event": "vertical_hop", "seed": 5}
    runs = intervals.runs(box, radius, intervals=1, **job)
    found = intervals.merged(box, radius, done=planned(runs, 1e7)[0], intervals=1, **job)
    whole = intervals.job(box, radius, intervals=found["intervals"], **job)
    rounding = found["bin_width"] / intervals.GRAIN / intervals.RETURNS / 2
    assert found["mean"] == pytest.approx(whole["mean"], abs=rounding, rel=0)
    assert found["stderr"] == pytest.approx(
        whole["stderr"], abs=2 * rounding / math.sqrt(found["chains"]), rel=0
    )
    same = found.keys() - {"mean", "stderr"}
    assert {name: found[name] for name in same} == {name: whole[name] for name in same}
