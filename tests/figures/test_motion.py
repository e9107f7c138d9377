"""Figures of the motion: hops, lines and bins are those of the table."""

import numpy as np
import pytest
from figure_cases import PAPER, draw, tables_of, unclear
from matplotlib.figure import Figure

from twodiscs.analysis.tables import TrajectoryTable
from twodiscs.figures import motion, style
from twodiscs.model.scene import Box


def test_the_panels_beneath_show_most_hops_and_a_hop_that_is_not_undone():
    hops = np.array([3.0, 40.0, 41.0, 42.0, 90.0])
    assert motion._densest_stretch(hops, 10.0, 0.0, 100.0) == (37.0, 47.0)
    assert motion._stretches(np.arange(600.0), hops[:1]) == [(0.0, 599 / 4)]  # 150 rows
    assert motion._densest_stretch(hops[:0], 10.0, 0.0, 100.0) == (0.0, 10.0)
    assert motion._densest_stretch(hops[4:], 10.0, 0.0, 92.0) == (82.0, 92.0)
    assert motion._loneliest_hop(hops, 10.0, 0.0, 100.0) == 90
    # Its stretch would go beyond the end.
    assert motion._loneliest_hop(hops, 10.0, 0.0, 92.0) is None
    assert motion._loneliest_hop(100 - hops[::-1], 10.0, 6.0, 200.0) == 97
    assert motion._loneliest_hop(hops[:1], 10.0, 0.0, 100.0) is None
    assert motion._loneliest_hop(hops[1:4] - [20, 0, 0], 10.0, 0.0, 100.0) == 20


@pytest.mark.parametrize(
    ("box", "axis"),
    [
        (PAPER, "x"),
        (Box(1.0, 1.0), "x"),
        (Box(1.0, 1.5), "y"),
        (Box(1.5, 1.0, periodic="x"), "y"),
        (Box(1.0, 1.5, periodic="y"), "x"),
    ],
    ids=str,
)
def test_the_longer_side_that_ends_at_walls_is_shown_with_its_hops(box, axis):
    """The panel beneath enlarges a short trajectory too; a hop that is not undone has its own."""
    rows = tables_of("paper")["trajectory"][: None if box == PAPER else 120]
    figure = draw("hopping_trajectory", box, {"trajectory": rows}, radius=0.24)
    assert unclear(figure) == []
    hop = "horizontal_hop" if axis == "x" else "vertical_hop"
    times = [row["time"] for row in rows if row["event"] == hop]
    for axes in figure.axes:
        dots = next(line for line in axes.lines if line.get_marker() == "o")
        assert list(dots.get_xdata()) == times
        path = next(line.get_data() for line in axes.lines if line.get_color() == style.BLUE)
        apart = [row[f"{axis}2"] - row[f"{axis}1"] for row in rows]
        np.testing.assert_array_equal(path, [[row["time"] for row in rows], apart])
    (start, end), (first, last) = (axes.get_xlim() for axes in figure.axes[:2])
    assert last - first <= (end - start) / 3 * (1 + 1e-12)
    assert start <= first < last <= end
    shaded = [(area.get_x(), area.get_x() + area.get_width()) for area in figure.axes[0].patches]
    np.testing.assert_allclose(shaded, [axes.get_xlim() for axes in figure.axes[1:]], rtol=1e-9)
    if box == PAPER:  # the first three hops are a 50th of a panel apart
        assert last - first == pytest.approx(50 * np.diff(times).min())
        assert figure.axes[2].get_xlim() == pytest.approx((times[3] - 25, times[3] + 25))
    assert len(figure.axes) == 2 + (box == PAPER)


