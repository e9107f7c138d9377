"""Draws of plain scenes have the law of the invariant measure; they do not only run."""

import math
from fractions import Fraction
from itertools import pairwise

import mpmath
import numpy as np
import pytest
from sampling.uniformity import FALSE_ALARM, assert_uniform
from scipy.special import chdtrc

from twodiscs.model.box import Box
from twodiscs.model.scene import Scene
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.separations import draw_crossing, draw_separation, separation_sampler
from twodiscs.sampling.starts import states
from twodiscs.sampling.streams import open_stream

JAM = Box(1.5, 1.0).largest_radius

#: Boxes and radii in every regime, next to the thresholds and where the discs hardly fit.
CASES = [
    (1.5, 1.0, r)
    for r in (1e-9, 0.01, 0.2, 0.25, 0.25 + 1e-12, 0.3, 0.374999, 0.375001, 0.38,
              JAM * (1 - 1e-4), JAM * (1 - 1e-9))
] + [
    (1.0, 1.0, 0.2499), (1.0, 1.0, 0.25), (1.0, 1.0, 0.2501), (1.0, 1.0, 0.2928932),
    (2.0, 1.0, 0.49), (2.0, 1.0, 0.5 * (1 - 1e-9)), (1.0, 2.0, 0.3), (1.0, 1.5, 0.38),
    (3.0, 1.0, 0.4), (3.0, 1.0, 0.499999), (1.0, 3.0, 0.4), (1e6, 1.0, 0.3), (1e-6, 1.0, 2e-7),
]  # fmt: skip


@compiled
def separations(seed, draw, n):
    state = open_stream(seed, 0)
    found = np.empty((3, n))
    for i in range(n):
        found[0, i], found[1, i], found[2, i] = draw_separation(state, draw)
    return found


@compiled
def crossings(seed, draw, n):
    state = open_stream(seed, 0)
    found = np.empty((8, n))
    for i in range(n):
        (
            found[0, i], found[1, i], found[2, i], found[3, i],
            found[4, i], found[5, i], found[6, i], found[7, i],
        ) = draw_crossing(state, draw.half_x, draw.half_y, draw.beyond_x)  # fmt: skip
    return found


def slack_density(scene):
    """Return (A, B, σ, upper end, g), g(p) ∝ the density of p = A − |x1 − x2|, for mpmath."""
    w, h, r = (Fraction(x) for x in (scene.width, scene.height, scene.radius))

    def exact(q):
        return mpmath.mpf(q.numerator) / q.denominator

    a, b, sigma = exact(w - 2 * r), exact(h - 2 * r), exact(2 * r)
    start = mpmath.sqrt(sigma**2 - b**2) if sigma > b else mpmath.mpf(0)

    def density(slack):
        u = a - slack
        k = mpmath.sqrt(sigma**2 - u**2) if u < sigma else mpmath.mpf(0)
        return slack * max(b - k, 0) ** 2

    return a, b, sigma, a - start, density


def slack_law(scene):
    """Return edges (65) and cumulative probabilities of the slack at them, by quadrature."""
    with mpmath.workdps(40):
        a, _, sigma, top, density = slack_density(scene)
        edges = [top * i / 64 for i in range(65)]
        kinks = [a - sigma] if a > sigma else []
        masses = []
        for low, high in pairwise(edges):
            inside = [kink for kink in kinks if low < kink < high]
            points = [low, *inside, high]
            # To 2e-11 of the scatter of a single draw.
            masses.append(mpmath.quad(density, points, maxdegree=2))
        total = sum(masses)
        return np.array([float(e) for e in edges]), np.array([float(m / total) for m in masses])


@pytest.mark.parametrize(("width", "height", "radius"), CASES)
def test_separations_have_the_invariant_law(width, height, radius):
    scene = Scene(width, height, radius)
    draw = separation_sampler(scene)
    n = 40_000
    slack_x, slack_y, u = separations(np.uint64(11), draw, n)
    assert np.all((slack_x >= 0) & (slack_y >= 0))
    edges, masses = slack_law(scene)
    counts, _ = np.histogram(slack_x, bins=edges)
    assert counts.sum() == n
    keep = n * masses >= 10
    expected = np.append(n * masses[keep], n * masses[~keep].sum())
    seen = np.append(counts[keep], counts[~keep].sum())
    if expected[-1] < 10:
        expected = np.append(expected[:-2], expected[-2:].sum())
        seen = np.append(seen[:-2], seen[-2:].sum())
    chi_square = np.sum((seen - expected) ** 2 / expected)
    assert chdtrc(expected.size - 1, chi_square) > FALSE_ALARM

    # Given u, the slack in y is (B − k)√U.
    with mpmath.workdps(40):
        a, b, sigma, _, _ = slack_density(scene)
        rooms = []
        for p in slack_x[:2000]:
            u = a - mpmath.mpf(float(p))
            k = mpmath.sqrt(sigma**2 - u**2) if u < sigma else mpmath.mpf(0)
            rooms.append(float(b - k))
    assert_uniform((slack_y[:2000] / np.array(rooms)) ** 2)


