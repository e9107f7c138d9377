"""The cost of a digit: the true error of every method against the processor time that it takes.

The results are work-precision diagrams, as for solvers of differential equations. Each method runs
at several amounts of work, repeatedly with other random numbers, and its relative error against the
exact value is averaged over the repetitions. All methods take turns in one run on one core, so if
the machine slows down, all methods slow down.

The rows of accuracy_cost.csv have five parts:

    volume, area   estimates of the volume and of the area of disc collisions
    time           mean times of all events by dynamics
    floor          the error that no amount of work removes, against ε or Δt
    radius         time to a relative error of 1e-3 in each mean time, radius by radius
    speed          of the engine in lock step over that of one trajectory at a time
"""

import math
import time
from functools import cache, partial
from statistics import fmean, median, median_high, pstdev
from typing import NamedTuple

import numpy as np
from mpmath import mp
from tqdm import tqdm

from twodiscs.comparison.scene_tables import MeanTimes, Theory
from twodiscs.dynamics import runs
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.dynamics.runs import relative_errors
from twodiscs.dynamics.two import strip
from twodiscs.model.box import Box, radii
from twodiscs.model.events import EVENTS, HOPS
from twodiscs.model.scene import Scene
from twodiscs.points.estimates import LinearFit
from twodiscs.sampling import montecarlo
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.separations import draw_constants
from twodiscs.sampling.streams import open_stream, signed_uniform
from twodiscs.theory import exact, laws, plain
from twodiscs.theory.quadrature import gauss_legendre
from twodiscs_paper.reference import DIGITS, MpScene, disc_collision_area, volume
from twodiscs_paper.studies.accuracy_cost import scalar, timestepping
from twodiscs_paper.study import row

#: The box of all measurements, with a medium radius and with one near the largest radius.
SCENE = Scene(1.5, 1.0, 0.2)
TIGHT = SCENE.with_radius(0.38)

AREA = "disc_collision_area"

#: Fractions for ``montecarlo.shell_thickness``; blocks of replicas for each time step.
SHELLS = (0.3, 0.1, 0.03, 0.01)
STEPS = {2.0**-4: 8, 2.0**-6: 8, 2.0**-8: 4, 2.0**-10: 0.5, 2.0**-12: 0.125}

#: Repetitions with other random numbers; calls of deterministic methods, which take microseconds.
REPETITIONS = 16
CALLS = 100

#: Processor seconds that the amounts of work below take.
USUAL_SECONDS = 30.0

#: The relative error whose cost is measured radius by radius, the number of radii, the blocks of a
#: pilot, relative distances from a threshold, and the radii of runs to this error.
TARGET = 1e-3
RADII = 28
PILOT_BLOCKS = 32
CLOSE = (1e-3, 1e-4, 1e-6)
PAID = {"vertical_hop": (0.05, 0.2, 0.3), "horizontal_hop": (0.05, 0.15, 0.2, 0.245)}

#: The fewest counts whose error is taken from a pilot.
FEWEST = 1000


class Series(NamedTuple):
    """A method at several amounts of work.

    ``run(work, seed)`` returns ({quantity: estimate}, units of work done, calls of the method);
    ``setting(work)`` is ε, Δt or None.
    """

    part: str
    method: str
    scene: Scene
    works: tuple
    run: object
    setting: object


# Estimators ---------------------------------------------------------------------------------


def rejected(quantity, fraction, scene, samples, seed):
    """Estimate by rejection from the prism; ``fraction(samples)`` sets the shell's thickness."""
    shell = fraction(samples) or 0.5
    point = montecarlo.sample_point(scene, [quantity], samples, shell, seed)
    part = point.quantities[quantity]
    return {quantity: part.measure * part.hits / samples}, samples, 1


def conditioned(scene, samples, seed):
    """Estimate the volume by the conditioned sampler."""
    part = montecarlo.conditioned_point(scene, ["volume"], samples, 0.5, seed).quantities["volume"]
    return {"volume": part.measure * part.hits / samples}, samples, 1


@cache
def balanced_fraction(scene, samples):
    """Return the best fraction for the thickness of the collision shell with ``samples``.

    It minimizes bias² + variance, both exact: thin shells are rarely hit, thick shells have a bias.
    """
    area = exact.areas(scene)["disc_collision"]
    prism = (scene.range_x * scene.range_y) ** 2

    def error(fraction):
        epsilon = montecarlo.shell_thickness(scene, "disc_collision", fraction)
        expected = exact.shell_expectation(scene, "disc_collision", epsilon)
        variance = expected * (prism / epsilon - expected) / samples
        return (expected - area) ** 2 + variance

    fractions = [10 ** (k / 40) for k in range(-160, 0)]
    return min(fractions, key=error)


