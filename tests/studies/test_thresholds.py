"""Power laws where events die out: laws against exact times, fits against a second method."""

import math

import numpy as np
import pytest

from twodiscs.cli import thresholds as command
from twodiscs.comparison import tables
from twodiscs.figures import thresholds as drawing
from twodiscs.figures.kit import style
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene
from twodiscs.studies.thresholds import measure as thresholds
from twodiscs.theory import exact, laws

BOXES = {"paper": (1.5, 1.0), "long": (3.0, 1.0), "double": (2.0, 1.0), "tall": (1.0, 1.5)}


@pytest.mark.parametrize("box", [*BOXES.values(), (1.0, 1.0), (0.3, 2.0)])
@pytest.mark.parametrize("event", EVENTS)
def test_mean_times_come_to_the_law(box, event):
    """At δ = 1e-7 r_c what is left to go is of the order V'δ/V, at most 1e-4 for these boxes."""
    law = laws.leading_law(*box, event)
    limit = law.limit if law else Scene(*box, 0.01).largest_radius
    near = Scene(*box, limit * (1 - 1e-7))
    time = exact.mean_times(near)[event]
    if law is None:
        assert time > 0.1 * abs(box[0] - 2 * box[1]) or box[0] < box[1]
        assert time == pytest.approx(laws.threshold_time(near, event), rel=1e-4)
        return
    assert law.power in (-2, 1)
    assert time == pytest.approx(law(near.radius), rel=2e-4)


def test_laws_of_the_paper_s_box():
    law = laws.leading_law(1.5, 1.0, "vertical_hop")
    critical = exact.volume(Scene(1.5, 1.0, 0.375))
    assert (law.limit, law.power) == (0.375, -2)
    due = 3 * math.pi / 4 * critical / (16 * math.sqrt(2) * (1 - 0.75))
    assert law.coefficient == pytest.approx(due, rel=1e-12)
    law = laws.leading_law(1.5, 1.0, "disc_collision")
    largest = Scene(1.5, 1.0, 0.3).largest_radius
    assert law.power == 1
    due = 3 * math.pi / 4 * math.sqrt(1.5) / (2 * largest)
    assert law.coefficient == pytest.approx(due, rel=1e-8)
    assert laws.leading_law(3.0, 1.0, "disc_collision") is None
    assert laws.leading_law(3.0, 1.0, "vertical_hop").power == 1


def test_line_is_that_of_polyfit():
    rng = np.random.default_rng(1)
    x, errors = rng.uniform(-3, 1, 9), rng.uniform(0.1, 2, 9)
    y = 2 - 1.5 * x + errors * rng.standard_normal(9)
    constant, slope, error, chi2 = thresholds.line(x, y, errors)
    (a, b), covariance = np.polyfit(x, y, 1, w=1 / errors, cov="unscaled")
    assert (slope, constant) == pytest.approx((a, b), rel=1e-12)
    assert error == pytest.approx(math.sqrt(covariance[0, 0]), rel=1e-12)
    assert chi2 == pytest.approx(np.sum(((y - a * x - b) / errors) ** 2), rel=1e-12)
    with pytest.raises(ValueError, match="at least 3 points, not 2"):
        thresholds.line(x[:2], y[:2], errors[:2])


def times_of(event, radii, noise=0.0, relative=1e-3, box=(1.5, 1.0), seed=2):
    """Return rows of mean_times.csv, as far as they are used: exact times with noise."""
    rng = np.random.default_rng(seed)
    rows = []
    for radius in radii:
        exact = exact.mean_times(Scene(*box, radius))[event]
        value = exact * (1 + noise * relative * rng.standard_normal())
        row = dict.fromkeys(tables.TABLES["mean_times"].names)
        row |= {"radius": radius, "event": event, "exact": exact, "estimate": value}
        rows.append(row | {"stderr": relative * exact})
    return rows


RADII = (0.21, 0.22, 0.23, 0.24, 0.245, 0.248)


def fitted(rows, box=(1.5, 1.0), passages=()):
    """Return {(quantity, form, parameter): row} of the fits of one scene."""
    found = thresholds.rows({"paper": box}, {"paper": rows}, list(passages))
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


def test_noise_is_in_the_errors():
    """200 fits: scores of exponent and coefficient have mean 0 and variance 1, χ² its degrees."""
    rng, law = np.random.default_rng(2), laws.leading_law(1.5, 1.0, "horizontal_hop")
    exact = np.array([row["exact"] for row in times_of("horizontal_hop", RADII)])
    found = {"exponent": [], "coefficient": []}
    for noise in rng.standard_normal((200, len(RADII))):
        times = exact * (1 + 1e-3 * noise)
        for row in thresholds.fits(law, "mean_time", RADII, times, 1e-3 * exact, exact):
            if row["form"] == "reduced":
                found[row["parameter"]].append(row)
    for fits in found.values():
        z = np.array([row["z"] for row in fits])
        assert abs(z.mean()) < 5 / math.sqrt(200)
        assert abs(z.var() - 1) < 5 * math.sqrt(2 / 200)
        degrees = fits[0]["degrees"]
        chi2 = np.mean([row["chi2"] for row in fits])
        assert abs(chi2 - degrees) < 5 * math.sqrt(2 * degrees / 200)


