"""The studies of stability and of error bars.

Without these tests stability could judge by wrong errors, and pass what is wrong.

Statistical comparisons are held to five standard errors.
"""

import math
from functools import partial

import numpy as np
import pytest
import yaml
from effect_scenes import PAPER
from factory import BOX, EXPECTED, LONG_RUNS, cells, of, written
from marks import slow
from mpmath import mpf
from scipy.stats import chi2, norm

import twodiscs as td
from twodiscs.dynamics.law import Law, two_disc_law
from twodiscs.figures import style
from twodiscs.sampling import montecarlo
from twodiscs.sampling.initial_states import states
from twodiscs.theory import exact
from twodiscs_paper.studies.distributions import measure as distributions
from twodiscs_paper.studies.passages import near, powers
from twodiscs_paper.studies.passages.parts import near_threshold
from twodiscs_paper.studies.stability import calibration, figure, figure_runs
from twodiscs_paper.studies.stability import measure as stability
from twodiscs_paper.studies.stability.study import CalibrationTable, StabilityTable

KEPT = LONG_RUNS / "calibration"
LARGEST = "largest radius"
BOXES = [BOX, td.Box(3.0, 1.0), td.Box(1e6, 1e-6), td.Box(1e-6, 1e6)]
#: The reference of theory takes half a second for a box.
OTHERS = [td.Box(1.0, 1.5), td.Box(1.0, 1.0), td.Box(2.0, 1.0), td.Box(1.98, 1.0)]
any_box = pytest.mark.parametrize("box", [*BOXES, *map(slow, OTHERS)], ids=str)


def failed(rows):
    return of(rows, passed=False)


def compared(box, rows):
    """Return the rows of a box; those of 1.5 × 1 are about what the expected ones are about.

    They have the same exact values and bounds.
    """
    rows, names = [*rows], ("part", "case", "radius", "distance", "method", "quantity")
    parts = {row["part"] for row in rows}
    kept = [row for row in StabilityTable.read(EXPECTED / "stability.csv") if row["part"] in parts]
    if box == BOX:
        bounds = "exact", "low", "high"
        assert cells(rows, *names) == cells(kept, *names)
        ours, due = (np.array(cells(some, *bounds), float) for some in (rows, kept))
        np.testing.assert_allclose(ours, due, rtol=1e-6)
    return rows


# Radii ------------------------------------------------------------------------------------------


@any_box
def test_all_radii_fit_and_ordinary_ones_visit_every_regime(box):
    radii = stability.ordinary_radii(box)
    assert radii == sorted(radii)
    limits = sorted(stability.limits(box).values())
    middles = [(a + b) / 2 for a, b in zip([0.0, *limits], limits, strict=False)]
    visited, every = ({box.scene(radius).regime for radius in some} for some in (radii, middles))
    assert visited == every
    for _, _, radius in stability.hard_radii(box):
        box.scene(radius)


# Rows -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "bounds", "passed"),
    [
        (1.0, {}, None),
        (None, {"high": 1.0}, None),
        (1.0, {"high": 1.0}, True),
        (1.1, {"high": 1.0}, False),
        (0.9, {"low": 1.0}, False),
        (1.0, {"low": 0.9, "high": 1.1, "z": -5.1}, False),
        (1.0, {"z": 5.0}, True),
        (math.nan, {"high": 1.0}, False),
    ],
)
def test_a_row_passes_within_its_bounds(value, bounds, passed):
    assert stability.judged({}, "volume", value, **bounds)["passed"] is passed


@any_box
def test_theory_holds_where_closed_forms_fail(box):
    rows = compared(box, stability.theory_rows(box))
    assert failed(rows) == []
    stable = of(rows, method="stable")
    assert len(stable) >= 100
    assert all(row["passed"] for row in stable)
    near, *_ = of(rows, method="closed-form", quantity="volume", distance=-1e-9, case=LARGEST)
    # Two powers of the room are lost even where the discs lie in a row.
    assert near["value"] > 1e-4 or max(box.sides) > 10 * min(box.sides)


