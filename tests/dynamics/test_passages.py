"""Hops that follow one another: against another program, exact rates and symmetries.

Statistical comparisons allow five standard errors: with some 40 of them a false alarm comes in
fewer than 3e-5 of all seeds.
"""

import math
from typing import NamedTuple

import numpy as np
import pytest
from scalar_passages import clusters, replicas

from twodiscs.comparison.transmission import by_clusters, of_clusters, plateau
from twodiscs.dynamics.ensemble import LANES
from twodiscs.dynamics.law import WRAP_X
from twodiscs.dynamics.two import passages
from twodiscs.dynamics.two.follow import follow
from twodiscs.model.box import Box
from twodiscs.model.events import AXIS
from twodiscs.model.scene import Scene
from twodiscs.sampling.prism import prism_of
from twodiscs.sampling.starts import COMPONENTS, StartSampler, draw_states
from twodiscs.sampling.streams import open_stream
from twodiscs.theory import exact
from twodiscs.theory.virial import flux_constant
from twodiscs_paper.studies.passages.measure import by_time, of_order

HOP = "horizontal_hop"
TIMES = [0.2, 1.0, 5.0, 10.0]
NARROW = 0.246  # 0.016 of the height is left to discs side by side along y


def surface_states(scene, hop, number, seed):
    """Return initial states on the surface of a ``hop``, weighted by the flux through it."""
    sampler = StartSampler(None, prism_of(scene, hop, 0.0), surface="xy".index(AXIS[hop]))
    states = np.zeros((COMPONENTS, number))
    draw_states(open_stream(np.uint64(seed), 0), sampler, states)
    return states


def five(found, due, error):
    assert abs(found - due) <= 5 * error, (found, due, error)


@pytest.mark.parametrize(
    ("periodic", "inertia"),
    [
        ("", None),
        pytest.param("x", None, marks=pytest.mark.slow),
        pytest.param("", 0.5, marks=pytest.mark.slow),
        pytest.param("x", 0.5, marks=pytest.mark.slow),
    ],
)
def test_correlations_are_those_of_another_program(inertia, periodic):
    for radius in (0.218, NARROW):
        scene = Scene(1.5, 1.0, radius, periodic=periodic, moment_of_inertia=inertia)
        sums, events = passages.hop_sums(scene, HOP, TIMES, 512, 3)
        assert events > 0
        other = replicas(
            4, 20_000, 1.5, 1.0, radius, inertia or 0.0, bool(periodic), np.array(TIMES)
        )
        means, errors = other.mean(axis=0), other.std(axis=0) / math.sqrt(len(other))
        for estimate, mean, error in zip(by_time(sums), means, errors, strict=True):
            five(estimate.value, mean, math.hypot(estimate.stderr, error) + 1e-12)
        if not periodic:
            # Hops alternate: C = 1 + 2 n is +1 or −1 in every replica.
            np.testing.assert_array_equal(sums[:, 1], -sums[:, 0])


class PastHops(NamedTuple):
    """The experiment ``NetHops`` from the reversed initial states."""

    times: np.ndarray
    hopping: bool
    axis: tuple
    falls: np.ndarray
    rises: np.ndarray
    hops: np.ndarray
    events: np.ndarray
    sums: np.ndarray
    first: int
    both_ways: bool | None = True

    begin, note = passages.NetHops.begin, passages.NetHops.note

    def ended(self, i, replica, stretch):
        if stretch == 0:
            falls = 1.0 - self.falls[i]
            self.falls[i], self.rises[i], self.hops[i] = falls, falls, -falls
            return -self.times[0]
        n = np.int64(self.rises[i] * (1.0 - 2.0 * self.falls[i]))
        block = (replica - self.first) // passages.HOPS_OF_BLOCK
        self.sums[block, 0, stretch - 1] += n
        self.sums[block, 1, stretch - 1] += n * n
        last = self.times.size
        return self.times[stretch] - self.times[stretch - 1] if stretch < last else 0.0


