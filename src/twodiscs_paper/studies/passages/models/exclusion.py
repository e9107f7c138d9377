"""Single file on a lattice: an exclusion process whose neighbours swap now and then.

On a ring of sites, half of them occupied, the two sites of every bond are exchanged at the rate 1,
but where both are occupied only with a probability p. Without swaps (p = 0) a tagged particle has
the mean square displacement F √t of a single file, F = (1 − ρ)/ρ · 2/√π at the density ρ (Arratia,
Ann. Probab. 11, 362 (1983)). With p = 1 it is a free random walk, D = 1. A particle swaps at the
exact rate ν = ρ p with its neighbour on either side, which moves it by ℓ = 1/ρ on average.

A swap changes the place of a particle in the order by one. The mean square of that number grows as
2 (D/ℓ²) t too. For rare swaps it has a far smaller error than the displacement, most of which is
the motion of whole regions.
"""

import math

import numpy as np

from twodiscs.model.checks import InputError, check_ascending, check_integer
from twodiscs.points.estimates import mean_of
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.streams import next_bits, open_stream, uniform

#: Occupied sites, and the exact factor of √t in the mean square displacement of a single file.
DENSITY = 0.5
SINGLE_FILE = (1 - DENSITY) / DENSITY * 2 / math.sqrt(math.pi)

#: Sites of a ring, a power of two: many more than a particle diffuses in the longest time.
SITES = 1024

#: The length of a run, in units of the time at which √t and t contribute equally; the shortest run;
#: the length of runs without swaps.
CROSSOVERS, SHORTEST, WITHOUT = 16, 64.0, 1024.0


@compiled
def exchange(seed, first, stop, sites, swap, times):
    """Return two mean squares on each of the rings ``first`` … ``stop`` − 1.

    They are of displacements, and of numbers of places in the order. Means are over all particles
    of a ring. The result has the shape (2, stop − first, times); ``times`` ascend and ``sites`` is
    a power of two.
    """
    squares = np.zeros((2, stop - first, times.size))
    mask = np.uint64(sites - 1)
    for ring in range(first, stop):
        state = open_stream(seed, ring)
        # The particle on a site, −1 for none: a shuffle draws the places.
        site = np.full(sites, -1)
        for i in range(sites // 2):
            site[i] = i
        for i in range(sites - 1, 0, -1):
            j = np.int64(uniform(state) * (i + 1))
            site[i], site[j] = site[j], site[i]
        moved, passed = np.zeros(sites // 2, np.int64), np.zeros(sites // 2, np.int64)
        done = 0
        for k in range(times.size):
            # The number of exchanges is fixed at its mean: it would fluctuate by 1/√(sites t).
            for _ in range(np.int64(times[k] * sites) - done):
                bits = next_bits(state)
                i = np.int64(bits & mask)
                j = np.int64((np.uint64(i) + np.uint64(1)) & mask)
                a, b = site[i], site[j]
                if a >= 0 and b >= 0:
                    if uniform(state) >= swap:
                        continue
                    passed[a] += 1
                    passed[b] -= 1
                site[i], site[j] = b, a
                if a >= 0:
                    moved[a] += 1
                if b >= 0:
                    moved[b] -= 1
            done = np.int64(times[k] * sites)
            squares[0, ring - first, k] = np.sum(moved * moved) / moved.size
            squares[1, ring - first, k] = np.sum(passed * passed) / moved.size
    return squares


def displacements(swap, times, rings, seed):
    """Return mean squares (2, rings, times) of tagged particles: displacements and places.

    Displacements are in sites, places are those in the order of the particles. ``swap`` is the
    probability p in [0, 1] that neighbours swap. ``times`` are in units of the mean time between
    exchanges of a bond. Raises ``InputError`` for numbers out of range.
    """
    if not 0 <= swap <= 1:
        raise InputError(f"swap must be a probability from 0 to 1, not {swap!r}")
    times, rings = np.array(check_ascending("times", times)), check_integer("rings", rings, 2)
    return exchange(np.uint64(check_integer("seed", seed, 0)), 0, rings, SITES, float(swap), times)


def run_time(swap):
    """Return the length of a run with ``swap`` > 0, a power of two.

    It is at least ``CROSSOVERS`` times t× = (F/2D)², where F √t = 2 D t, with D = ν ℓ².
    """
    crossover = (SINGLE_FILE / (2 * swap / DENSITY)) ** 2
    return 2.0 ** math.ceil(math.log2(max(SHORTEST, CROSSOVERS * crossover)))


def diffusion(swap, rings, seed):
    """Return D/(ν ℓ²) as an ``Estimate``, by the places of particles in their order.

    Their mean square is 2 (D/ℓ²) t, and a term ∝ √t in which the region of a particle moves against
    it. Its values at T and T/4 are combined so that √t cancels. Raises ``InputError`` unless
    0 < ``swap`` ≤ 1, and for numbers out of range.
    """
    if not 0 < swap <= 1:
        raise InputError(f"swap must be a probability above 0, not {swap!r}")
    time = run_time(swap)
    quarter, whole_time = displacements(swap, [time / 4, time], rings, seed)[1].T
    return mean_of((whole_time - 2 * quarter) / time / (swap * DENSITY))


def single_file(rings, seed):
    """Return F as an ``Estimate``: the mean square displacement without swaps, over √t."""
    (end,) = displacements(0.0, [WITHOUT], rings, seed)[0].T
    return mean_of(end / math.sqrt(WITHOUT))
