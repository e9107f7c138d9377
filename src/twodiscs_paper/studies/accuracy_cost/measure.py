"""The cost of accuracy: the true error of each method against the processor time that it takes.

A method runs block after block, each with its own random numbers. The blocks of a run, joined in
pairs again and again, are independent runs of 1, 2, 4, … blocks, so one run has the root mean
square of the true error, against the exact value, at all these times. The part ``error`` of
accuracy_cost.csv has it. Independent samples have the error √(c/t) after the time t: c is the
variance of a block times its time, and holds for every error above the floor of the method.

The part ``radius`` has c at many distances from the radius at which the horizontal hop is blocked.
"""

import math
import time
from collections.abc import Callable
from functools import cache, partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from mpmath import mp

import twodiscs
from twodiscs.dynamics.ensemble import LANES, REPLICAS
from twodiscs.dynamics.two import event_counts, strip, two_rates
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene
from twodiscs.points.estimates import stratified_mean
from twodiscs.sampling import montecarlo
from twodiscs.sampling.conditioned import conditioned_sampler
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.streams import open_stream, signed_uniform
from twodiscs.theory import exact, plain
from twodiscs.theory.quadrature import gauss_legendre
from twodiscs_paper.reference import DIGITS, MpScene, disc_collision_area, volume
from twodiscs_paper.studies.accuracy_cost import scalar, timestepping
from twodiscs_paper.study import row

#: The hop of all mean times, and the relative distance of the hard radius from where it is blocked.
TIMED_HOP, HARD_DISTANCE = "horizontal_hop", 1e-4
EASY_SCENE = Scene(1.5, 1.0, 0.2)
HARD_SCENE = EASY_SCENE.with_radius(EASY_SCENE.threshold(TIMED_HOP) * (1 - HARD_DISTANCE))

AREA = "disc_collision_area"

#: Time steps, and fractions for ``montecarlo.shell_thickness``: a thick shell, and the usual one.
TIME_STEPS = (2.0**-4, 2.0**-6, 2.0**-7)
SHELL_SIZES = (0.3, 0.02)

#: Replicas of a block of the methods for comparison, samples of a block on the surface.
FEW_REPLICAS, ON_SURFACE = 64, 1 << 16

#: Relative distances from the radius where the hop is blocked at which c is measured.
HARD_DISTANCES = (0.6, 0.2, 0.05, 1e-2, 1e-4, 1e-6)

#: Calls of methods that are deterministic and take microseconds, and the nodes of quadrature.
CALLS, COST_NODES = 100, range(1, 17)

#: Larger errors are left out. A power is fitted to errors above this multiple of the floor, of at
#: least this number of runs.
PRICED_ERROR, ABOVE_FLOOR, FEWEST_RUNS = 0.5, 3.0, 16

#: The most blocks of a method in a build.
MOST_BLOCKS = 1 << 14


class Method(NamedTuple):
    """A method that measures a ``quantity`` of a ``scene`` in blocks.

    ``block(i)`` returns the sums of block i, an array, and ``estimate(sums, blocks)`` the estimate
    over its exact value from the sums of some ``blocks``. ``bias`` is the relative error that stays
    if it is known exactly. ``setting`` is ε of a shell, Δt of time steps, T of a strip, or None.
    """

    name: str
    quantity: str
    scene: Scene
    block: Callable
    estimate: Callable
    bias: float | None = 0.0
    setting: float | None = None


# Mean times: each method estimates the rate of the hop --------------------------------------------


def _by_counts(name, scene, events, replicas, block, **more):
    """Return the ``Method`` whose ``block`` counts ``events`` of a number of ``replicas``."""
    hop = events.index(TIMED_HOP)
    expected = exact.rate(scene, TIMED_HOP) * two_rates.replica_duration(scene) * replicas

    def estimate(sums, blocks):
        return sums[hop] / (blocks * expected)

    return Method(name, f"{TIMED_HOP}_time", scene, block, estimate, **more)


def lockstep_method(scene, seed, blocks=1):
    """Return the ``Method`` of the engine: all events, ``blocks`` blocks as one."""
    duration = two_rates.replica_duration(scene)

    def block(i):
        first, stop = i * blocks, (i + 1) * blocks
        return event_counts.run_blocks(scene, EVENTS, seed, first, stop, duration)[0]

    return _by_counts("lockstep", scene, EVENTS, blocks * REPLICAS, block)


