"""Every number that the manuscript prints: its name, its table, its rows, its column, its format.

Nothing is computed here: what needs a fit, a correlation or a χ² is a row of the table of a study.
"""

import math

from twodiscs.model.events import EVENTS, HOPS
from twodiscs_paper.pipeline.documents.numbers.number import FIRST_HOP, MAIN, Cells, Number, Other
from twodiscs_paper.pipeline.documents.numbers.rounding import (
    AS_TYPED,
    Format,
    Printed,
    COUNTED,
    COUNTED_IN_WORDS,
    DISTINCT_IN_WORDS,
    NAME,
    RANGE,
    RANGE_OF_THREE,
    SIDES,
    WHOLE,
    WITH_ERROR,
    decimals,
    digits,
    largest,
    several,
    smallest,
    at_most,
    total,
)
from twodiscs_paper.pipeline.documents.numbers.texts import (
    CASES,
    CHANCE,
    CORRECTION,
    EXACT_OR_MEASURED,
    FAILED,
    FIRST_LETTER,
    METHODS,
    NUMBER_WORDS,
    PLAIN,
    PLURALS,
    QUOTIENT,
    RATIO,
    SEVERITY,
    SHARE,
    SHORT_EVENT,
    STEP_FLOORS,
    THEORY,
)

ESTIMATE = ("estimate", "stderr")
OVER_MEAN = ("estimate/exact_mean", "stderr/exact_mean")
TIMES_MEAN = ("estimate*exact_mean", "stderr*exact_mean")
FITTED = ("slope", "slope_stderr")
FIRST = ("first",)

# How simulations agree with the exact theory ------------------------------------------------------

COMPARED = {"passed": ...}
TESTS = {"passed": ..., "independent": True}
MEAN_SCORES = {"comparison": "z_mean"}
EVERYWHERE, STRIPS = {"starts": "invariant"}, {"starts": "strip"}

AGREEMENT = (
    Number("scenes", "grid", {}, "scene", DISTINCT_IN_WORDS),
    Number("radii", "grid", {}, "radius", COUNTED),
    Number("comparisons", "check", COMPARED, "passed", COUNTED),
    Number("tests", "check", TESTS, "passed", COUNTED),
    Number("tests_largest", "check", TESTS, "z", largest()),
    Number("tests_none_seen", "check", TESTS | {"status": "none-seen"}, "passed", COUNTED),
    Number("bounds", "check", TESTS, "bound", RANGE_OF_THREE),
    Number("sum_rule_radii", "check", COMPARED | {"comparison": "sum_rule"}, "passed", COUNTED),
    Number("sum_rule_largest", "check", COMPARED | {"comparison": "sum_rule"}, "z", largest()),
    Number("mean_time_largest", "check", COMPARED | {"comparison": "mean_time"}, "z", largest()),
    Number(
        "monte_carlo_largest", "check", {"method": ("monte_carlo", "conditioned")}, "z", largest()
    ),
    Number("dynamics_tests", "agreement", {"quantity": "mean_square"}, "count", WHOLE),
    Number("dynamics_mean_square", "agreement", {"quantity": "mean_square"}, "estimate", digits(2)),
    Number("dynamics_spread", "agreement", {"quantity": "mean_square"}, "stderr", digits(1)),
    *(
        Number(name, "agreement", {"quantity": "correlation", "event": e}, "estimate", digits(2))
        for name, e in (("correlation_walls", "right_wall"), ("correlation_hops", "vertical_hop"))
    ),
    Number("mean_scores", "check", MEAN_SCORES, "z", COUNTED),
    Number("mean_scores_largest", "check", MEAN_SCORES, "z", largest()),
    *(
        Number(f"mean_scores_{name}", "check", MEAN_SCORES | {"z": ...}, columns, form, pick)
        for pick in [("largest", "z")]
        for name, columns, form in (
            ("quantity", "quantity", NAME),
            ("box", ("width", "height"), SIDES),
        )
    ),
    Number("configurations", "cost", {"stage": "monte_carlo"}, "events", total(2)),
    Number("samples", "volume", {}, "samples", RANGE),
    Number("epsilon", "areas", {}, "epsilon", RANGE),
    Number("events", "cost", {"stage": "dynamics"}, "events", total(2)),
    Number("duration", "mean_times", EVERYWHERE, "duration", RANGE_OF_THREE),
    Number("replicas", "mean_times", EVERYWHERE, "replicas", RANGE),
    Number("target", "mean_times", {}, "target", RANGE),
    Number("strips", "mean_times", STRIPS, "exact", COUNTED_IN_WORDS),
    Number("strips_longest", "mean_times", STRIPS, "estimate", digits(2), ("largest", "estimate")),
)

