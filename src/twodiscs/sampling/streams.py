"""Random numbers that are the same on every machine: one stream for each block of work.

The generator is xoshiro256++ (Blackman and Vigna, ACM Trans. Math. Softw. 47, 36 (2021)).
SplitMix64 fills its state from the seed of the stream and the number of the block. A block
therefore has the same numbers in every process and order, and a shard of the work is a range of
blocks.
"""

import numpy as np

from twodiscs.sampling.jit import compiled

GOLDEN = np.uint64(0x9E3779B97F4A7C15)
MIX_1 = np.uint64(0xBF58476D1CE4E5B9)
MIX_2 = np.uint64(0x94D049BB133111EB)
UNIT = 2.0**-53


@compiled
def splitmix(counter):
    """Return the SplitMix64 output for ``counter``, a uint64 that steps by ``GOLDEN``."""
    z = (counter ^ (counter >> np.uint64(30))) * MIX_1
    z = (z ^ (z >> np.uint64(27))) * MIX_2
    return z ^ (z >> np.uint64(31))


@compiled
def open_stream(seed, block):
    """Return the state, 4 uint64, of the stream of ``seed`` (uint64) for ``block`` (≥ 0)."""
    state = np.empty(4, np.uint64)
    counter = splitmix(np.uint64(seed) + GOLDEN) ^ splitmix(np.uint64(block) * MIX_2 + MIX_1)
    for i in range(4):
        counter += GOLDEN
        state[i] = splitmix(counter)
    return state


@compiled
def next_bits(state):
    """Return 64 random bits as uint64 and step ``state`` (4 uint64) in place."""
    s0, s1, s2, s3 = state[0], state[1], state[2], state[3]
    total = s0 + s3
    bits = ((total << np.uint64(23)) | (total >> np.uint64(41))) + s0
    s2 ^= s0
    s3 ^= s1
    state[1] = s1 ^ s2
    state[0] = s0 ^ s3
    state[2] = s2 ^ (s1 << np.uint64(17))
    state[3] = (s3 << np.uint64(45)) | (s3 >> np.uint64(19))
    return bits


@compiled
def uniform(state):
    """Return a random double in [0, 1), a multiple of 2⁻⁵³."""
    return np.float64(next_bits(state) >> np.uint64(11)) * UNIT


@compiled
def signed_uniform(state):
    """Return a random double in [−1, 1)."""
    return 2.0 * uniform(state) - 1.0


@compiled
def exponential(state):
    """Return a random number with the density e⁻ˣ, by comparisons of uniform ones alone.

    A run u₁ > u₂ > … > uₙ of uniform numbers that descend has an odd length n with the probability
    e^(−u₁) for given u₁. After each run of even length 1 is added (von Neumann, 1951).
    """
    whole = 0.0
    while True:
        first = uniform(state)
        last, odd = first, True
        while True:
            value = uniform(state)
            if value >= last:
                break
            last, odd = value, not odd
        if odd:
            return whole + first
        whole += 1.0


@compiled
def draw_largest(state, n):
    """Return the largest of ``n`` uniform numbers: its density is n sⁿ⁻¹ on [0, 1)."""
    largest = uniform(state)
    for _ in range(n - 1):
        largest = max(largest, uniform(state))
    return largest
