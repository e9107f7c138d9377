"""Every number that the manuscript prints: its name, its table, its rows, its column, its format.

Nothing is computed here: the results of fits, correlations and χ² are rows of tables of studies.
``read`` reads these tables, and ``printed`` returns the numbers.
"""

import sys
from pathlib import Path

from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.comparison.tables.base import NUMBER, TEXT, Table
from twodiscs.model.events import HOPS, SHELLS
from twodiscs_paper.catalogue import STUDY_TABLES
from twodiscs_paper.pipeline.documents.formats import (
    AS_TYPED,
    CASES,
    CHANCE,
    CORRECTION,
    COUNTED,
    COUNTED_IN_WORDS,
    DISTINCT_IN_WORDS,
    EXACT_OR_MEASURED,
    FAILED,
    FIRST_HOP,
    FIRST_LETTER,
    INTEGER,
    MAIN,
    METHODS,
    NAME,
    NUMBER_WORDS,
    OTHERS,
    OVERLAP,
    PLAIN,
    PLURALS,
    POWER_OF_TWO,
    QUOTIENT,
    RANGE,
    RANGE_OF_THREE,
    RATIO,
    SEVERITY,
    SHARE,
    SHORT_EVENT,
    SIDES,
    SPREAD,
    STEP_FLOORS,
    THEORY,
    WITH_ERROR,
    Cells,
    NoRow,
    Number,
    Other,
    decimals,
    digits,
    largest,
    smallest,
    total,
)


def _of(table):
    """Return a function that declares a number of a ``table``."""
    return lambda name, where, *how, **same: Number(name, table, where, *how, **same)


check, grid, volume, areas, mean_times = map(
    _of, ("check", "grid", "volume", "areas", "mean_times")
)
cost, agreement, errata = map(_of, ("cost", "agreement", "errata"))
long_run, long_passages, long_tails = map(_of, ("long_run", "long_passages", "long_tails"))
distributions, tails, thresholds = map(_of, ("distributions", "tails", "thresholds"))
effects, passages, more_discs = map(_of, ("effects", "passages", "more_discs"))
accuracy_cost, stability = map(_of, ("accuracy_cost", "stability"))

ESTIMATE = ("estimate", "stderr")
OVER_MEAN = ("estimate/exact_mean", "stderr/exact_mean")
TIMES_MEAN = ("estimate*exact_mean", "stderr*exact_mean")
FITTED = ("slope", "slope_stderr")
FIRST = ("first",)
FARTHEST, NEAREST = ("largest", "distance"), ("smallest", "distance")

# How simulations agree with the exact theory ------------------------------------------------------

COMPARED = {"passed": ...}
TESTS = {"passed": ..., "independent": True}
MEAN_SCORES = {"comparison": "z_mean"}
EVERYWHERE, STRIPS = {"starts": "invariant"}, {"starts": "strip"}

