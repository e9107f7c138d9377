"""Calibration of error bars: one instrument that counts, over seeds, what errors say.

Each call of the face, and each study at a small size, is repeated with many seeds. The score of a
seed is its deviation over its own standard error: from the exact value, or from the mean over all
seeds if no exact value is known. If errors are right, the mean square of scores is 1. An error that
a call withholds ("too-few") has no score.
"""

import math
from collections import defaultdict
from functools import cache, partial
from itertools import pairwise

import numpy as np

import twodiscs as td
from twodiscs.model.events import HOPS
from twodiscs.model.scene import Box
from twodiscs.theory.exact import event_rate, events_per_interval
from twodiscs_paper.studies.accuracy_cost import measure as accuracy_cost
from twodiscs_paper.studies.distributions import measure as distributions
from twodiscs_paper.studies.effects import measure as effects
from twodiscs_paper.studies.more_discs import measure as more_discs
from twodiscs_paper.studies.passages import brownian, near, powers
from twodiscs_paper.studies.passages.models import limit
from twodiscs_paper.studies.passages.parts import (
    in_long_file,
    long_files,
    near_threshold,
    on_ring,
    with_friction,
)
from twodiscs_paper.studies.stability import measure as stability
from twodiscs_paper.studies.tails import measure as tails
from twodiscs_paper.studies.thresholds import measure as thresholds
from twodiscs_paper.study import select

BOX, CALIBRATED_HOP = Box(1.5, 1.0), "horizontal_hop"
PAPER = BOX.parameters()
ROUGH = {"moment_of_inertia": 0.5}


def packed(discs, packing, periodic):
    """Return the parameters of discs of the radius 1/2 at a ``packing`` fraction, in a square."""
    side = math.sqrt(discs * math.pi / 4 / packing)
    return {"width": side, "height": side, "radius": 0.5, "discs": discs, "periodic": periodic}


#: {name: parameters of a scene}: plain radii and thresholds, each effect at two values, all effects
#: together, necks, more discs, rings, and a long box.
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
    **{
        f"rough, r = {radius}": {**PAPER, "radius": radius, "moment_of_inertia": inertia}
        for radius, inertia in ((0.1, 1.0), (0.3, 0.1), (0.245, 0.05))
    },
    "rough ring": {
        "width": 1.0, "height": 2.0, "radius": 0.248, "moment_of_inertia": 0.3, "periodic": "x",
    },
    "all effects": {
        **PAPER, "radius": 0.15, "radius_ratio": 1.3, "mass_ratio": 2.0, "field": 0.3,
        "moment_of_inertia": 0.4, "friction": 0.5,
    },
    "field, neck": {**PAPER, "radius": 0.24, "field": 1.03},
    "unequal, neck": {**PAPER, **ROUGH, "radius": 0.2, "radius_ratio": 1.45, "mass_ratio": 3.0},
    "balls, neck": {"width": 1.0, "height": 1.5, "radius": 0.24, "depth": 0.6},
    "ring, neck": {**PAPER, "radius": 0.3, "periodic": "x"},
    "three discs": {**PAPER, "radius": 0.15, "discs": 3},
    "three rough discs": {**PAPER, **ROUGH, "radius": 0.15, "discs": 3},
    "four on a ring": {"width": 3.0, "height": 1.0, "radius": 0.2, "discs": 4, "periodic": "x"},
    "three rough discs on a ring": {**PAPER, **ROUGH, "radius": 0.15, "discs": 3, "periodic": "x"},
    "eight discs in a channel": {"width": 5.0, "height": 0.6, "radius": 0.18, "discs": 8},
    "eight discs": {"width": 3.0, "height": 2.0, "radius": 0.2, "discs": 8},
    "twenty discs": {"width": 5.0, "height": 3.0, "radius": 0.2, "discs": 20},
    "twenty on a ring": {"width": 15.0, "height": 1.0, "radius": 0.2, "discs": 20, "periodic": "x"},
    "three on a torus": {**PAPER, "radius": 0.22, "discs": 3, "periodic": "xy"},
    "100 × 1": {"width": 100.0, "height": 1.0, "radius": 0.1},
    **{
        f"{discs} discs{where}, packing {packing}": packed(discs, packing, periodic)
        for discs, where, periodic, packings in (
            (8, " on a torus", "xy", (0.3,)),
            (64, "", "", (0.1, 0.3, 0.6, 0.7)), (256, "", "", (0.3, 0.6)),
            (64, " on a ring", "x", (0.3, 0.6)), (64, " on a torus", "xy", (0.3, 0.6, 0.7)),
            (1024, "", "", (0.6,)),
        )
        for packing in packings
    },
}  # fmt: skip

