"""Transmission coefficients: from counts of clusters and of hops, and from the face."""

import math

import numpy as np
import pytest

import twodiscs as td
from twodiscs.comparison.measured import transmission
from twodiscs.comparison.scores import student_deviate
from twodiscs.dynamics.two.passages import LARGEST, REPLICAS, SUMS
from twodiscs.points.estimates import Estimate


def test_clusters_are_weighed_by_their_sizes():
    """Hops in clusters of 1, 2 and 3 are 1, 0 and 1/3 passages each."""
    sizes = np.zeros(LARGEST + 1, np.int64)
    sizes[1:4] = 600, 200, 300
    kappa = transmission.by_clusters(sizes)
    values = np.repeat([1, 0, 1 / 3], [600, 200, 300])
    assert kappa.value == pytest.approx(values.mean(), rel=1e-14)
    assert kappa.stderr == pytest.approx(values.std() / math.sqrt(1100), rel=1e-12)
    sizes[-1] = 100  # more than are counted: no passages
    assert transmission.by_clusters(sizes).value == pytest.approx(700 / 1200, rel=1e-14)


def test_errors_of_a_correlation_between_walls_are_binomial():
    sums = np.zeros((2, SUMS, 1), np.int64)
    sums[:, 0, 0], sums[:, 1, 0] = -10, 10  # 20 of the replicas have changed sides
    (found,) = transmission.by_time(sums)
    n = 2 * REPLICAS
    assert found.value == 1 - 2 * 20 / n
    assert found.stderr == pytest.approx(math.sqrt((1 - found.value**2) / n), rel=1e-14)


LAWS = {"order": transmission.of_order, "clusters": transmission.of_clusters}


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_a_plateau_is_what_passages_leave(law):
    """κ follows from its value after 0.01 passages; there is none if passages are too frequent."""
    kappa, time, mean = 0.8, 5.0, 400.0
    left, derivative = law(kappa * time / mean)
    assert left == pytest.approx(1 - 2 * kappa * time / mean, abs=4e-4)
    step = 1e-6
    assert derivative == pytest.approx((law(0.01 + step)[0] - left) / step, rel=1e-5)
    fallen = kappa * left
    found = transmission.plateau(Estimate(fallen, 0.01, 9), time, mean, law)
    assert found.value == pytest.approx(kappa, rel=1e-12)
    higher = transmission.plateau(Estimate(fallen + step, 0.01, 9), time, mean, law).value
    assert found.stderr == pytest.approx(0.01 * (higher - kappa) / step, rel=1e-3)
    assert transmission.plateau(Estimate(fallen, 0.01, 9), time, 30.0, law) is None
    assert transmission.plateau(Estimate(-0.01, 0.01, 9), time, mean, law) is None


@pytest.mark.parametrize("x", [0.01, 0.1, 0.5])
def test_independent_passages_leave_so_much(x):
    """Passages of a Poisson process, each one hop: x of them in a gap, by its definition."""
    times = np.cumsum(np.random.default_rng(1).exponential(1 / x, 400_000))
    ends = np.append(np.flatnonzero(np.diff(times) > 1), times.size - 1)
    sizes = np.bincount(np.diff(ends), minlength=LARGEST + 1) * np.arange(
        max(LARGEST, np.diff(ends).max()) + 1
    )
    found = transmission.by_clusters(sizes)
    # Hops of a cluster are not independent, so the error is larger, by the root of a size at most.
    error = found.stderr * math.sqrt(np.max(np.flatnonzero(sizes)))
    assert abs(found.value - transmission.of_clusters(x)[0]) <= 5 * error < 0.02


@pytest.mark.slow
def test_the_order_of_the_discs_decays_by_passages():
    """As exp(−2 κ t/τ), over starts of the invariant measure, whatever clusters of hops are.

    After 48 ranges what comes before has been forgotten. Clusters with a pause of six ranges have
    a κ that is too large by 1.5 %, which this would see.
    """
    scene, hop = td.Scene(1.5, 1.0, 0.25 * (1 - 2.0**-6)), "horizontal_hop"

    def ordered(start, now):
        return np.sign(start["x1"] - start["x2"]) * np.sign(now["x1"] - now["x2"])

    early, late = 48.0, 250.0
    parts = [td.observe(scene, ordered, [early, late], 2**17, seed=n) for n in range(16)]
    decays = np.array([np.log(part.mean[0] / part.mean[1]) for part in parts]) / (late - early)
    kappa = decays * td.mean_times(scene)[hop] / 2
    due = td.transmission(scene, hop, 2**18, seed=1).coefficient
    error = math.hypot(kappa.std(ddof=1) / math.sqrt(kappa.size), due.stderr)
    assert error < 0.003 * due.value
    assert abs(student_deviate((kappa.mean() - due.value) / error, kappa.size - 1)) <= 5


def test_the_face_has_the_coefficient_and_the_curve():
    scene = td.Scene(1.5, 1.0, 0.246)
    found = td.transmission(scene, "horizontal_hop", hops=2**14, seed=1)
    kappa, passage = found.coefficient, found.passage_time
    # A trial by a scalar program: 0.797(2) at this radius, without what later passages take.
    assert abs(kappa.value - 0.797) < 0.02
    assert passage.value == pytest.approx(td.mean_times(scene)["horizontal_hop"] / kappa.value)
    assert passage.relative_stderr == pytest.approx(kappa.relative_stderr)
    frame = found.frame()
    assert list(frame.columns) == ["kappa", "stderr"]
    assert frame.index[-1] == pytest.approx(10 * scene.range_x, rel=1e-12)
    assert "fraction of horizontal hops that are passages  0." in str(found)
    assert sum(found.clusters.values()) == 2**14
    again = td.transmission(scene, "horizontal_hop", hops=2**14, seed=1)
    assert again.coefficient == kappa
    assert td.transmission(scene, "horizontal_hop", hops=2**14, seed=2).coefficient != kappa


def test_frequent_hops_have_a_curve_only():
    found = td.transmission(td.Scene(1.5, 1.0, 0.2), "vertical_hop", hops=1000)
    assert found.coefficient is None
    assert found.passage_time is None
    assert found.clusters == {}  # none are looked for: they would hardly end
    assert "too frequent" in str(found)
    assert len(found.frame()) == len(transmission.TIMES)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"scene": td.Scene(1.5, 1.0, 0.3)}, "is blocked at radius 0.3"),
        ({"hop": "disc_collision"}, "hop must be one of"),
        ({"scene": td.Scene(1.5, 1.0, 0.2, periodic="x")}, "must be between walls"),
        ({"hops": 0}, "hops must be an integer"),
        ({"name": 3}, "name must be"),
    ],
)
def test_bad_requests_are_refused(change, said):
    good = {"scene": td.Scene(1.5, 1.0, 0.2), "hop": "horizontal_hop", "hops": 100}
    with pytest.raises(td.InputError, match=said):
        td.transmission(**(good | change))
