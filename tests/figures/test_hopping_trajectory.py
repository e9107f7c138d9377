"""The trajectory: which separation is drawn, and which stretch of time is enlarged."""

import numpy as np
import pytest
from figure_cases import tables_of, unclear

import twodiscs as td
from twodiscs.comparison.scene_tables import Trajectory
from twodiscs.figures import animation, motion, style
from twodiscs.model.box import Box


def test_the_panel_beneath_shows_most_hops():
    hops = np.array([3.0, 40.0, 41.0, 42.0, 90.0])
    start, end = motion._crowded(hops, 10.0, 0.0, 100.0)
    assert (start, end) == (37.0, 47.0)
    assert motion._crowded(hops[:1], 10.0, 0.0, 100.0) == (0.0, 10.0)
    assert motion._crowded(hops[:0], 10.0, 0.0, 100.0) == (0.0, 10.0)


@pytest.mark.parametrize(
    ("box", "axis"),
    [
        (Box(1.5, 1.0), "x"),
        (Box(1.0, 1.0), "x"),
        (Box(1.0, 1.5), "y"),
        (Box(1.5, 1.0, {"periodic": "x"}), "y"),
        (Box(1.0, 1.5, {"periodic": "y"}), "x"),
        (Box(1.0, 1.5, {"periodic": "x"}), "y"),
    ],
    ids=str,
)
def test_the_longer_side_that_ends_at_walls_is_shown(box, axis):
    """With the hops along it; and the radius is written above if it is known."""
    rows = tables_of("paper")["trajectory"]
    with style.context():
        figure = motion.draw_trajectory(box, rows, radius=0.24)
        bare = motion.draw_trajectory(box, rows)
    hop = "horizontal_hop" if axis == "x" else "vertical_hop"
    times = [row["time"] for row in rows if row["event"] == hop]
    for axes in figure.axes:
        assert axes.get_ylabel() in (f"${axis}_2-{axis}_1$", "")
        dots = next(line for line in axes.lines if line.get_marker() == "o")
        assert list(dots.get_xdata()) == times
        path = next(line.get_data() for line in axes.lines if line.get_color() == style.BLUE)
        apart = [row[f"{axis}2"] - row[f"{axis}1"] for row in rows]
        np.testing.assert_array_equal(path, [[row["time"] for row in rows], apart])
    titles = [one.axes[0].get_title("left") for one in (figure, bare)]
    assert ["$r=0.24$" in title for title in titles] == [True, False]


#: As many effects as go together, with values of three digits.
ALL_EFFECTS = {"radius_ratio": 0.625, "mass_ratio": 0.125, "moment_of_inertia": 0.375}


@pytest.mark.parametrize(
    "effects",
    [
        {},
        {"periodic": "x"},
        {"periodic": "x", "field": 0.625},
        {"periodic": "x", **ALL_EFFECTS},
        {"field": 0.125, **ALL_EFFECTS},
        {"depth": 1.25, "periodic": "xz", "mass_ratio": 0.125, "radius_ratio": 0.625},
    ],
    ids=str,
)
def test_effects_stand_clear_of_the_legend(effects):
    """In every figure whose heading says more than the box."""
    tables, box = tables_of("paper"), Box(1.55, 1.05, effects)
    with style.context():
        figure = motion.draw_trajectory(box, tables["trajectory"], radius=0.245)
        assert unclear(figure) == []
        assert unclear(motion.draw_hop_histogram(box, tables["hop_histogram"])) == []


@pytest.mark.parametrize(
    ("sides", "radius"),
    [
        ((3e-6, 1e-5), 6e-7),
        ((1e-5, 3e-6), 6e-7),
        ((0.03, 0.02), 0.0048),
        ((150, 100), 24),
        ((1.5e5, 1e5), 2.4e4),
    ],
)
def test_sides_of_any_size_stand_clear(sides, radius):
    """In the animation as well."""
    box = Box(*sides)
    rows = Trajectory.rows(box, radius, 1908)
    with style.context():
        assert unclear(motion.draw_trajectory(box, rows, radius=radius)) == []
        stage = animation.Stage(box, radius, rows)
        stage.show(stage.centre)
        assert unclear(stage.figure) == []


