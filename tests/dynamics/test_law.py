"""The law of one event of two plain discs and the contact of balls, against 50 digits.

Without these tests one event could be off by more than its inputs allow, where doubles have it
hard.
"""

import math
from itertools import combinations

import mpmath
import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from twodiscs.dynamics import law as event_law
from twodiscs.model.scene import Scene

#: Python runs these two, and their inner functions are compiled.
next_event, after_event = event_law.next_event.py_func, event_law.after_event.py_func

EPS = 2.0**-52
HALF_X, HALF_Y = 0.55, 0.3
SIGMA = 0.4


def mp(value):
    return mpmath.mpf(float(value))


def exact_contact(x, v, sigma):
    """Time to contact (None if discs miss or part) and its conditioning, both to 50 digits.

    The second value is Σ |p ∂t/∂p| over all inputs p: how far the time moves, to first order, if
    each input is wrong by one relative unit.
    """
    with mpmath.workdps(50):
        x, v, sigma = [*map(mp, x)], [*map(mp, v)], mp(sigma)
        a, b, c = mpmath.fdot(v, v), mpmath.fdot(x, v), mpmath.fdot(x, x) - sigma**2
        discriminant = b**2 - a * c
        if b >= 0 or discriminant <= 0:
            return None, None
        root = mpmath.sqrt(discriminant)
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
        assert abs(mp(found) - time) <= 8 * EPS * conditioning + 4 * EPS * abs(time)


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
        with mpmath.workdps(50):
            true = (mp(math.copysign(limit, velocity)) - mp(position)) / mp(velocity)
            # One rounding of the gap; none of the velocity, however small.
            assert abs(mp(gap) / mp(speed) - true) <= EPS * true


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
    assert sum(map(mp, parts)) == mp(whole)
    for part, share in zip(parts, (first, second), strict=True):
        assert part == pytest.approx(whole * share / (first + second), abs=2 * EPS * whole)
