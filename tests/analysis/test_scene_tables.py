"""The rows of the tables of a scene, made from points.

Without it a number of a point could be lost, or an error be made up.
"""

import math
from collections import Counter
from dataclasses import astuple, replace
from itertools import islice

import numpy as np
import pytest
from effect_scenes import PAPER, SCENES, THREE, in_unit
from factory import LAWS, RADII, Laws, as_theory, bins_point, counts_point, hits_point
from scipy.special import ndtri, stdtr

import twodiscs as td
from twodiscs.analysis import tables
from twodiscs.analysis.tables import AreasTable, HopHistogramTable, MeanTimesTable, VolumeTable
from twodiscs.dynamics import runs
from twodiscs.dynamics.many import many_rates
from twodiscs.measure.intervals import Intervals
from twodiscs.points.dynamics_point import StripCount
from twodiscs.points.intervals_point import Bins
from twodiscs.sampling.montecarlo import MonteCarloRun
from twodiscs.theory.exact import event_rate, rate, replicas_needed

# Monte Carlo ----------------------------------------------------------------------------------


def test_the_whole_wall_area_is_four_times_right_and_top():
    """In thick shells, whose bias is many errors: z is against their expectation."""
    point = Laws(LAWS[1].scene, shell=0.3).monte_carlo(np.random.default_rng(2), 10**9)
    found = {row["quantity"]: row for row in AreasTable.rows([point])}
    right, top, whole = (found[f"{e}_area"] for e in ("right_wall", "top_wall", "any_wall"))
    assert whole["estimate"] == pytest.approx(4 * (right["estimate"] + top["estimate"]), rel=1e-14)
    assert whole["expectation"] == 4 * (right["expectation"] + top["expectation"])
    # In these points the two shells are hit independently, so variances add up.
    both = 4 * math.hypot(right["stderr"], top["stderr"])
    assert whole["stderr"] == pytest.approx(both, rel=1e-2)
    deviate = (whole["estimate"] - whole["expectation"]) / whole["stderr"]
    assert whole["z"] == pytest.approx(deviate, abs=0.05)
    assert whole["bias"] < -10 * whole["stderr"]
    correlated = replace(point, right_and_top=min(right["hits"], top["hits"]))
    found = {row["quantity"]: row for row in AreasTable.rows([correlated])}
    assert found["any_wall_area"]["stderr"] > 1.1 * whole["stderr"]


def test_only_watched_areas_have_rows():
    point = LAWS[1].monte_carlo(np.random.default_rng(2), 10**6)
    found = AreasTable.rows([point], ("any_wall", "vertical_hop"))
    assert [row["quantity"] for row in found] == ["vertical_hop_area", "any_wall_area"]
    assert VolumeTable.rows([replace(point, quantities={})]) == []


def part_row(hits, samples, expectation=0.5, exact=0.5):
    point = hits_point(samples=samples, it=hits)
    return tables._sampled_row(point, "it", point.sampled("it"), exact, expectation)


@pytest.mark.parametrize(
    ("hits", "status"),
    [(0, "none-seen"), (1, "too-few"), (99, "too-few"), (100, "sampled"), (900, "sampled"),
     (901, "too-few"), (1000, "too-few")],
)  # fmt: skip
def test_few_hits_or_misses_show_no_error(hits, status):
    row = part_row(hits, 1000)
    assert (row["status"], row["test"]) == (status, "exact-tail")
    assert (row["estimate"] is None) == (hits == 0)
    assert (row["stderr"] is None) == (status != "sampled")
    assert row["z"] is not None


def test_the_shell_of_a_blocked_hop_must_be_as_empty_as_it_is():
    assert part_row(0, 1000, 0.0, 0.0)["z"] == 0
    assert part_row(1, 1000, 0.0, 0.0)["z"] == math.inf
    # A thick shell reaches beyond the blocked surface itself.
    row = part_row(500, 1000, 0.5, 0.0)
    assert (row["status"], row["bias"]) == ("impossible", 0.5)
    assert abs(row["z"]) < 1
    # Weights of three discs: each area must be 0, or the row is wrong.
    point = td.sample(td.Scene(1.5, 1.0, 0.28, discs=3), 1).point
    blocked, other = (point.quantities[f"{event}_area"] for event in ("horizontal_hop", "top_wall"))
    for weights, z in ((blocked, 0), (other, math.inf)):
        wrong = replace(point, quantities=point.quantities | {"horizontal_hop_area": weights})
        row = next(r for r in AreasTable.rows([wrong]) if r["quantity"] == "horizontal_hop_area")
        assert (row["z"], row["test"]) == (z, "certain")


