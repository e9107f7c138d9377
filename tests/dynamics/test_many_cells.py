"""The cell list of many discs, against the kernel of all pairs.

Without these tests the kernel of many discs could lose an event that the one of few discs finds, or
drift.
"""

import itertools
import math
from dataclasses import replace
from unittest.mock import Mock

import numpy as np
import pytest
from effect_scenes import distance_square
from exact_motion import path_events
from marks import slow

import twodiscs as td
from twodiscs.dynamics import rows
from twodiscs.dynamics.many import all_pairs as many
from twodiscs.dynamics.many import cell_list as many_cells
from twodiscs.dynamics.many import class_counts, many_intervals, many_paths, many_rates
from twodiscs.model.events import EVENTS, HOPS, WALLS
from twodiscs.model.many_geometry import CELL_DISCS, LEAST_CELL_SIDE
from twodiscs.sampling.many import chains, many_initial_states
from twodiscs.sampling.many.cell_grid import make_grid

#: At the border: where one kernel ends and the other one begins, and on rings.
BORDER = [
    td.Scene(15.0, 1.0, 0.1, discs=CELL_DISCS),
    td.Scene(4.0, 2.0, 0.2, discs=CELL_DISCS),
    td.Scene(8.0, 0.9, 0.2, discs=CELL_DISCS),
    td.Scene(4.0, 2.0, 0.15, discs=CELL_DISCS, periodic="x"),
    td.Scene(4.0, 2.0, 0.15, discs=CELL_DISCS, periodic="x", moment_of_inertia=0.4),
]


#: A torus of three columns and two rows of cells, and one with both images in reach along x alone.
TORI = [
    td.Scene(0.8, 0.6, 0.13, discs=4, periodic="xy"),
    td.Scene(0.6, 4.0, 0.13, discs=CELL_DISCS, periodic="xy"),
]


#: Rings of three columns of cells, and of two, where both images of a disc are in reach.
SHORT = [
    td.Scene(0.7, 4.0, 0.1, discs=24, periodic="x"),
    td.Scene(0.6, 4.0, 0.13, discs=CELL_DISCS, periodic="x"),
]


#: Few rough discs, which only the other kernel follows.
ROUGH = slow(td.Scene(1.5, 1.0, 0.15, discs=3, moment_of_inertia=0.3))
#: Their kernels take seconds to compile.
ROUGH_TOO = slow(BORDER[4])
#: Rough discs between walls, whose kernels take half as long as on a ring.
WALLED_ROUGH = replace(BORDER[4], periodic="")
#: Rings whose discs are kicked.
KICKED = [replace(scene, friction=4.0) for scene in (BORDER[3], *SHORT)]
KICKED_TORUS = replace(BORDER[3], periodic="xy", friction=4.0)


#: Few discs have as few cells as there may be.
THREE = td.Scene(1.5, 1.0, 0.26, discs=3)


@pytest.mark.parametrize(
    "scene",
    [THREE, *BORDER[:3], WALLED_ROUGH, TORI[0], *map(slow, [*BORDER[3:], *SHORT, TORI[1]])],
    ids=repr,
)
def test_a_few_events_are_the_same_ones(scene):
    """From the same states, before roundings have grown: the same counts, every one of them."""
    replicas, duration = 256, many_rates.expected_duration(scene, 2 * scene.discs)
    hops_y, hops_x = (None if axis in scene.periodic else True for axis in "yx")
    states, seeds = many_initial_states.states(scene, replicas, 4), (np.uint64(4), 0)
    law = many.many_disc_law(scene)
    grid = make_grid(scene)  # the states of a kernel become those at its end
    one = many_cells.count_events(
        states.copy(), *seeds, duration, duration / 3, law, grid, hops_y, hops_x, None
    )
    other = many.count_events(states, *seeds, 64, duration, law, hops_x, None)
    assert one[0].sum() > (2 if scene.discs < CELL_DISCS else 10) * replicas
    for some, same in zip(one, other, strict=True):
        assert np.array_equal(some, same)


