"""Reversed velocities retrace the path: the same events in reverse order."""

from itertools import islice

import numpy as np
import pytest

from twodiscs.dynamics.law import law_of
from twodiscs.dynamics.trajectory import events_of
from twodiscs.dynamics.two.path import advance
from twodiscs.model.scene import Scene
from twodiscs.sampling.starts import state_in, states


@pytest.mark.parametrize("radius", [0.05, 0.2, 0.24, 0.3, 0.38])
def test_the_same_events_in_reverse_order(radius):
    """Walls and collisions one by one: none is missed or added on the way back."""
    scene, number = Scene(1.5, 1.0, radius), 30
    law, starts = law_of(scene), states(scene, 5, 9)
    for i in range(5):
        out, back, state = [], [], state_in(starts, i)
        for _ in range(number):
            state, _, code = advance(state, law)
            out.append(code)
        state = (*state[:4], *(-v for v in state[4:]))
        for _ in range(number):
            state, _, code = advance(state, law)
            back.append(code)
        assert back == out[::-1]


def test_hops_are_retraced_too():
    scene = Scene(1.5, 1.0, 0.2)
    start = state_in(states(scene, 1, 4), 0)
    out = list(islice(events_of(scene, start, 8.0), 60))
    end = out[-1]
    assert end[1] == "end"
    state, elapsed = start, 0.0
    law = law_of(scene)
    while True:
        after, time, _ = advance(state, law)
        if elapsed + time > 8.0:
            break
        state, elapsed = after, elapsed + time
    back = list(events_of(scene, (*end[4][:4], *(-v for v in state[4:])), 8.0))
    assert [row[1] for row in back[1:-1]] == [row[1] for row in out[1:-1]][::-1]
    assert np.allclose(back[-1][4][:4], start[:4], atol=1e-7, rtol=0)
