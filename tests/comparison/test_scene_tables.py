"""Rows have the numbers of the points, for plain scenes and for scenes with effects."""

import math
from dataclasses import replace

import numpy as np
import pytest
from effect_scenes import SCENES
from factory import (
    BOX,
    RADII,
    Laws,
    bins_point,
    counts_point,
    hits_point,
    rows_of,
    scenes,
    theory_rows,
)

from twodiscs.comparison.scene_tables import (
    Areas,
    Cost,
    Grid,
    HopHistogram,
    MeanTimes,
    Theory,
    Volume,
    _sampled_row,
)
from twodiscs.model.box import Box
from twodiscs.model.events import EVENTS
from twodiscs.points import estimates
from twodiscs.points.dynamics import StripCount
from twodiscs.points.intervals import Bins
from twodiscs.sampling import montecarlo
from twodiscs.theory import exact
from twodiscs.theory.exact import rate


@pytest.fixture(scope="module")
def theory():
    return theory_rows()


@pytest.fixture(scope="module")
def laws():
    return [Laws(scene) for scene in scenes()]


def test_an_exact_value_that_is_not_there_is_named(theory, laws):
    point = laws[0].monte_carlo(np.random.default_rng(1), 1000)
    with pytest.raises(ValueError, match=r"theory\.csv has no volume at radius 0\.11"):
        Volume.rows(theory, {"monte_carlo": [replace(point, radius=0.11)]})


# Exact rows -------------------------------------------------------------------------------------


@pytest.mark.parametrize("box", [BOX, Box(1.5, 1.0, {"periodic": "x", "field": 0.3})])
def test_exact_rows_are_the_exact_numbers_radius_by_radius(box, tmp_path):
    radii = (0.3, 0.1)
    found = Theory.rows(box, radii)
    Theory.write(tmp_path / "theory.csv", found)
    assert Theory.read(tmp_path / "theory.csv") == found
    values = iter(found)
    for radius in radii:
        numbers = exact.exact(box.scene(radius))
        expected = [("volume", numbers["volume"])]
        expected += [(f"{event}_area", numbers["areas"][event]) for event in EVENTS]
        expected += [(f"{event}_time", numbers["mean_times"][event]) for event in EVENTS]
        for quantity, value in expected:
            assert next(values) == {"radius": radius, "quantity": quantity, "exact": value}
    assert next(values, None) is None


def test_rows_of_the_grid_say_what_is_open_where(tmp_path):
    found = Grid.rows(BOX, RADII)
    Grid.write(tmp_path / "grid.csv", found)
    assert [row["radius"] for row in found] == list(RADII)
    regimes = {row["radius"]: (row["regime"], row["ergodic_components"]) for row in found}
    assert regimes[0.2] == ("all-hops", 1)
    assert regimes[0.3] == ("vertical-hops", 2)
    assert regimes[0.38] == ("no-hops", 4)
    assert {row["largest_radius"] for row in found} == {BOX.largest_radius}


# Monte Carlo ----------------------------------------------------------------------------------


def test_rows_of_monte_carlo(theory, laws):
    rng = np.random.default_rng(1)
    points = [law.monte_carlo(rng, 10**8) for law in laws]
    volume = Volume.rows(theory, {"monte_carlo": points[::-1]})
    assert [row["radius"] for row in volume] == list(RADII)
    areas = Areas.rows(BOX, theory, {"monte_carlo": points[::-1]})
    assert [(row["radius"], row["quantity"]) for row in areas] == [
        (radius, f"{event}_area") for radius in RADII for event in EVENTS
    ]
    for row in volume + areas:
        if row["status"] == "sampled":
            assert row["estimate"] == pytest.approx(row["expectation"], abs=6 * row["stderr"])
            assert abs(row["z"]) < 6
        assert row["bias"] == row["expectation"] - row["exact"]
    for row in areas:
        blocked = row["exact"] == 0
        assert (row["status"] == "impossible") == blocked
        hop = row["quantity"].removesuffix("_area")
        assert blocked == (not BOX.scene(row["radius"]).is_possible(hop))


