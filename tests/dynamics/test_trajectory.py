"""One trajectory, event by event: the kernels in slow motion."""

import math

import numpy as np
import pytest
from effect_scenes import SCENES

from twodiscs.comparison.tables.trajectory import Trajectory
from twodiscs.dynamics import trajectory
from twodiscs.model.box import Box
from twodiscs.model.scene import Scene
from twodiscs.theory.exact import event_rate, mean_times

PAPER = Scene(1.5, 1.0, 0.2)


@pytest.mark.parametrize("radius", [0.2, 0.3, 0.3749, 0.38])
def test_a_trajectory_shows_some_hops_and_is_not_too_long(radius):
    """Eight mean times of the rarest hop that is open, or 6000 events, to a factor of √2."""
    scene = PAPER.with_radius(radius)
    rows = Trajectory.rows(Box(1.5, 1.0), radius, seed=3)
    assert rows == Trajectory.rows(Box(1.5, 1.0), radius, seed=3)
    assert rows != Trajectory.rows(Box(1.5, 1.0), radius, seed=4)
    hops = [mean_times(scene)[hop] for hop in ("vertical_hop", "horizontal_hop")]
    eight = 8 * max((time for time in hops if time), default=math.inf)
    expected = min(eight, 6000 / event_rate(scene))
    assert (
        expected / math.sqrt(2) <= rows[-1]["time"] * (1 + 1e-12) <= 1.001 * expected * math.sqrt(2)
    )


@pytest.mark.parametrize("name", ["channel", "balls"])
def test_rows_are_those_of_the_table(name, tmp_path):
    scene = SCENES[name]
    rows = Trajectory.rows(Box.of(scene), scene.radius, seed=1)
    Trajectory.write(tmp_path / "trajectory.csv", rows)
    assert Trajectory.read(tmp_path / "trajectory.csv") == rows
    deep = scene.depth is not None
    assert all((row["z1"] is not None) == (row["z2"] is not None) == deep for row in rows)
    assert {row["event"] for row in rows} >= {"start", "disc_collision", "vertical_hop", "end"}


def test_cells_are_the_periods_that_centres_have_gone_on():
    scene = Scene(1.5, 1.0, 0.1, periodic="x")
    x1 = np.array([row[1] for row in trajectory.trajectory(scene, 3, duration=40.0)])
    cells = trajectory.cell_of(scene.width, x1)
    assert len(set(cells.tolist())) > 1
    assert np.abs(x1 - scene.width * cells).max() <= scene.width / 2
