"""Rough discs, more than two: the law of an event, what stays, and the sphere of velocities.

Their rates, both kernels and hops of a pair are tested beside those of smooth discs. Statistical
comparisons allow five standard errors.
"""

import math
from dataclasses import replace
from itertools import islice, pairwise

import numpy as np
import pytest

import twodiscs as td
from twodiscs.dynamics import trajectory
from twodiscs.dynamics.many import engine, path
from twodiscs.model.scene import Scene
from twodiscs.sampling.many import initial
from twodiscs.theory.exact import replicas_needed

BOX = Scene(1.5, 1.0, 0.15, discs=3, moment_of_inertia=0.3)
RING = Scene(4.0, 2.0, 0.15, discs=initial.LARGE, periodic="x", moment_of_inertia=0.5)


def five(values, due):
    error = values.std(ddof=1) / math.sqrt(values.size)
    assert abs(values.mean() - due) <= 5 * error, (values.mean(), due, error)


def surface_velocity(u, v, s, normal):
    """Return the velocity of a surface, (x, y), where the outward ``normal`` leaves its disc."""
    return np.array([u - s * normal[1], v + s * normal[0]])


@pytest.mark.parametrize(
    "scene",
    [BOX, *(pytest.param(s, marks=pytest.mark.slow) for s in (replace(BOX, periodic="x"), RING))],
    ids=repr,
)
def test_surfaces_reverse_their_velocities(scene):
    """All of it, at discs and at walls. Energy stays, and so does momentum at discs."""
    # Not all rows: another law may gain energy without end.
    rows = [*islice(path.events_of(scene, initial.states(scene, 1, 2)[:, 0], 16.0), 2000)]
    seen = set()
    for (_, _, _, _, before), (_, name, first, second, now) in pairwise(rows):
        x, y, *_ = now.reshape(5, -1)
        old, new = before.reshape(5, -1)[2:], now.reshape(5, -1)[2:]
        energy = np.sum(new[:2] ** 2) + scene.moment_of_inertia * np.sum(new[2] ** 2)
        assert energy == pytest.approx(1, abs=1e-12)
        i = first - 1 if first else None
        if name.startswith("wall_"):
            at = np.array([x[i], 0.0]) if name[5] == "x" else np.array([0.0, y[i]])
            normal = at / np.linalg.norm(at)
            ends = [surface_velocity(*some[:, i], normal) for some in (old, new)]
        elif name == "disc_collision":
            j = second - 1
            apart = np.array([x[j] - x[i], y[j] - y[i]])
            if scene.periodic:
                apart[0] -= scene.width * np.round(apart[0] / scene.width)
            normal = apart / np.linalg.norm(apart)
            ends = [
                surface_velocity(*some[:, i], normal) - surface_velocity(*some[:, j], -normal)
                for some in (old, new)
            ]
            assert new[:2].sum(axis=1) == pytest.approx(old[:2].sum(axis=1), abs=1e-13)
            # Equal impulses along the surfaces turn both discs alike.
            assert new[2, i] - old[2, i] == pytest.approx(new[2, j] - old[2, j], abs=1e-13)
        else:
            continue
        assert ends[1] == pytest.approx(-ends[0], abs=1e-12)
        others = [k for k in range(scene.discs) if k + 1 not in (first, second)]
        assert np.array_equal(new[:, others], old[:, others])
        seen.add(name.rstrip("0123456789"))
    assert seen == {"disc_collision", "wall_y"} | ({"wall_x"} if not scene.periodic else set())


@pytest.mark.parametrize("periodic", ["", "x"])
def test_two_discs_are_those_of_the_engine_of_two(periodic):
    """One by one: the same events at the same times with the same velocities and spins."""
    scene = Scene(1.5, 1.0, 0.2, moment_of_inertia=0.4, periodic=periodic)
    start = initial.states(scene, 1, 5)[:, 0]
    # x1, x2, y1, y2, u1, u2, v1, v2, s1, s2 and x1, y1, x2, y2, u1, v1, u2, v2, s1, s2.
    order = [0, 2, 1, 3, 4, 6, 5, 7, 8, 9]
    found = [*path.events_of(scene, start, 12.0)]
    other = [*trajectory.events_of(scene, tuple(start[order]), 12.0)]
    assert len(found) > 30
    for (time, *event, state), (due, *same, known) in zip(found, other, strict=True):
        assert event[0] == same[0]
        assert time == pytest.approx(due, abs=1e-9)
        assert state[order] == pytest.approx(known, abs=1e-8)


@pytest.mark.parametrize("scene", [BOX, pytest.param(RING, marks=pytest.mark.slow)], ids=repr)
def test_reversed_discs_come_back(scene):
    """Velocities and spins are reversed after some events of each disc, in both kernels."""
    start, laps = initial.states(scene, 20, 3), np.zeros((scene.discs, 20))
    states, duration = start.copy(), engine.duration_of(scene, 4 * scene.discs)
    engine.advance_all(scene, states, laps, duration, None)
    assert np.abs(states - start).max() > 0.1
    states[2 * scene.discs :] *= -1
    engine.advance_all(scene, states, laps, duration, None)
    states[2 * scene.discs :] *= -1
    assert states == pytest.approx(start, abs=1e-7 * scene.width)