def test_the_panel_beneath_enlarges_a_short_trajectory_too():
    rows = tables_of("paper")["trajectory"][:120]
    with style.context():
        whole, close, *_ = motion.draw_trajectory(Box(1.5, 1.0), rows).axes
    (start, end), (first, last) = whole.get_xlim(), close.get_xlim()
    assert last - first <= (end - start) / 3 * (1 + 1e-12)
    assert start <= first < last <= end


def test_hops_are_in_the_legend_where_there_are_any():
    rows = tables_of("paper")["trajectory"]
    for shown, named in ((rows, True), ([r for r in rows if "hop" not in r["event"]], False)):
        with style.context():
            figure = motion.draw_trajectory(Box(1.5, 1.0), shown)
        texts = [text.get_text() for text in figure.legends[0].get_texts()]
        assert ("hops" in texts) == named


@pytest.mark.parametrize(("discs", "radius"), [(3, 0.2), (8, 0.1), (9, 0.1)])
def test_lines_of_many_discs_are_few_enough_to_follow_and_have_names(discs, radius):
    box = Box(1.5, 1.0, discs=discs)
    rows = Trajectory.rows(box, radius, 1908)
    with style.context():
        figure = motion.draw_trajectory(box, rows, radius=radius)
        assert unclear(figure) == []
    whole, close = figure.axes
    assert len(whole.lines) == len(close.lines) == discs
    bends = np.array([[len(line.get_xdata()) for line in axes.lines] for axes in figure.axes])
    assert np.all(bends <= motion.BENDS * discs + 1)
    inside = close.lines[0].get_xdata() <= close.get_xlim()[1]
    assert inside.sum() == motion.CLOSE_BENDS * discs + 1
    colours = [line.get_color() for line in whole.lines]
    assert len(set(colours)) == discs
    if discs > motion.NAMED:
        assert figure.legends == []
        return
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()][:2] == ["disc 1", "2"]
    assert [line.get_color() for line in legend.get_lines()] == colours


def test_lines_of_many_discs_are_those_of_the_trajectory():
    """Hops are no bends: without them the lines are the same."""
    box = Box(1.5, 1.0, discs=3)
    rows = Trajectory.rows(box, 0.2, 1908)
    with style.context():
        figure = motion.draw_trajectory(box, rows)
    line = figure.axes[0].lines[0]
    times = [row["time"] for row in rows if row["time"] <= figure.axes[0].get_xlim()[1]]
    assert len(times) > len(line.get_xdata())
    places = [row["x1"] for row in rows[: len(times)]]
    assert np.interp(times, *line.get_data()) == pytest.approx(places, abs=1e-12)


def test_of_very_many_discs_some_lines_are_drawn():
    """They are spread evenly; the panel beneath is closer also if the trajectory is short."""
    scene = td.Scene(9, 5, 0.2, discs=50)
    path = td.trajectory(scene, duration=10)
    whole, close = td.plot(path).axes
    assert close.get_title("right") == f"{motion.LINES} of the discs"
    assert close.get_xlim()[1] < whole.get_xlim()[1] / 2
    starts = np.sort(path[[f"x{n}" for n in range(1, 51)]].iloc[0].to_numpy(float))
    for axes in (whole, close):
        drawn = np.sort([line.get_ydata()[0] for line in axes.lines])
        assert len(drawn) == motion.LINES
        assert (drawn[0], drawn[-1]) == (starts[0], starts[-1])
        assert np.diff(np.searchsorted(starts, drawn)).max() <= 3


def test_the_third_panel_shows_a_hop_that_is_not_undone():
    hops = np.array([3.0, 40.0, 41.0, 42.0, 90.0])
    assert motion._lone(hops, 10.0, 0.0, 100.0) == 90
    assert motion._lone(hops, 10.0, 0.0, 92.0) is None  # its stretch would go beyond the end
    assert motion._lone(hops[1:4], 10.0, 0.0, 100.0) is None
    assert motion._lone(hops[:1], 10.0, 0.0, 100.0) is None
