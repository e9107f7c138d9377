"""Starts of every scene: the law of the invariant measure, and that of a flux on its surfaces."""

import math

import numpy as np
import pytest
from effect_scenes import SCENES
from sampling.uniformity import assert_uniform
from scipy.special import betainc

from twodiscs.model.scene import Scene
from twodiscs.sampling.separations import draw_crossing, separation_sampler
from twodiscs.sampling.starts import COMPONENTS, draw_states, start_sampler, state_in, states
from twodiscs.sampling.streams import open_stream

PLAIN = Scene(1.5, 1.0, 0.2)

#: D is 2, 3, 4 and 6 in the scenes of one effect; here it is 5 and 3, 6 and 4 again.
STARTS = {
    **SCENES,
    "upright channel": Scene(1.5, 1.0, 0.2, periodic="y", mass_ratio=0.2),
    "rough channel": Scene(1.5, 1.0, 0.2, periodic="x", moment_of_inertia=1.0),
    "balls between plates": Scene(1.5, 1.0, 0.2, depth=0.8, periodic="xz", mass_ratio=5.0),
    "strong field": Scene(1.5, 1.0, 0.15, field=1.5, mass_ratio=0.5),
}


def on_surface(scene, surface, n):
    """Return n starts on the surface of a hop along the axis ``surface``, 0 or 1."""
    found = np.zeros((COMPONENTS, n))
    sampler = start_sampler(scene, surface=surface)
    draw_states(open_stream(np.uint64(17), 0), sampler, found)
    return found


def parts(scene, starts):
    """Return {axis: (q1, q2, v1, v2)} and the spins (s1, s2) of rough discs or None.

    Coordinates on periodic axes are wrapped into the box.
    """
    found = {"x": starts[[0, 2, 4, 6]], "y": starts[[1, 3, 5, 7]]}
    if scene.depth is not None:
        found["z"] = starts[8:12]
    for axis in scene.periodic:
        side = scene.side(axis)
        found[axis][:2] -= side * np.round(found[axis][:2] / side)
    return found, starts[8:10] if scene.moment_of_inertia else None


# The law ----------------------------------------------------------------------------------------


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

    With a ``normal`` axis the first row is the relative motion along it. Energy and momenta have
    the required values.
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


@pytest.mark.parametrize("scene", [PLAIN, *STARTS.values()], ids=["plain", *STARTS])
def test_starts_have_the_law_of_the_invariant_measure(scene):
    found, spins = parts(scene, states(scene, 50_000, 17))
    places = {axis: both[:2] for axis, both in found.items()}
    assert_same_law(scene, places, rejected(scene, None, 300_000))
    unit = scaled_components(scene, found, spins)
    assert_uniform_on_sphere(unit)
    # The direction of motion does not depend on the place.
    for a in (distance_square(scene, places), found["y"][0]):
        assert np.max(np.abs(np.corrcoef([a, *unit**2])[0, 1:])) <= 5 / math.sqrt(a.size)


#: Their kernels take seconds to compile.
SLOW = ("balls", "rough", "rough channel", "balls between plates")
SURFACES = [
    pytest.param(name, axis, marks=[pytest.mark.slow] if name in SLOW else [])
    for name, scene in STARTS.items()
    for axis in "xy"
    if axis in scene.walled
]


@pytest.mark.parametrize(("name", "hop"), SURFACES)
def test_starts_on_a_surface_have_the_law_of_the_flux(name, hop):
    scene = STARTS[name]
    found, spins = parts(scene, on_surface(scene, "xy".index(hop), 50_000))
    places = {axis: both[:2] for axis, both in found.items()}
    assert np.array_equal(*places[hop])
    assert_same_law(scene, places, rejected(scene, hop, 300_000))
    normal, *others = scaled_components(scene, found, spins, hop)
    rest = np.sqrt(1 - normal**2)
    assert_uniform(rest ** (scene.velocity_components - 1))
    assert abs(np.mean(np.sign(normal))) <= 5 / math.sqrt(normal.size)
    assert_uniform_on_sphere(np.array(others) / rest)


# States -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("scene", [PLAIN, *SCENES.values()], ids=["plain", *SCENES])
def test_states_are_the_first_ones_of_their_stream(scene):
    """A block has the same starts in every process, for any number of them."""
    many = states(scene, 20, 3, 1)
    assert many.shape == (COMPONENTS, 20)
    assert np.array_equal(states(scene, 7, 3, 1), many[:, :7])
    for other in (states(scene, 20, 3, 2), states(scene, 20, 4, 1)):
        assert not np.any(other[:8] == many[:8])


@pytest.mark.parametrize("scene", [PLAIN, *SCENES.values()], ids=["plain", *SCENES])
def test_rows_that_a_scene_has_no_use_for_are_zero(scene):
    used = 8 + 4 * (scene.depth is not None) + 2 * (scene.moment_of_inertia is not None)
    for found in (states(scene, 20, 1), on_surface(scene, 1, 20) if "y" in scene.walled else None):
        if found is not None:
            assert np.all(np.any(found[:used], axis=1))
            assert not np.any(found[used:])


def test_a_start_on_the_surface_of_a_plain_scene_is_a_crossing():
    draw = separation_sampler(PLAIN)
    state = open_stream(np.uint64(17), 0)
    found = on_surface(PLAIN, 1, 5)
    for i in range(5):
        crossing = draw_crossing(state, draw.half_x, draw.half_y, draw.beyond_x)
        assert state_in(found, i) == crossing
