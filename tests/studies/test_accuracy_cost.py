"""The cost of accuracy: the estimators are right, and the numbers in the figures, too."""

import math

import numpy as np
import pytest
from figure_cases import bars, points

from twodiscs.figures import style
from twodiscs.figures.style import LOOKS
from twodiscs.model.box import Box
from twodiscs.model.events import EVENTS, HOPS
from twodiscs.model.scene import Scene
from twodiscs.sampling import montecarlo
from twodiscs.theory import exact
from twodiscs_paper.studies.accuracy_cost import figure, figure_by_radius, scalar
from twodiscs_paper.studies.accuracy_cost import measure as accuracy_cost
from twodiscs_paper.studies.accuracy_cost.study import AccuracyCost

PAPER = Scene(1.5, 1.0, 0.2)
AREA = accuracy_cost.AREA

#: One radius in each regime.
SCENES = [PAPER.with_radius(radius) for radius in (0.1, 0.2, 0.3, 0.38)]


@pytest.mark.parametrize("scene", SCENES[:3])
@pytest.mark.parametrize("quantity", ["volume", AREA])
def test_quadrature_falls_off_a_cliff(scene, quantity):
    """Gauss's rule gains at least a digit and a half a node until nothing but rounding is left."""
    true = accuracy_cost.reference(scene)[quantity]
    errors = [
        abs(float(accuracy_cost.quadrature(quantity, scene, nodes, 0)[0][quantity] / true - 1))
        for nodes in (3, 6, 12)
    ]
    assert errors[1] < 1e-4 * errors[0]
    assert errors[2] < 1e-14


def hits(samples, share):
    """Return the standard error of the relative error of ``samples`` with this share of hits."""
    return math.sqrt((1 - share) / (share * samples))


@pytest.mark.parametrize("scene", SCENES)
def test_samples_on_the_surface_are_unbiased(scene):
    """Five sigma: a false alarm in 6e-7 of all seeds."""
    true, samples = exact.areas(scene)["disc_collision"], 200_000
    found = accuracy_cost.on_surface(scene, samples, 3)[0][AREA]
    share = true / accuracy_cost.surface_measure(scene)
    assert abs(found / true - 1) < 5 * hits(samples, share)


@pytest.mark.parametrize("quantity", ["volume", AREA])
def test_sobol_points_are_unbiased_and_better(quantity):
    """The mean of 32 scramblings within five of its standard errors; random points do worse."""
    true, points = float(accuracy_cost.reference(PAPER)[quantity]), 1 << 12
    runs = [accuracy_cost.scrambled_sobol(quantity, PAPER, points, s)[0] for s in range(32)]
    errors = np.array([run[quantity] for run in runs]) / true - 1
    assert abs(errors.mean()) < 5 * errors.std(ddof=1) / math.sqrt(errors.size)
    measure = (PAPER.range_x * PAPER.range_y) ** 2
    if quantity == AREA:
        measure = accuracy_cost.surface_measure(PAPER)
    assert errors.std() < hits(points, true / measure) / 2


def test_the_best_shell_balances_bias_and_variance():
    """The bias is ∝ ε and the variance ∝ 1/ε: at the best ε, variance = 2 bias²."""
    samples = 1 << 20
    fraction = accuracy_cost.balanced_fraction(PAPER, samples)
    epsilon = montecarlo.shell_thickness(PAPER, "disc_collision", fraction)
    expected = exact.shell_expectation(PAPER, "disc_collision", epsilon)
    bias = expected - exact.areas(PAPER)["disc_collision"]
    prism = (PAPER.range_x * PAPER.range_y) ** 2
    variance = expected * (prism / epsilon - expected) / samples
    # The grid of ε is 6 % wide, and the bias not quite linear.
    assert math.isclose(variance, 2 * bias**2, rel_tol=0.3)
    assert accuracy_cost.balanced_fraction(PAPER, 64 * samples) < fraction / 3


def test_fitted_slope():
    x = [0.0, 1.0, 2.0, 3.0]
    assert accuracy_cost.fitted(x, [1 - 0.5 * t for t in x], 0.1) == (
        pytest.approx(-0.5),
        pytest.approx(0.1 / math.sqrt(5)),
    )
    assert accuracy_cost.fitted([1.0], [1.0]) == (None, None)
    assert accuracy_cost.fitted([1.0, 2.0], [1.0, 3.0]) == (pytest.approx(2.0), None)