@pytest.mark.parametrize(
    ("scene", "friction"),
    [
        (replace(BOX, discs=5, radius=0.1), 0.0),
        pytest.param(replace(BOX, discs=5, radius=0.1), 2.0, marks=pytest.mark.slow),
        pytest.param(RING, 0.0, marks=pytest.mark.slow),
        pytest.param(RING, 2.0, marks=pytest.mark.slow),
    ],
)
def test_velocities_and_spins_are_on_a_sphere(scene, friction):
    """At the start and later, also after kicks: two moments of each, and their pairs."""
    scene, replicas = replace(scene, friction=friction), 2048 if scene is not RING else 512
    d, n = 3 * scene.discs, scene.discs
    states, laps = initial.states(scene, replicas, 7), np.zeros((n, replicas))
    for time in (0.0, 3.0):
        if time:
            kicks = engine.kicks_of(scene, replicas, 7)
            engine.advance_all(scene, states, laps, time, kicks)
        u, v, s = states.reshape(5, n, -1)[2:]
        s = s * math.sqrt(scene.moment_of_inertia)
        assert (u**2 + v**2 + s**2).sum(axis=0) == pytest.approx(1, abs=1e-12)
        for part in (u, v, s):
            for disc in (0, n - 1):
                five(part[disc] ** 2, 1 / d)
                five(part[disc] ** 4, 3 / d / (d + 2))
            five(part.sum(axis=0) ** 2, n / d)
        for one, other in ((u, v), (u, s), (v, s)):
            five(one[0] * other[0], 0.0)
            five(one[0] ** 2 * other[0] ** 2, 1 / d / (d + 2))


def test_rough_walls_take_the_momentum_along_a_ring():
    """It is 0 only in the mean, and forgotten; the one of smooth discs stays 0."""
    n, replicas = RING.discs, 512
    states, laps = initial.states(RING, replicas, 4), np.zeros((n, replicas))
    before = states[2 * n : 3 * n].sum(axis=0)
    engine.advance_all(RING, states, laps, 64.0, None)
    after = states[2 * n : 3 * n].sum(axis=0)
    five(after, 0.0)
    five(before * after, 0.0)
    five(after**2, 1 / 3)
    assert RING.velocity_components == 3 * n


def test_energy_does_not_drift():
    """Over a million events of 20 discs on a ring."""
    states, laps = initial.states(RING, 1, 5), np.zeros((RING.discs, 1))
    engine.advance_all(RING, states, laps, engine.duration_of(RING, 1e6), None)
    energy = np.sum(states[40:80] ** 2) + RING.moment_of_inertia * np.sum(states[80:] ** 2)
    assert abs(energy - 1) < 1e-11


def test_bursts_in_a_neck_need_initial_states_in_it():
    """As two discs alone, divided by the pairs; smooth discs have no bursts."""
    near = Scene(2.2, 1.0, 0.25 / 1.001, discs=3, moment_of_inertia=0.02)
    pair = replace(near, discs=2)
    assert replicas_needed(near, "disc_collision", 0.01) == pytest.approx(
        replicas_needed(pair, "disc_collision", 0.01) / 3
    )
    assert replicas_needed(near, "top_wall", 0.01) == pytest.approx(
        replicas_needed(pair, "top_wall", 0.005) / 3
    )
    assert replicas_needed(replace(near, moment_of_inertia=None), "top_wall", 0.01) == 0
    found = td.simulate(near, 0.02, budget=1e6, seed=1)
    assert found["disc_collision_time"].status == "too-few"
    assert found["right_wall_time"].status == "reached"


def test_a_start_needs_the_energy_of_its_spins():
    (start,) = td.starts(BOX, 1, seed=1)
    assert len(td.trajectory(BOX, 2.0, start=start)) > 2
    start["s3"] *= 2
    with pytest.raises(td.InputError, match=r"^start must have a total energy of 0.5, not "):
        td.trajectory(BOX, 2.0, start=start)


def test_the_face_measures_rough_discs():
    """Averages of spins stay; intervals need friction, as for two discs."""
    found = td.observe(BOX, lambda start, now: now["s2"] ** 2, [0, 2], 4096, seed=1)
    assert np.all(np.abs(found.mean - 1 / 9 / BOX.moment_of_inertia) <= 5 * found.stderr)
    with pytest.raises(td.InputError, match=r"^scene must have smooth discs"):
        td.intervals(BOX, "vertical_hop", 1000, seed=1)
    kicked = td.intervals(replace(BOX, friction=2.0), "vertical_hop", 20000, seed=1)
    assert abs(kicked.mean.z) <= 5
    path = td.trajectory(BOX, 4.0, seed=1)
    (state,) = path.states_at(path["time"].iloc[-2:-1])
    assert [state[f"s{disc}"] for disc in (1, 2, 3)] == path.iloc[-2][["s1", "s2", "s3"]].to_list()