@compiled
def surface_hits(seed, samples, half_x, half_y, sigma):
    """Place disc 1 anywhere and disc 2 at contact in a random direction; count pairs that fit."""
    state = open_stream(seed, 0)
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


def surface_measure(scene):
    """Return the area of contact with disc 1 in the box and disc 2 anywhere: A B · 2πσ · √2."""
    return 2 * math.pi * scene.contact_distance * scene.range_x * scene.range_y * math.sqrt(2)


def on_surface(scene, samples, seed):
    """Estimate the area of disc collisions by samples on the surface itself."""
    hits = surface_hits(
        np.uint64(seed), samples, scene.range_x / 2, scene.range_y / 2, scene.contact_distance
    )
    return {AREA: surface_measure(scene) * hits / samples}, samples, 1


@compiled
def prism_hits(points, range_x, range_y, sigma):
    """Count the ``points`` (n, 4) of the unit cube that are allowed configurations."""
    hits = 0
    for i in range(points.shape[0]):
        u, v = (points[i, 0] - points[i, 1]) * range_x, (points[i, 2] - points[i, 3]) * range_y
        hits += u * u + v * v >= sigma * sigma
    return hits


@compiled
def contact_hits(points, range_x, range_y, sigma):
    """Count the ``points`` (n, 3) of the unit cube that put disc 2, at contact, into the box."""
    hits = 0
    for i in range(points.shape[0]):
        angle = 2.0 * math.pi * points[i, 2]
        x = points[i, 0] * range_x + sigma * math.cos(angle)
        y = points[i, 1] * range_y + sigma * math.sin(angle)
        hits += (x >= 0.0) & (x <= range_x) & (y >= 0.0) & (y <= range_y)
    return hits


def scrambled_sobol(quantity, scene, points, seed):
    """Estimate by scrambled Sobol points instead of random points; ``points`` is a power of two."""
    from scipy.stats import qmc

    dimensions = 4 if quantity == "volume" else 3
    cube = qmc.Sobol(dimensions, rng=seed).random_base2(points.bit_length() - 1)
    count = prism_hits if quantity == "volume" else contact_hits
    hits = count(cube, scene.range_x, scene.range_y, scene.contact_distance)
    prism = (scene.range_x * scene.range_y) ** 2
    measure = prism if quantity == "volume" else surface_measure(scene)
    return {quantity: measure * hits / points}, points, 1


@compiled
def along_arc(range_x, range_y, sigma, nodes, weights):
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


def quadrature(quantity, scene, nodes, seed):
    """Integrate along the arc with a Gauss rule; ``seed`` is not used."""
    sides = scene.range_x, scene.range_y, scene.contact_distance
    for _ in range(CALLS):
        volume, area = along_arc(*sides, *rule(nodes))
    return {quantity: volume if quantity == "volume" else area}, nodes, CALLS


def exactly(quantity, scene, work, seed):
    """Evaluate the exact theory without its cache; ``work`` and ``seed`` are not used."""
    for _ in range(CALLS):
        # Results of recent scenes are cached.
        plain.volume_and_areas.cache_clear()
        volume, areas = exact.volume(scene), exact.areas(scene)
    return {quantity: volume if quantity == "volume" else areas["disc_collision"]}, 1, CALLS


def closed_form(quantity, scene, work, seed):
    """Evaluate the closed forms in plain doubles."""
    for _ in range(CALLS):
        numbers = laws.closed_form(scene)
    area = numbers["areas"]["disc_collision"]
    return {quantity: numbers["volume"] if quantity == "volume" else area}, 1, CALLS


def reference(scene):
    """Return {quantity: value} of the volume and the area of disc collisions to fifty digits."""
    q = MpScene.of(scene.width, scene.height, scene.radius)
    return {"volume": volume(q), AREA: disc_collision_area(q)}


# Mean times ---------------------------------------------------------------------------------


def times(scene, events, counts, replicas, duration):
    """Return {quantity: mean time} from ``counts`` of ``events`` in ``replicas``."""
    with np.errstate(divide="ignore"):
        return {
            f"{event}_time": float(scene.copies(event) * duration * replicas / np.float64(n))
            for event, n in zip(events, counts, strict=True)
        }


def by_lockstep(scene, blocks, seed):
    """Measure the mean times with the engine."""
    duration = runs.replica_duration(scene)
    counts = runs.run_blocks(scene, EVENTS, seed, 0, blocks, duration)[0]
    means = times(scene, EVENTS, counts, blocks * REPLICAS, duration)
    return means, runs.simulated_events(counts), 1