AGREEMENT = (
    check("comparisons", COMPARED, "passed", COUNTED),
    check("tests", TESTS, "passed", COUNTED),
    check("tests_largest", TESTS, "z", largest()),
    check("tests_none_seen", TESTS | {"status": "none-seen"}, "passed", COUNTED),
    check("bounds", TESTS, "bound", RANGE_OF_THREE),
    check("sum_rule_radii", COMPARED | {"comparison": "sum_rule"}, "passed", COUNTED),
    check("sum_rule_largest", COMPARED | {"comparison": "sum_rule"}, "z", largest()),
    check("mean_time_largest", COMPARED | {"comparison": "mean_time"}, "z", largest()),
    check("monte_carlo_largest", {"method": ("monte_carlo", "conditioned")}, "z", largest()),
    agreement("dynamics_tests", {"quantity": "mean_square"}, "count", INTEGER),
    agreement("dynamics_mean_square", {"quantity": "mean_square"}, "estimate", digits(2)),
    agreement("dynamics_spread", {"quantity": "mean_square"}, "stderr", digits(1)),
    *(
        agreement(name, {"quantity": "correlation", "event": e}, "estimate", digits(2))
        for name, e in (("correlation_walls", "right_wall"), ("correlation_hops", "vertical_hop"))
    ),
    check("mean_scores", MEAN_SCORES, "z", COUNTED),
    check("mean_scores_largest", MEAN_SCORES, "z", largest()),
    *(
        check(f"mean_scores_{name}", MEAN_SCORES | {"z": ...}, columns, form, pick)
        for pick in [("largest", "z")]
        for name, columns, form in (
            ("quantity", "quantity", NAME),
            ("box", ("width", "height"), SIDES),
        )
    ),
    cost("configurations", {"stage": "monte_carlo"}, "events", total(2)),
    volume("samples", {}, "samples", RANGE),
    areas("epsilon", {}, "epsilon", RANGE),
    cost("events", {"stage": "dynamics"}, "events", total(2)),
    mean_times("duration", EVERYWHERE, "duration", RANGE_OF_THREE),
    mean_times("replicas", EVERYWHERE, "replicas", RANGE),
    mean_times("target", {}, "target", RANGE),
    mean_times("strips", STRIPS, "exact", COUNTED_IN_WORDS),
    mean_times("strips_longest", STRIPS, "estimate", digits(2), ("largest", "estimate")),
)

RAREST = ("largest", "exact")
DECAY = {"quantity": "rate"}
POWER = {"quantity": "survival", "law": ...}
RELATIVE = ("estimate/law", "stderr/law")
PAUSES = {"scene": "pause", "quantity": "coefficient"}
SMOOTH = {"scene": Other("pause"), "quantity": "coefficient"}
APPROACH = {"quantity": "approach"}
LONG_RUN = (
    long_run("long_run_events", {"event": ("any_wall", "disc_collision")}, "count", total(2)),
    long_run("long_run_radius", {}, "radius", AS_TYPED, FIRST),
    long_run("long_run_error", {}, "relative_stderr", smallest(1)),
    long_run("long_run_rare", {}, "exact", digits(2), RAREST),
    long_run("long_run_rare_error", {"exact": ...}, "relative_stderr", largest(1), RAREST),
    long_run("long_run_largest", {}, "z", largest()),
    *(
        long_passages(
            f"long_exponent_{name}",
            {"event": hop, "quantity": "last_exponent"},
            ESTIMATE,
            WITH_ERROR,
        )
        for name, hop in (("horizontal", "horizontal_hop"), ("vertical", "vertical_hop"))
    ),
    long_passages("long_kappa", SMOOTH | {"event": FIRST_HOP}, ESTIMATE, WITH_ERROR, NEAREST),
    *(
        long_passages(f"pause_{name}", PAUSES, ESTIMATE, WITH_ERROR, (which, "time"))
        for name, which in (("once", "smallest"), ("twice", "largest"))
    ),
    long_passages("pause_distance", PAUSES, "distance", POWER_OF_TWO, FIRST),
    long_passages("long_distance", {"quantity": "last_exponent"}, "distance", POWER_OF_TWO, FIRST),
    long_passages("long_hops", SMOOTH, "replicas", RANGE),
    *(
        number
        for end, pick in (("first", FIRST), ("last", ("last",)))
        for number in (
            long_tails(f"long_time_{end}", APPROACH, "time/exact_mean", digits(2), pick),
            long_tails(f"long_approach_{end}", APPROACH, ESTIMATE, WITH_ERROR, pick),
            long_tails(f"long_ratio_{end}", POWER, RELATIVE, WITH_ERROR, pick),
            long_tails(f"long_rate_{end}", DECAY, TIMES_MEAN, WITH_ERROR, pick),
            long_tails(f"long_rate_{end}_from", DECAY, "time/exact_mean", digits(2), pick),
            long_tails(f"long_rate_{end}_to", DECAY, "until/exact_mean", digits(2), pick),
        )
    ),
)