def test_the_whole_wall_area_is_four_times_right_and_top(theory, laws):
    point = laws[1].monte_carlo(np.random.default_rng(2), 10**7)
    found = {row["quantity"]: row for row in Areas.rows(BOX, theory, {"monte_carlo": [point]})}
    right, top, whole = (found[f"{e}_area"] for e in ("right_wall", "top_wall", "any_wall"))
    assert whole["estimate"] == pytest.approx(4 * (right["estimate"] + top["estimate"]), rel=1e-14)
    assert whole["expectation"] == 4 * (right["expectation"] + top["expectation"])
    # In these points the two shells are hit independently, so variances add up.
    assert whole["stderr"] == pytest.approx(
        4 * math.hypot(right["stderr"], top["stderr"]), rel=1e-2
    )
    correlated = replace(point, right_and_top=min(right["hits"], top["hits"]))
    found = {row["quantity"]: row for row in Areas.rows(BOX, theory, {"monte_carlo": [correlated]})}
    assert found["any_wall_area"]["stderr"] > 1.1 * whole["stderr"]


def test_only_watched_areas_have_rows(theory, laws):
    point = laws[1].monte_carlo(np.random.default_rng(2), 10**6)
    found = Areas.rows(BOX, theory, {"monte_carlo": [point]}, ("any_wall", "vertical_hop"))
    assert [row["quantity"] for row in found] == ["vertical_hop_area", "any_wall_area"]
    assert Volume.rows(theory, {"monte_carlo": [replace(point, quantities={})]}) == []


def part_row(hits, samples, expectation=0.5, exact=0.5):
    point = hits_point(samples=samples, it=hits)
    return _sampled_row(point, "it", point.sampled("it"), exact, expectation)


@pytest.mark.parametrize(
    ("hits", "status"),
    [(0, "none-seen"), (1, "too-few"), (99, "too-few"), (100, "sampled"), (900, "sampled"),
     (901, "too-few"), (1000, "too-few")],
)  # fmt: skip
def test_few_hits_or_misses_show_no_error(hits, status):
    row = part_row(hits, 1000)
    assert row["status"] == status
    assert (row["estimate"] is None) == (hits == 0)
    assert (row["stderr"] is None) == (status != "sampled")
    assert row["test"] == "exact-tail"
    assert row["z"] is not None


def test_the_shell_of_a_blocked_hop_must_be_as_empty_as_it_is():
    assert part_row(0, 1000, 0.0, 0.0)["z"] == 0
    assert part_row(1, 1000, 0.0, 0.0)["z"] == math.inf
    # A thick shell reaches beyond the blocked surface itself.
    row = part_row(500, 1000, 0.5, 0.0)
    assert (row["status"], row["bias"]) == ("impossible", 0.5)
    assert abs(row["z"]) < 1


# Molecular dynamics ---------------------------------------------------------------------------


def time_row(total=0, squares=0, exact=50.0, radius=0.37, **given):
    point = counts_point(radius, total=total, squares=squares, **given)
    theory = rows_of({(radius, "vertical_hop_time"): exact})
    (row,) = MeanTimes.rows(BOX, theory, {"dynamics": [point]})
    return row


def test_rows_of_mean_times(theory, laws):
    rng = np.random.default_rng(3)
    points = [law.dynamics(rng) for law in laws]
    found = MeanTimes.rows(BOX, theory, {"dynamics": points[::-1]})
    assert [(row["radius"], row["event"]) for row in found] == [
        (r, e) for r in RADII for e in EVENTS
    ]
    for row in found:
        scene = BOX.scene(row["radius"])
        assert row["ergodic_components"] == scene.ergodic_components
        if scene.is_possible(row["event"]):
            assert row["status"] == "reached"
            assert row["estimate"] == pytest.approx(row["exact"], abs=6 * row["stderr"])
            assert row["relative_stderr"] == pytest.approx(row["stderr"] / row["estimate"])
            assert row["relative_stderr"] < 4e-4
            assert row["bound"] is None
            t = (row["estimate"] - row["exact"]) / row["stderr"]
            assert row["z"] == pytest.approx(t, abs=0.03)  # Student's law, and the count's side
        else:
            assert row["status"] == "impossible"
            assert row["z"] == row["count"] == 0
            assert row["estimate"] is row["stderr"] is row["exact"] is None