# Molecular dynamics ---------------------------------------------------------------------------


def time_row(total=0, squares=0, exact=50.0, radius=0.37, **given):
    with as_theory({(radius, "vertical_hop_time"): exact}):
        (row,) = MeanTimesTable.rows([counts_point(radius, total=total, squares=squares, **given)])
    return row


def test_walls_that_symmetry_makes_equal_have_one_row():
    """Four pairs of a disc and a wall beneath h/4, beyond it two of them for either component."""
    for radius, copies in ((0.2, 4), (0.3, 2)):
        law = LAWS[RADII.index(radius)]
        point = law.dynamics(np.random.default_rng(4))
        row = {row["event"]: row for row in MeanTimesTable.rows([point])}["right_wall"]
        assert row["copies"] == copies
        assert abs(row["z"]) < 5
        assert row["estimate"] == copies * row["duration"] * row["replicas"] / row["count"]
        # Averaged over all initial conditions disc 1 hits the right wall copies/4 as often.
        assert row["exact"] == pytest.approx(copies / 4 / rate(law.scene, "right_wall"))


def test_a_rare_hop_has_the_row_of_its_strip():
    law = LAWS[RADII.index(0.24)]
    point = law.dynamics(np.random.default_rng(5), relative=0.1)
    tau = law.times["horizontal_hop"]
    count, n = round(0.125 * 10**7 / 0.004 / tau) // 4 * 4, 10**7 // 2
    # The first of two strata has a few starts too many.
    slow, fast = count // 4, count // 4 * 3
    sums = np.array([[[n, n]], [[slow, fast]], [[2 * slow, 2 * fast]]])
    component = {"duration": 0.125, "share": 0.004, "replicas": n, "shares": [[0.499, 0.501]]}
    strip = StripCount.of(component | {"sums": {(0, 2): [sums, np.int64(10**8)]}})
    point = replace(point, strips={"horizontal_hop": strip})
    found = {row["event"]: row for row in MeanTimesTable.rows([point])}
    assert [row["starts"] for row in found.values()].count("strip") == 1
    row = found["horizontal_hop"]
    assert (row["starts"], row["share"], row["count"]) == ("strip", 0.004, count)
    assert (row["replicas"], row["duration"], strip.events) == (2 * n, 0.125, 10**8)
    # ⟨N⟩ is 0.499 · q/2 + 0.501 · 3 q/2 with q of all starts together.
    assert row["estimate"] == pytest.approx(tau / 1.001, rel=1e-6)
    rates = np.array([slow, fast]) / n
    error = math.sqrt(np.sum(np.array([0.499, 0.501]) ** 2 * rates * (2 - rates)) / (n - 1))
    mean = [0.499, 0.501] @ rates
    assert row["relative_stderr"] == pytest.approx(error / mean, rel=1e-9)
    assert row["z"] == pytest.approx((mean / 1.001 - mean) / error, abs=1e-3)
    (other,) = MeanTimesTable.rows([point], without_strips=True)
    assert (other["starts"], other["event"]) == ("invariant", "horizontal_hop")
    assert other["count"] == point.counts["horizontal_hop"]
    assert other["replicas"] == point.replicas
    # Both are compared with theory, every other event once.
    compared = Counter(row["quantity"] for row in tables.CheckTable.rows([point]))
    for event in found:
        assert compared[f"{event}_time"] == 1 + (event == "horizontal_hop")


