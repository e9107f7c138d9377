"""Two spheres in a cylindrical pore: exact times, and the motion that is compared with them.

Without these tests the volume, areas, or passages of spheres in a pore could be wrong.
"""

import math

import mpmath as mp
import numpy as np
import pytest

from twodiscs_paper.studies.passages.models import pore


@pytest.mark.parametrize("size", [(3.0, 1.0, 0.2), (1.2, 1.0, 0.45), (2.5, 1.0, 0.6)])
def test_volume_and_areas_are_those_of_disc_line_picking(size):
    """V from the distribution of the distance of two points of a disc, areas by derivatives."""

    def volume(a, b, sigma):
        def part(z):
            s = mp.sqrt(max(sigma**2 - z * z, 0)) / b
            if s >= 2:
                return mp.mpf(0)
            cosine, root = mp.acos(s / 2), mp.sqrt(1 - s * s / 4)
            below = 1 + 2 * (s * s - 1) * cosine / mp.pi - s * (1 + s * s / 2) * root / mp.pi
            return (a - z) * (mp.pi * b * b) ** 2 * (1 - below)

        kinks = {mp.mpf(0), mp.sqrt(max(sigma**2 - 4 * b * b, 0)), min(a, sigma), a}
        return 2 * mp.quad(part, sorted(kinks))

    model = pore.Pore.of(*size)
    (a, b, sigma), (found, areas) = model, pore.volume_and_areas(model)
    with mp.workdps(20):
        here = [mp.mpf(x) for x in model]
        due = volume(*here)
        collision = -mp.sqrt(2) * mp.diff(volume, here, (0, 0, 1))
        end, side = (mp.diff(volume, here, n) / 2 for n in ((1, 0, 0), (0, 1, 0)))
    expected = [*map(float, (due, collision, end, side))]
    assert [found, *areas[1:]] == pytest.approx(expected, rel=1e-9)
    total = 2 * a * areas[2] + 2 * b * areas[3] - sigma * areas[1] / math.sqrt(2)
    assert total == pytest.approx(6 * found, rel=1e-14)


@pytest.mark.parametrize("room", [1e-2, 1e-5, 1e-9])
def test_hops_have_the_law_of_the_threshold(room):
    """τ → 225 V/(512√2 A B^(3/2) ε^(5/2)), with a correction of the order of ε."""
    model = pore.Pore.of(3.0, 1.0, (2 - room) / 4)
    (a, b, sigma), (volume, _) = model, pore.volume_and_areas(model)
    law = 225 * volume / (512 * math.sqrt(2) * a * b**1.5 * (2 * b - sigma) ** 2.5)
    assert 1 / pore.rates(model)[pore.HOP] == pytest.approx(law, rel=room)
    blocked, _ = pore.volume_and_areas(pore.Pore.of(3.0, 1.0, (2 + room) / 4))
    assert blocked == pytest.approx(volume, rel=30 * room)


def test_crossings_are_drawn_evenly():
    """Means of positions at a crossing, against those of pairs of points of a disc; five errors."""
    model, stream, q = pore.Pore.of(3.0, 1.0, 0.45), np.random.default_rng(1), np.zeros((2, 3))
    points, drawn = model.breadth * (2 * stream.random((2, 2, 10**6)) - 1), np.zeros((2, 2, 20_000))
    kept = (np.sum(points**2, axis=1) < model.breadth**2).all(axis=0)
    kept &= np.sum((points[0] - points[1]) ** 2, axis=0) >= model.sigma**2
    bits = pore.open_stream(np.uint64(2), 0)
    for k in range(drawn.shape[2]):
        pore.draw_crossing(q, model, bits)
        drawn[:, :, k] = q[:, :2]
    for i, j, k, m in ((0, 0, 0, 0), (1, 1, 1, 1), (0, 0, 1, 0), (0, 0, 1, 1)):
        found, due = (of[i, j] * of[k, m] for of in (drawn, points[:, :, kept]))
        error = math.hypot(found.std() / found.size**0.5, due.std() / due.size**0.5)
        assert abs(found.mean() - due.mean()) < 5 * error
