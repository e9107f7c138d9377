"""Mean times of N discs at the same area and the same energy per disc, by all methods.

Theory and engines give rates at total energy 1/2. At the energy per disc of two discs, velocities
are √(N/2) times as large, and times are shorter by the same factor.
"""

import math

import numpy as np

from twodiscs.dynamics.many import class_counts, many_rates
from twodiscs.dynamics.many.all_pairs import CLASSES
from twodiscs.model.many_geometry import copies
from twodiscs.model.scene import Scene
from twodiscs.sampling.many import insertions, many_initial_states
from twodiscs.theory import virial
from twodiscs.theory.flux import rates
from twodiscs.theory.n_discs import exact_method, known_derivatives
from twodiscs_paper.studies.more_discs import tori
from twodiscs_paper.study import row

#: The box per disc, 0.75 × 1: two discs have the box 1.5 × 1.
WIDTH_PER_DISC, ROW_HEIGHT = 0.75, 1.0

#: Numbers of discs, and radii: dilute, dense with both hops, and a channel of ordered discs.
DISCS, RADII = (2, 3, 4, 8, 16, 32, 64), (0.1, 0.2, 0.28)

#: Numbers of discs whose initial states take longer than their motion, and their replicas: fewer
#: ones, which are followed for longer. They have an eighth of the events, and no insertions, which
#: take too long.
REPLICAS_OF_MANY, EVENT_SHARE = {16: 128, 32: 96, 64: 48}, 1 / 8

#: (number of discs on a torus, their packing fraction): three, whose rate of collisions is exact,
#: and a fluid.
ON_TORI = tuple((discs, packing) for discs in (3, 64) for packing in (0.1, 0.3, 0.45))


def virial_weights(scene):
    """Return ``virial.weights`` of the rates of all events of a class, as in ``flux.rates``."""
    weights = virial.weights(scene) or {}
    return {e: weight / copies(scene, e) for e, weight in weights.items()}


def virial_sum(scene, rates):
    """Return the sum in the virial theorem, which is 1, from {class of events: rate}."""
    return math.fsum(weight * rates[event] for event, weight in virial_weights(scene).items())


def counted(scene, events, seed):
    """Return (sums, products, replicas, duration) of about ``events``."""
    if replicas := REPLICAS_OF_MANY.get(scene.discs):
        duration = many_rates.expected_duration(scene, EVENT_SHARE * events / replicas)
        counts = class_counts.run_classes(scene, seed, 0, 1, duration, replicas=replicas)
        return *counts, replicas, duration
    duration = many_rates.expected_duration(scene)
    first = class_counts.run_classes(scene, seed, 0, 1, duration)
    blocks = max(2, math.ceil(events / class_counts.simulated_events(first[0])))
    rest = class_counts.run_classes(scene, seed, 1, blocks, duration)
    sums, products = (one + more for one, more in zip(first, rest, strict=True))
    return sums, products, blocks * many_rates.block_replicas(scene, duration), duration


def dynamics_rates(scene, events, seed):
    """Return ({class: rate}, {class: error}, error of the virial sum) from about ``events``."""
    sums, products, replicas, duration = counted(scene, events, seed)
    second = np.triu(products) + np.triu(products, 1).T
    covariance = (second / replicas - np.outer(sums, sums) / replicas**2) / replicas / duration**2
    weights = np.array([virial_weights(scene).get(event, 0.0) for event in CLASSES])
    rates = dict(zip(CLASSES, (sums / replicas / duration).tolist(), strict=True))
    errors = dict(zip(CLASSES, np.sqrt(np.diag(covariance)).tolist(), strict=True))
    return rates, errors, math.sqrt(weights @ covariance @ weights)


def _time(scene, event, rate, error=0.0):
    """Return (mean time, its error) of events that share a rate, or (None, None) without rate."""
    if not rate:
        return None, None
    # The mean is over all initial states, for two discs too, so that all numbers of discs compare.
    time = copies(scene, event) / rate / math.sqrt(scene.discs / 2)
    return time, time * error / rate


def _deviate(value, error, other, spread=0.0):
    """Return how many errors two values are apart, None if one of them is missing or exact."""
    if value is None or other is None:
        return None
    size = math.hypot(error, spread)
    return (value - other) / size if size else None


def rows(events, samples, seed, discs=DISCS, radii=RADII, on_tori=ON_TORI):
    """Yield the rows of more_discs.csv, from about ``events`` and ``samples`` for each scene."""
    for radius in radii:
        for number in discs:
            scene = Scene(WIDTH_PER_DISC * number, ROW_HEIGHT, radius, discs=number)
            yield from _of_scene(scene, events, samples, seed)
    for number, packing in on_tori:
        yield _on_torus(tori.torus(number, packing, "1:1"), events, seed)


def _on_torus(scene, events, seed):
    """Return the row of Z of discs on a torus: three have an exact rate, more the virial series."""
    (name,), per_rate, known = scene.events, tori.per_collision(scene), known_derivatives(scene)
    found, errors, _ = dynamics_rates(scene, events, seed)
    due, spread = (
        (1 + per_rate * rates(scene, known)[name], 0.0)
        if known
        else tori.virial_series(tori.packing_fraction(scene), scene.discs)
    )
    value, error = 1 + per_rate * found[name], per_rate * errors[name]
    return row(
        _start(scene, "three" if known else "series"), event="compressibility_factor", exact=due,
        dynamics=value, dynamics_stderr=error, z=_deviate(value, error, due, spread),
    )  # fmt: skip


def _start(scene, theory):
    return {
        "discs": scene.discs, "width": scene.width, "height": scene.height, "radius": scene.radius,
        "periodic": scene.periodic or None, "theory": theory,
        "states": many_initial_states.method(scene),
    }  # fmt: skip


def _of_scene(scene, events, samples, seed):
    known = known_derivatives(scene)
    theory = exact_method(scene) or "none"
    true = rates(scene, known) if known else {}
    has_samples = scene.discs not in REPLICAS_OF_MANY
    sampled, errors_of_samples = (
        (rates(scene, part) for part in insertions.sample(scene, samples, seed))
        if has_samples
        else ({}, {})
    )
    found, errors, virial_error = dynamics_rates(scene, events, seed)
    start = _start(scene, theory)
    for event in CLASSES:
        time, _ = _time(scene, event, true.get(event))
        sampled_time, spread = _time(scene, event, sampled.get(event), errors_of_samples.get(event))
        counted_time, error = _time(scene, event, found[event], errors[event])
        reference = (time, 0.0) if known else (sampled_time, spread)
        yield row(
            start, event=event, exact=time,
            monte_carlo=sampled_time, monte_carlo_stderr=spread,
            monte_carlo_z=_deviate(sampled_time, spread, time),
            dynamics=counted_time, dynamics_stderr=error,
            z=_deviate(counted_time, error, *reference),
        )  # fmt: skip
    total = virial_sum(scene, found)
    yield row(
        start, event="virial", exact=1.0,
        monte_carlo=virial_sum(scene, sampled) if has_samples else None,
        dynamics=total, dynamics_stderr=virial_error, z=_deviate(total, virial_error, 1.0),
    )  # fmt: skip
