"""Calibration of error bars: one instrument that counts, over seeds, what errors say.

Each call of the face is repeated with many seeds. The score of a seed is its deviation over its own
standard error: from the exact value, or from the mean over all seeds if no exact value is known.
If errors are right, the mean square of scores is 1. An error that a call withholds ("too-few") has
no score.
"""

import math
from collections import defaultdict
from itertools import pairwise

import numpy as np

import twodiscs as td
from twodiscs.model.events import HOPS
from twodiscs.theory.exact import event_rate, events_per_interval

PAPER = {"width": 1.5, "height": 1.0}

#: {name: parameters of a scene}: plain radii and thresholds, each effect at two values, all effects
#: together, more discs, rings, and long boxes.
SCENES = {
    **{f"r = {radius}": {**PAPER, "radius": radius} for radius in (0.05, 0.15, 0.2, 0.3, 0.38)},
    **{f"r = {radius}": {**PAPER, "radius": radius} for radius in (0.2499, 0.2501, 0.3745)},
    **{
        f"{name} {value}": {**PAPER, "radius": 0.2, name: value}
        for name, values in {
            "radius_ratio": (0.5, 1.5), "mass_ratio": (0.2, 5.0), "periodic": ("x", "xy"),
            "field": (0.1, 0.8), "moment_of_inertia": (0.1, 0.5), "friction": (0.3, 10.0),
            "depth": (0.6, 2.0),
        }.items()
        for value in values
    },
    "rough, r = 0.1": {**PAPER, "radius": 0.1, "moment_of_inertia": 1.0},
    "rough, r = 0.3": {**PAPER, "radius": 0.3, "moment_of_inertia": 0.1},
    "rough, r = 0.245": {**PAPER, "radius": 0.245, "moment_of_inertia": 0.05},
    "rough ring": {
        "width": 1.0, "height": 2.0, "radius": 0.248, "moment_of_inertia": 0.3, "periodic": "x",
    },
    "all effects": {
        **PAPER, "radius": 0.15, "radius_ratio": 1.3, "mass_ratio": 2.0, "field": 0.3,
        "moment_of_inertia": 0.4, "friction": 0.5,
    },
    "three discs": {**PAPER, "radius": 0.15, "discs": 3},
    "three rough discs": {**PAPER, "radius": 0.15, "discs": 3, "moment_of_inertia": 0.5},
    "eight discs in a channel": {"width": 5.0, "height": 0.6, "radius": 0.18, "discs": 8},
    "eight discs": {"width": 3.0, "height": 2.0, "radius": 0.2, "discs": 8},
    "100 × 1": {"width": 100.0, "height": 1.0, "radius": 0.1},
}  # fmt: skip

#: The least size that the face accepts, the default one, and a long one.
SIZES = {
    "simulate": {"least": {"budget": 1}, "usual": {"error": 1e-2}, "long": {"error": 3e-3}},
    "sample": {"least": {"samples": 1}, "usual": {"samples": 3e6}},
    "intervals": {"least": {"number": 1}, "usual": {"number": 2**17}},
    "transmission": {"least": {"hops": 1}, "usual": {"hops": 2**15}},
    "observe": {"least": {"replicas": 1}, "usual": {"replicas": 2**13}},
    "diffusion": {"least": {"replicas": 1}, "usual": {"replicas": 2**13}},
}

#: The most wall and disc events of a call.
MOST_EVENTS = 3e7

#: Times of observed averages, over the side of the box along x.
TIMES = (0.5, 2.0)


def _measured(result):
    """Yield (quantity, value, error, exact, test) of the rows of ``simulate`` or ``sample``.

    The value of an area is that of a thin shell, which has an exact expectation of its own.
    """
    for row, one in zip(result.rows, result.values(), strict=True):
        exact = row.get("expectation", one.exact)
        yield one.quantity, one.value, one.stderr, exact, row["test"] or one.status


def _of_simulate(scene, **settings):
    result = td.simulate(scene, **{"error": 1e-2, "budget": MOST_EVENTS} | settings)
    yield from _measured(result)
    for first, other in pairwise(one for one in result.values() if one.stderr and one.exact):
        ratio, exact = first.u / other.u, first.exact / other.exact
        yield "ratio of times", ratio.nominal_value, ratio.std_dev, exact, "ratio"
    if not scene.field and scene.radius_ratio == 1:
        for name, one in td.pressure(result).items():
            yield name, one.value, one.stderr, one.exact, "pressure"