def test_an_error_in_a_formula_shows(monkeypatch):
    volume = exact.volume
    monkeypatch.setattr(exact, "volume", lambda scene: volume(scene) * (1 + 1e-12))
    assert {row["quantity"] for row in failed(stability.theory_rows(BOX))} == {"volume"}
    # A zero must be met exactly.
    assert stability.relative_error({"a": 0.0}, {"a": mpf(0)}) == 0
    assert stability.relative_error({"a": 1e-300}, {"a": mpf(0)}) == math.inf
    assert stability.relative_error({"a": 1.0}, {}) == math.inf


@any_box
def test_sampling_and_estimates_hold(box, monkeypatch):
    """Five sigma on every share and estimate: with some 1000 of them a false alarm in 6e-4."""
    monkeypatch.setattr(stability, "SHARE_PROPOSALS", 2**16)
    monkeypatch.setattr(stability, "ESTIMATE_PROPOSALS", 2**18)
    shares = compared(box, stability.sampling_rows(box, seed=1))
    assert failed(shares) == []
    shares = of(shares, method="conditioned")
    assert all(0.25 <= row["exact"] <= 1 for row in shares)
    for row in shares:
        variance = row["exact"] * (1 - row["exact"]) / row["count"]
        if row["count"] * min(row["exact"], 1 - row["exact"]) >= 1000:
            z = (row["value"] - row["exact"]) / math.sqrt(variance)
            assert row["z"] == pytest.approx(z, rel=1e-6)
    estimates = compared(box, stability.estimate_rows(box, seed=1))
    assert failed(estimates) == []
    volumes = of(estimates, quantity="volume")
    assert all(row["exact"] == exact.volume(box.scene(row["radius"])) for row in volumes)
    assert all(row["count"] >= 2**18 for row in estimates)
    assert all(0 < row["value"] < math.inf for row in of(estimates, quantity="volume"))


def test_the_seed_after_the_largest_is_0():
    assert stability.other_seed(2**63 - 1, 1) == 0


# Times of events ----------------------------------------------------------------------------------


@pytest.mark.parametrize("box", [BOX, td.Box(1e6, 1e-6)], ids=str)
def test_predicted_times_are_right_to_a_few_roundings(box):
    ours = of(compared(box, stability.time_rows(box, seed=4)), method="stable")
    assert len(ours) == 8
    assert all(row["passed"] and row["count"] >= 350 for row in ours)
    assert all(0.05 < row["value"] < 4 for row in ours)


@pytest.mark.parametrize(
    ("apart", "formula", "error"),
    [
        (0.5, None, 0),
        (0.4, None, None),
        (0.1, (1.0, math.nan, True), math.inf),
        (0.1, (math.nan, 1.0, True), math.inf),
        (0.5, (1.0, 1.0, True), math.inf),
    ],
)
def test_misses_and_false_hits_are_infinite_errors(apart, formula, error):
    others = [] if formula is None else [lambda *inputs: formula]
    dx, dy = -0.6 - 0.8 * apart, -0.8 + 0.6 * apart
    assert stability.contact_error(dx, dy, 1.2, 1.6, 0.4, *others) == error


def test_the_textbook_is_right_where_nothing_cancels():
    found = stability.contact_error(-1.0, 0.25, 1.0, 0.125, 0.5, stability.textbook_quotient)
    assert found < 4
    assert stability.exact_contact(1.0, 0.25, 0.5, 0.0, 0.5) == (None, None)  # the discs part


# Extreme scenes -----------------------------------------------------------------------------------


def test_the_extremes_are_those_of_every_effect():
    """Both ends of each range, as far as they allow to follow the discs."""
    scenes = stability.EXTREMES.values()
    for name in ("mass_ratio", "radius_ratio", "moment_of_inertia"):
        values = {getattr(scene, name) for scene in scenes}
        assert {td.EFFECTS[name].low, td.EFFECTS[name].high} <= values
    assert {name for scene in scenes for name in scene.effects} == td.EFFECTS.keys()
    assert {scene.discs for scene in scenes} == {2, 3, 16}
    for case, scene in stability.EXTREMES.items():
        if "hardly" in case:
            with pytest.raises(td.InputError, match="does not fit"):
                scene.with_radius(scene.radius * 1.03)


