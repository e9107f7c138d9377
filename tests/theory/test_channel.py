"""The theory of an ordered channel, against quadrature, moments and limits.

Without these tests the theory of an ordered channel could be off from others, from sums of moments
or its limits.
"""

import math

import numpy as np
import pytest
from marks import slow
from scipy.integrate import quad_vec

import twodiscs as td
from twodiscs.theory import channel, exact, three
from twodiscs.theory.flux import Derivatives
from twodiscs.theory.n_discs import known_derivatives
from twodiscs_paper.studies.passages.models.file import limit

BOUND = 1e-10


@pytest.mark.parametrize(
    ("theory", "discs", "width", "height"),
    [
        (known_derivatives, 2, 1.5, 0.6), slow(known_derivatives, 2, 1.0, 0.6),
        (known_derivatives, 2, 6.0, 0.6), (three.derivatives, 3, 1.5, 0.6),
        slow(three.derivatives, 3, 1.2, 0.6), (three.derivatives, 3, 3.0, 0.4),
        (three.derivatives, 3, 1.2, 0.36001), (three.derivatives, 3, 10.0, 0.67),
    ],
)  # fmt: skip
def test_two_and_three_discs_have_their_other_theory(theory, discs, width, height):
    """The logarithm of V has an absolute error."""
    scene = td.Scene(width, height, 0.18, discs=discs)
    found, expected = channel.derivatives(scene), theory(scene)
    assert found.log_volume == pytest.approx(expected.log_volume, abs=BOUND)
    assert found[1:] == pytest.approx(expected[1:], rel=BOUND)


@pytest.mark.parametrize("ratio", [2, 50, 800])
def test_nodes_resolve_the_phase_of_a_transform_up_to_their_reach(ratio):
    force, scene = 3.0, td.Scene(1.0, 0.6, 0.18)
    made = channel.make_channel(scene, force, ratio * force)
    p = force * complex(1, math.sqrt(ratio**2 - 1))
    found = 2 * np.einsum("i,j,kij->", made.weights, made.weights, np.exp(-p * made.apart))
    b, sigma, least = made.height, made.sigma, made.least
    expected, _ = quad_vec(
        lambda y: 2 * (b - y) * np.exp(-p * (np.sqrt(sigma**2 - y**2) - least)), 0, b, epsrel=1e-13
    )
    assert found == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(("rank", "size"), [(9, 16), (24, 32), (90, 200)])
def test_a_kernel_is_the_product_of_few_vectors_if_its_range_has_few(rank, size):
    left, right = np.random.default_rng(3).standard_normal((2, 200, rank))
    columns, rows = channel._factors(left @ right.T)
    assert columns.shape == (200, size)
    assert columns @ rows == pytest.approx(left @ right.T, abs=1e-11)


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
    [
        (4, 3.0, 1.0, 0.28), (4, 6.0, 1.0, 0.3), (5, 2.4, 0.6, 0.17), (8, 4.9, 1.0, 0.3),
        slow(4, 1.5, 0.6, 0.18), slow(4, 1.6, 0.6, 0.18), slow(4, 2.5, 1.0, 0.28),
    ],
)  # fmt: skip
def test_long_channels_are_made_of_moments(discs, width, height, radius):
    """The bound is the one that ``channel.derivatives`` promises."""
    scene = td.Scene(width, height, radius, discs=discs)
    for known, value in zip(channel.derivatives(scene), by_moments(scene), strict=True):
        assert abs(known - value) <= 1e-12 * max(1, abs(value))


def test_hops_of_many_discs_are_those_of_the_sum_without_a_series(monkeypatch):
    scene = td.Scene(13.0, 1.0, 0.28, discs=24)
    found = channel.derivatives(scene).vertical_hops
    monkeypatch.setattr(channel, "RATIO_ERROR", -1.0)
    monkeypatch.setattr(channel, "_geometric", None)
    assert found == pytest.approx(channel.derivatives(scene).vertical_hops, rel=1e-11)


@pytest.mark.parametrize("force", [1.0, 5.0, 20.0])
def test_the_softness_of_a_channel_is_the_derivative_of_its_length(force):
    """By a difference over 1e-4 of the force, whose rounding and curvature are below 1e-7."""
    step = 1e-4 * force
    low, here, high = (limit(1.0, 0.3, force + k * step) for k in (-1, 0, 1))
    assert here.softness == pytest.approx((low.length - high.length) / (2 * step), rel=1e-7)


def test_many_discs_tend_to_the_largest_eigenvalue():
    """At the same force only the two ends differ, by 1/N."""
    height, radius, force = 0.6, 0.18, 20.0
    ideal = limit(height, radius, force)
    differences = []
    for discs in (32, 64, 128):
        scene = td.Scene(ideal.length * discs + radius, height, radius, discs=discs)
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
    # Each order takes off a power of 1/N, N = 128.
    assert np.all(np.abs(first[1]) < 2e-3)
    assert np.all(np.abs(second) < 1.6e-4)


@pytest.mark.parametrize("share", [0.3, 0.6, 0.9])
def test_residue_at_close_packing_in_a_channel(share):
    """The force times the length left is 2 kT for each disc in a zigzag at close packing.

    Montero and Santos, arXiv:2212.08932: the equation of state has a simple pole with residue 2
    there, where hard rods on a line have 1. The rest of the expansion is linear in kT/force.
    """
    across = share * math.sqrt(0.75)
    least = math.sqrt((1 - across) * (1 + across))

    def residue(force):
        return force * (limit(1 + across, 0.5, force).length - least)

    extrapolated = 2 * residue(2e5) - residue(1e5)
    assert extrapolated == pytest.approx(2, rel=1e-7)


@pytest.mark.parametrize(
    ("scene", "is_slow"),
    [
        (td.Scene(1.15, 0.5, 0.14, discs=4), True),
        (td.Scene(0.5, 1.0, 0.14, discs=4), True),
        (td.Scene(1.3, 0.5, 0.14, discs=4), False),
        (td.Scene(2.0, 0.5, 0.14, discs=7), True),
        (td.Scene(2.0, 0.5, 0.14, discs=8), False),
        (td.Scene(0.6, 0.5, 0.14), False),
        (td.Scene(1.0, 1.0, 0.18, discs=4), False),
        (td.Scene(1.5, 1.0, 0.2, field=0.3), False),
    ],
    ids=repr,
)
def test_exact_says_before_it_begins_that_it_takes_minutes(scene, is_slow, monkeypatch, recwarn):
    monkeypatch.setattr(exact, "exact", None)
    with pytest.raises(TypeError, match="'NoneType' object is not callable"):
        td.exact(scene)
    assert ["may take some minutes" in str(one.message) for one in recwarn] == [True] * is_slow
    assert {one.filename for one in recwarn} <= {__file__}


def test_a_channel_that_needs_too_many_terms_is_refused(monkeypatch):
    monkeypatch.setattr(channel, "MOST_TERMS", 24)
    with pytest.raises(td.InputError, match=r"^the .* for 3 discs needs more than 24 terms"):
        channel.derivatives(td.Scene(3.0, 0.4, 0.18, discs=3), hops=False)
