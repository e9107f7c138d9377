"""Streams of random numbers, and draws from them.

Without these tests two streams could be the same, or a draw have another law.
"""

import numpy as np
from sampling.uniformity import assert_uniform

from twodiscs.sampling import streams


def test_exponential_numbers():
    state = streams.open_stream(np.uint64(7), 0)
    values = np.array([streams.exponential(state) for _ in range(50_000)])
    assert_uniform(np.exp(-values))
    # They do not know of one another.
    assert abs(np.corrcoef(values[1:], values[:-1])[0, 1]) <= 5 / np.sqrt(values.size)


def test_streams_differ_by_seed_and_by_block():
    states = [tuple(streams.open_stream(np.uint64(s), b)) for s in range(40) for b in range(40)]
    assert len(set(states)) == len(states)
    bits = np.array(states, dtype=np.uint64).view(np.uint8)
    assert abs(np.unpackbits(bits).mean() - 0.5) <= 5 / (2 * np.sqrt(bits.size * 8))


def test_the_generators_are_those_of_their_authors():
    """First numbers of the reference implementations in C."""
    state = np.array([1, 2, 3, 4], np.uint64)
    assert [int(streams.next_bits(state)) for _ in range(5)] == [
        41943041, 58720359, 3588806011781223, 3591011842654386, 9228616714210784205
    ]  # fmt: skip
    with np.errstate(over="ignore"):
        counters = [np.uint64(1234567) + np.uint64(i) * streams.GOLDEN for i in (1, 2)]
    assert [int(streams.splitmix(counter)) for counter in counters] == [
        6457827717110365317, 3203168211198807973
    ]  # fmt: skip


def test_uniform_numbers_are_multiples_of_two_to_the_minus_53():
    state = streams.open_stream(np.uint64(1), 0)
    for low, draw in ((0, streams.uniform), (-1, streams.signed_uniform)):
        found = np.array([draw(state) for _ in range(1000)])
        assert_uniform((found - low) / (1 - low))
        assert np.array_equal(found * 2**53, np.round(found * 2**53))
    assert streams.uniform(np.array([0, 0, 0, 0], np.uint64)) == 0.0
