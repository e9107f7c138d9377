"""Every figure of a scene draws for every box and every table, with no text upon another."""

from functools import cache

import pytest
from figure_cases import BOXES, PAPER, draw, tables_of, unclear

from twodiscs.figures import radius, style
from twodiscs.figures.catalogue import FIGURES
from twodiscs.model.box import Box

#: Boxes where labels could meet, and of any size.
TABLED = ("paper", "square", "long", "ten", "nearly square", "tiny", "large")


#: Those that differ most.
QUICK = ("paper", "square", "long")


def pairs():
    """Yield (figure, box): drawings in all boxes, the others in some."""
    for name, entry in FIGURES.items():
        for box in TABLED if entry.tables else BOXES:
            yield pytest.param(name, box, marks=[] if box in QUICK else pytest.mark.slow)
    yield from ((name, "tall") for name in ("hopping_trajectory", "wall_area"))


@cache
def drawn(name, box):
    """Return a figure of one of ``BOXES``."""
    with style.context():
        return draw(name, BOXES[box], tables_of(box))


@pytest.mark.parametrize(("name", "box"), list(pairs()))
def test_texts_stand_clear(name, box):
    figure = drawn(name, box)
    with style.context():
        assert unclear(figure) == []
    width, height = figure.get_size_inches()
    assert width == (radius.WIDE if name == "all_areas" else style.COLUMN)
    assert height < 6.5


def test_what_would_not_be_clear_is_found():
    with style.context():
        figure = draw("model", PAPER, {})
        figure.text(0.5, 0.5, "one")
        figure.text(0.5, 0.5, "two")
        figure.text(-0.5, 0.5, "beyond")
        assert unclear(figure) == ["beyond", ("one", "two")]


def test_tables_with_little_in_them():
    """A single radius, a single event, and no estimate at all."""
    read = tables_of("paper")
    few = {
        "volume": read["volume"][:1],
        "areas": [r for r in read["areas"] if r["quantity"] == "top_wall_area"][:2],
        "mean_times": [r for r in read["mean_times"] if r["event"] == "horizontal_hop"][-2:],
        "hop_histogram": [
            row
            for row in read["hop_histogram"]
            if row["radius"] == read["hop_histogram"][0]["radius"]
        ],
        "trajectory": read["trajectory"][:3],
    }
    assert [r["status"] for r in few["mean_times"]] == ["impossible"] * 2
    with style.context():
        for name in ("volume", "wall_area", "mean_hop_time", "hop_histogram", "hopping_trajectory"):
            draw(name, PAPER, few).draw_without_rendering()
        with pytest.raises(ValueError, match=r"collision_area has no row of disc_collision"):
            draw("collision_area", PAPER, few)
        with pytest.raises(ValueError, match=r"mean_wall_time has no row of right_wall"):
            draw("mean_wall_time", PAPER, few)


@pytest.mark.parametrize("name", [name for name, entry in FIGURES.items() if entry.tables])
def test_laws_of_plain_scenes_are_not_drawn_with_effects(name):
    """No law for small discs, none near the end, no density at 0; the effects are named instead."""
    effects, symbol = {"field": 1.5}, "g=1.5"
    if "field" in FIGURES[name].without:
        effects, symbol = {"radius_ratio": 0.5}, "r_2/r_1=0.5"
    box = Box(1.5, 1.0, effects)
    with style.context():
        figures = [drawn(name, "paper"), draw(name, box, tables_of("paper"))]
    dashed, marks = (
        [sum(wanted(line) for axes in figure.axes for line in axes.lines) for figure in figures]
        for wanted in (
            lambda line: line.get_zorder() == 6,
            lambda line: line.get_linewidth() == 1.8,
        )
    )
    assert not any(dashed[1:] + marks[1:])
    assert bool(dashed[0]) == ("mean" in name or name == "pressure")
    assert bool(marks[0]) == (name == "hop_histogram")
    assert any(symbol in axes.get_title("left") for axes in figures[1].axes)