def test_the_past_is_as_the_future():
    """κ(t) = κ(−t): from the same states with reversed velocities."""
    scene, times = Scene(1.5, 1.0, 0.24), np.array(TIMES)
    future, _ = passages.hop_sums(scene, HOP, times, 512, 5)
    lanes, past = [np.zeros(LANES) for _ in range(4)], np.zeros_like(future)
    hops = PastHops(times, True, (True, WRAP_X), *lanes, past, 0)
    prism = prism_of(scene, HOP, 0.0)
    follow(hops, scene, StartSampler(None, prism, surface=0), 5, 0, 512, 64, LANES, 2)
    for one, other in zip(by_time(future), by_time(past), strict=True):
        assert one != other
        five(one.value, other.value, math.hypot(one.stderr, other.stderr))


@pytest.mark.parametrize("inertia", [None, pytest.param(0.5, marks=pytest.mark.slow)])
def test_odd_clusters_are_what_is_left_of_the_correlation(inertia):
    """Hops are so rare that the gap hardly matters, and the error is far smaller."""
    scene = Scene(1.5, 1.0, 0.249, moment_of_inertia=inertia)
    sizes, _ = passages.cluster_sizes(scene, HOP, 6.0, 64, 6)
    (late,) = by_time(passages.hop_sums(scene, HOP, [6.0], 64, 7)[0])
    kappa = by_clusters(sizes)
    five(kappa.value, late.value, math.hypot(kappa.stderr, late.stderr))
    # Passages that follow within the gap are 2 κ gap/τ of them, 2e-3 at most.
    assert 2 * 6.0 * exact.rate(scene, HOP) < 2e-3
    assert sizes[0] == 0
    assert sizes.sum() == 64 * passages.HOPS_OF_BLOCK
    assert kappa.stderr * math.sqrt(kappa.n) < math.sqrt(kappa.value)


@pytest.mark.parametrize("inertia", [None, 0.5, 0.1])
@pytest.mark.parametrize(("radius", "gap"), [(0.247, 0.6), (0.247, 6.0), (0.1, 0.4)])
def test_clusters_to_both_sides_are_those_of_another_program(inertia, radius, gap):
    """Spins are reversed with the velocities.

    The gap is counted from each hop, not from the bounce after it: of small discs that is as late.
    κ, the share of single hops and the mean size of clusters, up to 64 hops.
    """
    scene = Scene(1.5, 1.0, radius, moment_of_inertia=inertia)
    counts, _ = passages.cluster_sizes(scene, HOP, gap, 192, 11)
    own = np.repeat(np.arange(counts.size), counts)
    other = clusters(12, 12_000, 1.5, 1.0, radius, inertia or 0.0, gap, math.inf, False)
    for of in (lambda n: n % 2 / n, lambda n: n == 1, lambda n: np.minimum(n, 64)):
        values = [np.asarray(of(sizes), float) for sizes in (own, other)]
        errors = [part.std() / math.sqrt(part.size) for part in values]
        five(values[0].mean(), values[1].mean(), math.hypot(*errors))


@pytest.mark.parametrize("inertia", [None, pytest.param(0.5, marks=pytest.mark.slow)])
def test_clusters_with_friction_are_those_of_another_program(inertia):
    """Kicks before and after time 0 are independent."""
    scene = Scene(1.5, 1.0, NARROW, moment_of_inertia=inertia, friction=20.0)
    counts, _ = passages.cluster_sizes(scene, HOP, 6.0, 128, 11)
    own = np.repeat(np.arange(counts.size), counts)
    other = clusters(12, 4000, 1.5, 1.0, NARROW, inertia or 0.0, 6.0, 1 / 20.0, False)
    for of in (lambda n: n % 2 / n, lambda n: n == 1, lambda n: np.minimum(n, 64)):
        values = [np.asarray(of(sizes), float) for sizes in (own, other)]
        errors = [part.std() / math.sqrt(part.size) for part in values]
        five(values[0].mean(), values[1].mean(), math.hypot(*errors))


def test_equal_steps_diffuse_as_friction_of_twice_their_rate():
    """After equal steps Δt, as in Brownian dynamics, D is ⟨v²⟩Δt/2, with friction it is ⟨v²⟩/γ."""
    rate, found = 40.0, {}
    for steps in (rate, rate / 2):
        sizes = clusters(2, 6000, 1.5, 1.0, NARROW, 0.0, 6.0, 1 / steps, True)
        odd = sizes % 2 / sizes
        found[steps] = odd.mean(), odd.std() / math.sqrt(odd.size)
    scene = Scene(1.5, 1.0, NARROW, friction=rate)
    kappa = by_clusters(passages.cluster_sizes(scene, HOP, 6.0, 96, 1)[0])
    (half, half_error), (equal, error) = found.values()
    five(equal, kappa.value, math.hypot(error, kappa.stderr))
    five(2 * half, kappa.value, math.hypot(2 * half_error, kappa.stderr))
    assert equal - half > 10 * math.hypot(error, half_error)


