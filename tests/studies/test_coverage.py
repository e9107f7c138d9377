"""The rows of coverage: the fraction of 95 % intervals that cover an exact value."""

import math

import pytest

from twodiscs.model.box import Box
from twodiscs.model.events import EVENTS
from twodiscs.theory.exact import mean_times
from twodiscs_paper.studies.stability import measure as stability

BOX = Box(1.5, 1.0)
RADII = (0.05, 0.2, 0.24, 0.3, 0.38)


@pytest.fixture(scope="module")
def covered():
    """{(radius, event): row} of 800 repetitions of a run of one block."""
    rows = list(stability.coverage_rows(BOX, seed=77))
    return {(row["radius"], row["quantity"]): row for row in rows}


@pytest.mark.slow
@pytest.mark.parametrize("radius", RADII)
def test_intervals_cover_the_exact_time_in_95_of_100(covered, radius):
    """800 repetitions know the coverage to 0.77 %: five standard errors are 3.9 %."""
    times = mean_times(BOX.scene(radius))
    for event in EVENTS:
        if times[event] is None:
            assert (radius, event) not in covered
        else:
            row = covered[radius, event]
            assert row["count"] == 800
            assert row["status"] == "counted"
            assert abs(row["value"] - 0.95) < 5 * math.sqrt(0.95 * 0.05 / 800), (radius, event)
            assert row["passed"]


def test_too_few_events_are_said_to_be_too_few(monkeypatch):
    """Just below h/4 one block sees hardly any horizontal hop: there is no interval to speak of."""
    monkeypatch.setattr(stability, "ordinary_radii", lambda box: [0.2499])
    rows = list(stability.coverage_rows(BOX, seed=7, repetitions=20))
    row = next(row for row in rows if row["quantity"] == "horizontal_hop")
    assert row["status"] == "too-few"
    assert row["value"] is None
    assert row["passed"] is None