@pytest.mark.parametrize(("discs", "stretches"), [(CELL_DISCS, 0), slow(1024, 4)])
def test_a_log_has_room_for_pairs_of_a_row_or_a_column(discs, stretches):
    """Not for all pairs; their number is kept where discs go on to the next row."""
    side = math.sqrt(discs * math.pi / 0.3) / 10
    scene = td.Scene(side, side, 0.1, discs=discs)
    path = many_paths.Followed(scene, scene.events)
    path.start(many_initial_states.states(scene, 1, 1), 1)
    later = (log for log, _ in path.go_on(stretches * many_rates.usual_epoch(scene) / 64))
    for log in itertools.chain([path.log], later):
        sizes = [size for bands in path.bands for size in np.diff(bands.first)]
        assert log.pending[0] == sum(map(math.comb, sizes, itertools.repeat(2))) < 64 * discs
        assert log.times.size < max(200 * discs, many_paths.LOG_ENTRIES + 1)


def test_which_kernel_runs(monkeypatch):
    """By the number of discs, and by whether a hop is counted."""
    small, large = (td.Scene(15.0, 1.0, 0.1, discs=n) for n in (CELL_DISCS - 1, CELL_DISCS))
    assert many_initial_states.large_grid(small) is None
    assert many_initial_states.large_grid(large) is not None
    assert [make_grid(scene).x.size for scene in [*SHORT, *TORI]] == [4, 3, 4, 3]
    assert make_grid(TORI[0]).y.size == 3
    monkeypatch.setattr(class_counts, "run_classes", lambda *_, hops: (hops,))
    monkeypatch.setattr(class_counts, "combine_classes", bool)
    for events in (EVENTS, HOPS[:1], WALLS):
        assert class_counts.run_blocks(large, events, 1, 0, 1, 1.0) == (events != WALLS)


def test_a_ring_with_just_enough_room_has_two_cells():
    tight = replace(SHORT[1], radius=SHORT[1].width / (4 * LEAST_CELL_SIDE))
    tight.require_followable()
    assert make_grid(tight).x.size == 3
    with pytest.raises(td.InputError, match="room for two cells"):
        replace(tight, radius=math.nextafter(tight.radius, 1.0)).require_followable()


#: Scenes in which both kernels go there and back.
RETURNED = [BORDER[3], *SHORT, ROUGH_TOO, ROUGH]
RETURNED += [slow(TORI[1]), slow(BORDER[0]), slow(td.Scene(48.0, 1.0, 0.1, discs=64))]


@pytest.mark.parametrize("scene", RETURNED, ids=repr)
def test_advanced_states_are_those_of_the_other_kernel(scene):
    """After some events of each disc, and there and back again; rounds of a ring as well."""
    start, discs = many_initial_states.states(scene, 20, 9), scene.discs
    if scene.periodic:  # disc 1 moves along the border of two cells
        start[:discs] += (border := make_grid(scene).x[1]) - start[0]
        start[:discs] -= scene.width * np.round(start[:discs] / scene.width)
        start[0], start[2 * discs] = border, 0.0
    duration = many_rates.expected_duration(scene, 4 * discs)
    states, laps = start.copy(), np.zeros((2 * discs, 20))
    counts = scene.periodic and scene.moment_of_inertia is None
    hops, others = (np.zeros(20), np.zeros(20)) if counts else (None, None)
    many_paths.advance_all(scene, states, laps, duration, None, hops)
    other, rounds = start.copy(), np.zeros((2 * discs, 20))
    many.advance_states(other, rounds, duration, many.many_disc_law(scene), None, others)
    assert np.array_equal(laps, rounds)
    assert np.array_equal(hops, others)
    assert states == pytest.approx(other, abs=1e-7 * scene.width)
    states[2 * discs :] *= -1
    many_paths.advance_all(scene, states, laps, duration, None, hops)
    states[2 * discs :] *= -1
    assert states == pytest.approx(start, abs=1e-7 * scene.width)


