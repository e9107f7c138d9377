"""Theory against references of 50 digits and more, for the very doubles that the scene holds.

The reference integrates over v first, then over u by antiderivatives, with 150 digits, of which
cancellation near the largest radius takes up to 100; the antiderivatives are checked against direct
two-dimensional quadrature, and the definitions of the shells by throwing discs into a box.
"""

import json
import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf
from scipy.special import bdtr, bdtrc

from twodiscs.model import events
from twodiscs.model.box import fits, largest_radius
from twodiscs.model.events import EVENTS, HOPS
from twodiscs.model.scene import Scene
from twodiscs.theory import exact, laws, tails

BOUND = 1e-13

PAPER = (1.5, 1.0)
BOXES = [PAPER, (1.0, 1.0), (2.0, 1.0), (1.0, 2.0), (3.0, 1.0), (1.0, 1.7), (1e6, 1.0), (1.0, 1e6)]


@pytest.fixture(autouse=True, scope="module")
def digits():
    """Work with 150 digits."""
    with mp.workdps(150):
        yield


def relative_error(value, exact):
    """Return |value/exact − 1|; an exact zero must be met exactly."""
    if exact == 0:
        return 0.0 if value == 0 else math.inf
    return float(abs(mpf(value) - exact) / abs(exact))


# The reference ----------------------------------------------------------------------------------


def lengths(scene):
    """Return (A, B, σ) of the scene's doubles, with all digits."""
    w, h, r = mpf(scene.width), mpf(scene.height), mpf(scene.radius)
    return w - 2 * r, h - 2 * r, 2 * r


class Profile:
    """Integrals over v ≥ k(u) = √(σ² − u²)₊, from u = 0 to x, for x ≥ 0."""

    def __init__(self, range_y, sigma):
        self.b, self.s = range_y, sigma
        # Below this u the arc runs above the rectangle.
        self.u0 = mp.sqrt(max(sigma**2 - range_y**2, mpf(0)))

    def integral(self, x, power, moment):
        """Return ∫ u^moment (B − k)₊^power du with power 1 or 2, moment 0 or 1."""
        if x <= self.u0:
            return mpf(0)
        b, s, end = self.b, self.s, min(x, self.s)

        def antiderivative(u):
            k = mp.sqrt(s * s - u * u)
            if moment == 0:
                of_1, of_k, of_k2 = u, (u * k + s * s * mp.asin(u / s)) / 2, s * s * u - u**3 / 3
            else:
                of_1, of_k, of_k2 = u * u / 2, -(k**3) / 3, s * s * u * u / 2 - u**4 / 4
            return b * of_1 - of_k if power == 1 else b * b * of_1 - 2 * b * of_k + of_k2

        total = antiderivative(end) - antiderivative(self.u0)
        if x > s:
            total += b**power * (x ** (moment + 1) - s ** (moment + 1)) / (moment + 1)
        return total

    def weighted(self, a, x, power):
        """Return ∫ (a − u) (B − k)₊^power du from 0 to x."""
        return a * self.integral(x, power, 0) - self.integral(x, power, 1)


def reference_volume(a, b, s):
    """Return the volume for ranges a, b and contact distance s; 0 when the discs do not fit."""
    return 2 * Profile(b, s).weighted(a, a, 2) if s * s < a * a + b * b else mpf(0)


def reference(scene):
    """Return the volume and the areas of a scene."""
    a, b, s = lengths(scene)
    profile = Profile(b, s)
    end = min(a, s)

    def antiderivative(u):  # of (A − u)(B/k − 1)
        k = mp.sqrt(s * s - u * u)
        return a * b * mp.asin(u / s) + b * k - a * u + u * u / 2

    right, top = profile.integral(a, 2, 0), 2 * profile.weighted(a, a, 1)
    return {
        "volume": 2 * profile.weighted(a, a, 2),
        "vertical_hop": mp.sqrt(2) * b * max(a - s, mpf(0)) ** 2,
        "horizontal_hop": mp.sqrt(2) * a * max(b - s, mpf(0)) ** 2,
        "disc_collision": 4 * mp.sqrt(2) * s * (antiderivative(end) - antiderivative(profile.u0)),
        "right_wall": right,
        "top_wall": top,
        "any_wall": 4 * (right + top),
    }


