"""Files of figures: their bytes are the same with any settings, on any day."""

import re
import runpy
from pathlib import Path

import matplotlib
import pytest
from figure_cases import PAPER, draw
from marks import slow

import twodiscs as td
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


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        *(("integration_regimes", kind) for kind in ("pdf", "png", "svg")),
        *(slow("animation", kind) for kind in ("gif", "png")),
    ],
)
def test_same_bytes_whatever_the_settings_are(name, kind, tmp_path, monkeypatch):
    found = []
    for turn, colour in enumerate(("white", "yellow")):
        monkeypatch.setenv("TZ", f"UTC{turn}")
        settings = {"figure.facecolor": colour, "font.size": 9 + turn, "pdf.fonttype": 3}
        path = tmp_path / f"{turn}.{kind}"
        with matplotlib.rc_context(settings):
            if name == "animation":
                td.animate(td.trajectory(PAPER.scene(0.24)), path)
            else:
                style.save(draw(name, PAPER, {}), path)
        found.append(path.read_bytes())
    assert found[0] == found[1]
    assert len(found[0]) < 600_000
    assert not re.search(rb"Date|Creat|<dc:date>|Producer|Matplotlib|tIME|iTXt|Software", found[0])
    if kind == "pdf":
        assert b"/FontFile2" in found[0]
        assert b"/Type3" not in found[0]
        width = float(re.search(rb"/MediaBox \[ ?0 0 ([0-9.]+)", found[0])[1])
        assert width == pytest.approx(72 * style.COLUMN_WIDTH)
    elif (name, kind) == ("integration_regimes", "png"):
        width = int.from_bytes(found[0][16:20], "big")
        assert width == round(style.RC_PARAMS["savefig.dpi"] * style.COLUMN_WIDTH)


# Looks of events ----------------------------------------------------------------------------------


def test_events_without_a_look_are_told(monkeypatch):
    monkeypatch.setattr(events, "EVENTS", tuple("abcdefghi"))
    with pytest.raises(TypeError, match=r"style\.py has 8 looks, too few for 9 events"):
        runpy.run_path(style.__file__)
