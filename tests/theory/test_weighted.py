"""Volumes and areas with effects, against a reference from their definition.

Without these tests volumes and areas of scenes with effects could miss a kink, a mass or a power of
the energy.

The reference integrates over the signed separations with 40 digits, from the definition of each
density: the range of the common motion and the energy left at its ends. It does not use slacks.
Dynamics tests the meaning of the areas.
"""

import math
import os
from itertools import pairwise, product

import numpy as np
import pytest
from commands import python
from effect_scenes import exchanged, in_unit
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from marks import slow
from mpmath import mp, mpf
from theory.antiderivatives import TURNED, relative_error

from twodiscs.model.events import DECLARED_EVENTS, EVENT_AXES, EVENTS, HOPS, SHELL_EVENTS, WALLS
from twodiscs.model.scene import Scene
from twodiscs.theory import exact, flux, weighted
from twodiscs.theory.clusters import corner_variance
from twodiscs_paper.studies.passages.near import passing_rate

BOUND, DIGITS = 1e-13, 40


def numbers(scene):
    """Return {name: volume or area} of a scene."""
    return {"volume": weighted.volume(scene)} | weighted.areas(scene)


def assert_close(found, expected, bound=BOUND):
    """Check that two dicts of numbers agree."""
    errors = {name: relative_error(found[name], value) for name, value in expected.items()}
    assert max(errors.values()) < bound, errors


# The reference ----------------------------------------------------------------------------------


class Axis:
    """Signed separation s = q1 − q2 along an axis; disc ``held`` (0 or 1) stays at one end."""

    def __init__(self, scene, axis, power, held=None, high=False):
        self.side, self.power = mpf(scene.side(axis)), power
        self.periodic, self.held = axis in scene.periodic, held is not None
        field = 2 * mpf(scene.field) if axis == "y" else mpf(0)
        self.slope = [field * mpf(m) for m in scene.masses]
        self.radii = [mpf(r) for r in scene.radii]
        self.low, self.high = list(self.radii), [self.side - r for r in self.radii]
        if self.held:
            self.low[held] = self.high[held] = (self.high if high else self.low)[held]

    def energy(self, q1, q2):
        """Return 1 − U/E."""
        heights = q1 - self.radii[0], q2 - self.radii[1]
        return 1 - self.slope[0] * heights[0] - self.slope[1] * heights[1]

    def density(self, s):
        """Return ∫ (1 − U/E)₊^p dq1 at q2 = q1 − s."""
        if self.periodic:
            return self.side if 2 * abs(s) <= self.side else mpf(0)
        low, high = max(self.low[0], self.low[1] + s), min(self.high[0], self.high[1] + s)
        bottom = self.energy(low, low - s)
        if low > high or bottom <= 0:
            return mpf(0)
        if self.held:
            return bottom**self.power
        if not any(self.slope):
            return high - low
        n, top = self.power + 1, max(self.energy(high, high - s), mpf(0))
        return (bottom**n - top**n) / (n * sum(self.slope))

    def kinks(self):
        """Return where the density may not be analytic, its ends included."""
        if self.periodic:
            return [-self.side / 2, mpf(0), self.side / 2]
        (l1, l2), (h1, h2) = self.low, self.high
        found = {mpf(0), l1 - h2, h1 - l2, l1 - l2, h1 - h2}
        if any(self.slope):
            # No energy is left with one disc at an end and the other one this much away.
            for own, sign in ((0, 1), (1, -1)):
                other = 1 - own
                for q in (self.low[own], self.high[own]):
                    left = 1 - self.slope[own] * (q - self.radii[own])
                    found.add(sign * (q - self.radii[other] - left / self.slope[other]))
        return sorted(s for s in found if l1 - h2 <= s <= h1 - l2)

    def tail(self, k):
        """Return ∫ over |s| ≥ k of a density that is linear in pieces, by the midpoint rule."""
        total = mpf(0)
        for a, b in pairwise(self.kinks()):
            a, b = (max(a, k), b) if a >= 0 else (a, min(b, -k))
            total += max(b - a, 0) * self.density((a + b) / 2)
        return total


def integral(function, points):
    """Return the integral over all pieces between sorted ``points``."""
    points = sorted(set(points))
    return sum(mp.quad(function, [a, b]) for a, b in pairwise(points) if b - a > mpf(10) ** -35)


