"""The rows of reversed paths: as many events as the Lyapunov exponent allows, and that exponent."""

import math

import numpy as np
import pytest

from twodiscs.dynamics.law import Law, law_of
from twodiscs.model.box import Box
from twodiscs.model.scene import Scene
from twodiscs.sampling.starts import states
from twodiscs_paper.studies.stability import measure as stability


@pytest.mark.parametrize("sides", [(1.5, 1.0), (1e-3, 1.3e-3)])
def test_events_retraced_are_those_the_exponent_allows(sides):
    """z within 5 for the exponents; the number within five binary digits of roundings."""
    box = Box(*sides)
    rows = list(stability.reversal_rows(box, seed=3))
    judged = [row for row in rows if row["passed"] is not None]
    assert len(judged) == 2 * len(stability.ordinary_radii(box))
    assert [row for row in judged if not row["passed"]] == []
    assert all(row["value"] > 0 for row in rows)


def test_nothing_is_said_where_paths_hardly_diverge():
    """In a box of 1e6 × 1e-6 the discs do not meet for millions of events."""
    rows = list(stability.reversal_rows(Box(1e6, 1e-6), seed=3))
    assert {row["status"] for row in rows} == {"long"}
    assert all(row["value"] is None and row["passed"] is None for row in rows)


def test_growth_does_not_depend_on_the_size_of_the_separation():
    """It is that of the tangent space: the same for separations of 1e-7, 1e-8 and 1e-9."""
    scene = Scene(1.5, 1.0, 0.2)
    law = law_of(scene)
    starts = states(scene, 50, 1)
    logs = [np.log(stability.growth(starts, 5, 20, size, law)) for size in (1e-7, 1e-8, 1e-9)]
    assert np.median(logs[1]) > 3
    for other in (logs[0], logs[2]):
        assert np.median(np.abs(other - logs[1])) < 1e-3


def test_growth_ends_where_the_events_differ():
    """Discs hit opposite walls simultaneously: for the neighbour the other one comes first."""
    state = np.array([[-0.4], [0.0], [0.4], [0.0], [-0.5], [0.0], [0.5], [0.0]])
    assert math.isnan(stability.growth(state, 0, 10, 1e-9, Law(0.55, 0.3, 0.4))[0])