def test_a_floor_has_no_say_in_the_slope():
    rows = [
        accuracy_cost.cost_row(
            "time", "q", 0.2, "m", work=n, error=math.hypot(1 / math.sqrt(n), floor),
            floor=floor, repetitions=8, seconds=1.0,
        )
        for floor in (1e-4,) for n in (10, 100, 10**4, 10**8, 10**9)
    ]  # fmt: skip
    found = accuracy_cost.with_slope(rows)[0]
    assert found["slope"] == pytest.approx(-0.5, abs=1e-3)


def test_the_price_of_a_poisson_process():
    rate, time = exact.event_rate(PAPER), exact.mean_times(PAPER)["vertical_hop"]
    expected = pytest.approx(1e4 * time * rate)
    assert accuracy_cost.predicted_events(PAPER, "vertical_hop", 1e-2) == expected


@pytest.mark.parametrize("method", ["by_lockstep", "by_scalar", "by_steps"])
def test_engines_name_what_they_count(method):
    """Each mean time within a tenth of the exact one: an event taken for another one is far off."""
    run = getattr(accuracy_cost, method)
    amount = (2.0**-6, PAPER, 1, 3) if method == "by_steps" else (PAPER, 1, 3)
    if method == "by_scalar":
        amount = PAPER, 1024, 3
    found, work, calls = run(*amount)
    times, counted = exact.mean_times(PAPER), scalar.COUNTED
    if method == "by_lockstep":
        counted = EVENTS
    assert tuple(found) == tuple(f"{event}_time" for event in counted)
    for event in counted:
        assert found[f"{event}_time"] == pytest.approx(times[event], rel=0.1), event
    assert work > 10_000
    assert calls == 1


# A whole run, as small as can be ----------------------------------------------------------------


@pytest.fixture(scope="module")
def rows(tmp_path_factory):
    path = tmp_path_factory.mktemp("cost") / "accuracy_cost.csv"
    AccuracyCost.write(path, accuracy_cost.rows(1.0, repetitions=2))
    return AccuracyCost.read(path)


def of(rows, **where):
    return [row for row in rows if all(row[key] == value for key, value in where.items())]


def test_every_method_is_there(rows):
    methods = {
        "volume": "rejection conditioned sobol quadrature closed_form exact",
        "area": "shell balanced_shell surface sobol quadrature closed_form exact",
        "time": "lockstep scalar time_step",
        "floor": "shell time_step",
        "radius": "lockstep strip poisson paid",
    }
    for part, names in methods.items():
        assert {row["method"] for row in of(rows, part=part)} == set(names.split()), part


def test_the_speed_is_that_of_the_median_run():
    def runs(method, *speeds):
        return [{"part": "time", "method": method, "work": n, "seconds": 1.0} for n in speeds]

    found = accuracy_cost.speed([*runs("scalar", 2, 9, 1), *runs("lockstep", 16, 12)])
    assert (found["method"], found["setting"]) == ("lockstep", 8.0)


def test_exact_evaluation_is_exact(rows):
    for row in of(rows, method="exact"):
        assert row["error"] < 1e-15


def test_floors(rows):
    shells = of(rows, part="floor", method="shell")
    assert [row["error"] for row in shells] == sorted((r["error"] for r in shells), reverse=True)
    for row in shells:
        expected = exact.shell_expectation(PAPER, "disc_collision", row["setting"])
        area = exact.areas(PAPER)["disc_collision"]
        assert row["bias"] == pytest.approx(expected / area - 1)
    for row in of(rows, part="floor", method="time_step", quantity="any_wall_time"):
        assert row["bias"] > 10 * row["spread"]


def test_a_hop_that_dies_out_costs_ever_more(rows):
    found = of(rows, part="radius", method="poisson", quantity="horizontal_hop_time")
    prices = [row["seconds"] for row in found if row["radius"] > 0.1]
    assert prices == sorted(prices)
    assert prices[-1] > 100 * prices[0]


@pytest.mark.parametrize("hop", HOPS)
def test_from_starts_next_to_it_it_does_not(rows, hop):
    """Half a start for 1/error², of 2 to 32 events: no more than 24, by the random numbers."""
    found = of(rows, part="radius", method="strip", quantity=f"{hop}_time")
    last = Box.of(PAPER).threshold(hop)
    assert min(1 - row["radius"] / last for row in found) < 2e-6
    assert all(row["work"] < 24 / row["error"] ** 2 for row in found)


@pytest.fixture(scope="module")
def panels(rows):
    """The panels of both figures, {label: axes}."""
    with style.context():
        figures = [m.draw(None, {"accuracy_cost": rows}) for m in (figure, figure_by_radius)]
    return {axes.get_label(): axes for drawn in figures for axes in drawn.axes}


