"""The law of one event with effects, against textbook formulas.

Without these tests the event law of an effect could be wrong at a contact, a wall or the end of a
cell.
"""

import doctest
import math
import re
from collections import Counter
from dataclasses import replace

import effect_scenes
import numpy as np
import pytest
from effect_scenes import exchanged
from exact_motion import path_events
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from marks import slow
from mpmath import mp, mpf

from twodiscs.dynamics import law as event_law
from twodiscs.dynamics.engine import find_engine
from twodiscs.dynamics.law import DISC, END_OF_TIME, fall_quotient, two_disc_law
from twodiscs.dynamics.two import follow
from twodiscs.model.events import DECLARED_EVENTS, EVENT_AXES, EVENTS, HOPS, WALLS
from twodiscs.model.scene import Scene
from twodiscs.sampling.initial_states import STATE_ROWS, components, states
from twodiscs.sampling.jit import compiled

EPS = 2.0**-52
SCENES = effect_scenes.SCENES | {
    "dense": Scene(1.5, 1.0, 0.38),
    "stack": Scene(1.5, 1.0, 0.3755, field=0.5),
    "tube": Scene(1.5, 1.0, 0.2, depth=1.2, mass_ratio=2.0, periodic="z"),
    "all": effect_scenes.ALL,
}


fall = compiled(lambda position, velocity, *other: fall_quotient(position, velocity, *other))

#: Python runs these two, and their inner functions are compiled: a whole law takes seconds.
next_event, after_event = event_law.next_event.py_func, event_law.after_event.py_func

#: Friction is no part of the law.
LAWS = [scene for name, scene in SCENES.items() if name != "friction"]


def start(scene, seed):
    """Return a state of the invariant measure."""
    return tuple(map(float, states(scene, 1, seed)[: len(components(scene)), 0]))


def parts(scene, state):
    """Return positions and velocities as {axis: pair}, and the pair of spins."""
    q, p = {"x": state[0:4:2], "y": state[1:4:2]}, {"x": state[4:8:2], "y": state[5:8:2]}
    if scene.depth is not None:
        q["z"], p["z"] = state[8:10], state[10:12]
    return q, p, state[8:10] if scene.moment_of_inertia is not None else (0.0, 0.0)


def energy(scene, state):
    """Return the total energy of a state."""
    q, p, spins = parts(scene, state)
    total = []
    for i, (mass, radius) in enumerate(zip(scene.masses, scene.radii, strict=True)):
        total += [mass * p[axis][i] ** 2 / 2 for axis in p]
        total.append((scene.moment_of_inertia or 0.0) * mass * spins[i] ** 2 / 2)
        total.append(mass * scene.field * (q["y"][i] + scene.height / 2 - radius))
    return math.fsum(total)


def reversed_state(scene, state):
    """Return the state with velocities and spins reversed, as the loop keeps it."""
    column, kept = np.zeros((2, STATE_ROWS, 1))
    column[: len(state), 0] = state
    follow.keep_reversed(kept, 0, column, 0, two_disc_law(scene), True)
    return tuple(map(float, kept[: len(state), 0]))


# Conserved quantities ---------------------------------------------------------------------------


@pytest.mark.parametrize("scene", LAWS, ids=repr)
def test_energy_momentum_and_room_are_kept(scene):
    """Over 5000 events; roundings of a sum of n random signs grow like √n, here 71."""
    law, state, places = two_disc_law(scene), start(scene, 1), []
    assert energy(scene, state) == pytest.approx(0.5, abs=4 * EPS)
    for _ in range(5000):
        time, code = next_event(state, math.inf, law)
        assert 0.0 <= time < math.inf
        state = after_event(state, time, code, law)
        assert abs(energy(scene, state) - 0.5) < 4 * 71 * EPS
        q, p, _ = parts(scene, state)
        distance = math.hypot(*(a - b for a, b in q.values()))
        assert distance / scene.contact_distance - 1 > -64 * EPS
        for axis in scene.walled:
            for place, radius in zip(q[axis], scene.radii, strict=True):
                assert abs(place) <= scene.side(axis) / 2 - radius + 2 * EPS
        for axis in scene.periodic:
            assert abs(q[axis][0] - q[axis][1]) <= scene.side(axis) / 2 * (1 + 64 * EPS)
        for axis in scene.conserved:
            momentum = sum(m * v for m, v in zip(scene.masses, p[axis], strict=True))
            assert abs(momentum) < 4 * 71 * EPS
        places.append([np.dot(scene.masses, q[axis]) for axis in scene.conserved])
    # Coordinates therefore stay of the size of the box, in a run of any length.
    assert not scene.conserved or np.ptp(places, axis=0).max() < 1e-11