def reference_times(scene):
    """Return the mean times of a scene, by cases."""
    exact = reference(scene)
    volume = exact.pop("volume")
    one_sided = 3 * mp.pi / 2 * volume
    times = {event: one_sided / area if area else None for event, area in exact.items()}
    for hop, wall in (("horizontal_hop", "right_wall"), ("vertical_hop", "top_wall")):
        if times[hop] is None:
            times[wall] /= 2
        else:
            times[hop] /= 2
    return times


def reference_shell(scene, event, epsilon):
    """Return the expectation of a shell."""
    a, b, s = lengths(scene)
    thick = mpf(epsilon)
    if event == "disc_collision":
        outer = s + mp.sqrt(2) * thick
        return (reference_volume(a, b, s) - reference_volume(a, b, outer)) / thick
    if event in ("horizontal_hop", "top_wall"):
        a, b = b, a
    if event in HOPS:
        # ∬ over v ≤ √2 ε of 4 (A − u)(B − v), over 2ε: the profile with the axes exchanged.
        return Profile(a, s).weighted(b, min(mp.sqrt(2) * thick, b), 2) / thick
    # x1 = a − g: disc 2 is up to A − g to the left or up to g to the right of it.
    profile = Profile(b, s)
    within = min(thick, a)

    def twice(x):
        return profile.weighted(x, x, 2)

    return (twice(a) - twice(a - within) + twice(within)) / thick


SCENES = [
    (1.5, 1.0, 0.2),
    (1.5, 1.0, 0.3),
    (1.5, 1.0, 0.38),
    (1.0, 1.7, 0.28),
    (3.0, 1.0, 0.45),
    (1.0, 1.0, 0.251),
]


@pytest.mark.parametrize("lengths_given", SCENES[:4])
def test_reference_agrees_with_two_dimensional_quadrature(lengths_given):
    scene = Scene(*lengths_given)
    exact = reference(scene)
    with mp.workdps(18):
        a, b, s = lengths(scene)
        edges = sorted({mpf(0), mp.sqrt(max(s * s - b * b, 0)), min(s, a), a})

        def over_rectangle(density):
            def column(u):
                k = mp.sqrt(max(s * s - u * u, mpf(0)))
                return mp.quad(lambda v: density(u, v), [k, b]) if k < b else mpf(0)

            return mp.quad(column, edges)

        angles = [mp.acos(min(a / s, 1)), mp.asin(min(b / s, 1))]
        found = {
            "volume": 4 * over_rectangle(lambda u, v: (a - u) * (b - v)),
            "right_wall": 2 * over_rectangle(lambda u, v: b - v),
            "top_wall": 2 * over_rectangle(lambda u, v: a - u),
            # Two centres on the arc: length element σ/√2 dθ, common motion √2 (A − u) √2 (B − v).
            "disc_collision": 4 * mp.sqrt(2) * s * mp.quad(
                lambda q: (a - s * mp.cos(q)) * (b - s * mp.sin(q)), angles
            ),
        }  # fmt: skip
    for quantity, value in found.items():
        assert relative_error(value, exact[quantity]) < 1e-14


@pytest.mark.parametrize("box", BOXES)
def test_reference_has_fifty_digits_even_next_to_the_largest_radius(box):
    scene = Scene(*box, largest_radius(*box) * (1 - 1e-12))
    exact = reference(scene)
    with mp.workdps(400):
        for quantity, value in reference(scene).items():
            assert abs(exact[quantity] - value) <= abs(value) * mpf(10) ** -50


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

    largest = largest_radius(width, height)
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
    assume(fits(width, height, radius))
    return Scene(width, height, radius)