def beyond(axes, square):
    """Return the integral of the densities of two axes over s² + s'² ≥ square, or of one axis."""
    first, kinks = axes[0], axes[0].kinks()
    touches = [mpf(0)] + ([k * k for k in axes[1].kinks()] if len(axes) > 1 else [])
    roots = [mp.sqrt(square - c) for c in touches if c <= square]
    points = [s for s in (*kinks, *roots, *(-k for k in roots)) if kinks[0] <= s <= kinks[-1]]

    def line(s):
        left = square - s * s
        if len(axes) == 1:
            return first.density(s) if left <= 0 else mpf(0)
        return first.density(s) * axes[1].tail(mp.sqrt(max(left, 0)))

    return integral(line, points)


def ring_separation(axes, square):
    """Return the integral of the densities of two axes along the circle."""
    r = mp.sqrt(square)
    points = [k * mp.pi / 2 for k in range(5)]
    for kinks, turn in ((axes[0].kinks(), mpf(0)), (axes[1].kinks(), mp.pi / 2)):
        for k in kinks:
            if abs(k) <= r:
                points += [(turn + sign * mp.acos(k / r)) % (2 * mp.pi) for sign in (1, -1)]
    one, two = axes
    return integral(lambda a: r * one.density(r * mp.cos(a)) * two.density(r * mp.sin(a)), points)


def reference(scene):
    """Return {"volume": V, event: A, …} of a scene in the plane."""
    contact = scene.exact_contact
    square = (mpf(contact.numerator) / contact.denominator) ** 2
    m1, m2 = (mpf(m) for m in scene.masses)
    relative, components = mp.sqrt(1 / m1 + 1 / m2), mpf(scene.velocity_components)

    def axes(power, names="yx", **held):
        return [Axis(scene, name, power, *held.get(name, ())) for name in names]

    power = (components - 1) / 2
    found = {"volume": beyond(axes(components / 2 - 1), square)} | dict.fromkeys(EVENTS, mpf(0))
    for axis, disc, high in product(scene.walled, (0, 1), (False, True)):
        area = beyond(axes(power, **{axis: (disc, high)}), square) / mp.sqrt((m1, m2)[disc])
        found["any_wall"] += area
        at = (axis, 1 if high else -1)
        for wall in WALLS if disc == 0 else ():
            if (DECLARED_EVENTS[wall].axis, DECLARED_EVENTS[wall].side) == at:
                found[wall] = area
    for hop in set(HOPS) & set(scene.events):
        level, other = axes(power, EVENT_AXES[hop] + {"x": "y", "y": "x"}[EVENT_AXES[hop]])
        found[hop] = relative * level.density(mpf(0)) * beyond([other], square)
    found["disc_collision"] = relative * ring_separation(axes(power), square)
    return found


SCENES = [
    Scene(1.5, 1.0, 0.2, radius_ratio=0.3, mass_ratio=3.0),
    Scene(1.5, 1.0, 0.33, radius_ratio=1.3),
    Scene(1.5, 1.0, 0.2, periodic="xy", radius_ratio=0.7),
    Scene(0.8, 1.0, 0.27, periodic="x", mass_ratio=0.3),
    Scene(1.5, 1.0, 0.2, field=0.3),
    Scene(1.5, 1.0, 0.37, field=4.0),
    Scene(1.5, 1.0, 0.2, field=20.0),
    Scene(1.5, 1.0, 0.2, field=2.3, radius_ratio=0.7, mass_ratio=2.0),
    Scene(1.5, 1.0, 0.25, field=1.3, periodic="x", radius_ratio=1.3, mass_ratio=0.3),
    Scene(1.5, 1.0, 0.2, field=1.0, moment_of_inertia=0.5, radius_ratio=1.5),
    # Just above and below the radius where the nearest image is too near.
    Scene(1.3, 1.0, 0.325 * (1 + 1e-12), periodic="x"),
    Scene(1.3, 1.0, 0.325 * (1 - 1e-12), periodic="x", field=0.4),
    # Beside thresholds, at 1 − 1e-6 of the largest radius, and with next to no energy to spare.
    Scene(2.0, 1.5, 0.5 * (1 - 1e-9) / 1.5, radius_ratio=2.0, field=0.5),
    Scene(2.0, 1.5, 0.5 * (1 + 1e-9), field=0.3, periodic="x"),
    Scene(1.5, 1.0, (1 - 1e-6) * Scene(1.5, 1.0, 0.1, field=0.1).largest_radius, field=0.1),
    Scene(1.0, 1.5, (1 - 1e-6) * Scene(1.0, 1.5, 0.1, mass_ratio=2).largest_radius, mass_ratio=2),
    Scene(1.5, 2.0, 0.4, field=(1 - 1e-6) * 0.5 / math.sqrt(0.64 - 0.49)),
]  # fmt: skip