@pytest.mark.parametrize("scene", LAWS, ids=repr)
def test_reversed_velocities_lead_back(scene):
    law, first = two_disc_law(scene), start(scene, 2)
    state, times, number = first, [], 8
    for _ in range(number):
        time, code = next_event(state, math.inf, law)
        state, times = after_event(state, time, code, law), [*times, time]
    state = reversed_state(scene, state)
    # The last event is undone first; the path ends at its first state, in mid-flight.
    for _ in range(number):
        time, code = next_event(state, math.inf, law)
        state = after_event(state, time, code, law)
    state = reversed_state(scene, after_event(state, times[0], END_OF_TIME, law))
    assert state == pytest.approx(first, abs=1e-7)


#: {code: name} of events.
CODES = {code: name for name, code in vars(event_law).items() if re.match("WALL|WRAP|DISC", name)}


@pytest.mark.parametrize("scene", LAWS, ids=repr)
def test_no_motion_depends_on_which_disc_and_which_axis_is_the_first(scene):
    """Disc 2 as the first, in units of its mass; then x and y exchanged, which reverses spins."""
    views = [(*exchanged(scene), 1, "12", "21")]
    views += [] if scene.field else [(scene.turned(), 1.0, -1, "xyuvXY", "yxvuYX")]
    for other, speed, turn, *letters in views:
        renamed, laws = str.maketrans(*letters), (two_disc_law(scene), two_disc_law(other))
        units = dict.fromkeys("xyz", 1.0) | dict.fromkeys("uvw", speed) | {"s": turn * speed}
        one, after = start(scene, 4), None
        for _ in range(16):
            known = zip(components(scene), one, strict=True)
            known = {name.translate(renamed): units[name[0]] * value for name, value in known}
            same = tuple(known[name] for name in components(scene))
            assert after is None or same == pytest.approx(after, abs=1e-12)
            (time, code), (due, its_code) = map(next_event, (one, same), (math.inf,) * 2, laws)
            assert CODES[its_code] == CODES[code].translate(renamed)
            assert due * speed == pytest.approx(time, rel=1e-12, abs=1e-14)
            one = after_event(one, time, code, laws[0])
            after = after_event(same, due, its_code, laws[1])


#: The kernel that counts the events of a scene takes some seconds to compile.
COUNTED = [effect_scenes.PAPER, SCENES["combination"], SCENES["friction"]]
COUNTED += [Scene(1.5, 1.0, 0.15, discs=3), slow(replace(SCENES["all"], friction=2.0))]


@pytest.mark.parametrize("scene", COUNTED, ids=repr)
def test_a_trajectory_tells_the_same_events_as_the_ensemble(scene):
    rows = list(path_events(scene, start(scene, 3), 64.0, seed=3))
    names = Counter(row[1] for row in rows)
    seen = {event: names[event] for event in (*HOPS, "disc_collision")}
    discs = range(1, 1 + (scene.discs if scene.identical else 1))
    for wall in WALLS:
        # Both walls of an axis count, except the walls of y in a field.
        axis, side = EVENT_AXES[wall], DECLARED_EVENTS[wall].side
        seen[wall] = sum(
            row[1] == f"wall_{axis}{disc}"
            and (axis == "x" or not scene.field or row[4][2 * disc - 1] * side > 0)
            for row in rows
            for disc in discs
        )
    seen["any_wall"] = sum(n for name, n in names.items() if name.startswith("wall"))
    sums, products = find_engine(scene).counts.run_blocks(scene, EVENTS, 3, 0, 1, 64.0, replicas=1)
    assert np.array_equal(products, np.triu(np.outer(sums, sums)))
    for event, count in zip(EVENTS, sums, strict=True):
        assert event not in scene.events or count == seen[event]
    assert seen["any_wall"] > 10
    assert ("kick" in names) == bool(scene.friction)