RAREST = ("largest", "exact")
LONG_RUN = (
    Number(
        "long_run_events", "long_run", {"event": ("any_wall", "disc_collision")}, "count", total(2)
    ),
    Number("long_run_radius", "long_run", {}, "radius", AS_TYPED, FIRST),
    Number("long_run_error", "long_run", {}, "relative_stderr", smallest(1)),
    Number("long_run_rare", "long_run", {}, "exact", digits(2), RAREST),
    Number(
        "long_run_rare_error", "long_run", {"exact": ...}, "relative_stderr", largest(1), RAREST
    ),
    Number("long_run_largest", "long_run", {}, "z", largest()),
)

AGREEMENT_CELLS = Cells(
    "agreement",
    "check",
    {},
    ("scene",),
    (
        Number("box", "check", {}, ("width", "height"), SIDES, FIRST),
        Number("radii", "grid", {}, "radius", COUNTED),
        Number("events", "cost", {"stage": "dynamics"}, "events", total(2)),
        Number("comparisons", "check", COMPARED, "passed", COUNTED),
        Number("tests", "check", TESTS, "passed", COUNTED),
        Number("failed", "check", COMPARED, "passed", FAILED),
        Number("largest", "check", {}, "z", largest()),
    ),
)

# How times are distributed ------------------------------------------------------------------------

DENSITIES = {"quantity": "density_at_zero", "z": ...}
ODD = ("largest", "z")
ODD_DENSITY = Number("odd_density", "distributions", DENSITIES, ESTIMATE, WITH_ERROR, ODD)
HOPS_RATIO = {"event": "vertical_hop", "quantity": "last_ratio"}
DECAY = {"quantity": "rate"}


def _tail(name, event):
    """Return the numbers on the last ratio of a tail to its law."""
    ratio = {"event": event, "quantity": "last_ratio"}
    last = Number(f"tail_{name}_ratio", "tails", ratio, ESTIMATE, WITH_ERROR)
    return (
        last,
        Number(f"tail_{name}_time", "tails", ratio, "time/exact_mean", digits(2)),
        Number(
            f"tail_{name}_probability", "tails", {"quantity": "survival", "method": "weighted"},
            "estimate", digits(2), same=(last, "event", "radius", "time"),
        ),
        Number(f"tail_{name}_radius", "tails", ratio, "radius", digits(3)),
    )  # fmt: skip


def _hazards(quantity):
    return {"scene": MAIN, "quantity": quantity}


#: A hazard that falls although no drift avoids the hop, in another box than the first one.
ELSEWHERE = {"scene": Other(MAIN), "event": "vertical_hop", "quantity": "falling_without_drift"}

