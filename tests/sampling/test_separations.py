"""The law of the draws, not only that they run."""

import math
from fractions import Fraction
from itertools import pairwise

import mpmath
import numpy as np
import pytest
from effect_scenes import SCENES
from scipy.special import betainc, chdtrc, kolmogorov

from twodiscs.model.box import largest_radius
from twodiscs.model.scene import Scene
from twodiscs.sampling import prism, separations
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.streams import largest_of, open_stream, second_largest_of, uniform

#: Five sigma, two-sided: the rate of false alarms of each comparison here.
FALSE_ALARM = 5.7e-7

JAM = largest_radius(1.5, 1.0)

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
        found[0, i], found[1, i], found[2, i] = separations.draw_separation(state, draw)
    return found


@compiled
def configurations(seed, draw, side_x, side_y, n):
    state = open_stream(seed, 0)
    found = np.empty((4, n))
    for i in range(n):
        found[0, i], found[1, i], found[2, i], found[3, i] = separations.draw_configuration(
            state, draw, side_x, side_y
        )
    return found


@compiled
def velocities(seed, n):
    state = open_stream(seed, 0)
    found = np.empty((4, n))
    for i in range(n):
        found[0, i], found[1, i], found[2, i], found[3, i] = separations.draw_velocity(state)
    return found


@compiled
def crossings(seed, draw, n):
    state = open_stream(seed, 0)
    found = np.empty((8, n))
    for i in range(n):
        (
            found[0, i], found[1, i], found[2, i], found[3, i],
            found[4, i], found[5, i], found[6, i], found[7, i],
        ) = separations.draw_crossing(state, draw.half_x, draw.half_y, draw.beyond_x)  # fmt: skip
    return found


@compiled
def order_statistics(seed, n, many):
    state = open_stream(seed, 0)
    found = np.empty((3, many))
    for i in range(many):
        found[0, i] = uniform(state)
        found[1, i] = largest_of(state, n)
        found[2, i] = second_largest_of(state, n)
    return found


def assert_uniform(values):
    """Kolmogorov–Smirnov: ``values`` are uniform on [0, 1]."""
    values = np.sort(values)
    n = values.size
    steps = np.arange(n + 1) / n
    distance = max(np.max(steps[1:] - values), np.max(values - steps[:-1]))
    assert kolmogorov(math.sqrt(n) * distance) > FALSE_ALARM, distance


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
            masses.append(mpmath.quad(density, points, maxdegree=4))
        total = sum(masses)
        return np.array([float(e) for e in edges]), np.array([float(m / total) for m in masses])


@pytest.mark.parametrize(("width", "height", "radius"), CASES)
def test_separations_have_the_invariant_law(width, height, radius):
    scene = Scene(width, height, radius)
    draw = separations.draw_constants(scene)
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
    share = float(accepted) / separations.draw_constants(scene).mass
    assert 0.25 <= share <= 1.0 + 1e-9


@pytest.mark.parametrize("radius", [0.2, 0.3, 0.38, JAM * (1 - 1e-9)])
@pytest.mark.parametrize("sides", [(0, 0), (1, 0), (-1, 1), (1, -1)])
def test_components_are_chosen(radius, sides):
    scene = Scene(1.5, 1.0, radius)
    n = 20_000
    x1, y1, x2, y2 = configurations(np.uint64(5), separations.draw_constants(scene), *sides, n)
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
    drawn = configurations(np.uint64(8), separations.draw_constants(scene), 0, 0, n)
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
    v = velocities(np.uint64(2), 100_000)
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
    draw = separations.draw_constants(scene)
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


def test_order_statistics():
    for n in (2, 3, 6):
        single, largest, second = order_statistics(np.uint64(n), n, 100_000)
        assert_uniform(single)
        assert_uniform(largest**n)
        assert_uniform(n * second ** (n - 1) - (n - 1) * second**n)


