"""Many discs that are rough or kicked.

Without these tests rough or kicked discs, more than two, could gain energy, or be kicked as another
replica.

Statistical comparisons allow five standard errors.
"""

from collections import Counter
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from exact_motion import path_events
from marks import slow
from sampling.uniformity import assert_uniform_on_sphere

from twodiscs import Scene, simulate
from twodiscs.dynamics import ensemble
from twodiscs.dynamics.ensemble import LANES, open_all, open_block_kicks
from twodiscs.dynamics.many import all_pairs as many
from twodiscs.dynamics.many import cell_list, class_counts, many_intervals, many_paths, many_rates
from twodiscs.dynamics.rows import Rows
from twodiscs.model.many_geometry import CELL_DISCS
from twodiscs.sampling.many import many_initial_states
from twodiscs.theory.exact import replicas_needed

FIVE = Scene(1.5, 1.0, 0.1, discs=5, moment_of_inertia=0.3)
RING = Scene(4.0, 2.0, 0.15, discs=CELL_DISCS, periodic="x", moment_of_inertia=0.5)


@pytest.fixture
def in_python(monkeypatch):
    """Trajectories of few discs without a kernel of their own, which takes seconds to compile."""
    monkeypatch.setattr(many_paths, "record_rows", many_paths.record_rows.py_func)


@pytest.mark.usefixtures("in_python")
@pytest.mark.parametrize(
    ("periodic", "inertia"), [("", None), ("", 0.4), slow("x", None), slow("x", 0.4)]
)
def test_two_discs_are_those_of_the_engine_of_two(periodic, inertia):
    """One by one: the same events at the same times with the same velocities and spins."""
    scene = Scene(1.5, 1.0, 0.2, moment_of_inertia=inertia, periodic=periodic)
    start = many_initial_states.states(scene, 1, 5)[:, 0]
    # x1, x2, y1, y2, u1, u2, v1, v2, s1, s2 and x1, y1, x2, y2, u1, v1, u2, v2, s1, s2.
    order = [0, 2, 1, 3, 4, 6, 5, 7, 8, 9][: start.size]
    found = [*Rows.joined([*many_paths.path_rows(scene, start, 12.0)]).events()]
    other = [*path_events(scene, tuple(start[order]), 12.0)]
    assert len(found) > 30
    for (time, *event, state), (due, *same, known) in zip(found, other, strict=True):
        assert event == same
        assert time == pytest.approx(due, abs=1e-9)
        assert np.array(state)[order] == pytest.approx(known, abs=1e-8)


@pytest.mark.parametrize(
    ("scene", "friction", "time"),
    [(FIVE, 0.0, 0.0), slow(FIVE, 0.0, 3.0), slow(FIVE, 2.0, 3.0), slow(RING, 2.0, 3.0)],
)
def test_velocities_and_spins_are_on_a_sphere(scene, friction, time):
    """At the start and later, also after kicks."""
    scene, replicas, n = replace(scene, friction=friction), 4096, scene.discs
    states, laps = many_initial_states.states(scene, replicas, 7), np.zeros((2 * n, replicas))
    if time:
        kicks = open_block_kicks(many.new_kicks(scene, replicas), 7)
        many_paths.advance_all(scene, states, laps, time, kicks)
    unit = states[2 * n :].copy()
    unit[2 * n :] *= np.sqrt(scene.moment_of_inertia)
    assert np.sum(unit**2, axis=0) == pytest.approx(1, abs=1e-12)
    assert_uniform_on_sphere(unit)


def test_bursts_in_a_neck_need_initial_states_in_it():
    """As two discs alone, divided by the pairs; smooth discs have no bursts."""
    near = Scene(2.2, 1.0, 0.25 / 1.001, discs=3, moment_of_inertia=0.02)
    pair = replace(near, discs=2)
    due = replicas_needed(pair, "disc_collision", 0.01) / 3
    assert replicas_needed(near, "disc_collision", 0.01) == pytest.approx(due)
    for event in ("right_wall", "top_wall", "any_wall"):  # each disc is in two pairs
        due = replicas_needed(pair, event, 0.005) / 3
        assert replicas_needed(near, event, 0.01) == pytest.approx(due)
    assert replicas_needed(replace(near, moment_of_inertia=None), "top_wall", 0.01) == 0
    found = simulate(near, 0.02, budget=1e6, seed=1)
    assert found["disc_collision_time"].status == "too-few"
    assert found["right_wall_time"].status == "reached"


FEW = Scene(1.5, 1.0, 0.15, discs=3, friction=4.0)
KICKED = Scene(3.0, 1.0, 0.15, discs=3, periodic="x", friction=4.0)