@pytest.mark.parametrize(
    "box",
    [Box(1.5, 1.0, discs=9), Box(1.0, 1.5, discs=3), Box(1.5, 1.0, discs=3, periodic="x")],
    ids=str,
)
def test_lines_of_many_discs_are_those_of_the_trajectory(box):
    """Few enough bends to follow. Hops are no bends: without them the lines are the same."""
    discs, axis = box.discs, "x" if box.width > box.height else "y"
    rows = TrajectoryTable.rows(box, 0.1, 1908)
    figure = draw("hopping_trajectory", box, {"trajectory": rows}, radius=0.1)
    assert unclear(figure) == []
    whole, close = figure.axes
    times = [row["time"] for row in rows if row["time"] <= whole.get_xlim()[1]]
    for axes in figure.axes:
        for disc, line in enumerate(axes.lines, 1):
            assert len(line.get_xdata()) <= motion.DISC_BENDS * discs + 1 <= len(times)
            places = [row[f"{axis}{disc}"] for row in rows[: len(times)]]
            assert np.interp(times, *line.get_data()) == pytest.approx(places, abs=1e-12)
        assert len({line.get_color() for line in axes.lines}) == disc == discs
        shown = [line.get_ydata()[line.get_xdata() <= axes.get_xlim()[1]] for line in axes.lines]
        ends = (np.min(shown), np.max(shown)) if box.effects.get("periodic") else (-0.75, 0.75)
        assert axes.get_ylim() == ends
    inside = close.lines[0].get_xdata() <= close.get_xlim()[1]
    assert inside.sum() == motion.CLOSE_BENDS * discs + 1


def test_of_very_many_discs_some_lines_are_drawn():
    """They are spread evenly; the panel beneath is closer also if the trajectory is short."""
    rng, box = np.random.default_rng(1), Box(9.0, 5.0, discs=50)
    starts = np.sort(rng.uniform(-4.5, 4.5, 50))
    places = {f"x{n}": x for n, x in enumerate(rng.permutation(starts), 1)}
    rows = [{"time": float(t), "event": "disc_collision", **places} for t in range(400)]
    whole, close = draw("hopping_trajectory", box, {"trajectory": rows}).axes
    assert close.get_xlim()[1] < whole.get_xlim()[1] / 2
    drawn = np.sort([line.get_ydata()[0] for line in whole.lines])
    assert len(drawn) == len(close.lines) == motion.LINES_PER_PANEL
    assert (close.get_title("left"), close.get_title("right")) == ("(b)", "24 of the discs")
    assert (drawn[0], drawn[-1]) == (starts[0], starts[-1])
    assert np.diff(np.searchsorted(starts, drawn)).max() <= 3


def test_a_curve_has_the_first_bins_that_hold_enough():
    counts, rows = [0, 500, 400, 9, 30], []
    for i, n in enumerate(counts):
        row = {"left": i / 4, "right": (i + 1) / 4, "count": n, "exact_mean": 0.5}
        rows.append(row | {"density": 2.0 * n, "stderr": 1.0 * n})
    for fewest, stop in ((10, 3), (1, 5), (1000, 1)):
        edges, density, errors = motion.curve(rows, fewest)
        assert edges.tolist() == [i / 2 for i in range(1, stop + 1) if stop > 1]
        assert density.tolist() == (2 * errors).tolist() == counts[1:stop]


def test_bursts_have_logarithmic_axes_with_space_for_all_radii():
    """The curve of the first radius is the highest."""
    same = {"event": "horizontal_hop", "exact_mean": 1.0, "bins": "own", "count": 9, "stderr": 0.1}
    rows = [
        same | {"radius": radius, "left": left, "right": 2 * left, "density": high * 0.1 / left}
        for radius, high in ((0.2, 50.0), (0.24, 5.0))
        for left in (0.1, 0.2, 0.4)
    ]
    _, short = motion.draw_hop_histogram(Box(1.5, 1.0, field=0.1), rows).axes
    assert short.get_xscale() == short.get_yscale() == "log"
    assert (short.get_xlim(), short.get_ylim()) == ((0.1, 2.5), (np.exp(-2.5) / 2, 100.0))


def test_a_density_that_bins_are_too_wide_for_is_not_marked():
    """Bins must be finer than the space of a disc that passes the other, or is beside it."""
    row = {"radius": 0.2, "left": 0.0, "exact_mean": 1.0}
    for hop, space in (("vertical_hop", 1.0 - 0.4), ("horizontal_hop", 1.0 - 0.8)):
        for factor in (0.99, 1.01):
            axes, right = Figure().subplots(), factor * space / motion.FINE_BINS
            motion._mark_zero(axes, PAPER, row | {"event": hop, "right": right}, "black")
            assert len(axes.lines) == (factor < 1)