def test_streams_differ_by_seed_and_by_block():
    states = [tuple(open_stream(np.uint64(s), b)) for s in range(40) for b in range(40)]
    assert len(set(states)) == len(states)
    bits = np.array(states, dtype=np.uint64).view(np.uint8)
    ones = np.unpackbits(bits).mean()
    assert abs(ones - 0.5) <= 5 / (2 * math.sqrt(bits.size * 8))


# Scenes with effects ----------------------------------------------------------------------------

#: D is 2, 3, 4 and 6 in the scenes of one effect; here it is 5 and 3, 6 and 4 again.
STARTS = {
    **SCENES,
    "upright channel": Scene(1.5, 1.0, 0.2, periodic="y", mass_ratio=0.2),
    "rough channel": Scene(1.5, 1.0, 0.2, periodic="x", moment_of_inertia=1.0),
    "balls between plates": Scene(1.5, 1.0, 0.2, depth=0.8, periodic="xz", mass_ratio=5.0),
    "strong field": Scene(1.5, 1.0, 0.15, field=1.5, mass_ratio=0.5),
}


@compiled
def draw_starts(seed, prism, surface, starts):
    state = open_stream(seed, 0)
    for i in range(starts.shape[1]):
        starts.fill_start(state, prism, surface, starts, i)


def starts_of(scene, surface, n):
    """Return n starts: {axis: (q1, q2, v1, v2)} and the spins (s1, s2) of rough discs or None.

    Coordinates on periodic axes are wrapped into the box.
    """
    rows = np.empty((12, n))
    draw_starts(np.uint64(17), prism.prism_of(scene), surface, rows)
    found = {"x": rows[[0, 2, 4, 6]], "y": rows[[1, 3, 5, 7]]}
    if scene.depth is not None:
        found["z"] = rows[8:12]
    for axis in scene.periodic:
        side = scene.side(axis)
        found[axis][:2] -= side * np.round(found[axis][:2] / side)
    return found, rows[8:10] if scene.moment_of_inertia else None


def energy_left(scene, y1, y2):
    """Return twice the kinetic energy at total energy 1/2; heights count from the bottom."""
    (r1, r2), (m1, m2) = scene.radii, scene.masses
    half = scene.height / 2
    return 1 - 2 * scene.field * (m1 * (y1 + half - r1) + m2 * (y2 + half - r2))


def distance_square(scene, places):
    """Return |Δ|² to the nearest image; ``places`` are {axis: (q1, q2)}."""
    total = 0.0
    for axis, (q1, q2) in places.items():
        d = np.abs(q1 - q2)
        if axis in scene.periodic:
            d = np.minimum(d, scene.side(axis) - d)
        total = total + d**2
    return total


def rejected(scene, surface, n):
    """Return places {axis: (q1, q2)} by plain rejection: ``n`` proposals, the weight by numpy."""
    rng = np.random.default_rng(17)
    places, power = {}, scene.velocity_components / 2 - 1
    for axis in scene.axes:
        half = [
            scene.side(axis) / 2 - (0 if axis in scene.periodic else radius)
            for radius in scene.radii
        ]
        places[axis] = np.array([rng.uniform(-h, h, n) for h in half])
        if axis == surface:
            places[axis][:] = rng.uniform(-min(half), min(half), n)
            power += 1 / 2
    weight = np.maximum(energy_left(scene, *places["y"]), 0.0) ** power
    kept = distance_square(scene, places) >= scene.contact_distance**2
    kept &= rng.random(n) < weight
    return {axis: both[:, kept] for axis, both in places.items()}


def assert_same_law(scene, drawn, plain):
    """Means of coordinates, squares and products agree within five standard errors."""

    def functions(places):
        q = [row for axis in scene.axes for row in places[axis]]
        yield from q
        yield from (a * b for i, a in enumerate(q) for b in q[: i + 1])
        yield distance_square(scene, places)
        yield (q[0] * q[-1]) ** 2

    for a, b in zip(functions(drawn), functions(plain), strict=True):
        error = math.sqrt(a.var() / a.size + b.var() / b.size)
        assert abs(a.mean() - b.mean()) <= 5 * error