def test_the_slope_at_zero_grows_with_friction():
    """A kick soon after a hop may lead back: −κ'(0⁺) gains γ⟨v'/(v + v')⟩ over the speeds v, v'.

    v is the normal speed at the hop, weighted by the flux, and v' that after a kick. Components n
    of a unit vector in four dimensions have a density ∝ √(1 − n²); with n = sin φ the integrals are
    over φ. The mean is 2/5.
    """
    rate, time = 20.0, 5e-3
    x, weights = np.polynomial.legendre.leggauss(64)
    angle, weights = math.pi / 4 * (x + 1), weights * np.cos(math.pi / 4 * (x + 1)) ** 2
    speed = np.sin(angle)
    ratio = speed[:, None] * speed / (speed[:, None] + speed)
    mean = weights @ ratio @ weights / (weights @ speed) / weights.sum()
    assert mean == pytest.approx(2 / 5, rel=1e-6)
    plain = 2 * 3 * math.sqrt(2) / (16 * 1.06)
    scene = Scene(1.5, 1.0, 0.22, friction=rate)
    early, late = (
        by_time(passages.hop_sums(scene, HOP, [n * time], 4096, n)[0])[0] for n in (1, 2)
    )
    slope = (4 * (1 - early.value) - (1 - late.value)) / (2 * time)
    error = math.hypot(4 * early.stderr, late.stderr) / (2 * time)
    five(slope, plain + rate * mean, error)
    assert error < 0.05 * rate * mean


EFFECTS = {
    "friction": (HOP, Scene(1.5, 1.0, 0.248, friction=8.0)),
    "unequal": (HOP, Scene(1.5, 1.0, 0.165, radius_ratio=2.0, mass_ratio=3.0)),
    "field": ("vertical_hop", Scene(1.0, 1.5, 0.248, field=0.2, friction=0.5)),
    "channel": (HOP, Scene(1.5, 1.0, 0.249, periodic="y", friction=8.0)),
    "balls": (HOP, Scene(1.5, 0.8, 0.232, depth=0.8)),
}


@pytest.mark.parametrize(
    "name", ["friction", *(pytest.param(n, marks=pytest.mark.slow) for n in [*EFFECTS][1:])]
)
def test_both_estimates_of_effects_agree(name):
    """By clusters and by κ(t), where passages are rare; corrected for those in the gap."""
    (hop, scene), gap = EFFECTS[name], 6.0
    mean = 1 / exact.passing_rate(scene, hop)
    early = by_clusters(passages.cluster_sizes(scene, hop, gap, 128, 6)[0])
    (late,) = by_time(passages.hop_sums(scene, hop, [gap], 256, 7)[0])
    kappa, other = plateau(early, gap, mean, of_clusters), plateau(late, gap, mean, of_order)
    five(kappa.value, other.value, math.hypot(kappa.stderr, other.stderr))
    assert 0 < kappa.value < 1


@pytest.mark.parametrize("inertia", [None, 0.5])
def test_hops_on_a_ring_have_their_exact_rate(inertia):
    scene = Scene(1.5, 1.0, 0.2, periodic="x", moment_of_inertia=inertia)
    sums, _ = passages.hop_sums(scene, HOP, [20.0], 256, 8, on_surface=False)
    counts = sums[:, 2, 0] / (20.0 * passages.HOPS_OF_BLOCK)
    five(counts.mean(), exact.passing_rate(scene, HOP), counts.std(ddof=1) / 16)


def test_ratios_of_rates_are_those_of_the_constants():
    """Smooth to rough: c4/c6 in the box; c3/c6 on the ring, whose rough walls take momentum."""
    for periodic, components in (("", 4), ("x", 3)):
        smooth, rough = (
            exact.passing_rate(Scene(1.5, 1.0, 0.2, periodic=periodic, moment_of_inertia=i), HOP)
            for i in (None, 0.5)
        )
        due = flux_constant(components) / flux_constant(6)
        assert smooth / rough == pytest.approx(due, rel=1e-13)
    plain = Scene(1.5, 1.0, 0.2)
    assert exact.passing_rate(plain, HOP) == exact.rate(plain, HOP)


