"""Exact curves: near to every limit, and broken where they jump."""

from itertools import pairwise

import numpy as np
import pytest
from figure_cases import BOXES, PAPER

from twodiscs.figures import curves
from twodiscs.figures.curves import limits
from twodiscs.model.box import Box


@pytest.mark.parametrize("box", BOXES.values(), ids=BOXES)
def test_curves_approach_every_limit_from_both_sides(box):
    ends = [0, *(radius for radius, _ in limits(box))]
    for branch, (low, high) in zip(curves.branches(box), pairwise(ends), strict=True):
        assert (np.diff(branch) > 0).all()
        assert low < branch[0]
        assert branch[-1] < high
        assert branch[0] - low <= 1.01e-4 * (high - low)
        assert high - branch[-1] <= 1e-8 * high


def test_curves_break_where_times_jump():
    radii, exact = curves.exact_curves(PAPER)
    gaps = np.flatnonzero(np.isnan(radii))
    assert len(gaps) == 3
    for event, factors in (("right_wall", [2, 1]), ("top_wall", [1, 2]), ("any_wall", [1, 1])):
        times = exact[f"{event}_time"]
        assert np.isnan(times[gaps]).all()
        # The curves come within 1e-9 of the limits; near w/4 the times change fast.
        jumps = times[gaps[:2] - 1] / times[gaps[:2] + 1]
        np.testing.assert_allclose(jumps, factors, rtol=1e-5)
    impossible = radii > PAPER.height / 4
    assert np.isnan(exact["horizontal_hop_time"][impossible]).all()
    assert (exact["horizontal_hop_area"][impossible] == 0).all()


def test_limits_of_another_box_break_the_curves_too():
    """Those beyond the largest radius of this box are left out."""
    box = Box(1.5, 1.0, {"mass_ratio": 2.0})
    own, more = curves.branches(box), curves.branches(box, others=(0.1, 0.9))
    assert len(more) == len(own) + 1
    assert more[0][-1] < 0.1 < more[1][0]


@pytest.mark.parametrize("effects", [{}, {"field": 1.5}, {"periodic": "x"}])
def test_curves_have_no_corners(effects):
    """As drawn on a column, in points: no line turns by more than 20 degrees."""
    radii, exact = curves.exact_curves(Box(1.5, 1.0, effects))
    across = radii / np.nanmax(radii) * 200
    for name, values in exact.items():
        with np.errstate(divide="ignore", invalid="ignore"):
            up = np.log(np.where(values > 0, values, np.nan)) * 30  # five units fill the height
        steps = np.diff(across + 1j * up)
        pairs = np.abs(steps) > 1
        pairs = pairs[1:] & pairs[:-1]
        turns = np.degrees(np.abs(np.angle(steps[1:][pairs] / steps[:-1][pairs])))
        assert np.nanmax(turns, initial=0) < 20, name
