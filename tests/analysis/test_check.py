"""The check of a scene: its comparisons, bounds and verdicts.

Without it a wrong theory, count or error bar could pass, or a right one fail.
"""

from collections import Counter
from dataclasses import replace
from itertools import combinations_with_replacement
from types import SimpleNamespace

import numpy as np
import pytest
from effect_scenes import SCENES
from factory import LAWS, RADII, Laws, as_theory, counts_point, empty, exact_values, of
from scipy.special import ndtri, stdtr

from twodiscs.analysis import check, scores
from twodiscs.analysis.tables import AreasTable, HopHistogramTable, MeanTimesTable, VolumeTable
from twodiscs.model.events import EVENT_AXES, EVENTS, HOPS, SHELL_EVENTS, WALLS
from twodiscs.model.scene import Scene
from twodiscs.points.estimates import Estimate
from twodiscs.theory import exact

SAMPLES = 10**12  # at 0.36 a sample in 300 000 is a hit of a shell

#: {axis: its first wall}; the others are hit as often as this one, in every replica.
FIRST = {EVENT_AXES[wall]: wall for wall in reversed(WALLS)}
MIRRORED = [wall for wall in WALLS if wall not in FIRST.values()]

#: How many quantities have scores at several radii: volume, areas, times, intervals, the sum rule.
SCORED = 3 + 2 * len(EVENTS)

BLOCKED = sum(not law.scene.is_possible(hop) for law in LAWS for hop in HOPS)
TESTED = len(RADII) * (1 + 2 * len(SHELL_EVENTS) - len(MIRRORED)) + 4 - 2 * BLOCKED


@pytest.fixture(scope="module")
def points():
    rng = np.random.default_rng(1)
    return {
        "monte_carlo": [law.monte_carlo(rng, SAMPLES) for law in LAWS],
        "dynamics": [law.dynamics(rng) for law in LAWS],
        "intervals": [law.intervals(rng) for law in LAWS[:4]],
    }


def text_table(points, theory=None):
    points = [point for some in points.values() for point in some]
    with as_theory(theory or exact_values()):
        compared = check.comparisons(
            VolumeTable.rows(points),
            AreasTable.rows(points),
            MeanTimesTable.rows(points),
            HopHistogramTable.rows(points),
            [point for point in points if point.stage == "dynamics"],
        )
    return check.check_rows(compared)


def failed(rows):
    return {(row["comparison"], row["quantity"], row["radius"]) for row in of(rows, passed=False)}


# When all is right ----------------------------------------------------------------------------


def test_all_that_was_measured_is_compared(points):
    found = text_table(points)
    assert all(row["passed"] for row in found)
    n = len(RADII)
    assert Counter(row["comparison"] for row in found) == {
        **{"volume": n, "area": len(EVENTS) * n, "mean_time": len(EVENTS) * n, "sum_rule": n},
        **{"hop_interval": 4, "z_mean": SCORED, "z_spread": SCORED},
    }
    over_radii = 2 * SCORED
    at_a_radius = found[:-over_radii]
    assert [row["radius"] for row in at_a_radius] == sorted(row["radius"] for row in at_a_radius)
    for rows in (at_a_radius, found[-over_radii:]):
        assert {row["bound"] for row in rows} == {scores.bonferroni_bound(len(rows), 5e-4)}
    z = [row["z"] for row in found if row["comparison"] == "volume"]
    mean, size = (row for row in found[-over_radii:] if row["quantity"] == "volume")
    assert (mean["exact"], size["exact"]) == (0.0, 1.0)
    assert mean["stderr"] == pytest.approx(len(z) ** -0.5)
    assert mean["estimate"] == pytest.approx(np.mean(z))
    assert size["estimate"] == pytest.approx(np.sqrt(np.mean(np.square(z))))
    assert (mean["z"], size["z"]) == (scores.z_mean(z), scores.z_spread(z))
    for row in found:
        assert row["p"] == scores.two_sided_p(row["z"])
        if row["comparison"] in ("sum_rule", "hop_interval"):
            deviate = (row["estimate"] - row["exact"]) / row["stderr"]
            assert row["z"] == pytest.approx(ndtri(stdtr(1023, deviate)))  # 1024 replicas or chains


# When something is wrong ----------------------------------------------------------------------