def check_accuracy(scene):
    exact = reference(scene)
    assert relative_error(exact.volume(scene), exact["volume"]) < BOUND
    areas, times = exact.areas(scene), exact.mean_times(scene)
    assert tuple(areas) == tuple(times) == EVENTS
    for event in EVENTS:
        assert relative_error(areas[event], exact[event]) < BOUND, event
    for event, time in reference_times(scene).items():
        if time is None:
            assert times[event] is None
        else:
            assert relative_error(times[event], time) < BOUND, event


@settings(max_examples=400, deadline=None, derandomize=True)
@given(hard_scenes())
@example(Scene(*PAPER, largest_radius(*PAPER) * (1 - 1e-12)))
@example(Scene(1, 1, largest_radius(1, 1) * (1 - 1e-12)))
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
    for threshold in (box[0] / 4, box[1] / 4, largest_radius(*box)):
        for radius in (threshold * (1 - offset), threshold * (1 + offset)):
            if fits(*box, radius):
                check_accuracy(Scene(*box, radius))


@settings(max_examples=200, deadline=None, derandomize=True)
@given(hard_scenes(), st.floats(-9, 0), st.booleans())
def test_shells_are_right_to_1e_13(scene, exponent, by_room):
    room = abs(scene.largest_radius - scene.radius)
    epsilon = (min(scene.radius, room) if by_room and room > 0 else scene.radius) * 10**exponent
    for event in events.SHELLS:
        found = exact.shell_expectation(scene, event, epsilon)
        assert relative_error(found, reference_shell(scene, event, epsilon)) < BOUND, event


@pytest.mark.parametrize(("width", "height"), [(-190, -189), (189, 190), (190, -190)])
def test_the_smallest_and_largest_boxes(width, height):
    box = 2.0**width, 2.0**height
    for radius in (2.0**-195, min(box) / 4, min(box) * 0.3, largest_radius(*box) * (1 - 1e-6)):
        scene = Scene(*box, radius)
        with mp.workdps(500):
            check_accuracy(scene)


# Definitions ------------------------------------------------------------------------------------


@pytest.mark.parametrize(("width", "height", "radius"), SCENES)
def test_shells_contain_what_random_discs_hit(width, height, radius):
    """Exact binomial tails at 5 sigma, 6e-7: for the 36 numbers of all scenes together 2e-5."""
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
        "right_wall": a - x1 <= epsilon,
        "top_wall": b - y1 <= epsilon,
    }
    prism = (4 * a * b) ** 2
    expected = {"volume": (np.count_nonzero(free), exact.volume(scene) / prism)}
    for event, shell in shells.items():
        size = epsilon * (2 if event in HOPS else 1)
        share = exact.shell_expectation(scene, event, epsilon) * size / prism
        expected[event] = np.count_nonzero(free & shell), share
    for quantity, (hits, share) in expected.items():
        tail = min(bdtr(hits, samples, share), bdtrc(hits - 1, samples, share))
        assert 2 * tail > 5.7e-7, quantity


@pytest.mark.parametrize(("width", "height", "radius"), SCENES)
@pytest.mark.parametrize("event", events.SHELLS)
def test_a_thin_shell_tends_to_its_surface(width, height, radius, event):
    scene = Scene(width, height, radius)
    area = exact.areas(scene)[event]
    thick, thin = (exact.shell_expectation(scene, event, e * radius) for e in (2e-6, 1e-6))
    if area == 0:
        assert thin <= thick
    else:
        # The bias is of first order in ε, with a coefficient that grows as the room shrinks.
        assert thick - area == pytest.approx(2 * (thin - area), rel=1e-2)
        assert thin == pytest.approx(area, rel=1e-2)


def test_a_shell_reaches_just_beyond_a_blocked_hop():
    scene = Scene(1, 1, 0.2501)
    assert exact.areas(scene)["vertical_hop"] == 0
    assert exact.shell_expectation(scene, "vertical_hop", 0.05) > 0
    assert exact.shell_expectation(scene, "vertical_hop", 1e-4) == 0


# Identities -------------------------------------------------------------------------------------


def volume_slope(scene):
    """Return −dV/dr = A_walls + √2 A_coll."""
    areas = exact.areas(scene)
    return areas["any_wall"] + math.sqrt(2) * areas["disc_collision"]