def scaled_components(scene, found, spins, normal=None):
    """Return unit vectors of D components, from velocities scaled by √mass, a row each.

    With a ``normal`` axis the first row is the relative motion along it. Energy and momenta are
    what they should be.
    """
    m1, m2 = scene.masses
    reduced, common, rows = math.sqrt(m1 * m2 / (m1 + m2)), [], []
    for axis in (normal, *(a for a in scene.axes if a != normal)) if normal else scene.axes:
        v1, v2 = found[axis][2:]
        if axis in scene.conserved:
            assert np.max(np.abs(m1 * v1 + m2 * v2)) < 8 * 2.0**-52 * math.sqrt(max(m1, m2))
            rows.append(reduced * (v1 - v2))
        elif axis == normal:
            rows.append(reduced * (v1 - v2))
            common.append((m1 * v1 + m2 * v2) / math.sqrt(m1 + m2))
        else:
            rows += [math.sqrt(m1) * v1, math.sqrt(m2) * v2]
    rows += common
    if spins is not None:
        rows += [math.sqrt(scene.moment_of_inertia * m1) * spins[0]]
        rows += [math.sqrt(scene.moment_of_inertia * m2) * spins[1]]
    assert len(rows) == scene.velocity_components
    square, left = np.sum(np.square(rows), axis=0), energy_left(scene, *found["y"][:2])
    assert np.max(np.abs(square - left)) < 16 * 2.0**-52
    return np.array(rows) / np.sqrt(square)


def assert_uniform_on_sphere(unit):
    """Every component squared has a beta law; second and fourth mixed moments are exact."""
    d, n = unit.shape
    for i, a in enumerate(unit):
        assert abs(np.mean(np.sign(a))) <= 5 / math.sqrt(n)
        assert_uniform(betainc(1 / 2, (d - 1) / 2, a**2))
        for b in unit[:i]:
            assert abs(np.mean(a * b)) <= 5 * np.std(a * b) / math.sqrt(n)
            product = a**2 * b**2
            assert abs(np.mean(product) - 1 / (d * (d + 2))) <= 5 * np.std(product) / math.sqrt(n)


@pytest.mark.parametrize("name", STARTS)
def test_starts_have_the_law_of_the_invariant_measure(name):
    scene = STARTS[name]
    found, spins = starts_of(scene, None, 50_000)
    places = {axis: both[:2] for axis, both in found.items()}
    assert_same_law(scene, places, rejected(scene, None, 300_000))
    unit = scaled_components(scene, found, spins)
    assert_uniform_on_sphere(unit)
    # The direction of motion does not depend on the place.
    for a in (distance_square(scene, places), found["y"][0]):
        assert np.max(np.abs(np.corrcoef([a, *unit**2])[0, 1:])) <= 5 / math.sqrt(a.size)


@pytest.mark.parametrize(
    ("name", "hop"), [(n, axis) for n, s in STARTS.items() for axis in "xy" if axis in s.walled]
)
def test_starts_on_a_surface_have_the_law_of_the_flux(name, hop):
    scene = STARTS[name]
    found, spins = starts_of(scene, "xy".index(hop), 50_000)
    places = {axis: both[:2] for axis, both in found.items()}
    assert np.array_equal(*places[hop])
    assert_same_law(scene, places, rejected(scene, hop, 300_000))
    normal, *others = scaled_components(scene, found, spins, hop)
    rest = np.sqrt(1 - normal**2)
    assert_uniform(rest ** (scene.velocity_components - 1))
    assert abs(np.mean(np.sign(normal))) <= 5 / math.sqrt(normal.size)
    assert_uniform_on_sphere(np.array(others) / rest)
