"""The limit ε → 0 of a neck with kicks: κ of smooth discs as a function of x = γ√(εσ).

In the limit the motions across are fast, so that between kicks the invariants ω_i = v_i λ are kept,
with λ = L(u)/ε = 1 + s² and s = u/√(2εσ). With √(εσ) as the unit of time, g = u̇/√2 changes by

    ds/dt = g,    dg/dt = 2 s ω²/λ³,    ω² = ω₁² + ω₂².

A kick draws (v₁, v₂, g, p) uniformly on the unit sphere; p moves the pair as a whole. A pair starts
at s = 0, weighted by the flux, and is followed in both directions of time until it is at |s| =
``OUTER_DISTANCE``. Its crossings of s = 0 are a cluster, as in ``hop_clusters``.
"""

import math

import numpy as np

from twodiscs.sampling.jit import compiled
from twodiscs.sampling.streams import exponential, open_stream, uniform

#: A pair that is so far outside comes back with a probability below 3e-4.
OUTER_DISTANCE = 12.0

#: The longest step of the integration over 1 + s²: with half of it κ is the same within 1e-4.
NECK_STEP = 0.04

#: Pairs in a block, which has a stream of random numbers; larger clusters count as the largest.
NECK_PAIRS, NECK_CLUSTER = 2**12, 2**14


@compiled
def crossings_outwards(x, g, square, stream):
    """Return how often a pair crosses s = 0 until it is outside.

    It starts at s = 0 at the speed ``g`` > 0, with ``square`` = ω².
    """
    s, found, ahead, left = 0.0, 0, True, exponential(stream) / x
    while abs(s) < OUTER_DISTANCE:
        step = min(NECK_STEP * (1.0 + s * s), left)
        # Half of the way, the change of g there, and the other half.
        s += g * step / 2
        room = 1.0 + s * s
        g += 2 * s * square / (room * room * room) * step
        s += g * step / 2
        if (s > 0.0) != ahead:
            found, ahead = found + 1, not ahead
        left -= step
        if left <= 0.0:
            left = exponential(stream) / x
            across = uniform(stream)
            g = math.sqrt(1.0 - across) * math.cos(2 * math.pi * uniform(stream))
            square = across * (1.0 + s * s) ** 2
    return found


@compiled
def cluster_sizes(x, seed, first, stop):
    """Return how many pairs of the blocks ``first`` … ``stop`` − 1 are in a cluster of n."""
    sizes = np.zeros(NECK_CLUSTER + 1, np.int64)
    for block in range(first, stop):
        stream = open_stream(seed, block)
        for _ in range(NECK_PAIRS):
            rest, cosine = uniform(stream) ** (2 / 3), uniform(stream)
            g, square = math.sqrt(1.0 - rest), rest * (1.0 - cosine * cosine)
            n = 1 + crossings_outwards(x, g, square, stream)
            n += crossings_outwards(x, g, square, stream)
            sizes[min(n, NECK_CLUSTER)] += 1
    return sizes
