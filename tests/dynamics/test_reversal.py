"""Reversed velocities retrace the path, for as many events as the Lyapunov exponent allows."""

import math
from itertools import islice

import numpy as np
import pytest

from twodiscs.dynamics.law import Law, law_of
from twodiscs.dynamics.trajectory import follow
from twodiscs.model.box import Box
from twodiscs.model.scene import Scene
from twodiscs.sampling.starts import state_in, states
from twodiscs_paper.studies.stability import measure as stability


@pytest.mark.parametrize("sides", [(1.5, 1.0), (3.0, 1.0), (1e-3, 1.3e-3)])
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


@pytest.mark.parametrize("radius", [0.05, 0.2, 0.24, 0.3, 0.38])
def test_the_same_events_in_reverse_order(radius):
    """Walls and collisions one by one: none is missed or added on the way back."""
    scene, number = Scene(1.5, 1.0, radius), 30
    law, starts = law_of(scene), states(scene, 5, 9)
    for i in range(5):
        out, back, state = [], [], state_in(starts, i)
        for _ in range(number):
            state, _, code = stability.advance(state, law)
            out.append(code)
        state = stability.turned_back(state)
        for _ in range(number):
            state, _, code = stability.advance(state, law)
            back.append(code)
        assert back == out[::-1]


def test_hops_are_retraced_too():
    scene = Scene(1.5, 1.0, 0.2)
    start = state_in(states(scene, 1, 4), 0)
    out = list(islice(follow(scene, start, 8.0), 60))
    end = out[-1]
    assert end[5] == "end"
    state, elapsed = start, 0.0
    law = law_of(scene)
    while True:
        after, time, _ = stability.advance(state, law)
        if elapsed + time > 8.0:
            break
        state, elapsed = after, elapsed + time
    back = list(follow(scene, (*end[1:5], *(-v for v in state[4:])), 8.0))
    assert [row[5] for row in back[1:-1]] == [row[5] for row in out[1:-1]][::-1]
    assert np.allclose(back[-1][1:5], start[:4], atol=1e-7, rtol=0)


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
    """Discs that hit opposite walls at once: for the neighbour the other one comes first."""
    state = np.array([[-0.4], [0.0], [0.4], [0.0], [-0.5], [0.0], [0.5], [0.0]])
    assert math.isnan(stability.growth(state, 0, 10, 1e-9, Law(0.55, 0.3, 0.4))[0])