#: Scenes whose trajectories have the events of the other kernel.
FOLLOWED = [*KICKED, slow(KICKED_TORUS), slow(BORDER[0]), ROUGH_TOO]
FOLLOWED += [slow(td.Scene(8.75, 0.6, 0.18, discs=20, friction=4.0))]


@pytest.mark.parametrize("scene", FOLLOWED, ids=repr)
def test_a_trajectory_has_the_events_of_the_other_kernel(scene, monkeypatch):
    """In the same order, hops as well, before roundings grow; also past full logs and rows."""
    state = many_initial_states.states(scene, 1, 1)[:, 0]
    for axis in scene.periodic:
        state[3 + scene.discs * (axis == "y")] += 2 * scene.side(axis)
    # The rate that is guessed for short rings is far too high.
    short = scene in KICKED[1:]
    duration = many_rates.expected_duration(scene, (10 if short else 5) * scene.discs)
    monkeypatch.setattr(many_paths, "LOG_ENTRIES", 50)
    monkeypatch.setattr(
        many_paths, "new_rows", lambda size: rows.Rows(*(a[..., :20] for a in rows.new_rows(size)))
    )
    found = [*path_events(scene, state, duration)]
    monkeypatch.undo()
    monkeypatch.setattr(many_paths, "large_grid", lambda scene: None)
    monkeypatch.setattr(many_paths, "record_rows", many_paths.record_rows.py_func)
    other = [*path_events(scene, state, duration)]
    assert len(found) > (2 if short or not scene.walled else 5) * scene.discs
    assert short or bool(scene.friction) == any(row[1] == "kick" for row in found)
    assert [row[1:4] for row in found] == [row[1:4] for row in other]
    for (time, *_, now), (same, *_, then) in zip(found, other, strict=True):
        assert time == pytest.approx(same, abs=1e-7)
        assert now == pytest.approx(then, abs=1e-7 * scene.width)


@pytest.mark.parametrize("share", [0.5, 0.999])
def test_events_are_as_many_as_expected_within_a_factor_of_two(share):
    """Those of a replica, too: 256 of each disc, and more if discs are crowded."""
    box = td.Box(5.0, 4.0, discs=CELL_DISCS)
    scene = box.scene(share * box.largest_radius)
    time, replicas = many_rates.expected_duration(scene), 8
    sums, _ = class_counts.run_classes(scene, 1, 0, 1, time, replicas=replicas)
    events = class_counts.simulated_events(sums) / replicas
    assert 0.5 < events / (time * many_rates.expected_event_rate(scene)) < 2
    assert 0.5 < events / (256 * box.discs * chains.crowding(scene)) < 2


@pytest.mark.parametrize(
    ("discs", "packing"),
    [
        (20, 0.3), slow(64, 0.3), slow(64, 0.6), slow(64, 0.7), slow(1024, 0.3), slow(1024, 0.6),
        slow(2048, 0.3),
    ],
)  # fmt: skip
def test_a_small_budget_has_an_error_bar(discs, packing):
    """If so many or crowded discs need long replicas, the warning has one that is enough."""
    side = math.sqrt(discs * math.pi / packing) / 10
    scene, budget = td.Scene(side, side, 0.1, discs=discs), 1e6
    with pytest.warns(td.AccuracyWarning):
        md = td.simulate(scene, budget=budget, seed=1)
    if packing == 0.7 or discs > 1024:
        assert "of the 100 replicas that an error needs" in md.note
        budget = float(md.note.split("A budget of ")[1].split()[0])
        with pytest.warns(td.AccuracyWarning):
            md = md.more(budget=budget)
    assert 100 <= md.point.replicas < 300
    assert md.point.events < 1.1 * budget
    assert all(one.stderr for one in md.values())
    # Replicas of another duration are done again.
    with pytest.warns(td.AccuracyWarning):
        assert td.simulate(scene, budget=1e5, seed=1).more(budget=budget) == md