@pytest.mark.parametrize(
    ("panel", "part", "method"),
    [
        ("volume", "volume", "sobol"),
        ("area", "area", "surface"),
        ("area", "area", "sobol"),
        ("times", "time", "lockstep"),
        ("times", "time", "scalar"),
    ],
)
def test_bars_are_those_of_the_mean_over_the_runs(rows, panels, panel, part, method):
    """Not of one run; they end above zero."""
    own = of(rows, part=part, method=method)
    own = [row for row in own if part != "time" or row["quantity"] == "vertical_hop_time"]
    due = [
        (row["seconds"], row["error"], min(row["spread"] / row["repetitions"] ** 0.5, 0.9 * error))
        for row in own
        for error in [row["error"]]
    ]
    shown = bars(panels[panel], figure.LOOK[method][0], "None")  # beside the symbols
    np.testing.assert_allclose(shown, sorted(due), rtol=1e-9)


def test_symbols_are_the_errors_over_their_times(rows, panels):
    shells = sorted({row["setting"] for row in of(rows, method="shell", part="area")}, reverse=True)
    cases = [
        ("area", figure.LOOK["balanced_shell"], of(rows, part="area", method="balanced_shell")),
        *(
            ("area", look, of(rows, part="area", method="shell", setting=thickness))
            for look, thickness in zip(figure.SHELLS, shells, strict=True)
        ),
        *(
            ("volume", figure.LOOK[method], of(rows, part="volume", method=method))
            for method in ("rejection", "conditioned", "sobol")
        ),
        *(
            ("times", figure.LOOK[method], of(rows, method=method, quantity="vertical_hop_time"))
            for method in ("lockstep", "scalar", "time_step")
        ),
    ]
    for panel, look, own in cases:
        own = [row for row in own if row["part"] not in ("floor", "radius", "speed")]
        due = {(row["seconds"], max(row["error"], 2.0**-53)) for row in own}
        assert points(panels[panel], *look) == due != set()


def curve(axes, label):
    (line,) = [line for line in axes.lines if line.get_label() == label]
    return line.get_data()


def test_the_laws_have_their_powers_and_go_through_the_errors(rows, panels):
    """Samples fall as the root of time; at the best Δt no other Δt has a smaller error."""
    for panel, part, method in (
        ("volume", "volume", "rejection"),
        ("area", "area", "surface"),
        ("times", "time", "lockstep"),
    ):
        own = of(rows, part=part, method=method, radius=0.2)
        own = [row for row in own if part != "time" or row["quantity"] == "vertical_hop_time"]
        times, errors = curve(panels[panel], r"$\propto t^{-1/2}$")
        assert np.ptp(errors**2 * times) < 1e-12 * errors[0] ** 2 * times[0]
        logarithms = [math.log(row["error"]) for row in own]
        assert np.mean(np.log(errors)) == pytest.approx(np.mean(logarithms))
    times, errors = curve(panels["times"], r"best $\Delta t$, $\propto t^{-1/3}$")
    floor = max(
        of(rows, part="floor", method="time_step", quantity="vertical_hop_time"),
        key=lambda row: row["setting"],
    )
    runs = of(rows, part="time", method="time_step", quantity="vertical_hop_time")
    noise = np.median(
        [(r["error"] ** 2 - r["bias"] ** 2) * r["seconds"] * r["setting"] for r in runs]
    )
    steps = np.geomspace(1e-7, 10, 20001)
    for time, error in zip(times, errors, strict=True):
        squares = (floor["error"] / floor["setting"] * steps) ** 2 + noise / (time * steps)
        assert error == pytest.approx(math.sqrt(squares.min()), rel=1e-6)


def test_quadrature_is_drawn_over_its_nodes(rows, panels):
    for part, look in (("volume", (style.BLUE, "o")), ("area", (style.VERMILLION, "s"))):
        own = of(rows, part=part, method="quadrature")
        due = {(row["work"], max(row["error"], 2.0**-53)) for row in own}
        assert points(panels["quadrature"], *look) == due


def test_prices_of_pilots_are_drawn_over_those_of_a_poisson_process(rows, panels):
    predicted = of(rows, part="radius", method="poisson")
    speed = np.median([row["work"] / row["seconds"] for row in predicted])
    for event, look in LOOKS.items():
        own = of(rows, part="radius", method="lockstep", quantity=f"{event}_time")
        assert {(r["radius"], r["seconds"]) for r in own} <= points(
            panels["times by radius"], *look
        )
        due = {
            row["radius"]: row["seconds"] * speed / one["work"]
            for row in own
            for one in of(predicted, quantity=f"{event}_time", radius=row["radius"])
        }
        shown = dict(points(panels["ratios"], *look))
        assert shown.keys() >= due.keys() != set()
        assert [shown[radius] for radius in due] == pytest.approx([*due.values()], rel=0.01)