DISTRIBUTIONS = (
    Number("chain_factor", "agreement", {"quantity": "error_ratio"}, "estimate", largest()),
    Number("densities", "distributions", DENSITIES, "z", COUNTED),
    Number("densities_largest", "distributions", DENSITIES, "z", largest()),
    Number(
        "densities_others", "distributions", DENSITIES, "z",
        several(lambda z: at_most(sorted(map(abs, z))[:-1]) if len(z) > 1 else None),
    ),
    ODD_DENSITY,
    Number("odd_density_exact", "distributions", DENSITIES, "reference", digits(5), ODD),
    Number("odd_density_box", "distributions", DENSITIES, ("width", "height"), SIDES, ODD),
    Number("odd_density_radius", "distributions", DENSITIES, "radius", AS_TYPED, ODD),
    Number(
        "odd_density_chains", "agreement", {"quantity": "density_at_zero"}, ESTIMATE, WITH_ERROR,
        same=(ODD_DENSITY, "scene", "event", "radius"),
    ),
    *_tail("collisions", "disc_collision"),
    *_tail("hops", "vertical_hop"),
    Number(
        "tail_hops_approach", "tails", {"event": "vertical_hop", "quantity": "approach"},
        ESTIMATE, WITH_ERROR,
    ),
    Number("decay_rate", "tails", DECAY, TIMES_MEAN, WITH_ERROR),
    Number("decay_radius", "tails", DECAY, "radius", digits(3)),
    Number("decay_first", "tails", DECAY, "time/exact_mean", digits(2)),
    Number("decay_last", "tails", DECAY, "until/exact_mean", digits(2)),
    Number("decay_chi2", "tails", {"quantity": "chi2"}, "estimate", digits(3)),
    Number("decay_degrees", "tails", {"quantity": "degrees"}, "estimate", WHOLE),
    Number("decay_chance", "tails", {"quantity": "chance"}, "estimate", digits(2)),
    Number("hazards", "distributions", _hazards("rate"), "estimate", COUNTED),
    Number("plateaus", "distributions", _hazards("plateau"), "estimate", COUNTED),
    Number("plateau_cases", "distributions", _hazards("plateau"), ("event", "radius"), CASES),
    Number("plateau_rates", "distributions", _hazards("plateau"), "estimate*exact_mean", RANGE),
    Number("rates_nearest", "distributions", _hazards("rate"), "z", smallest()),
    Number(
        "falling_cases", "distributions", _hazards(("falling", "falling_without_drift")),
        ("event", "radius"), CASES,
    ),
    Number("fallen_cases", "distributions", _hazards("over_cubic"), ("event", "radius"), CASES),
    Number("over_cubic", "distributions", _hazards("over_cubic"), "estimate", RANGE),
    Number("first_passage_largest", "distributions", _hazards("first_passage"), "z", largest()),
    *(
        Number(f"elsewhere_{name}", "distributions", ELSEWHERE, columns, form, ("last",))
        for name, columns, form in (
            ("box", ("width", "height"), SIDES),
            ("radius", "radius", AS_TYPED),
            ("hazard", TIMES_MEAN, WITH_ERROR),
            ("first", "first/exact_mean", digits(2)),
            ("last", "last/exact_mean", digits(2)),
        )
    ),
)  # fmt: skip


def _rates(column, quantity, columns, form, **more):
    return Number(column, "distributions", {"quantity": quantity} | more, columns, form)


RATES_CELLS = Cells(
    "rates",
    "distributions",
    {"scene": MAIN},
    ("event", "radius"),
    (
        _rates("hop", "mean", "event", FIRST_LETTER),
        _rates("radius", "mean", "radius", AS_TYPED),
        _rates("density", "density_at_zero", TIMES_MEAN, WITH_ERROR),
        _rates("rate", "rate", TIMES_MEAN, WITH_ERROR),
        _rates("reach", "rate", "last/exact_mean", digits(2)),
        _rates("chi2", "rate", "p", CHANCE),
        _rates("trend", "trend", "p", CHANCE),
        _rates("squared_cv", "squared_cv", ESTIMATE, WITH_ERROR),
        _rates("first_passage", "first_passage", OVER_MEAN, WITH_ERROR, last=None),
    ),
)

# Power laws, effects and corrections --------------------------------------------------------------

LAWS = {"scene": MAIN, "quantity": "mean_time"}
PLAIN_EXPONENT = {"form": "plain", "parameter": "exponent"}
REDUCED = {"form": "reduced"}
SHARES = {"quantity": "never_met_share", "scene": "rough"}
ROUGH = SHARES | {"effects": Other("{}")}
WORST = ("largest", "duration", "estimate")
NEVER_MET = Number("never_met_rough", "effects", ROUGH, "estimate", digits(2), WORST)