def by_scalar(scene, replicas, seed):
    """Measure the mean times one trajectory at a time."""
    duration = runs.replica_duration(scene)
    counts = scalar.count_blocks(
        np.uint64(seed), 0, 1, replicas, duration, scene.contact_distance, draw_constants(scene),
        (0, 0),
    )[0]  # fmt: skip
    means = times(scene, scalar.COUNTED, counts, replicas, duration)
    return means, scalar.simulated_events(counts), 1


def by_steps(step, scene, blocks, seed):
    """Measure the mean times by looking for overlaps every ``step``."""
    duration = runs.replica_duration(scene)
    counts = timestepping.run_blocks(scene, seed, 0, blocks, duration, step)
    replicas = blocks * REPLICAS
    means = times(scene, scalar.COUNTED, counts, replicas, duration)
    return means, round(duration / step) * replicas, 1


# Work and precision ---------------------------------------------------------------------------


def doubling(first, last):
    """Return first, 2 first, 4 first, … up to ``last``, at least two of them."""
    return tuple(first << k for k in range(max(2, int(last / first).bit_length())))


def series(scale):
    """Return every ``Series`` of volume, area and time, with ``scale`` times the usual work."""
    curves = []

    def add(part, method, run, works, scene=SCENE, setting=lambda work: None):
        curves.append(Series(part, method, scene, works, partial(run, scene), setting))

    def thickness(fraction):
        return montecarlo.shell_thickness(SCENE, "disc_collision", fraction)

    block = montecarlo.BLOCK
    samples = doubling(block, 32 * block * scale)
    for scene in (SCENE, TIGHT):
        add("volume", "rejection", partial(rejected, "volume", lambda _: None), samples, scene)
        add("volume", "conditioned", conditioned, doubling(1 << 16, (1 << 20) * scale), scene)
    for f in SHELLS:
        run = partial(rejected, AREA, lambda _, f=f: f)
        add("area", "shell", run, samples, setting=lambda _, f=f: thickness(f))
    best = partial(balanced_fraction, SCENE)
    run = partial(rejected, AREA, best)
    add("area", "balanced_shell", run, samples, setting=lambda work: thickness(best(work)))
    add("area", "surface", on_surface, doubling(1 << 10, (1 << 20) * scale))
    for part, quantity in (("volume", "volume"), ("area", AREA)):
        points = doubling(1 << 8, (1 << 17) * scale)
        add(part, "sobol", partial(scrambled_sobol, quantity), points)
        add(part, "quadrature", partial(quadrature, quantity), tuple(range(1, 17)))
        add(part, "closed_form", partial(closed_form, quantity), (1,))
        add(part, "exact", partial(exactly, quantity), (1,))

    add("time", "lockstep", by_lockstep, doubling(1, 128 * scale))
    add("time", "scalar", by_scalar, doubling(1 << 8, (1 << 13) * scale))
    for step, most in STEPS.items():
        # Coarse steps are always run: they show the law.
        if most * scale >= 2 or step > 2.0**-8:
            run, blocks = partial(by_steps, step), doubling(1, most * scale)
            add("time", "time_step", run, blocks, setting=lambda _, step=step: step)
    return curves


def exact_values(scene, part):
    """Return {quantity: exact value} of a part at the radius of ``scene``."""
    if part != "time":
        return reference(scene)
    return {f"{event}_time": value for event, value in exact.mean_times(scene).items()}


def measure(all_series, repetitions):
    """Run every series ``repetitions`` times in turn and return {(series, work): results}.

    A result is (relative errors by quantity, units of work, seconds of one call).
    """
    for curve in all_series:
        curve.run(curve.works[0], 0)
    results = {(i, work): [] for i, curve in enumerate(all_series) for work in curve.works}
    # The bar appears in a terminal only: logs stay clean.
    for repetition in tqdm(range(repetitions), "repetitions", leave=False, disable=None):
        for i, curve in enumerate(all_series):
            true = exact_values(curve.scene, curve.part)
            # This call fills the processor's caches again after the series before.
            curve.run(curve.works[0], 0)
            for k, work in enumerate(curve.works):
                # Every run has its own random numbers.
                seed = 1 + repetition + repetitions * (i + len(all_series) * k)
                start = time.process_time()
                estimates, units, calls = curve.run(work, seed)
                seconds = (time.process_time() - start) / calls
                with mp.workdps(DIGITS):
                    errors = {q: float(value / true[q] - 1) for q, value in estimates.items()}
                results[i, work].append((errors, units, seconds))
    return results