AGREEMENT_CELLS = Cells(
    "agreement",
    "check",
    {},
    ("scene",),
    (
        check("box", {}, ("width", "height"), SIDES, FIRST),
        grid("radii", {}, "radius", COUNTED),
        cost("events", {"stage": "dynamics"}, "events", total(2)),
        check("comparisons", COMPARED, "passed", COUNTED),
        check("tests", TESTS, "passed", COUNTED),
        check("failed", COMPARED, "passed", FAILED),
        check("largest", {}, "z", largest()),
    ),
)

# How times are distributed ------------------------------------------------------------------------

DENSITIES = {"quantity": "density_at_zero", "z": ...}
ODD = ("largest", "z")
ODD_DENSITY = distributions("odd_density", DENSITIES, ESTIMATE, WITH_ERROR, ODD)


def _tail(name, event):
    """Return the numbers on the last ratio of a tail to its law."""
    ratio = {"event": event, "quantity": "last_ratio"}
    last = tails(f"tail_{name}_ratio", ratio, ESTIMATE, WITH_ERROR)
    return (
        last,
        tails(f"tail_{name}_time", ratio, "time/exact_mean", digits(2)),
        tails(
            f"tail_{name}_probability",
            {"quantity": "survival", "method": "weighted"},
            "estimate",
            digits(2),
            same=(last, "event", "radius", "time"),
        ),
        tails(f"tail_{name}_radius", ratio, "radius", digits(3)),
    )


def _hazards(quantity):
    return {"scene": MAIN, "quantity": quantity}


#: A hazard that falls although no drift avoids the hop, in another box than the first.
ELSEWHERE = {"scene": Other(MAIN), "event": "vertical_hop", "quantity": "falling_without_drift"}

DISTRIBUTIONS = (
    agreement("chain_factor", {"quantity": "error_ratio"}, "estimate", largest()),
    distributions("densities", DENSITIES, "z", COUNTED),
    distributions("densities_largest", DENSITIES, "z", largest()),
    distributions("densities_others", DENSITIES, "z", OTHERS),
    ODD_DENSITY,
    distributions("odd_density_exact", DENSITIES, "reference", digits(5), ODD),
    distributions("odd_density_box", DENSITIES, ("width", "height"), SIDES, ODD),
    distributions("odd_density_radius", DENSITIES, "radius", AS_TYPED, ODD),
    agreement(
        "odd_density_chains",
        {"quantity": "density_at_zero"},
        ESTIMATE,
        WITH_ERROR,
        same=(ODD_DENSITY, "scene", "event", "radius"),
    ),
    *_tail("collisions", "disc_collision"),
    *_tail("hops", "vertical_hop"),
    tails("decay_rate", DECAY, TIMES_MEAN, WITH_ERROR),
    tails("decay_radius", DECAY, "radius", digits(3)),
    tails("decay_first", DECAY, "time/exact_mean", digits(2)),
    tails("decay_last", DECAY, "until/exact_mean", digits(2)),
    tails("decay_chi2", {"quantity": "chi2"}, "estimate", digits(3)),
    tails("decay_degrees", {"quantity": "degrees"}, "estimate", INTEGER),
    tails("decay_chance", {"quantity": "chance"}, "estimate", digits(2)),
    distributions("hazards", _hazards("rate"), "estimate", COUNTED),
    distributions("plateaus", _hazards("plateau"), "estimate", COUNTED),
    distributions("plateau_cases", _hazards("plateau"), ("event", "radius"), CASES),
    distributions("plateau_rates", _hazards("plateau"), "estimate*exact_mean", RANGE),
    distributions("rates_nearest", _hazards("rate"), "z", smallest()),
    distributions(
        "falling_cases", _hazards(("falling", "falling_without_drift")), ("event", "radius"), CASES
    ),
    distributions("fallen_cases", _hazards("over_cubic"), ("event", "radius"), CASES),
    distributions("over_cubic", _hazards("over_cubic"), "estimate", RANGE),
    distributions("first_passage_largest", _hazards("first_passage"), "z", largest()),
    *(
        distributions(f"elsewhere_{name}", ELSEWHERE, columns, form, ("last",))
        for name, columns, form in (
            ("box", ("width", "height"), SIDES),
            ("radius", "radius", AS_TYPED),
            ("hazard", TIMES_MEAN, WITH_ERROR),
            ("first", "first/exact_mean", digits(2)),
            ("last", "last/exact_mean", digits(2)),
        )
    ),
)