def test_none_seen_gives_a_bound_and_no_estimate():
    row = time_row(exact=5e4)
    assert row["estimate"] is row["stderr"] is row["relative_stderr"] is None
    assert abs(row["z"]) < 2
    # Where 400 were due, even four to a replica, to see none is wrong.
    assert time_row(exact=51.2)["z"] > 10


def test_too_few_events_show_no_error():
    row = time_row(60, 90, 20480 / 60)
    assert row["status"] == "too-few"
    assert row["estimate"] == pytest.approx(20480 / 60)
    assert row["stderr"] is row["relative_stderr"] is row["bound"] is None
    assert (row["z"], row["test"]) == (0.0, "cluster-bound")
    assert time_row(60, 90, 20480 / 20)["z"] < 0  # too many of them
    # 180 events in clusters of three are as good as 60.
    assert time_row(180, 540, 20480 / 180)["status"] == "too-few"
    row = time_row(300, 350, 20480 / 300)
    assert (row["status"], row["test"]) == ("budget", "cluster-bound")
    assert row["stderr"] > 0
    for factor, status in ((1.001, "reached"), (0.999, "budget")):
        target = {"vertical_hop": factor * row["relative_stderr"]}
        assert time_row(300, 350, 20480 / 300, target=target)["status"] == status
    # The error that was asked for is that of the strip.
    beside = counts_point(total=300, squares=350, strips={"vertical_hop": None})
    with as_theory({(0.37, "vertical_hop_time"): 20480 / 300}):
        (row,) = MeanTimesTable.rows([beside], without_strips=True)
    assert row["status"] == "counted"
    assert time_row(3000, 9000, 20480 / 3000)["test"] == "normal"
    assert time_row(10**6, 2 * 10**10, replicas=99)["status"] == "too-few"


def test_where_no_exact_value_is_known_what_is_seen_stands():
    """This state differs from impossible: nothing is compared, and nothing fails."""
    row = time_row(2000, 3000, None)
    assert row["status"] == "budget"
    assert row["estimate"] == pytest.approx(2048 * 10.0 / 2000)
    assert row["stderr"] > 0
    assert row["exact"] is row["z"] is row["test"] is None
    assert time_row(exact=None)["status"] == "none-seen"
    row = part_row(500, 1000, expectation=None, exact=None)
    assert (row["status"], row["z"], row["bias"]) == ("sampled", None, None)
    assert row["estimate"] > 0


# Histogram ------------------------------------------------------------------------------------


def test_rows_of_the_histogram():
    rng = np.random.default_rng(5)
    points = [LAWS[i].intervals(rng) for i in (2, 1)]
    found = HopHistogramTable.rows(points)
    assert [row["radius"] for row in found] == [0.1] * 17 + [0.2] * 17
    for row in found:
        tau = row["exact_mean"]
        left, right = row["left"], row["right"]
        density = (math.exp(-left / tau) - math.exp(-right / tau)) / (right - left)
        assert row["density"] == pytest.approx(density, abs=5 * row["stderr"])
        assert abs(row["z"]) < 5
        assert row["z"] == pytest.approx((row["mean"] - tau) / row["mean_stderr"], rel=0.02)
    empty = replace(points[0], equal=Bins([0, 1, 2], [0, 5], [0, 5], [0, 5]))
    first, second = [row for row in HopHistogramTable.rows([empty]) if row["bins"] == "equal"]
    assert (first["density"], first["stderr"]) == (0.0, None)
    assert second["stderr"] > 0
    few = HopHistogramTable.rows([point := LAWS[2].intervals(rng, chains=99)])
    assert few[0]["z"] is few[0]["mean_stderr"] is None
    said = [Intervals(one.scene, one, {}).mean.status for one in (points[0], point)]
    assert said == ["sampled", "too-few"]