@pytest.mark.parametrize("budget", [1e6, 1.2e6, 1.6e6, 4e6, 1e8])
@pytest.mark.parametrize("discs", [64, 1024, 2048, 4096])
@pytest.mark.parametrize("friction", [0.0, 0.01])
def test_a_budget_has_room_for_the_replicas_of_an_error_or_for_few(discs, budget, friction):
    """In whole blocks; few replicas have no error, and 150 of them are a budget that is enough."""
    scene = td.Scene(discs**0.5, discs**0.5, 0.3, discs=discs, periodic="xy", friction=friction)
    work = many_rates.work_per_event(scene)

    def planned(budget):
        duration = many_rates.replica_duration(scene, budget)
        each = many_rates.events_per_disc(scene, duration)
        block = many_rates.block_replicas(scene, duration)
        blocks = max(1, int(budget / work / (block * each * discs)))
        assert each >= 0.9 * discs / many_rates.DISCS_PER_EVENT
        return block * blocks, block * blocks * each * discs * work

    replicas, events = planned(budget)
    assert (replicas < 100) == (budget < 0.9 * 100 * work * discs**2 / many_rates.DISCS_PER_EVENT)
    assert planned(max(150 / replicas, 1) * events)[0] >= 100


def test_a_log_has_room_for_the_spins_of_rough_discs():
    shapes = [many_cells.new_log(3, rough).states.shape for rough in (None, 0.4)]
    assert shapes == [(3, 2, 4), (3, 2, 5)]


def test_crowded_discs_have_replicas_of_one_length():
    """Whatever the budget, with the most events of a replica. Rates of a channel are exact."""
    box = td.Box(64.0, 64.0, discs=4096, periodic="xy")
    roomy, crowded = (box.scene(share * box.largest_radius) for share in (0.5, 0.95))
    usual = many_rates.replica_duration(crowded)
    assert many_rates.replica_duration(crowded, 10**6) == usual
    events = usual * many_rates.expected_event_rate(crowded)
    assert 0.5 < events / many_rates.MOST_REPLICA_EVENTS < 2
    block = many_rates.block_replicas(roomy, many_rates.replica_duration(roomy))
    assert many_rates.block_replicas(roomy) == block
    assert many_paths.trajectory_rate(TORI[1]) == many_rates.expected_event_rate(TORI[1])
    kicked = td.Scene(3.0, 2.0, 0.2, discs=5, friction=1000.0)
    work = many_rates.work_per_event(kicked)
    less = many_rates.replica_duration(replace(kicked, friction=0)) / work
    assert work > 10
    assert 0.5 < many_rates.replica_duration(kicked) / less < 2
    # A chain lasts as long as a replica: at least 256 intervals, at most 64 windows of these.
    for scene, hop, window in (
        (BORDER[0], "vertical_hop", many_rates.replica_duration(BORDER[0])),
        (BORDER[0], "horizontal_hop", many_rates.replica_duration(BORDER[0])),
        (td.Scene(32.0, 32.0, 0.3, discs=1024), "vertical_hop", 64.0),
        (td.Scene(15.0, 1.0, 0.2499, discs=CELL_DISCS), "horizontal_hop", 2.0**28),
    ):
        mean = many_intervals.mean_interval(scene, hop)
        assert many_intervals.per_chain(scene, hop) == max(256, int(window / mean / 2))
    # An event of few discs is compared with all pairs.
    three, six = (many_rates.cost_ratio(td.Scene(1.5, 1.0, 0.1, discs=n)) - 1 for n in (3, 6))
    assert six == pytest.approx(5 * three)
    # A kick has its work.
    few, hop = td.Scene(1.5, 1.0, 0.1, discs=4), "vertical_hop"
    both = [many_intervals.events_per_interval(replace(few, friction=f), hop) for f in (0.0, 3.0)]
    assert both[1] == pytest.approx(both[0] * many_rates.work_per_event(replace(few, friction=3.0)))
    channel = td.Scene(8.0, 0.41, 0.2, discs=CELL_DISCS)
    for event in ("any_wall", "disc_collision"):
        assert many_rates.expected_rates(channel)[event] == pytest.approx(td.rate(channel, event))
    # Wall hits are guessed here, and collisions are 1.6 times the guess.
    box = td.Box(32.0, 32.0, discs=1024)
    found = many_rates.expected_rates(box.scene(0.985 * box.largest_radius))
    assert found["disc_collision"] / found["any_wall"] == pytest.approx(1.605, rel=1e-3)