def scalar_method(scene, seed):
    """Return the ``Method`` of one trajectory after the other."""
    given = FEW_REPLICAS, two_rates.replica_duration(scene), scene.contact_distance
    given += (conditioned_sampler(scene),)

    def block(i):
        return scalar.count_blocks(np.uint64(seed), i, i + 1, *given)[0]

    return _by_counts("scalar", scene, scalar.COUNTED, FEW_REPLICAS, block)


def steps_method(scene, seed, step):
    """Return the ``Method`` of looking for overlaps every ``step``, a power of two."""
    steps = round(two_rates.replica_duration(scene) / step)
    given = FEW_REPLICAS, LANES, steps, step, scene.contact_distance, conditioned_sampler(scene)

    def block(i):
        return timestepping.step_blocks(np.uint64(seed), i, i + 1, *given)

    more = {"bias": None, "setting": step}
    return _by_counts("time_step", scene, scalar.COUNTED, FEW_REPLICAS, block, **more)


def strip_method(scene, seed):
    """Return the ``Method`` of initial states in a strip next to the hop, eight blocks as one."""
    near = strip.choose_strip(scene, TIMED_HOP)
    fractions = strip.stratum_fractions(scene, TIMED_HOP, near)
    expected = exact.rate(scene, TIMED_HOP) * 2 * near.time / near.fraction

    def block(i):
        return strip.run_blocks(scene, TIMED_HOP, near, seed, 8 * i, 8 * (i + 1))[0]

    return Method(
        "strip", f"{TIMED_HOP}_time", scene, block,
        lambda sums, n: stratified_mean(fractions, *sums)[0] / expected, setting=near.time,
    )  # fmt: skip


# Volume and areas ---------------------------------------------------------------------------------


#: {method: function of a scene, quantities, the fraction of shells and a seed that samples}.
SAMPLERS_BY_NAME = {"rejection": montecarlo.prism_sampler, "conditioned": montecarlo.conditioned}


def samples_method(scene, seed, quantity, fraction=None, name="rejection"):
    """Return the ``Method`` of samples of the prism, or ``name``; only an area has a shell."""
    sampler = SAMPLERS_BY_NAME[name](scene, [quantity], fraction, seed)
    event = quantity.removesuffix("_area")
    true, thickness, bias = exact.volume(scene), None, 0.0
    if quantity != "volume":
        true, thickness = (
            exact.areas(scene)[event],
            montecarlo.shell_thickness(scene, event, fraction),
        )
        bias = exact.shell_expectation(scene, event, thickness) / true - 1
        name = "shell"

    def estimate(sums, blocks):
        point = sampler.point({(0, blocks): [sums]})
        found = point.quantities[quantity]
        return found.measure * found.hits / point.samples / true

    return Method(
        name, quantity, scene, lambda i: sampler.count(i, i + 1), estimate, bias, thickness
    )


@compiled
def surface_hits(seed, block, samples, half_x, half_y, sigma):
    """Place disc 1 anywhere and disc 2 at contact in a random direction; count pairs that fit."""
    state = open_stream(seed, block)
    hits = 0
    for _ in range(samples):
        x, y = half_x * signed_uniform(state), half_y * signed_uniform(state)
        p, q = signed_uniform(state), signed_uniform(state)
        square = p * p + q * q
        while square >= 1.0 or square == 0.0:
            p, q = signed_uniform(state), signed_uniform(state)
            square = p * p + q * q
        reach = sigma / math.sqrt(square)
        hits += (abs(x + reach * p) <= half_x) & (abs(y + reach * q) <= half_y)
    return hits


def surface_method(scene, seed):
    """Return the ``Method`` of samples on the surface of disc collisions itself.

    Disc 1 is anywhere in the box and disc 2 at contact: an area of A B · 2πσ · √2.
    """
    sides, sigma = (scene.range_x, scene.range_y), scene.contact_distance
    measure = 2 * math.pi * sigma * math.prod(sides) * math.sqrt(2)
    share = exact.areas(scene)["disc_collision"] / measure
    given = ON_SURFACE, *(side / 2 for side in sides), sigma

    def block(i):
        return np.array(surface_hits(np.uint64(seed), i, *given))

    return Method(
        "surface", AREA, scene, block, lambda hits, n: float(hits) / (n * ON_SURFACE * share)
    )


