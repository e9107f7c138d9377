"""The limit of smooth discs at a threshold, and its constant c.

Without these tests the limit of smooth discs at a threshold, and so c, could be wrong.

Comparisons are held to five standard errors: false alarms in fewer than one of a million each.
"""

import math

import numpy as np
import pytest
from scipy.integrate import dblquad

from twodiscs.model.checks import InputError
from twodiscs_paper.studies.passages.models import limit


def test_reversed_velocities_retrace_the_motion():
    """From slacks uniform in the room at the separation 1/2, with normal velocities."""
    stream = np.random.default_rng(3)
    a, b = stream.random((2, 200))
    a, b = np.where(a + b > 1, 1 - a, a), np.where(a + b > 1, 1 - b, b)
    for start in np.array([a / 8, b / 8, *(8 * stream.normal(size=(2, 200)))]).T:
        state = start.copy()
        limit.fly(state, 0.5, 0.7, 3.0, math.inf)
        state[2:] *= -1
        limit.fly(state, 3.0, -0.7, 0.5, math.inf)
        state[2:] *= -1
        # Some dozen events; roundings grow by less than a factor of two in each.
        np.testing.assert_allclose(state, start, rtol=0, atol=1e-8)


def test_early_turns_pass_with_the_exact_probability():
    # With invariants kept for ever each pair with P² > 2 (w1² + w2²) passes, whenever it turns.
    def integrand(cosine, rest):
        total = math.sqrt(2 * rest) * cosine
        return 1.5 * math.sqrt(rest) * (1 + total / math.sqrt(2 - total**2))

    exact, _ = dblquad(integrand, 0, 1, math.sqrt(0.5), 1)
    found = limit.amplitude(24, 5, near=1e9)
    longest = limit.UNIFORM_TURNS * limit.FARTHEST_TURN
    assert abs(found.value / longest - exact) < 5 * found.stderr / longest


def test_c_does_not_depend_on_where_invariants_are_kept():
    early, late = limit.amplitude(24, 6, near=0.25), limit.amplitude(48, 7, near=0.45)
    assert abs(early.value - late.value) < 5 * math.hypot(early.stderr, late.stderr)


def test_one_block_has_no_error():
    with pytest.raises(InputError, match="values must be at least two"):
        limit.amplitude(1, 5)
