"""Sizes of ensembles and errors of counts, for two discs and for more.

An ensemble is many independent trajectories. They start from streams of random numbers keyed by
block, and their sums are integers, or taken in the order of the initial states. A result therefore
depends on the scene, the seed and the blocks, not on lanes, processors or shards.
"""

import math

import numpy as np

#: Trajectories that a kernel advances in lock step.
LANES = 64

#: Sweeps, each of one event for every lane, between two searches for lanes that have ended.
SWEEPS = 8

#: Replicas with one random stream.
REPLICAS = 1024

#: Successive intervals between hops that a chain records.
RETURNS = 256

#: Hops with one random stream, of which each is followed.
HOPS_OF_BLOCK = 64

#: Clusters of this many hops, or more, are in one class. It counts as even, which makes κ too small
#: by less than the fraction of hops in it over their number.
LARGEST = 2**13

#: The sums at each time after a hop: n = Σ s_0 s_k and n², N hops and N².
SUMS = 4


def nearest_power_of_two(value):
    """Return the power of two next to ``value`` > 0 on a logarithmic scale.

    Durations and bin widths come from the exact theory, whose last digit may depend on the math
    library. The power of two is the same on every machine.
    """
    mantissa, exponent = math.frexp(value)
    return math.ldexp(1.0, exponent if mantissa > math.sqrt(0.5) else exponent - 1)


def relative_errors(sums, products, replicas):
    """Return the relative standard error of each mean count (n), inf without a count.

    Replicas are independent, so the error is √(var N / R) / ⟨N⟩.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = sums / replicas
        variance = np.maximum(np.diag(products) / replicas - mean**2, 0.0)
        errors = np.sqrt(variance / replicas) / mean
    return np.where(sums > 0, errors, np.inf)
