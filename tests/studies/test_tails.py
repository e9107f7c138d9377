"""The study of tails: weighted starts, the law C/t³ and rates.

Without these tests weighted starts, the law C/t³ or the tests of a rate could be wrong.

Every statistical comparison allows five standard errors. Of 100 blocks, these errors are known to
7 %, and for Student's law with 99 degrees of freedom five are beyond reach in all but 3e-6 of the
seeds; with some 40 comparisons a false alarm comes in fewer than 2e-4 of them.
"""

import math
from itertools import pairwise

import numpy as np
import pytest
from factory import BOX, of, written

from twodiscs.model.events import HOPS
from twodiscs.model.scene import Box
from twodiscs.sampling.streams import open_stream
from twodiscs.theory import exact
from twodiscs_paper.studies.estimates import sample_mean
from twodiscs_paper.studies.single import tail_constant
from twodiscs_paper.studies.tails import measure as tails
from twodiscs_paper.studies.tails.study import TailsTable

PAPER = BOX.scene(0.24)


def in_mean_times(scene, event, times):
    """Return times that are given in units of the exact mean time."""
    return [time * exact.mean_times(scene)[event] for time in times]


@pytest.mark.parametrize(
    ("radius", "event"), [(0.24, "disc_collision"), (0.1, "vertical_hop"), (0.1, "horizontal_hop")]
)
def test_weighted_starts_agree_with_plain_counting(radius, event):
    """In the common range, from one to ten mean times."""
    scene = PAPER.with_radius(radius)
    times = in_mean_times(scene, event, (1, 2, 5, 7, 10))
    weighted = tails.tail(scene, event, times, 20, 1)
    plain = sample_mean(tails.survivals(scene, event, times, 100_000, 2))
    for a, b in zip(weighted, plain, strict=True):
        assert abs(a.value - b.value) <= 5 * math.hypot(a.stderr, b.stderr)
        assert 0 < a.relative_stderr < 0.15


def test_few_starts_have_errors_that_cover_what_they_did_not_meet():
    """Against P(T > t)/(C/t³) of vertical hops by another program, with one marker and no strata.

    It has 7.423(7), 3.063(4), 1.596(2) and 1.338(2) at 10, 20, 50 and 100 mean times from 2.4e7
    starts. The mean square of z over 40 seeds is 1 to its own error √(2/40); strata without an
    interval, taken as certain, give 2 to 5.
    """
    scene, event = PAPER.with_radius(0.1), "vertical_hop"
    times = in_mean_times(scene, event, (10, 20, 50, 100))
    law = [tail_constant(scene, event) / time**3 for time in times]
    due = np.multiply((7.423, 3.063, 1.596, 1.338), law)
    runs = [tails.tail(scene, event, times, 4, seed) for seed in range(40)]
    z = [[(one.value - x) / one.stderr for one, x in zip(run, due, strict=True)] for run in runs]
    assert (np.mean(np.square(z), axis=0) < 1 + 5 * math.sqrt(2 / len(runs))).all()


def test_a_stratum_without_a_longer_interval_adds_its_bound():
    """In two blocks of collisions most strata have no interval of 50 mean times."""
    scene, event, samples, blocks = PAPER, "disc_collision", 8, 2
    (time,) = times = in_mean_times(scene, event, (50,))
    (found,) = tails.tail(scene, event, times, samples, 3, blocks)
    strata = 8
    sums, longest = tails.length_biased(
        np.uint64(3), 0, blocks, strata, samples, np.array(times), tails.two_disc_law(scene),
        tails.conditioned_sampler(scene), False,
    )  # fmt: skip
    mean = exact.mean_times(scene)[event]
    (spread,) = sample_mean(mean * sums.sum(axis=1))
    empty = ~sums.any(axis=(0, 2))
    assert 2 < empty.sum() < strata
    bounds = mean * longest[empty, 1] / blocks * (longest[empty, 0] / time) ** 3
    assert found.value == spread.value
    assert found.stderr == pytest.approx(math.hypot(spread.stderr, *bounds))


def test_tails_are_cubic():
    """P(T > t) t³ of collisions has come to C at 300 mean times, where e^(−t/τ) is 1e-130.

    The difference falls as τ/t, with a coefficient of about 2 at 20 to 300 mean times; twice that
    is added to five standard errors.
    """
    (time,) = times = in_mean_times(PAPER, "disc_collision", (300,))
    (estimate,) = tails.tail(PAPER, "disc_collision", times, 20, 4)
    law = tail_constant(PAPER, "disc_collision") / time**3
    assert estimate.relative_stderr < 0.05
    assert abs(estimate.value - law) <= 5 * estimate.stderr + 4 / 300 * law


