"""Monte Carlo of the volume and all areas of N discs, by discs that are inserted one at a time.

The height of each disc is uniform. Its x is then uniform in the length ℓ that the discs before it
leave free at this height. The weight W_k = Π ℓ_i/A of the first k discs corrects for the choice
(Rosenbluth and Rosenbluth, J. Chem. Phys. 23, 356 (1955)): V = (AB)^N ⟨W_N⟩ without bias. The last
disc is then tried on each surface, in place of any of the N discs:

    ∂V/∂A            (N/2) (AB)^(N−1) B ⟨W_(N−1) [free on the right + free on the left]⟩
    −∂V/∂σ           N(N − 1)/2 (AB)^(N−1) 2πσ ⟨W_(N−1) [free where it touches a disc]⟩
    Σ ∫δ(x_i − x_j)  N(N − 1)/2 (AB)^(N−1) B ⟨W_(N−1) [free at the x of a disc]⟩

with random heights, directions and discs; ∂V/∂B and hops in y likewise. A sample adds an integer to
each sum: its weight in units of 2^(−20) typical weights, rounded up or down randomly. Sums are
therefore unbiased integers, the same on every machine.
"""

import math
from typing import NamedTuple

import numpy as np

from twodiscs.model.checks import MOST_DISCS_WITH_VOLUME, InputError
from twodiscs.model.events import SHELL_EVENTS, by_kind
from twodiscs.model.many_geometry import has_volume
from twodiscs.points.monte_carlo_point import InsertionPoint
from twodiscs.sampling.conditioned import draw_in_disc
from twodiscs.sampling.jit import compiled, inlined, optional
from twodiscs.sampling.rounds import Sampler
from twodiscs.sampling.streams import next_bits, open_stream, signed_uniform, uniform
from twodiscs.sampling.threads import call_in_thread
from twodiscs.theory.equation_of_state import pair_overlap
from twodiscs.theory.flux import Derivatives

#: Samples with one random stream.
INSERTIONS_PER_BLOCK = 1 << 12

#: Units of a typical weight.
WEIGHT_UNITS = 2.0**20

#: The names of the sums: the volume and the fields of ``Derivatives`` after the logarithm.
SUM_NAMES = (
    "volume", "per_width", "per_height", "per_contact", "horizontal_hops", "vertical_hops",
)  # fmt: skip

#: The index of the sum of an event; both walls of an axis have the same one.
SUM_OF_EVENT = by_kind(
    "sampling/many/insertions.py",
    {
        "hop": lambda event: SUM_NAMES.index(f"{event.name}s"),
        "collision": lambda event: SUM_NAMES.index("per_contact"),
        "wall": lambda event: SUM_NAMES.index("per_width" if event.axis == "x" else "per_height"),
    },
    SHELL_EVENTS,
)

#: The index of the sum of each quantity of a point, in the order of the sums.
SUM_OF_QUANTITY = {"volume": 0} | {
    f"{event}_area": SUM_OF_EVENT[event] for event in sorted(SUM_OF_EVENT, key=SUM_OF_EVENT.get)
}


class Bounds(NamedTuple):
    """The constants of a scene: half-ranges, σ, periods (None between walls), typical weight."""

    half_x: float
    half_y: float
    sigma: float
    ring_x: float | None
    ring_y: float | None
    typical: float


@optional(lambda dx, ring: dx)
def ring_separation(dx, ring):
    """Return the separation to the nearest image along a periodic axis."""
    dx -= ring if dx > ring / 2 else 0.0
    dx += ring if dx < -ring / 2 else 0.0
    return dx


def _put_between(starts, ends, n, low, high, half, ring):
    starts[n], ends[n] = max(low, -half), min(high, half)
    return n + 1


@optional(_put_between)
def put_interval(starts, ends, n, low, high, half, ring):
    """Add the blocked interval from ``low`` to ``high``, on a ring as two across ±``half``."""
    starts[n], ends[n] = max(low, -half), min(high, half)
    n += 1
    if low < -half:
        starts[n], ends[n] = low + ring, half
        n += 1
    if high > half:
        starts[n], ends[n] = -half, high - ring
        n += 1
    return n


@compiled
def free_place(state, centres, k, y, box, starts, ends):
    """Return (free length at height ``y`` beside the first ``k`` discs, a random x in it)."""
    n = 0
    for j in range(k):
        dy = ring_separation(y - centres[1, j], box.ring_y)
        square = (box.sigma - dy) * (box.sigma + dy)
        if square > 0.0:
            d, x = math.sqrt(square), centres[0, j]
            n = put_interval(starts, ends, n, x - d, x + d, box.half_x, box.ring_x)
    # Sort the short list by starts.
    for i in range(1, n):
        low, high, j = starts[i], ends[i], i
        while j > 0 and starts[j - 1] > low:
            starts[j], ends[j] = starts[j - 1], ends[j - 1]
            j -= 1
        starts[j], ends[j] = low, high
    free, reached = 0.0, -box.half_x
    for i in range(n):
        free += max(starts[i] - reached, 0.0)
        reached = max(reached, ends[i])
    free += box.half_x - reached
    left, reached = free * uniform(state), -box.half_x
    for i in range(n):
        gap = max(starts[i] - reached, 0.0)
        if left < gap:
            return free, reached + left
        left -= gap
        reached = max(reached, ends[i])
    return free, min(reached + left, box.half_x)


