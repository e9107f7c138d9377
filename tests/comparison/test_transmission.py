"""Transmission coefficients: what counts of clusters and of hops say, and what the face returns."""

import math

import numpy as np
import pytest

import twodiscs as td
from twodiscs.comparison.estimates import Estimate
from twodiscs.comparison.measured import transmission
from twodiscs.dynamics.passages import LARGEST, REPLICAS, SUMS


def test_clusters_are_weighed_by_their_sizes():
    """Of hops in clusters of 1, 2 and 3: 1, 0 and 1/3 passages each."""
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


def test_a_plateau_is_what_passages_take_away():
    """κ from κ exp(−2 κ t/τ), and none where passages come too often."""
    kappa, time, mean = 0.8, 5.0, 400.0
    fallen = kappa * math.exp(-2 * kappa * time / mean)
    found = transmission.plateau(Estimate(fallen, 0.01, 9), time, mean)
    assert found.value == pytest.approx(kappa, rel=1e-12)
    step = 1e-5
    higher = transmission.plateau(Estimate(fallen + step, 0.01, 9), time, mean).value
    assert found.stderr == pytest.approx(0.01 * (higher - kappa) / step, rel=1e-3)
    assert transmission.plateau(Estimate(fallen, 0.01, 9), time, 50.0) is None
    assert transmission.plateau(Estimate(0.001, 0.01, 9), time, 10.0) is None
    assert transmission.plateau(Estimate(-0.01, 0.01, 9), time, mean) is None


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
    assert "too often" in str(found)
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