@pytest.mark.parametrize("discs", [2, 3])
@pytest.mark.parametrize(
    ("events", "counts", "status"),
    [(0.4, (100, 110, 9), "extrapolated"), (0.39, (99, 100, 9), "too-few"),
     (0.39, (100, 99, 9), "too-few"), (0.41, (100, 100, 9), "not-resolved")],
)  # fmt: skip
def test_a_density_at_zero_needs_few_events_and_many_intervals(discs, events, counts, status):
    """Bins resolve up to 0.4 events of a pair, N/2 of which share the exact rate of all events."""
    scene = replace(LAWS[1].scene, discs=discs)
    point = bins_point(counts=counts, scene=scene, bin_width=events * discs / 2 / event_rate(scene))
    found = Intervals(scene, point, {"number": sum(counts)}).at_zero
    assert (found.status, found.count) == (status, sum(counts[:2]))
    assert (found.value is None) == (status == "not-resolved")
    assert (found.stderr is None) == (status != "extrapolated")
    if status == "extrapolated":  # by a parabola without a linear term, or by a line
        weights = np.array([7, -1]) / 6 if discs == 2 else np.array([3, -1]) / 2
        parts = weights * np.transpose([astuple(b.density)[:2] for b in islice(point.bins(), 2)])
        assert [found.value, found.stderr] == pytest.approx([parts[0].sum(), np.hypot(*parts[1])])


# Units ------------------------------------------------------------------------------------------


UNIT = 2.0**-6


@pytest.mark.parametrize(
    "scene",
    [PAPER, *(SCENES[n] for n in ("field", "rough")), THREE,
     td.Scene(5.0, 1.0, 0.24, discs=5, friction=0.2)],
    ids=str,
)  # fmt: skip
def test_columns_scale_as_their_units_say(scene):
    """The random numbers are the same in each unit of length."""
    sampled = ["volume", "vertical_hop_area", "disc_collision_area"]
    powers = {"": 0, "length": 1, "time": 1, "1/time": -1}
    dimensions = scene.discs * len(scene.axes)
    powers |= {"length⁴": dimensions, "length³": dimensions - 1}  # the units of two discs
    found = []
    for one in (scene, in_unit(scene, UNIT)):
        points = [
            runs.DynamicsRun(one, dict.fromkeys(td.EVENTS, 1.0), 1, 7).run(),
            runs.IntervalsRun(one, "vertical_hop", 1, 7).run(),
            MonteCarloRun(one, sampled, 1, 0.02, 7).run(),
        ]
        made = VolumeTable, AreasTable, MeanTimesTable, HopHistogramTable
        rows = [(table, row) for table in made for row in table.rows(points)]
        found.append([(name, c, row[name]) for t, row in rows for name, c in t.columns.items()])
    for (name, column, one), (*_, other) in zip(*found, strict=True):
        if column.type is float and one is not None:
            one = pytest.approx(one * UNIT ** powers[column.unit], rel=1e-9, abs=1e-300)
        assert other == one, name


# With effects -----------------------------------------------------------------------------------


def test_the_bound_of_a_wall_never_hit_counts_no_copy_twice():
    """The walls that are one by symmetry are hit together: no more is known than of one event.

    Without an event in R replicas of length T the bound is R T/(4 ln 20).
    """
    point = LAWS[RADII.index(0.3)].dynamics(np.random.default_rng(1))
    none = {name: dict.fromkeys(getattr(point, name), 0) for name in ("counts", "products")}
    point = replace(point, **none)
    possible = [row for row in MeanTimesTable.rows([point]) if row["status"] != "impossible"]
    assert {row["copies"] for row in possible} == {1, 2, 4}
    due = point.replicas * point.duration / (4 * math.log(20))
    for row in possible:
        assert row["status"] == "none-seen"
        assert row["bound"] == pytest.approx(due, rel=1e-12), row["event"]


@pytest.mark.parametrize(
    ("replicas", "target", "status"),
    [(2**15, 0.5, "too-few"), (2**16, 0.5, "reached"), (2**15, None, "too-few"),
     (2**16, None, "counted")],
)  # fmt: skip
def test_an_error_smaller_than_asked_needs_its_own_initial_states(replicas, target, status):
    """Half of the mean time needs 119 states of rough discs, the error of these counts 45411."""
    scene, event = td.Scene(1.5, 1.0, 0.245, moment_of_inertia=0.5), "disc_collision"
    assert replicas_needed(scene, event, 0.5) < replicas
    total = 1000 * replicas
    point = counts_point(
        scene.radius, event, total, 1010 * total,
        scene=scene, replicas=replicas, target={event: target},
    )  # fmt: skip
    with as_theory({(scene.radius, f"{event}_time"): 1.0}):
        (row,) = MeanTimesTable.rows([point])
    assert row["status"] == status
    assert (row["stderr"] is None) == (status == "too-few")


