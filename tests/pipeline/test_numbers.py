"""The numbers of the manuscript: how they are rounded, and that they are what the tables say."""

import math
import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from twodiscs.comparison.digests import read_json
from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.comparison.tables.exact import Theory
from twodiscs.comparison.tables.mean_times import MeanTimes
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.model.checks import InputError
from twodiscs.model.events import EVENTS, HOPS
from twodiscs_paper.catalogue import STUDY_TABLES
from twodiscs_paper.pipeline.configuration.load import load
from twodiscs_paper.pipeline.configuration.reading import read
from twodiscs_paper.pipeline.documents.numbers import (
    agreement,
    costs,
    distributions,
    laws,
    more_discs,
    passages,
    rounding,
    table,
)

SOURCE = (Path(__file__).resolve().parents[2] / "paper" / "paper.typ").read_text()
TABLES = SCENE_TABLES | STUDY_TABLES
BOX = {"name": "main", "width": 1.5, "height": 1.0}


def rows(name, *values):
    """Return rows of a table that are empty but for ``values``, dicts."""
    columns = TABLES[name].columns()
    assert all(columns.keys() >= value.keys() for value in values)
    return [TABLES[name].empty(**value) for value in values]


def texts(found):
    """Return {name: text} of those numbers that there are."""
    return {name: number.text for name, number in found.items() if number is not None}


# Rounding -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("number", "shown"),
    [
        (rounding.significant(0, 2), "$0$"),
        (rounding.significant(3.14159, 3), "$3.14$"),
        (rounding.significant(0.0999, 2), "$0.1$"),
        (rounding.significant(-1234.0, 3), "$-1230$"),
        (rounding.significant(9996.0, 3), "$10^(4)$"),
        (rounding.significant(44312345678, 2), "$4.4 times 10^(10)$"),
        (rounding.significant(1e-15, 2), "$10^(-15)$"),
        (rounding.significant(0.03125, 3), "$0.0313$"),
        (rounding.with_error(0.8134, 0.0021), "$0.813 (2)$"),
        (rounding.with_error(-0.6098, 0.1141), "$-0.61 (11)$"),
        (rounding.with_error(1.0, 0.03), "$1.00 (3)$"),
        (rounding.with_error(0.9996, 0.00096), "$0.9996 (10)$"),
        (rounding.with_error(0.03, 0.0098), "$0.030 (10)$"),
        (rounding.with_error(120.0, 30.0), "$120 (30)$"),
        (rounding.at_most([0.3, 3.013]), "$3.1$"),
        (rounding.at_most([3.1, 0.0]), "$3.1$"),
        (rounding.at_most([1.525e-15]), "$1.6 times 10^(-15)$"),
        (rounding.at_most([9.96]), "$10$"),
        (rounding.at_most([0.0926], 1), "$0.1$"),
        (rounding.at_least([3.19, 9.98]), "$3.1$"),
        (rounding.percent_at_least([0.39689, 0.5]), "$39.6$"),
        (rounding.percent_at_most([0.28, 0.07]), "$28$"),
        (rounding.span([0.5, 12345, 2.0]), "$0.5$ to $1.2 times 10^(4)$"),
        (rounding.span([2.0, 2.0]), "$2$"),
        (rounding.in_words(2), "two"),
        (rounding.in_words(12), "12"),
        (rounding.sides(1.5, 1.0), "$1.5 times 1$"),
        (rounding.sides(3e-6, 1e-5), "$(3 times 10^(-6)) times 10^(-5)$"),
    ],
)
def test_numbers_are_written_as_physicists_do(number, shown):
    assert number.text == shown


def test_bounds_hold_and_are_tight():
    for x in np.random.default_rng(1).lognormal(0, 20, 1000):
        up, down = (float(f(x)) for f in (rounding.rounded_up, rounding.rounded_down))
        assert down * (1 - 1e-11) <= x <= up * (1 + 1e-11)
        assert up - down <= 0.1001 * down


@pytest.mark.parametrize(
    "function", [rounding.at_most, rounding.at_least, rounding.span, rounding.percent_at_least]
)
def test_of_nothing_there_is_no_number(function):
    assert function([]) is None


# Groups -------------------------------------------------------------------------------------------


def scene_rows(name, *values):
    return [{"scene": "main", **row} for row in rows(name, *values)]