@pytest.mark.parametrize("box", BOXES)
def test_areas_are_the_derivative_of_the_volume(box):
    """Integrated over 80 % of a regime, where a Gauss rule of 60 nodes is good to 2⁻¹²⁰."""
    points, weights = np.polynomial.legendre.leggauss(60)
    edges = sorted({0.0, *(t for t in (box[0] / 4, box[1] / 4) if fits(*box, t))})
    edges.append(largest_radius(*box))
    for low, high in pairwise(edges):
        centre, half = (low + high) / 2, 0.4 * (high - low)
        integral = half * math.fsum(
            weight * volume_slope(Scene(*box, centre + half * point))
            for point, weight in zip(points, weights, strict=True)
        )
        drop = exact.volume(Scene(*box, centre - half)) - exact.volume(Scene(*box, centre + half))
        assert integral == pytest.approx(drop, rel=BOUND)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(hard_scenes())
def test_virial_and_sum_rule(scene):
    """Their terms cancel near the largest radius, so each brings its own error of 1e-13."""
    a, b, s = lengths(scene)
    volume, areas = exact.volume(scene), exact.areas(scene)
    terms = [
        2 * a * areas["right_wall"],
        2 * b * areas["top_wall"],
        -s * areas["disc_collision"] / mp.sqrt(2),
        -4 * mpf(volume),
    ]
    assert abs(sum(terms)) <= BOUND * sum(map(abs, terms))

    times = exact.mean_times(scene)
    right = times["right_wall"] * (1 if scene.horizontal_hops else 2)
    top = times["top_wall"] * (1 if scene.vertical_hops else 2)
    terms = [
        3 * mp.pi / 4 * a / right,
        3 * mp.pi / 4 * b / top,
        -3 * mp.pi / (8 * mp.sqrt(2)) * s / times["disc_collision"],
        mpf(-1),
    ]
    assert abs(sum(terms)) <= BOUND * sum(map(abs, terms))


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
    for event, other in exact.TURNED.items():
        if times[event] is None:
            assert turned_times[other] is None
        else:
            assert turned_times[other] == pytest.approx(times[event], rel=BOUND)


# Regimes ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("box", [PAPER, (1.0, 1.7), (1.0, 1.0)])
def test_nothing_jumps_at_a_threshold_but_the_wall_times(box):
    """From one double to the next but one, numbers move by up to 4 parts in the room left."""
    for threshold, wall in ((box[0] / 4, "top_wall"), (box[1] / 4, "right_wall")):
        below = Scene(*box, math.nextafter(threshold, 0))
        above = Scene(*box, math.nextafter(threshold, 1))
        rel = BOUND + 5 * (above.radius - below.radius) / (below.largest_radius - threshold)
        assert exact.volume(above) == pytest.approx(exact.volume(below), rel=rel)
        before, after = exact.areas(below), exact.areas(above)
        for event in EVENTS:
            assert after[event] == pytest.approx(before[event], rel=rel, abs=1e-30)
        before, after = exact.mean_times(below), exact.mean_times(above)
        walls = {"top_wall", "right_wall"} if box[0] == box[1] else {wall}
        for event in EVENTS[2:]:
            factor = 0.5 if event in walls else 1
            assert after[event] == pytest.approx(factor * before[event], rel=rel)


@pytest.mark.parametrize("radius", [0.25, 0.3, 0.375, 0.38])
def test_a_blocked_hop_has_no_area_and_no_time(radius):
    scene = Scene(*PAPER, radius)
    for hop, open_ in (("vertical_hop", radius < 0.375), ("horizontal_hop", False)):
        assert (exact.areas(scene)[hop] > 0) == (exact.rate(scene, hop) > 0) == open_
        assert (exact.mean_times(scene)[hop] is not None) == open_
    assert exact.areas(scene)["horizontal_hop"] == 0.0