#: The reference takes seconds: most tests are slow.
REFERENCES = [scene if i in (0, 3, 6, 12, 15) else slow(scene) for i, scene in enumerate(SCENES)]


@pytest.mark.parametrize("scene", REFERENCES, ids=repr)
def test_reference(scene):
    """All volumes and areas agree with the reference; the part of all separations is the whole."""
    assert_close(numbers(scene), reference(scene))
    assert_close(weighted.areas_near(scene, "x", scene.side("x")), weighted.areas(scene))


BITS = """
import sys
from twodiscs.model.scene import Scene
from twodiscs.theory.exact import areas, volume
step, *scenes = sys.argv[1:]
print(sorted((text, volume(eval(text)), areas(eval(text))) for text in scenes[:: int(step)]))
"""


def test_the_bits_depend_on_neither_vectors_nor_process():
    """Without AVX the same is found, in another order, with other hashes and threads."""
    radii = 0.02, 0.1, 0.15, 0.2, 0.3, 0.34, 0.36
    scenes = [*map(repr, SCENES), *(repr(Scene(1.5, 1.0, r, field=1.5)) for r in radii)]
    vectors = np.show_config("dicts")["SIMD Extensions"].get("found", [])
    other = {"OPENBLAS_NUM_THREADS": "1", "NPY_DISABLE_CPU_FEATURES": " ".join(vectors)}
    one, two = (
        python("-c", BITS, step, *scenes, env=os.environ | {"PYTHONHASHSEED": "1"} | env).stdout
        for step, env in (("1", {}), ("-1", other | {"PYTHONHASHSEED": "2"}))
    )
    assert one == two
    assert one.count("disc_collision") == len(scenes)


# Closed forms -----------------------------------------------------------------------------------


BOXES = [(1.5, 1.0), slow((1.0, 1.0)), slow((1.0, 2.0)), (3.0, 1.0), (1e6, 1.0)]


@pytest.mark.parametrize("box", BOXES, ids=str)
def test_plain_scenes(box):
    """Without effects everything is as in ``exact``, up to the largest radius."""
    largest = Scene(*box, min(box) / 10).largest_radius
    radii = [largest * fraction for fraction in (1e-6, 0.1, 0.5, 0.65, 0.9, 1 - 1e-6, 1 - 1e-12)]
    radii += [side / 4 * (1 + shift) for side in box for shift in (-1e-9, 0.0, 1e-9)]
    for radius in sorted({r for r in radii if r < largest}):
        scene = Scene(*box, radius)
        expected = {"volume": exact.volume(scene)} | exact.areas(scene)
        assert_close(numbers(scene), expected, 1e-14)
        for event in SHELL_EVENTS:
            for epsilon in (radius * 1e-5, radius / 2):
                found = weighted.shell_expectation(scene, event, epsilon)
                expected = exact.shell_expectation(scene, event, epsilon)
                assert found == pytest.approx(expected, rel=1e-12, abs=0)


def test_balls_on_a_torus():
    """Boltzmann's case: πσ² g over the free volume."""
    scene = Scene(1.5, 1.0, 0.2, depth=1.2, periodic="xyz")
    free = 1.5 * 1.0 * 1.2 - 4 / 3 * math.pi * 0.4**3
    expected = free / (math.pi * 0.4**2 * math.sqrt(2))
    assert exact.mean_times(scene)["disc_collision"] == pytest.approx(expected, rel=1e-14)


