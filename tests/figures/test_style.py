"""Files of figures: the same bytes whatever the machine is set to; every event has a look."""

import os
import re
import runpy
import subprocess
import sys
from pathlib import Path

import matplotlib
import pytest
from figure_cases import PAPER, draw

from twodiscs.figures import style
from twodiscs.figures.style import _LOOKS, LOOKS, SIZES, name_of
from twodiscs.model import events
from twodiscs.model.events import EVENTS, HOPS


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
from twodiscs.figures import style
with style.context():
    figure = draw(sys.argv[1], PAPER, tables_of("paper"))
    for path in sys.argv[2:]:
        style.save(figure, path)
"""


@pytest.mark.slow
@pytest.mark.parametrize("name", ["integration_regimes", "mean_hop_time"])
def test_same_bytes_whatever_the_machine_is_set_to(name, tmp_path):
    style_file = tmp_path / "matplotlibrc"
    style_file.write_text("font.size: 20\nlines.linewidth: 7\npdf.fonttype: 3\n")
    contents = []
    tests = {"PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    for turn, environment in enumerate(
        ({"PYTHONHASHSEED": "1"}, {"PYTHONHASHSEED": "2", "MATPLOTLIBRC": str(style_file)})
    ):
        folder = tmp_path / str(turn)
        folder.mkdir()
        outputs = [folder / "a.pdf", folder / "a.png"]
        finished = subprocess.run(
            [sys.executable, "-c", DRAW, name, *outputs],
            env=os.environ | tests | {"TZ": f"UTC{turn}"} | environment,
            capture_output=True,
            text=True,
        )
        assert (finished.returncode, finished.stderr) == (0, "")
        contents.append([path.read_bytes() for path in outputs])
    assert contents[0] == contents[1]
    pdf, png = contents[0]
    assert not re.search(rb"Date|Creator|Producer|Matplotlib", pdf)
    assert b"/Subtype /Type0" in pdf or b"/Subtype /TrueType" in pdf
    assert b"/FontFile2" in pdf
    assert b"/Type3" not in pdf
    width = float(re.search(rb"/MediaBox \[ ?0 0 ([0-9.]+)", pdf)[1])
    assert width == pytest.approx(72 * style.COLUMN)
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    assert not re.search(rb"tIME|iTXt|Software|Creation|Matplotlib", png)
    assert int.from_bytes(png[16:20], "big") == round(style.SETTINGS["savefig.dpi"] * style.COLUMN)


def test_an_svg_is_the_same_bytes_again_and_has_no_date(tmp_path):
    paths = [tmp_path / "a.svg", tmp_path / "b.svg"]
    for path in paths:
        with style.context():
            style.save(draw("model", PAPER, {}), path)
    first, second = (path.read_bytes() for path in paths)
    assert first == second
    assert not re.search(rb"<dc:date>|Matplotlib v", first)


def test_settings_are_restored():
    before = dict(matplotlib.rcParams)
    with style.context():
        assert matplotlib.rcParams["font.size"] == style.SETTINGS["font.size"]
    assert dict(matplotlib.rcParams) == before


# Looks of events ----------------------------------------------------------------------------------


def test_either_colour_or_marker_tells_events_apart():
    assert tuple(LOOKS) == EVENTS
    for part in zip(*LOOKS.values(), strict=True):
        assert len(set(part[:6])) == min(len(EVENTS), 6)


def test_looks_of_events_to_come_differ_from_all_others():
    assert len(set(_LOOKS)) == len(_LOOKS)
    assert {marker for _, marker in _LOOKS} <= set(SIZES)


def test_events_without_a_look_are_told(monkeypatch):
    monkeypatch.setattr(events, "EVENTS", tuple("abcdefghi"))
    with pytest.raises(TypeError, match=r"style\.py has 8 looks, too few for 9 events"):
        runpy.run_path(style.__file__)


def test_names_are_plural_but_for_walls():
    names = {event: name_of(event) for event in EVENTS}
    assert names["right_wall"] == "right wall"
    assert names["any_wall"] == "any wall"
    assert [names[hop] for hop in HOPS] == ["vertical hops", "horizontal hops"]
    assert names["disc_collision"] == "disc collisions"