@inlined
def is_free(centres, k, x, y, box, but):
    """Return whether a disc at (x, y) is in the box without overlap of the first ``k`` discs.

    Disc ``but`` is ignored.
    """
    if (abs(x) > box.half_x) | (abs(y) > box.half_y):
        return False
    for j in range(k):
        dx = ring_separation(x - centres[0, j], box.ring_x)
        dy = ring_separation(y - centres[1, j], box.ring_y)
        if j != but and dx * dx + dy * dy < box.sigma * box.sigma:
            return False
    return True


def _free_at_walls(centres, k, x, y, opposite_x, opposite_y, box, ring):
    free = 1.0 if is_free(centres, k, x, y, box, -1) else 0.0
    return free + (1.0 if is_free(centres, k, opposite_x, opposite_y, box, -1) else 0.0)


@optional(_free_at_walls)
def free_at_walls(centres, k, x, y, opposite_x, opposite_y, box, ring):
    """Return at how many of two opposite points, which are on walls, a disc is free.

    Along a periodic axis there are no walls.
    """
    return 0.0


@compiled
def sample_blocks(seed, first, stop, discs, box):
    """Return (sums, products) of the samples of blocks ``first`` … ``stop`` − 1, int64.

    Sums (6) are in ``WEIGHT_UNITS`` of a typical weight, in the order of ``SUM_NAMES``. Products
    (6, 6), for errors, are Σ w_e w_f in the same units.
    """
    n = len(SUM_NAMES)
    centres = np.empty((2, discs))
    starts, ends = np.empty(3 * discs), np.empty(3 * discs)
    weights = np.zeros(n)
    sums, products = np.zeros(n, np.int64), np.zeros((n, n), np.int64)
    length, last = 2 * box.half_x, discs - 1
    for block in range(first, stop):
        state = open_stream(seed, block)
        for _ in range(INSERTIONS_PER_BLOCK):
            weight = 1.0 / box.typical
            for k in range(last):
                y = box.half_y * signed_uniform(state)
                free, x = free_place(state, centres, k, y, box, starts, ends)
                centres[0, k], centres[1, k] = x, y
                weight *= free / length
                if weight == 0.0:
                    break
            weights[:] = 0.0
            if weight > 0.0:
                x, y = box.half_x * signed_uniform(state), box.half_y * signed_uniform(state)
                free, _ = free_place(state, centres, last, y, box, starts, ends)
                weights[0] = free / length
                sides = box.half_x, y, -box.half_x, y
                weights[1] = free_at_walls(centres, last, *sides, box, box.ring_x) / 2
                top = x, box.half_y, x, -box.half_y
                weights[2] = free_at_walls(centres, last, *top, box, box.ring_y) / 2
                j = np.int64(next_bits(state) % np.uint64(last))
                p, q, square = draw_in_disc(state)
                scale = box.sigma / math.sqrt(square)
                at_x = ring_separation(centres[0, j] + p * scale, box.ring_x)
                at_y = ring_separation(centres[1, j] + q * scale, box.ring_y)
                touches = is_free(centres, last, at_x, at_y, box, j)
                weights[3] = 1.0 if touches else 0.0
                weights[4] = 1.0 if is_free(centres, last, centres[0, j], y, box, -1) else 0.0
                weights[5] = 1.0 if is_free(centres, last, x, centres[1, j], box, -1) else 0.0
            for e in range(n):
                weights[e] *= weight
                sums[e] += np.int64(weights[e] * WEIGHT_UNITS + uniform(state))
            for e in range(n):
                for f in range(e, n):
                    products[e, f] += np.int64(weights[e] * weights[f] * WEIGHT_UNITS)
    return sums, products


def make_bounds(scene):
    """Return the ``Bounds`` of a ``Scene``."""
    pairs = scene.discs * (scene.discs - 1) / 2
    # Rounded to a power of two: the same on every machine.
    typical = 2.0 ** round(pairs * math.log2(1 - pair_overlap(scene)))
    ranges = scene.range_x / 2, scene.range_y / 2
    return Bounds(*ranges, scene.contact_distance, *periods(scene), typical)


def periods(scene):
    """Return the periods of a ``Scene`` along x and y, None between walls."""
    return tuple(scene.side(axis) if axis in scene.periodic else None for axis in "xy")


def run_blocks(scene, seed, first, stop):
    """Return (sums, products) of the samples of a ``Scene``, integers that shards can add."""
    return sample_blocks(np.uint64(seed), first, stop, scene.discs, make_bounds(scene))


