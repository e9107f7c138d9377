"""The errata: verdicts on formulas of the source.

Without these tests a formula could be called wrong that is right, or a correction be wrong itself.

The verdicts are computed; here they are compared with those found by hand, and formulas are spoilt
to see them turn.
"""

import dataclasses
import re
from functools import cache

import pandas as pd
import pytest
from factory import EXPECTED, written
from mpmath import mp, mpf

from twodiscs_paper import reference
from twodiscs_paper.errata import measure as errata
from twodiscs_paper.errata import statements
from twodiscs_paper.errata.statements import LIMITS, NUMERATOR, REGIMES, STATEMENTS
from twodiscs_paper.errata.study import ErrataTable

WRONG = {
    "axis of the cylinder", "volumewhd", "factor of 2 or 4", "VolumenCasoFeo", "eq:surface-area",
    "AreaH", "caption on the hop area", "hoptau", "hoptaulimit", "hop time near w/4",
    "collision time is smooth", "impactwall", "range of two components", "range of four components",
    "hop surface orthogonal to Y", "pasoraro", "app:colgeneral, first line",
    "app:colgeneral with b = 0", "app:colgeneral as a quarter", "vertical hops excluded", "A_whole",
    "lower triangle of the wall", "limit of thin shells",
}  # fmt: skip
RIGHT_IN_RANGE = {"AreaChoque", "colltau", "collision time goes to zero", "exponential tails"}

BY_LABEL = {statement.label: statement for statement in STATEMENTS}


@pytest.fixture(autouse=True, scope="module")
def digits():
    with mp.workdps(reference.DIGITS):
        yield


@cache
def verdicts():
    """Return {label: row}."""
    return {row["label"]: row for row in errata.rows()}


def judged(label, printed):
    """Return the row of a statement with another ``printed`` formula."""
    return errata.judge(dataclasses.replace(BY_LABEL[label], printed=printed))


# Verdicts -----------------------------------------------------------------------------------------


def test_verdicts_are_those_found_by_hand():
    found = {label: row["verdict"] for label, row in verdicts().items()}
    assert {label for label in found if found[label] == "wrong"} == WRONG
    assert {label for label in found if found[label] == "right-in-range"} == RIGHT_IN_RANGE
    assert len(found) == len(STATEMENTS)


def test_every_statement_says_where_and_whatever_is_not_right_says_what_is():
    for statement, row in zip(STATEMENTS, verdicts().values(), strict=True):
        assert set(statement.where) <= set(REGIMES) | set(LIMITS)
        assert re.fullmatch(r"(I|II|III|IV|V|VI) ?[ABC]? ?[123]?|A [12] ?[abc]?|B", statement.place)
        assert row["verdict"] == "right" or row["correction"]
        assert (row["verdict"] == "right") == (row["severity"] is None)
        assert row["severity"] in (None, "major", "minor", "slip")
        assert (row["correction"] or "").count("`") % 2 == 0


def test_the_table_is_the_expected_one(tmp_path, monkeypatch):
    rows = [*verdicts().values()]
    monkeypatch.setattr(errata, "rows", lambda: rows)
    found, due = written(tmp_path, ErrataTable), ErrataTable.read(EXPECTED / "errata.csv")
    pd.testing.assert_frame_equal(pd.DataFrame(found), pd.DataFrame(due), rtol=1e-12, atol=0)


@pytest.mark.parametrize(
    "label",
    ["volumeabd", "areax1p", "colltaulim0", "V_l", "A_sector", "app:colgeneral", "largest radius"],
)
def test_a_spoilt_formula_is_wrong(label):
    printed = BY_LABEL[label].printed
    assert verdicts()[label]["verdict"] == "right"
    for change in (
        lambda value: value * (1 + mpf("1e-9")),
        lambda value: mp.mpc(value, 1e-9),
        lambda value: value / mpf(0),
    ):
        assert judged(label, lambda q, change=change: change(printed(q)))["verdict"] == "wrong"


@pytest.mark.parametrize("roots", [(0, 0), (1, 0), (0, 1)])
def test_a_time_with_a_root_on_one_side_of_h_4_is_not_smooth(roots, monkeypatch):
    """The curvature of |d|^(3/2), with the distance d from it, is infinite at 0."""

    def time(event, q):
        d = q.r - q.h / 4
        return d**2 + roots[d > 0] * abs(d) ** 1.5

    monkeypatch.setattr(statements, "mean_time", time)
    assert statements.collision_time_is_smooth(reference.MpScene.of(3, 1, 0)) == (roots == (0, 0))


@pytest.mark.parametrize("side", [-1, 1])
@pytest.mark.parametrize("closed", ["h", "w"])
def test_the_listed_regimes_end_where_the_hops_close(closed, side):
    q = reference.MpScene(mpf(3) / 2, mpf(1), mpf(0))
    q = q._replace(r=getattr(q, closed) / 4 * (1 + side * mpf("1e-9")))
    assert statements.regimes_are_as_listed(q)


# Corrections --------------------------------------------------------------------------------------


def value(formula, q):
    """Return the value of a ``formula`` as corrections write it, 3ab² for 3*a*b**2."""
    text = re.sub("[²³⁴]", lambda power: f"**{'²³⁴'.index(power[0]) + 2}", formula)
    text = re.sub(r"√(\d)", r"√(\1)", text.rpartition("= ")[2].replace("−", "-"))
    code = ""
    for part in re.findall(r"arcsin|\*\*\d|\d+|[√VNabhrwπ]|[-+/()]", text):
        if re.search(r"[\dNabhrwπ)]$", code) and re.match(r"[\w√(]", part):
            code += "*"
        code += f"mpf({part})" if part.isdecimal() else part.replace("√", "root")
    names = {"mpf": mpf, "π": mp.pi, "root": mp.sqrt, "arcsin": mp.asin, "a": q.a, "b": q.b}
    names |= q._asdict() | {"V": lambda radius: reference.volume(q._replace(r=radius))}
    names["N"] = "N" in code and value(NUMERATOR, q)
    return eval(code, names)


def formulas_of(label):
    """Return the formulas in the correction of a statement."""
    return re.findall("`(.*?)`", BY_LABEL[label].correction)


#: Statements whose formula lacks a factor.
FACTORS = {"factor of 2 or 4": "2", "eq:surface-area": "√2", "limit of thin shells": "√2/2"}

#: Those whose correction has the right formula, as the first one of it or as another one.
FORMULAS = dict.fromkeys(
    ("VolumenCasoFeo", "AreaH", "hoptau", "hoptaulimit", "impactwall", "A_whole"), 0
) | {"lower triangle of the wall": 0, "hop time near w/4": 1}


@pytest.mark.parametrize("label", [*FACTORS, *FORMULAS, "volumewhd"])
def test_the_correction_is_right(label):
    def corrected(q):
        if label in FORMULAS:
            return value(formulas_of(label)[FORMULAS[label]], q)
        printed = BY_LABEL[label].printed(q)
        if label in FACTORS:
            return value(FACTORS[label], q) * printed
        right, wrong, last, wrong_last = (value(formula, q) for formula in formulas_of(label))
        return printed + right - wrong + last - wrong_last

    assert judged(label, corrected)["verdict"] == "right"


def test_the_time_left_in_long_boxes():
    q = reference.MpScene(mpf(3), mpf(1), mpf(1) / 2 - mpf("1e-30"))
    limit = value(formulas_of("collision time goes to zero")[1], q)
    assert abs(reference.mean_time("disc_collision", q) / limit - 1) < 1e-20
