"""The study of agreement over all scenes.

Without these tests the agreement could count what is no test, or weigh it wrongly.
"""

import math

import numpy as np
import pytest
from factory import empty, of, written

from twodiscs.analysis.tables import SCENE_TABLES
from twodiscs.model.events import HOPS
from twodiscs_paper.studies.agreement import measure
from twodiscs_paper.studies.agreement.study import AgreementTable
from twodiscs_paper.studies.effects.study import EffectsTable

#: Scores at four radii.
SCORES = {
    "right_wall": (1.0, -1.0, 2.0, 0.0),
    "top_wall": (-2.0, 2.0, -4.0, 0.0),
    "vertical_hop": (1.0, 0.0, -1.0, 0.0),
    "disc_collision": (0.0, 1.0, 0.0, -1.0),
}
TEST = {"comparison": "mean_time", "method": "dynamics", "test": "normal"}
TEST |= {"passed": True, "independent": True, "bound": 4.25}


def check_rows():
    """Return tests at four radii, and rows that are no tests with a normal law."""
    start = TEST | {"quantity": "any_wall_time", "radius": 0.1, "z": 9.0}
    others = {"independent": False, "test": "exact-tail", "method": "monte_carlo"}
    others |= {"comparison": "flux", "passed": None}
    rows = [start | {name: value} for name, value in others.items()]
    for event, values in SCORES.items():
        for i, value in enumerate(values):
            rows.append(TEST | {"quantity": f"{event}_time", "radius": 0.1 * (i + 1), "z": value})
    return [empty(SCENE_TABLES["check"], **row) for row in rows]


def histogram_rows():
    """Return bins of half of all intervals whose errors are 3 times those of independent counts."""
    n, width = 40_000, 0.25
    error = 0.5 / math.sqrt(n) / width
    bins = {"left": 1.0, "right": 1.0 + width, "intervals": n, "event": "vertical_hop"}
    bins |= {"radius": 0.4}
    return [
        empty(SCENE_TABLES["hop_histogram"], **bins | row)
        for row in (
            {"bins": "wide", "count": n // 2, "stderr": 3 * error, "density": 9.0},
            {"bins": "wide", "count": 999, "stderr": 100 * error, "density": 9.0},
            {"bins": "wide", "count": 1000, "stderr": error / 10, "density": 9.0},
            {"bins": "equal", "count": 10, "stderr": 100 * error, "density": 1.3},
            {"bins": "equal", "count": 9, "stderr": 10 * error, "density": 1.0},
            {"bins": "equal", "count": 9, "stderr": error, "density": 9.0},
            {"bins": "equal", "count": 9, "stderr": error, "density": 9.0, "radius": 0.5},
        )
    ]


def effect_rows():
    start = {"scene": "channel", "radius": 0.1, "status": "reached", "starts": "invariant"}
    return [
        dict.fromkeys(EffectsTable.columns) | start | row
        for row in (
            {"quantity": "top_wall_time", "z": 1.0, "count": 4000},
            {"quantity": "any_wall_time", "z": -5.0, "count": 4000},
            {"radius": 0.2, "quantity": "any_wall_time", "z": -1.5, "count": 4000},
            {"radius": 0.3, "quantity": "any_wall_time", "z": 0.0, "status": "impossible"},
            {"quantity": "never_met_share", "estimate": 0.2},
        )
    ]


def one(rows, **where):
    (row,) = of(rows, **where)
    return row["count"], row["estimate"], row.get("stderr")


def test_rows_are_as_by_hand():
    """Tests with a normal law, bins, and effects whose count is no sum of others are compared.

    A bin of half of all intervals has the error √(n/4)/n/width if they are independent. The
    parabola p − at² whose means over (0, 1) and (1, 2) are 1.3 and 1 begins at 1.35.
    """
    tables = {"a/check": check_rows(), "a/hop_histogram": histogram_rows()}
    rows = [*AgreementTable.rows(tables | {"effects": effect_rows(), "b/check": check_rows()})]
    due = 32, np.mean(np.square([*SCORES.values()])), math.sqrt(2 / 32)
    assert one(rows, quantity="mean_square") == pytest.approx(due)
    assert one(rows, quantity="error_ratio") == (2, pytest.approx(3), None)
    error = math.hypot(7 * 100, 10) / 6 * 0.5 / math.sqrt(40_000) / 0.25
    assert one(rows, quantity="density_at_zero", scene="a") == pytest.approx((2, 1.35, error))
    assert one(rows, quantity="effects") == (2, 1.5, None)
    assert measure.error_ratio([])["estimate"] == 1


def test_a_count_from_a_strip_is_no_part_of_a_sum():
    """It has trajectories of its own: 30 = 20 + 10 is a coincidence."""
    rows = [
        {"scene": "a", "radius": 0.1, "quantity": f"{event}_time", "count": count, "z": 1.0}
        | {"starts": "strip" if event in HOPS else "invariant", "status": "reached"}
        for event, count in {"horizontal_hop": 10, "right_wall": 20, "any_wall": 30}.items()
    ]
    assert [row["count"] for row in measure.tests_of_effects(rows)] == [3]
    together = [row | {"starts": "invariant"} for row in rows]
    assert [row["count"] for row in measure.tests_of_effects(together)] == [2]


def test_without_comparisons_there_is_little_to_say(tmp_path):
    rows = written(tmp_path, AgreementTable, tables={"effects": []})
    assert [row["quantity"] for row in rows] == ["error_ratio", "third_virial"]


def test_the_third_virial_coefficient_is_that_of_tonks():
    """4/3 − √3/π, as Clisby and McCoy (2006) quote it; the quadrature is good to 1e-11."""
    found = measure.third_virial()["estimate"]
    assert found == pytest.approx(4 / 3 - math.sqrt(3) / math.pi, abs=1e-10)
    assert f"{found:.6f}" == "0.782004"
