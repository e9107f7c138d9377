"""Dynamics of two discs in cases that are numerically hard.

Without these tests roundings could add, lose or repeat an event where arithmetic has it hard.
"""

import math

import pytest
from exact_motion import compare, path_events
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from twodiscs import Box, Scene, trajectory
from twodiscs.dynamics.law import two_disc_law
from twodiscs.sampling.initial_states import states
from twodiscs_paper.studies.single import advance

PAPER = Scene(1.5, 1.0, 0.2)
BOXES = [(1.5, 1.0), (1.0, 1.5), (1.0, 1.0), (2.0, 1.0), (3.0, 1.0), (1e-6, 1e6), (1e6, 1e-6)]


def hard_radii(box):
    """Return an ordinary radius, a tiny one, both sides of thresholds, some below the largest."""
    near = [radius * (1 + d) for radius in box.thresholds for d in (-1e-9, 1e-9)]
    near += [box.largest_radius * (1 - d) for d in (1e-3, 1e-6, 1e-9)]
    return [box.shortest / 5, box.shortest * 1e-9, *filter(box.fits, near)]


@pytest.mark.parametrize("sides", BOXES)
def test_every_hard_radius_of_every_box(sides):
    box = Box(*sides)
    for radius in hard_radii(box):
        scene = box.scene(radius)
        for seed in range(2):
            state = tuple(states(scene, 1, seed)[:8, 0].tolist())
            assert compare(scene, state, 60) >= 40, (radius, seed)


def unit_speed(*velocities):
    """Return the velocities, scaled to the energy 1/2."""
    speed = math.hypot(*velocities)
    return tuple(v / speed for v in velocities)


@pytest.mark.parametrize("radius", [1e-9, 1e-6, 1e-3])
@pytest.mark.parametrize("miss", [0.0, 0.5, 0.999999, 1.000001])
def test_tiny_discs_aimed_at_each_other(radius, miss):
    """From afar, an impact parameter of ``miss`` contact distances decides between hit and miss."""
    scene = PAPER.with_radius(radius)
    state = (-0.5, miss * 2 * radius, 0.5, 0.0, *unit_speed(1.0, 0.0, -1.0, 0.0))
    names = [row[1] for row in path_events(scene, state, 1.0)]
    assert names.count("disc_collision") == (miss < 1)
    assert compare(scene, state, 4) >= 2 if miss else compare(scene, state, 8) == 8


@pytest.mark.parametrize("state", [
    # no relative velocity
    (-0.3, 0.1, 0.3, -0.1, 0.6, 0.3741657386773941, 0.6, 0.3741657386773941),
    # one disc at rest, the other one on its way to it, or past it
    (-0.4, 0.05, 0.2, 0.0, 1.0, 0.0, 0.0, 0.0),
    (0.2, 0.0, -0.4, -0.25, 0.0, 0.0, 0.8, 0.6),
    # components exactly zero, of either sign, and denormal ones
    (-0.3, 0.1, 0.3, -0.1, 0.0, 0.8, -0.0, -0.6),
    (-0.3, 0.1, 0.3, -0.1, 1e-300, 0.8, -2.0**-1022, -0.6),
    # almost parallel
    (-0.3, 0.1, 0.3, -0.1, 0.6, 0.3741657386773941, 0.6 - 1e-13, 0.3741657386773941),
    # in contact, on the way in and on the way out
    (-0.2, 0.0, 0.2, 0.0, 0.8, 0.1, -0.5, 0.3),
    (-0.2, 0.0, 0.2, 0.0, -0.8, 0.1, 0.5, 0.3),
    # a rounding short of contact, and a rounding beyond it
    (-0.2, 0.0, 0.2 + 2.0**-54, 0.0, 0.8, 0.1, -0.5, 0.3),
    (-0.2, 0.0, 0.2 - 2.0**-54, 0.0, 0.8, 0.1, -0.5, 0.3),
    # both in corners, at the walls
    (0.55, 0.3, -0.55, -0.3, 0.7, 0.1, -0.2, -0.3),
    # one disc at rest on its walls, or sliding along one, while the other one comes and goes
    (-0.55, 0.3, -0.55, -0.3, -0.0, 0.0, 0.7, 0.7),
    (-0.55, -0.3, 0.55, 0.3, 0.7, 0.6, 0.0, 0.0),
    (0.55, 0.1, -0.2, -0.1, 0.0, 0.6, 0.5, 0.3),
    # discs on opposite walls, moving along them
    (0.55, 0.1, -0.55, -0.1, 0.0, 0.8, 0.0, -0.6),
])  # fmt: skip
def test_states_that_are_hard(state):
    assert compare(PAPER, (*state[:4], *unit_speed(*state[4:])), 40) >= 15


