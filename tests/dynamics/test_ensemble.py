"""What the experiments with the ensemble share."""

import numpy as np
import pytest
from effect_scenes import SCENES

from twodiscs.dynamics import ensemble
from twodiscs.dynamics.law import law_of
from twodiscs.model.scene import Scene


@pytest.mark.parametrize(
    ("value", "power"),
    [(1.0, 1.0), (1.41, 1.0), (1.42, 2.0), (3.0, 4.0), (0.7, 0.5), (0.71, 1.0), (1e-9, 2.0**-30)],
)
def test_the_nearest_power_of_two_is_so_on_a_logarithmic_scale(value, power):
    assert ensemble.nearest_power_of_two(value) == power


@pytest.mark.parametrize(
    ("scene", "components"),
    [(Scene(1.5, 1.0, 0.2), 8), (SCENES["rough"], 10), (SCENES["balls"], 12)],
)
def test_a_lane_holds_the_whole_state_and_nothing_else(scene, components):
    law = law_of(scene)
    rows = ensemble.new_rows(3, law)
    state = tuple(np.arange(1.0, components + 1))
    ensemble.put_state(rows, 1, state, law)
    assert ensemble.state_at(rows, 1, law) == state
    assert ensemble.state_at(rows, 0, law) == ensemble.state_at(rows, 2, law) == (0.0,) * components
