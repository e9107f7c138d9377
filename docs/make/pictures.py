"""The pictures of README.md and docs: one panel each, drawn for the size at which it is shown.

    python docs/make/pictures.py results docs

draws them from a finished build, to which ``snakemake explorer`` has added. ``pdftoppm`` takes the
first page of the manuscript, ``chromium`` the top of the report and the explorer.
"""

import json
import re
import subprocess
from pathlib import Path
from shutil import copyfile
from tempfile import TemporaryDirectory

from PIL import Image

from twodiscs.arguments import Parser, run
from twodiscs.figures.kit import panels, style
from twodiscs_paper.configuration.load import load
from twodiscs_paper.pipeline.jobs.figure import ENTRIES, draw_figure
from twodiscs_paper.pipeline.jobs.study import read_tables

#: {picture: (figure, number of the panel, abscissa if it is written beneath another panel)}
PANELS = {
    "mean_hop_time": ("mean_hop_time", 0, "radius $r$"),
    "tails": ("tails", 0, r"interval $t/\tau$"),
    "hazard": ("distributions", 0, ""),
    "effects": ("effects", 0, "radius $r$"),
    "price": ("accuracy_cost_by_radius", 0, "radius $r$"),
    "cost": ("accuracy_cost", 2, "processor time (s)"),
    "passages": ("transmission", 0, ""),
    "more_discs": ("more_discs", 0, "number of discs $N$"),
}

#: Drawings that are shown whole.
WHOLE = ("model",)

#: Inches: the height of a picture, and its margins as in figures; two dots are a pixel shown.
HEIGHT, TOP, DPI = 2.5, 0.3, 200


#: The script that brings the explorer to the moment of its picture.
AT_A_HOP = """
runs.advance(2e7);
while (!(drawn.time > 3 && drawn.flash && drawn.time - drawn.flash.since < 0.05)) move(0.02);
state.paused = true;
draw();
renew();
"""


def tables_of(name, results):
    """Return {name: rows} of the tables of the figure ``name``, in the folders ``results``."""
    names = (*ENTRIES[name].tables, *ENTRIES[name].main_tables)
    paths = [f"{n}={f / n}.csv" for n in names for f in results if (f / f"{n}.csv").exists()]
    return read_tables(paths)


def alone(figure, number, abscissa):
    """Leave one panel of a figure, as wide as a column."""
    kept = figure.axes[number]
    for axes in figure.axes:
        axes.set_visible(axes is kept)
    figure.set_size_inches(style.COLUMN, HEIGHT)
    across, up = style.COLUMN - panels.LEFT - panels.RIGHT, HEIGHT - panels.BOTTOM - TOP
    corner = panels.LEFT / style.COLUMN, panels.BOTTOM / HEIGHT
    kept.set_position((*corner, across / style.COLUMN, up / HEIGHT))
    for text in kept.texts:
        text.set_text(re.sub(r"\([a-z]\) ?", "", text.get_text()))
    for legend in figure.legends:
        legend.set_visible(False)
        names = [text.get_text() for text in legend.get_texts()]
        kept.legend(legend.legend_handles, names, loc="upper left")
    if abscissa:
        kept.set_xlabel(abscissa)
        kept.tick_params(labelbottom=True)


def first_pages(results, output):
    """Take pictures of the first page of the manuscript and of the top of the report."""
    page = output / "paper"
    subprocess.run(
        ["pdftoppm", "-png", "-r", "80", "-singlefile", results / "paper.pdf", page], check=True
    )
    photograph(results / "report.html", output / "report.png", "1060,1120")


def photograph(page, picture, size):
    """Take a picture of the HTML file ``page`` in a window of ``size``, "width,height"."""
    subprocess.run(
        [
            *("chromium", "--headless", "--no-sandbox", "--hide-scrollbars"),
            *(f"--window-size={size}", f"--screenshot={picture}", page.resolve().as_uri()),
        ],
        check=True,
        capture_output=True,
    )


def explorer(results, output):
    """Take a picture of the explorer after a few million events, at a hop, in 256 colours."""
    text = (results / "explorer.html").read_text(encoding="utf-8")
    with TemporaryDirectory() as folder:
        page, picture = Path(folder, "explorer.html"), Path(folder, "explorer.png")
        page.write_text(text.replace("</body>", f"<script>{AT_A_HOP}</script></body>"), "utf-8")
        photograph(page, picture, "1280,1100")
        with Image.open(picture) as image:
            image.convert("RGB").quantize(256).save(output / "explorer.png", optimize=True)


def main():
    parser = Parser(description=__doc__.split("\n")[0])
    parser.add_argument("results", type=Path, help="the folder of a finished build")
    parser.add_argument("output", type=Path, help="where the pictures go")
    options = parser.parse_args()
    configuration = json.loads((options.results / "configuration.json").read_text(encoding="utf-8"))
    scene = load(configuration).main
    folders = (options.results / scene.name, options.results)
    with style.context():
        for picture, (name, *panel) in (PANELS | {name: (name,) for name in WHOLE}).items():
            figure = draw_figure(name, tables_of(name, folders), scene.box)
            if panel:
                alone(figure, *panel)
            figure.savefig(options.output / f"{picture}.png", dpi=DPI, metadata={"Software": None})
    copyfile(folders[0] / "figures" / "animation.gif", options.output / "animation.gif")
    first_pages(options.results, options.output)
    explorer(options.results, options.output)


if __name__ == "__main__":
    run(main)
