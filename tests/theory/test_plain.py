"""Numbers of plain scenes, against antiderivatives of many digits.

Without these tests numbers of plain scenes could lose digits at some radius: antiderivatives of
many digits.
"""

import math

import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf
from theory.antiderivatives import reference, reference_shell, reference_times, relative_error

from twodiscs.model.events import EVENTS, HOPS, SHELL_EVENTS
from twodiscs.model.scene import Box, Scene
from twodiscs.theory import exact

BOUND = 1e-13

PAPER = (1.5, 1.0)


# Accuracy ---------------------------------------------------------------------------------------

sides = st.floats(-3, 3).map(lambda x: 10**x)
offsets = st.builds(lambda sign, x: sign * 10**x, st.sampled_from([-1, 1]), st.floats(-16, -1))


@st.composite
def hard_scenes(draw):
    """Draw boxes of all shapes up to 1e6, and radii where formulas break."""
    height = draw(sides)
    shape = draw(st.sampled_from(["any", "extreme", "square", "double"]))
    if shape == "any":
        ratio = 10 ** draw(st.floats(-0.5, 0.5))
    elif shape == "extreme":
        ratio = 10 ** draw(st.floats(-6, 6))
    else:
        ratio = (1 if shape == "square" else 2) * (1 + draw(st.just(0.0) | offsets))
    width = height * ratio
    if draw(st.booleans()):
        width, height = height, width

    largest = Box(width, height).largest_radius
    where = draw(st.sampled_from(["between", "small", "largest", "threshold", "next"]))
    threshold = draw(st.sampled_from([width / 4, height / 4]))
    if where == "between":
        radius = largest * draw(st.floats(0.01, 0.99))
    elif where == "small":
        radius = min(width, height) * 10 ** draw(st.floats(-12, -1))
    elif where == "largest":
        radius = largest * (1 - 10 ** draw(st.floats(-12, -1)))
    elif where == "threshold":
        radius = threshold * (1 + draw(offsets))
    else:
        ends = (threshold, 0, math.inf)
        radius = draw(st.sampled_from([math.nextafter(threshold, end) for end in ends]))
    assume(Box(width, height).fits(radius))
    return Scene(width, height, radius)


def check_accuracy(scene):
    expected = reference(scene)
    assert relative_error(exact.volume(scene), expected["volume"]) < BOUND
    areas, times = exact.areas(scene), exact.mean_times(scene)
    assert tuple(areas) == tuple(times) == EVENTS
    for event in EVENTS:
        assert relative_error(areas[event], expected[event]) < BOUND, event
    for event, time in reference_times(scene).items():
        assert (times[event] is None) == (time is None)
        assert time is None or relative_error(times[event], time) < BOUND, event


@settings(max_examples=250, deadline=None, derandomize=True)
@given(hard_scenes())
@example(Scene(*PAPER, Box(*PAPER).largest_radius * (1 - 1e-12)))
@example(Scene(1, 1, Box(1, 1).largest_radius * (1 - 1e-12)))
@example(Scene(2, 1, 0.5 * (1 - 1e-12)))
@example(Scene(1, 2, 0.5 * (1 - 1e-12)))
@example(Scene(1e6, 1, 0.5 * (1 - 1e-12)))
@example(Scene(1e-6, 1, 0.5e-6 * (1 - 1e-12)))
@example(Scene(1e6, 1e-6, 1e-18))
def test_every_number_is_right_to_1e_13(scene):
    check_accuracy(scene)


@settings(max_examples=120, deadline=None, derandomize=True)
@given(hard_scenes(), st.floats(-9, 0), st.booleans())
def test_shells_and_shares_near_hops_are_right_to_1e_13(scene, exponent, by_room):
    room = abs(scene.largest_radius - scene.radius)
    epsilon = (min(scene.radius, room) if by_room and room > 0 else scene.radius) * 10**exponent
    for event in SHELL_EVENTS:
        found = exact.shell_expectation(scene, event, epsilon)
        assert relative_error(found, reference_shell(scene, event, epsilon)) < BOUND, event
    volume, half = reference(scene)["volume"], mpf(epsilon) / mp.sqrt(2)
    for hop in HOPS:
        due = 2 * half * reference_shell(scene, hop, half) / volume
        assert relative_error(exact.fraction_near(scene, hop, epsilon), due) < BOUND, hop


@pytest.mark.parametrize(("width", "height"), [(-190, -189), (189, 190), (190, -190)])
def test_the_smallest_and_largest_boxes(width, height):
    box = 2.0**width, 2.0**height
    for radius in (2.0**-195, min(box) / 4, min(box) * 0.3, Box(*box).largest_radius * (1 - 1e-6)):
        scene = Scene(*box, radius)
        with mp.workdps(500):
            check_accuracy(scene)