def _rates(column, quantity, columns, form, **more):
    return distributions(column, {"quantity": quantity} | more, columns, form)


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
NEVER_MET = effects("never_met_rough", ROUGH, "estimate", digits(2), WORST)

POWERS = (
    thresholds("reduced_largest", LAWS | REDUCED, "z", largest()),
    thresholds("strip_powers", LAWS | {"parameter": "strips", "estimate": 1.0}, "event", PLURALS),
    *(
        thresholds(f"{hop.removesuffix('_hop')}_{name}", LAWS | PLAIN_EXPONENT | of, c, form)
        for hop in HOPS
        for of in [{"event": hop}]
        for name, c, form in (
            ("exponent", "estimate", digits(3)),
            ("reach", "farthest/limit_radius", digits(2, 100)),
        )
    ),
    agreement("effects", {"quantity": "effects"}, "count", INTEGER),
    agreement("third_virial", {"quantity": "third_virial"}, "estimate", digits(9)),
    thresholds(
        "reduced_vertical",
        LAWS | REDUCED | {"event": "vertical_hop", "parameter": "exponent"},
        ESTIMATE,
        WITH_ERROR,
    ),
    effects("effect_scenes", {"quantity": Other("never_met_share")}, "scene", DISTINCT_IN_WORDS),
    agreement("effects_largest", {"quantity": "effects"}, "estimate", largest()),
    NEVER_MET,
    effects("never_met_time", ROUGH | {"estimate": ...}, "duration", digits(2), WORST),
    effects("never_met_radius", ROUGH | {"estimate": ...}, "radius", AS_TYPED, WORST),
    effects(
        "never_met_smooth",
        SHARES | {"effects": "{}"},
        ("count", "replicas"),
        SHARE,
        same=(NEVER_MET, "radius", "duration"),
    ),
    errata("statements", {}, "verdict", COUNTED),
    errata("statements_right", {"verdict": "right"}, "verdict", COUNTED),
    errata("statements_major", {"severity": "major"}, "verdict", COUNTED),
)

#: Times between hits of any wall follow from the times of the right and the top wall.
POWERS_CELLS = Cells(
    "powers",
    "thresholds",
    LAWS | {"event": Other("any_wall")},
    ("event",),
    (
        thresholds("event", PLAIN_EXPONENT, "event", SHORT_EVENT),
        thresholds("points", PLAIN_EXPONENT, "points", INTEGER),
        thresholds("plain", PLAIN_EXPONENT, ESTIMATE, WITH_ERROR),
        thresholds("curve", PLAIN_EXPONENT, "curve", digits(5)),
        thresholds("reduced", REDUCED | {"parameter": "exponent"}, ESTIMATE, WITH_ERROR),
        thresholds(
            "coefficient",
            REDUCED | {"parameter": "coefficient"},
            ("estimate/law", "stderr/law"),
            WITH_ERROR,
        ),
    ),
)

ERRATA_CELLS = Cells(
    "errata",
    "errata",
    {"verdict": Other("right")},
    (),
    (
        errata("number", {}, "number", PLAIN),
        errata("label", {}, "label", PLAIN),
        errata("section", {}, "place", PLAIN),
        errata("severity", {}, ("severity", "verdict"), SEVERITY),
        errata("ratio", {}, ("ratio", "radius"), RATIO),
        errata("by", {}, "decided_by", METHODS),
        errata("right", {}, "correction", CORRECTION),
    ),
    is_numbered=True,
)

# Passages and more discs --------------------------------------------------------------------------

