"""The usual engine, an independent program: its counts equal those of kernels and slow motion."""

import numpy as np
import pytest

from twodiscs.dynamics import runs, trajectory
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene
from twodiscs.sampling.separations import separation_sampler
from twodiscs.sampling.starts import state_in, states
from twodiscs_paper.studies.accuracy_cost import scalar

PAPER = Scene(1.5, 1.0, 0.2)


@pytest.mark.parametrize("radius", [0.05, 0.2, 0.24, 0.3, 0.38])
def test_the_scalar_engine_counts_the_same(radius):
    """Written with branches and divisions, the same law has the same counts, replica for replica.

    Chaos would turn a difference in the last bit into other counts after some tens of events.
    """
    scene = PAPER.with_radius(radius)
    duration = runs.replica_duration(scene)
    arguments = (duration, scene.contact_distance, separation_sampler(scene), (0, 0))
    usual = scalar.count_blocks(np.uint64(3), 0, 1, 1024, *arguments)
    sums, products = runs.run_blocks(scene, EVENTS, 3, 0, 1, duration)[:2]
    at = [EVENTS.index(event) for event in scalar.COUNTED]
    np.testing.assert_array_equal(usual[0], sums[at])
    np.testing.assert_array_equal(usual[1], products[np.ix_(at, at)])


def test_following_one_trajectory_is_the_kernel_in_slow_motion():
    start = state_in(states(PAPER, 1, 5), 0)
    rows = list(trajectory.events_of(PAPER, start, 64.0))
    names = [row[1] for row in rows]
    times = [row[0] for row in rows]
    assert times == sorted(times)
    assert names[0] == "start"
    assert names[-1] == "end"
    assert times[-1] == pytest.approx(64.0)
    counts = scalar.count_replica(
        *start, 64.0, PAPER.range_x / 2, PAPER.range_y / 2, PAPER.contact_distance
    )
    for event in ("vertical_hop", "horizontal_hop", "disc_collision"):
        assert names.count(event) == counts[scalar.COUNTED.index(event)] > 0
    for row in rows:
        if row[1] == "vertical_hop":
            assert abs(row[4][1] - row[4][3]) < 1e-14
        if row[1] == "horizontal_hop":
            assert abs(row[4][0] - row[4][2]) < 1e-14