def cost_row(part, quantity, radius, method, **cells):
    """Return a row of accuracy_cost.csv."""
    box = {"width": SCENE.width, "height": SCENE.height, "radius": radius}
    return row(box, part=part, quantity=quantity, method=method, **cells)


def summary(curve, quantity, work, results):
    """Return the row of one series at one amount of work."""
    errors = [errors[quantity] for errors, _, _ in results]
    sizes = [abs(error) for error in errors]
    return cost_row(
        curve.part, quantity, curve.scene.radius, curve.method,
        setting=curve.setting(work),
        work=round(median(units for _, units, _ in results)),
        seconds=median(seconds for _, _, seconds in results),
        error=math.sqrt(fmean(size * size for size in sizes)),
        spread=pstdev(sizes),
        bias=fmean(errors),
        repetitions=len(results),
    )  # fmt: skip


def fitted(x, y, error=None):
    """Return (slope, standard error) of a ``LinearFit``; None if the points are too few for it."""
    if len(x) < 2:
        return None, None
    slope = LinearFit(x, y, error).slope
    return slope.value, slope.stderr or None


def with_slope(rows):
    """Return the rows of a series with the power of the work by which its error falls.

    Time is proportional to work, except for the time to start. The fit leaves out amounts of work
    whose error is not above three times the floor. Quadrature has no such power; its slope is
    digits per node, until rounding limits the error.
    """
    if rows[0]["method"] == "quadrature":
        fair = [one for one in rows if one["error"] > 1e-14]
        fit = fitted([one["work"] for one in fair], [math.log10(one["error"]) for one in fair])
    else:
        fair = [one for one in rows if 0.5 > one["error"] > 3 * one.get("floor", 0.0)]
        x = [math.log(one["work"]) for one in fair]
        y = [math.log(one["error"]) for one in fair]
        # The root mean square of R normal deviates has the relative error 1/√(2R).
        fit = fitted(x, y, 1 / math.sqrt(2 * rows[0]["repetitions"]))
    return [one | {"slope": fit[0], "slope_stderr": fit[1]} for one in rows]


def work_precision(all_series, results):
    """Return the rows of the parts volume, area, time and floor."""
    rows, floors = [], {}
    for i, curve in enumerate(all_series):
        for quantity in results[i, curve.works[0]][0][0]:
            summaries = [summary(curve, quantity, work, results[i, work]) for work in curve.works]
            settings = {part["setting"] for part in summaries}
            if curve.method in ("shell", "time_step"):
                floor = lasting_error(curve, quantity, results, i)
                floors.setdefault((curve.method, quantity), []).append((settings.pop(), *floor))
                # A floor within the noise counts as none.
                lasting = floor[0] if abs(floor[0]) > 3 * floor[1] else 0.0
                summaries = [part | {"floor": abs(lasting)} for part in summaries]
            rows += with_slope(summaries) if len(summaries) > 1 else summaries
    for (method, quantity), values in floors.items():
        clear = [value for value in values if abs(value[1]) > 3 * value[2]]
        x, y = [math.log(s) for s, _, _ in clear], [math.log(abs(e)) for _, e, _ in clear]
        slope, slope_error = fitted(x, y)
        for setting, error, stderr in values:
            found = {"setting": setting, "error": abs(error), "spread": stderr, "bias": error}
            found |= {"slope": slope, "slope_stderr": slope_error}
            rows.append(cost_row("floor", quantity, SCENE.radius, method, **found))
    return rows


def lasting_error(curve, quantity, results, i):
    """Return (relative error that no work removes, its standard error).

    For a shell it is exact; for time steps it is the mean over all runs, weighted by length.
    """
    if curve.method == "shell":
        epsilon = curve.setting(curve.works[0])
        expected = exact.shell_expectation(curve.scene, "disc_collision", epsilon)
        return expected / exact.areas(curve.scene)["disc_collision"] - 1, 0.0
    runs = [(errors[quantity], work) for work in curve.works for errors, _, _ in results[i, work]]
    errors, weights = map(np.array, zip(*runs, strict=True))
    mean = float(errors @ weights / weights.sum())
    # The variance of a run is inversely proportional to its length.
    variance = float(weights @ (errors - mean) ** 2 / (errors.size - 1))
    return mean, math.sqrt(variance / weights.sum())


# Radius by radius -----------------------------------------------------------------------------


def predicted_events(scene, event, error=TARGET):
    """Return how many wall and disc events a relative ``error`` of one mean time takes.

    For a Poisson process, error⁻² of these events are needed; the rates are exact.
    """
    time = exact.mean_times(scene)[event] / scene.copies(event)
    return exact.event_rate(scene) * time / error**2


