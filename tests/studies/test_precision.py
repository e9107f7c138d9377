"""The same law in another precision: the engine's own bits in double, and where single fails."""

import math

import numpy as np
import pytest

from twodiscs.dynamics import counting, ensemble, law
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene
from twodiscs.theory import exact
from twodiscs_paper.studies.accuracy_cost import precision, scalar

PAPER = Scene(1.5, 1.0, 0.2)

#: The indices of the engine's counts of the events that single precision counts.
AT = [EVENTS.index(event) for event in scalar.COUNTED]


@pytest.mark.parametrize("radius", [0.05, 0.2, 0.26, 0.38])
def test_in_double_precision_it_is_the_engine(radius):
    scene = PAPER.with_radius(radius)
    duration = counting.replica_duration(scene)
    sums, mean, error = precision.run_blocks(scene, 3, 1, 3, duration, np.float64)
    assert np.array_equal(sums, counting.run_blocks(scene, EVENTS, 3, 1, 3, duration)[0][AT])
    # Some 1e3 events, each of which may lose a rounding or two.
    assert abs(mean) < error < 1e3 * 2**-52


def test_the_law_itself_stays_double():
    names = precision.law_in(np.float32)
    assert names["RESTING_SPEED"] == 4 * 2.0**-23
    assert law.RESTING_SPEED == 4 * 2.0**-52
    assert names["next_event"] is not law.next_event
    assert names["DISC"].dtype == np.float32
    assert set(names) >= {name for name in vars(law) if name[0] != "_"}
    third = np.float32(1) / np.float32(3)
    gap, speed = names["wall_quotient"](third, np.float32(1), np.float32(0.5))
    assert gap == np.float32(0.5) - third
    assert law.wall_quotient(1 / 3, 1.0, 0.5) == (0.5 - 1 / 3, 1.0)
    assert speed == 1


@pytest.mark.parametrize("radius", [0.01, 0.2, 0.26, 0.3, 0.376, 0.38])
def test_single_precision_has_the_exact_rates_where_there_is_room(radius):
    """Five sigma; errors of single precision are some 1e-6 of a rate here."""
    scene = PAPER.with_radius(radius)
    duration, blocks = counting.replica_duration(scene), 8
    counts, _, energy = precision.run_blocks(scene, 1, 0, blocks, duration)
    double, products = counting.run_blocks(scene, EVENTS, 1, 0, blocks, duration)
    noise = ensemble.relative_errors(double, products, blocks * ensemble.REPLICAS)
    for event, e, count in zip(scalar.COUNTED, AT, counts, strict=True):
        if not scene.is_possible(event):
            assert count == 0
        elif double[e] >= 1000:
            expected = scene.multiplicity(event) / exact.mean_times(scene)[event] * duration
            expected *= blocks * ensemble.REPLICAS
            assert abs(count / expected - 1) < 5 * noise[e], event
    assert 1e-8 < energy < 1e-5


def test_single_precision_goes_wrong_where_there_is_no_room():
    scene = PAPER.with_radius(PAPER.largest_radius * (1 - 1e-6))
    duration, blocks = counting.replica_duration(scene), 8
    expected = exact.rate(scene, "disc_collision") * duration * blocks * ensemble.REPLICAS
    double, products = counting.run_blocks(scene, EVENTS, 1, 0, blocks, duration)
    noise = ensemble.relative_errors(double, products, blocks * ensemble.REPLICAS)
    noise = noise[counting.COLLISIONS]
    single = precision.run_blocks(scene, 1, 0, blocks, duration)[0]
    assert abs(double[counting.COLLISIONS] / expected - 1) < 5 * noise
    assert abs(single[scalar.COLLISIONS] / expected - 1) > 10 * noise


@pytest.mark.parametrize("room", [1e-3, 1e-5, 3e-7])
def test_single_precision_always_ends(room):
    scene = PAPER.with_radius(PAPER.largest_radius * (1 - room))
    counts = precision.run_blocks(scene, 2, 0, 1, counting.replica_duration(scene))[0]
    assert counts[-1] > 0


def test_energy_drifts_as_a_random_walk():
    """Over 64 times the events eightfold; the ratio of sums over 1e3 replicas is within 20 %."""
    duration = counting.replica_duration(PAPER)
    short = precision.run_blocks(PAPER, 1, 0, 1, duration)[2]
    long = precision.run_blocks(PAPER, 1, 0, 1, 64 * duration)[2]
    assert math.isclose(long / short, 8, rel_tol=0.2)


@pytest.mark.parametrize(
    "wrong",
    [
        {"scene": None},
        {"seed": -1},
        {"stop": 0},
        {"duration": 0.0},
        {"dtype": np.float16},
        {"dtype": None},
    ],
)
def test_bad_requests_are_refused(wrong):
    right = {"scene": PAPER, "seed": 1, "first": 0, "stop": 1, "duration": 1.0}
    with pytest.raises(ValueError, match="must"):
        precision.run_blocks(**right | wrong)