def test_displacements_grow_as_the_correlations_say():
    """d⟨n²⟩/dt = Γ C(t), between t = 20 and 40 where C has its limit."""
    scene = Scene(1.5, 1.0, 0.22, periodic="x")
    sums, _ = passages.hop_sums(scene, HOP, [20.0, 40.0], 512, 9, on_surface=False)
    rate = exact.passing_rate(scene, HOP)
    grown = (sums[:, 1, 1] - sums[:, 1, 0]) / (20.0 * passages.HOPS_OF_BLOCK * rate)
    (due,) = by_time(passages.hop_sums(scene, HOP, [30.0], 512, 10)[0])
    error = grown.std(ddof=1) / math.sqrt(len(grown))
    five(grown.mean(), due.value, math.hypot(error, due.stderr))


def test_initial_states_are_on_the_surface():
    for radius in (0.2, 0.25 * (1 - 2.0**-30)):
        for effects in ({}, {"periodic": "x"}, {"moment_of_inertia": 0.5}):
            scene = Scene(1.5, 1.0, radius, **effects)
            x1, y1, x2, y2, u1, v1, u2, v2, s1, s2 = surface_states(scene, HOP, 256, 1)[:10]
            spins = scene.moment_of_inertia or 0.0
            assert np.array_equal(x1, x2)
            assert (np.abs(y1 - y2) >= scene.contact_distance).all()
            assert (np.abs(y1) <= scene.range_y / 2).all()
            energy = (u1**2 + v1**2 + u2**2 + v2**2 + spins * (s1**2 + s2**2)) / 2
            assert np.allclose(energy, 0.5, rtol=1e-14)
            if effects == {"periodic": "x"}:
                assert np.allclose(u1 + u2, 0, atol=1e-15)
            # Half of them hop either way; the flux has ⟨n²⟩ = 2/(D + 1) of the normal velocity n.
            normal, n = (u1 - u2) / math.sqrt(2), u1.size
            assert abs(np.sum(normal > 0) - n / 2) <= 5 * math.sqrt(n) / 2
            due = 2 / (scene.velocity_components + 1)
            assert abs(np.mean(normal**2) - due) <= 5 * np.std(normal**2) / math.sqrt(n)


def test_small_discs_on_the_surface_are_as_far_apart_as_the_measure_says():
    """|y1 − y2| has the density ∝ B − v from σ to B: at a quarter of B either disc can be above."""
    scene = Scene(1.5, 1.0, 0.1)
    states = surface_states(scene, HOP, 2**14, 1)
    apart = np.abs(states[1] - states[3])
    sigma, reach = scene.contact_distance, scene.range_y

    def moment(n):
        def integral(v):
            return reach * v ** (n + 1) / (n + 1) - v ** (n + 2) / (n + 2)

        return integral(reach) - integral(sigma)

    mean, square = (moment(n) / moment(0) for n in (1, 2))
    five(apart.mean(), mean, math.sqrt((square - mean**2) / apart.size))


def test_blocks_are_what_results_depend_on():
    scene = Scene(1.5, 1.0, 0.24)
    whole, events = passages.hop_sums(scene, HOP, TIMES, 6, 11)
    parts = [passages.hop_sums(scene, HOP, TIMES, 3, 11, first) for first in (0, 3)]
    np.testing.assert_array_equal(whole, np.concatenate([sums for sums, _ in parts]))
    assert events == sum(events for _, events in parts)
    turned = Box.of(scene).turned().scene(0.24)
    np.testing.assert_array_equal(whole, passages.hop_sums(turned, "vertical_hop", TIMES, 6, 11)[0])


@pytest.mark.slow
def test_hops_in_a_field_are_those_along_y():
    """The field is so weak that the results do not change, but it has another kernel."""
    plain, weak = Scene(1.0, 1.5, 0.24), Scene(1.0, 1.5, 0.24, field=1e-9)
    both = [by_time(passages.hop_sums(s, "vertical_hop", TIMES, 256, 12)[0]) for s in (plain, weak)]
    for one, other in zip(*both, strict=True):
        five(one.value, other.value, math.hypot(one.stderr, other.stderr))