#: Scenes of more discs have calls of the least size, and half of the seeds. Scenes of still more
#: have one call, with the budget that help(simulate) names for them, or that its warning names.
LEAST_CALLS, ONE_CALL = 8, 20

#: The least size that the face accepts, the default one, a long one, and one that an error ends.
CALL_SIZES = {
    "simulate": {
        "least": {"budget": 1}, "usual": {"error": 1e-2}, "long": {"error": 3e-3},
        "small": {"error": 0.5, "budget": 1e6}, "dense": {"error": 0.5, "budget": 2e7},
    },
    "sample": {
        "least": {"samples": 1}, "usual": {"samples": 3e6}, "error": {"error": 0.03, "budget": 1e7},
        "torus": {"samples": 2e5},
    },
    "intervals": {"least": {"number": 1}, "usual": {"number": 2**17}},
    "transmission": {"least": {"hops": 1}, "usual": {"hops": 2**15}},
    "observe": {"least": {"replicas": 1}, "usual": {"replicas": 2**13}, "torus": {"replicas": 1}},
    "diffusion": {"least": {"replicas": 1}, "usual": {"replicas": 2**13}, "torus": {"replicas": 1}},
    "cost": {"least": {}},
}  # fmt: skip

#: The most wall and disc events of a call.
MOST_CALL_EVENTS = 3e7

#: Times of observed averages, over the side of the box along x.
TEST_TIMES = (0.5, 2.0)


# Calls of the face --------------------------------------------------------------------------------


def _measured(result):
    """Yield (quantity, value, error, exact, test) of the rows of ``simulate`` or ``sample``.

    The value of an area is that of a thin shell, which has an exact expectation of its own.
    """
    for row, one in zip(result.rows, result.values(), strict=True):
        exact = row.get("expectation", one.exact)
        yield one.quantity, one.value, one.stderr, exact, row["test"] or one.status


def simulated(scene, **settings):
    """Yield the values of ``simulate``, of ratios of its mean times, and of ``pressure``."""
    result = td.simulate(scene, **{"error": 1e-2, "budget": MOST_CALL_EVENTS} | settings)
    yield from _measured(result)
    for first, other in pairwise(one for one in result.values() if one.stderr and one.exact):
        ratio, exact = first.u / other.u, first.exact / other.exact
        yield "ratio of times", ratio.nominal_value, ratio.std_dev, exact, "ratio"
    # Without walls a pressure has the scores of the time: one scene of more discs is enough.
    if not scene.field and scene.radius_ratio == 1 and (scene.walled or scene.discs <= ONE_CALL):
        for name, one in td.pressure(result).items():
            yield name, one.value, one.stderr, one.exact, "pressure"


def sampled(scene, **settings):
    """Yield the values of ``sample`` and of ``free_energy``."""
    result = td.sample(scene, **settings)
    yield from _measured(result)
    if not scene.field and result["volume"].stderr:
        one = td.free_energy(result)
        yield "free_energy", one.value, one.stderr, one.exact, "free energy"


def intervals(scene, **settings):
    """Yield the values of ``intervals`` of each hop."""
    if event_rate(scene) is None:  # the work of an interval is not known
        return
    for hop in HOPS:
        if scene.is_possible(hop) and events_per_interval(scene, hop) * 2**17 < MOST_CALL_EVENTS:
            result = td.intervals(scene, hop, **settings)
            for name, one in {"mean": result.mean, "density at 0": result.at_zero}.items():
                exact = one.exact if name == "mean" else None  # a parabola has a bias
                yield f"{name} of {hop}", one.value, one.stderr, exact, one.status
            for k, row in enumerate(result.frame().head(8).itertuples()):
                yield f"bin {k} of {hop}", row.density, row.stderr, None, "bin"


