"""Without these tests the usual engine or the time-stepping one could count something else."""

import numpy as np
import pytest

from twodiscs.dynamics import runs
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene
from twodiscs.sampling.separations import separation_sampler
from twodiscs.sampling.starts import draw_starts
from twodiscs.sampling.streams import open_stream
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


@pytest.mark.parametrize("radius", [0.05, 0.2, 0.24, 0.3, 0.38])
def test_the_scalar_engine_counts_the_same(radius):
    """Written with branches and divisions, the same law has the same counts, replica for replica.

    Chaos would turn a difference in the last bit into other counts after some tens of events.
    """
    scene = PAPER.with_radius(radius)
    duration = runs.engine_of(scene).replica_duration(scene)
    arguments = (duration, scene.contact_distance, separation_sampler(scene), (0, 0))
    usual = scalar.count_blocks(np.uint64(3), 0, 1, 1024, *arguments)
    sums, products = runs.engine_of(scene).run_blocks(scene, EVENTS, 3, 0, 1, duration)[:2]
    at = [EVENTS.index(event) for event in scalar.COUNTED]
    np.testing.assert_array_equal(usual[0], sums[at])
    np.testing.assert_array_equal(usual[1], products[np.ix_(at, at)])