def test_rows_of_extremes_are_their_mean_times(monkeypatch):
    """A plain box of 1e6 × 1e-6, where most events are never seen, and an ordinary one."""
    scenes = {"long": stability.EXTREMES["1e6 by 1e-6"], "ordinary": PAPER}
    rows = list(stability.extreme_rows(1, scenes))
    assert failed(rows) == []
    own = {(row["case"], row["quantity"]): row for row in rows}
    for case, scene in scenes.items():
        for event, time in exact.mean_times(scene).items():
            assert own[case, f"{event}_time"]["exact"] == time
    assert own["long", "disc_collision_time"]["z"] is own["long", "virial"]["z"] is None
    assert own["long", "disc_collision_time"]["passed"] is None
    assert own["long", "virial"]["distance"] == pytest.approx(0.4 - 1)  # up to half the height
    assert own["long", "top_wall_time"]["passed"] is True
    virial = own["ordinary", "virial"]
    assert abs(virial["value"] - 1) < 5 * virial["stderr"] < 0.05
    # Wrong times do not pass.
    times = exact.mean_times
    wrong = {"mean_times": lambda scene: {e: 1.05 * t for e, t in times(scene).items()}}
    monkeypatch.setattr(exact, *wrong.popitem())
    found = failed(stability.extreme_rows(1, {"ordinary": PAPER}))
    assert {row["quantity"] for row in found} >= {"any_wall_time", "disc_collision_time"}


def test_a_bound_that_says_something_is_judged(monkeypatch):
    """Two counts have no normal law: one is too improbable, the other may be anything."""
    cells = {"exact": 1.0, "estimate": None, "stderr": None, "status": "none-seen"}
    cells |= {"comparison": "mean_time", "method": "dynamics", "test": "cluster-bound"}
    found = [cells | {"quantity": "a_time", "z": 6.0}, cells | {"quantity": "b_time", "z": 0.0}]
    found.append(cells | {"quantity": "c_time", "z": 0.0, "test": "certain"})
    monkeypatch.setattr(stability, "comparisons", lambda *_: found)
    rows = stability.extreme_rows(1, {"ordinary": PAPER})
    judged = [(row["quantity"], row["z"], row["passed"]) for row in rows]
    assert judged == [("a_time", 6.0, False), ("b_time", None, None)]


# Long runs and paths back ------------------------------------------------------------------------


@pytest.mark.parametrize("box", [*BOXES, td.Box(1e40, 1.5e40), *map(slow, OTHERS)], ids=str)
def test_everything_is_conserved_at_every_hard_radius(box):
    rows = compared(box, stability.dynamics_rows(box, 5, ordinary=4_000_000, hard=2_000_000))
    assert len(rows) == 4 * len(stability.hard_radii(box))
    assert all(row["passed"] is True and row["count"] >= 2_000_000 for row in rows)


def test_the_errors_of_a_run_are_those_of_its_worst_lane(monkeypatch):
    nearest = (PAPER.contact_distance * np.array([1.5, 1.25])) ** 2
    far_x, far_y = PAPER.range_x / 2 + np.array([-1, 0.75]), PAPER.range_y / 2 + np.array([0.5, 0])
    found = nearest, np.array([2e-15, 6e-15]), far_x, far_y, np.ones(2)
    monkeypatch.setattr(stability, "audit", lambda *_: found)
    row = stability.run(PAPER, 1000, 1)
    assert (row["energy_error"], row["lanes_lost"]) == (3e-15, 2)
    unit_x, unit_y = stability.box_units(PAPER)
    assert row["excess"] == pytest.approx(max(0.75 / unit_x, 0.5 / unit_y))
    assert row["smallest_gap"] == pytest.approx(PAPER.contact_distance / 4 / max(unit_x, unit_y))


def test_energy_error_grows_like_a_random_walk():
    """A drift would grow in proportion to the events, a walk like their square root.

    The exponent of a walk fluctuates; the largest of 64 lanes over a factor of 64 in the number of
    events grows by 8, and by 64 for a drift. Halfway, on a logarithmic scale, is 23.
    """
    short, long = (stability.run(PAPER, n, 2)["energy_error"] for n in (10**6, 64 * 10**6))
    assert long / short < 23


def audited(starts, shortest=0.0):
    columns = np.array(starts, float).T.copy()
    return stability.audit(columns, 1, 50, two_disc_law(PAPER), shortest)


GOOD = (-0.4, 0.1, 0.4, -0.1, 0.6, 0.48, -0.64, 0.0)