def transmitted(scene, **settings):
    """Yield the values of ``transmission``, of the horizontal hop if it has them."""
    along = scene.is_possible(CALIBRATED_HOP) or (scene.periodic and scene.discs > 2)
    hop = CALIBRATED_HOP if along else "vertical_hop"
    result = td.transmission(scene, hop, **settings)
    if result.coefficient:
        one = result.coefficient
        yield "coefficient", one.value, one.stderr, None, "clusters"
    for time, one in zip(result.times[::5], result.curve[::5], strict=True):
        yield f"κ at {time / result.times[0]:.3g}", one.value, one.stderr, None, "plateau"


def averages(call, scene, **settings):
    """Yield averages of ``observe``, of a square of a coordinate, or of ``diffusion``."""
    squares = [lambda start, now: now["x1"] ** 2] if call is td.observe else []
    found = call(scene, *squares, [time * scene.width for time in TEST_TIMES], **settings)
    for k, (means, errors) in enumerate(zip(found.mean, found.stderr, strict=True)):
        for c, (mean, error) in enumerate(zip(np.ravel(means), np.ravel(errors), strict=True)):
            yield f"average {c} at time {k}", float(mean), float(error), None, "average"


#: {method of a row of a sample: name of its prices}.
SAMPLER_NAMES = {"monte_carlo": "rejection", "insertion": "insertions"}


@cache
def prices(scene):
    """Return the ``Cost`` of a scene."""
    return td.cost(scene)


def priced(scene, seed):
    """Yield the values of the smallest runs, with the errors that ``cost`` gives them.

    Wall hits of rough discs have none: in corners they come in crowds of any size, so their number
    has no variance, and only the error of a run itself knows which crowds it met.
    """
    if event_rate(scene) is None:  # no exact value
        return
    known = {(one.quantity, one.method): one for one in prices(scene).prices}
    times, samples = td.simulate(scene, error=0.999, seed=seed), td.sample(scene, 1, seed=seed)
    for result in (times, samples):
        for row, (name, value, error, exact, _) in zip(result.rows, _measured(result), strict=True):
            method = "strips" if row.get("starts") == "strip" else "dynamics"
            if result is samples:
                method = SAMPLER_NAMES.get(row["method"], row["method"])
                if name != "volume" and scene.discs == 2:
                    method = f"shells, {method}"
            one = known.get((name, method))
            crowded = scene.moment_of_inertia and name.endswith("wall_time")
            if one and error and exact and not crowded:
                least = math.sqrt(one.c / one.least_seconds)
                yield f"{name} by {method}", value, least * exact, exact, "price"


#: {name of a call: its values}
STAGE_CALLS = {
    "simulate": simulated, "sample": sampled, "intervals": intervals, "transmission": transmitted,
    "observe": partial(averages, td.observe), "diffusion": partial(averages, td.diffusion),
    "cost": priced,
}  # fmt: skip


# Studies ------------------------------------------------------------------------------------------

#: The columns that tell rows of a study apart.
TABLE_NAMES = (
    "quantity", "method", "event", "form", "parameter", "program", "discs", "radius", "distance",
    "moment_of_inertia", "friction", "step", "room", "neck", "time", "duration", "first", "last",
)  # fmt: skip

#: The quantities whose reference, if it has no error, is their exact value.
EXACT_QUANTITIES = {"mean", "density_at_zero", "slope", "single_file", "crossing_rate"}

#: Files of few discs, as in the long run: times are in units of h over the thermal speed.
FILE_CASES = {
    "files": [{"discs": n, "halvings": 3, "replicas": 64} for n in (4, 16)], "name": "files",
    "width": 1.5, "height": 1.0, "step": 4.0, "records": 128, "lags": [4, 8], "sums": [2.0, 4.0],
}  # fmt: skip

#: {(program, s): ε}, as powers of 1/2: necks from 16 steps to 1/32, and those of first passages.
CROSSINGS = {
    ("reflected", 2): (2, 3, 4, 5, 6, 10, 12, 14), ("reflected", 5): (2, 3, 4),
    ("kicked", 5): (4,), ("together", 2): (2, 4), ("confined", 2): (2, 4), ("singly", 2): (2, 4),
}  # fmt: skip
PASSAGES = {(program, 2): (2, 4) for program in ("reflected", "together", "confined", "singly")}

#: {radius where events die out: relative distances below it}.
LAW_DISTANCES = {0.25: (0.16, 0.08, 0.04, 0.02, 0.01), 0.375: (0.16, 0.08, 0.04, 0.02, 0.01)}
LAW_DISTANCES[BOX.largest_radius] = (0.02, 0.01, 0.005)


