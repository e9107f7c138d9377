"""The study of what accuracy costs.

Without these tests an estimator, an engine or c of what accuracy costs could be wrong.

Comparisons are held to five standard errors: a false alarm in 6e-7 of all seeds each.
"""

import math
from itertools import count, pairwise, product
from types import SimpleNamespace

import numpy as np
import pytest
from effect_scenes import PAPER
from factory import LONG_RUNS, empty, of
from figure_cases import points, unclear

from twodiscs.dynamics.engine import find_engine
from twodiscs.figures import style
from twodiscs.model.events import EVENTS
from twodiscs.sampling.conditioned import conditioned_sampler
from twodiscs_paper import benchmark
from twodiscs_paper.studies.accuracy_cost import figure, figure_by_radius, scalar, timestepping
from twodiscs_paper.studies.accuracy_cost import measure as costs
from twodiscs_paper.studies.accuracy_cost.study import AccuracyCostTable

# Methods ------------------------------------------------------------------------------------------


def named(method):
    return f"{method.name}-{method.quantity}-{method.scene.radius:g}-{method.setting}"


@pytest.mark.parametrize("method", costs.methods(3), ids=named)
def test_a_method_estimates_its_quantity_with_its_bias(method):
    """An event, a volume or a normal taken for another one is far off."""
    sums, times = costs.measured(method, math.inf, 48)
    errors = dict(costs.doublings(method, sums))[1]
    assert len(times) == len(errors) == 48
    assert times.min() > 0
    mean, error = errors.mean(), errors.std(ddof=1) / math.sqrt(errors.size)
    if method.bias is None:
        # Events come late by Δt/2 and grazing collisions are missed: an error ∝ Δt.
        assert 0.5 * method.setting < mean < 8 * method.setting
    elif error == 0:  # 192 blocks near h/4 without a hop
        assert method.scene == costs.HARD_SCENE
        assert (mean, method.name) == (-1, "lockstep")
    else:
        assert abs(mean - method.bias) < 5 * error


def test_blocks_have_their_own_random_numbers_and_those_of_their_seed():
    for make in (costs.scalar_method, costs.surface_method, costs.strip_method):
        scene = costs.HARD_SCENE if make is costs.strip_method else PAPER
        blocks = [make(scene, seed).block(n) for seed, n in ((1, 2), (1, 3), (2, 2), (1, 2))]
        assert np.array_equal(blocks[0], blocks[3])
        assert not any(np.array_equal(a, b) for a, b in pairwise(blocks))


@pytest.mark.parametrize("quantity", ["volume", costs.AREA])
@pytest.mark.parametrize("radius", [0.1, 0.2, 0.3])
def test_quadrature_falls_off_a_cliff(radius, quantity):
    """Gauss's rule gains at least a digit and a half a node until nothing but rounding is left."""
    scene = PAPER.with_radius(radius)
    true = costs.reference(scene)[quantity]
    values = [costs.quadrature(scene, nodes)[quantity] for nodes in (3, 6, 12)]
    few, more, most = (abs(float(value / true - 1)) for value in values)
    assert more < 1e-4 * few
    assert most < 1e-14


# Other programs -----------------------------------------------------------------------------------


@pytest.mark.parametrize("radius", [0.2, 0.24, 0.3])
def test_short_steps_count_what_the_scalar_engine_counts(radius):
    """From the same starts, up to the events of the last step and of grazing discs."""
    scene, step, steps = PAPER.with_radius(radius), 2.0**-14, 2**15
    shared = scene.contact_distance, conditioned_sampler(scene)
    sums = timestepping.step_blocks(np.uint64(4), 0, 1, 256, 8, steps, step, *shared)
    due, _ = scalar.count_blocks(np.uint64(4), 0, 1, 256, steps * step, *shared)
    assert sum(due) > 3000
    assert np.abs(sums - due).max() <= 5


