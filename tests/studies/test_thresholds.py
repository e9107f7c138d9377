"""The study of power laws at thresholds.

Without these tests a fitted power, its error or its law at a threshold could be wrong.
"""

import math

import numpy as np
import pytest
from factory import empty, written

from twodiscs.analysis.tables import MeanTimesTable
from twodiscs.figures import style
from twodiscs.model.scene import Box
from twodiscs.theory import exact
from twodiscs_paper.studies.distributions.study import DistributionsTable
from twodiscs_paper.studies.thresholds import figure
from twodiscs_paper.studies.thresholds import measure as thresholds
from twodiscs_paper.studies.thresholds.study import ThresholdsTable

PAPER, LONG = Box(1.5, 1.0), Box(3.0, 1.0)


def times_of(event, radii, noise=0.0, box=PAPER):
    """Return rows of mean_times.csv, as far as they are used: exact times with noise."""
    rng, rows = np.random.default_rng(2), []
    for radius in radii:
        time = exact.mean_times(box.scene(radius))[event]
        found = {"exact": time, "stderr": 1e-3 * time}
        found["estimate"] = time + noise * found["stderr"] * rng.standard_normal()
        rows.append(empty(MeanTimesTable, radius=radius, event=event, **found))
    return rows


def passages_of(name, box, rows, last=None):
    """Return rows of distributions.csv: first passages half as long again as the mean times."""
    return [
        empty(
            DistributionsTable, scene=name, width=box.width, height=box.height,
            radius=row["radius"], event=row["event"], quantity="first_passage", last=last,
            exact_mean=row["exact"], estimate=1.5 * row["exact"], stderr=row["stderr"], count=9,
        )
        for row in rows
    ]  # fmt: skip


RADII = (0.21, 0.22, 0.23, 0.24, 0.245, 0.248)


def fitted(rows, box=PAPER, passages=()):
    """Return {(quantity, form, parameter): row} of the fits of one scene."""
    read = {"paper/mean_times": rows, "distributions": list(passages)}
    found = list(thresholds.rows(read, {"paper": box.parameters()}))
    assert all((row["width"], row["height"]) == (box.width, box.height) for row in found)
    return {(row["quantity"], row["form"], row["parameter"]): row for row in found}


def test_exact_times_have_the_exact_power():
    found = fitted(times_of("horizontal_hop", RADII))
    assert len(found) == 4
    exponent = found["mean_time", "reduced", "exponent"]
    assert exponent["estimate"] == pytest.approx(-2, abs=1e-10)
    assert exponent["chi2"] < 1e-12
    assert exponent["degrees"] == 4
    coefficient = found["mean_time", "reduced", "coefficient"]
    assert coefficient["estimate"] == pytest.approx(coefficient["law"], rel=1e-10)
    for parameter in ("exponent", "coefficient"):
        plain = found["mean_time", "plain", parameter]
        assert plain["estimate"] == pytest.approx(plain["curve"], rel=1e-12)
    # At these radii the times themselves do not show the power.
    plain = found["mean_time", "plain", "exponent"]
    assert abs(plain["estimate"] + 2) > 0.2
    assert plain["p"] < 1e-10


def test_fits_keep_to_one_regime_and_to_honest_errors():
    rows = times_of("disc_collision", (0.3, 0.36, 0.376, 0.379, 0.381, 0.383))
    assert fitted(rows)["mean_time", "plain", "exponent"]["points"] == 4
    rows[-1]["stderr"] = None
    assert fitted(rows)["mean_time", "plain", "exponent"]["points"] == 3
    rows[-2]["stderr"] = None
    assert fitted(rows) == {}
    assert fitted(times_of("disc_collision", (0.42, 0.45, 0.48), box=LONG), LONG) == {}


def test_first_passages_are_fitted_without_a_curve():
    """Those that are cut are left out, and so are those of another scene."""
    rows = times_of("horizontal_hop", RADII)
    passages = passages_of("paper", PAPER, rows) + passages_of("other", PAPER, rows)
    found = fitted([], passages=passages + passages_of("paper", PAPER, rows, last=1.0))
    assert set(found) == {("first_passage", form, "exponent") for form in ("plain", "reduced")}
    row = found["first_passage", "reduced", "exponent"]
    assert row["estimate"] == pytest.approx(-2, abs=1e-10)
    assert row["curve"] is row["z"] is None
    assert row["points"] == len(RADII)
    # They are not the time between hops where this vanishes.
    rows = times_of("vertical_hop", (0.42, 0.45, 0.48), box=LONG)
    assert fitted([], LONG, passages_of("paper", LONG, rows)) == {}


def test_a_coefficient_is_the_mean_of_its_logarithm_by_the_errors():
    """Off by d ± s in the logarithm: the mean of d with the weights 1/s², and χ² about it."""
    law, radii = thresholds.PowerLaw(1.0, -2, 3.0), np.array([0.8, 0.9, 0.95])
    d, s, due = np.array([0.1, -0.2, 0.3]), np.array([0.1, 0.2, 0.4]), law(radii)
    times = due * np.exp(d)
    rows = [*thresholds.fits({}, law, "mean_time", radii, times, s * times, due)]
    mean, error = (0.1 * 16 - 0.2 * 4 + 0.3) / 21, 0.4 / math.sqrt(21)
    value, chi2 = 3 * math.exp(mean), np.sum(((d - mean) / s) ** 2)
    found = {"estimate": value, "stderr": value * error, "law": 3.0, "curve": 3.0}
    found |= {"z": (1 - 3 / value) / error, "chi2": chi2, "degrees": 2, "p": math.exp(-chi2 / 2)}
    for row in rows[1::2]:  # plain and reduced
        assert {name: row[name] for name in found} == pytest.approx(found)


# The table and the figure -------------------------------------------------------------------------


@pytest.mark.parametrize("box", [PAPER, LONG], ids=str)
def test_the_table_is_written(box, tmp_path):
    """The main scene may measure no mean times; then the fits are those of the passages."""
    rows = times_of("horizontal_hop", RADII, noise=1.0, box=box)
    passages = {"distributions": passages_of("a", box, rows)}
    both, one = {"mean_time", "first_passage"}, {"first_passage"}
    for read, quantities in ((passages | {"a/mean_times": rows}, both), (passages, one)):
        found = written(tmp_path, ThresholdsTable, tables=read, scenes={"a": box.parameters()})
        assert {row["quantity"] for row in found} == quantities
        with style.context():
            assert figure.draw(box, read | {"thresholds": found})