def table_values(make, seed):
    """Yield the values of the rows of a study's table that have an error, from ``make(seed)``."""
    for row in make(seed):
        value, error = row.get("estimate"), row.get("stderr")
        if not error or row.get("seed"):  # an exponent from one seed is that of all seeds
            continue
        known = row.get("curve", row.get("exact"))
        if row["quantity"] in EXACT_QUANTITIES and not row.get("reference_stderr"):
            known = row.get("reference")
        cells = (row.get(name) for name in TABLE_NAMES)
        name = " ".join(f"{c:.4g}" if isinstance(c, float) else str(c) for c in cells if c)
        yield name, value, error, known, "study"


def interval_rows(seed):
    """Yield rows of distributions.csv: intervals with a cubic tail, and without one."""
    for hop, radius in (("vertical_hop", 0.1), (CALIBRATED_HOP, 0.24), ("vertical_hop", 0.3)):
        start = {"event": hop, "radius": radius}
        yield from distributions.measured(start, BOX.scene(radius), hop, seed, 2**20)


def threshold_rows(seed):
    """Return the rows of thresholds.csv, without a form that has the same errors."""
    radii = [limit * (1 - distance) for limit, some in LAW_DISTANCES.items() for distance in some]
    found = [td.simulate(BOX.scene(radius), error=1e-2, budget=1, seed=seed) for radius in radii]
    scene = {"name": "paper", "box": PAPER, "event": CALIBRATED_HOP, "radii": []}
    tables = {
        "paper/mean_times": [row for times in found for row in times.rows],
        "distributions": [{"last": None} | r for r in distributions.rows([scene], seed, 2**18)],
    }
    return [r for r in thresholds.rows(tables, {"paper": PAPER}) if r["form"] == "reduced"]


def passage_rows(seed):
    """Return rows of passages.csv of smooth discs: κ, its exponents, and c."""
    rows = [*near_threshold.one_hop("", BOX, CALIBRATED_HOP, range(3, 9), None, 2**16, seed)]
    rows = [dict.fromkeys(powers.HOP_COLUMNS) | row for row in rows]
    c = limit.amplitude(64, seed)
    amplitude = {"quantity": "amplitude", "estimate": c.value, "stderr": c.stderr}
    return [*rows, *powers.fits(rows), amplitude]


def passage_rows_of_effects(seed):
    """Yield rows of passages.csv of rough discs, of discs with friction, and on a ring."""
    yield from near_threshold.one_hop("", BOX, CALIBRATED_HOP, range(3, 7), 0.5, 2**16, seed)
    yield from with_friction.one_friction("", BOX, 40.0, (6, 8, 10), 2**16, seed)
    for inertia in (None, 0.5):
        yield from on_ring.one_ring("", BOX, inertia, 2**24, seed)


def file_rows(seed):
    """Yield rows of passages.csv of files: hops, κ, D, displacements and F."""
    yield from long_files.long_files(**FILE_CASES, seeds=[seed])
    open_radius, friction = near.radius_at(0.25, 3), in_long_file.FILE_FRICTION
    for radius, frictions in ((0.28, [friction]), (open_radius, [None, friction])):
        yield from in_long_file.one_long_file("", BOX, radius, frictions, seed)


def brownian_rows(seed):
    """Return the rows of brownian.csv from few crossings and pairs."""
    groups = {
        method: [
            {"program": program, "step": step, "halvings": halvings, "samples": samples}
            for (program, step), halvings in widths.items()
        ]
        for method, widths, samples in (("crossings", CROSSINGS, 2048), ("passages", PASSAGES, 64))
    }
    return brownian.rows(brownian.counted([seed], **groups))


def lyapunov_rows(seed):
    """Yield the rows of stability.csv on Lyapunov exponents, by both methods."""
    for one in select(stability.reversal_rows(BOX, seed), quantity="exponent"):
        yield one | {"method": one["case"], "estimate": one["value"], "exact": None}