def test_balls():
    """Balls in a box, in powers, for σ up to the shortest range; areas by derivatives."""
    scene = Scene(1.5, 1.0, 0.2, depth=1.2)
    sigma = 2 * mpf(scene.radius)
    ranges = [mpf(scene.side(axis)) - sigma for axis in "xyz"]

    def volume(a, b, c, s):
        return (a * b * c) ** 2 - (
            4 * mp.pi / 3 * a * b * c * s**3
            - mp.pi / 2 * (a * b + b * c + c * a) * s**4
            + mpf(8) / 15 * (a + b + c) * s**5
            - s**6 / 6
        )

    def hop(a, b, c):
        area = b * b * c * c - mp.pi * b * c * sigma**2 + mpf(4) / 3 * (b + c) * sigma**3
        return mp.sqrt(2) * a * (area - sigma**4 / 2)

    a, b, c = ranges
    orders = np.eye(4, dtype=int).tolist()
    sides = [mp.diff(volume, (*ranges, sigma), tuple(order)) for order in orders]
    expected = {
        "volume": volume(*ranges, sigma),
        "vertical_hop": hop(b, a, c),
        "horizontal_hop": hop(a, b, c),
        "disc_collision": -mp.sqrt(2) * sides[3],
        "any_wall": 2 * sum(sides[:3]),
        **{wall: sides["xy".index(EVENT_AXES[wall])] / 2 for wall in WALLS},
    }  # fmt: skip
    assert_close(numbers(scene), expected)


# Identities -------------------------------------------------------------------------------------

RATIO = st.floats(0.2, 5.0)


@st.composite
def scenes(draw):
    """Return a scene with any effects that go together."""
    effects = {
        "radius_ratio": draw(st.just(1.0) | RATIO),
        "mass_ratio": draw(st.just(1.0) | RATIO),
        "periodic": draw(st.sampled_from(["", "x", "y", "xy"])),
        **draw(st.sampled_from([{}, {"moment_of_inertia": 0.5}, {"depth": 1.2}])),
    }
    if "y" not in effects["periodic"]:
        effects["field"] = draw(st.just(0.0) | st.floats(1e-3, 10.0))
    box = draw(st.floats(0.5, 3.0)), draw(st.floats(0.5, 3.0))
    try:
        largest = Scene(*box, 1e-9, **effects).largest_radius
        return Scene(*box, draw(st.floats(0.01, 0.999)) * largest, **effects)
    except ValueError:
        assume(False)


@given(scenes())
# At the farthest separation roundings leave less energy than none.
@example(Scene(2.7, 1.0, 0.13, depth=1.0, radius_ratio=2.3, field=0.6))
# Disc 1 just reaches the top, at rest.
@example(Scene(1.0, 1.0, 0.25, field=1.0))
@settings(max_examples=40, deadline=None, derandomize=True)
def test_what_is_possible(scene):
    """An area is positive where the event is possible, and 0 elsewhere; all is finite."""
    assert 0 < weighted.volume(scene) < math.inf
    for event, area in weighted.areas(scene).items():
        assert 0 <= area < math.inf
        assert (area > 0) == scene.is_possible(event)
        assert (exact.mean_times(scene)[event] is None) == (area == 0)


@given(scenes(), st.floats(0.01, 1.4))
@settings(max_examples=20, deadline=None, derandomize=True)
def test_no_number_depends_on_which_disc_and_which_axis_is_the_first(scene, share):
    """Disc 2 as the first, in units of its mass, then x and y exchanged."""
    other, speed = exchanged(scene)
    shell = share * min(scene.radii)
    shells = [e for e in scene.events if e in SHELL_EVENTS or not scene.is_plain]

    def agree(found, expected, size=0.0):
        assert found == pytest.approx(expected, rel=1e-9, abs=1e-11 * size)

    agree(exact.volume(other), exact.volume(scene))
    every = exact.rate(scene, "any_wall") + exact.rate(scene, "disc_collision")
    for event in {*scene.events} - {*WALLS}:
        agree(exact.rate(other, event) / speed, exact.rate(scene, event), every)
        if event in shells:
            near = exact.shell_expectation(other, event, shell / speed) / speed
            agree(near, exact.shell_expectation(scene, event, shell))
    hops = [hop for hop in HOPS if hop in scene.events]
    for hop in hops:
        agree(exact.fraction_near(other, hop, shell), exact.fraction_near(scene, hop, shell))
    if scene.field:
        return
    # Both discs hit two walls of an axis.
    walls = {EVENT_AXES[wall]: wall for wall in WALLS if wall in scene.events}.values()
    both = sum(exact.rate(scene, wall) + exact.rate(other, wall) / speed for wall in walls)
    if not scene.depth:
        agree(2 * both, exact.rate(scene, "any_wall"))
    turned = scene.turned()
    agree(exact.volume(turned), exact.volume(scene))
    for event in TURNED.keys() & scene.events:
        agree(exact.rate(turned, TURNED[event]), exact.rate(scene, event), every)
        if event in shells:
            near = exact.shell_expectation(turned, TURNED[event], shell)
            agree(near, exact.shell_expectation(scene, event, shell))
    for hop in hops:
        near = exact.fraction_near(turned, TURNED[hop], shell)
        agree(near, exact.fraction_near(scene, hop, shell))


