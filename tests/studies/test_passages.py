"""Passages near the threshold: against exact laws, between estimators, and on the lattice.

Statistical comparisons allow five standard errors: with some 20 of them a false alarm comes in
fewer than 2e-5 of all seeds.
"""

import math

import numpy as np
import pytest
from fabricated import make_table

from twodiscs.comparison.transmission import by_clusters, plateau
from twodiscs.dynamics.passages import cluster_sizes
from twodiscs.figures.kit import style
from twodiscs.model.box import Box
from twodiscs.studies.distributions import measure as distributions
from twodiscs.studies.passages import exclusion, figure, measure
from twodiscs.studies.passages.table import Passages
from twodiscs.theory import exact

BOX, HOP = Box(1.5, 1.0), "horizontal_hop"


def test_thresholds_are_those_before_the_box_is_full():
    assert measure.thresholds(BOX) == {"vertical_hop": 0.375, HOP: 0.25}
    assert measure.thresholds(Box(3.0, 1.0)) == {HOP: 0.25}


@pytest.mark.parametrize(("hop", "halvings"), [(HOP, 4), ("vertical_hop", 8)])
def test_the_slope_at_zero_is_exact(hop, halvings):
    limit = measure.thresholds(BOX)[hop]
    scene = BOX.scene(measure.radius_at(limit, halvings))
    (row,) = measure._Hop("paper", scene, hop, halvings, 1).slope(1024)
    assert row["reference_stderr"] is None
    assert abs(row["z"]) <= 5
    assert row["stderr"] < 0.15 * row["reference"]


def test_first_passages_take_the_time_between_passages():
    """⟨F⟩ = τ (1 + CV²)/2 tends to τ/κ: κ is 2/(1 + CV²) but for the time to forget, of τ."""
    scene = BOX.scene(0.242)
    rows = {row["quantity"]: row for row in distributions.measured(scene, HOP, 2, 2**23)}
    spread = rows["squared_cv"]
    due = 2 / (1 + spread["estimate"])
    error = due * spread["stderr"] / (1 + spread["estimate"])
    gap, mean = 6 * scene.range_x, exact.mean_times(scene)[HOP]
    kappa = plateau(by_clusters(cluster_sizes(scene, HOP, gap, 512, 3)[0]), gap, mean)
    allowed = 5 * math.hypot(error, kappa.stderr) + gap / mean
    assert abs(kappa.value - due) <= allowed
    assert allowed < 0.25


# The lattice ------------------------------------------------------------------------------------


def test_free_walks_and_single_files_are_exact():
    """D = 1 where neighbours always swap, so that D/(ν ℓ²) = 1/2, and F √t where they never do.

    At t = 1024 what is left to go to the law of √t is of the order of 1/√t = 3 %.
    """
    free = exclusion.diffusion(1.0, 64, 1)
    assert abs(free.value - 0.5) <= 5 * free.stderr
    assert free.stderr < 0.02
    file = exclusion.single_file(64, 2)
    assert abs(file.value - exclusion.SINGLE_FILE) <= 5 * file.stderr + 0.03


def test_rare_swaps_make_a_random_walk():
    """The trial had 0.93(2) for p = 0.1; a law D ∝ τ^(−1/2) would have 3 times that of p = 1."""
    found = exclusion.diffusion(0.1, 64, 3)
    assert abs(found.value - 0.93) <= 5 * math.hypot(found.stderr, 0.02)


def test_particles_move_by_one_site():
    """At most one site by an exchange; none where none is made, and the same for the same seed."""
    (first,) = exclusion.displacements(0.3, [2.0**-20, 1.0], 2, 4)[:1]
    assert first[0] == 0
    assert 0 < first[1] < 2
    again = exclusion.displacements(0.3, [2.0**-20, 1.0], 2, 4)
    np.testing.assert_array_equal(again[0], first)
    assert not np.array_equal(exclusion.displacements(0.3, [1.0], 2, 5)[0], first[1:])


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: exclusion.displacements(1.5, [1.0], 2, 1), "swap must be a probability"),
        (lambda: exclusion.diffusion(0.0, 2, 1), "swap must be a probability above 0"),
        (lambda: exclusion.displacements(0.5, [1.0], 1, 1), "rings must be an integer"),
        (lambda: exclusion.displacements(0.5, [], 2, 1), "times must ascend"),
    ],
)
def test_bad_requests_are_refused(call, said):
    with pytest.raises(ValueError, match=said):
        call()


# The table and the figure -----------------------------------------------------------------------


PARAMETERS = {"scenes": {"paper": BOX.parameters()}, "events": 2**18, "seed": 1}


@pytest.fixture
def small(monkeypatch):
    """Make the study one of few distances and hops."""
    for name, value in {
        "SMOOTH": range(5, 8), "ROUGH": range(4, 7), "RING": range(3, 4), "INERTIAS": (0.5, 1.0),
        "MOST_HOPS": 2**12, "SWAPS": (1.0, 0.3), "MORE_RINGS": 4,
    }.items():  # fmt: skip
        monkeypatch.setattr(measure, name, value)


def test_the_job_writes_the_table_and_the_figure_reads_it(tmp_path, monkeypatch, small):
    path = tmp_path / "passages.csv"
    assert make_table(monkeypatch, "passages", PARAMETERS, path) == 0
    rows = Passages.read(path)
    z = [row["z"] for row in rows if row["z"] is not None]
    assert max(map(abs, z)) < 5
    by_quantity = {row["quantity"] for row in rows}
    assert by_quantity == {
        "correlation", "coefficient", "passage_time", "plateau", "slope", "exponent",
        "passage_exponent", "rate", "diffusion", "single_file",
    }  # fmt: skip
    # Nothing but the passages tells time between passages from time between hops.
    times = [row for row in rows if row["quantity"] == "passage_time"]
    kappa = [row for row in rows if row["quantity"] == "coefficient"]
    for time, fraction in zip(times, kappa, strict=True):
        assert time["estimate"] * fraction["estimate"] == pytest.approx(time["exact_mean"])
    with style.context():
        drawn = figure.draw(BOX, {"passages": rows})
    curves, powers, between, diffusion, residuals = drawn.axes
    assert len(curves.lines) > 5
    tau = between.lines[0]
    limit = measure.thresholds(BOX)[HOP]
    for distance, value in zip(tau.get_xdata()[::20], tau.get_ydata()[::20], strict=True):
        due = exact.mean_times(BOX.scene(limit * (1 - distance)))[HOP]
        assert value == pytest.approx(due, rel=1e-12)
    names = [text.get_text() for text in powers.get_legend().get_texts()]
    assert any("1-\\kappa" in name for name in names)
    assert diffusion.get_ylabel().startswith("diffusion")
    assert residuals.get_xscale() == "log"


def test_a_box_without_thresholds_has_its_lattice_only(monkeypatch, small):
    """In a square the discs jam before either hop becomes blocked... at the same radius."""
    rows = list(Passages.rows({"square": {"width": 1.0, "height": 4.0}}, 2**18, 1))
    events = {row["event"] for row in rows}
    assert events == {"vertical_hop", "swap"}
    with style.context():
        assert figure.draw(Box(1.0, 4.0), {"passages": rows})