def possible_radii(event):
    return {law.scene.radius for law in LAWS if law.scene.is_possible(event)}


#: {wrong number: another one that fails with it}.
ALSO = {"vertical_hop_time": "vertical_hop_interval"}
ALSO |= {f"{wall}_area": "any_wall_area" for wall in WALLS}


@pytest.mark.parametrize(
    "name", ["volume", *(f"{e}_time" for e in EVENTS), *(f"{e}_area" for e in SHELL_EVENTS)]
)
def test_a_number_off_by_one_percent_is_named(points, name, monkeypatch):
    true = exact.shell_expectation

    def shell_expectation(scene, of, epsilon):
        return true(scene, of, epsilon) * (1.01 if f"{of}_area" == name else 1)

    monkeypatch.setattr(exact, "shell_expectation", shell_expectation)
    event, _, kind = name.rpartition("_")
    radii = possible_radii(event or "any_wall")
    theory = exact_values()
    for radius in radii if kind != "area" else ():
        theory[radius, name] *= 0.99 if event in HOPS else 1.01
    found = failed(text_table(points, theory))
    assert {("mean_time" if kind == "time" else kind, name, radius) for radius in radii} <= found
    assert {quantity for _, quantity, _ in found} <= {name, ALSO.get(name)}


@pytest.mark.parametrize("dynamics", [0.031, 0.032])
@pytest.mark.parametrize("samples", [0.031, 0.032])
def test_a_flux_has_a_score_if_neither_of_its_errors_is_coarse(dynamics, samples, monkeypatch):
    """Both are to be below 1/√1000, and known."""
    monkeypatch.setattr(check, "flux_time", lambda *_: Estimate(2.0, 2.0 * samples, 9))
    row = empty(MeanTimesTable, radius=0.1, event="top_wall", starts="invariant", status="counted")
    row |= {"estimate": 2.1, "stderr": 2.1 * dynamics, "relative_stderr": dynamics}
    point = SimpleNamespace(radius=0.1, stage="monte_carlo", method="insertion")
    _, flux = check.comparisons([], [], [row], [], [point])
    assert (flux["comparison"], flux["exact"], flux["estimate"]) == ("flux", 1, 1.05)
    assert flux["radius"] == point.radius
    assert flux["stderr"] == pytest.approx(1.05 * np.hypot(dynamics, samples))
    fine = max(dynamics, samples) == 0.031
    assert flux["z"] == (pytest.approx(0.05 / flux["stderr"]) if fine else None)
    assert flux["status"] == ("counted" if fine else "too-few")
    _, unknown = check.comparisons([], [], [row | {"stderr": None}], [], [point])
    monkeypatch.setattr(check, "flux_time", lambda *_: None)
    assert check.comparisons([], [], [row], [], [point])[1] == unknown
    assert (unknown["estimate"], unknown["z"], unknown["status"]) == (None, None, "too-few")
    # Without samples at its radius there is no flux.
    assert len(check.comparisons([], [], [row | {"radius": 0.2}], [], [point])) == 1