@given(scenes(), st.floats(0.01, 1.4), st.sampled_from([2.0**-20, 2.0**7]))
@settings(max_examples=10, deadline=None, derandomize=True)
def test_no_bit_depends_on_the_unit_of_length(scene, share, unit):
    other, shell, dimensions = in_unit(scene, unit), share * min(scene.radii), 2 * len(scene.axes)
    assert exact.volume(other) == unit**dimensions * exact.volume(scene)
    for event in scene.events:
        assert exact.rate(other, event) == exact.rate(scene, event) / unit
        assert corner_variance(other, event, unit) == corner_variance(scene, event, 1.0)
        if event in SHELL_EVENTS or not scene.is_plain:
            near = exact.shell_expectation(scene, event, shell)
            in_shell = exact.shell_expectation(other, event, unit * shell)
            assert in_shell == unit ** (dimensions - 1) * near


@pytest.mark.parametrize("periodic", ["", "x"])
def test_weak_field(periodic):
    """Areas and volumes of a vanishing field are those without it."""
    without = numbers(Scene(1.5, 1.0, 0.3, periodic=periodic, radius_ratio=0.9))
    for field in (1e-60, 1e-17):
        scene = Scene(1.5, 1.0, 0.3, periodic=periodic, field=field, radius_ratio=0.9)
        assert_close(numbers(scene), without, 1e-14)


# The meaning of areas and shells ------------------------------------------------------------------


def test_passages_along_a_ring():
    """In a field the flux has another power of the energy than the volume."""
    scene = Scene(1.5, 1.0, 0.2, periodic="x", field=0.8)
    power, square = mpf(scene.velocity_components - 1) / 2, (2 * mpf(scene.radius)) ** 2
    level, other = (Axis(scene, axis, power) for axis in "xy")
    area = mp.sqrt(2) * level.density(mpf(0)) * beyond([other], square)
    due = flux.flux_constant(scene.velocity_components) * area / reference(scene)["volume"]
    assert relative_error(passing_rate(scene, "horizontal_hop"), due) < BOUND


def test_thick_and_thin_collision_shells():
    """Collision shells are differences of volumes, those too thin for that as well."""
    scene = SCENES[7]
    axes, sigma = [Axis(scene, a, mpf(1.5)) for a in "yx"], mpf(float(sum(scene.exact_radii)))
    relative = mpf(math.sqrt(1 / scene.masses[0] + 1 / scene.masses[1]))
    inner = beyond(axes, sigma**2)
    for epsilon in (0.1, 1e-3, 3e-5):
        outer = beyond(axes, (sigma + mpf(epsilon) * relative) ** 2)
        found = weighted.shell_expectation(scene, "disc_collision", epsilon)
        assert relative_error(found, (inner - outer) / epsilon) < 1e-11


def test_a_thin_shell_that_grows_beyond_half_a_period():
    """On a torus it is a ring without the four segments of its circle beyond the square."""
    scene, epsilon = Scene(3.0, 3.0, 0.749997, periodic="xy"), 1e-5
    inner, half = 2 * mpf(scene.radius), mpf(scene.width) / 2
    outer = inner + mp.sqrt(2) * mpf(epsilon)
    assert inner < half < outer
    segment = outer**2 * mp.acos(half / outer) - half * mp.sqrt(outer**2 - half**2)
    expected = scene.width**2 * (mp.pi * (outer**2 - inner**2) - 4 * segment) / mpf(epsilon)
    found = weighted.shell_expectation(scene, "disc_collision", epsilon)
    assert relative_error(found, expected) < 1e-11