def test_the_audit_sees_what_is_wrong():
    """Too much energy, discs that overlap and part, one beyond its range, no number, and rest."""
    fast = (*GOOD[:4], 0.6, 0.48, -0.64, 0.1)
    overlapping = (-0.1, 0.0, 0.1, 0.0, -0.001, 0.0, 0.001, math.sqrt(1 - 2e-6))
    outside = (0.551, 0.1, -0.4, -0.1, 0.0, 0.8, 0.0, 0.6)
    broken, at_rest = (math.nan, *GOOD[1:]), (*GOOD[:4], 0.0, 0.0, 0.0, 0.0)
    nearest, energy, far_x, _, lost = audited([GOOD, fast, overlapping, outside, broken, at_rest])
    assert energy[0] <= 1e-15
    assert energy[1] == pytest.approx(0.01, rel=1e-9)
    assert nearest[0] >= 0.16 * (1 - 1e-15)
    assert nearest[2] < 0.15
    assert (far_x[0], far_x[3]) == (0.55, 0.551)
    assert lost.tolist() == [False] * 4 + [True] * 2
    # Both a sixth of a second for fifty events, which is not much to ask, and far too much.
    assert not audited([GOOD], shortest=1 / 6)[4][0]
    assert audited([GOOD], shortest=1000.0)[4][0]


def test_distances_have_units_of_the_sides_and_a_window_its_least_time(monkeypatch):
    """Gaps and excesses along the side 3 have the unit 2, the power of two below it.

    A window of ten events must last a hundredth of the mean time of ten events.
    """
    scene, given = td.Scene(3.0, 1.0, 0.2), []
    seen = np.array([[0.401**2], [0.0], [1.33], [0.31], [0.0]])
    monkeypatch.setattr(stability, "audit", lambda *these: given.append(these) or seen)
    found = stability.run(scene, 10 * stability.STATE_LANES, 1)
    assert (found["smallest_gap"], found["excess"]) == pytest.approx((0.001 / 2, 0.03 / 2))
    ((*_, least),) = given
    assert least == pytest.approx(0.01 * 10 / exact.event_rate(scene))


def test_events_retraced_are_those_the_exponent_allows(monkeypatch):
    """z within 5 for the exponents; the number within five binary digits of roundings."""
    monkeypatch.setattr(stability, "REVERSED_PATHS", 1000)
    box = td.Box(1e-3, 1.3e-3)
    rows = list(stability.reversal_rows(box, seed=3))
    judged = [row for row in rows if row["passed"] is not None]
    assert len(judged) == 2 * len(stability.ordinary_radii(box))
    assert all(row["passed"] for row in judged)
    assert all(row["value"] > 0 for row in rows)
    # Logarithms of errors scatter by less than ten, and there are 1000 of them.
    assert all(row["stderr"] < 0.3 * row["value"] for row in of(rows, quantity="return_error"))
    for row in of(rows, quantity="events_retraced"):
        (grown, _) = of(rows, quantity="exponent", radius=row["radius"])
        lengths = np.array([row[name] for name in ("exact", "low", "high")]) * grown["value"]
        due = np.array([1.0, 1.0 / 1.3 / 32, 32.0]) * stability.RETURN_ERROR * 2**53
        np.testing.assert_allclose(np.exp(lengths), due, rtol=1e-9)
    # In a box of 1e6 × 1e-6 the discs do not meet for millions of events.
    for row in stability.reversal_rows(td.Box(1e6, 1e-6), seed=3):
        assert (row["status"], row["value"], row["passed"]) == ("long", None, None)


def test_growth_is_that_of_the_tangent_space_and_ends_where_the_events_differ():
    """It is the same for separations of 1e-7, 1e-8 and 1e-9."""
    starts, law = states(PAPER, 50, 1), two_disc_law(PAPER)
    logs = [np.log(stability.growth(starts, 5, 20, size, law)) for size in (1e-7, 1e-8, 1e-9)]
    assert np.median(logs[1]) > 3
    for other in (logs[0], logs[2]):
        assert np.median(np.abs(other - logs[1])) < 1e-3
    # Discs hit opposite walls simultaneously: for the neighbour the other one comes first.
    state = np.array([[-0.4], [0.0], [0.4], [0.0], [-0.5], [0.0], [0.5], [0.0]])
    assert math.isnan(stability.growth(state, 0, 10, 1e-9, Law(0.55, 0.3, 0.4))[0])