@pytest.fixture
def tables():
    """Return tables whose numbers are easily seen."""
    verdict = {"passed": True, "independent": True, "bound": 4.75}
    found = {name: [] for name in (*table.OF_SCENES, *table.OF_STUDIES, "long_run")}
    found["grid"] = scene_rows("grid", {"radius": 0.1}, {"radius": 0.2})
    found["check"] = scene_rows(
        "check",
        verdict | {"comparison": "volume", "method": "monte_carlo", "z": -1.25},
        verdict | {"comparison": "mean_time", "method": "dynamics", "z": 2.51, "passed": False},
        verdict
        | {"comparison": "mean_time", "method": "dynamics", "z": 0.1}
        | {"status": "none-seen", "bound": 4.25},
        verdict | {"comparison": "area", "method": "conditioned", "z": 3.01, "independent": False},
        verdict
        | {"comparison": "sum_rule", "method": "dynamics", "z": -3.51}
        | {"independent": False},
        {"comparison": "area", "method": "monte_carlo"},
    )
    found["cost"] = scene_rows(
        "cost",
        {"stage": "monte_carlo", "events": 4_000_000},
        {"stage": "dynamics", "events": 70_000_000},
        {"stage": "dynamics", "events": 5_000_000},
    )
    found["volume"] = scene_rows("volume", {"samples": 1000}, {"samples": 250_000})
    found["areas"] = scene_rows("areas", {"epsilon": 0.002}, {"epsilon": None})
    found["mean_times"] = scene_rows(
        "mean_times",
        {"starts": "invariant", "duration": 0.5, "replicas": 7000, "target": 1e-3, "exact": 2.0},
        {"starts": "strip", "duration": 1e-5, "replicas": 10, "target": 1e-3, "exact": 1.2e7},
    )
    return found


def test_agreement_counts_tests_and_their_largest_deviation(tables):
    found = texts(agreement.agreement(tables, [BOX]))
    assert found == {
        "scenes": "one",
        "radii": "2",
        "comparisons": "5",
        "tests": "3",
        "tests_largest": "$2.6$",
        "tests_none_seen": "1",
        "bounds": "$4.25$ to $4.75$",
        "sum_rule_radii": "1",
        "sum_rule_largest": "$3.6$",
        "mean_time_largest": "$2.6$",
        "monte_carlo_largest": "$3.1$",
    }
    assert [texts(row) for row in agreement.agreement_table(tables, [BOX]).values()] == [
        {"box": "$1.5 times 1$", "radii": "2", "events": "$7.5 times 10^(7)$", "comparisons": "5"}
        | {"tests": "3", "failed": "1", "largest": "$3.6$"}
    ]


def correlated_rows():
    """Return tests at four radii, and statements on their mean scores."""
    z = {
        "right_wall": (1.0, -1.0, 2.0, 0.0),
        "top_wall": (-2.0, 2.0, -4.0, 0.0),
        "vertical_hop": (1.0, 0.0, -1.0, 0.0),
        "disc_collision": (0.0, 1.0, 0.0, -1.0),
    }
    start = {"comparison": "mean_time", "method": "dynamics", "test": "normal"}
    start |= {"passed": True, "independent": True, "bound": 4.25}
    return scene_rows(
        "check",
        *(
            start | {"quantity": f"{event}_time", "radius": 0.1 * (i + 1), "z": value}
            for event, values in z.items()
            for i, value in enumerate(values)
        ),
        start | {"quantity": "any_wall_time", "radius": 0.1, "z": 9.0, "independent": False},
        start | {"quantity": "top_wall_time", "radius": 0.9, "z": 9.0, "test": "exact-tail"},
        {"comparison": "z_mean", "quantity": "any_wall_area", "z": -3.01},
        {"comparison": "z_mean", "quantity": "volume", "z": 1.0},
    )


def test_correlations_are_those_of_tests_at_the_same_radii():
    assert texts(agreement.correlations(correlated_rows())) == {
        "dynamics_tests": "16",
        "dynamics_mean_square": "$2.1$",  # (6 + 24 + 2 + 2)/16
        "dynamics_spread": "$0.4$",  # √(2/16)
        "correlation_walls": "$-1$",
        "correlation_hops": "$0$",
    }
    assert agreement.correlations([]) == {}


def test_mean_scores_name_the_largest():
    assert texts(agreement.mean_scores(correlated_rows(), [BOX])) == {
        "mean_scores": "2",
        "mean_scores_largest": "$3.1$",
        "mean_scores_quantity": "any wall area",
        "mean_scores_box": "$1.5 times 1$",
    }
    assert agreement.mean_scores([], [BOX]) == {}


def test_effort_is_that_of_all_scenes(tables):
    assert texts(agreement.effort(tables)) == {
        "configurations": "$4 times 10^(6)$",
        "samples": "$1000$ to $2.5 times 10^(5)$",
        "epsilon": "$2 times 10^(-3)$",
        "events": "$7.5 times 10^(7)$",
        "duration": "$0.5$",
        "replicas": "$7000$",
        "target": "$10^(-3)$",
        "strips": "one",
        "strips_longest": "$1.2 times 10^(7)$",
    }