#: Moments of inertia, in units of mr², as the manuscript names them; one half is a solid disc.
INERTIAS = {"one": 1.0, "half": 0.5, "quarter": 0.25, "tenth": 0.1}
FILES = {"scene": MAIN, "discs": Other(2), "method": "states"}
LATTICE = {"method": "lattice"}


def _near(quantity, inertia=None, **more):
    """Return the filter of a quantity of the hop that is blocked first, near its threshold."""
    where = {"scene": MAIN, "event": FIRST_HOP, "quantity": quantity}
    return where | {"moment_of_inertia": inertia, "friction": None} | more


def _ends(name, where, column=ESTIMATE, form=WITH_ERROR, suffix=""):
    """Return the numbers at the largest distance from the threshold and at the smallest one."""
    return (
        passages(f"{name}_first{suffix}", where, column, form, FARTHEST),
        passages(f"{name}_last{suffix}", where, column, form, NEAREST),
    )


RING = {"method": "hops", "discs": 2}
KICKED = {"scene": MAIN, "discs": 2, "friction": ..., "quantity": "coefficient"}
LOCAL_POWERS = KICKED | {"quantity": "local_exponent"}
ORDER = {"scene": MAIN, "quantity": "diffusion", "method": "order"}
KAPPA = _near("coefficient")
PASSAGES = (
    passages("passages", {}, "z", COUNTED),
    passages("passages_largest", {}, "z", largest()),
    *_ends("passages", KAPPA, "distance", POWER_OF_TWO, "_distance"),
    *_ends("passages", KAPPA),
    passages("passages_c", {"quantity": "amplitude"}, ESTIMATE, WITH_ERROR),
    passages("passages_exponent", _near("last_exponent"), ESTIMATE, WITH_ERROR),
    *(
        passages(f"passages_rough_{name}", _near("last_exponent", i), ESTIMATE, WITH_ERROR)
        for name, i in INERTIAS.items()
    ),
    passages(
        "passages_rough_distance", _near("coefficient", ...), "distance", POWER_OF_TWO, NEAREST
    ),
    passages(
        "passages_rough_last", _near("coefficient", INERTIAS["half"]), ESTIMATE, WITH_ERROR, NEAREST
    ),
    passages(
        "passages_rough_half_power",
        _near("passage_exponent", INERTIAS["half"]),
        ESTIMATE,
        WITH_ERROR,
    ),
    passages("friction_rates", KICKED, "friction", RANGE),
    *(
        passages(f"friction_kappa_{name}", KICKED, ESTIMATE, WITH_ERROR, (which, "estimate"))
        for name, which in (("least", "smallest"), ("most", "largest"))
    ),
    *(
        passages(f"friction_{what}_{name}", LOCAL_POWERS | {"friction": rate}, column, form, pick)
        for name, rate, pick in (("diffusive", 160.0, FARTHEST), ("ballistic", 10.0, NEAREST))
        for what, column, form in (
            ("power", ESTIMATE, WITH_ERROR),
            ("rate", "friction", digits(3)),
        )
    ),
    passages("friction_rates_z", KICKED | {"quantity": "rate"}, "z", largest()),
    *_ends("passages_ring_smooth", _near("diffusion", **RING)),
    *_ends("passages_ring", _near("diffusion", **RING), "distance", POWER_OF_TWO, "_distance"),
    *_ends("passages_ring_rough", _near("diffusion", INERTIAS["half"], **RING)),
    passages("passages_files_least", FILES | {"quantity": "diffusion"}, "estimate", smallest()),
    passages("passages_files_most", FILES | {"quantity": "diffusion"}, "estimate", largest()),
    passages("passages_files_error", FILES | {"quantity": "diffusion"}, "stderr", largest(1)),
    passages("passages_files_discs", FILES | {"quantity": "diffusion"}, "discs", NUMBER_WORDS),
    *(
        passages(
            f"passages_files_rates_{name}",
            FILES | {"quantity": "rate", "discs": discs},
            "estimate",
            QUOTIENT,
        )
        for name, discs in (("four", 4), ("eight", 8))
    ),
    passages("long_files_discs", ORDER | {"friction": None}, "discs", INTEGER, FARTHEST),
    *_ends("long_files_smooth", ORDER | {"friction": None}),
    *_ends("long_files_kicked", ORDER | {"friction": ...}),
    *_ends("long_files", ORDER | {"friction": None}, "distance", POWER_OF_TWO, "_distance"),
    passages("long_files_law_z", {"method": "states", "quantity": "single_file"}, "z", largest()),
    passages("passages_lattice_z", LATTICE | {"quantity": "diffusion"}, "z", largest()),
    passages("passages_single_file", LATTICE | {"quantity": "single_file"}, ESTIMATE, WITH_ERROR),
    *(
        passages(f"passages_lattice_{name}", LATTICE | {"quantity": "diffusion"}, c, form, pick)
        for name, c, form, pick in (
            ("first", ESTIMATE, WITH_ERROR, ("largest", "swap")),
            ("last", ESTIMATE, WITH_ERROR, ("smallest", "swap")),
            ("swap", "swap", digits(2), ("smallest", "swap")),
        )
    ),
)