@pytest.mark.parametrize("radius", [0.05, 0.2, 0.24, 0.3, 0.38])
def test_the_scalar_engine_counts_the_same(radius):
    """Written with branches and divisions, the same law has the same counts, replica for replica.

    Chaos would turn a difference in the last bit into other counts after some tens of events.
    """
    scene = PAPER.with_radius(radius)
    duration = find_engine(scene).rates.replica_duration(scene)
    arguments = duration, scene.contact_distance, conditioned_sampler(scene)
    usual = scalar.count_blocks(np.uint64(3), 0, 1, 1024, *arguments)
    sums, products = find_engine(scene).counts.run_blocks(scene, EVENTS, 3, 0, 1, duration)[:2]
    at = [EVENTS.index(event) for event in scalar.COUNTED]
    np.testing.assert_array_equal(usual[0], sums[at])
    np.testing.assert_array_equal(usual[1], products[np.ix_(at, at)])


def test_the_benchmark_gives_both_engines_the_same_work():
    assert benchmark.scalar_engine(1)[0] == benchmark.lockstep(1)[0] > 2e5


# Errors over time ---------------------------------------------------------------------------------


def made(values):
    """Return a ``Method`` whose blocks have these errors."""
    return costs.Method(
        "made", "volume", PAPER, lambda i: np.array(values[i % len(values)]),
        lambda sums, blocks: 1 + float(sums) / blocks,
    )  # fmt: skip


def test_runs_of_two_four_and_more_blocks_are_means_of_their_own_blocks():
    found = costs.doublings(made([0.0]), np.array([1.0, 3.0, 5.0, 7.0, 9.0]))
    due = [(1, [1, 3, 5, 7, 9]), (2, [2, 6]), (4, [4])]
    assert [(blocks, [*errors]) for blocks, errors in found] == due


def fitted(errors, floor=0.0):
    """Return the power and its error of blocks with a tenth of these ``errors``."""
    return costs.power(dict(costs.doublings(made([0.0]), np.asarray(errors) / 10)), floor / 10)


def test_the_power_of_independent_blocks_has_the_error_that_it_says():
    """Over 600 runs the scatter is as stated, to 15 %."""
    generator = np.random.default_rng(5)
    runs = np.array([fitted(generator.normal(size=1024)) for _ in range(600)])
    deviations = (runs[:, 0] + 0.5) / runs[:, 1]
    assert deviations.std() == pytest.approx(1, rel=5 / math.sqrt(1200))
    # Eight runs of two blocks are too few, and of rare counts most blocks have none.
    assert fitted(generator.normal(size=16)) == (None, None)
    assert fitted(10 * (generator.poisson(0.01, 256) / 0.01 - 1)) == (None, None)


def test_errors_that_stay_have_no_power_and_correlated_ones_another():
    generator = np.random.default_rng(6)
    assert fitted(np.full(64, 0.1)) == (pytest.approx(0), pytest.approx(1, abs=1))
    # Blocks in pairs that are the same: the first doubling gains nothing.
    value, _ = fitted(np.repeat(generator.normal(size=512), 2))
    assert value > -0.4
    # Near the floor errors have no say.
    biased = 0.2 + generator.normal(size=4096)
    free, with_floor = fitted(biased), fitted(biased, 0.2)
    assert free[0] > with_floor[0] + 0.02
    assert abs(with_floor[0] + 0.5) < 0.03
    assert fitted(biased, 1.0) == (None, None)


def test_rows_of_a_method(monkeypatch):
    """Blocks with errors of ±0.1 around 0.02 that take 2 s each: c = 2 × 0.01, and no power."""
    values = [0.12, -0.08] * 8
    monkeypatch.setattr(costs, "measured", lambda *_: (np.array(values), np.full(len(values), 2.0)))
    rows = [*costs.error_rows(made(values)._replace(bias=0.02, setting=0.5), 1.0, 16)]
    assert [row["seconds"] for row in rows] == [2, 4, 8, 16, 32]
    assert [row["repetitions"] for row in rows] == [16, 8, 4, 2, 1]
    assert rows[0]["error"] == pytest.approx(math.hypot(0.1, 0.02))
    assert [row["error"] for row in rows[1:]] == pytest.approx([0.02] * 4)
    for row in rows:
        assert row["c"] == pytest.approx(2 * np.var(values, ddof=1))
        assert (row["floor"], row["setting"]) == (0.02, 0.5)
    # A bias that is not known is the mean, if that is clear: 0.02 ± 0.026 is not.
    (row, *_) = costs.error_rows(made(values)._replace(bias=None), 1.0, 16)
    assert row["floor"] == 0.0
    values[:] = [0.22, 0.18] * 8
    (row, *_) = costs.error_rows(made(values)._replace(bias=None), 1.0, 16)
    assert row["floor"] == pytest.approx(0.2)
    values[:] = [2.0, -2.0] * 8  # errors of more than a half are left out
    assert [row["seconds"] for row in costs.error_rows(made(values), 1.0, 16)] == [4, 8, 16, 32]


