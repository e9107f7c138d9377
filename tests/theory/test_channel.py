"""The ordered channel: against other theories, sums of moments, and its limits."""

import math

import numpy as np
import pytest

from twodiscs.model.checks import InputError
from twodiscs.model.scene import Scene
from twodiscs.theory import channel, n_discs, three
from twodiscs.theory.virial import Derivatives, rates, virial_sum

BOUND = 1e-10

#: Relative errors in channels that are longer than the discs in a row.
PROMISED = 1e-12


def agree(found, expected, rel):
    """The logarithm of V has an absolute error."""
    assert found.log_volume == pytest.approx(expected.log_volume, abs=rel)
    assert found[1:] == pytest.approx(expected[1:], rel=rel)


@pytest.mark.parametrize("width", [1.5, 1.0, 6.0])
def test_two_discs_have_the_plain_theory(width):
    scene = Scene(width, 0.6, 0.18, discs=2)
    agree(channel.derivatives(scene), n_discs.known_derivatives(scene), BOUND)


@pytest.mark.parametrize(
    ("width", "height"), [(1.5, 0.6), (1.2, 0.6), (3.0, 0.4), (1.2, 0.36001), (10.0, 0.67)]
)
def test_three_discs_have_the_quadrature(width, height):
    scene = Scene(width, height, 0.18, discs=3)
    agree(channel.derivatives(scene), three.derivatives(scene), BOUND)


def by_moments(scene, order=40):
    """Return the ``Derivatives`` of a channel that is longer than the discs in a row.

    There the rooms A/(N − 1) − d of the bonds are positive, and A − S is their sum: V = ∫ (A − S)^N
    is made of their moments, by Gauss's rule. Derivatives are such integrals of N (A − S)^(N−1)
    times the derivative of S, hops those of δ(y_i − y_j). All terms are positive: nothing cancels.
    """
    n, sigma, a, b = scene.discs, scene.contact_distance, scene.range_x, scene.range_y
    assert a > (n - 1) * sigma
    nodes, weights = np.polynomial.legendre.leggauss(order)
    y, w = b * (1 + nodes) / 2, b * weights / 2
    square = (y[:, None] - y) ** 2
    d = np.sqrt(sigma**2 - square)
    # Moments stand over k!, so that those of sums are convolutions.
    moments = [1 + 0 * d]
    for k in range(1, n + 1):
        moments.append(moments[-1] * (a / (n - 1) - d) / k)

    def joined(left, right):
        """Return the moments of a sum, and integrate over the node between its parts."""
        return [sum(left[m] * w @ right[k - m] for m in range(k + 1)) for k in range(n + 1)]

    # Of 0, 1, … bonds from a node on, whatever their other end.
    ends = [[float(k == 0) + 0 * y for k in range(n + 1)]]
    for _ in range(n - 1):
        ends.append(joined(moments, ends[-1]))
    volume = w @ ends[-1][n]

    def mean(factor):
        """Return Σ over bonds of ∫ N (A − S)^(N−1) times a ``factor`` of the bond, over V."""
        bond = [factor * each for each in moments]
        total = 0.0
        for i in range(n - 1):
            beyond = joined(bond, ends[n - 2 - i])
            total += sum((w * ends[i][k]) @ beyond[n - 1 - k] for k in range(n))
        return total / volume

    chain, level = moments, 0.0
    for bonds in range(1, n):
        closed = [np.diag(each) for each in chain]
        for i in range(n - bonds):
            left, right = ends[i], ends[n - 1 - i - bonds]
            for k in range(n + 1):
                inner = sum(left[m] * closed[k - m] for m in range(k + 1))
                level += (w * inner) @ right[n - k]
        chain = joined(chain, moments)
    return Derivatives(
        math.log(math.factorial(n) * volume),
        w @ ends[-1][n - 1] / volume,
        n / b + mean(square / (b * d)),
        mean(sigma / d),
        horizontal_hops=0.0,
        vertical_hops=level / volume,
    )


@pytest.mark.parametrize(
    ("discs", "width", "height", "radius"),
    [(4, 1.6, 0.6, 0.18), (4, 2.5, 1.0, 0.28), (4, 6.0, 1.0, 0.3), (5, 2.4, 0.6, 0.17),
     (8, 4.9, 1.0, 0.3), pytest.param(4, 1.5, 0.6, 0.18, marks=pytest.mark.slow)],
)  # fmt: skip
def test_long_channels_are_made_of_moments(discs, width, height, radius):
    """The bound is the one that ``theory.exact.volume`` promises."""
    scene = Scene(width, height, radius, discs=discs)
    for known, value in zip(channel.derivatives(scene), by_moments(scene), strict=True):
        assert abs(known - value) <= PROMISED * max(1, abs(value))


def test_four_discs_in_a_shorter_channel():
    """By a product rule over the heights: the integrand has a kink in its fourth derivative."""
    scene, values = Scene(1.3, 0.6, 0.18, discs=4), []
    for order in (40, 56):
        x, w = np.polynomial.legendre.leggauss(order)
        y, w = scene.range_y * (1 + x) / 2, scene.range_y * w / 2
        d = np.sqrt(scene.contact_distance**2 - (y[:, None] - y) ** 2)
        middle = d[:, :, None] + d[None]
        room = scene.range_x - middle
        total = 0.0
        for i in range(order):
            left = np.maximum(room[i, :, :, None] - d[None], 0.0) ** 2
            total += w[i] * (left * left @ w @ w @ w)
        values.append(math.log(total))
    spread = abs(values[0] - values[1])
    assert spread < 1e-7
    assert channel.derivatives(scene, hops=False).log_volume == pytest.approx(
        values[1], abs=2 * spread
    )