def methods(seed):
    """Return all methods that are measured, with random numbers of ``seed``."""
    return [
        lockstep_method(EASY_SCENE, seed),
        scalar_method(EASY_SCENE, seed),
        *(steps_method(EASY_SCENE, seed, step) for step in TIME_STEPS),
        strip_method(HARD_SCENE, seed),
        lockstep_method(HARD_SCENE, seed, blocks=4),
        samples_method(EASY_SCENE, seed, "volume"),
        samples_method(EASY_SCENE, seed, "volume", name="conditioned"),
        *(samples_method(EASY_SCENE, seed, AREA, fraction) for fraction in SHELL_SIZES),
        surface_method(EASY_SCENE, seed),
        samples_method(HARD_SCENE, seed, "volume"),
        samples_method(HARD_SCENE, seed, AREA, SHELL_SIZES[-1]),
    ]


# Exact values -------------------------------------------------------------------------------------


@compiled
def arc_sums(range_x, range_y, sigma, nodes, weights):
    """Return (volume, area of disc collisions) by a rule on [0, 1], in plain doubles."""
    start = math.acos(min(range_x / sigma, 1.0))
    turn = math.asin(min(range_y / sigma, 1.0)) - start
    beyond_y = max(range_y - sigma, 0.0)
    volume, disc = range_x * range_x * beyond_y * beyond_y, 0.0
    for i in range(nodes.size):
        angle = start + turn * nodes[i]
        cos = math.cos(angle)
        x, y = range_x - sigma * cos, range_y - sigma * math.sin(angle)
        area = 2.0 * turn * weights[i] * sigma * x * y
        disc += area
        volume += area * x * cos
    return volume, 2.0 * math.sqrt(2.0) * disc


@cache
def rule(order):
    """Return (nodes, weights) of the Gauss–Legendre rule on [0, 1] as arrays."""
    nodes, _, weights = zip(*gauss_legendre(order), strict=True)
    return np.array(nodes), np.array(weights)


def quadrature(scene, nodes):
    """Return {quantity: value} of the volume and the area by a Gauss rule along the arc."""
    sides = scene.range_x, scene.range_y, scene.contact_distance
    return dict(zip(("volume", AREA), arc_sums(*sides, *rule(nodes)), strict=True))


def evaluated(scene):
    """Return {quantity: value} of the exact theory, without its cache of recent scenes."""
    plain.volume_and_areas.cache_clear()
    return {"volume": exact.volume(scene), AREA: exact.areas(scene)["disc_collision"]}


def reference(scene):
    """Return {quantity: value} of the volume and the area of disc collisions to fifty digits."""
    q = MpScene.of(scene.width, scene.height, scene.radius)
    return {"volume": volume(q), AREA: disc_collision_area(q)}


def exact_rows():
    """Yield the rows of quadrature and of the exact evaluation at both radii."""
    works = [("quadrature", partial(quadrature, nodes=n), n) for n in COST_NODES]
    works.append(("exact", evaluated, None))
    for scene in (EASY_SCENE, HARD_SCENE):
        true = reference(scene)
        for name, work, nodes in works:
            work(scene)
            start = time.process_time()
            for _ in range(CALLS):
                found = work(scene)
            seconds = (time.process_time() - start) / CALLS
            for quantity, value in found.items():
                with mp.workdps(DIGITS):
                    error = abs(float(value / true[quantity] - 1))
                cells = {"setting": nodes, "seconds": seconds, "error": error}
                yield cost_row(scene, "exact", quantity, name, **cells)


# True errors over time ----------------------------------------------------------------------------


def measured(method, seconds, most):
    """Return (sums, seconds) of the blocks of a ``Method``: two at least, ``most`` at most.

    No block begins after this processor time in ``seconds``.
    """
    method.block(most)  # compiles
    sums, times = [], []
    clock = time.process_time
    end = clock() + seconds
    while len(sums) < most and (len(sums) < 2 or clock() < end):
        start = clock()
        sums.append(method.block(len(sums)))
        times.append(clock() - start)
    return np.array(sums), np.array(times)


