"""Brownian dynamics of two discs in a narrow channel.

Without these tests Brownian steps or their κ could be wrong.

Comparisons are held to five standard errors: false alarms in fewer than one of a million each.
"""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import norm

from twodiscs_paper.studies.passages import brownian as study
from twodiscs_paper.studies.passages.models import brownian_steps

# Laws that can be solved ------------------------------------------------------------------------


def test_volume_resistance_and_first_passage_are_integrals_of_the_density():
    for room in (0.3, 2.0**-10):

        def density(u, room=room):
            return (1 + room - math.sqrt(max(1 - u * u, 0.0)) * (abs(u) < 1)) ** 2

        volume, _ = quad(density, 0, study.HALF, points=[1.0])
        assert study.side_volume(room) == pytest.approx(volume, rel=1e-8)
        flow, _ = quad(
            lambda u: 1 / density(u), -study.HALF, study.HALF,
            points=[-1, -math.sqrt(room), 0, math.sqrt(room), 1], limit=200,
        )  # fmt: skip
        assert study.resistance(room) == pytest.approx(flow, rel=1e-7)
        time, _ = quad(
            lambda u: quad(density, u, study.HALF, points=[1.0])[0] / density(u), 0, study.HALF,
            points=[math.sqrt(room), 1], limit=200,
        )  # fmt: skip
        assert study.first_passage(0.1, room) == pytest.approx(100 * time, rel=1e-6)


def times_of_a_walk(length):
    """Return the mean numbers of steps of a walk from H to the first u < 0, and to u ≤ −H.

    Steps are normal with the standard deviation ``length``, and reflected at u = H.
    """
    half, nodes = study.HALF, 400
    x, weights = np.polynomial.legendre.leggauss(nodes)

    def solve(end):
        at = (half + end) / 2 + (half - end) / 2 * x
        weight = (half - end) / 2 * weights

        def kernel(u):
            return norm.pdf(at, u, length) + norm.pdf(2 * half - at, u, length)

        matrix = np.array([kernel(u) for u in at]) * weight
        times = np.linalg.solve(np.eye(nodes) - matrix, np.ones(nodes))
        return 1 + float((kernel(half) * weight) @ times)

    return solve(0.0), solve(-half)


@pytest.mark.parametrize("program", ["reflected", "together", "singly"])
def test_first_passages_in_a_wide_channel_are_those_of_a_random_walk(program):
    """The discs meet on one side of a million: the channel is 2^20 high."""
    step = 0.25
    counts = study.passage_counts(3, program, step, -20, 4000)
    length = step if program == "singly" else math.sqrt(2) * step
    for name, due in zip(("first", "passage"), times_of_a_walk(length), strict=True):
        total, square = counts[name]
        error = math.sqrt((square / 4000 - (total / 4000) ** 2) / 4000)
        assert abs(total / 4000 - due) < 5 * error, (name, total / 4000, due)


# The motion -------------------------------------------------------------------------------------


@pytest.mark.parametrize("program", study.PROGRAMS)
def test_positions_stay_uniform(program):
    """Steps keep the means of functions of the positions, if states are drawn uniformly."""
    stream, room, number = np.random.default_rng(6), 0.2, 20_000
    states = np.zeros((4 * number, 7))
    states[:, 0] = study.HALF * (2 * stream.random(4 * number) - 1)
    states[:, 1:3] = (1 + room) * stream.random((4 * number, 2))
    states = states[states[:, 0] ** 2 + (states[:, 1] - states[:, 2]) ** 2 >= 1][:number]
    before = states.copy()
    bits = brownian_steps.open_stream(np.uint64(7), 0)
    for state in states:
        for _ in range(8):
            brownian_steps.advance(state, study.PROGRAMS[program], 0.15, study.HALF, 1 + room, bits)
    for value in (
        lambda s: s[:, 0] ** 2, lambda s: s[:, 1], lambda s: s[:, 1] * s[:, 2],
        lambda s: abs(s[:, 0]) < 0.3, lambda s: abs(s[:, 1] - s[:, 2]),
    ):  # fmt: skip
        change = value(states).astype(float) - value(before)
        assert abs(change.mean()) < 5 * change.std() / math.sqrt(len(change))


# Two ways to each number ------------------------------------------------------------------------


@pytest.mark.parametrize("program", study.PROGRAMS)
def test_both_methods_agree(program):
    """Pairs start far apart, or at a crossing that is followed in both directions of time.

    Reflected discs cross at the exact rate.
    """
    point = {"program": program, "step": 0.125, "halvings": 3}
    near, far = (
        estimated(point, count(1, program, 0.125, 3, samples))
        for (count, estimated), samples in zip(study.METHODS.values(), (2**13, 1000), strict=True)
    )
    for quantity, one in near.items():
        other = far[quantity]
        off = abs(one.value - other.value) / math.hypot(one.stderr, other.stderr)
        assert off < 5, (quantity, one, other)
    rate = far["crossing_rate"]
    assert program != "reflected" or abs(rate.value - 1) < 5 * rate.stderr < 0.2


def test_clusters_hold_each_crossing_once():
    counts = study.crossing_counts(1, "reflected", 0.125, 4, 100)
    assert sum(number for _, number in counts["sizes"]) == 2 * brownian_steps.STEP_CROSSINGS
    assert counts["tried"] == 2 * brownian_steps.STEP_CROSSINGS  # none is rejected
    assert study.crossing_counts(2, "reflected", 0.125, 4, 100) != counts