def test_errors_of_chains_are_compared_with_those_of_counts():
    """A bin of half of all intervals: √(n/4)/n/width if they are independent."""
    n, width = 40_000, 0.25
    bins = {"left": 1.0, "right": 1.0 + width, "intervals": n}
    error = 0.5 / math.sqrt(n) / width
    found = rows(
        "hop_histogram",
        bins | {"count": n // 2, "stderr": 3 * error},
        bins | {"count": 10, "stderr": 100 * error},
    )
    assert distributions.chains(found)["chain_factor"].value == pytest.approx(3)
    assert distributions.chains([])["chain_factor"].text == "$1$"


def density_rows():
    """Return rows of densities at zero, the second one the odd one, and bins of its chains."""
    case = {"scene": "main", "event": "vertical_hop", "radius": 0.4, "width": 3.0, "height": 1.0}
    value = case | {"quantity": "density_at_zero", "estimate": 1.34, "stderr": 0.005}
    value |= {"reference": 1.325825}
    bins = case | {"bins": "equal", "density": 1.3, "stderr": 0.006, "count": 9}
    del bins["width"], bins["height"]
    return (
        rows(
            "distributions",
            *(value | {"radius": x, "z": z} for x, z in ((0.1, 1.0), (0.4, -3.3), (0.2, 2.0))),
        ),
        [
            {**row, "scene": "main"}
            for row in rows(
                "hop_histogram",
                *(
                    {k: v for k, v in (bins | more).items() if k != "scene"}
                    for more in (
                        {"radius": 0.1, "density": 9.0},
                        {"bins": "wide", "density": 9.0},
                        {"density": 1.3},
                        {"density": 1.0},
                        {"density": 9.0},
                    )
                ),
            )
        ],
    )


def test_densities_name_the_largest_deviation_and_the_next():
    """The parabola p − at² whose means over (0, 1) and (1, 2) are 1.3 and 1 begins at 1.35."""
    found, histogram = density_rows()
    expected = {
        "densities": "3",
        "densities_largest": "$3.3$",
        "densities_others": "$2$",
        "odd_density": "$1.340 (5)$",
        "odd_density_exact": "$1.3258$",
        "odd_density_box": "$3 times 1$",
        "odd_density_radius": "0.4",
    }
    assert texts(distributions.densities(found, [])) == expected
    error = math.hypot(7 * 0.006, 0.006) / 6
    chains = rounding.with_error(1.35, error).text
    assert texts(distributions.densities(found, histogram)) == expected | {
        "odd_density_chains": chains
    }
    assert texts(distributions.densities([], histogram)) == {"densities": "0"}


def tail_rows():
    start = {"event": "vertical_hop", "radius": 0.1, "exact_mean": 2.0, "law": 1e-5}
    return rows(
        "tails",
        start | {"method": "weighted", "time": 40.0, "estimate": 2e-5, "stderr": 1e-6},
        start | {"method": "weighted", "time": 60.0, "estimate": 1.1e-5, "stderr": 3e-7},
        start | {"method": "weighted", "time": 80.0, "estimate": 1e-5, "stderr": 4e-6},
        start | {"method": "counted", "time": 90.0, "estimate": 1e-5, "stderr": 1e-9},
        {"radius": 0.3, "exact_mean": 0.8, "quantity": "rate", "time": 2.4, "until": 7.2}
        | {"estimate": 1.0, "stderr": 0.002},
    )


def test_tails_are_quoted_where_they_are_last_measured_well():
    found = tail_rows()
    assert texts(distributions.tails(found)) == {
        "tail_hops_ratio": "$1.10 (3)$",
        "tail_hops_time": "$30$",
        "tail_hops_probability": "$1.1 times 10^(-5)$",
        "tail_hops_radius": "$0.1$",
        "tail_hops_approach": "$0.55 (16)$",  # 0.10(3) √30
        "decay_rate": "$0.8000 (16)$",
        "decay_radius": "$0.3$",
        "decay_first": "$3$",
        "decay_last": "$9$",
    }


def survival(hazards, n):
    """Return rows of P(T > t) after 0, 1, 2, … of n intervals, with binomial errors."""
    p = np.exp(-np.cumsum([1.0, *hazards]))
    return rows(
        "tails",
        *(
            {"time": float(t), "estimate": float(x), "stderr": math.sqrt(x * (1 - x) / n)}
            for t, x in enumerate(p)
        ),
    )


def test_one_hazard_at_all_times_is_tested_by_chi_square():
    """Of two times: the square of the difference over its error, √(k₁/n₁² …) by hand."""
    n, hazards = 10**6, (0.8, 0.79)
    found = distributions.constant_hazard(survival(hazards, n))
    p = np.exp(-np.cumsum([1.0, *hazards]))
    errors = [math.sqrt((1 / later - 1 / before) / n) for before, later in pairwise(p)]
    chi2 = (hazards[0] - hazards[1]) ** 2 / (errors[0] ** 2 + errors[1] ** 2)
    assert found["decay_chi2"].value == pytest.approx(chi2)
    assert found["decay_chance"].value == pytest.approx(math.erfc(math.sqrt(chi2 / 2)))
    assert found["decay_degrees"].value == 1
    constant = distributions.constant_hazard(survival((0.8, 0.8, 0.8), n))
    assert constant["decay_chi2"].value == pytest.approx(0, abs=1e-12)
    assert distributions.constant_hazard(survival((0.8,), n)) == {}


def hazard_rows(scene, radius, p, trend, counts=(), mean=0.5):
    """Return the rows of one hop: a fit over 20 mean times, bins of 2 mean times."""
    case = {"scene": scene, "radius": radius, "event": "vertical_hop", "exact_mean": mean}
    case |= {"width": 3.0, "height": 1.0}
    width = 2 * mean
    return [
        case | {"quantity": "mean", "estimate": mean},
        case | {"quantity": "first_passage", "estimate": 0.75 * mean, "stderr": 0.01 * mean},
        case
        | {"quantity": "first_passage", "last": 9.0, "estimate": 9.9, "stderr": 1.0, "z": -1.2},
        case | {"quantity": "density_at_zero", "estimate": 0.3 / mean, "stderr": 0.01 / mean},
        case
        | {"quantity": "rate", "last": 20 * mean, "estimate": 0.8 / mean, "p": p}
        | {"stderr": 0.02 / mean, "z": -9.99},
        case | {"quantity": "trend", "p": trend},
        *(
            case
            | {"quantity": "hazard", "first": i * width, "last": (i + 1) * width}
            | {"count": count, "estimate": rate}
            for i, (count, rate) in enumerate(counts)
        ),
    ]


def distribution_rows():
    counts = [(9999, 9.0)] * 6 + [(100, 2.0), (50, 1.0), (25, 0.5), (0, 0.0)]
    return rows(
        "distributions",
        *hazard_rows("main", 0.1, 0.5, 0.25),
        *hazard_rows("main", 0.2, 1e-6, 0.5, counts),
        *hazard_rows("main", 0.3, 0.5, 1e-6),
        *hazard_rows("other", 0.2, 1e-6, 0.5, counts),
        *hazard_rows("other", 0.4, 1e-6, 0.5, counts),
        *hazard_rows("other", 0.45, 0.5, 0.5, counts),
    )


def test_hazards_are_sorted_by_whether_they_are_constant():
    """Late bins are those from 12 mean times on; the risk of a bin is hops over hazard."""
    data = distribution_rows()
    hops, risk, middles = 175, 150.0, np.array([6.5, 7.5, 8.5])  # the mean is ½
    expected = (3 / middles * 50.0).sum()
    hazard = 0.5 * hops / risk
    assert texts(distributions.hazards(data, "main")) == {
        "hazards": "3",
        "plateaus": "1",
        "plateau_cases": "vertical hops at $r =$ $0.1$",
        "plateau_rates": "$0.8$",
        "rates_nearest": "$9.9$",
        "falling_cases": "vertical hops at $r =$ $0.2$, $0.3$",
        "fallen_cases": "vertical hops at $r =$ $0.2$",
        "over_cubic": rounding.significant(hops / expected, 2).text,
        "first_passage_largest": "$1.2$",
        "elsewhere_box": "$3 times 1$",
        "elsewhere_radius": "0.4",
        "elsewhere_hazard": rounding.with_error(hazard, hazard / math.sqrt(hops)).text,
        "elsewhere_first": "$12$",
        "elsewhere_last": "$18$",
    }


def test_the_table_of_rates_is_in_units_of_the_mean():
    data = rows(
        "distributions",
        *hazard_rows("main", 0.1, 0.034, 1e-6),
        {"scene": "main", "event": "horizontal_hop", "radius": 0.05, "quantity": "mean"},
        *hazard_rows("other", 0.1, 0.5, 0.5),
    )
    first, second = distributions.rates_table(data, "main").values()
    assert texts(first) == {
        "hop": "v",
        "radius": "0.1",
        "density": "$0.300 (10)$",
        "rate": "$0.80 (2)$",
        "reach": "$20$",
        "chi2": "$0.03$",
        "trend": "$0$",
        "first_passage": "$0.750 (10)$",
    }
    assert texts(second) == {"hop": "h", "radius": "0.05"}


def power_rows():
    return rows(
        "thresholds",
        *(
            {"scene": scene, "event": "vertical_hop", "quantity": quantity, "form": form}
            | {"parameter": parameter, "law": law, "estimate": 0.99 * law, "stderr": 0.01}
            | {"points": 9, "curve": 1.01 * law, "z": z, "limit_radius": 0.25, "farthest": 0.04}
            for scene, quantity in (("main", "mean_time"), ("main", "first_passage"), ("x", "x"))
            for form, parameter, law, z in (
                ("plain", "exponent", -2.0, 8.0),
                ("plain", "coefficient", 0.5, 8.0),
                ("reduced", "exponent", -2.0, 0.31),
                ("reduced", "coefficient", 0.5, -0.5),
            )
        ),
    )


def test_power_laws_are_those_of_mean_times_of_the_main_scene():
    powers = power_rows()
    expected = {
        "reduced_largest": "$0.5$",
        "vertical_exponent": "$-1.98$",
        "vertical_reach": "$16$",
    }
    times = [
        {"scene": "main", "event": "vertical_hop", "radius": radius, "starts": starts}
        for radius, starts in ((0.2, "invariant"), (0.21, "strip"), (0.24, "strip"))
    ]
    in_strips = {"strip_powers": "vertical hops"}
    assert texts(laws.powers(powers, "main", times)) == expected | in_strips
    times.append(times[0] | {"radius": 0.22})
    assert texts(laws.powers(powers, "main", times)) == expected
    assert texts(laws.powers(powers, "main", [])) == expected
    assert texts(laws.powers([], "main", times)) == {}
    check = [{"scene": "main", "quantity": "vertical_hop_time", "passed": True}]
    assert laws.powers_table(powers, "main", [check[0] | {"independent": False}]) == {}
    check[0]["independent"] = True
    assert texts(laws.powers_table(powers, "main", check)["vertical_hop"]) == {
        "event": "v. hop",
        "points": "9",
        "plain": "$-1.980 (10)$",
        "curve": "$-2.02$",
        "reduced": "$-1.980 (10)$",
        "coefficient": "$0.99 (2)$",
    }


def effect_rows():
    share = {"scene": "rough", "quantity": "never_met_share", "radius": 0.2}
    rough = share | {"effects": "{'moment_of_inertia': 0.5}"}
    return rows(
        "effects",
        {"scene": "rough", "quantity": "any_wall_time", "z": 1.51, "status": "reached"},
        {"scene": "balls", "quantity": "any_wall_time", "z": 0.0, "status": "impossible"},
        {"scene": "balls", "quantity": "any_wall_time", "status": "too-few"},
        rough | {"duration": 100.0, "estimate": 0.2},
        rough | {"duration": 1e4, "estimate": 2e-3},
        share | {"effects": "{}", "duration": 1e4, "estimate": 1e-7},
    )


def test_effects_count_what_is_possible_and_name_the_discs_that_never_meet():
    found = effect_rows()
    expected = {
        "effects": "1",
        "effect_scenes": "two",
        "effects_largest": "$1.6$",
        "never_met_rough": "$2 times 10^(-3)$",
        "never_met_time": "$10^(4)$",
        "never_met_radius": "0.2",
        "never_met_smooth": "a share of $10^(-7)$",
    }
    assert texts(laws.effects(found)) == expected
    assert texts(laws.effects(found[:-1])) == expected | {"never_met_smooth": "none"}


def errata_rows():
    return rows(
        "errata",
        {"label": "volindic", "place": "II", "verdict": "right", "severity": None},
        {"label": "hop_tau", "place": "V", "verdict": "wrong", "ratio": 0.5, "radius": 0.2}
        | {"number": "26", "severity": "major", "correction": "`8√2 b√(a² − r²)`, with `√2` once"}
        | {"decided_by": "theory; Monte Carlo 2.0(1); dynamics 2.00(1)"},
        {"verdict": "in range", "severity": "slip", "decided_by": "theory"},
    )


def test_effects_whose_count_is_a_sum_of_others_are_no_tests():
    start = {"scene": "channel", "radius": 0.1, "status": "reached", "starts": "invariant"}
    found = rows(
        "effects",
        start | {"quantity": "top_wall_time", "z": 1.0, "count": 4000},
        start | {"quantity": "any_wall_time", "z": 1.0, "count": 4000},
        start | {"radius": 0.2, "quantity": "any_wall_time", "z": 1.0, "count": 4000},
    )
    assert laws.effects(found)["effects"].text == "2"


def test_errata_are_counted_and_those_that_are_not_right_are_listed():
    found = errata_rows()
    assert texts(laws.errata(found)) == {
        "statements": "3",
        "statements_right": "1",
        "statements_major": "1",
    }
    first, second = laws.errata_table(found).values()
    assert texts(first) == {
        "number": "26",
        "label": r"hop\_tau",
        "section": "V",
        "severity": "major",
        "ratio": "$0.5$ at $0.2$",
        "by": "C D",
        "right": "$8 sqrt(2)  b  sqrt( a ^2 -  r ^2)$, with $sqrt(2)$ once",
    }
    assert {"ratio", "by"}.isdisjoint(texts(second))
    assert second["severity"].text == "slip, in range"


def cost(part, quantity, method, **values):
    return {"part": part, "quantity": quantity, "method": method} | values


def cost_rows():
    return rows(
        "accuracy_cost",
        *(
            cost(part, quantity, method, slope=-0.5, slope_stderr=0.03, work=9, seconds=1.0)
            for part, method, quantity in costs.POWERS.values()
        ),
        *(
            cost("time", "vertical_hop_time", method, work=work, seconds=0.5)
            for method, events in (("scalar", 2), ("lockstep", 13), ("single_precision", 26))
            for work in (events, events * 1000, events * 1_000_000)
        ),
        cost("floor", "disc_collision_area", "shell", setting=0.01, error=0.006),
        cost("floor", "disc_collision_area", "shell", setting=0.05, error=0.03),
        cost("floor", "vertical_hop_time", "time_step", setting=0.0625, error=0.1),
        cost("floor", "vertical_hop_time", "time_step", setting=0.25, error=0.4),
        cost("radius", "vertical_hop_time", "strip", error=1e-3, seconds=0.052),
        cost("volume", "volume", "exact", seconds=1.1e-4),
    )


def test_costs_quote_fits_speeds_floors_and_prices():
    found = cost_rows()
    assert texts(costs.accuracy_cost(found)) == dict.fromkeys(costs.POWERS, "$-0.50 (3)$") | {
        "shell_floor": "$0.03$",
        "shell_epsilon": "$0.05$",
        "step_floors": "$0.4$ at $Delta t =$ $0.25$, $0.1$ at $Delta t =$ $0.063$",
        "evaluation_seconds": "$10^(-4)$",
        "lockstep_faster": "$6.5$",
        "single_faster": "$2.0$",
        "price_error": "$10^(-3)$",
        "strip_seconds": "$0.06$",
    }
    assert texts(costs.accuracy_cost([])) == {}


def stability_rows():
    def hard(part, quantity, method=None, **values):
        return {"part": part, "quantity": quantity, "method": method} | values

    return rows(
        "stability",
        hard("theory", "volume", "stable", value=1e-16),
        hard("theory", "areas", "stable", value=1.51e-15),
        hard("theory", "areas", "closed", value=1.0),
        hard("theory", "volume", "stable", value=math.inf),
        hard("sampling", "accepted_share", "conditioned", value=0.4567),
        hard("dynamics", "energy_error", value=2e-13, count=3000),
        hard("dynamics", "smallest_gap", value=-3e-16, count=1000),
        hard("times", "contact_time", value=0.75),
        hard("coverage", "any_wall", value=0.94),
        hard("coverage", "top_wall", value=0.9512),
        hard("coverage", "right_wall"),
    )


def test_stability_quotes_the_worst_of_what_was_seen():
    found = stability_rows()
    assert texts(costs.stability(found)) == {
        "theory_error": "$1.6 times 10^(-15)$",
        "accepted_least": "$45.6$",
        "longest_run": "$3000$",
        "energy_error": "$2 times 10^(-13)$",
        "overlap": "$3 times 10^(-16)$",
        "contact_time": "$0.75$",
        "coverage_least": "$94$",
        "coverage_most": "$95.2$",
    }


# Passages and more discs --------------------------------------------------------------------------


def passage_rows(exponent=0.4):
    """Return rows of two hops of a box, of which the horizontal one is blocked first."""

    def row(quantity, distance, estimate, stderr, method="clusters", **values):
        event = values.pop("event", "horizontal_hop")
        limit = 0.375 if event == "vertical_hop" else 0.25
        return {
            "scene": "main", "event": event, "distance": distance, "quantity": quantity,
            "radius": limit * (1 - distance), "method": method, "estimate": estimate,
            "stderr": stderr,
        } | values  # fmt: skip

    distances = [2.0**-n for n in range(3, 10)]
    smooth = [row("coefficient", d, 1 - d**exponent, 1e-3 * d**exponent) for d in distances]
    return rows(
        "passages",
        *reversed(smooth),
        row("coefficient", 0.125, 0.5, 0.01, event="vertical_hop"),
        *(
            row("coefficient", d, d**inertia, 1e-2 * d**inertia, moment_of_inertia=inertia)
            for inertia in passages.INERTIAS.values()
            for d in distances[-3:]
        ),
        row("passage_exponent", 0.01, -2.5, 0.02, "fit", moment_of_inertia=0.5),
        row("passage_exponent", 0.01, -2.6, 0.02, "fit", moment_of_inertia=0.1),
        *(
            row("diffusion", d, 1 + d, 0.01, method, moment_of_inertia=inertia, z=z)
            for inertia in (None, 0.5)
            for d, z in ((0.125, 0.5), (0.0625, -1.55))
            for method in ("hops", "states")
        ),
        *(
            row(quantity, d, value, 0.0123, "states", discs=discs)
            for discs in (4, 8)
            for d, value, rate in ((0.125, 0.97, 0.1), (0.0625, 0.8512, 0.0125))
            for quantity, value in (("diffusion", value), ("rate", rate))
        ),
        {"quantity": "single_file", "method": "lattice", "swap": 0.0, "estimate": 1.1}
        | {"stderr": 0.02},
        {"quantity": "diffusion", "method": "lattice", "swap": 1.0, "estimate": 0.49}
        | {"stderr": 0.004},
        {"quantity": "diffusion", "method": "lattice", "swap": 0.01, "estimate": 1.02}
        | {"stderr": 0.05},
    )


def test_passages_are_quoted_for_the_hop_that_is_blocked_first():
    found = texts(passages.passages(passage_rows(), "main"))
    assert found == {
        "passages": "8",
        "passages_largest": "$1.6$",
        "passages_pause": "48",
        "passages_first_distance": "$2^(-3)$",
        "passages_last_distance": "$2^(-9)$",
        "passages_first": "$0.5647 (4)$",
        "passages_last": "$0.91753 (8)$",
        "passages_exponent": "$0.4000 (5)$",
        "passages_rough_one": "$1.000 (10)$",
        "passages_rough_half": "$0.500 (10)$",
        "passages_rough_quarter": "$0.250 (10)$",
        "passages_rough_tenth": "$0.100 (10)$",
        "passages_rough_distance": "$2^(-9)$",
        "passages_rough_half_power": "$-2.50 (2)$",
        "passages_ring_smooth_first": "$1.125 (10)$",
        "passages_ring_smooth_last": "$1.062 (10)$",
        "passages_ring_rough_first": "$1.125 (10)$",
        "passages_ring_rough_last": "$1.062 (10)$",
        "passages_ring_first_distance": "$2^(-3)$",
        "passages_ring_last_distance": "$2^(-4)$",
        "passages_files": "$0.85$ to $0.97$",
        "passages_files_error": "$0.02$",
        "passages_files_discs": "four and eight",
        "passages_files_rates": "$8$",
        "passages_single_file": "$1.10 (2)$",
        "passages_lattice_first": "$0.490 (4)$",
        "passages_lattice_last": "$1.02 (5)$",
        "passages_lattice_swap": "$0.01$",
    }
    assert texts(passages.passages(passage_rows(), "other")) == {
        "passages": "8", "passages_largest": "$1.6$",
    }  # fmt: skip
    assert texts(passages.passages([], "main")) == {"passages": "0"}


def gas_rows():
    def row(discs, event, exact, dynamics, z, theory="three"):
        return {
            "discs": discs, "width": 0.75 * discs, "radius": 0.1, "theory": theory,
            "event": event, "exact": exact, "dynamics": dynamics,
            "dynamics_stderr": dynamics and dynamics / 1000, "z": z,
        }  # fmt: skip

    return rows(
        "more_discs",
        row(4, "vertical_hop", None, 0.25271, 1.0, "none"),
        row(4, "virial", 1.0, 1.0003, 0.3, "none"),
        row(3, "vertical_hop", 0.519907, 0.5195, -1.74),
        row(3, "horizontal_hop", None, None, None),
    )


def test_more_discs_have_exact_times_where_there_are_any():
    assert texts(more_discs.more_discs(gas_rows())) == {
        "more_discs": "3", "more_discs_exact": "1", "more_discs_sums": "1",
        "more_discs_largest": "$1.8$", "more_discs_most": "4", "more_discs_width": "$0.75$",
    }  # fmt: skip
    cells = more_discs.more_discs_table(gas_rows())
    assert [texts(row) for row in cells.values()] == [
        {"radius": "$0.1$", "discs": "3", "theory": "three", "vertical_hop": "$0.51991$",
         "largest": "$1.8$"},
        {"radius": "$0.1$", "discs": "4", "theory": "--", "vertical_hop": "$0.2527 (3)$",
         "largest": "$1$"},
    ]  # fmt: skip
    assert cells["00"]["horizontal_hop"] is None
    assert texts(more_discs.more_discs([])) == {
        "more_discs": "0", "more_discs_exact": "0", "more_discs_sums": "0",
    }  # fmt: skip


# The table ----------------------------------------------------------------------------------------


def write(folder, tables):
    for name in (*table.OF_SCENES, *table.OF_STUDIES):
        found = tables[name]
        own = folder / "main" if name in table.OF_SCENES else folder
        own.mkdir(exist_ok=True)
        columns = TABLES[name].columns()
        TABLES[name].write(
            own / f"{name}.csv", [{column: row[column] for column in columns} for row in found]
        )


def test_tables_are_read_from_the_folders_of_scenes_and_from_that_of_all(tables, tmp_path):
    write(tmp_path, tables)
    scene = BOX | {"tables": list(SCENE_TABLES)}
    assert table.read(tmp_path, [scene]) == tables
    (tmp_path / "errata.csv").write_text("nothing\n")
    with pytest.raises(InputError, match=r"errata\.csv must be a table errata"):
        table.read(tmp_path, [scene])


LONG_RUN = [
    {"event": event, "radius": 0.224, "exact": exact, "relative_stderr": error, "z": z}
    | {"count": count}
    for event, exact, error, z, count in (
        ("horizontal_hop", 12273.9, 1.23e-5, 0.4, 10**7),
        ("disc_collision", 1.21, 2.46e-7, -1.55, 2 * 10**11),
        ("any_wall", 0.318, 1.04e-7, 0.2, 8 * 10**11),
    )
]


def test_the_long_run_is_quoted_by_its_events_errors_and_largest_deviation():
    assert texts(agreement.long_run(rows("mean_times", *LONG_RUN))) == {
        "long_run_events": "$10^(12)$",
        "long_run_radius": "0.224",
        "long_run_error": "$10^(-7)$",
        "long_run_rare": "$1.2 times 10^(4)$",
        "long_run_rare_error": "$2 times 10^(-5)$",
        "long_run_largest": "$1.6$",
    }
    assert agreement.long_run([]) == {}


def test_the_long_run_is_what_its_shards_counted_and_agrees():
    folder = Path(__file__).resolve().parents[2] / "paper" / "long_run"
    scene = load(read(folder / "config.yaml")).scenes[0]
    point = read_json(folder / "dynamics.json")
    assert point["radius"] == scene.radii[0]
    theory = list(Theory.rows(scene.box, scene.radii))
    made = MeanTimes.rows(scene.box, theory, {"dynamics": [point]})
    kept = MeanTimes.read(folder / "mean_times.csv")
    assert [row["event"] for row in made] == [row["event"] for row in kept]
    for ours, theirs in zip(made, kept, strict=True):
        assert ours["count"] == theirs["count"]
        assert ours["estimate"] == pytest.approx(theirs["estimate"], rel=1e-12)
        assert abs(ours["z"]) < 5  # ten scores: a false alarm in 2e5 seeds
    shards = [read_json(path) for path in folder.glob("shards/all-*.json")]
    used = [shard for shard in shards if shard["stop"] * REPLICAS <= point["replicas"]]
    assert sum(shard["stop"] - shard["first"] for shard in used) * REPLICAS == point["replicas"]
    counted = [sum(counts) for counts in zip(*(shard["sums"][0] for shard in used), strict=True)]
    # What was declared later was not counted.
    assert counted == [point["counts"][event] for event in EVENTS if event in point["counts"]]


def test_numbers_become_rows_of_a_table(tables, tmp_path):
    found = table.numbers(tables, [BOX])
    path = tmp_path / "paper_numbers.csv"
    table.PaperNumbers.write(path, table.table_rows(found))
    by_name = {row["name"]: row for row in table.PaperNumbers.read(path)}
    assert by_name["tests_largest"] == {"name": "tests_largest", "value": 2.51, "text": "$2.6$"}
    assert by_name["agreement/main/box"]["value"] is None
    assert list(by_name) == list(found)
    assert table.numbers({name: [] for name in tables}, [BOX])["tests"].text == "0"


def test_what_the_manuscript_prints_is_what_is_computed(tables):
    """All of it, and nothing else: "--" stands for a number that there is not."""
    tables |= {
        "distributions": [*distribution_rows(), *density_rows()[0]],
        "hop_histogram": density_rows()[1],
        "tails": [
            *({**row, "event": "disc_collision"} for row in tail_rows()),
            *tail_rows(),
            *(
                {**row, "event": "disc_collision", "radius": 0.3, "time": t}
                | {"method": "counted", "quantity": "survival"}
                for t, row in zip((2.4, 4.8, 7.2), survival((0.8, 0.8), 1000), strict=True)
            ),
        ],
        "thresholds": [{**row, "event": e} for row in power_rows() for e in HOPS],
        "mean_times": [
            *tables["mean_times"],
            {**tables["mean_times"][1], "event": "vertical_hop", "radius": 0.24},
        ],
        "check": [*tables["check"], *correlated_rows()],
        "effects": effect_rows(),
        "errata": errata_rows(),
        "accuracy_cost": cost_rows(),
        "stability": stability_rows(),
        "passages": passage_rows(),
        "more_discs": gas_rows(),
        "long_run": rows("mean_times", *LONG_RUN),
    }
    found = table.numbers(tables, [BOX])
    constants = {"dearer", "intervals", "seed"}
    printed = {*re.findall(r'(?:number|has)\("(\w+)"\)', SOURCE)}
    assert printed - constants == {name for name in found if "/" not in name}
    assert {*re.findall(r'cells\("(\w+)"\)', SOURCE)} == {
        name.split("/")[0] for name in found if "/" in name
    }