POWERS = (
    Number("reduced_largest", "thresholds", LAWS | REDUCED, "z", largest()),
    Number(
        "strip_powers", "thresholds", LAWS | {"parameter": "strips", "estimate": 1.0},
        "event", PLURALS,
    ),
    *(
        Number(f"{hop.removesuffix('_hop')}_{name}", "thresholds", LAWS | PLAIN_EXPONENT | of, c, form)
        for hop in HOPS
        for of in [{"event": hop}]
        for name, c, form in (
            ("exponent", "estimate", digits(3)),
            ("reach", "farthest/limit_radius", digits(2, 100)),
        )
    ),
    Number("effects", "agreement", {"quantity": "effects"}, "count", WHOLE),
    Number(
        "effect_scenes", "effects", {"quantity": Other("never_met_share")}, "scene",
        DISTINCT_IN_WORDS,
    ),
    Number("effects_largest", "agreement", {"quantity": "effects"}, "estimate", largest()),
    NEVER_MET,
    Number("never_met_time", "effects", ROUGH | {"estimate": ...}, "duration", digits(2), WORST),
    Number("never_met_radius", "effects", ROUGH | {"estimate": ...}, "radius", AS_TYPED, WORST),
    Number(
        "never_met_smooth", "effects", SHARES | {"effects": "{}"}, ("count", "replicas"), SHARE,
        same=(NEVER_MET, "radius", "duration"),
    ),
    Number("statements", "errata", {}, "verdict", COUNTED),
    Number("statements_right", "errata", {"verdict": "right"}, "verdict", COUNTED),
    Number("statements_major", "errata", {"severity": "major"}, "verdict", COUNTED),
)  # fmt: skip

#: Times between hits of any wall follow from those of the right and of the top wall.
POWERS_CELLS = Cells(
    "powers",
    "thresholds",
    LAWS | {"event": Other("any_wall")},
    ("event",),
    (
        Number("event", "thresholds", PLAIN_EXPONENT, "event", SHORT_EVENT),
        Number("points", "thresholds", PLAIN_EXPONENT, "points", WHOLE),
        Number("plain", "thresholds", PLAIN_EXPONENT, ESTIMATE, WITH_ERROR),
        Number("curve", "thresholds", PLAIN_EXPONENT, "curve", digits(5)),
        Number("reduced", "thresholds", REDUCED | {"parameter": "exponent"}, ESTIMATE, WITH_ERROR),
        Number(
            "coefficient", "thresholds", REDUCED | {"parameter": "coefficient"},
            ("estimate/law", "stderr/law"), WITH_ERROR,
        ),
    ),
)  # fmt: skip

ERRATA_CELLS = Cells(
    "errata",
    "errata",
    {"verdict": Other("right")},
    (),
    (
        Number("number", "errata", {}, "number", PLAIN),
        Number("label", "errata", {}, "label", PLAIN),
        Number("section", "errata", {}, "place", PLAIN),
        Number("severity", "errata", {}, ("severity", "verdict"), SEVERITY),
        Number("ratio", "errata", {}, ("ratio", "radius"), RATIO),
        Number("by", "errata", {}, "decided_by", METHODS),
        Number("right", "errata", {}, "correction", CORRECTION),
    ),
    is_numbered=True,
)

# Passages and more discs --------------------------------------------------------------------------

#: Moments of inertia, in units of mr², as the manuscript names them; one half is a solid disc.
INERTIAS = {"one": 1.0, "half": 0.5, "quarter": 0.25, "tenth": 0.1}
FARTHEST, NEAREST = ("largest", "distance"), ("smallest", "distance")
POWER_OF_TWO = Format(lambda x: Printed(x, f"$2^({round(math.log2(x))})$"))
FILES = {"scene": MAIN, "discs": Other(2), "method": "states"}
LATTICE = {"method": "lattice"}