def test_a_measurement_ends_after_its_time_or_its_blocks(monkeypatch):
    monkeypatch.setattr(costs.time, "process_time", count(0.0).__next__)
    sums, times = costs.measured(made([0.5]), 9.0, 100)
    assert len(sums) == 4
    assert [*times] == [1.0] * 4
    assert len(costs.measured(made([0.5]), math.inf, 7)[0]) == 7
    assert len(costs.measured(made([0.5]), 0.0, 7)[0]) == 2
    assert {row["seconds"] for row in costs.exact_rows()} == {1 / costs.CALLS}


def test_rows_are_those_of_all_methods_and_of_all_distances(monkeypatch):
    """A build shares its seconds among the methods; a long run has blocks. None is run here."""
    given = []

    def error_rows(method, seconds, most):
        given.append((seconds, most))
        yield costs.cost_row(method.scene, "error", method.quantity, method.name)

    monkeypatch.setattr(costs, "error_rows", error_rows)
    price = SimpleNamespace(quantity="volume", method="rejection", c=2.0, floor=0.5)
    free = SimpleNamespace(quantity="all", method="exact", c=0.0, floor=0.0)
    cost = SimpleNamespace(prices=[price, free])
    monkeypatch.setattr(costs.twodiscs, "cost", lambda scene: cost, raising=False)
    rows = [empty(AccuracyCostTable, **row) for row in AccuracyCostTable.rows(seconds=7.0, seed=1)]
    assert len(of(rows, part="error")) == len(costs.methods(1))
    assert sum(seconds for seconds, _ in given) == pytest.approx(7)
    by_radius = of(rows, part="radius")
    assert [row["distance"] for row in by_radius] == [*costs.HARD_DISTANCES]
    for row in by_radius:
        assert (row["c"], row["floor"], row["method"]) == (2.0, 0.5, "rejection")
        assert row["radius"] == pytest.approx(0.25 * (1 - row["distance"]))
    long = len([*AccuracyCostTable.part(seed=1, blocks=8)])
    assert given[-long:] == [(math.inf, 8)] * len(costs.methods(1))


# The figures --------------------------------------------------------------------------------------


LONG = AccuracyCostTable.read(LONG_RUNS / "accuracy_cost" / "accuracy_cost.csv")


@pytest.fixture(scope="module")
def rows():
    """The errors of the long run at twice the times, exact values and c by distance."""
    build = [row | {"seconds": 2 * row["seconds"]} for row in LONG]
    generator = np.random.default_rng(1)
    prices = [
        ("dynamics", "vertical_hop_time"), ("dynamics", "any_wall_time"),
        ("strips", "horizontal_hop_time"), ("rejection", "volume"),
        ("shells, rejection", "top_wall_area"), ("conditioned", "volume"),
        ("shells, conditioned", "disc_collision_area"),
    ]  # fmt: skip
    made = [*costs.exact_rows()]
    for (method, quantity), distance in product(prices, costs.HARD_DISTANCES):
        cells = {"distance": distance, "c": float(10 ** generator.uniform(-9, 3))}
        made.append(costs.cost_row(costs.EASY_SCENE, "radius", quantity, method, **cells))
    return build + [empty(AccuracyCostTable, **row) for row in made]


@pytest.fixture(scope="module")
def panels(rows):
    tables = {"accuracy_cost": rows, "kept": LONG}
    with style.context():
        both = [*figure.draw(None, tables).axes, *figure_by_radius.draw(None, tables).axes]
    return {axes.get_label(): axes for axes in both}


RADII = [costs.EASY_SCENE.radius, costs.HARD_SCENE.radius]
ALL = [("a", one) for one in figure.TIME_CURVES] + [("b", one) for one in figure.SAMPLE_CURVES]