@pytest.mark.parametrize(
    ("radius", "right", "top"), [(0.2, 1, 1), (0.3, 0.5, 1), (0.375, 0.5, 0.5), (0.38, 0.5, 0.5)]
)
def test_rates_average_over_all_components_and_times_over_those_that_meet(radius, right, top):
    scene = Scene(*PAPER, radius)
    share = {"right_wall": right, "top_wall": top}
    for event, time in exact.mean_times(scene).items():
        if time is not None:
            assert time * exact.rate(scene, event) == pytest.approx(share.get(event, 1), rel=1e-15)


def test_exact_is_ready_for_json():
    numbers = exact.exact(Scene(*PAPER, 0.3))
    assert json.loads(json.dumps(numbers)) == numbers
    assert list(numbers) == [
        "regime", "ergodic_components", "largest_radius", "volume", "areas", "mean_times"
    ]  # fmt: skip


def test_results_can_be_changed_without_changing_the_next():
    scene = Scene(*PAPER, 0.3)
    exact.areas(scene)["top_wall"] = 0
    assert exact.areas(scene)["top_wall"] > 0


# Closed forms -----------------------------------------------------------------------------------


@pytest.mark.parametrize("box", BOXES[:6])
@pytest.mark.parametrize("fraction", [0.01, 0.1, 0.3, 0.5, 0.6, 0.7, 0.8])
def test_closed_forms_agree_where_they_do_not_cancel(box, fraction):
    """Terms of order (wh)² leave an absolute error of some roundings of them."""
    w, h = box
    scene = Scene(w, h, fraction * largest_radius(w, h))
    closed, areas = laws.closed_form(scene), exact.areas(scene)
    assert tuple(closed["areas"]) == EVENTS
    assert abs(closed["volume"] - exact.volume(scene)) < 1e-14 * (w * h) ** 2
    for event, area in closed["areas"].items():
        assert abs(area - areas[event]) < 1e-14 * w * h * (w + h)


def test_closed_forms_fail_near_the_largest_radius_as_documented():
    for delta in (1e-3, 1e-4):
        scene = Scene(*PAPER, largest_radius(*PAPER) * (1 - delta))
        error = abs(laws.closed_form(scene)["volume"] / exact.volume(scene) - 1)
        assert 1e-3 < error * delta**4 / 1e-16 < 1e3


# Limits -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("box", [PAPER, (1.0, 1.0), (0.3, 2.0)])
def test_small_discs(box):
    """What the first-order laws leave out is of second order: a hundredth at a tenth of r."""
    w, h = box
    for event in EVENTS:
        errors = [
            exact.mean_times(Scene(w, h, r))[event] / laws.small_radius_time(w, h, event, radius=r)
            - 1
            for r in (1e-3 * min(box), 1e-4 * min(box))
        ]
        assert abs(errors[0]) < 1e-4
        assert errors[1] == pytest.approx(errors[0] / 100, rel=0.05, abs=1e-13)


def test_point_discs():
    w, h = PAPER
    limits = {
        "vertical_hop": 3 * math.pi * h / (4 * math.sqrt(2)),
        "horizontal_hop": 3 * math.pi * w / (4 * math.sqrt(2)),
        "disc_collision": math.inf,
        "right_wall": 3 * math.pi * w / 2,
        "top_wall": 3 * math.pi * h / 2,
        "any_wall": 3 * math.pi * w * h / (8 * (w + h)),
    }
    times = exact.mean_times(Scene(w, h, 1e-12))
    for event, limit in limits.items():
        assert laws.small_radius_time(w, h, event) == pytest.approx(limit, rel=1e-15)
        if event != "disc_collision":
            assert times[event] == pytest.approx(limit, rel=1e-11)
    assert times["disc_collision"] == pytest.approx(3 * w * h / (8 * math.sqrt(2) * 1e-12))