def test_corner_hit_exactly_by_both_discs():
    """Both run into opposite corners: four simultaneous events, and the way back."""
    scene = PAPER.with_radius(0.125)
    state = (0.625 - 0.25, 0.375 - 0.25, -0.625 + 0.25, -0.375 + 0.25, 0.5, 0.5, -0.5, -0.5)
    rows = list(path_events(scene, state, 1.0))
    assert [row[0] for row in rows] == [0.0, 0.5, 0.5, 0.5, 0.5, 1.0]
    assert sorted(row[1] for row in rows[1:-1]) == ["wall_x1", "wall_x2", "wall_y1", "wall_y2"]
    assert rows[-1][4][:4] == state[:4]


def test_discs_smaller_than_the_spacing_of_coordinates():
    """Centres that coincide have no line of centres: no division by zero, no energy lost."""
    scene = Scene(1e-6, 1e6, 1e-15)
    half_x, half_y = scene.range_x / 2, scene.range_y / 2
    for velocities in ((0.0, 0.0, 0.0, 1.0), (0.0, -1e-160, 0.0, 1.0)):
        state = (-half_x, 0.0, -half_x, -half_y, *velocities)
        for _ in range(20):
            state, time, _ = advance(state, two_disc_law(scene))
            assert 0 <= time < math.inf
            assert abs(math.fsum(v * v for v in state[4:]) - 1) < 1e-14


@pytest.mark.parametrize("discs", [2, 3, 20])
@pytest.mark.parametrize(("radius", "apart"), [(0.1, 0.2 * (1 - 1e-13)), (1e-20, 0.25)])
def test_discs_that_overlap_collide_at_once_or_go_on(discs, radius, apart):
    """An overlap by a rounding ends at time 0; centres that coincide have no line of centres."""
    scene, speed = Scene(8.0, 2.0, radius, discs=discs), math.sqrt(0.5)
    start = {f"{letter}{k + 1}": 0.0 for letter in "xyuv" for k in range(discs)}
    start |= {f"x{k + 1}": 0.3 * k - 3.5 for k in range(discs)}
    start |= {"y1": 0.5, "x2": start["x1"] + apart, "y2": 0.5, "u1": speed, "u2": -speed}
    rows = trajectory(scene, duration=0.2, start=start)
    first, last = rows[rows["event"] == "disc_collision"].iloc[0], rows.iloc[-1]
    assert first["time"] == pytest.approx(0.0 if radius == 0.1 else apart / 2 / speed, abs=1e-15)
    assert (rows["time"] >= 0).all()
    due = -speed if radius == 0.1 else speed
    assert [last["u1"], last["u2"]] == pytest.approx([due, -due])


#: Velocities that are trouble, before they are scaled to the energy.
speeds = st.one_of(
    st.sampled_from([0.0, -0.0, 1.0, -1.0, 0.5, 5e-324, -1e-310, 1e-300, -1e-160, 1e-17, -1e-16]),
    st.floats(-1, 1),
)


@given(
    st.sampled_from(BOXES),
    st.data(),
    st.tuples(*[st.sampled_from([-1.0, 0.0, 1.0, 1 - 2.0**-53, 0.3])] * 4),
    st.tuples(speeds, speeds, speeds, speeds),
)
@settings(max_examples=100, deadline=None, derandomize=True)
def test_any_combination_of_extremes_goes_on(sides, data, places, velocities):
    """Centres in corners, on walls, on one line; velocities zero, denormal, equal: on it goes.

    No time is negative or not a number, energy and gaps stay, and time advances.
    """
    box = Box(*sides)
    radius = data.draw(st.sampled_from(hard_radii(box)))
    scene = box.scene(radius)
    assume(math.hypot(*velocities) > 0.1)
    half_x, half_y, sigma = scene.range_x / 2, scene.range_y / 2, scene.contact_distance
    x1, y1, x2, y2 = (q * h for q, h in zip(places, (half_x, half_y) * 2, strict=True))
    assume((x1 - x2) ** 2 + (y1 - y2) ** 2 >= sigma**2)
    state = (x1, y1, x2, y2, *unit_speed(*velocities))
    law, elapsed = two_disc_law(scene), 0.0
    for number in range(300):
        state, time, _ = advance(state, law)
        assert time >= 0
        if time == math.inf:
            # Only if no event ever follows, except after the time of a denormal speed.
            assert number <= 8
            return
        elapsed += time
        assert abs(math.fsum(v * v for v in state[4:]) - 1) < 1e-12
        assert abs(state[0]) <= half_x + 1e-15 * box.width
        assert abs(state[3]) <= half_y + 1e-15 * box.height
        gap = math.hypot(state[0] - state[2], state[1] - state[3]) - sigma
        assert gap >= -1e-14 * max(sides)
    assert elapsed > 0