def test_walls_that_symmetry_makes_equal_have_one_row(theory, laws):
    """Four pairs of a disc and a wall beneath h/4, beyond it two of them for either component."""
    for radius, copies in ((0.2, 4), (0.3, 2)):
        law = laws[RADII.index(radius)]
        point = law.dynamics(np.random.default_rng(4))
        found = {row["event"]: row for row in MeanTimes.rows(BOX, theory, {"dynamics": [point]})}
        row = found["right_wall"]
        assert row["copies"] == copies
        assert abs(row["z"]) < 5
        assert row["estimate"] == copies * row["duration"] * row["replicas"] / row["count"]
        # Averaged over all initial conditions disc 1 hits the right wall copies/4 as often.
        assert row["exact"] == pytest.approx(copies / 4 / rate(law.scene, "right_wall"))


def test_a_rare_hop_has_the_row_of_its_strip(theory, laws):
    law = laws[RADII.index(0.24)]
    point = law.dynamics(np.random.default_rng(5), relative=0.1)
    tau = law.times["horizontal_hop"]
    count, n = round(0.125 * 10**7 / 0.004 / tau) // 4 * 4, 10**7 // 2
    # The first of two strata has a few starts too many.
    slow, fast = count // 4, count // 4 * 3
    strip = StripCount(
        duration=0.125, share=0.004, replicas=2 * n, count=count, squares=count,
        events=10**8,
        strata=([[0.499, 0.501]], [[n, n]], [[slow, fast]], [[slow, fast]]),
    )  # fmt: skip
    point = replace(point, strips={"horizontal_hop": strip})
    found = {row["event"]: row for row in MeanTimes.rows(BOX, theory, {"dynamics": [point]})}
    assert [row["starts"] for row in found.values()].count("strip") == 1
    row = found["horizontal_hop"]
    assert (row["starts"], row["share"], row["count"]) == ("strip", 0.004, count)
    # ⟨N⟩ is 0.499 · q/2 + 0.501 · 3 q/2 with q of all starts together.
    assert row["estimate"] == pytest.approx(tau / 1.001, rel=1e-6)
    rates = np.array([slow, fast]) / n
    error = math.sqrt(np.sum(np.array([0.499, 0.501]) ** 2 * rates * (1 - rates)) / (n - 1))
    mean = [0.499, 0.501] @ rates
    assert row["relative_stderr"] == pytest.approx(error / mean, rel=1e-9)
    assert row["z"] == pytest.approx((mean / 1.001 - mean) / error, abs=1e-3)
    (other,) = MeanTimes.rows(BOX, theory, {"dynamics": [point]}, without_strips=True)
    assert (other["starts"], other["event"]) == ("invariant", "horizontal_hop")
    assert other["count"] == point.counts["horizontal_hop"]
    assert other["replicas"] == point.replicas


def test_none_seen_gives_a_bound_and_no_estimate():
    row = time_row(exact=5e4)
    assert row["status"] == "none-seen"
    assert row["estimate"] is row["stderr"] is row["relative_stderr"] is None
    assert row["bound"] == estimates.mean_time_bound(2048, 10.0)
    assert abs(row["z"]) < 2
    # Where 400 were due, even four to a replica, to see none is wrong.
    assert time_row(exact=51.2)["z"] > 10


def test_too_few_events_show_no_error():
    row = time_row(60, 90, 20480 / 60)
    assert row["status"] == "too-few"
    assert row["estimate"] == pytest.approx(20480 / 60)
    assert row["stderr"] is row["relative_stderr"] is row["bound"] is None
    assert (row["z"], row["test"]) == (0.0, "cluster-bound")
    # 180 events in clusters of three are as good as 60.
    assert time_row(180, 540)["status"] == "too-few"
    row = time_row(300, 350)
    assert row["status"] == "budget"
    assert row["test"] == "cluster-bound"
    assert row["stderr"] > 0
    assert time_row(2000, 3000)["test"] == "normal"


def test_few_replicas_show_no_error():
    assert time_row(10**6, 2 * 10**10, replicas=99)["status"] == "too-few"


def test_a_blocked_hop_that_is_seen_has_an_infinite_score():
    row = time_row(1, 1, None, 0.38)
    assert (row["status"], row["z"], row["count"]) == ("impossible", -math.inf, 1)


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


