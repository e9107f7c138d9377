"""The law of one event, against 50 digits, and with effects against textbook formulas.

Without these tests one event could be off by more than its inputs allow, where doubles have it
hard, or the law of an effect be wrong at a contact, a wall or the end of a cell.
"""

import doctest
import math
import re
from collections import Counter
from dataclasses import replace
from itertools import combinations

import effect_scenes
import numpy as np
import pytest
from effect_scenes import exchanged
from exact_motion import path_events
from hypothesis import assume, example, given, settings
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


# Two plain discs, and contacts of balls -----------------------------------------------------------

HALF_X, HALF_Y = 0.55, 0.3
SIGMA = 0.4


def exact_contact(x, v, sigma):
    """Time to contact (None if discs miss or part) and its conditioning, both to 50 digits.

    The second value is Σ |p ∂t/∂p| over all inputs p: how far the time moves, to first order, if
    each input is wrong by one relative unit.
    """
    with mp.workdps(50):
        x, v, sigma = [*map(mpf, x)], [*map(mpf, v)], mpf(sigma)
        a, b, c = mp.fdot(v, v), mp.fdot(x, v), mp.fdot(x, x) - sigma**2
        discriminant = b**2 - a * c
        if b >= 0 or discriminant <= 0:
            return None, None
        root = mp.sqrt(discriminant)
        time = c / (root - b)
        moved = [(q, p * time, q + p * time) for q, p in zip(x, v, strict=True)]
        slopes = sum(abs(q * then) + abs(way * then) for q, way, then in moved) + sigma**2
        return time, slopes / root


def contact_time(x, v, sigma):
    gap, speed, approach = event_law.contact_quotient(*[*x, None][:3], *[*v, None][:3], sigma)
    return max(gap / speed, 0.0) if approach and speed > 0 else None


def check_contact(x, v, sigma):
    time, conditioning = exact_contact(x, v, sigma)
    found = contact_time(x, v, sigma)
    speed, approach = math.hypot(*v), -np.dot(x, v)
    parts = [(x[i] * v[j], x[j] * v[i]) for i, j in combinations(range(len(x)), 2)]
    impact, exact_impact = math.hypot(*(one - other for one, other in parts)), sigma * speed
    doubt = 8 * EPS * (sum(abs(one) + abs(other) for one, other in parts) + exact_impact)
    if abs(impact - exact_impact) <= doubt:
        # Some roundings of the inputs decide between hit and miss; a hit is at the closest
        # approach, to within the half-chord that the doubt leaves.
        if found is not None:
            half_chord = math.sqrt(4 * doubt * exact_impact) / speed**2
            assert abs(found - approach / speed**2) <= half_chord + 8 * EPS * found
    elif found is None or time is None:
        assert found is time or abs(approach) <= 8 * EPS * sigma * max(speed, 1.0)
    else:
        assert found >= 0
        assert abs(mpf(found) - time) <= 8 * EPS * conditioning + 4 * EPS * abs(time)


@given(
    st.floats(0, 2 * math.pi),
    st.floats(1e-12, 1e3),
    st.floats(0, 2 * math.pi),
    st.floats(1e-9, 1.4),
)
@example(direction=0.2, room=0.3, heading=0.0, speed=0.0)
@settings(max_examples=400, deadline=None, derandomize=True)
def test_contact_from_anywhere(direction, room, heading, speed):
    distance = SIGMA * (1 + room)
    x = distance * math.cos(direction), distance * math.sin(direction)
    check_contact(x, (speed * math.cos(heading), speed * math.sin(heading)), SIGMA)


@given(*[st.tuples(*[st.floats(-1, 1)] * 3)] * 2)
@settings(max_examples=200, deadline=None, derandomize=True)
def test_contact_of_balls(x, v):
    assume(math.hypot(*x) > SIGMA * (1 + 1e-9) and math.hypot(*v) > 1e-9)
    check_contact(x, v, SIGMA)


@given(st.floats(0, 2 * math.pi), st.floats(1e-3, 1e3), st.integers(-6, 6), st.floats(1e-3, 1.4))
@settings(max_examples=400, deadline=None, derandomize=True)
def test_grazing_within_some_roundings(direction, room, ulps, speed):
    """The impact parameter is σ to some ulps, so that the discriminant is 0 to some ulps."""
    impact = SIGMA * (1 + ulps * EPS)
    along = SIGMA * room
    c, s = math.cos(direction), math.sin(direction)
    x = -along * c - impact * s, -along * s + impact * c
    check_contact(x, (speed * c, speed * s), SIGMA)


