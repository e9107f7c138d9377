"""Kicks by friction: their law, their streams, and mean times with them.

Without these tests kicks could have another law, repeat themselves, or change mean times.

Statistical comparisons allow five standard errors, some 40 of them.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from dynamics.rates import check_rates
from effect_scenes import ALL, PAPER, SCENES
from marks import slow
from sampling.uniformity import assert_uniform_on_sphere, parts, scaled_components

import twodiscs as td
from twodiscs.dynamics import law
from twodiscs.dynamics.engine import find_engine
from twodiscs.dynamics.ensemble import open_block_kicks, open_kicks
from twodiscs.dynamics.many import all_pairs
from twodiscs.dynamics.two.follow import new_kicks
from twodiscs.sampling.initial_states import components, states
from twodiscs.sampling.streams import exponential, open_stream
from twodiscs.theory import exact

NAMED = SCENES | {"all": ALL, "rings": replace(SCENES["combination"], periodic="xz")}
#: A scene without effects, and one that takes long to compile.
BOTH = pytest.mark.parametrize("scene", [PAPER, slow(ALL)], ids=["plain", "all"])


@pytest.mark.parametrize("name", ["friction", "all", "torus", "rings"])
def test_a_kick_keeps_places_and_draws_velocities_on_the_sphere(name):
    """Also their energy, and the momentum along a periodic axis: 0 in the ensemble, not 0 below."""
    scene = replace(NAMED[name], friction=1.0)
    start = states(scene, 1, 5)[: len(components(scene)), 0]
    kicks, stream = new_kicks(scene, 1), open_stream(np.uint64(2), 0)
    redrawn = law.redrawn.py_func  # of which each effect would compile another one

    def kicked(state, number):
        """Yield the states after each of a ``number`` of kicks."""
        for _ in range(number):
            state = redrawn(state, stream, kicks.direction, kicks.velocity, kicks.sampler)
            yield state

    found = np.array([*kicked(tuple(start), 8000)]).T
    for row, q, value in zip(found, components(scene), start, strict=True):
        assert q[0] not in "xyz" or np.all(row == value)
    unit = scaled_components(scene, *parts(scene, found), roundings=16_000)
    assert_uniform_on_sphere(unit)
    # One kick does not know of the one before.
    d, n = unit.shape
    assert np.all(np.abs(np.mean(unit[:, 1:] * unit[:, :-1], axis=1)) <= 5 / (d * math.sqrt(n)))
    for velocity, _ in zip("uvw", scene.axes, strict=False):
        start[components(scene).index(f"{velocity}1")] += 0.3
    found, spins = parts(scene, np.array([start, *kicked(tuple(start), 50)]).T)
    energy = sum(scene.masses @ found[axis][2:] ** 2 for axis in scene.axes)
    if spins is not None:
        energy += scene.moment_of_inertia * (scene.masses @ spins**2)
    assert np.ptp(energy) < 50 * 16 * 2.0**-52  # roundings
    for axis in scene.axes:
        momentum = scene.masses @ found[axis][2:]
        assert (np.ptp(momentum) < 1e-14) == (axis in scene.conserved)


@pytest.mark.parametrize("ring", ["", "x"])
@pytest.mark.parametrize("inertia", [None, 0.4])
def test_a_kick_of_three_discs_keeps_energy_and_momentum(inertia, ring):
    """The energy is 1/2; smooth discs on a ring keep their momentum, others have none to keep."""
    scene = td.Scene(1.5, 1.0, 0.1, discs=3, friction=1.0, periodic=ring, moment_of_inertia=inertia)
    start = states(scene, 1, 5)[6:].reshape(-1, 3, 1)
    start[0] += 0.1
    n, law_of_three = 4000, all_pairs.many_disc_law(scene)
    moved, kicks = np.repeat(start, n, axis=2), open_block_kicks(all_pairs.new_kicks(scene, 1), 2)
    u, v, spins = moved if len(moved) == 3 else (*moved, None)
    for l in range(n):
        all_pairs.redraw.py_func(u, v, spins, l, 0, law_of_three, kicks)
    weights = np.array([1.0, 1.0, scene.moment_of_inertia or 0.0])[: len(moved), None, None]
    mean = start[0].mean() if scene.conserved else 0.0
    moved[0] -= mean
    energies = np.sum(weights * moved**2, axis=(0, 1))
    assert energies == pytest.approx(1 - 3 * mean**2, abs=1e-13)
    if scene.conserved:
        assert np.sum(moved[0], axis=0) == pytest.approx(0, abs=1e-14)
    else:
        assert_uniform_on_sphere((np.sqrt(weights) * moved).reshape(-1, n))


@pytest.mark.parametrize("angle", range(8))
def test_a_kick_leaves_discs_that_move_alike(angle):
    """Roundings give their relative energy, 0, either sign; its root changes velocities by 1e-8."""
    torus = td.Scene(2.0, 2.0, 0.1, periodic="xy", mass_ratio=0.7, friction=1.0)
    way = np.array([math.cos(angle), math.sin(angle)])
    kicks, alike = new_kicks(torus, 1), (way / math.sqrt(sum(torus.masses))).tolist()
    state = 0.0, 0.0, 0.5, 0.0, *alike, *alike
    given = open_stream(np.uint64(2), 0), kicks.direction, kicks.velocity, kicks.sampler
    assert law.redrawn.py_func(state, *given) == pytest.approx(state, abs=1e-7)
    three = replace(torus, mass_ratio=1.0, discs=3)
    same = np.repeat(way / math.sqrt(3), 3).reshape(2, 3, 1)
    moved, kicks = same.copy(), open_block_kicks(all_pairs.new_kicks(three, 1), 2)
    all_pairs.redraw.py_func(*moved, None, 0, 0, all_pairs.many_disc_law(three), kicks)
    assert moved == pytest.approx(same, abs=1e-7)


@pytest.mark.parametrize("rate", [0.5, 20.0])
@BOTH
def test_no_mean_time_changes(scene, rate):
    both = scene, replace(scene, friction=rate)
    assert both[1].family == "effects"
    times, other = (exact.mean_times(one) for one in both)
    for event, time in times.items():
        assert other[event] == (time if time is None else pytest.approx(time, rel=1e-13))
    assert exact.volume(both[1]) == pytest.approx(exact.volume(scene), rel=1e-13)
    assert both[1].velocity_components == scene.velocity_components
    check_rates(both[1], seed=6, blocks=16)


@BOTH
def test_intervals_have_their_exact_mean(scene):
    """Rough discs have none without friction, because they are not ergodic."""
    hop, scene = "vertical_hop", replace(scene, friction=2.0)
    found = td.intervals(scene, hop, 2**16, seed=3).mean
    assert abs(found.value - exact.mean_times(scene)[hop]) <= 5 * found.stderr


def test_lanes_without_a_replica_are_not_kicked():
    """A lane that never began has no time to its next kick: a kick in it would never end."""
    kicks = new_kicks(replace(PAPER, friction=2.0), 3)
    open_kicks(1, np.uint64(3), 0, kicks)
    assert np.isfinite(kicks.waits).tolist() == [False, True, False]


def test_kicks_have_other_random_numbers_than_initial_states():
    """The first kick does not come at the time that the stream of a block of states would give."""
    kicks, seed = new_kicks(replace(PAPER, friction=2.0), 1), np.uint64(3)
    for replica in range(4):
        open_kicks(0, seed, replica, kicks)
        assert kicks.waits[0] != exponential(open_stream(seed, replica)) / 2.0


@pytest.mark.parametrize("discs", [2, 3])
def test_states_of_two_blocks_are_kicked_as_those_of_one_that_is_twice_as_large(discs):
    scene = td.Scene(1.5, 1.0, 0.1, discs=discs, friction=2.0)
    new = find_engine(scene).paths.new_kicks
    whole = open_block_kicks(new(scene, 8), 3).waits
    assert np.array_equal(open_block_kicks(new(scene, 4), 3, first=4).waits, whole[4:])
    assert len({*whole}) == 8


def test_velocities_forget_at_the_rate_of_kicks():
    """⟨v(0)·v(t)⟩ is e^(−γt) of what it is without collisions: here the discs are small."""
    scene, times = td.Scene(100.0, 100.0, 1e-3, friction=2.0), [0.1, 0.5, 1.0]

    def product(start, now):
        return start["u1"] * now["u1"]

    found = td.observe(scene, product, times, 2**15, seed=1)
    for time, mean, error in zip(times, found.mean, found.stderr, strict=True):
        assert abs(mean - 0.25 * math.exp(-2.0 * time)) <= 5 * error + 0.02 * 0.25
    together = td.observe(scene, product, times[-1:], 2**15, seed=1)
    assert together.mean[0] == pytest.approx(found.mean[-1], rel=1e-12)


def test_kicks_may_leave_no_event_to_a_run():
    found = td.simulate(replace(PAPER, friction=1e6), 1, budget=1)
    assert {(one.count, one.status) for one in found.values()} == {(0, "none-seen")}