@pytest.mark.parametrize(("width", "height", "radius"), CASES)
def test_a_quarter_of_the_proposals_is_accepted_at_least(width, height, radius):
    scene = Scene(width, height, radius)
    with mpmath.workdps(40):
        a, _, sigma, top, density = slack_density(scene)
        kinks = [a - sigma] if a > sigma else []
        points = [0, *kinks, *(top - (top - p) / 8**3 for p in kinks), top]
        accepted = mpmath.quad(density, sorted(points), maxdegree=7)
    share = float(accepted) / separation_sampler(scene).mass
    assert 0.25 <= share <= 1.0 + 1e-9


@pytest.mark.parametrize("radius", [0.2, 0.3, 0.38, JAM * (1 - 1e-9)])
@pytest.mark.parametrize("sides", [(0, 0), (1, 0), (-1, 1), (1, -1)])
def test_components_are_chosen(radius, sides):
    scene = Scene(1.5, 1.0, radius)
    n = 20_000
    x1, y1, x2, y2 = states(scene, n, 5, order=sides)[:4]
    for side, difference in zip(sides, (x1 - x2, y1 - y2), strict=True):
        above = np.count_nonzero(difference > 0)
        if side:
            assert above == (n if side > 0 else 0)
        else:
            assert abs(above - n / 2) <= 5 * math.sqrt(n) / 2
    half_x, half_y = scene.range_x / 2, scene.range_y / 2
    assert np.all(np.abs([x1, x2]) <= half_x)
    assert np.all(np.abs([y1, y2]) <= half_y)
    gap = np.hypot(x1 - x2, y1 - y2) - scene.contact_distance
    assert gap.min() >= -1e-15


@pytest.mark.parametrize("radius", [0.05, 0.2, 0.24])
def test_configurations_are_those_of_rejection(radius):
    """Single coordinates and their mutual moments against plain rejection by numpy."""
    scene = Scene(1.5, 1.0, radius)
    n = 200_000
    drawn = states(scene, n, 8)[:4]
    rng = np.random.default_rng(8)
    half = np.array([scene.range_x, scene.range_y, scene.range_x, scene.range_y]) / 2
    plain = rng.uniform(-half, half, (20 * n, 4)).T
    far = (plain[0] - plain[2]) ** 2 + (plain[1] - plain[3]) ** 2 >= scene.contact_distance**2
    plain = plain[:, far][:, :n]
    for f in (
        lambda x1, y1, x2, y2: x1,
        lambda x1, y1, x2, y2: y2,
        lambda x1, y1, x2, y2: x1**2,
        lambda x1, y1, x2, y2: y1**2,
        lambda x1, y1, x2, y2: x1 * x2,
        lambda x1, y1, x2, y2: y1 * y2,
        lambda x1, y1, x2, y2: x1 * y1 * x2 * y2,
        lambda x1, y1, x2, y2: (x1 * y2) ** 2,
    ):
        a, b = f(*drawn), f(*plain)
        error = math.sqrt(a.var() / a.size + b.var() / b.size)
        assert abs(a.mean() - b.mean()) <= 5 * error


def test_velocities_are_uniform_on_the_sphere():
    """Each component n has density ∝ √(1 − n²); squares of pairs are uniform; no correlations."""
    v = states(Scene(1.5, 1.0, 0.2), 100_000, 2)[4:8]
    assert np.max(np.abs(np.sum(v**2, axis=0) - 1)) < 8 * 2.0**-52
    for n in v:
        assert_uniform((np.arcsin(n) + n * np.sqrt(1 - n**2)) / math.pi + 0.5)
    assert_uniform(v[0] ** 2 + v[1] ** 2)
    assert_uniform(v[1] ** 2 + v[2] ** 2)
    for i in range(4):
        for j in range(i):
            assert abs(np.mean(v[i] * v[j])) <= 5 / math.sqrt(24 * v.shape[1])


@pytest.mark.parametrize("radius", [0.1, 0.24, 0.3])
def test_crossings_have_the_law_of_the_flux(radius):
    scene = Scene(1.5, 1.0, radius)
    draw = separation_sampler(scene)
    x1, y1, x2, y2, u1, v1, u2, v2 = crossings(np.uint64(4), draw, 100_000)
    assert np.array_equal(y1, y2)
    assert_uniform(y1 / scene.range_y + 0.5)
    separation = np.abs(x1 - x2)
    assert separation.min() >= scene.contact_distance * (1 - 1e-15)
    slack = scene.range_x - separation
    assert_uniform((slack / (scene.range_x - scene.contact_distance)) ** 2)
    assert_uniform(((x1 + x2) / slack + 1) / 2)
    speed = u1**2 + v1**2 + u2**2 + v2**2
    assert np.max(np.abs(speed - 1)) < 16 * 2.0**-52
    normal = (v1 - v2) / math.sqrt(2)
    rest = np.sqrt(1 - normal**2)
    assert_uniform(rest**3)
    assert abs(np.mean(np.sign(normal))) <= 5 / math.sqrt(normal.size)
    # The other three components are uniform on their sphere: each is uniform (Archimedes).
    for component in (u1, u2, (v1 + v2) / math.sqrt(2)):
        assert_uniform((component / rest + 1) / 2)
