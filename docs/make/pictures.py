"""The pictures of README.md and docs, most of one panel, drawn for the size at which one sees them.

    python docs/make/pictures.py results docs

draws them from a finished build of config/config.yaml.
"""

import re
import sys
from pathlib import Path

from twodiscs.figures import style
from twodiscs.figures.draw import draw as draw_figure
from twodiscs.model.scene import Box
from twodiscs_paper.catalogue import ALL_FIGURES, TABLES, read_table
from twodiscs_paper.draw import DRAW

#: The box of the pictures and its scene, the first of config/config.yaml.
BOX = Box(1.5, 1.0)
SCENE = "paper"

#: Pictures that are whole figures.
WHOLE = {
    "model": "model",
    "mean_times": "mean_times",
    "cost": "accuracy_cost",
    "price": "accuracy_cost_by_radius",
    "calibration": "calibration",
    "tori": "tori",
}

#: {picture: (figure, number of the panel, abscissa if it is written beneath another panel)}
PANELS = {
    "mean_hop_time": ("mean_hop_time", 0, "radius $r$"),
    "tails": ("tails", 0, r"interval $t/\tau$"),
    "hazard": ("distributions", 0, ""),
    "effects": ("effects", 0, "radius $r$"),
    "passages": ("transmission", 0, ""),
    "more_discs": ("more_discs", 1, "number of discs $N$"),
}

#: Inches of a picture from bottom to top, the place of its panel, dots per inch: two are a pixel.
HEIGHT, PLACE, DPI = 2.5, (0.16, 0.18, 0.76, 0.66), 200


def draw(name, results):
    """Return a figure of the tables in a folder of results, None if one of them is missing."""
    # All events of the table of mean times are in one figure for td.plot alone.
    entry, tables = ALL_FIGURES.get(name, ALL_FIGURES["mean_hop_time"]), {}
    for table in (*entry.tables, *entry.main_tables):
        paths = [Path(results, SCENE, f"{table}.csv"), Path(results, f"{table}.csv")]
        path = next(filter(Path.exists, paths), None)
        if path is None:
            return None
        tables[table] = TABLES[table].read(path)
    tables |= {table: read_table(path) for table, path in entry.long_runs.items()}
    return DRAW[name](BOX, tables) if name in DRAW else draw_figure(name, BOX, *tables.values())


def keep_panel(figure, number, abscissa):
    """Leave one panel of a figure, as wide as a column."""
    figure.set_layout_engine("none")
    kept = figure.axes[number]
    for axes in figure.axes:
        axes.set_visible(axes is kept)
    figure.set_size_inches(style.COLUMN, HEIGHT)
    kept.set_position(PLACE)
    for text in (*kept.texts, kept.title, kept._left_title):
        text.set_text(re.sub(r"\([a-z]\) ?", "", text.get_text()))
    for legend in figure.legends:
        legend.set_visible(False)
        names = [text.get_text() for text in legend.get_texts()]
        kept.legend(legend.legend_handles, names, ncols=2, fontsize=6)
    if abscissa:
        kept.set_xlabel(abscissa)
        kept.tick_params(labelbottom=True)


def main(results, output):
    """Draw the pictures from the folder ``results`` into the folder ``output``."""
    figures = {picture: draw(name, results) for picture, name in WHOLE.items()}
    for picture, (name, number, abscissa) in PANELS.items():
        figures[picture] = draw(name, results)
        keep_panel(figures[picture], number, abscissa)
    for picture, figure in figures.items():
        figure.savefig(Path(output, f"{picture}.png"), dpi=DPI, metadata={"Software": None})


if __name__ == "__main__":
    with style.context():
        main(*sys.argv[1:])
