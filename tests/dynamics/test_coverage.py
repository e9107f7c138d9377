"""Error bars: the coverage of 95 % intervals, for exactly known values."""

import math

import numpy as np
import pytest

from twodiscs.comparison.scene_tables import MeanTimes, Theory
from twodiscs.dynamics import runs
from twodiscs.model.box import Box
from twodiscs.model.events import SHELLS
from twodiscs.model.scene import Scene
from twodiscs.sampling import montecarlo
from twodiscs.theory.exact import shell_expectation, volume

BOX = Box(1.5, 1.0)


@pytest.mark.slow
def test_binomial_intervals_cover_volume_and_areas():
    """1600 points of one block of proposals, against the exact expectation of each shell."""
    scene = BOX.scene(0.38)
    areas = [f"{event}_area" for event in SHELLS]
    points = [
        montecarlo.conditioned_point(scene, ["volume", *areas], 1, 0.3, seed)
        for seed in range(1600)
    ]
    exact = {"volume": volume(scene)}
    for event, area in zip(SHELLS, areas, strict=True):
        epsilon = points[0].quantities[area].epsilon
        exact[area] = shell_expectation(scene, event, epsilon)
    for quantity, value in exact.items():
        found = [point.estimate(quantity) for point in points]
        if value == 0:
            assert found == [None] * 1600
        else:
            assert 0.92 <= np.mean([one.covers(value) for one in found]) <= 0.98, quantity


def test_the_shown_interval_is_the_one_whose_coverage_is_measured():
    """The estimate ± stderr of a table comes from the same sums by the same function."""
    point = runs.count_events(BOX.scene(0.24), {"right_wall": 0.02}, 10**7, 1)
    count, squares = point.counts["right_wall"], point.products["right_wall*right_wall"]
    replicas, duration = point.replicas, 4 * point.duration
    estimate = point.estimate("right_wall", copies=4)
    variance = squares / replicas - (count / replicas) ** 2
    error = math.sqrt(variance / (replicas - 1)) / (count / replicas)
    assert estimate.value == pytest.approx(duration * replicas / count, rel=1e-14)
    assert estimate.relative_stderr == pytest.approx(error, rel=1e-9)


BURSTS = Scene(
    0.013234765602418557, 2.554439270542779, 0.0032671790178727283, periodic="x",
    field=0.05914673912256739, moment_of_inertia=0.9083554322976234,
)  # fmt: skip


def row_of(scene, point):
    """Return the one row of mean_times.csv of a point."""
    box = Box.of(scene)
    (row,) = MeanTimes.rows(box, Theory.rows(box, [scene.radius]), {"dynamics": [point]})
    return row


@pytest.mark.slow
def test_bursts_of_collisions_have_no_error_bar():
    """Rough discs that hardly pass each other: rare replicas have a thousand times the mean.

    A sample without a large one is wrong by up to 80 of its errors. The rule finds this in 39 of 40
    samples; a sample with only usual replicas looks like any other.
    """
    wrong, bars = 0, 0
    for seed in range(40):
        point = runs.count_events(BURSTS, {"disc_collision": 1e-3}, 10**6, seed)
        row = row_of(BURSTS, point)
        bars += row["stderr"] is not None
        wrong += row["stderr"] is not None and abs(row["z"]) > 5
    assert wrong <= bars <= 4


@pytest.mark.slow
@pytest.mark.parametrize("radius", [0.24, 0.2475])
def test_rough_discs_with_an_error_bar_are_covered(radius):
    """Mean square deviate within five sigma of 1, of those that have an error bar."""
    scene, z = Scene(1.0, 1.0, radius, moment_of_inertia=0.9), []
    for seed in range(20):
        point = runs.count_events(scene, {"disc_collision": 1e-3}, 10**6, seed)
        row = row_of(scene, point)
        z += [row["z"]] if row["stderr"] else []
    assert len(z) >= 15
    assert abs(np.mean(np.square(z)) - 1) < 5 * math.sqrt(2 / len(z))
