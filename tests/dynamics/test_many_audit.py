"""Long runs of N discs: energy, gaps and ranges hold, and nothing stands still."""

import math

import numpy as np
import pytest

from twodiscs.dynamics.ensemble import LANES
from twodiscs.dynamics.many import lockstep as many
from twodiscs.model.scene import Scene
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.many import initial

#: |E − 1/2| after 1e9 events over 64 lanes, and roundings of the box that an overlap may be.
ENERGY_BOUND, GAP_BOUND = 1e-11, 1e-14

GASES = {
    "three": Scene(1.5, 1.0, 0.15, discs=3),
    "four": Scene(1.5, 1.0, 0.12, discs=4),
    "hardly fit": Scene(1.5, 1.0, 0.3005102, discs=3),
    "tiny": Scene(1.5, 1.0, 1e-9, discs=5),
    "dense channel": Scene(2.24, 0.6, 0.18, discs=8),
    "ring": Scene(1.5, 1.0, 0.2, discs=4, periodic="x"),
    "many": Scene(3.0, 2.0, 0.15, discs=16),
}


@compiled
def audit(states, passes, law):
    """Follow the columns of ``states`` for a number of passes of one event each.

    Returns the smallest square of a distance, the largest |x| and |y|, the largest energy
    error, the shortest time of a lane, and the largest momentum along x.
    """
    n, lanes = states.shape[0] // 4, states.shape[1]
    x, y = states[:n].copy(), states[n : 2 * n].copy()
    u, v = states[2 * n : 3 * n].copy(), states[3 * n :].copy()
    old_x, old_y = np.zeros((n, lanes)), np.zeros((n, lanes))
    remaining, times = np.full(lanes, 1e300), np.zeros(lanes)
    codes, speeds, total = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    counts = np.zeros((many.N, lanes))
    nearest, far_x, far_y, worst, drift = 1e300, 0.0, 0.0, 0.0, 0.0
    for step in range(passes):
        many.find_events(x, y, u, v, remaining, times, codes, speeds, law)
        many.advance(x, y, u, v, old_x, old_y, remaining, times, codes, counts, law, True)
        for l in range(lanes):
            total[l] += times[l]
            remaining[l] = 1e300
        # Positions at events are what may go wrong; looking at every one would take too long.
        if step % 61 < 2:
            for l in range(lanes):
                energy, momentum = 0.0, 0.0
                for i in range(n):
                    energy += u[i, l] * u[i, l] + v[i, l] * v[i, l]
                    momentum += u[i, l]
                    far_x, far_y = max(far_x, abs(x[i, l])), max(far_y, abs(y[i, l]))
                    for j in range(i):
                        dx, dy = many.nearest(x[i, l] - x[j, l], law.ring), y[i, l] - y[j, l]
                        nearest = min(nearest, dx * dx + dy * dy)
                worst, drift = max(worst, abs(energy - 1.0) / 2), max(drift, abs(momentum))
    return nearest, far_x, far_y, worst, np.min(total), drift


def check(scene, events):
    """All bounds, for a number of ``events``."""
    states = initial.states(scene, LANES, 1)
    law = many.law_of(scene)
    nearest, far_x, far_y, worst, shortest, drift = audit(states, events // LANES, law)
    box = max(scene.width, scene.height)
    assert np.sqrt(nearest) - scene.contact_distance >= -GAP_BOUND * box
    assert far_x <= (scene.range_x / 2 if not scene.periodic else scene.width / 2 * (1 + 1e-15))
    assert far_y <= scene.range_y / 2
    assert worst <= ENERGY_BOUND
    # No lane is stuck: as many events of an ideal gas of one direction would take longer.
    assert shortest > 0
    if scene.periodic:
        assert drift < 1e-10
    return shortest / (events / LANES)


@pytest.mark.parametrize("name", GASES)
def test_everything_is_conserved(name):
    check(GASES[name], 1_000_000)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["three", "four"])
def test_everything_is_conserved_over_a_billion_events(name):
    check(GASES[name], 10**9)


def test_a_disc_at_rest_and_discs_that_touch():
    """Contact is a matter of direction: touching discs that approach collide now, others do not."""
    law = many.law_of(Scene(10.0, 10.0, 0.5, discs=3))
    x = np.array([[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]])
    y = np.zeros((3, 2))
    u = np.array([[0.6, -0.6], [0.0, 0.0], [0.0, 0.0]])
    v = np.array([[0.0, 0.0], [0.0, 0.0], [0.8, 0.8]])
    old_x, old_y = np.zeros((3, 2)), np.zeros((3, 2))
    times, codes, speeds, counts = np.zeros(2), np.zeros(2), np.zeros(2), np.zeros((many.N, 2))
    remaining = np.full(2, 100.0)
    many.find_events(x, y, u, v, remaining, times, codes, speeds, law)
    assert times[0] == 0.0
    assert codes.tolist() == [7.0, 6.0]
    assert times[1] == pytest.approx(4.5 / 0.8)
    many.advance(x, y, u, v, old_x, old_y, remaining, times, codes, counts, law, True)
    assert (u[0, 0], u[1, 0]) == (0.0, 0.6)
    assert counts[:, 0].tolist() == [0.0, 0.0, 1.0, 0.0, 0.0]
    assert counts[:, 1].tolist() == [0.0, 0.0, 0.0, 0.0, 1.0]
    assert y[2, 1] == law.half_y


@pytest.mark.parametrize(("width", "discs"), [(1.0, 3), (3.0, 8)])
def test_a_flight_on_a_ring_ends_before_a_third_image_comes_near(width, discs):
    """The largest relative speed is √2, and half the ring is the most between two looks."""
    law = many.law_of(Scene(width, 1.0, 0.1, discs=discs, periodic="x"))
    fastest = math.sqrt(2)
    assert law.ring[2] * fastest == pytest.approx(width / 2, rel=1e-15)
    # Two discs side by side, in opposite directions: they look again, then meet the next image.
    x, y = np.zeros((discs, 1)), np.linspace(-0.35, 0.35, discs)[:, None].copy()
    u, v = np.zeros((discs, 1)), np.zeros((discs, 1))
    u[0], u[1] = 1 / fastest, -1 / fastest
    left, times, codes, speeds = np.full(1, np.inf), np.zeros(1), np.zeros(1), np.zeros(1)
    many.find_events(x, y, u, v, left, times, codes, speeds, law)
    assert times[0] * fastest <= width / 2 * (1 + 1e-15)