def _of_sample(scene, **settings):
    result = td.sample(scene, **settings)
    yield from _measured(result)
    if not scene.field and result["volume"].stderr:
        one = td.free_energy(result)
        yield "free_energy", one.value, one.stderr, one.exact, "free energy"


def _of_intervals(scene, **settings):
    if event_rate(scene) is None:  # the work of an interval is not known
        return
    for hop in HOPS:
        if scene.is_possible(hop) and events_per_interval(scene, hop) * 2**17 < MOST_EVENTS:
            result = td.intervals(scene, hop, **settings)
            one = result.mean
            yield f"mean of {hop}", one.value, one.stderr, one.exact, one.status
            for k, row in enumerate(result.frame().head(8).itertuples()):
                yield f"bin {k} of {hop}", row.density, row.stderr, None, "bin"


def _of_transmission(scene, **settings):
    result = td.transmission(scene, "horizontal_hop", **settings)
    if result.coefficient:
        one = result.coefficient
        yield "coefficient", one.value, one.stderr, None, "clusters"
    for time, one in zip(result.times[::5], result.curve[::5], strict=True):
        yield f"κ at {time / result.times[0]:.3g}", one.value, one.stderr, None, "plateau"


def _averages(found):
    for k, (means, errors) in enumerate(zip(found.mean, found.stderr, strict=True)):
        for c, (mean, error) in enumerate(zip(np.ravel(means), np.ravel(errors), strict=True)):
            yield f"average {c} at time {k}", float(mean), float(error), None, "average"


def _of_observe(scene, **settings):
    times = [time * scene.width for time in TIMES]
    yield from _averages(td.observe(scene, lambda start, now: now["x1"] ** 2, times, **settings))


def _of_diffusion(scene, **settings):
    times = [time * scene.width for time in TIMES]
    yield from _averages(td.diffusion(scene, times, **settings))


#: {name of a call: its values}
CALLS = {
    "simulate": _of_simulate, "sample": _of_sample, "intervals": _of_intervals,
    "transmission": _of_transmission, "observe": _of_observe, "diffusion": _of_diffusion,
}  # fmt: skip


def scored(values):
    """Return (scores, number of values without an error) of [(value, error, exact), …]."""
    known = [(v, e, x) for v, e, x in values if v is not None and e and math.isfinite(e)]
    if not known:
        return np.array([]), len(values)
    value, error, exact = (np.array(part, float) for part in zip(*known, strict=True))
    if np.isnan(exact).any():
        n = value.size
        exact = value.mean()
        error = error * math.sqrt((n - 1) / n) if n > 1 else error * math.inf
    return (value - exact) / error, len(values) - value.size


def rows(seeds, first, scenes=tuple(SCENES), calls=tuple(CALLS)):
    """Yield a row for each quantity, size, call and scene, from ``seeds`` seeds from ``first`` on.

    A call that a scene refuses, such as a transmission without hops, has no row.
    """
    for case in scenes:
        scene = td.Scene(**SCENES[case])
        for call in calls:
            for size, settings in SIZES[call].items():
                found, tests = defaultdict(list), {}
                try:
                    for seed in range(first, first + (seeds if size != "long" else seeds // 4)):
                        for name, *value, test in CALLS[call](scene, **settings, seed=seed):
                            found[name].append(value)
                            tests[name] = test
                except td.InputError:
                    continue
                for name, values in found.items():
                    z, withheld = scored(values)
                    yield row_of_scores(case, call, size, name, tests[name], z, withheld)


def row_of_scores(case, call, size, quantity, test, z, withheld):
    """Return the row of the scores ``z`` and of the number of values ``withheld`` without error."""
    square = float(np.mean(z * z)) if z.size else None
    spread = float(np.std(z * z, ddof=1) / math.sqrt(z.size)) if z.size > 1 else None
    return {
        "case": case, "call": call, "size": size, "quantity": quantity, "test": test,
        "scores": z.size, "withheld": withheld, "mean": float(z.mean()) if z.size else None,
        "mean_square": square, "stderr": spread, "beyond_three": int((np.abs(z) > 3).sum()),
    }  # fmt: skip
