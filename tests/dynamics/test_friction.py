"""Friction: kicks draw all velocities anew, and no mean time changes.

Statistical comparisons allow five standard errors, some 40 of them.
"""

import math
from collections import Counter
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from dynamics.rates import check_rates
from effect_scenes import SCENES
from sampling.uniformity import assert_uniform
from scipy.special import betainc

import twodiscs as td
from twodiscs.dynamics import runs, trajectory
from twodiscs.dynamics.ensemble import open_kicks
from twodiscs.dynamics.law import law_of
from twodiscs.dynamics.two.follow import kicked, new_kicks, new_rows, put_state
from twodiscs.model.checks import InputError
from twodiscs.model.events import EVENTS, HOPS
from twodiscs.model.scene import Scene
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.starts import components, states
from twodiscs.sampling.streams import exponential, open_stream
from twodiscs.theory import exact

PLAIN = Scene(1.5, 1.0, 0.2)
ALL = Scene(
    1.5, 1.0, 0.2, periodic="x", field=0.3, radius_ratio=1.2, mass_ratio=2.0, moment_of_inertia=0.4
)


#: The fast tests have one scene with spins, a field and a ring.
NAMED = SCENES | {"all": ALL}
#: A scene without effects, and one that takes long to compile.
BOTH = pytest.mark.parametrize(
    "scene", [PLAIN, pytest.param(ALL, marks=pytest.mark.slow)], ids=["plain", "all"]
)


def slow(*names):
    """Return the names as parameters of slow tests: each compiles kicks of its own."""
    return [pytest.param(name, marks=pytest.mark.slow) for name in names]


@compiled
def kick_again(state, number, seed, law, kicks):
    """Return the states after each of a ``number`` of kicks, one a column."""
    rows = new_rows(number, law)
    open_kicks(0, seed, 0, kicks)
    for i in range(number):
        state = kicked(state, 0, kicks.waits[0], law, kicks)
        put_state(rows, i, state, law)
    return rows


def momenta_and_energy(scene, state):
    """Return ({axis: total momentum}, kinetic energy) of columns of states."""
    of = dict(zip(components(scene), state, strict=True))
    momenta, energy = {}, 0.0
    for axis, name in zip("xyz", "uvw", strict=True):
        if f"{name}1" in of:
            pairs = [(m, of[f"{name}{i}"]) for i, m in enumerate(scene.masses, 1)]
            momenta[axis] = sum(m * v for m, v in pairs)
            energy = energy + sum(m * v * v for m, v in pairs) / 2
    if scene.moment_of_inertia:
        for i, m in enumerate(scene.masses, 1):
            energy = energy + m * scene.moment_of_inertia * of[f"s{i}"] ** 2 / 2
    return momenta, energy


@pytest.mark.parametrize(
    "name", ["friction", *slow("all", "torus", "field", "rough", "combination")]
)
def test_a_kick_keeps_places_energy_and_conserved_momenta(name):
    """The momentum along a periodic axis stays what it is, 0 in the ensemble and not 0 here."""
    scene = replace(NAMED[name], friction=1.0)
    start = states(scene, 1, 5)[: len(components(scene)), 0]
    start[components(scene).index("u1")] += 0.3
    given = np.uint64(1), law_of(scene), new_kicks(scene, 1)
    found = np.array(kick_again(tuple(start), 50, *given))
    names = components(scene)
    for row, name, value in zip(found, names, start, strict=True):
        if name[0] in "xyz":
            assert np.all(row == value)
        else:
            assert len(set(row)) == 50
    before, after = momenta_and_energy(scene, start[:, None]), momenta_and_energy(scene, found)
    assert np.allclose(after[1], before[1], rtol=1e-13)
    for axis in scene.axes:
        same = np.abs(after[0][axis] - before[0][axis]) < 1e-14
        assert np.all(same) if axis in scene.conserved else not np.any(same)


@pytest.mark.parametrize("name", ["friction", *slow("all", "torus", "rough", "combination")])
def test_velocities_after_a_kick_are_uniform_on_the_sphere(name):
    """Components scaled by √mass, along conserved axes the relative one, by √(reduced mass)."""
    scene = replace(NAMED[name], friction=1.0)
    start = states(scene, 1, 5)[: len(components(scene)), 0]
    given = np.uint64(2), law_of(scene), new_kicks(scene, 1)
    found = np.array(kick_again(tuple(start), 20_000, *given))
    of, (m1, m2), rows = dict(zip(components(scene), found, strict=True)), scene.masses, []
    for axis, v in zip(scene.axes, "uvw", strict=False):
        if axis in scene.conserved:
            rows.append(math.sqrt(m1 * m2 / (m1 + m2)) * (of[f"{v}1"] - of[f"{v}2"]))
        else:
            rows += [math.sqrt(m1) * of[f"{v}1"], math.sqrt(m2) * of[f"{v}2"]]
    if scene.moment_of_inertia:
        inertia = scene.moment_of_inertia
        rows += [math.sqrt(inertia * m) * of[f"s{i}"] for i, m in ((1, m1), (2, m2))]
    unit = np.array(rows) / np.sqrt(np.sum(np.square(rows), axis=0))
    d, n = unit.shape
    assert d == scene.velocity_components
    for i, a in enumerate(unit):
        assert abs(np.mean(np.sign(a))) <= 5 / math.sqrt(n)
        assert_uniform(betainc(1 / 2, (d - 1) / 2, a**2))
        for b in unit[:i]:
            assert abs(np.mean(a * b)) <= 5 * np.std(a * b) / math.sqrt(n)
        # One kick does not know of the one before.
        assert abs(np.mean(a[1:] * a[:-1])) <= 5 / (d * math.sqrt(n))


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