def doublings(method, sums):
    """Yield (blocks, true relative errors) of the independent runs of 1, 2, 4, … blocks."""
    blocks = 1
    while len(sums):
        yield blocks, np.array([method.estimate(one, blocks) - 1 for one in sums])
        pairs = len(sums) // 2
        sums = sums[: 2 * pairs : 2] + sums[1 : 2 * pairs : 2]
        blocks *= 2


def root_mean_square(errors):
    """Return the root mean square of ``errors``."""
    return math.sqrt(np.mean(errors**2))


def power(joined, floor):
    """Return the power of the time with which errors fall, and its standard error, or (None, None).

    ``joined`` are {blocks: errors}. If two runs with errors a and b are joined, the square of the
    error is Σ(a² + b² + 2ab)/4. The power is −1/2 if runs are independent, and the size of the
    products gives the error. The result is the weighted mean over all doublings with enough runs,
    and with errors well above the ``floor``.
    """
    powers, errors = [], []
    for short, long in pairwise(joined.values()):
        if len(long) < FEWEST_RUNS or root_mean_square(long) <= ABOVE_FLOOR * floor:
            break
        before = short[: 2 * len(long)]
        if root_mean_square(before) > PRICED_ERROR:
            continue  # of rare counts, whose products are too few
        products = 2 * before[::2] * before[1::2]
        powers.append(math.log2(root_mean_square(long) / root_mean_square(before)))
        errors.append(math.sqrt(np.sum(products**2)) / np.sum(before**2) / math.log(4))
    if not powers:
        return None, None
    weights = 1 / np.square(errors)
    return float(np.average(powers, weights=weights)), float(weights.sum() ** -0.5)


def error_rows(method, seconds, most, **cells):
    """Yield the rows of a ``Method``: its true error at 1, 2, 4, … blocks."""
    sums, times = measured(method, seconds, most)
    joined, each = dict(doublings(method, sums)), float(times.mean())
    errors = joined[1]
    noise = float(errors.std(ddof=1))
    floor, floor_error = method.bias, 0.0
    if floor is None:
        floor, floor_error = float(errors.mean()), noise / math.sqrt(errors.size)
    # A floor within its noise counts as none.
    floor = abs(floor) if abs(floor) > 3 * floor_error else 0.0
    slope, slope_error = power(joined, floor)
    for blocks, errors in joined.items():
        error = root_mean_square(errors)
        if error <= PRICED_ERROR:
            yield cost_row(
                method.scene, "error", method.quantity, method.name,
                setting=method.setting, seconds=each * blocks, error=error,
                repetitions=errors.size, c=noise**2 * each, floor=floor,
                slope=slope, slope_stderr=slope_error, **cells,
            )  # fmt: skip


def cost_row(scene, part, quantity, method, **cells):
    """Return a row of accuracy_cost.csv."""
    box = {"width": scene.width, "height": scene.height, "radius": scene.radius}
    return row(box, part=part, quantity=quantity, method=method, **cells)


def long_run(seed, blocks):
    """Yield the rows of a long run: each method with this number of ``blocks``."""
    for method in methods(seed):
        yield from error_rows(method, math.inf, blocks)


def radius_rows():
    """Yield the rows of the part ``radius``: c of each quantity and method, by ``td.cost``."""
    for distance in HARD_DISTANCES:
        scene = EASY_SCENE.with_radius(EASY_SCENE.threshold(TIMED_HOP) * (1 - distance))
        for price in twodiscs.cost(scene).prices:
            if price.method != "exact":
                cells = {"distance": distance, "c": price.c, "floor": price.floor}
                yield cost_row(scene, "radius", price.quantity, price.method, **cells)


def rows(seconds, seed):
    """Yield the rows of accuracy_cost.csv, from about ``seconds`` for all methods together."""
    all_methods = methods(seed)
    for method in all_methods:
        yield from error_rows(method, seconds / len(all_methods), MOST_BLOCKS)
    yield from exact_rows()
    yield from radius_rows()