JUDGED = {"z": ...}
MORE_DISCS = (
    more_discs("more_discs", {}, "z", COUNTED),
    more_discs("more_discs_exact", {"exact": ..., "event": Other("virial")}, "z", COUNTED),
    more_discs("more_discs_sums", {"event": "virial"}, "z", COUNTED),
    more_discs("more_discs_largest", {}, "z", largest()),
    more_discs("more_discs_sampled", {}, "monte_carlo_z", COUNTED),
    more_discs("more_discs_sampled_largest", {}, "monte_carlo_z", largest()),
    more_discs("more_discs_top", {"event": "top_wall"}, ("radius", "dynamics"), SPREAD),
    more_discs("more_discs_most", JUDGED, "discs", INTEGER, ("largest", "discs")),
    more_discs("more_discs_width", JUDGED, "width/discs", digits(3), ("largest", "discs")),
)

MORE_DISCS_CELLS = Cells(
    "more",
    "more_discs",
    {},
    ("radius", "discs"),
    (
        more_discs("radius", {}, "radius", digits(3), FIRST),
        more_discs("discs", {}, "discs", INTEGER, FIRST),
        more_discs("theory", {}, "theory", THEORY, FIRST),
        *(
            more_discs(
                event, {"event": event}, ("dynamics", "dynamics_stderr", "exact"), EXACT_OR_MEASURED
            )
            for event in SHELLS
        ),
        more_discs("largest", {}, "z", largest()),
    ),
    is_sorted=True,
    is_numbered=True,
)

# The cost of a digit, and numerically hard cases --------------------------------------------------

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
FLOORS = {"part": "floor", "quantity": "disc_collision_area"}
STEPS = {"part": "floor", "quantity": "vertical_hop_time"}
THICKEST = ("largest", "setting")

COSTS = (
    *(
        accuracy_cost(
            name,
            dict(zip(("part", "method", "quantity"), of, strict=True)),
            FITTED,
            WITH_ERROR,
            FIRST,
        )
        for name, of in PRICES.items()
    ),
    accuracy_cost("shell_floor", FLOORS, "error", digits(2), THICKEST),
    accuracy_cost("shell_epsilon", FLOORS, "setting", digits(2), THICKEST),
    accuracy_cost("step_floors", STEPS, ("setting", "error"), STEP_FLOORS),
    accuracy_cost(
        "evaluation_seconds", {"method": "exact"}, "seconds", digits(1), ("largest", "seconds")
    ),
    *(
        accuracy_cost(name, {"part": "speed", "method": method}, "setting", decimals(1))
        for name, method in (("lockstep_faster", "lockstep"), ("single_faster", "single_precision"))
    ),
    accuracy_cost("price_error", {"part": "radius"}, "error", digits(1), ("smallest", "error")),
    accuracy_cost("strip_seconds", {"part": "radius", "method": "strip"}, "seconds", largest(1)),
)


