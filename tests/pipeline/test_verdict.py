"""The verdict on the comparisons of a build.

Without these tests a comparison beyond its bound, or a table without any, could pass.
"""

import math

import pytest
from factory import EXPECTED

from twodiscs.analysis.tables import SCENE_TABLES
from twodiscs_paper.catalogue import STUDIES, STUDY_TABLES
from twodiscs_paper.pipeline.results.verdict import verdict

PAPER = SCENE_TABLES["check"].read(EXPECTED / "paper" / "check.csv")
CHECKED = [study.tables[0].name() for study in STUDIES.values() if study.checked]


def test_what_agrees_passes_with_a_line_for_each_table():
    studies = {name: STUDY_TABLES[name].read(EXPECTED / f"{name}.csv") for name in CHECKED}
    failures, summary = verdict([("paper", PAPER), *studies.items()])
    assert failures == []
    first, *others = summary.splitlines()
    scores = [row["z"] for row in PAPER if row["z"] is not None]
    assert first.startswith(f"paper: {len(scores)} comparisons passed, ")
    assert f"largest |z| {max(map(abs, scores)):.3g}; " in first
    assert [line.partition(":")[0] for line in others] == CHECKED
    assert len(CHECKED) == 2


@pytest.mark.parametrize("z", [99.0, -99.0, math.inf, math.nan])
def test_a_score_beyond_its_bound_is_named(z):
    which = {"quantity": "disc_collision_time", "radius": 0.1}.items()
    rows = [row | {"z": z} if which <= row.items() else row for row in PAPER]
    (failure,), _ = verdict([("paper", rows)])
    assert failure.startswith("paper: comparison mean_time, quantity disc_collision_time, ")
    assert f"method dynamics, radius 0.1 has z = {z:.3g}, beyond the bound " in failure


def test_the_bound_of_a_study_grows_with_its_number_of_scores():
    """4.6 is beyond the bound of 100 scores, 4.4 is not; it is beyond that of ten."""

    def failures(scores):
        rows = [{"quantity": "diffusion", "radius": 0.1, "z": z} for z in scores]
        return verdict([("passages", rows)])[0]

    assert failures([4.4] + [0.0] * 99) == []
    assert len(failures([4.4] + [0.0] * 9)) == 1
    said = "passages: quantity diffusion, radius 0.1 has z = 4.6, beyond the bound 4.42"
    assert failures([4.6] + [0.0] * 99) == [said]


def test_an_empty_set_is_no_pass():
    assert verdict([]) == (["nothing is compared"], "")
    for rows in ([], [row | {"z": None} for row in PAPER]):
        failures, summary = verdict([("paper", PAPER), ("other", rows)])
        assert failures == ["other: nothing is compared"]
        assert not any(line.startswith("other") for line in summary.splitlines())