@pytest.mark.usefixtures("in_python")
@pytest.mark.parametrize("scene", [slow(FEW), KICKED], ids=["few", "ring"])
def test_a_kick_keeps_places_energy_and_momentum(scene):
    """Kicks are rows of a trajectory, and their number is that of a Poisson process."""
    time = 32.0
    start = many_initial_states.states(scene, 1, 3)[:, 0]
    if scene.periodic:
        # Another momentum along the ring, which has to stay.
        start[2 * scene.discs : 3 * scene.discs] += 0.1
        start[2 * scene.discs :] /= np.linalg.norm(start[2 * scene.discs :])
    rows = [*path_events(scene, start, time, seed=3)]
    names = Counter(row[1] for row in rows)
    assert abs(names["kick"] - scene.friction * time) <= 5 * np.sqrt(scene.friction * time)
    momentum = start[2 * scene.discs : 3 * scene.discs].sum()
    for (before, *_, old), (now, name, first, second, new) in pairwise(rows):
        (x, y, u, v), (*_, w) = np.split(np.array(new), 4), np.split(np.array(old), 4)
        assert np.sum(u * u + v * v) == pytest.approx(1, abs=1e-12)
        assert not scene.periodic or np.sum(u) == pytest.approx(momentum, abs=1e-12)
        if name == "kick":
            assert (first, second) == (None, None)
            assert np.all(v != w)
            old_x, old_y, old_u, _ = np.split(np.array(old), 4)
            assert x == pytest.approx(old_x + old_u * (now - before), abs=1e-9)
            assert y == pytest.approx(old_y + w * (now - before), abs=1e-9)
    other = [*path_events(scene, start, time, seed=4)]
    assert np.array_equal(other[0][-1], rows[0][-1])
    assert not np.array_equal(other[-1][-1], rows[-1][-1])


def test_kicks_belong_to_replicas_not_to_blocks(monkeypatch):
    """Two blocks of four replicas from the same state are one block of eight."""
    duration = many_rates.expected_duration(KICKED, 24)
    assert duration * KICKED.friction > 3
    state = many_initial_states.states(KICKED, 1, 1)
    monkeypatch.setattr(class_counts, "draw_states", lambda *given: np.copyto(given[2], state))
    first, _ = class_counts.run_classes(KICKED, 5, 0, 1, duration, replicas=4)
    halves = class_counts.run_classes(KICKED, 5, 0, 2, duration, replicas=4)
    whole = class_counts.run_classes(KICKED, 5, 0, 1, duration, replicas=8)
    assert np.array_equal(halves[0], whole[0])
    assert np.array_equal(halves[1], whole[1])
    assert not np.array_equal(halves[0], 2 * first)


def test_replicas_beyond_the_first_lanes_have_their_own_kicks_laps_and_hops():
    """They are those of the same states with the same kicks, followed alone."""
    scene, more = Scene(2.25, 1.0, 0.2, discs=3, periodic="x", friction=4.0), 3
    states = many_initial_states.states(scene, LANES + more, 9)
    results = states, np.zeros((6, LANES + more)), np.zeros(LANES + more)
    alone, kicks = [each[..., LANES:].copy() for each in results], many.new_kicks(scene, more)
    open_all(np.uint64(9), LANES, kicks)
    all_kicks = open_block_kicks(many.new_kicks(scene, LANES + more), 9)
    for (now, laps, hops), own in ((results, all_kicks), (alone, kicks)):
        many_paths.advance_all(scene, now, laps, 20.0, own, hops)
    for each, due in zip(results, alone, strict=True):
        assert np.array_equal(each[..., LANES:], due)


def test_cells_have_the_kicks_of_their_replicas(monkeypatch):
    """Trajectories with kicks are compared with the other kernel; counts are from the same loop."""
    opened, followed = [], []
    monkeypatch.setattr(cell_list, "open_kicks", lambda *given: opened.append(given[:3]))
    monkeypatch.setattr(cell_list, "start_from", lambda *given: None)
    monkeypatch.setattr(cell_list, "follow_discs", lambda *given: followed.append(given[7:9]))
    monkeypatch.setattr(cell_list, "count_events", cell_list.count_events.py_func)
    scene = replace(RING, moment_of_inertia=None, friction=4.0)
    class_counts.run_classes(scene, 5, 3, 5, 1.0, replicas=4)
    assert opened == [(0, 5, replica) for replica in range(12, 20)]
    assert all(lane == 0 and kicks.rate == 4.0 for lane, kicks in followed)
    assert len(followed) == 8


def test_chains_have_the_kicks_of_their_numbers(monkeypatch):
    """In each block, and beyond the first lanes; nothing goes on after the kicks are opened."""
    opened, chains = [], LANES + 2
    monkeypatch.setattr(ensemble, "open_kicks", lambda *given: opened.append(given[:3]))
    monkeypatch.setattr(many, "record_intervals", many.record_intervals.py_func)
    bins, ended = (0.1, None, np.full(65, 65)), np.zeros(1, np.bool_)
    many_intervals.record_intervals(FEW, "vertical_hop", 3, 2, 4, chains, bins, ended, window=8.0)
    assert opened == [(chain % chains % LANES, 3, chain) for chain in range(2 * chains, 4 * chains)]