def test_drifts_cover_the_sphere_evenly():
    """One stratum with all of [0, 1/2] gives a velocity uniform on the sphere: ⟨u²⟩, ⟨u⁴⟩, ⟨u²v²⟩.

    Their values 1/4, 1/8 and 1/24 are met within five errors; the energy is 1/2.
    """
    state = open_stream(np.uint64(5), 0)
    v = np.array([tails.draw_drifting_velocity(state, 0.5, 0.0) for _ in range(40_000)])
    assert np.abs(np.sum(v**2, axis=1) - 1).max() < 8 * 2.0**-52
    i, j = np.tril_indices(4, -1)
    for values, due in ((v**2, 1 / 4), (v**4, 1 / 8), (v[:, i] ** 2 * v[:, j] ** 2, 1 / 24)):
        z = (values.mean(axis=0) - due) / values.std(axis=0) * math.sqrt(len(values))
        assert np.abs(z).max() <= 5


# The table and the figure -----------------------------------------------------------------------


def test_the_rate_of_decay_is_that_of_the_counts():
    """Vertical hops without drifts, between 3 and 5 mean times."""
    scene = PAPER.with_radius(0.3)
    first, last = in_mean_times(scene, "vertical_hop", (3, 5))
    counted = tails.survivals(scene, "vertical_hop", [first, last], 20_000, 8)
    rate, (early, late) = tails.decay(counted, first, last), sample_mean(counted)
    by_hand = math.log(early.value / late.value) / (last - first)
    assert rate.value == pytest.approx(by_hand, rel=1e-12)
    # Correlations between the two counts can only help, and intervals are nearly independent.
    assert rate.stderr * (last - first) < 2 / math.sqrt(8 * 20_000 * late.value)
    # The ratio of counts in proportion has no error.
    assert tails.decay(np.array([[2.0, 1.0], [4.0, 2.0]]), first, last).stderr < 1e-12


def test_the_error_of_a_rate_between_survivals_is_that_of_those_that_last_longer():
    """Of 50 intervals of 100 that last to 1, 10 last to 3, with a binomial error."""
    early = {"time": 1.0, "estimate": 0.5, "stderr": 0.05, "exact_mean": 1.0}
    late = {"time": 3.0, "estimate": 0.1, "stderr": 0.03, "exact_mean": 1.0}
    rate = tails.rate_between(early, late)
    assert rate["estimate"] == pytest.approx(math.log(5) / 2)
    assert rate["stderr"] == pytest.approx(math.sqrt(0.2 * 0.8 / 50) / 0.2 / 2)


def test_a_mean_of_runs_has_their_replicas():
    found = tails.joined([sample_mean([0, 2]), sample_mean([1, 5])])  # 1 ± 1 and 3 ± 2
    assert (found.value, found.stderr, found.n) == (2.0, pytest.approx(math.sqrt(5) / 2), 4)


def test_cases_of_other_boxes():
    events = ["disc_collision", "vertical_hop", "vertical_hop"]
    assert tails.cases(BOX) == [*zip(events, (0.24, 0.1, 0.3), strict=True)]
    assert [event for event, _ in tails.cases(Box(1.0, 3.0))] == ["disc_collision", *2 * HOPS[1:]]
    assert [tails.cases(Box(w, 1.0))[1:] for w in (1.0, 1.1)] == [[("vertical_hop", 0.1)]] * 2
    # Discs hardly ever meet in a box that long.
    assert [event for event, _ in tails.cases(Box(1e6, 1.0))] == 2 * [HOPS[0]]


