"""Long runs, scaled down: energy, gaps and ranges hold at every hard radius, no lane is lost."""

import math

import numpy as np
import pytest

from twodiscs.dynamics.law import law_of
from twodiscs.model.box import Box
from twodiscs.model.scene import Scene
from twodiscs_paper.studies.stability import measure as stability

BOXES = [
    (1.5, 1.0), (1.0, 1.0), (2.0, 1.0), (3.0, 1.0), (1.0, 1.5), (1.98, 1.0), (100.0, 1.0),
    (1e-6, 1e6), (1e6, 1e-6), (3e-5, 2e-5), (1e40, 1.5e40),
]  # fmt: skip

PAPER = Scene(1.5, 1.0, 0.2)


@pytest.mark.parametrize("sides", BOXES)
def test_everything_is_conserved_at_every_hard_radius(sides):
    box = Box(*sides)
    rows = list(stability.dynamics_rows(box, seed=5, ordinary=4_000_000, hard=2_000_000))
    assert len(rows) == 4 * len(stability.hard_radii(box))
    assert [row for row in rows if row["passed"] is not True] == []
    assert all(row["count"] >= 2_000_000 for row in rows)


@pytest.mark.parametrize("distance", [1e-10, 1e-11, 1e-12])
def test_closer_still_to_the_largest_radius(distance):
    """Even if each disc has only a few different doubles as coordinates, no energy is lost."""
    for box in (Box(1.5, 1.0), Box(1.0, 1.0), Box(3.0, 1.0)):
        seen = stability.run(box.scene(box.largest_radius * (1 - distance)), 1_000_000, 1)
        assert seen["lanes_lost"] == 0
        assert seen["energy_error"] <= stability.ENERGY_BOUND
        assert seen["smallest_gap"] >= stability.GAP_BOUND
        assert seen["excess"] <= stability.EXCESS_BOUND


def test_energy_error_grows_like_a_random_walk():
    """A drift would grow in proportion to the events, a walk like their square root.

    The exponent of a walk fluctuates; the largest of 64 lanes over a factor of 64 in the number of
    events grows by 8, and by 64 for a drift. Halfway, on a logarithmic scale, is 23.
    """
    short, long = (
        stability.run(PAPER, number, 2)["energy_error"] for number in (10**6, 64 * 10**6)
    )
    assert long / short < 23


def audited(starts, shortest=0.0, events=50):
    columns = np.array(starts, float).T.copy()
    return stability.audit(columns, 1, events, law_of(PAPER), shortest)


GOOD = (-0.4, 0.1, 0.4, -0.1, 0.6, 0.48, -0.64, 0.0)


def test_the_audit_sees_what_is_wrong():
    """Too much energy, discs that overlap and part, one beyond its range, one not a number."""
    fast = (*GOOD[:4], 0.6, 0.48, -0.64, 0.1)
    overlapping = (-0.1, 0.0, 0.1, 0.0, -0.001, 0.0, 0.001, math.sqrt(1 - 2e-6))
    outside = (0.551, 0.1, -0.4, -0.1, 0.0, 0.8, 0.0, 0.6)
    broken = (math.nan, *GOOD[1:])
    nearest, energy, far_x, _, lost = audited([GOOD, fast, overlapping, outside, broken])
    assert energy[0] <= 1e-15
    assert energy[1] == pytest.approx(0.01, rel=1e-9)
    assert nearest[0] >= 0.16 * (1 - 1e-15)
    assert nearest[2] < 0.15
    assert far_x[0] == 0.55
    assert far_x[3] == 0.551
    assert lost.tolist() == [False, False, False, False, True]


def test_the_audit_sees_lanes_that_do_not_advance():
    at_rest = (*GOOD[:4], 0.0, 0.0, 0.0, 0.0)
    assert audited([GOOD, at_rest])[4].tolist() == [False, True]
    # Both a sixth of a second for fifty events, which is not much to ask, and far too much.
    assert not audited([GOOD], shortest=1 / 6)[4][0]
    assert audited([GOOD], shortest=1000.0)[4][0]


def test_units_of_the_box():
    assert stability.box_units(PAPER) == (1.0, 1.0)
    assert stability.box_units(Scene(4.0, 3.9, 0.1)) == (4.0, 2.0)
    assert stability.box_units(Scene(1e-6, 1e6, 1e-7)) == (2.0**-20, 2.0**19)
