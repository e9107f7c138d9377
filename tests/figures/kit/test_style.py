"""Files of figures: the same bytes whatever the machine is set to, and none for a mistake."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import matplotlib
import pytest
from fabricated import command
from figure_cases import PAPER, draw, tables_of

from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.figures.catalogue import FIGURES
from twodiscs.figures.kit import style
from twodiscs.pipeline import jobs


def words_of(folder, name, outputs):
    """Write the tables that a figure reads and return the command line of its job."""
    entry, tables = FIGURES[name], []
    for table in entry.tables:
        path = folder / f"{table}.csv"
        SCENE_TABLES[table].write(path, tables_of("paper")[table])
        tables.append(f"{table}={path}")
    given = json.dumps({"box": PAPER.parameters(), **entry.options})
    outputs = [str(folder / output) for output in outputs]
    words = ["figure", entry.module, "--parameters", given, "--table", *tables]
    return [*words, "--output", *outputs]


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


@pytest.mark.slow
@pytest.mark.parametrize("name", ["integration_regimes", "mean_hop_time"])
def test_same_bytes_whatever_the_machine_is_set_to(name, tmp_path):
    style_file = tmp_path / "matplotlibrc"
    style_file.write_text("font.size: 20\nlines.linewidth: 7\npdf.fonttype: 3\n")
    contents = []
    for turn, environment in enumerate(
        ({"PYTHONHASHSEED": "1"}, {"PYTHONHASHSEED": "2", "MATPLOTLIBRC": str(style_file)})
    ):
        folder = tmp_path / str(turn)
        folder.mkdir()
        words = words_of(folder, name, ["a.pdf", "a.png"])
        finished = subprocess.run(
            [sys.executable, "-m", "twodiscs.pipeline.jobs", *words],
            env=os.environ | {"TZ": f"UTC{turn}"} | environment,
            capture_output=True,
            text=True,
        )
        assert (finished.returncode, finished.stderr) == (0, "")
        contents.append([(folder / f).read_bytes() for f in ("a.pdf", "a.png")])
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
    assert int.from_bytes(png[16:20], "big") == round(style.DPI * style.COLUMN)


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


#: The first part of parameters, and all of those of a drawing.
START = '{"box": {"width": 1.5, "height": 1.0}'
BOX = START + "}"


@pytest.mark.parametrize(
    ("module", "options", "sentence"),
    [
        (
            "figures.geometry.model",
            {"--parameters": '{"box": {"width": -1, "height": 1}}'},
            "width must be",
        ),
        (
            "figures.radius",
            {"--parameters": START + ', "names": {"volume": ""}, "label": "", "place": ""}'},
            "tables must be the one of volume, not none",
        ),
        (
            "figures.geometry.model",
            {"--output": "a.bmp"},
            "file, not 'a.bmp'",
        ),
    ],
)
def test_mistakes_are_told_in_one_sentence(
    module, options, sentence, monkeypatch, capsys, tmp_path
):
    monkeypatch.chdir(tmp_path)
    given = {"--parameters": BOX, "--output": "a.png"} | options
    words = [word for pair in given.items() for word in pair]
    assert command(monkeypatch, jobs, "figure", module, *words) == 2
    error = capsys.readouterr().err
    assert sentence in error
    assert error.count("\n") == 1
    assert not any(tmp_path.iterdir())