@pytest.mark.slow
def test_rare_hops_have_their_exact_rate():
    """In a strip, with kicks before and after a start: none, one or several hops."""
    for rate in (3.0, 100.0):
        scene, hop = Scene(1.5, 1.0, 0.2495, friction=rate), "horizontal_hop"
        point = runs.count_events(scene, {hop: 0.02}, 10**8, 7)
        found = point.strips[hop].estimate()
        assert abs(found.value - exact.mean_times(scene)[hop]) <= 5 * found.stderr
        assert found.relative_stderr < 0.025


@BOTH
def test_intervals_have_their_exact_mean(scene):
    """Rough discs have none without friction, because they are not ergodic."""
    hop, scene = "vertical_hop", replace(scene, friction=2.0)
    found = td.intervals(scene, hop, 2**16, seed=3).mean
    assert abs(found.value - exact.mean_times(scene)[hop]) <= 5 * found.stderr


@BOTH
def test_bits_do_not_depend_on_shards_or_lanes(scene):
    scene = replace(scene, friction=2.0)

    def counts(first, stop, lanes=64):
        return runs.run_blocks(scene, EVENTS, 3, first, stop, 8.0, replicas=100, lanes=lanes)

    whole, halves = counts(0, 4), [counts(0, 1), counts(1, 4)]
    for total, *shards, other in zip(whole, *halves, counts(0, 4, 7), strict=True):
        assert np.array_equal(total, sum(shards))
        assert np.array_equal(total, other)


def test_lanes_without_a_replica_are_not_kicked():
    """A lane that never began has no time to its next kick: a kick in it would never end."""
    kicks = new_kicks(replace(PLAIN, friction=2.0), 3)
    open_kicks(1, np.uint64(3), 0, kicks)
    assert np.isfinite(kicks.waits).tolist() == [False, True, False]


def test_kicks_have_other_random_numbers_than_initial_states():
    """The first kick does not come at the time that the stream of a block of states would give."""
    kicks, seed = new_kicks(replace(PLAIN, friction=2.0), 1), np.uint64(3)
    for replica in range(4):
        open_kicks(0, seed, replica, kicks)
        assert kicks.waits[0] != exponential(open_stream(seed, replica)) / 2.0


@pytest.mark.parametrize("discs", [2, 3])
def test_states_of_two_blocks_are_kicked_as_those_of_one_that_is_twice_as_large(discs):
    scene = Scene(1.5, 1.0, 0.1, discs=discs, friction=2.0)
    whole = trajectory.path_of(scene).kicks_of(scene, 8, 3).waits
    assert np.array_equal(trajectory.path_of(scene).kicks_of(scene, 4, 3, block=1).waits, whole[4:])
    assert len({*whole}) == 8


@BOTH
def test_a_trajectory_has_the_kicks_of_the_ensemble(scene):
    """It has the same events as a replica of the ensemble, and kicks at random times."""
    scene, time = replace(scene, friction=4.0), 256.0
    start = tuple(map(float, states(scene, 1, 3)[: len(components(scene)), 0]))
    rows = list(trajectory.events_of(scene, start, time, seed=3))
    names = Counter(row[1] for row in rows)
    sums, _ = runs.run_blocks(scene, EVENTS, 3, 0, 1, time, replicas=1, lanes=1)
    counts = dict(zip(EVENTS, sums.tolist(), strict=True))
    for event in {*HOPS, "disc_collision"} & {*scene.events}:
        assert counts[event] == names[event]
    walls = sum(n for name, n in names.items() if name.startswith("wall"))
    assert (counts["any_wall"], rows[-1][1]) == (walls, "end")
    assert abs(names["kick"] - 4 * time) <= 5 * math.sqrt(4 * time)
    for (before, *_, old), (at, event, *_, new) in pairwise(rows):
        if event == "kick":
            velocities = [i for i, name in enumerate(components(scene)) if name[0] in "uvs"]
            assert all(old[i] != new[i] for i in velocities)
            assert at > before
    # Another seed has the same start and other kicks.
    other = list(trajectory.events_of(scene, start, time, seed=4))
    assert other[0] == rows[0]
    assert other[-1][-1] != rows[-1][-1]


def test_velocities_forget_at_the_rate_of_kicks():
    """⟨v(0)·v(t)⟩ is e^(−γt) of what it is without collisions: here the discs are small."""
    scene, times = Scene(100.0, 100.0, 1e-3, friction=2.0), [0.1, 0.5, 1.0]

    def product(start, now):
        return start["u1"] * now["u1"]

    found = td.observe(scene, product, times, 2**15, seed=1)
    for time, mean, error in zip(times, found.mean, found.stderr, strict=True):
        assert abs(mean - 0.25 * math.exp(-2.0 * time)) <= 5 * error + 0.02 * 0.25
    together = td.observe(scene, product, times[-1:], 2**15, seed=1)
    assert together.mean[0] == pytest.approx(found.mean[-1], rel=1e-12)


def test_too_many_kicks_are_refused():
    for bad in (2e6, math.inf, -1.0, "1"):
        with pytest.raises(InputError, match=r"^friction must"):
            Scene(1.5, 1.0, 0.2, friction=bad)