def free_fraction(scene):
    """Return the estimate of V/(AB)^N from the first block of the stream 0, maybe 0."""
    sums, _ = call_in_thread(run_blocks, scene, 0, 0, 1)
    return float(sums[0]) / WEIGHT_UNITS / INSERTIONS_PER_BLOCK * make_bounds(scene).typical


def estimate(scene, sums, products, samples):
    """Return (``Derivatives``, standard errors in the same form) from a number of ``samples``.

    Errors are linearly propagated: for ratios to the volume with their covariance, for ln V from
    the error of V. On a periodic axis the walls have 0.
    """
    n, a, b = scene.discs, scene.range_x, scene.range_y
    if sums[0] == 0:
        raise InputError(f"samples must be more than {samples}: in none of them {n} discs fit")
    unit = WEIGHT_UNITS * samples
    mean = np.asarray(sums) / unit
    # Only the upper triangle of the products is counted, and used.
    covariance = (np.asarray(products) / unit - np.outer(mean, mean)) / samples
    pairs = n * (n - 1) / 2
    factors = np.array(
        [n / a, n / b, pairs * 2 * math.pi * scene.contact_distance / (a * b), pairs / a, pairs / b]
    )
    ratios = mean[1:] / mean[0]
    spread = np.diag(covariance)[1:] - 2 * ratios * covariance[0, 1:] + ratios**2 * covariance[0, 0]
    errors = np.sqrt(np.maximum(spread, 0.0)) / mean[0]
    log_volume = n * math.log(a * b) + math.log(make_bounds(scene).typical) + math.log(mean[0])
    return (
        Derivatives(log_volume, *map(float, factors * ratios)),
        Derivatives(math.sqrt(max(covariance[0, 0], 0.0)) / mean[0], *map(float, factors * errors)),
    )


def sample(scene, samples, seed):
    """Return the ``estimate`` of a ``Scene`` from a number of ``samples``, in whole blocks."""
    blocks = -(-samples // INSERTIONS_PER_BLOCK)
    return estimate(
        scene, *call_in_thread(run_blocks, scene, seed, 0, blocks), blocks * INSERTIONS_PER_BLOCK
    )


# The pipeline -------------------------------------------------------------------------------------


def insertion_sampler(scene, quantities, shell, seed):
    """Return the ``Sampler`` of volume and areas of a ``Scene`` of more than two discs.

    Arguments are as in ``montecarlo.prism_sampler``; no shell is needed. A point is an
    ``InsertionPoint``. The area of all walls comes with those of the right and the top wall.
    """
    if scene.discs > MOST_DISCS_WITH_VOLUME:
        raise InputError(
            f"discs must be at most {MOST_DISCS_WITH_VOLUME} for Monte Carlo by insertion, not "
            f"{scene.discs}: almost every insertion of more discs has the weight 0"
        )
    if not has_volume(scene):
        unit = 2.0 ** round(math.log2(scene.range_x * scene.range_y) / 2)
        raise InputError(
            f"width and height must be in a unit of length in which a double holds the volume of "
            f"{scene.discs} discs, not {scene.width!r} and {scene.height!r}: divide all lengths by "
            f"{unit!r}"
        )
    wanted = {*quantities, "volume"}
    if "any_wall_area" in wanted:
        wanted |= {f"{event}_area" for event in ("right_wall", "top_wall") if event in scene.events}
    sampled = {name: k for name, k in SUM_OF_QUANTITY.items() if name in wanted}

    measures = _volume_and_areas(scene)
    constants = {
        "method": InsertionPoint.METHOD,
        "samples": INSERTIONS_PER_BLOCK,
        "unit": int(WEIGHT_UNITS),
        "quantities": {n: {"place": k, "measure": measures[k]} for n, k in sampled.items()},
    }

    def run(first, stop):
        return np.vstack(run_blocks(scene, seed, first, stop))

    # A disc takes about ten times as long as a sample of the prism of two discs.
    return Sampler(scene, INSERTIONS_PER_BLOCK, run, constants, 10.0 * scene.discs)


def _volume_and_areas(scene):
    """Return volume and areas for a mean weight of 1, in the order of ``SUM_NAMES``.

    Areas are those of ``theory.n_discs.surfaces``: of any pair, or of one disc at one wall.
    """
    a, b, n = scene.range_x, scene.range_y, scene.discs
    volume, pairs = (a * b) ** n * make_bounds(scene).typical, n * (n - 1) / 2
    level = math.sqrt(2) * pairs
    touching = level * 2 * math.pi * scene.contact_distance / (a * b)
    factors = (1.0, 1 / a, 1 / b, touching, level / a, level / b)
    return [volume * factor for factor in factors]


def expected(scene):
    """Return an estimate of the ``Derivatives`` of a ``Scene`` from a few blocks of the stream 0.

    It is the same on every machine, and None if the discs fit in no sample.
    """
    try:
        return sample(scene, 16 * INSERTIONS_PER_BLOCK, 0)[0]
    except InputError:
        return None