@pytest.mark.parametrize(("replicas", "status"), [(2016, "too-few"), (2017, "reached")])
def test_a_strip_of_rough_discs_needs_its_events_alone(replicas, status):
    """All of its initial states are in the neck: 100 (2/⟨N⟩ + 1/6) have an error.

    The same counts from ordinary initial states have none, because few of those are in the neck.
    """
    scene, hop = td.Scene(1.5, 1.0, 0.2475, moment_of_inertia=0.1), "horizontal_hop"
    strip = StripCount(
        duration=1.0, share=0.01, replicas=replicas, count=200, squares=200, events=1000,
        strata=([[1.0]], [[replicas]], [[200]], [[200]]),
    )  # fmt: skip
    given = {"scene": scene, "replicas": replicas, "duration": 100.0, "target": {hop: 0.1}}
    point = counts_point(scene.radius, hop, 200, 200, strips={hop: strip}, **given)
    with as_theory({(scene.radius, f"{hop}_time"): 1000.0}):  # ⟨N⟩ is 0.1
        (row,), (other,) = (MeanTimesTable.rows([point], part) for part in (False, True))
    assert (row["starts"], row["status"]) == ("strip", status)
    assert (row["stderr"] is None) == (status == "too-few")
    assert (other["starts"], other["status"], other["z"]) == ("invariant", "too-few", None)


@pytest.mark.parametrize("chains", [100, 150])
def test_the_mean_of_a_histogram_is_tested_over_chains(chains):
    """Student's t with as many degrees of freedom as chains less one, whatever their intervals."""
    point = LAWS[2].intervals(np.random.default_rng(2), chains)
    point = replace(point, mean=LAWS[2].times["vertical_hop"] - 5 * point.stderr)
    (z,) = {row["z"] for row in HopHistogramTable.rows([point])}
    assert z == pytest.approx(ndtri(stdtr(chains - 1, -5.0)), abs=2e-3)
    assert abs(z - ndtri(stdtr(point.intervals - 1, -5.0))) > 0.1


CORNERS = [
    (td.Scene(1.5, 1, 1e-4, discs=3), 2**16, 1908),
    (td.Scene(1.5, 1, 1e-4, discs=4), 2**16, 1908),
    (td.Scene(5.8658211593466785, 1.0, 0.48719834881192786, discs=6, periodic="x"), 2**17, 23),
]


@pytest.mark.parametrize(("scene", "samples", "seed"), CORNERS)
def test_insertions_that_all_fit_or_hardly_ever_have_no_error(scene, samples, seed):
    """As two discs have it: too few hits, or too few misses."""
    for row in td.sample(scene, samples, seed=seed).values():
        assert row.count == 0 or row.status == "too-few"
        assert row.status in ("too-few", "none-seen")
        assert row.stderr is row.interval() is row.z is None
        assert (row.value is None) == (row.status == "none-seen")


def test_insertions_have_a_score_from_1000_on():
    rows = td.sample(td.Scene(1.5, 1, 0.2, discs=3), 1, seed=1).rows
    assert {(r["z"] is None, r["hits"] < 1000) for r in rows} == {(True, True), (False, False)}
    assert all(r["z"] * (r["estimate"] - r["exact"]) > 0 for r in rows if r["z"])


DENSE = [
    CORNERS[-1][0],
    td.Scene(1.0, 1.4280527786758892, 0.15449468266455402, discs=10),
    td.Scene(3.6810167765300044, 1.0, 0.20987490024520206, discs=14, periodic="x"),
]


@pytest.mark.parametrize("scene", DENSE)
def test_rates_that_insertions_do_not_see_are_guessed(scene):
    assert 0 < many_rates.expected_event_rate(scene) < math.inf
    assert many_rates.expected_rates(scene)["disc_collision"] > 0