@pytest.mark.parametrize(
    ("box", "event", "order"),
    [
        *(((1.2, 1.0), event, 1) for event in EVENTS),
        *(((1.0, 1.2), event, 1) for event in EVENTS),
        *(((1.0, 1.0), event, 1) for event in EVENTS),
        *(((2.0, 1.0), event, 1) for event in EVENTS),
        *(((1.0, 2.0), event, 1) for event in EVENTS),
        ((3.0, 1.0), "horizontal_hop", 1),
        ((3.0, 1.0), "disc_collision", 2),
        ((3.0, 1.0), "right_wall", 2),
        ((3.0, 1.0), "vertical_hop", 2),
        ((1.0, 3.0), "vertical_hop", 1),
        ((1.0, 3.0), "horizontal_hop", 2),
        ((1.0, 3.0), "any_wall", 2),
    ],
)
def test_laws_at_the_threshold(box, event, order):
    """The error shrinks with the given power of the distance from the threshold."""
    w, h = box
    limit = largest_radius(w, h)
    if event == "vertical_hop":
        limit = min(limit, w / 4) if w < 2 * h else limit
    if event == "horizontal_hop":
        limit = min(limit, h / 4) if h < 2 * w else limit
    errors = []
    for delta in (1e-5, 1e-6):
        scene = Scene(w, h, limit * (1 - delta))
        errors.append(exact.mean_times(scene)[event] / laws.threshold_time(scene, event) - 1)
    assert abs(errors[0]) < 1e-2
    assert errors[1] == pytest.approx(errors[0] / 10**order, rel=0.05, abs=1e-13)


def test_threshold_laws_as_written():
    w, h = PAPER
    scene = Scene(w, h, 0.37)
    law = 0.75 * math.pi * exact.volume(Scene(w, h, w / 4))
    law /= 16 * math.sqrt(2) * (h - w / 2) * (w / 4 - 0.37) ** 2
    assert laws.threshold_time(scene, "vertical_hop") == pytest.approx(law, rel=1e-12)

    largest, delta = largest_radius(w, h), 0.01
    scene = Scene(w, h, largest - delta)
    collision = 0.75 * math.pi * math.sqrt(w * h) * delta / (2 * largest)
    right = 0.75 * math.pi * math.sqrt(2 * w * h) * delta / (w - 2 * largest)
    assert laws.threshold_time(scene, "disc_collision") == pytest.approx(collision, rel=1e-12)
    assert laws.threshold_time(scene, "right_wall") == pytest.approx(right, rel=1e-12)

    delta = 0.01
    hop = 3 * math.pi * delta / (2 * math.sqrt(2))
    double = Scene(2, 1, 0.5 - delta)
    assert laws.threshold_time(double, "vertical_hop") == pytest.approx(hop, rel=1e-12)
    collision = 3 * math.pi / (4 * math.sqrt(2)) * (3 - 2)
    slim = Scene(3, 1, 0.5 * (1 - 1e-9))
    assert laws.threshold_time(slim, "disc_collision") == pytest.approx(collision, rel=1e-8)
    assert laws.threshold_time(slim, "horizontal_hop") is None


# Distributions of the times ---------------------------------------------------------------------


@pytest.mark.parametrize("box", [PAPER, (1.0, 1.7)])
def test_density_at_zero_is_that_of_one_bounce(box):
    """Five sigma: crossings by Gaussian velocities weighted by the flux, and the hop back at once.

    With d uniform the density at 0 is the mean of 1/(2B) times |v1 + v2|, here taken from the share
    of returns within a short time with disc 1 or 2 followed to the wall.
    """
    scene, rng, n, short = Scene(*box, 0.1), np.random.default_rng(1), 1_000_000, 0.02
    for hop, side in (("vertical_hop", scene.range_y), ("horizontal_hop", scene.range_x)):
        velocity = rng.normal(size=(n, 4))
        velocity /= np.linalg.norm(velocity, axis=1)[:, None]
        v1, v2 = velocity[:, 0], velocity[:, 1]
        y = rng.uniform(-side / 2, side / 2, n)
        places = [y + v * short for v in (v1, v2)]
        folded = [np.clip(q, -side / 2, side / 2) * 2 - q for q in places]
        # Back on the sides from which they came: disc 1 beneath disc 2 though it was faster.
        back = (folded[0] - folded[1]) * (v1 - v2) < 0
        weight = np.abs(v1 - v2) / np.abs(v1 - v2).mean()
        share, error = np.mean(weight * back), np.std(weight * back) / math.sqrt(n)
        exact = tails.density_at_zero(scene, hop)
        assert abs(share - exact * short) <= 5 * error
    assert tails.density_at_zero(GOOD, "horizontal_hop") is None


