"""Quantities over the radius: estimates, exact curves and laws are drawn."""

import numpy as np
import pytest
from figure_cases import BOXES, PAPER, bars, covered, draw, points, simulated, tables_of, unclear

from twodiscs.comparison.table import quantity_of
from twodiscs.figures import curves, radius, style
from twodiscs.figures.catalogue import FIGURES, WALL_NAMES
from twodiscs.model.box import Box
from twodiscs.theory.exact import mean_times
from twodiscs.theory.laws import small_radius_time
from twodiscs_paper.studies.thresholds.measure import leading_law

OVER_RADIUS = [name for name in radius.OVER_RADIUS if name in FIGURES]


@pytest.fixture(scope="module")
def figures():
    with style.context():
        return {name: draw(name, PAPER, tables_of("paper")) for name in OVER_RADIUS}


@pytest.mark.parametrize("name", OVER_RADIUS)
def test_each_quantity_has_its_own_curve_and_estimates(figures, name):
    """Estimates with their standard errors, and residuals, as in the rows of the table."""
    radii, exact = curves.exact_curves(PAPER)
    names, (main, lower) = [*radius.OVER_RADIUS[name].names], figures[name].axes[:2]
    drawn = [line for line in main.lines if len(line.get_xdata()) == len(radii)]
    assert len(drawn) == len(names)
    assert FIGURES[name].needs == {*names}
    for line, quantity, (colour, marker) in zip(drawn, names, style.SERIES, strict=False):
        rooted = "hop_area" in name
        np.testing.assert_array_equal(line.get_ydata(), exact[quantity] ** (0.5 if rooted else 1))
        assert line.get_color() == (style.BLACK if len(names) == 1 else colour)
        rows = [
            row
            for row in tables_of("paper")[FIGURES[name].tables[0]]
            if quantity_of(row) == quantity and row["stderr"]
        ]
        assert rows
        shown = [(r, y, s) for r, y, s in bars(main, colour, marker) if s]
        due = np.array([(row["radius"], row["estimate"], row["stderr"]) for row in rows])
        if rooted:
            due[:, 1] **= 0.5
            due[:, 2] /= 2 * due[:, 1]
        np.testing.assert_allclose(shown, due, rtol=1e-9)
        due = {(row["radius"], row["z"]) for row in rows if abs(row["z"]) < 6}
        assert due <= points(lower, colour, marker)


def test_blocked_hop_area_is_shown_as_zero(figures):
    points = {
        (x, y)
        for line in figures["horizontal_hop_area"].axes[0].lines
        if line.get_marker() == "o"
        for x, y in zip(line.get_xdata(), line.get_ydata(), strict=True)
    }
    blocked = [r["radius"] for r in tables_of("paper")["volume"] if r["radius"] > 0.25]
    assert blocked
    assert {(r, 0.0) for r in blocked} <= points


def asymptotes(axes):
    """Return the dashed lines of the limiting laws, as (abscissae, ordinates)."""
    return [line.get_data() for line in axes.lines if line.get_zorder() == 6]


def test_limiting_laws_run_into_the_curves(figures):
    """The law for small discs begins at the limit r → 0, and that of the end ends on the curve."""
    small, last = asymptotes(figures["mean_collision_time"].axes[0])
    assert small[0][-1] == radius.SMALL * PAPER.largest_radius
    assert small[1][0] == small_radius_time(PAPER, "disc_collision", small[0][0])
    time = mean_times(PAPER.scene(float(last[0][-1])))["disc_collision"]
    assert last[1][-1] == pytest.approx(time, rel=1e-3)
    assert len(asymptotes(figures["mean_hop_time"].axes[0])) == 2


def test_times_approach_the_end_of_their_hop(figures):
    """The panel beneath: curves, estimates and laws over the distance from w/4 or h/4."""
    lower = figures["mean_hop_time"].axes[2]
    ends = {"vertical_hop": 0.375, "horizontal_hop": 0.25}
    for (event, end), (distances, times) in zip(ends.items(), asymptotes(lower), strict=True):
        law = leading_law(PAPER, event)
        np.testing.assert_allclose(times, law.coefficient * (end * distances) ** -2, rtol=1e-5)
        assert distances.max() < radius.LAW
    rows = [r for r in tables_of("paper")["mean_times"] if r["event"] == "horizontal_hop"]
    shown = {x for line in lower.lines if line.get_marker() == "s" for x in line.get_xdata()}
    assert shown == {1 - row["radius"] / 0.25 for row in rows if row["stderr"]}