# Calibration --------------------------------------------------------------------------------------


def test_scores_of_values_with_errors_that_are_right_and_wrong():
    """Normal values: mean squares of 1, of 4 with half of the error, and about their own mean."""
    values = np.random.default_rng(1).standard_normal(4000) + 3
    five = 5 * math.sqrt(2 / 4000)
    for error, known, due in ((1.0, 3.0, 1.0), (0.5, 3.0, 4.0), (1.0, None, 1.0)):
        z, withheld = calibration.scored([(v, error, known) for v in values])
        assert abs(np.mean(z * z) / due - 1) < five
        assert withheld == 0
    z, withheld = calibration.scored([(4.0, 1.0, 3.0), (4.0, None, 3.0), (None, None, 3.0)])
    assert (z.tolist(), withheld) == ([1.0], 2)
    # About their mean two values are certain to be nearer by √(1/2).
    z, _ = calibration.scored([(1.0, 1.0, None), (3.0, 1.0, None)])
    assert z.tolist() == pytest.approx([-math.sqrt(2), math.sqrt(2)])
    kept = calibration.score_cells(np.array([1.0, -2.0, 3.5]), 0)
    assert (kept["mean_square"], kept["beyond_three"]) == (5.75, 1)
    assert kept["stderr"] == pytest.approx(np.std([1, 4, 12.25], ddof=1) / math.sqrt(3))


def test_a_row_of_calibration_counts_what_the_face_prints(monkeypatch):
    """One seed of few bodies: scores of simulate are the deviations over the printed errors."""
    monkeypatch.setitem(calibration.CALL_SIZES, "simulate", {"least": {"budget": 1}})
    rows, z = [*calibration.rows(2, 5, ("r = 0.2",), ("simulate",))], []
    for seed in (5, 6):
        one = td.simulate(PAPER, budget=1, seed=seed)["disc_collision_time"]
        z.append((one.value - one.exact) / one.stderr)
    kept = of(CalibrationTable.read(KEPT / "calibration.csv"), case="r = 0.2", size="least")
    assert cells(rows, "quantity") == cells(of(kept, call="simulate"), "quantity")
    (row,) = of(rows, quantity="disc_collision_time")
    assert (row["scores"], row["withheld"]) == (2, 0)
    assert row["mean"] == pytest.approx(np.mean(z))
    assert row["mean_square"] == pytest.approx(np.mean(np.square(z)))


#: Studies of plain discs whose rows of one seed take more than two seconds.
LONG = {"brownian", "stability"}
ONCE = [("r = 0.2", call) for call in calibration.STAGE_CALLS if call != "diffusion"]
ONCE += [("periodic x", call) for call in calibration.STAGE_CALLS]
ONCE += [
    (case, study) if case == "plain discs" and study not in LONG else slow(case, study)
    for study, case in calibration.STUDY_CASES
]


@pytest.mark.parametrize(("case", "call"), ONCE)
def test_one_seed_has_the_quantities_of_the_long_run(case, call, monkeypatch):
    """Calls have their least size. Scores of exact values are within five sigma."""
    least = {name: {"least": sizes["least"]} for name, sizes in calibration.CALL_SIZES.items()}
    monkeypatch.setattr(calibration, "CALL_SIZES", least)
    rows = [*calibration.rows(1, 990_000, (case,), (call,))]
    kept = of(CalibrationTable.read(KEPT / "calibration.csv"), case=case, call=call)
    kept = {row["quantity"] for row in kept if row["size"] in ("least", "study")}
    found = {row["quantity"] for row in rows}
    assert set() < found <= kept
    assert len(found) >= 0.9 * len(kept)
    assert all(abs(row["mean"] or 0.0) < 5 for row in rows)


#: Strata and clusters, a field, hits in corners, a ring, kicks, and more discs.
SOME = (
    "r = 0.2", "r = 0.38", "r = 0.2499", "field 0.8", "moment_of_inertia 0.5", "periodic x",
    "friction 10.0", "three discs", "100 × 1",
)  # fmt: skip
COUNTED = [("simulate", ("r = 0.2499",)), ("cost", ("r = 0.2",))]
COUNTED += [slow(call, SOME) for call in calibration.STAGE_CALLS]
COUNTED += [slow(study, (kind,)) for study, kind in calibration.STUDY_CASES]