# Falling ----------------------------------------------------------------------------------------


@settings(max_examples=300, deadline=None)
@given(position=st.floats(-0.5, 0.5), velocity=st.floats(-2, 2), field=st.floats(1e-6, 1e3))
def test_time_of_fall(position, velocity, field):
    """Against 50 digits; the error is the condition of the root times a few roundings."""
    assume(abs(velocity) > 1e-12)
    # The first wall ahead is a question of the sign of v² − 2 g (1/2 − y).
    with mp.workdps(50):
        y, v, g = mpf(position), mpf(velocity), mpf(field)
        left = v * v - 2 * g * (mpf(0.5) - y)
        assume(abs(left) > 1e-12 * v * v)
        if v > 0 and left > 0:
            true = (v - mp.sqrt(left)) / g
        else:
            left = v * v + 2 * g * (y + mpf(0.5))
            true = (v + mp.sqrt(left)) / g
        slope = abs(v - g * true)
        terms = abs(y) + mpf(0.5) + abs(v * true) + g * true**2
        bound = 8 * EPS * (true + terms / slope)
        gap_, speed = fall(position, velocity, 0.5, field)
        assert abs(mpf(gap_) / mpf(speed) - true) <= bound


def test_a_disc_that_grazes_the_top_falls_back():
    """v² = 2 g (limit − y) exactly: it stops there, and what counts is the floor."""
    gap_, speed = fall(0.0, 1.0, 0.5, 1.0)
    assert gap_ / speed == pytest.approx(1 + math.sqrt(2), rel=4 * EPS)


# Contacts ---------------------------------------------------------------------------------------


@settings(max_examples=200, deadline=None)
@given(st.integers(0, 10**6), st.floats(0.1, 10), st.floats(0.05, 1.0), st.floats(0.2, 5))
def test_rough_collisions_reverse_what_slides_and_what_approaches(seed, mass, inertia, ratio):
    """The relative velocity of the surfaces where they touch is reversed, along both directions.

    Energy and momentum stay, and both spins change by the same torque over the radius.
    """
    scene = Scene(100.0, 100.0, 0.1, mass_ratio=mass, moment_of_inertia=inertia, radius_ratio=ratio)
    generator = np.random.default_rng(seed)
    angle, sigma = generator.uniform(0, 2 * math.pi), scene.contact_distance
    n = np.array([math.cos(angle), math.sin(angle)])
    v1, v2 = generator.normal(size=(2, 2))
    assume((v1 - v2) @ n < -0.01)
    s1, s2 = generator.normal(size=2)
    place = sigma * n / 2
    state = (*place, *-place, *v1, *v2, s1, s2)
    after = after_event(state, 0.0, DISC, two_disc_law(scene))
    w1, w2, (t1, t2) = np.array(after[4:6]), np.array(after[6:8]), after[8:]
    t = np.array([-n[1], n[0]])

    def slip(a, b, spins):
        return np.array([(a - b) @ n, (a - b) @ t - sum(spins)])

    size = float(np.max(np.abs(state[4:])))
    assert np.allclose(slip(w1, w2, (t1, t2)), -slip(v1, v2, (s1, s2)), atol=1e-13 * size)
    assert np.allclose(v1 + mass * v2, w1 + mass * w2, rtol=0, atol=1e-12 * size * (1 + mass))
    assert energy(scene, state) == pytest.approx(energy(scene, after), rel=1e-12)
    # Forces at the point of contact turn either disc there by as much as the other, r n × impulse.
    turned = inertia * np.array([t1 - s1, mass * (t2 - s2)])
    assert turned == pytest.approx(turned[::-1], abs=1e-11 * size * (1 + mass))
    again = after_event((*after[:4], *after[4:]), 0.0, DISC, two_disc_law(scene))
    assert again[4:] == pytest.approx(state[4:], abs=1e-12 * size)


def test_the_worked_example_is_true():
    assert doctest.testmod(follow).attempted > 4
    assert doctest.testmod(follow).failed == 0