def _near(quantity, inertia=None, **more):
    """Return the filter of a quantity of the hop that is blocked first, near its threshold."""
    where = {"scene": MAIN, "event": FIRST_HOP, "quantity": quantity}
    return where | {"moment_of_inertia": inertia} | more


def _ends(name, where, column=ESTIMATE, form=WITH_ERROR, suffix=""):
    """Return the numbers at the largest distance from the threshold and at the smallest one."""
    return (
        Number(f"{name}_first{suffix}", "passages", where, column, form, FARTHEST),
        Number(f"{name}_last{suffix}", "passages", where, column, form, NEAREST),
    )


RING = {"method": "hops", "discs": 2}
KAPPA = _near("coefficient")
PASSAGES = (
    Number("passages", "passages", {}, "z", COUNTED),
    Number("passages_largest", "passages", {}, "z", largest()),
    *_ends("passages", KAPPA, "distance", POWER_OF_TWO, "_distance"),
    *_ends("passages", KAPPA),
    Number("passages_exponent", "passages", _near("last_exponent"), ESTIMATE, WITH_ERROR),
    *(
        Number(f"passages_rough_{name}", "passages", _near("last_exponent", i), ESTIMATE, WITH_ERROR)
        for name, i in INERTIAS.items()
    ),
    Number(
        "passages_rough_distance", "passages", _near("coefficient", ...), "distance", POWER_OF_TWO,
        NEAREST,
    ),
    Number(
        "passages_rough_half_power", "passages", _near("passage_exponent", INERTIAS["half"]),
        ESTIMATE, WITH_ERROR,
    ),
    *_ends("passages_ring_smooth", _near("diffusion", **RING)),
    *_ends("passages_ring", _near("diffusion", **RING), "distance", POWER_OF_TWO, "_distance"),
    *_ends("passages_ring_rough", _near("diffusion", INERTIAS["half"], **RING)),
    Number("passages_files", "passages", FILES | {"quantity": "diffusion"}, "estimate", RANGE),
    Number("passages_files_error", "passages", FILES | {"quantity": "diffusion"}, "stderr", largest(1)),
    Number("passages_files_discs", "passages", FILES | {"quantity": "diffusion"}, "discs", NUMBER_WORDS),
    Number("passages_files_rates", "passages", FILES | {"quantity": "rate"}, "estimate", QUOTIENT),
    Number(
        "passages_single_file", "passages", LATTICE | {"quantity": "single_file"}, ESTIMATE,
        WITH_ERROR,
    ),
    *(
        Number(f"passages_lattice_{name}", "passages", LATTICE | {"quantity": "diffusion"}, c, form, pick)
        for name, c, form, pick in (
            ("first", ESTIMATE, WITH_ERROR, ("largest", "swap")),
            ("last", ESTIMATE, WITH_ERROR, ("smallest", "swap")),
            ("swap", "swap", digits(2), ("smallest", "swap")),
        )
    ),
)  # fmt: skip

JUDGED = {"z": ...}
MORE_DISCS = (
    Number("more_discs", "more_discs", {}, "z", COUNTED),
    Number(
        "more_discs_exact", "more_discs", {"exact": ..., "event": Other("virial")}, "z", COUNTED
    ),
    Number("more_discs_sums", "more_discs", {"event": "virial"}, "z", COUNTED),
    Number("more_discs_largest", "more_discs", {}, "z", largest()),
    Number("more_discs_most", "more_discs", JUDGED, "discs", WHOLE, ("largest", "discs")),
    Number(
        "more_discs_width", "more_discs", JUDGED, "width/discs", digits(3), ("largest", "discs")
    ),
)