@pytest.mark.parametrize(("panel", "one"), ALL, ids=lambda value: getattr(value, "name", value))
def test_symbols_are_errors_and_times_and_lines_are_c_over_the_square(rows, panels, panel, one):
    """Full ones of the long run, open ones of the build; the longest run is always there."""
    mine = [line for line in panels[panel].lines if line.get_color() == one.colour]
    for table, full in ((LONG, one.colour), (rows, "white")):
        look = one.marker, full
        own = [line for line in mine if (line.get_marker(), line.get_markerfacecolor()) == look]
        shown = {point for line in own for point in zip(*line.get_data(), strict=True)}
        for some in figure.by_setting(table, one, RADII).values():
            thinned = [*some[::-1][:: figure.SYMBOL_DOUBLINGS], some[-1]]
            assert {(row["error"], row["seconds"]) for row in thinned} <= shown
    curves = [line.get_xydata() for line in mine if len(line.get_xdata()) > 100]
    for first, *_ in figure.by_setting(LONG, one, RADII).values():
        c, floor = first["c"], first["floor"]
        far = [xy[(xy[:, 0] > 2 * floor) & (xy[:, 0] < 0.5)].T for xy in curves]
        assert any(np.allclose(c / y, x**2 - floor**2, rtol=1e-9) for x, y in far)


def test_errors_times_and_distances_are_logarithmic(panels):
    scales = {(axes.get_xscale(), axes.get_yscale()) for axes in panels.values()}
    assert scales == {("log", "log")}


def test_texts_stand_clear_and_symbols_are_named(panels):
    assert [unclear(figure) for figure in {axes.figure for axes in panels.values()}] == [[], []]


def test_exact_values_are_at_the_bottom(rows, panels):
    for panel, quantity in (("a", "volume"), ("b", costs.AREA)):
        own = of(rows, part="exact", radius=costs.EASY_SCENE.radius, quantity=quantity)
        (row,) = of(own, method="exact")
        heights = [line.get_ydata()[0] for line in panels[panel].lines if line.get_lw() == 1.0]
        assert heights == [row["seconds"]]
    nodes = {row["error"] for row in of(own, method="quadrature") if row["error"] > 1e-6}
    assert {x for x, _ in points(panels["b"], style.BLACK, "P")} == nodes != set()


def test_the_bar_of_a_root_mean_square_is_that_of_normal_errors():
    """A square has the variance 2s⁴ + 4b²s², for errors with the bias b and the variance s²."""
    bias, variance, number = 0.75, 0.25, 16
    rms = math.hypot(bias, math.sqrt(variance))
    row = {"c": 8 * variance, "seconds": 8.0, "floor": bias, "repetitions": number, "error": rms}
    due = math.sqrt((2 * variance**2 + 4 * bias**2 * variance) / number) / (2 * rms)
    assert figure._spread(row) == pytest.approx(due)


@pytest.mark.parametrize("floor", [0.0, 1e-4])
def test_the_curve_of_a_method_goes_to_its_floor(floor):
    errors, seconds = figure._law(2.0, floor)
    low, high = sorted(figure.ERROR_RANGE)
    assert errors.max() == pytest.approx(high)
    assert errors.min() == pytest.approx(floor or low, rel=1e-13)
    np.testing.assert_allclose(seconds * (errors**2 - floor**2), 2.0)


def test_c_by_distance_is_drawn_for_each_method_and_quantity(rows, panels):
    looks = figure_by_radius.looks()
    for panel in ("dynamics", "strips", "rejection", "conditioned"):
        own = [row for row in of(rows, part="radius") if row["method"].endswith(panel)]
        assert own
        assert panels[panel].get_title("left").endswith(f")  {panel}")
        for quantity in {row["quantity"] for row in own}:
            due = {(row["distance"], row["c"]) for row in of(own, quantity=quantity)}
            assert points(panels[panel], *looks[quantity]) == due
    assert looks["top_wall_area"] == looks["top_wall_time"] == style.EVENT_LOOKS["top_wall"]
    left = {name for name, axes in panels.items() if axes.get_ylabel().startswith("time $")}
    assert {"dynamics", "rejection"} <= left