def test_the_legend_leaves_out_what_is_never_seen():
    """In this field no disc gets up to the top wall, so there is no curve of it."""
    box = Box(1.0, 4.0, {"field": 0.5})
    assert not box.scene(0.1).is_possible("top_wall")
    rng = np.random.default_rng(1)
    rows = [
        simulated(rng, scene, event, time, 0.01)
        for scene in map(box.scene, (0.05, 0.1, 0.2))
        for event, time in mean_times(scene).items()
    ]
    with style.context():
        main = draw("mean_wall_time", box, {"mean_times": rows}).axes[0]
    legend = main.get_legend()
    names = WALL_NAMES["right_wall"], WALL_NAMES["any_wall"]
    assert tuple(text.get_text() for text in legend.get_texts()) == names
    shown = [(handle.get_color(), handle.get_marker()) for handle in legend.legend_handles]
    assert shown == [style.SERIES[0], style.SERIES[2]]


@pytest.mark.parametrize("name", BOXES)
def test_no_collision_time_lies_beneath_the_legend(name):
    with style.context():
        assert covered(draw("mean_collision_time", BOXES[name], tables_of(name)).axes[0]) == []


def test_no_hop_time_lies_beneath_the_legend_where_it_ends_with_the_largest_radius():
    box, event = Box(5.0, 1.0, {"periodic": "x", "field": 0.6}), "vertical_hop"
    rng, rows = np.random.default_rng(4), []
    for r in (0.1, 0.2, 0.3):
        scene = box.scene(r)
        time = mean_times(scene)[event]
        rows.append(simulated(rng, scene, event, time, 3e-3))
    with style.context():
        figure = draw("mean_hop_time", box, {"mean_times": rows})
        assert [covered(axes) for axes in figure.axes if axes.get_legend()] == [[], []]


def test_the_legend_has_no_line_where_no_exact_value_is_known():
    box = Box(1.5, 1.0, discs=5)
    rng = np.random.default_rng(5)
    rows = [
        simulated(rng, box.scene(r), event, 1.0, 3e-3) | {"exact": None, "z": None}
        for r in (0.05, 0.1)
        for event in ("vertical_hop", "horizontal_hop")
    ]
    with style.context():
        figure = draw("mean_hop_time", box, {"mean_times": rows})
        assert unclear(figure) == []
    (axes,) = figure.axes
    lines = axes.get_legend().get_lines()
    handles = [(line.get_linestyle(), line.get_marker()) for line in lines]
    assert handles == [("None", marker) for _, marker in style.SERIES[:2]]


def test_an_estimate_above_the_curve_is_in_the_picture():
    tables = tables_of("paper")
    first, *others = [r for r in tables["areas"] if r["quantity"] == "vertical_hop_area"]
    far = first | {"estimate": 1.2 * first["exact"], "stderr": 0.1 * first["exact"]}
    with style.context():
        main = draw("vertical_hop_area", PAPER, {"areas": [far, *others]}).axes[0]
    assert main.get_ylim()[1] > (1.2 * first["exact"]) ** 0.5


def test_where_nothing_is_known_there_are_symbols_only():
    """No residuals, and no curves that approach an end."""
    ring = Box(1.5, 1.0, {"periodic": "x"}, discs=3)
    unknown = {"exact": None, "z": None, "test": None, "status": "counted", "bound": None}
    rows = [
        {"event": event, "radius": r, "estimate": time, "stderr": 1e-3 * time} | unknown
        for event, times in (("disc_collision", (3, 1, 0.5, 0.2)), ("vertical_hop", (4, 4, 4, 3)))
        for r, time in zip((0.05, 0.1, 0.15, 0.2), times, strict=True)
    ]
    for name in ("mean_hop_time", "mean_collision_time", "pressure"):
        shown = rows
        if name == "pressure":
            shown = [row | {"event": "top_wall"} for row in rows if row["event"] == "vertical_hop"]
        with style.context():
            figure = draw(name, ring, {"mean_times": shown})
            assert unclear(figure) == []
        (axes,) = figure.axes
        assert axes.get_xlabel() == "radius $r$"
        assert any(label.label1.get_visible() for label in axes.xaxis.get_major_ticks())


def test_curves_are_drawn_to_their_end_without_any_residual():
    """Times from too few events for an error: a panel for them and one beneath."""
    rows = [
        row | {"stderr": None, "z": None, "status": "too-few"}
        for row in tables_of("paper")["mean_times"]
        if row["event"] in ("vertical_hop", "horizontal_hop") and row["estimate"]
    ]
    with style.context():
        figure = draw("mean_hop_time", PAPER, {"mean_times": rows})
    main, approach = figure.axes
    assert main.get_xlabel() == "radius $r$"
    assert approach.get_xlabel().startswith("relative distance")


@pytest.mark.filterwarnings("error")
def test_a_single_value_has_an_ordinate_around_it():
    """And there is one where nothing is known at all."""
    (row,) = tables_of("paper")["volume"][:1]
    box = Box(3.0, 1.5, discs=8)
    with style.context():
        for estimate in (1.4e-3, None):
            alone = [row | {"exact": None, "z": None, "estimate": estimate}]
            main = draw("volume", box, {"volume": alone}).axes[0]
            low, high = main.get_ylim()
            assert low < (estimate or 1) < high
            assert 2.9 < high / low < 10
