"""Mean times of N discs at the same room and the same energy for each disc, by all methods.

Rates of theory and of the engines are at total energy 1/2. At the energy that each of two discs has
then, velocities are √(N/2) times as large, and times as much shorter.
"""

import math

import numpy as np

from twodiscs.dynamics import many
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.model.many import CLASSES, Gas
from twodiscs.sampling.many import initial, measures
from twodiscs.theory.many import exact
from twodiscs.theory.many.rates import rates, virial_sum, virial_weights

#: A room per disc of 0.75 × 1: two of them have the box 1.5 × 1.
WIDTH_PER_DISC, HEIGHT = 0.75, 1.0

#: Numbers of discs, and radii: open, both hops but one dense, an ordered channel.
DISCS, RADII = (2, 3, 4, 8), (0.1, 0.2, 0.28)


def dynamics_rates(gas, events, seed):
    """Return ({class: rate}, {class: error}, error of the virial sum) of about so many events."""
    duration = many.duration_of(gas)
    each = many.simulated_events(many.run_blocks(gas, seed, 0, 1, duration)[0])
    blocks = max(2, math.ceil(events / each))
    sums, products = many.run_blocks(gas, seed, 0, blocks, duration)
    replicas = blocks * REPLICAS
    second = np.triu(products) + np.triu(products, 1).T
    covariance = (second / replicas - np.outer(sums, sums) / replicas**2) / replicas / duration**2
    weights = np.array([virial_weights(gas).get(event, 0.0) for event in CLASSES])
    rates = dict(zip(CLASSES, (sums / replicas / duration).tolist(), strict=True))
    errors = dict(zip(CLASSES, np.sqrt(np.diag(covariance)).tolist(), strict=True))
    return rates, errors, math.sqrt(weights @ covariance @ weights)


def _time(gas, event, rate, error=0.0):
    """Return (mean time, its error) of events that share a rate; None where there are none."""
    if not rate:
        return None, None
    time = gas.multiplicity(event) / rate / math.sqrt(gas.discs / 2)
    return time, time * error / rate


def _deviate(value, error, other, spread=0.0):
    size = math.hypot(error, spread)
    return (value - other) / size if size else None


def rows(events, samples, seed, discs=DISCS, radii=RADII):
    """Yield the rows of more_discs.csv, of so many ``events`` and ``samples`` for each gas."""
    for radius in radii:
        for number in discs:
            gas = Gas(number, WIDTH_PER_DISC * number, HEIGHT, radius)
            yield from _of_gas(gas, events, samples, seed)


def _of_gas(gas, events, samples, seed):
    known = exact.measures(gas)
    true = rates(gas, known) if known else {}
    sampled, spread = (rates(gas, part) for part in measures.sample(gas, samples, seed))
    counted, errors, virial_error = dynamics_rates(gas, events, seed)
    start = {
        "discs": gas.discs, "width": gas.width, "height": gas.height, "radius": gas.radius,
        "theory": exact.method(gas) or "none", "states": initial.method(gas),
    }  # fmt: skip
    for event in CLASSES:
        time, _ = _time(gas, event, true.get(event))
        estimate, estimate_error = _time(gas, event, sampled[event], spread[event])
        seen, error = _time(gas, event, counted[event], errors[event])
        reference, uncertain = (time, 0.0) if known else (estimate, estimate_error)
        z = (
            None
            if seen is None or reference is None
            else _deviate(seen, error, reference, uncertain)
        )
        yield start | {
            "event": event, "exact": time, "monte_carlo": estimate,
            "monte_carlo_stderr": estimate_error, "dynamics": seen, "dynamics_stderr": error,
            "z": z,
        }  # fmt: skip
    total = virial_sum(gas, counted)
    yield start | {
        "event": "virial", "exact": 1.0, "monte_carlo": virial_sum(gas, sampled),
        "monte_carlo_stderr": None, "dynamics": total, "dynamics_stderr": virial_error,
        "z": _deviate(total, virial_error, 1.0),
    }  # fmt: skip