def power_rows(seed):
    """Yield the powers of the time with which errors fall, of two methods of accuracy_cost.csv."""
    for method in accuracy_cost.methods(np.uint64(seed)):
        if method.name in ("lockstep", "rejection") and method.scene == accuracy_cost.EASY_SCENE:
            one = next(accuracy_cost.error_rows(method, math.inf, 256))
            yield one | {"estimate": one["slope"], "stderr": one["slope_stderr"], "exact": -0.5}


def rate_rows(seed):
    """Yield rows of more_discs.csv, a row for each method."""
    for one in more_discs.rows(2**16, 2**16, seed, (2, 3, 4, 8), (0.1, 0.28), ()):
        for method in ("monte_carlo", "dynamics"):
            values = {"estimate": one.get(method), "stderr": one.get(f"{method}_stderr")}
            yield one | values | {"quantity": "rate", "method": method}


#: {(study, kind of its scenes): function of a seed that returns rows of its table}.
STUDY_CASES = {
    ("tails", "plain discs"): partial(tails.rows, BOX, 2, 4000),
    ("distributions", "plain discs"): interval_rows,
    ("thresholds", "plain discs"): threshold_rows,
    ("passages", "plain discs"): passage_rows,
    ("passages", "effects"): passage_rows_of_effects,
    ("passages", "more discs"): file_rows,
    ("brownian", "plain discs"): brownian_rows,
    ("more_discs", "more discs"): rate_rows,
    ("effects", "effects"): partial(
        effects.share_rows, {"scene": ""}, td.Scene(**PAPER, **ROUGH, radius=0.2), blocks=64
    ),
    ("stability", "plain discs"): lyapunov_rows,
    ("accuracy_cost", "plain discs"): power_rows,
}


# Rows ---------------------------------------------------------------------------------------------


def kind(case):
    """Return what the discs of a case are: plain discs, with effects, or more than two."""
    if case not in SCENES:
        return case
    names = SCENES[case].keys() - {"width", "height", "radius"}
    return "more discs" if "discs" in names else "effects" if names else "plain discs"


def _sizes(scene):
    """Return the names of the sizes of calls of a ``Scene``."""
    if scene.discs > ONE_CALL:
        packing = scene.discs * math.pi * scene.radius**2 / (scene.width * scene.height)
        return ("dense",) if packing > 0.65 else ("small",) if scene.walled else ("small", "torus")
    return ("least",) if scene.discs > LEAST_CALLS else ("least", "usual", "long", "error")


def runs(seeds):
    """Yield (case, call, size, number of seeds, function of a ``seed`` that yields values)."""
    for case, parameters in SCENES.items():
        scene = td.Scene(**parameters)
        for call, sizes in CALL_SIZES.items():
            for size, settings in sizes.items():
                if size in _sizes(scene):
                    half = LEAST_CALLS < scene.discs <= ONE_CALL
                    number = seeds // (4 if size == "long" else 2 if half else 1)
                    yield case, call, size, number, partial(STAGE_CALLS[call], scene, **settings)
    for (study, case), make in STUDY_CASES.items():
        yield case, study, "study", seeds, partial(table_values, make)


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


def rows(seeds, first, cases=None, calls=None):
    """Yield a row for each quantity, size, call and case, from ``seeds`` seeds from ``first`` on.

    ``cases`` and ``calls`` are the names of some, or None for all. A call that a scene refuses,
    such as a transmission without hops, has no row.
    """
    for case, call, size, number, work in runs(seeds):
        if (cases and case not in cases) or (calls and call not in calls):
            continue
        found, tests = defaultdict(list), {}
        try:
            for seed in range(first, first + number):
                for name, *value, test in work(seed=seed):
                    found[name].append(value)
                    tests[name] = test
        except td.InputError:
            continue
        for name, values in found.items():
            z, withheld = scored(values)
            start = {"case": case, "kind": kind(case), "call": call, "size": size}
            start |= {"quantity": name, "test": tests[name], "seeds": number}
            yield start | score_cells(z, withheld)


def score_cells(z, withheld):
    """Return the cells of the scores ``z``, with ``withheld`` values that have no error."""
    square = float(np.mean(z * z)) if z.size else None
    spread = float(np.std(z * z, ddof=1) / math.sqrt(z.size)) if z.size > 1 else None
    return {
        "scores": z.size, "withheld": withheld, "mean": float(z.mean()) if z.size else None,
        "mean_square": square, "stderr": spread, "beyond_three": int((np.abs(z) > 3).sum()),
    }  # fmt: skip