def _stability(name, part, quantity, form, **more):
    where = {"part": part} | ({"quantity": quantity} if quantity else {}) | more
    return stability(name, where, "value", form)


EXACT_VALUES = ("volume", "areas", "mean_times")
STABILITY = (
    _stability("theory_error", "theory", EXACT_VALUES, largest(), method="stable"),
    _stability(
        "accepted_least", "sampling", "accepted_share", smallest(3, 100), method="conditioned"
    ),
    stability("longest_run", {"part": "dynamics"}, "count", digits(2), ("largest", "count")),
    _stability("energy_error", "dynamics", "energy_error", largest()),
    _stability("overlap", "dynamics", "smallest_gap", OVERLAP),
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

# The tables, and what is printed -----------------------------------------------------------------

#: The tables of scenes and of studies that numbers are taken from.
READ = {number.table for number in (*NUMBERS, *(cell for table in CELLS for cell in table.cells))}
OF_SCENES = sorted(READ & SCENE_TABLES.keys())
OF_STUDIES = sorted(READ & STUDY_TABLES.keys())

#: Tables of the long runs, which are kept: no build makes them.
LONG_RUNS = {
    "long_run": SCENE_TABLES["mean_times"],
    "long_passages": STUDY_TABLES["passages"],
    "long_tails": STUDY_TABLES["tails"],
}


class PaperNumbers(Table):
    """One row per number that the manuscript prints."""

    columns = {
        "name": TEXT("its name in the manuscript; table/row/column for a cell of a table"),
        "value": NUMBER("the number itself, if the text shows one number"),
        "text": TEXT("the printed text, as markup of Typst; empty for an empty cell"),
    }


def read(results, scenes, long_runs=None):
    """Return {name: rows} of the tables in the folder ``results`` that numbers are taken from.

    ``long_runs`` are {name: path} of tables among ``LONG_RUNS``. ``scenes`` have a "name", "width"
    and "height" each, which are added to the rows of a scene, and the names of their "tables".
    Raises ``OSError`` for a table that is missing, ``InputError`` for a file that
    is no table.
    """
    tables = {name: [] for name in (*OF_SCENES, *OF_STUDIES)}
    for scene in scenes:
        start = {"scene": scene["name"], "width": scene["width"], "height": scene["height"]}
        for name in set(OF_SCENES).intersection(scene["tables"]):
            path = Path(results, scene["name"], f"{name}.csv")
            tables[name] += [start | row for row in SCENE_TABLES[name].read(path)]
    for name in OF_STUDIES:
        tables[name] = STUDY_TABLES[name].read(Path(results, f"{name}.csv"))
    paths = long_runs or {}
    return tables | {
        name: kind.read(paths[name]) if name in paths else [] for name, kind in LONG_RUNS.items()
    }


def printed(tables, scenes):
    """Return {name: ``Printed``} of all that the manuscript prints.

    ``tables`` are as ``read`` returns them; the manuscript is about the first of the ``scenes``. A
    number without a row is left out, because a configuration may have less; its sentence goes to
    the standard error. Raises ``InputError`` for a number with several rows instead of one.
    """
    main = scenes[0]
    hop = "horizontal_hop" if main["width"] > main["height"] else "vertical_hop"
    given, found = {MAIN: main["name"], FIRST_HOP: hop}, {}
    for number in NUMBERS:
        try:
            found[number.name] = number.printed(tables, given)
        except NoRow as error:
            print(error, file=sys.stderr)
    for cells in CELLS:
        found |= cells.printed(tables, given)
    return {name: number for name, number in found.items() if number is not None}


def table_rows(values):
    """Return the rows of paper_numbers.csv for the numbers ``values``."""
    return [
        {"name": name, "value": None if value is None else float(value), "text": text or None}
        for name, (value, text) in values.items()
    ]
