"""Files of figures: their bytes are the same on every machine, with any settings, on any day."""

import os
import re
import runpy
import sys
from pathlib import Path

import matplotlib
import pytest
from commands import python

from twodiscs.figures import style
from twodiscs.model import events


def test_fonts_are_those_of_matplotlib_even_if_its_list_lacks_them(monkeypatch):
    """The list is kept at home, and may stem from an installation that was half removed."""
    fonts, families = style.fontManager, ("cmr10", "cmmi10", "STIXGeneral")
    others = [font for font in fonts.ttflist if not re.match("cm|STIX", font.name)]
    monkeypatch.setattr(fonts, "ttflist", others)
    fonts._findfont_cached.cache_clear()
    with pytest.raises(ValueError, match="Failed to find font"):
        style.findfont(families[0], fallback_to_default=False)
    with style.context():
        found = [style.findfont(name, fallback_to_default=False) for name in families]
    folder = Path(matplotlib.get_data_path(), "fonts", "ttf")
    assert [Path(path) for path in found] == [folder / f"{name}.ttf" for name in families]


DRAW = """
import sys
from figure_cases import PAPER, draw, tables_of
from twodiscs.analysis.tables import TrajectoryTable
from twodiscs.figures import animation, style
with style.context():
    if sys.argv[1] == "animation":
        animation.animate(PAPER, 0.24, TrajectoryTable.rows(PAPER, 0.24, 1908), sys.argv[2:])
    else:
        figure = draw(sys.argv[1], PAPER, tables_of("paper"))
        for path in sys.argv[2:]:
            style.save(figure, path)
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "kinds"),
    [
        ("integration_regimes", ("pdf", "png", "svg")),
        ("mean_hop_time", ("pdf", "png", "svg")),
        ("animation", ("gif", "png")),
    ],
)
def test_same_bytes_whatever_the_machine_is_set_to(name, kinds, tmp_path):
    style_file = tmp_path / "matplotlibrc"
    style_file.write_text("font.size: 20\nlines.linewidth: 7\npdf.fonttype: 3\n")
    contents = []
    tests = {"PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    for turn, environment in enumerate(
        ({"PYTHONHASHSEED": "1"}, {"PYTHONHASHSEED": "2", "MATPLOTLIBRC": str(style_file)})
    ):
        folder = tmp_path / str(turn)
        folder.mkdir()
        outputs = [folder / f"a.{kind}" for kind in kinds]
        environment = os.environ | tests | {"TZ": f"UTC{turn}"} | environment
        finished = python("-c", DRAW, name, *outputs, env=environment)
        assert (finished.returncode, finished.stderr) == (0, "")
        contents.append([path.read_bytes() for path in outputs])
    assert contents[0] == contents[1]
    if name == "animation":
        assert all(len(content) < 600_000 for content in contents[0])
        return
    pdf, png, svg = contents[0]
    assert not re.search(rb"Date|Creator|Producer|Matplotlib", pdf)
    assert b"/FontFile2" in pdf
    assert b"/Type3" not in pdf
    width = float(re.search(rb"/MediaBox \[ ?0 0 ([0-9.]+)", pdf)[1])
    assert width == pytest.approx(72 * style.COLUMN)
    assert not re.search(rb"<dc:date>|Matplotlib v|tIME|iTXt|Software|Creation", svg + png)
    assert int.from_bytes(png[16:20], "big") == round(style.SETTINGS["savefig.dpi"] * style.COLUMN)


# Looks of events ----------------------------------------------------------------------------------


def test_events_without_a_look_are_told(monkeypatch):
    monkeypatch.setattr(events, "EVENTS", tuple("abcdefghi"))
    with pytest.raises(TypeError, match=r"style\.py has 8 looks, too few for 9 events"):
        runpy.run_path(style.__file__)