MORE_DISCS_CELLS = Cells(
    "more",
    "more_discs",
    {},
    ("radius", "discs"),
    (
        Number("radius", "more_discs", {}, "radius", digits(3), FIRST),
        Number("discs", "more_discs", {}, "discs", WHOLE, FIRST),
        Number("theory", "more_discs", {}, "theory", THEORY, FIRST),
        *(
            Number(
                event, "more_discs", {"event": event}, ("dynamics", "dynamics_stderr", "exact"),
                EXACT_OR_MEASURED,
            )
            for event in EVENTS
            if event != "any_wall"
        ),
        Number("largest", "more_discs", {}, "z", largest()),
    ),
    is_sorted=True,
    is_numbered=True,
)  # fmt: skip

# What a digit costs, and where arithmetic has it hard ---------------------------------------------

#: The fitted powers: (part, method, quantity) in accuracy_cost.csv.
PRICES = {
    "power_rejection": ("volume", "rejection", "volume"),
    "power_surface": ("area", "surface", "disc_collision_area"),
    "power_balanced_shell": ("area", "balanced_shell", "disc_collision_area"),
    "power_sobol_volume": ("volume", "sobol", "volume"),
    "power_sobol_area": ("area", "sobol", "disc_collision_area"),
    "power_lockstep": ("time", "lockstep", "vertical_hop_time"),
    "power_scalar": ("time", "scalar", "vertical_hop_time"),
}
SHELLS = {"part": "floor", "quantity": "disc_collision_area"}
STEPS = {"part": "floor", "quantity": "vertical_hop_time"}
THICKEST = ("largest", "setting")

COSTS = (
    *(
        Number(name, "accuracy_cost", dict(zip(("part", "method", "quantity"), of, strict=True)), FITTED,
               WITH_ERROR, FIRST)
        for name, of in PRICES.items()
    ),
    Number("shell_floor", "accuracy_cost", SHELLS, "error", digits(2), THICKEST),
    Number("shell_epsilon", "accuracy_cost", SHELLS, "setting", digits(2), THICKEST),
    Number("step_floors", "accuracy_cost", STEPS, ("setting", "error"), STEP_FLOORS),
    Number(
        "evaluation_seconds", "accuracy_cost", {"method": "exact"}, "seconds", digits(1),
        ("largest", "seconds"),
    ),
    *(
        Number(name, "accuracy_cost", {"part": "speed", "method": method}, "setting", decimals(1))
        for name, method in (("lockstep_faster", "lockstep"), ("single_faster", "single_precision"))
    ),
    Number(
        "price_error", "accuracy_cost", {"part": "radius"}, "error", digits(1),
        ("smallest", "error"),
    ),
    Number(
        "strip_seconds", "accuracy_cost", {"part": "radius", "method": "strip"}, "seconds",
        largest(1),
    ),
)  # fmt: skip


def _stability(name, part, quantity, form, **more):
    where = {"part": part} | ({"quantity": quantity} if quantity else {}) | more
    return Number(name, "stability", where, "value", form)


EXACT_VALUES = ("volume", "areas", "mean_times")
STABILITY = (
    _stability("theory_error", "theory", EXACT_VALUES, largest(), method="stable"),
    _stability(
        "accepted_least", "sampling", "accepted_share", smallest(3, 100), method="conditioned"
    ),
    Number(
        "longest_run", "stability", {"part": "dynamics"}, "count", digits(2), ("largest", "count")
    ),
    _stability("energy_error", "dynamics", "energy_error", largest()),
    _stability("overlap", "dynamics", "smallest_gap", several(lambda gaps: at_most([-min(gaps)]))),
    _stability("contact_time", "times", "contact_time", largest()),
    _stability("coverage_least", "coverage", None, smallest(3, 100)),
    _stability("coverage_most", "coverage", None, largest(3, 100)),
)

NUMBERS = (
    *AGREEMENT,
    *LONG_RUN,
    *DISTRIBUTIONS,
    *POWERS,
    *PASSAGES,
    *MORE_DISCS,
    *COSTS,
    *STABILITY,
)
CELLS = (AGREEMENT_CELLS, RATES_CELLS, POWERS_CELLS, ERRATA_CELLS, MORE_DISCS_CELLS)
