"""Integrals of three discs, against other quadratures.

Without these tests the integrals of three discs could miss a region or a kink.
"""

import math
import random

import numpy as np
import pytest
from mpmath import mp, mpf

from twodiscs.model.many_geometry import largest_known_radius as largest_radius
from twodiscs.model.scene import Scene
from twodiscs.theory import three

BOUND = 1e-12


def boxes(number, seed):
    """Yield sides and radii of all kinds, some of them at the radii where kinks meet."""
    rng = random.Random(seed)
    while number:
        width = 10 ** rng.uniform(0, 1.2)
        largest = largest_radius(3, width, 1.0)
        radius = largest * rng.choice([rng.random(), 1 - 10 ** rng.uniform(-3, -1)])
        if rng.random() < 0.4:
            special = (1 / 4, width / 4, 1 / 6, width / 6, 1 / (2 + math.sqrt(3)), width / 3)
            radius = rng.choice(special) * (1 + rng.choice([-1, 0, 1]) * 10 ** rng.uniform(-12, -2))
        if 1e-3 < radius < largest * (1 - 1e-3):
            number -= 1
            yield width, 1.0, radius


def test_the_box_on_its_side_has_the_same_numbers():
    """The integrals, their regions and their kinks are others then, the results the same."""
    for width, height, radius in boxes(30, 1):
        a, b, sigma = width - 2 * radius, height - 2 * radius, 2 * radius
        volume, by_a, by_b, contact, _ = three.integrals(a, b, sigma)
        turned = three.integrals(b, a, sigma)
        assert turned[:4] == pytest.approx((volume, by_b, by_a, contact), rel=BOUND)
        euler = a * by_a + b * by_b - sigma * contact
        assert euler == pytest.approx(6 * volume, abs=BOUND * (volume + sigma * contact))


def test_triangles_that_begin_to_reach_around_a_torus_are_small():
    """At three diameters, where arguments of arc cosines round to more than 1."""
    for side in np.linspace(1, 2, 40):
        below, above = (
            three.torus_derivatives(Scene(side, side, side / 6 * share, discs=3, periodic="xy"))
            for share in (1 - 1e-12, 1 + 1e-12)
        )
        assert above[:4] == pytest.approx(below[:4], abs=1e-9)


@pytest.mark.parametrize(
    ("width", "height", "radius"),
    [(1.5, 1.0, 0.16), (1.5, 1.0, 0.249), (1.0, 1.02, 0.2499), (0.5, 2.0, 0.12), (9.0, 1.0, 0.2)],
)
def test_three_discs_on_a_torus(width, height, radius):
    """Points at random: the third side of a triangle may go around the torus. Five errors.

    V scales as a length to the sixth power, and its slope is that of differences.
    """
    found = three.torus_derivatives(Scene(width, height, radius, discs=3, periodic="xy"))
    sides = np.array([width, height])
    at = np.random.default_rng(5).random((3, 400_000, 2)) * sides
    apart = np.array([at[0] - at[1], at[1] - at[2], at[2] - at[0]])
    apart -= sides * np.round(apart / sides)
    share = np.mean(np.all(np.sum(apart**2, axis=2) >= 4 * radius**2, axis=0))
    due = math.exp(found.log_volume) / (width * height) ** 3
    assert abs(share - due) < 5 * math.sqrt(due * (1 - due) / at.shape[1])
    if max(radius / width, radius / height) < 1 / 6:
        beta = math.pi * 4 * radius**2 / (width * height)
        square = (1 - 3 * math.sqrt(3) / 4 / math.pi) * beta**2
        assert due == pytest.approx(1 - 3 * beta + 3 * beta**2 - square, rel=1e-14)
    step, logs = 1e-5 * radius, []
    for size in (radius - step, radius - 2 * step):
        scene = Scene(width, height, size, discs=3, periodic="xy")
        logs.append(three.torus_derivatives(scene).log_volume)
    slope = (4 * logs[0] - logs[1] - 3 * found.log_volume) / (-4 * step)
    assert -slope == pytest.approx(found.per_contact, rel=1e-6)


@pytest.mark.parametrize("radius", [0.05, 0.15, 0.2, 0.24, 0.28, 0.3])
def test_derivatives_are_those_of_the_volume(radius):
    """Central differences of the fourth order: their error is (step)⁴."""
    at = np.array([1.5 - 2 * radius, 1.0 - 2 * radius, 2 * radius])
    found = three.integrals(*at)
    room = largest_radius(3, 1.5, 1.0) - radius
    for k, derivative in enumerate((found[1], found[2], -found[3])):
        step = 2e-3 * min(room, radius) * np.eye(3)[k]
        values = [three.integrals(*(at + n * step))[0] for n in (-2, -1, 1, 2)]
        slope = (values[0] - 8 * values[1] + 8 * values[2] - values[3]) / (12 * step[k])
        assert slope == pytest.approx(derivative, rel=1e-8)


def hops_in_y(a, b, sigma):
    """Return Σ ∫ δ(y_i − y_j) by its own formula: two discs level, the third one a gap away."""
    with mp.workdps(20):
        a, b, sigma = mpf(a), mpf(b), mpf(sigma)

        def d(gap):
            return mp.sqrt(max(sigma**2 - gap**2, 0))

        def spans(gap):
            c = d(gap)
            # The third disc is beside the other two, or between them.
            beside = max(a - sigma - c, 0) ** 3 / 6
            middle = sigma
            if 2 * c >= sigma:
                return 2 * beside + max(a - 2 * c, 0) ** 3 / 6
            m = max(a - middle, 0)
            return 2 * beside + (a - 2 * c) * m**2 / 2 - m**3 / 3

        cuts = {mpf(0), b, sigma, sigma * mp.sqrt(3) / 2}
        if abs(a - sigma) < sigma:
            cuts.add(mp.sqrt(sigma**2 - (a - sigma) ** 2))
        if a < 2 * sigma:
            cuts.add(mp.sqrt(sigma**2 - a**2 / 4))
        cuts = sorted(cut for cut in cuts if cut <= b)
        # Three pairs are level, either of the two on the left, the third above or below.
        return 12 * mp.quad(lambda gap: (b - gap) * spans(gap), cuts)


@pytest.mark.parametrize(
    ("width", "radius"), [(1.5, 0.1), (1.5, 0.2), (1.5, 0.26), (1.0, 0.2), (3.0, 0.3), (4.0, 0.05)]
)
def test_hops_agree_with_an_integral_of_one_dimension(width, radius):
    a, b, sigma = width - 2 * radius, 1 - 2 * radius, 2 * radius
    for sides in ((a, b), (b, a)):
        direct = hops_in_y(*sides[::-1], sigma)
        found = three.integrals(*sides, sigma)[4]
        assert found == pytest.approx(float(direct), rel=BOUND, abs=1e-300)
