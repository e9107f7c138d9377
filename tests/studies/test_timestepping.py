"""The time-stepping simulation against a plain one, and the law of its error."""

import numpy as np
import pytest

from twodiscs.dynamics import ensemble
from twodiscs.model.scene import Scene
from twodiscs.sampling.separations import separation_sampler
from twodiscs.sampling.starts import draw_starts
from twodiscs.sampling.streams import open_stream
from twodiscs.theory import exact
from twodiscs_paper.studies.accuracy_cost import scalar, timestepping

PAPER = Scene(1.5, 1.0, 0.2)


def plain(scene, start, steps, step):
    """Return the counts of one trajectory, with vectors and branches."""
    x, v = np.array(start[:4]).reshape(2, 2), np.array(start[4:]).reshape(2, 2)
    half = np.array([scene.range_x, scene.range_y]) / 2
    counts = dict.fromkeys(scalar.COUNTED, 0)
    for _ in range(steps):
        before = x[0] - x[1]
        x = x + v * step
        beyond = (np.abs(x) > half) & (x * v > 0)
        counts["any_wall"] += beyond.sum()
        counts["right_wall"] += beyond[:, 0].sum()
        counts["top_wall"] += beyond[:, 1].sum()
        v = np.where(beyond, -v, v)
        apart = x[0] - x[1]
        changed = (before < 0) != (apart < 0)
        counts["horizontal_hop"] += changed[0]
        counts["vertical_hop"] += changed[1]
        approach = apart @ (v[0] - v[1])
        if apart @ apart < scene.contact_distance**2 and approach < 0:
            counts["disc_collision"] += 1
            kick = approach / (apart @ apart) * apart
            v = v + np.array([-kick, kick])
    return [int(counts[event]) for event in scalar.COUNTED]


@pytest.mark.parametrize(("radius", "step"), [(0.2, 0.05), (0.24, 0.01), (0.3, 0.02)])
def test_it_is_the_plain_simulation(radius, step):
    """Short enough that chaos has not made a last digit into another count."""
    scene, replicas, steps = PAPER.with_radius(radius), 16, 150
    draw, starts = separation_sampler(scene), np.zeros((8, 16))
    sums = timestepping.step_blocks(
        np.uint64(4), 0, 1, replicas, 8, steps, step, scene.contact_distance, draw
    )
    draw_starts(open_stream(np.uint64(4), 0), draw, 0, 0, starts)
    expected = np.sum([plain(scene, start, steps, step) for start in starts.T], axis=0)
    assert sums.tolist() == expected.tolist()
    assert sums[-1] > 50


def test_the_error_is_proportional_to_the_step():
    """Its errors over Δt agree for three steps within 10 % and five standard errors."""
    duration, blocks, slopes = 32.0, 2, []
    expected = exact.rate(PAPER, "any_wall") * duration * blocks * ensemble.REPLICAS
    for step in (2.0**-4, 2.0**-5, 2.0**-6):
        counts = timestepping.run_blocks(PAPER, 1, 0, blocks, duration, step)
        # Wall counts scatter less than those of a Poisson process.
        slopes.append(((expected / counts[-1] - 1) / step, expected**-0.5 / step))
    for slope, error in slopes:
        assert abs(slope - slopes[0][0]) < 5 * np.hypot(error, slopes[0][1]) + 0.1 * slope
        assert slope > 5 * error


def test_the_duration_is_a_whole_number_of_steps():
    once = timestepping.run_blocks(PAPER, 1, 0, 1, 1.0, 0.5)
    assert np.array_equal(once, timestepping.run_blocks(PAPER, 1, 0, 1, 1.1, 0.5))
    assert timestepping.run_blocks(PAPER, 1, 0, 1, 1e-9, 0.5)[-1] >= 0
