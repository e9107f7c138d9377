"""The verdict on all tables: what passed is summed up, and a failure is named."""

import subprocess
import sys

from factory import row

from twodiscs.comparison import scores
from twodiscs.comparison.tables.check import Check
from twodiscs_paper.pipeline.results import verdict
from twodiscs_paper.studies.passages.table import Passages


def compared(z, **given):
    """Return a row of check.csv that passed if |z| ≤ 4."""
    usual = {"comparison": "mean_time", "quantity": "top_wall_time", "method": "dynamics"}
    judged = {"z": z, "bound": 4.0, "passed": abs(z) <= 4.0, "independent": True}
    return row(Check, **usual | judged | {"radius": 0.1, "status": "reached"} | given)


GOOD = [
    compared(0.5),
    compared(-3.25),
    compared(1.0, independent=False),
    compared(2.0, status="too-few"),
    compared(0.0, status="none-seen"),
]


def test_a_verdict_sums_up_what_passed():
    failures, text = verdict.verdict({"good": GOOD, "again": GOOD[:3]}, {})
    assert failures == []
    good, again = text.splitlines()
    assert good.startswith("good: ")
    for words in ("5 comparisons", "4 of them tests", "|z| 3.25", "2 had too few"):
        assert words in good
    for words in ("again: ", "3 comparisons", "2 of them tests", " 0 had too few", " 0 more"):
        assert words in again


def test_what_could_not_be_compared_is_counted_apart():
    nothing = compared(0.0) | {"z": None, "passed": None}
    failures, text = verdict.verdict({"scene": [*GOOD, nothing]}, {})
    assert failures == []
    assert "5 comparisons" in text
    assert "1 more could not be compared" in text


def test_a_failure_names_scene_quantity_radius_method_and_score():
    rows = [*GOOD, compared(-5.5, radius=0.3), compared(6.0, comparison="z_mean", radius=None)]
    failures, _ = verdict.verdict({"good": GOOD, "bad": rows}, {})
    at_radius, over_all = failures
    for words in ("bad: ", "mean_time", "top_wall_time", "0.3", "dynamics", "-5.5", "bound 4"):
        assert words in at_radius
    assert "z_mean" in over_all
    assert "all radii" in over_all


def test_studies_are_judged_by_their_scores():
    """1000 scores: a bound of 4.9 or so."""
    rows = [
        row(Passages, radius=0.1, event="vertical_hop", z=z) for z in (*[0.5] * 998, -4.7, None)
    ]
    failures, text = verdict.verdict({}, {"passages": rows})
    assert failures == []
    assert "999 comparisons" in text
    assert "|z| 4.7" in text
    (failure,), _ = verdict.verdict({}, {"passages": [*rows, rows[0] | {"z": 5.1}]})
    bound = scores.bonferroni_bound(1000, scores.FALSE_ALARM)
    for words in ("passages: ", "vertical_hop", "radius 0.1", "z = 5.1", f"{bound:.3g}"):
        assert words in failure


def test_the_import_is_light():
    code = (
        f"import sys, {verdict.__name__}; print({{'numpy', 'scipy', 'pandas'}} & {{*sys.modules}})"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "set()"