def test_errors_have_the_correlation_of_successive_replicas():
    """Sums of four neighbours in a row of random numbers; each error is known to 3 %."""
    alone = np.random.default_rng(3).integers(1000, 1100, (8000, 2))
    together = sum(np.roll(alone, k, 0) for k in range(4))
    for counts, ratio in ((alone, 1), (together, 19 / 6)):
        spread = np.diag(class_counts.spread_of_batches(counts, 6)) / 8000 - counts.mean(0) ** 2
        assert spread / counts.var(0) == pytest.approx(ratio, rel=0.15)


def test_only_successive_states_of_a_chain_are_in_batches(monkeypatch):
    """Crowded discs have a new chain for each state, and these are independent."""
    spread = Mock(wraps=class_counts.spread_of_batches)
    monkeypatch.setattr(class_counts, "spread_of_batches", spread)
    for packing, calls in ((0.7, 0), (0.5, 1)):
        side = math.sqrt(CELL_DISCS * math.pi * 0.01 / packing)
        scene = td.Scene(side, side, 0.1, discs=CELL_DISCS, periodic="xy")
        class_counts.run_classes(scene, 1, 0, 1, 0.01, replicas=20)
        assert spread.call_count == calls


def check_state(scene, state):
    """Discs do not overlap and are between the walls; energy and momenta are what they were."""
    x, y, u, v, *s = np.reshape(state, (-1, scene.discs))
    i, j = np.array([*itertools.combinations(range(scene.discs), 2)]).T
    square = distance_square(scene, {"x": (x[i], x[j]), "y": (y[i], y[j])})
    gap = np.sqrt(np.min(square)) - scene.contact_distance
    assert gap >= -1e-13 * max(scene.width, scene.height)
    assert "x" in scene.periodic or np.max(np.abs(x)) <= scene.range_x / 2 * (1 + 1e-15)
    assert "y" in scene.periodic or np.max(np.abs(y)) <= scene.range_y / 2 * (1 + 1e-15)
    turning = scene.moment_of_inertia * np.sum(s[0] ** 2) if s else 0.0
    assert abs(np.sum(u * u + v * v) + turning - 1) < 1e-11
    for axis, velocities in (("x", u), ("y", v)):
        assert axis not in scene.conserved or abs(np.sum(velocities)) < 1e-10


side = math.sqrt(256 * math.pi * 0.01 / 0.6)
#: In both kernels: dilute, dense and hardly fitting discs, tiny ones and rings.
STAYING = {
    "hardly fit": td.Scene(1.5, 1.0, 0.3005102, discs=3),
    "tiny": td.Scene(1.5, 1.0, 1e-9, discs=5),
    "ring": td.Scene(1.5, 1.0, 0.2, discs=4, periodic="x"),
    "dense ring": td.Scene(side, side, 0.1, discs=256, periodic="x"),
    "torus": td.Scene(1.0, 1.0, 0.2499999, discs=3, periodic="xy"),
    "dense torus": td.Scene(side, side, 0.1, discs=256, periodic="xy"),
    "three": td.Scene(1.5, 1.0, 0.15, discs=3),
    "many": td.Scene(side, side, 0.1, discs=256),
    "rough": BORDER[4],
}


@pytest.mark.parametrize(
    ("name", "events"),
    [*((name, 4e4) for name in [*STAYING][:5]), *(slow(name, 2e7) for name in [*STAYING][5:])],
)
def test_nothing_overlaps_or_drifts(name, events):
    scene, states = STAYING[name], many_initial_states.states(STAYING[name], 1, 1)
    laps, part = np.zeros((2 * scene.discs, 1)), many_rates.expected_duration(scene, events)
    hops = np.zeros(1) if scene.periodic else None  # as the kernels that are compiled above
    for _ in range(5):
        many_paths.advance_all(scene, states, laps, part, None, hops)
        check_state(scene, states)
