"""The pictures of the pages: one panel each, the one that the text speaks of."""

import pytest
import speed
from figure_cases import PAPER, draw, tables_of, unclear
from pictures import HEIGHT, PANELS, WHOLE, alone

from twodiscs.figures.catalogue import FIGURES
from twodiscs.figures.kit import style
from twodiscs_paper.catalogue import STUDY_FIGURES
from twodiscs_paper.studies.effects.study import Benchmark


def test_pictures_are_of_figures_that_there_are():
    names = [name for name, *_ in PANELS.values()] + [*WHOLE]
    assert set(names) <= {*FIGURES, *STUDY_FIGURES}


@pytest.mark.parametrize("picture", [p for p, (name, *_) in PANELS.items() if name in FIGURES])
def test_a_picture_is_a_panel_with_a_legend_and_names_of_its_axes(picture):
    name, *panel = PANELS[picture]
    with style.context():
        figure = draw(name, PAPER, tables_of("paper"))
        alone(figure, *panel)
        assert unclear(figure) == []
        (kept,) = [axes for axes in figure.axes if axes.get_visible()]
    assert kept.get_legend()
    assert kept.get_xlabel()
    assert "residual" not in kept.get_ylabel()
    assert tuple(figure.get_size_inches()) == (style.COLUMN, HEIGHT)


def test_the_picture_of_speed_has_the_values_of_the_benchmark():
    names = ["lockstep", "discs_3", "discs_64", "discs_3_without_hops", "discs_64_without_hops"]
    rows = [
        Benchmark.empty(
            benchmark="md_events_per_second_by_number", variant=name, value=10.0 ** (8 - n)
        )
        for n, name in enumerate(names)
    ]
    with style.context():
        drawn = speed.draw(
            [*rows, Benchmark.empty(benchmark="other", variant="discs_8", value=1.0)]
        )
        assert unclear(drawn) == []
    two, hops, none, published = (line.get_xydata().tolist() for line in drawn.axes[0].lines)
    assert two == [[2, 1e8]]
    assert hops == [[3, 1e7], [64, 1e6]]
    assert none == [[3, 1e5], [64, 1e4]]
    assert published == [[256, 5.3e5]]