def strip_rows(scene, blocks):
    """Yield the rows of pilots of ``blocks`` from strips next to the surfaces of rare hops."""
    for hop in strip.rare_hops(scene):
        near = strip.strip_of(scene, hop)
        strip.run_blocks(scene, hop, near, 0, 0, 1)
        start = time.process_time()
        sums, events = strip.run_blocks(scene, hop, near, 1, 0, blocks)
        seconds = time.process_time() - start
        more = (strip.relative_error(strip.fractions_of(scene, hop, near), sums) / TARGET) ** 2
        yield cost_row(
            "radius", f"{hop}_time", scene.radius, "strip",
            setting=near.time, work=round(events * more), seconds=seconds * more, error=TARGET,
            repetitions=blocks * REPLICAS,
        )  # fmt: skip


def by_radius(scale):
    """Yield the rows of the part radius: the cost of a relative error of ``TARGET``, in four ways.

    ``lockstep`` measures speed and error of a pilot at the radius; ``strip`` does so from starts
    next to a rare hop, also close to its threshold; ``poisson`` is predicted from the exact rates
    and one speed, the median over all radii; ``paid`` is a run to this error.
    """
    speeds, scenes = [], []
    for radius in radii(SCENE.width, SCENE.height, 0.01, RADII):
        scene = SCENE.with_radius(radius)
        duration = runs.replica_duration(scene)
        blocks = math.ceil(PILOT_BLOCKS * scale)
        start = time.process_time()
        sums, products = runs.run_blocks(scene, EVENTS, 1, 0, blocks, duration)
        seconds = time.process_time() - start
        events = runs.simulated_events(sums)
        speeds.append(events / seconds)
        scenes.append(scene)
        yield from strip_rows(scene, blocks)
        errors = relative_errors(sums, products, blocks * REPLICAS)
        for event, count, error in zip(EVENTS, sums, errors, strict=True):
            if count >= FEWEST:
                more = (float(error) / TARGET) ** 2
                yield cost_row(
                    "radius", f"{event}_time", radius, "lockstep",
                    work=round(events * more), seconds=seconds * more, error=TARGET,
                    repetitions=blocks * REPLICAS,
                )  # fmt: skip
    for hop in HOPS:
        for distance in CLOSE:
            scene = SCENE.with_radius(Box.of(SCENE).threshold(hop) * (1 - distance))
            yield from strip_rows(scene, blocks)
    speed = median(speeds)
    for scene in scenes:
        for event in EVENTS:
            if scene.is_possible(event):
                events = predicted_events(scene, event)
                yield cost_row(
                    "radius", f"{event}_time", scene.radius, "poisson",
                    work=round(events), seconds=events / speed, error=TARGET,
                )  # fmt: skip
    for event, paid in PAID.items():
        runs.run_blocks(SCENE, (event,), 0, 0, 1, 1.0)
        for radius in paid:
            scene = SCENE.with_radius(radius)
            start = time.process_time()
            point = runs.count_events(scene, {event: TARGET}, 10**10, 1)
            seconds = time.process_time() - start
            box = Box.of(scene)
            (mean,) = MeanTimes.rows(box, Theory.rows(box, [radius]), {"dynamics": [point]})
            bias = mean["estimate"] / mean["exact"] - 1
            yield cost_row(
                "radius", f"{event}_time", radius, "paid",
                work=point.events, seconds=seconds, error=TARGET, bias=bias, repetitions=1,
            )  # fmt: skip


# The table ------------------------------------------------------------------------------------


def speed(rows):
    """Return the row on how much faster the engine in lock step is than one trajectory at a time.

    Only ``rows`` of the part time count. The speed of an engine is the speed of its median run.
    """
    lockstep, scalar = (
        median_high(
            run["work"] / run["seconds"]
            for run in rows
            if (run["part"], run["method"]) == ("time", method)
        )
        for method in ("lockstep", "scalar")
    )
    return cost_row("speed", "events", SCENE.radius, "lockstep", setting=lockstep / scalar)


def rows(seconds=USUAL_SECONDS, repetitions=REPETITIONS):
    """Return the rows of accuracy_cost.csv for some ``seconds`` of processor time.

    Every method runs its minimum work, so this takes a few seconds whatever ``seconds`` is.
    ``repetitions`` ≥ 2.
    """
    scale = seconds / USUAL_SECONDS
    all_series = series(scale)
    work_rows = work_precision(all_series, measure(all_series, repetitions))
    return [*work_rows, speed(work_rows), *by_radius(scale)]
