"""Without these tests a picture of the pages could show another panel, or one without axes."""

import pytest
from figure_cases import PAPER, draw, tables_of, unclear
from pictures import HEIGHT, PANELS, keep_panel

from twodiscs.figures import style
from twodiscs.figures.catalogue import FIGURES
from twodiscs_paper.catalogue import STUDY_FIGURES


@pytest.mark.parametrize("picture", [p for p, (name, *_) in PANELS.items() if name in FIGURES])
def test_a_picture_is_a_panel_with_a_legend_and_names_of_its_axes(picture):
    assert {name for name, *_ in PANELS.values()} <= {*FIGURES, *STUDY_FIGURES}
    name, *panel = PANELS[picture]
    with style.context():
        figure = draw(name, PAPER, tables_of("paper"))
        keep_panel(figure, *panel)
        assert unclear(figure) == []
        (kept,) = [axes for axes in figure.axes if axes.get_visible()]
    assert kept.get_legend()
    assert kept.get_xlabel()
    assert "residual" not in kept.get_ylabel()
    assert tuple(figure.get_size_inches()) == (style.COLUMN, HEIGHT)
