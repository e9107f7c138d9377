"""The loop of two discs: its lanes, and an experiment of our own."""

import doctest

import numpy as np
import pytest
from effect_scenes import SCENES

from twodiscs.dynamics.law import law_of, next_event
from twodiscs.dynamics.two import follow
from twodiscs.model.scene import Scene
from twodiscs.sampling.starts import components, states


def test_the_worked_example_is_true():
    assert doctest.testmod(follow).attempted > 4
    assert doctest.testmod(follow).failed == 0


@pytest.mark.parametrize(
    ("scene", "components"),
    [(Scene(1.5, 1.0, 0.2), 8), (SCENES["rough"], 10), (SCENES["balls"], 12)],
)
def test_a_lane_holds_the_whole_state_and_nothing_else(scene, components):
    law = law_of(scene)
    rows = follow.new_rows(3, law)
    state = tuple(np.arange(1.0, components + 1))
    follow.put_state(rows, 1, state, law)
    assert follow.state_at(rows, 1, law) == state
    assert follow.state_at(rows, 0, law) == follow.state_at(rows, 2, law) == (0.0,) * components


#: Each takes seconds to compile; those that are not slow have all the effects.
LAWS = [Scene(1.5, 1.0, 0.2), SCENES["rough"], SCENES["torus"], SCENES["combination"]] + [
    pytest.param(SCENES[name], marks=pytest.mark.slow)
    for name in ("unequal", "channel", "field", "balls")
]


@pytest.mark.parametrize("scene", LAWS, ids=repr)
@pytest.mark.parametrize("remaining", [0.05, 1.0, np.inf])
def test_lanes_together_find_the_event_that_each_would_find_alone(scene, remaining):
    lanes, law = 37, law_of(scene)  # no multiple of the width of a vector
    rows = follow.new_rows(lanes, law)
    starts = states(scene, lanes, 3)[: len(components(scene))]
    for lane in range(lanes):
        follow.put_state(rows, lane, tuple(starts[:, lane]), law)
    times, codes = np.zeros(lanes), np.zeros(lanes)
    follow.find_events(rows, np.full(lanes, remaining), times, codes, law)
    alone = [next_event(tuple(start), remaining, law) for start in starts.T]
    assert [*zip(times.tolist(), codes.tolist(), strict=True)] == alone
    assert len(set(codes)) > (1 if remaining < 1 else 2)