def test_the_table_is_written(tmp_path, monkeypatch):
    """And depends on the seed alone; every case and method has its own stream."""
    monkeypatch.setattr(tails, "WEIGHTED_TIMES", (5, 50))
    seeds = []
    for name in ("tail", "counted_survival"):
        work = getattr(tails, name)
        monkeypatch.setattr(tails, name, lambda *of, work=work: seeds.append(of[-1]) or work(*of))
    given = {"box": BOX, "samples": 5, "replicas": 2000}
    rows, again, other = (written(tmp_path, TailsTable, **given, seed=seed) for seed in (1, 1, 2))
    assert len({*seeds[: len(seeds) // 3]}) == len(seeds) // 3 > 4
    assert rows == again != other
    (rate,) = of(rows, quantity="rate")
    assert rate["law"] == pytest.approx(1 / rate["exact_mean"])
    for row in of(rows, quantity="survival"):
        constant = tail_constant(BOX.scene(row["radius"]), row["event"])
        assert (row["law"] or 0) * row["time"] ** 3 == pytest.approx(constant)
        assert (row["law"] is None) == (row["radius"] == 0.3)


def test_counts_without_a_longer_interval_have_the_error_of_one():
    """Ten replicas have about 80 intervals, and none lasts ten mean times."""
    rows = tails.rows(BOX, 1, 10, 1)
    empty = of(rows, method="counted", estimate=0)
    assert len(empty) > 5
    assert {row["stderr"] for row in empty} == {1 / 80}
    assert "rate" not in {row["quantity"] for row in rows}


START = {"event": "vertical_hop", "radius": 0.1, "exact_mean": 2.0, "quantity": "survival"}


def row(**values):
    return {**START, "stderr": None, **values}


def test_the_last_ratio_is_the_last_one_that_is_measured_well():
    """An error of a fifth is too large; the approach is (ratio − 1) √(t/τ)."""
    weighted = {"method": "weighted", "law": 1e-5}
    rows = [
        row(**weighted, time=40.0, estimate=2e-5, stderr=1e-6),
        row(**weighted, time=60.0, estimate=1.1e-5, stderr=3e-7),
        row(**weighted, time=80.0, estimate=1e-5, stderr=4e-6),
        row(**weighted, time=90.0, estimate=1e-5),
        row(method="counted", time=90.0, estimate=1e-5, stderr=1e-9, law=1e-5),
    ]
    ratio, approach = tails.last_ratios(rows)
    assert (ratio["quantity"], ratio["time"], ratio["radius"]) == ("last_ratio", 60.0, 0.1)
    assert (ratio["estimate"], ratio["stderr"]) == pytest.approx((1.1, 0.03))
    assert approach["quantity"] == "approach"
    expected = 0.1 * math.sqrt(30), 0.03 * math.sqrt(30)
    assert (approach["estimate"], approach["stderr"]) == pytest.approx(expected)
    (only,) = tails.last_ratios([one | {"event": "disc_collision"} for one in rows])
    assert only["quantity"] == "last_ratio"


def survival(hazards, n):
    """Return rows of P(T > t) after 1, 2, … of n intervals with binomial errors."""
    p = np.exp(-np.cumsum([1.0, *hazards]))
    return [
        row(method="counted", time=t, estimate=x, stderr=math.sqrt(x * (1 - x) / n))
        for t, x in enumerate(map(float, p), start=1)
    ]


def test_the_approach_to_a_law_has_a_power_and_a_mean_by_its_errors():
    """Ratios 1 + c √(τ/t) with c = 2, and 3 at the last time; τ = 5."""
    given = [(100.0, 2.0, 0.01), (1000.0, 2.0, 0.02), (4000.0, 2.0, 0.03), (9000.0, 3.0, 0.03)]
    times, c, errors = np.array(given).T
    values = zip(5 * times, 4 * (1 + c / np.sqrt(times)), 4 * errors, strict=True)
    start = {"exact_mean": 5.0, "law": 4.0}
    rows = [start | dict(zip(("time", "estimate", "stderr"), one, strict=True)) for one in values]
    power = tails.approach_power(rows, rows[2])
    assert (power["estimate"], power["until"]) == (pytest.approx(-0.5), rows[2]["time"])
    weights = (2 / np.sqrt(times) / errors)[:3]
    _, covariance = np.polyfit(np.log(times[:3]), np.zeros(3), 1, w=weights, cov="unscaled")
    assert power["stderr"] == pytest.approx(math.sqrt(covariance[0, 0]))
    mean, late = tails.mean_approach(rows[2:]), np.sqrt(times[2:]) * errors[2:]
    assert mean["estimate"] == pytest.approx(np.average([2, 3], weights=late**-2.0))
    assert (mean["stderr"], mean["until"]) == (pytest.approx(late[0]), rows[3]["time"])


def test_one_hazard_at_all_times_is_tested_by_chi_square():
    """For two hazards χ² is the square of their difference over its error."""
    n, hazards = 10**6, (0.8, 0.79)
    rows = survival((*hazards, 5.0), n)
    rate = row(quantity="rate", method="counted", time=1.0, until=3.0, estimate=0.8)
    others = [one | {"radius": 0.3} for one in rows]
    found = {one["quantity"]: one["estimate"] for one in tails.constancy([*others, *rows, rate])}
    p = np.exp(-np.cumsum([1.0, *hazards]))
    errors = [math.sqrt((1 / later - 1 / before) / n) for before, later in pairwise(p)]
    chi2 = (hazards[0] - hazards[1]) ** 2 / (errors[0] ** 2 + errors[1] ** 2)
    chance = math.erfc(math.sqrt(chi2 / 2))
    assert found == pytest.approx({"chi2": chi2, "degrees": 1, "chance": chance})
    slower = [one | {"time": 2 * one["time"]} for one in survival(hazards, n)]
    assert tails.constant_hazard(slower) == (pytest.approx(chi2), 1)
    assert tails.constant_hazard(survival((0.8, 0.8, 0.8), n)) == (pytest.approx(0, abs=1e-12), 2)
    assert not [*tails.constancy([*rows[:2], rate])]
