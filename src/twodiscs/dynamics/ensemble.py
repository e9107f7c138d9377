"""The ensemble: many independent trajectories, their sizes, and the kicks that friction gives them.

Trajectories start from streams of random numbers keyed by block, and their sums are integers, or
taken in the order of the initial states. A result therefore depends on the scene, the seed and the
blocks, not on lanes, processors or shards.

Friction draws all velocities anew in kicks. They come at the times of a Poisson process, so that
the time to the next one does not depend on the past. A kick leaves the invariant measure as it is,
and it satisfies detailed balance with reversed velocities. The past of a state is therefore the
future of the reversed state. The kicks in its past and in its future are independent.

A kick ends a flight, as the end of time does. Each replica has its own stream of random numbers,
keyed by its number. The seeds of jobs are below 2⁶³, and the seeds of kicks above. Without friction
the kicks are None, and nothing is compiled. The constants of the law are the same with and without
friction.
"""

import math
from typing import NamedTuple

import numpy as np

from twodiscs.sampling.jit import compiled, optional
from twodiscs.sampling.streams import exponential, open_stream

#: Trajectories that a kernel advances in lock step.
LANES = 64

#: Sweeps, each of one event for every lane, between two searches for lanes that have ended. There
#: are fewer if paths are short.
SWEEPS, SHORT_SWEEPS = 8, 2

#: Replicas with one random stream.
REPLICAS = 1024

#: Successive intervals between hops that a chain records.
CHAIN_HOPS = 256

#: Hops with one random stream, of which each is followed.
HOPS_PER_BLOCK = 64

#: The most events of a run that has no error to reach: hours to days.
MOST_RUN_EVENTS = 10**11

#: The bit that makes the seed of kicks of the seed of a job.
KICK_SEED_BIT = np.uint64(1 << 63)


def nearest_power_of_two(value):
    """Return the power of two next to ``value`` > 0 on a logarithmic scale.

    Durations and bin widths come from the exact theory, whose last digit may depend on the math
    library. The power of two is the same on every machine.
    """
    mantissa, exponent = math.frexp(value)
    return math.ldexp(1.0, exponent if mantissa > math.sqrt(0.5) else exponent - 1)


@optional(lambda time, width, last, edges: min(np.int64(time / width), last))
def find_bin(time, width, last, edges):
    """Return the number of the bin with a ``time``: of one ``width`` or between ``edges``.

    A time outside of all bins has the number ``last``.
    """
    return (np.searchsorted(edges, time, side="right") - 1) % edges.size


# Kicks ------------------------------------------------------------------------------------------


class Kicks(NamedTuple):
    """The rate of kicks, and for each lane the time to the next one and its stream.

    ``stream``, ``direction`` and ``velocity`` are working memory. ``sampler`` is the
    ``law.KickSampler`` of two discs, None of more.
    """

    rate: float
    waits: np.ndarray  # (lanes,)
    streams: np.ndarray  # (lanes, 4), uint64
    stream: np.ndarray
    direction: np.ndarray
    velocity: np.ndarray
    sampler: tuple | None = None


def idle_kicks(scene, lanes, direction, velocity, sampler=None):
    """Return the ``Kicks`` of some ``lanes``, which ``open_kicks`` begins; None without friction.

    The last arguments are the memory and the constants with which velocities are drawn.
    """
    if not scene.friction:
        return None
    waits, streams = np.full(lanes, np.inf), np.zeros((lanes, 4), np.uint64)
    stream = np.zeros(4, np.uint64)
    return Kicks(scene.friction, waits, streams, stream, direction, velocity, sampler)


@optional(lambda i, seed, replica, kicks: None)
def open_kicks(i, seed, replica, kicks):
    """Begin the kicks of a ``replica`` of the streams of ``seed`` (uint64) in lane ``i``."""
    stream = open_stream(seed ^ KICK_SEED_BIT, replica)
    for k in range(stream.size):
        kicks.streams[i, k] = stream[k]
    kicks.waits[i] = exponential(kicks.streams[i]) / kicks.rate


@optional(lambda i, kicks: None)
def renew_kicks(i, kicks):
    """Draw the time to the next kick in lane ``i`` anew: another path begins with its replica."""
    kicks.waits[i] = exponential(kicks.streams[i]) / kicks.rate


@optional(lambda remaining, i, kicks: remaining)
def kick_limit(remaining, i, kicks):
    """Return the ``remaining`` time of lane ``i``, or the time to its next kick if it is less."""
    wait = kicks.waits[i]
    return remaining if remaining < wait else wait


@compiled
def open_all(seed, first, kicks):
    """Begin the kicks of the replicas from the ``first`` on, one a lane."""
    for i in range(kicks.waits.size):
        open_kicks(i, seed, first + i, kicks)


def open_block_kicks(kicks, seed, first=0):
    """Return ``kicks`` (None stays None), begun for the replicas from the ``first`` on."""
    if kicks is not None:
        open_all(np.uint64(seed), first, kicks)
    return kicks
