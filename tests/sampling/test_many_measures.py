"""Monte Carlo of N discs by insertion: the exact numbers, honest errors, the same bits."""

import itertools

import numpy as np
import pytest

from twodiscs.model.checks import InputError
from twodiscs.model.many import Gas
from twodiscs.sampling.many import measures
from twodiscs.theory.many import exact

GASES = [
    Gas(2, 1.5, 1.0, 0.2),
    Gas(3, 1.5, 1.0, 0.15),
    Gas(3, 1.5, 1.0, 0.25),
    Gas(3, 1.0, 1.5, 0.28),
    Gas(4, 1.6, 0.6, 0.18),
    Gas(8, 3.5, 0.6, 0.18),
    Gas(5, 0.6, 2.5, 0.18),
]


@pytest.mark.parametrize("gas", GASES, ids=repr)
def test_volume_and_areas_are_exact(gas):
    """Five sigma of each."""
    found, errors = measures.sample(gas, 200_000, 2)
    for value, error, true in zip(found, errors, exact.measures(gas), strict=True):
        assert abs(value - true) <= 5 * error
        assert error > 0 or true == 0


@pytest.mark.parametrize(
    "gas",
    [Gas(4, 1.5, 1.0, 0.12), Gas(4, 1.5, 1.0, 0.12, "x"), Gas(3, 1.2, 1.0, 0.25, "x")],
    ids=repr,
)
def test_the_volume_is_that_of_rejection(gas):
    """Five sigma of both, where there is no exact value; with the images of a ring."""
    rng, n = np.random.default_rng(3), 200_000
    x = gas.range_x * rng.random((gas.discs, n))
    y = gas.range_y * rng.random((gas.discs, n))
    free = np.ones(n, bool)
    for i, j in itertools.combinations(range(gas.discs), 2):
        dx = np.abs(x[i] - x[j])
        dx = np.minimum(dx, gas.width - dx) if gas.periodic else dx
        free &= dx**2 + (y[i] - y[j]) ** 2 >= gas.contact_distance**2
    found, errors = measures.sample(gas, 100_000, 4)
    rejected = np.log(free.mean()) + gas.discs * np.log(gas.range_x * gas.range_y)
    error = np.sqrt((1 - free.mean()) / free.mean() / n)
    assert abs(found.log_volume - rejected) < 5 * np.hypot(error, errors.log_volume)


@pytest.mark.parametrize("gas", [GASES[1], GASES[6]], ids=repr)
def test_errors_are_those_of_repetitions(gas):
    """The spread of 200 estimates over the mean error: within five standard errors of it.

    In a channel most of a ratio to the volume is known from their covariance.
    """
    many = [
        measures.estimate(gas, *measures.run_blocks(gas, 5, k, k + 1), measures.BLOCK)
        for k in range(200)
    ]
    values = np.array([value for value, _ in many])
    errors = np.array([error for _, error in many])
    spread, error = values.std(axis=0, ddof=1), np.sqrt((errors**2).mean(axis=0))
    ratio = spread[error > 0] / error[error > 0]
    assert np.all(spread[error == 0] == 0)
    assert np.all(np.abs(ratio - 1) < 5 / np.sqrt(2 * 199))


def test_where_a_draw_fits_once_in_a_million():
    """And the error is still a few per cent."""
    gas = Gas(3, 1.5, 1.0, 0.28)
    free = np.exp(exact.measures(gas).log_volume) / (gas.range_x * gas.range_y) ** 3
    assert free < 1e-4
    found, errors = measures.sample(gas, 2_000_000, 1)
    assert errors.log_volume < 0.05
    assert abs(found.log_volume - exact.measures(gas).log_volume) < 5 * errors.log_volume


def test_shards_add_up():
    gas = GASES[4]
    whole = measures.run_blocks(gas, 7, 0, 5)
    parts = [measures.run_blocks(gas, 7, a, b) for a, b in ((0, 1), (1, 4), (4, 5))]
    for one, *pieces in zip(whole, *parts, strict=True):
        assert one.dtype == np.int64
        assert np.array_equal(one, sum(pieces))


def test_no_room_is_a_sentence():
    gas = Gas(16, 1.5, 1.0, 0.13)
    with pytest.raises(InputError, match="none had room for 16 discs"):
        measures.sample(gas, 1000, 1)