def test_fits_keep_to_one_regime_and_to_honest_errors():
    radii = (0.3, 0.36, 0.376, 0.379, 0.381, 0.383)
    rows = times_of("disc_collision", radii)
    found = fitted(rows)["mean_time", "plain", "exponent"]
    assert found["points"] == 4
    assert found["farthest"] == pytest.approx(found["limit_radius"] - 0.376)
    rows[-1]["stderr"] = None
    assert fitted(rows)["mean_time", "plain", "exponent"]["points"] == 3
    rows[-2]["stderr"] = None
    assert fitted(rows) == {}
    assert fitted(times_of("disc_collision", (0.42, 0.45, 0.48), box=(3.0, 1.0)), (3.0, 1.0)) == {}


def test_first_passages_are_fitted_without_a_curve():
    passages = [
        {"scene": "paper", "event": "horizontal_hop", "quantity": "first_passage", "last": last}
        | {"exact_mean": row["exact"], "radius": row["radius"], "estimate": 1.5 * row["exact"]}
        | {"stderr": row["stderr"]}
        for row in times_of("horizontal_hop", RADII)
        for last in (None, 1.0)
    ]
    found = fitted([], passages=passages)
    assert set(found) == {("first_passage", form, "exponent") for form in ("plain", "reduced")}
    row = found["first_passage", "reduced", "exponent"]
    assert row["estimate"] == pytest.approx(-2, abs=1e-10)
    assert row["curve"] is row["z"] is None
    assert row["points"] == len(RADII)


@pytest.mark.parametrize("bad", [0, -1, math.nan, "1", True, None])
def test_bad_requests_are_refused(bad):
    with pytest.raises(ValueError, match="must"):
        laws.leading_law(bad, 1.0, "vertical_hop")
    with pytest.raises(ValueError, match="event must be one of"):
        laws.leading_law(1.5, 1.0, bad)


@pytest.mark.parametrize("box", ["paper", "long"])
def test_the_command_writes_the_table_and_the_figure_reads_it(box, tmp_path, monkeypatch):
    width, height = BOXES[box]
    rows = times_of("horizontal_hop", RADII, noise=1.0, box=BOXES[box])
    for row in rows:
        row |= {"count": 9, "ergodic_components": 1, "replicas": 9, "duration": 1.0}
        row |= {"relative_stderr": 1e-3, "target": 1e-3, "status": "reached", "z": 0.0}
    passages = [
        dict.fromkeys(tables.TABLES["distributions"].names)
        | {"scene": "a", "width": width, "height": height, "event": "horizontal_hop"}
        | {"exact_mean": row["exact"], "radius": row["radius"], "estimate": row["exact"]}
        | {"stderr": row["stderr"], "quantity": "first_passage", "count": 9}
        for row in rows
    ]
    paths = {name: str(tmp_path / f"{name}.csv") for name in ("mean_times", "distributions", "out")}
    tables.write(paths["mean_times"], "mean_times", rows)
    tables.write(paths["distributions"], "distributions", passages)
    words = ["x", "--scenes", repr({"a": BOXES[box]}), "--distributions", paths["distributions"]]
    words += ["--output", paths["out"]]
    monkeypatch.setattr("sys.argv", [*words, "--times", f"a={paths['mean_times']}"])
    command.main()
    found = tables.read(paths["out"], "thresholds")
    assert {row["quantity"] for row in found} == {"mean_time", "first_passage"}
    read = {"mean_times": rows, "distributions": passages, "thresholds": found}
    with style.context():
        hops, ratios = drawing.draw({"width": width, "height": height}, read).axes
    assert "first passages" in hops.get_legend_handles_labels()[1]
    law = laws.leading_law(width, height, "horizontal_hop")
    dashed = [line for line in hops.lines if line.get_linestyle() == "--"][-1]
    distance, time = dashed.get_data()
    np.testing.assert_allclose(time, law.coefficient * (law.limit * distance) ** -2, rtol=1e-9)
    assert len(ratios.containers) == sum(
        laws.leading_law(width, height, event) is not None for event in drawing.LOOKS
    )
    for text in ("b=x.csv", "a"):
        monkeypatch.setattr("sys.argv", [*words, "--times", text])
        with pytest.raises(ValueError, match="times must be SCENE=PATH"):
            command.main()
