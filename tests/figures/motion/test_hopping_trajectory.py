"""The trajectory: which separation is drawn, and which stretch of time is enlarged."""

import numpy as np
import pytest
from figure_cases import tables_of, unclear

from twodiscs.figures.kit import style
from twodiscs.figures.motion import hopping_trajectory
from twodiscs.model.box import Box


def test_the_panel_beneath_shows_most_hops():
    hops = np.array([3.0, 40.0, 41.0, 42.0, 90.0])
    start, end = hopping_trajectory._crowded(hops, 10.0, 0.0, 100.0)
    assert (start, end) == (37.0, 47.0)
    assert hopping_trajectory._crowded(hops[:1], 10.0, 0.0, 100.0) == (0.0, 10.0)
    assert hopping_trajectory._crowded(hops[:0], 10.0, 0.0, 100.0) == (0.0, 10.0)


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
        figure = hopping_trajectory.draw(box, {"trajectory": rows}, radius=0.24)
        bare = hopping_trajectory.draw(box, {"trajectory": rows})
    hop = "horizontal_hop" if axis == "x" else "vertical_hop"
    times = [row["time"] for row in rows if row["event"] == hop]
    for axes in figure.axes:
        assert axes.get_ylabel() == f"${axis}_2-{axis}_1$"
        dots = next(line for line in axes.lines if line.get_marker() in ("o", "|"))
        assert list(dots.get_xdata()) == times
    texts = [" ".join(text.get_text() for text in one.axes[0].texts) for one in (figure, bare)]
    assert ["$r=0.24$" in text for text in texts] == [True, False]


@pytest.mark.parametrize(
    "effects", [{}, {"periodic": "x"}, {"periodic": "x", "field": 0.6}], ids=str
)
def test_effects_stand_clear_of_the_legend(effects):
    rows = tables_of("paper")["trajectory"]
    with style.context():
        box = Box(1.5, 1.0, effects)
        figure = hopping_trajectory.draw(box, {"trajectory": rows}, radius=0.24)
        assert unclear(figure) == []