@given(
    st.sampled_from([0.3, 1e-6, 1e6, 0.5 * (1 - 1e-9)]),
    st.floats(-1, 1),
    st.one_of(
        st.floats(-1, 1, allow_subnormal=True),
        st.sampled_from([0.0, -0.0, 5e-324, -5e-324, 1e-310, 2.0**-1022, 1.0, -1.0]),
    ),
)
@settings(max_examples=400, deadline=None, derandomize=True)
def test_wall_time(limit, place, velocity):
    position = limit * place
    gap, speed = event_law.wall_quotient(position, velocity, limit)
    assert gap >= 0
    assert speed == abs(velocity)
    if velocity != 0:
        with mp.workdps(50):
            true = (mpf(math.copysign(limit, velocity)) - mpf(position)) / mpf(velocity)
            # One rounding of the gap; none of the velocity, however small.
            assert abs(mpf(gap) / mpf(speed) - true) <= EPS * true


def step(state, remaining=math.inf, half_x=HALF_X, half_y=HALF_Y, sigma=SIGMA):
    law = event_law.Law(half_x, half_y, sigma)
    time, code = next_event(state, remaining, law)
    after = after_event(state, time, code, law)
    assert 0 <= time < math.inf
    assert all(map(math.isfinite, after))
    return time, code, after


@pytest.mark.parametrize("beyond", [1, 2, -1])
def test_a_disc_put_behind_its_wall_by_a_rounding_bounces_at_once(beyond):
    x = HALF_X + beyond * math.ulp(HALF_X)
    time, code, after = step((x, 0.2, -HALF_X, -HALF_Y, 0.5, 0.0, 0.0, 0.5))
    assert time <= 8 * EPS
    assert (code, after[0], after[4]) == (event_law.WALL_X1, HALF_X, -0.5)
    time, code, after = step(after)
    assert time > 0.1


@given(st.integers(0, 2**32 - 1), st.floats(1e-17, 1e-13))
@example(seed=0, approach=1e-16)
@settings(max_examples=200, deadline=None, derandomize=True)
def test_grazing_contact_never_repeats_for_ever(seed, approach):
    """At contact, with a normal speed of about a rounding, discs come apart in a few events."""
    angle = np.random.default_rng(seed).uniform(0, 2 * math.pi)
    c, s = math.cos(angle), math.sin(angle)
    state = (
        SIGMA * c / 2, SIGMA * s / 2, -SIGMA * c / 2, -SIGMA * s / 2,
        -0.5 * s - approach * c, 0.5 * c - approach * s, 0.5 * s, -0.5 * c,
    )  # fmt: skip
    elapsed = 0.0
    for _ in range(4):
        time, _, state = step(state, half_x=1.0, half_y=1.0)
        elapsed += time
    assert elapsed > 0.01


def test_hops_are_counted_once():
    """From + to exactly 0 and on to −, or back to +, there is one hop, or none."""
    pairs = (0.1, -0.1), (0.1, 0.0), (0.0, 0.1), (0.0, -0.1), (-0.1, 0.0)
    assert [event_law.crosses(*pair) for pair in pairs] == [True, False, False, True, True]
    assert event_law.crossing_time(0.3, -0.6) == 0.5


def test_the_law_of_a_plain_scene_has_no_effects():
    """An effect that is None is not compiled."""
    law = event_law.two_disc_law(Scene(1.5, 1.0, 0.2))
    assert law == (0.55, 0.3, 0.4, *[None] * (len(event_law.Law._fields) - 3))


@given(st.floats(0.1, 10), st.floats(1e-3, 1e3), st.floats(1e-3, 1e3))
@settings(max_examples=200, deadline=None, derandomize=True)
def test_a_division_has_parts_whose_sum_is_the_whole(whole, first, second):
    """To the last bit; a rounding in the sum would be the same at every event, and add up."""
    parts = event_law.divided(whole, first, second)
    assert sum(map(mpf, parts)) == mpf(whole)
    for part, share in zip(parts, (first, second), strict=True):
        assert part == pytest.approx(whole * share / (first + second), abs=2 * EPS * whole)