@pytest.mark.parametrize(("call", "cases"), COUNTED)
def test_errors_are_what_they_say(call, cases):
    """16 fresh seeds: no mean square is beyond five sigma of chance, at Bonferroni's bound."""
    rows = calibration.rows(16, 990_000, cases, (call,))
    check_mean_squares([row for row in rows if row["scores"] >= 8])


def few_intervals(seed):
    """Return rows of distributions.csv from few intervals."""
    return distributions.measured({}, BOX.scene(0.1), "vertical_hop", seed, 2**17)


def few_passages(seed):
    """Return rows of passages.csv by ``NearThreshold`` from few hops, at two distances."""
    rows = [*near_threshold.one_hop("", BOX, "horizontal_hop", (6, 7), None, 2**12, seed)]
    return [*rows, *powers.fits([dict.fromkeys(powers.HOP_COLUMNS) | row for row in rows])]


@pytest.mark.parametrize("make", [few_intervals, few_passages])
def test_errors_of_few_are_what_they_say(make, monkeypatch):
    """64 fresh seeds tell mean squares of 4 and of 1/4 from 1, for seven quantities of a study."""
    monkeypatch.setattr(near, "MOST_HOPS", 2**11)
    monkeypatch.setattr(near_threshold, "MOST_HOPS", 2**11)
    monkeypatch.setattr(distributions, "FEWEST_ENDED", 100)
    monkeypatch.setattr(distributions, "FEWEST_IN_BIN", 30)
    monkeypatch.setattr(calibration, "STUDY_CASES", {("few", ""): make})
    rows = [row for row in calibration.rows(64, 990_000, calls=("few",)) if row["scores"] >= 32]
    assert len({row["quantity"].split()[0] for row in rows}) == 7
    check_mean_squares(rows)


def check_mean_squares(rows):
    """Values of one seed are correlated: there are no more scores than seeds."""
    alarm = norm.sf(5) / len(rows)
    for row in rows:
        n = min(row["scores"], row["seeds"])
        assert alarm < chi2.sf(row["mean_square"] * n, n) < 1 - alarm, row


def test_the_kept_errors_are_what_they_say():
    """Each scene, call and study has errors, as the configuration of the long run says."""
    rows = [row for row in CalibrationTable.read(KEPT / "calibration.csv") if row["scores"] > 1]
    check_mean_squares(rows)
    assert all(row["kind"] == calibration.kind(row["case"]) for row in rows)
    seeds = yaml.safe_load((KEPT / "config.yaml").read_text(encoding="utf-8"))["seeds"]
    made = {(case, call, size): number for case, call, size, number, _ in calibration.runs(seeds)}
    found = {(row["case"], row["call"], row["size"]): row["seeds"] for row in rows}
    assert found.items() <= made.items()
    assert {name for key in made for name in key} == {name for key in found for name in key}


# The jobs and the figure --------------------------------------------------------------------------


def test_table_and_figure_of_any_box(tmp_path, monkeypatch):
    """Everything is small, for the form of the table only."""
    for name in ("SHARE_PROPOSALS", "ESTIMATE_PROPOSALS"):
        monkeypatch.setattr(stability, name, montecarlo.PROPOSALS_PER_BLOCK)
    monkeypatch.setattr(stability, "REVERSED_PATHS", 200)
    monkeypatch.setattr(stability, "WINDOW_EVENTS", 64)
    one = partial(stability.extreme_rows, scenes={"ordinary": PAPER})
    monkeypatch.setattr(stability, "extreme_rows", one)
    box = td.Box(1e-6, 1e6)
    rows = written(tmp_path, StabilityTable, box=box, seed=1, ordinary=2000, hard=1000)
    parts = {"theory", "sampling", "estimates", "times", "dynamics", "extremes", "reversal"}
    assert {row["part"] for row in rows} == parts
    followed = of(rows, part="dynamics")
    assert all((row["count"] >= 2000) == (row["case"] == "ordinary") for row in followed)
    with style.context():
        for module in (figure, figure_runs):
            for some in (rows, []):
                assert module.draw(box, {"stability": some})