@pytest.mark.parametrize(
    ("discs", "width", "height", "radius"),
    [(4, 1.2, 0.6, 0.18), (5, 1.6, 0.6, 0.18), (8, 2.7, 0.6, 0.18), (16, 7.0, 1.0, 0.29),
     (64, 30.0, 0.6, 0.18), (4, 1e-6, 4e-7, 1.2e-7), (512, 240.0, 0.6, 0.18)],
)  # fmt: skip
def test_the_virial_theorem(discs, width, height, radius):
    scene = Scene(width, height, radius, discs=discs)
    known = channel.derivatives(scene, hops=False)
    # If there is little room, walls and collisions cancel.
    size = scene.range_x * known.per_width / (2 * discs)
    assert virial_sum(scene, rates(scene, known)) == pytest.approx(1, abs=1e-11 * size)


@pytest.mark.parametrize("discs", [4, 8, 24])
def test_a_tonks_gas_is_left_where_the_channel_is_as_wide_as_the_discs(discs):
    """V → B^N (A − (N − 1) σ)^N, with relative corrections of the order N (B/σ)² σ/room."""
    radius, gap = 0.25, 1e-6
    scene = Scene(1.0 * discs, 0.5 + gap, radius, discs=discs)
    room = scene.range_x - (discs - 1) * scene.contact_distance
    known = channel.derivatives(scene)
    small = discs**2 * scene.range_y**2 / scene.contact_distance / room
    assert known.log_volume == pytest.approx(
        discs * math.log(scene.range_y * room), abs=small + 1e-11 * discs
    )
    assert known.per_width == pytest.approx(discs / room, rel=1e-9)
    assert known.per_contact == pytest.approx(discs * (discs - 1) / room, rel=1e-9)
    assert known.per_height == pytest.approx(discs / scene.range_y, rel=1e-5)
    # All heights are independent: ∫ δ(y_i − y_j) is 1/B for each pair.
    assert known.vertical_hops == pytest.approx(discs * (discs - 1) / 2 / scene.range_y, rel=1e-5)


def test_hops_of_many_discs_are_those_of_the_sum_without_a_series(monkeypatch):
    scenes = [Scene(w, 1.0, 0.28, discs=n) for n, w in ((24, 13.0), (48, 25.0))]
    found = [channel.derivatives(scene).vertical_hops for scene in scenes]
    monkeypatch.setattr(channel, "RATIO_ERROR", -1.0)
    monkeypatch.setattr(channel, "_geometric", None)
    for scene, value in zip(scenes, found, strict=True):
        assert value == pytest.approx(channel.derivatives(scene).vertical_hops, rel=1e-11)


def test_many_discs_tend_to_the_largest_eigenvalue():
    """At the same force only the two ends differ, by 1/N."""
    height, radius, force = 0.6, 0.18, 20.0
    ideal = channel.limit(height, radius, force)
    differences = []
    for discs in (64, 128, 256):
        scene = Scene(ideal.length * discs + radius, height, radius, discs=discs)
        known = channel.derivatives(scene, hops=False)
        differences.append(
            [known.per_width / force - 1, known.per_contact / discs / ideal.per_contact - 1,
             known.per_height / discs / ideal.per_height - 1]
        )  # fmt: skip
    differences = np.array(differences)
    # Without the first order in 1/N, and without the second.
    first = 2 * differences[1:] - differences[:-1]
    second = (4 * first[1] - first[0]) / 3
    assert np.all(np.abs(differences[-1]) > 0.005)
    # Each order takes off a power of 1/N, N = 256.
    assert np.all(np.abs(first[1]) < 5e-4)
    assert np.all(np.abs(second) < 2e-5)


def test_the_limit_is_a_tonks_gas_in_a_narrow_channel():
    found = channel.limit(0.5 + 1e-7, 0.25, 3.0)
    assert found.length == pytest.approx(1 / 3.0 + 0.5, rel=1e-10)
    assert found.per_contact == pytest.approx(3.0, rel=1e-10)
    assert found.level == pytest.approx(1e7, rel=1e-6)


def test_what_is_no_ordered_channel_is_refused():
    with pytest.raises(InputError, match="ordered channel"):
        channel.derivatives(Scene(3.0, 1.0, 0.2, discs=4))
    with pytest.raises(InputError, match="2 \\+ √3 radii"):
        channel.limit(1.0, 0.2, 1.0)
    with pytest.raises(InputError, match="force must"):
        channel.limit(0.6, 0.18, 0.0)


def test_turned_channels_are_the_same():
    along, up = (
        n_discs.known_derivatives(Scene(3.0, 0.6, 0.18, discs=4)),
        n_discs.known_derivatives(Scene(0.6, 3.0, 0.18, discs=4)),
    )
    assert along == up.turned()
    assert n_discs.event_rates(Scene(3.0, 0.6, 0.18, discs=4))["horizontal_hop"] == 0.0


def test_two_discs_are_those_of_a_scene():
    scene, scene = Scene(1.5, 1.0, 0.2), Scene(1.5, 1.0, 0.2, discs=2)
    from twodiscs.theory.exact import rate

    for event, found in rates(scene, n_discs.known_derivatives(scene)).items():
        copies = scene.copies(event)
        assert found == pytest.approx(copies * rate(scene, event), rel=1e-13)