def test_rows_of_the_histogram(theory, laws):
    rng = np.random.default_rng(5)
    points = [laws[i].intervals(rng) for i in (2, 1)]
    found = HopHistogram.rows(theory, {"intervals": points})
    assert [row["radius"] for row in found] == [0.1] * 17 + [0.2] * 17
    for row in found:
        tau = row["exact_mean"]
        left, right = row["left"], row["right"]
        density = (math.exp(-left / tau) - math.exp(-right / tau)) / (right - left)
        assert row["density"] == pytest.approx(density, abs=5 * row["stderr"])
        assert abs(row["z"]) < 5
        assert row["z"] == pytest.approx((row["mean"] - tau) / row["mean_stderr"], rel=0.02)
    empty = replace(points[0], equal=Bins([0, 1, 2], [0, 5], [0, 5]))
    first, second = [
        row for row in HopHistogram.rows(theory, {"intervals": [empty]}) if row["bins"] == "equal"
    ]
    assert (first["density"], first["stderr"]) == (0.0, None)
    assert second["stderr"] > 0
    few = HopHistogram.rows(theory, {"intervals": [laws[2].intervals(rng, chains=99)]})
    assert few[0]["z"] is few[0]["mean_stderr"] is None


# The time of jobs -----------------------------------------------------------------------------


def test_cost_is_by_stage_and_radius():
    points = {
        "monte_carlo": [hits_point(0.1, 3)],
        "dynamics": [counts_point(0.2, events=5), counts_point(0.1, events=7)],
        "intervals": [bins_point(0.1, intervals=11)],
    }
    jobs = [(stage, point.radius) for stage, some in points.items() for point in some]
    rows = Cost.rows(points, dict.fromkeys(jobs[1:], 0.5))
    assert [tuple(row.values()) for row in rows] == [
        ("dynamics", 0.1, 7, 0.5),
        ("dynamics", 0.2, 5, 0.5),
        ("intervals", 0.1, 11, 0.5),
        ("monte_carlo", 0.1, 3, None),
    ]


# With effects -----------------------------------------------------------------------------------


def exact_of(*scenes):
    """Return the rows of theory.csv of scenes of one box."""
    radii = [scene.radius for scene in scenes]
    return Theory.rows(Box.of(scenes[0]), radii)


#: Each compiles a kernel of its own.
SLOW = ("unequal", "channel", "field", "rough")


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=[pytest.mark.slow] if name in SLOW else []) for name in SCENES],
)
def test_monte_carlo_becomes_rows_that_agree(name, tmp_path):
    scene = SCENES[name]
    quantities = ["volume", *(f"{event}_area" for event in scene.events)]
    scenes = [scene.with_radius(radius) for radius in (0.1, scene.radius)]
    points = [montecarlo.SamplingRun(s, quantities, 1, 0.1, 7).run() for s in scenes]
    theory = exact_of(*scenes)
    volume = Volume.rows(theory, {"monte_carlo": points[::-1]})
    areas = Areas.rows(Box.of(scene), theory, {"monte_carlo": points[::-1]})
    Volume.write(tmp_path / "volume.csv", volume)
    Areas.write(tmp_path / "areas.csv", areas)
    assert [row["radius"] for row in volume] == [s.radius for s in scenes]
    assert [(row["radius"], row["quantity"]) for row in areas] == [
        (s.radius, f"{event}_area") for s in scenes for event in scene.events
    ]
    for row in volume + areas:
        possible = row["exact"] != 0
        assert row["status"] == ("sampled" if possible else "impossible")
        # Five sigma, two-sided: a false alarm in 1.7 million comparisons.
        assert abs(row["z"]) <= 5
        if possible:
            assert abs(row["estimate"] - row["expectation"]) <= 6 * row["stderr"]


def test_all_walls_have_counts_of_their_own():
    scene = SCENES["unequal"]
    point = montecarlo.SamplingRun(scene, ["any_wall_area"], 1, 0.1, 7).run()
    (row,) = Areas.rows(Box.of(scene), exact_of(scene), {"monte_carlo": [point]}, ("any_wall",))
    part = point.quantities["any_wall_area"]
    assert (row["hits"], row["epsilon"]) == (part.hits, part.epsilon)
    assert row["estimate"] == part.measure * part.hits / point.samples
    watched = Areas.rows(Box.of(scene), exact_of(scene), {"monte_carlo": [point]}, ("right_wall",))
    assert watched == []


def test_plain_points_keep_to_right_and_top():
    """All walls of a plain scene join two shells, which its point holds."""
    plain = BOX.scene(0.2)
    point = montecarlo.SamplingRun(plain, ["any_wall_area"], 1, 0.1, 7).run()
    assert "any_wall_area" not in point.quantities
    (row,) = Areas.rows(Box.of(plain), exact_of(plain), {"monte_carlo": [point]}, ("any_wall",))
    assert row["epsilon"] is None