@pytest.mark.parametrize("rare", check.SUM_RULE_EVENTS)
@pytest.mark.parametrize(("number", "status"), [(999, "too-few"), (1000, "counted")])
def test_the_sum_rule_needs_a_thousand_of_each_of_its_events(rare, number, status):
    counts = dict.fromkeys(check.SUM_RULE_EVENTS, 50 * 2048) | {rare: number}
    pairs = combinations_with_replacement(counts, 2)  # of independent events
    products = {f"{a}*{b}": counts[a] * counts[b] // 2048 + counts[a] * (a == b) for a, b in pairs}
    point = counts_point(0.2, counts=counts, products=products, target=dict.fromkeys(counts, 1.0))
    (row,) = check.comparisons([], [], [], [], [point])
    assert (row["radius"], row["exact"], row["status"]) == (0.2, 1, status)
    assert (row["z"] is None) == (status == "too-few")


@pytest.mark.parametrize(("replicas", "status"), [(2**15, "too-few"), (2**16, "counted")])
def test_the_sum_rule_needs_the_initial_states_of_all_its_events(replicas, status):
    """Collisions and the top wall of these rough discs need 45411, the right wall 19254."""
    scene = Scene(1.5, 1.0, 0.245, moment_of_inertia=0.5)
    point = Laws(scene).dynamics(np.random.default_rng(3), replicas, 1e-2)
    rows = check.comparisons([], [], [], [], [point])
    assert [row["status"] for row in rows if row["comparison"] == "sum_rule"] == [status]


def with_hops(point, number):
    """Return the point with another ``number`` of vertical hops, each in a replica of its own."""
    event = "vertical_hop"
    products = {pair: 0 if event in pair else n for pair, n in point.products.items()}
    products |= {f"{event}*{event}": number}
    return replace(point, counts=point.counts | {event: number}, products=products)


def test_what_is_blocked_must_not_be_seen(points):
    seen = with_hops(points["dynamics"][RADII.index(0.38)], 1)
    found = text_table({**points, "dynamics": [seen]})
    assert failed(found) == {("mean_time", "vertical_hop_time", 0.38)}


def test_what_is_due_must_be_seen(points):
    dynamics = [with_hops(point, 0) for point in points["dynamics"]]
    due = {("mean_time", "vertical_hop_time", r) for r in possible_radii("vertical_hop")}
    assert failed(text_table({**points, "dynamics": dynamics})) == due
    monte_carlo = [
        replace(p, quantities=p.quantities | {"volume": replace(p.quantities["volume"], hits=0)})
        for p in points["monte_carlo"]
    ]
    assert ("volume", "volume", 0.38) in failed(text_table({**points, "monte_carlo": monte_carlo}))


def test_what_cannot_be_compared_is_there_and_not_passed():
    rng = np.random.default_rng(6)
    interval = LAWS[1].intervals(rng, chains=50)
    dynamics = LAWS[1].dynamics(rng, replicas=64, relative=1e-2)
    found = text_table({"dynamics": [dynamics], "intervals": [interval]})
    untested = [row for row in found if row["passed"] is None]
    assert {row["comparison"] for row in untested} == {"hop_interval", "sum_rule"}
    for row in untested:
        assert row["status"] == "too-few"
        assert row["z"] is row["p"] is row["bound"] is row["test"] is None
    assert {row["status"] for row in found if row["comparison"] == "mean_time"} == {"too-few"}


# With effects ---------------------------------------------------------------------------------


def test_the_sum_rule_is_for_equal_discs_between_walls():
    """One effect at a time: spins and kicks do not matter."""
    simple = LAWS[2].scene, SCENES["rough"], SCENES["friction"]
    ratios = (replace(SCENES["unequal"], **{f"{name}_ratio": 1.0}) for name in ("mass", "radius"))
    for scene in (*simple, *ratios, *map(SCENES.get, ("channel", "field", "balls"))):
        point = Laws(scene).dynamics(np.random.default_rng(3), events=check.SUM_RULE_EVENTS)
        found = check.comparisons([], [], [], [], [point])
        assert [row["comparison"] for row in found] == ["sum_rule"] * (scene in simple)


# Independent rows -----------------------------------------------------------------------------


def test_independent_rows_could_fail_and_follow_from_no_other(points):
    good = text_table(points)
    independent = [row for row in good if row["independent"]]
    compared = {row["comparison"] for row in independent}
    assert compared == {"volume", "area", "mean_time", "hop_interval"}
    for row in [row for row in good if not row["independent"]]:
        derived = row["comparison"] in ("sum_rule", "z_mean", "z_spread")
        summed = {"any_wall_area", *(f"{event}_time" for event in ("any_wall", *MIRRORED))}
        assert derived or row["quantity"] in summed or row["test"] == "certain"
    assert not any(row["test"] == "certain" for row in independent)
    assert len(independent) == TESTED


def test_walls_are_tests_of_their_own_where_they_are_not_counted_alone():
    """The whole of the walls is a sum of others only if those are watched, or has a shell."""
    rng, row = np.random.default_rng(7), empty(AreasTable, quantity="any_wall_area", radius=0.2)
    for epsilon in (None, 0.004):
        (one,) = check.comparisons([], [row | {"epsilon": epsilon, "z": 0.0}], [], [], [])
        assert one["independent"] == (epsilon is not None)
    for events in (("any_wall",), ("right_wall", "any_wall"), ("disc_collision", "any_wall")):
        found = text_table({"dynamics": [LAWS[1].dynamics(rng, events=events)]})
        independent = [row["quantity"] for row in found if row["independent"]]
        assert independent == [f"{event}_time" for event in events]