def test_tail_constants_of_blocked_drifts():
    """Their size is measured in test_tails.py; here are the symmetries and what is blocked."""
    assert tails.tail_constant(GOOD, "horizontal_hop") is None
    assert tails.tail_constant(GOOD, "vertical_hop") == 0.0
    assert tails.tail_constant(Scene(*PAPER, 0.38), "disc_collision") == 0.0
    for event in (*HOPS, "disc_collision"):
        scene, turned = Scene(*PAPER, 0.1), Scene(*PAPER[::-1], 0.1)
        other = exact.TURNED.get(event, event)
        constants = tails.tail_constant(scene, event), tails.tail_constant(turned, other)
        assert constants[0] == pytest.approx(constants[1], rel=BOUND)


@pytest.mark.parametrize("bad", ["any_wall", "right_wall", "", None])
def test_only_hops_and_collisions_have_tails(bad):
    with pytest.raises(ValueError, match="event must be one of vertical_hop, "):
        tails.tail_constant(GOOD, bad)
    with pytest.raises(ValueError, match="hop must be one of vertical_hop, "):
        tails.density_at_zero(GOOD, bad)


# Bad input --------------------------------------------------------------------------------------

GOOD = Scene(*PAPER, 0.3)


@pytest.mark.parametrize(
    "function",
    [
        exact.volume,
        exact.areas,
        exact.mean_times,
        exact.exact,
        laws.closed_form,
        lambda scene: exact.rate(scene, "any_wall"),
        lambda scene: laws.threshold_time(scene, "any_wall"),
        lambda scene: exact.shell_expectation(scene, "right_wall", 0.01),
        lambda scene: tails.density_at_zero(scene, "vertical_hop"),
        lambda scene: tails.tail_constant(scene, "disc_collision"),
    ],
)
@pytest.mark.parametrize("bad", [None, 0.3, "paper", (1.5, 1, 0.3), {"radius": 0.3}, [GOOD]])
def test_what_is_no_scene_is_refused(function, bad):
    with pytest.raises(ValueError, match=r"^scene must be a Scene, not "):
        function(bad)


@pytest.mark.parametrize("bad", ["hop", "", None, 3, math.nan, [], GOOD])
def test_an_unknown_event_is_refused(bad):
    for function in (
        lambda: exact.rate(GOOD, bad),
        lambda: laws.threshold_time(GOOD, bad),
        lambda: exact.shell_expectation(GOOD, bad, 0.01),
        lambda: laws.small_radius_time(1.5, 1, bad),
    ):
        with pytest.raises(ValueError, match="event must be one of vertical_hop, "):
            function()


def test_all_walls_together_have_no_shell():
    with pytest.raises(ValueError, match=r"event must be one of .* not 'any_wall'"):
        exact.shell_expectation(GOOD, "any_wall", 0.01)


@pytest.mark.parametrize("bad", [0, -0.01, math.nan, math.inf, "0.01", True, None, 1e-70, 0.31])
def test_a_bad_epsilon_is_refused(bad):
    with pytest.raises(ValueError, match=r"^epsilon must "):
        exact.shell_expectation(GOOD, "disc_collision", bad)


@pytest.mark.parametrize("bad", [0, -1, math.nan, math.inf, "1", True, None])
def test_bad_boxes_and_radii_are_refused(bad):
    with pytest.raises(ValueError, match=r"^width must "):
        laws.small_radius_time(bad, 1, "any_wall")
    with pytest.raises(ValueError, match=r"^height must "):
        laws.small_radius_time(1, bad, "any_wall")
    if bad != 0 or bad is True:
        with pytest.raises(ValueError, match=r"^radius must "):
            laws.small_radius_time(1, 1, "any_wall", radius=bad)
    with pytest.raises(ValueError, match="does not fit"):
        laws.small_radius_time(1, 1, "any_wall", radius=0.3)
