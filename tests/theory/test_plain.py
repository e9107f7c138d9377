"""Plain scenes against antiderivatives of many digits, for the very doubles that the scene holds.

The definitions of the shells are tested by throwing discs into a box.
"""

import math

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from mpmath import mp
from scipy.special import bdtr, bdtrc
from theory.antiderivatives import (
    DIGITS,
    TURNED,
    reference,
    reference_shell,
    reference_times,
    relative_error,
)

from twodiscs.model.box import Box
from twodiscs.model.events import AXIS, DECLARED, EVENTS, HOPS, SHELLS, WALLS
from twodiscs.model.scene import Scene
from twodiscs.theory import exact

BOUND = 1e-13

PAPER = (1.5, 1.0)
BOXES = [PAPER, (1.0, 1.0), (2.0, 1.0), (1.0, 2.0), (3.0, 1.0), (1.0, 1.7), (1e6, 1.0), (1.0, 1e6)]


@pytest.fixture(autouse=True, scope="module")
def digits():
    """Work with many digits."""
    with mp.workdps(DIGITS):
        yield


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
        radius = draw(
            st.sampled_from(
                [threshold, math.nextafter(threshold, 0), math.nextafter(threshold, math.inf)]
            )
        )
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
        if time is None:
            assert times[event] is None
        else:
            assert relative_error(times[event], time) < BOUND, event


@settings(max_examples=400, deadline=None, derandomize=True)
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


@pytest.mark.parametrize("box", BOXES)
@pytest.mark.parametrize("offset", [0, 1e-15, 1e-14, 1e-12, 1e-9, 1e-6, 1e-3])
def test_both_sides_of_every_threshold(box, offset):
    for threshold in (box[0] / 4, box[1] / 4, Box(*box).largest_radius):
        for radius in (threshold * (1 - offset), threshold * (1 + offset)):
            if Box(*box).fits(radius):
                check_accuracy(Scene(*box, radius))


@settings(max_examples=200, deadline=None, derandomize=True)
@given(hard_scenes(), st.floats(-9, 0), st.booleans())
def test_shells_are_right_to_1e_13(scene, exponent, by_room):
    room = abs(scene.largest_radius - scene.radius)
    epsilon = (min(scene.radius, room) if by_room and room > 0 else scene.radius) * 10**exponent
    for event in SHELLS:
        found = exact.shell_expectation(scene, event, epsilon)
        assert relative_error(found, reference_shell(scene, event, epsilon)) < BOUND, event


@pytest.mark.parametrize(("width", "height"), [(-190, -189), (189, 190), (190, -190)])
def test_the_smallest_and_largest_boxes(width, height):
    box = 2.0**width, 2.0**height
    for radius in (2.0**-195, min(box) / 4, min(box) * 0.3, Box(*box).largest_radius * (1 - 1e-6)):
        scene = Scene(*box, radius)
        with mp.workdps(500):
            check_accuracy(scene)


# Definitions ------------------------------------------------------------------------------------

SCENES = [
    (1.5, 1.0, 0.2),
    (1.5, 1.0, 0.3),
    (1.5, 1.0, 0.38),
    (1.0, 1.7, 0.28),
    (3.0, 1.0, 0.45),
    (1.0, 1.0, 0.251),
]


@pytest.mark.parametrize(("width", "height", "radius"), SCENES)
def test_shells_contain_what_random_discs_hit(width, height, radius):
    """Exact binomial tails at 5 sigma, 6e-7: for some 40 numbers of all scenes together 2e-5."""
    scene, samples, epsilon = Scene(width, height, radius), 2_000_000, radius / 3
    rng = np.random.default_rng(4)
    a, b, sigma = width / 2 - radius, height / 2 - radius, 2 * radius
    x1, x2 = rng.uniform(-a, a, (2, samples))
    y1, y2 = rng.uniform(-b, b, (2, samples))
    distance = np.hypot(x1 - x2, y1 - y2)
    free, root = distance >= sigma, math.sqrt(2)
    shells = {
        "vertical_hop": np.abs(y1 - y2) / root <= epsilon,
        "horizontal_hop": np.abs(x1 - x2) / root <= epsilon,
        "disc_collision": (distance - sigma) / root <= epsilon,
    }
    for wall in WALLS:
        half, centre = (a, x1) if AXIS[wall] == "x" else (b, y1)
        shells[wall] = half - DECLARED[wall].side * centre <= epsilon
    prism = (4 * a * b) ** 2
    expected = {"volume": (np.count_nonzero(free), exact.volume(scene) / prism)}
    for event, shell in shells.items():
        size = epsilon * (2 if event in HOPS else 1)
        share = exact.shell_expectation(scene, event, epsilon) * size / prism
        expected[event] = np.count_nonzero(free & shell), share
    for quantity, (hits, share) in expected.items():
        tail = min(bdtr(hits, samples, share), bdtrc(hits - 1, samples, share))
        assert 2 * tail > 5.7e-7, quantity


def test_a_shell_reaches_just_beyond_a_blocked_hop():
    scene = Scene(1, 1, 0.2501)
    assert exact.areas(scene)["vertical_hop"] == 0
    assert exact.shell_expectation(scene, "vertical_hop", 0.05) > 0
    assert exact.shell_expectation(scene, "vertical_hop", 1e-4) == 0


# Identities -------------------------------------------------------------------------------------


@settings(max_examples=100, deadline=None, derandomize=True)
@given(hard_scenes(), st.integers(-20, 20))
def test_scaling_is_exact_and_turning_the_box_swaps_the_names(scene, power):
    scale = 2.0**power
    big = Scene(scale * scene.width, scale * scene.height, scale * scene.radius)
    assert exact.volume(big) == scale**4 * exact.volume(scene)
    assert exact.areas(big) == {e: scale**3 * x for e, x in exact.areas(scene).items()}

    turned = Scene(scene.height, scene.width, scene.radius)
    assert exact.volume(turned) == pytest.approx(exact.volume(scene), rel=BOUND)
    times, turned_times = exact.mean_times(scene), exact.mean_times(turned)
    for event, other in TURNED.items():
        if times[event] is None:
            assert turned_times[other] is None
        else:
            assert turned_times[other] == pytest.approx(times[event], rel=BOUND)
