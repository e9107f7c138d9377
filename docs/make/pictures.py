"""The pictures of README.md and docs, most of one panel, drawn for the size at which one sees them.

    python docs/make/pictures.py results docs

draws them from a finished build of config/config.yaml. Those of README.md have two lines each, and
are so small on paper that their letters are large on a screen.
"""

import re
import sys
from pathlib import Path

from twodiscs.figures import panels, style
from twodiscs.figures.draw import draw as draw_figure
from twodiscs.figures.radius import select_series
from twodiscs.model.scene import Box
from twodiscs_paper.catalogue import ALL_FIGURES, TABLES, read_table
from twodiscs_paper.draw import DRAW
from twodiscs_paper.study import select

#: The box of the pictures and its scene, the first of config/config.yaml.
BOX = Box(1.5, 1.0)
SCENE = "paper"

#: Pictures that are whole figures.
WHOLE = {
    "model": "model",
    "cost": "accuracy_cost",
    "price": "accuracy_cost_by_radius",
    "calibration": "calibration",
    "tori": "tori",
}

#: {picture: (figure, number of the panel, abscissa if it is written beneath another panel)}
PANELS = {
    "mean_hop_time": ("mean_hop_time", 0, "radius $r$ (length)"),
    "tails": ("tails", 0, r"interval $t/\tau$"),
    "hazard": ("distributions", 0, ""),
    "effects": ("effects", 0, "radius $r$ (length)"),
    "passages": ("transmission", 0, ""),
    "more_discs": ("more_discs", 1, "number of discs $N$"),
}

#: Inches of a picture from bottom to top, the place of its panel, dots per inch: two are a pixel.
HEIGHT, PLACE, DPI = 2.5, (0.16, 0.18, 0.76, 0.66), 200


def draw(name, results):
    """Return a figure of the tables in a folder of results, None if one of them is missing."""
    entry, tables = ALL_FIGURES[name], {}
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
    figure.set_size_inches(style.COLUMN_WIDTH, HEIGHT)
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


#: Inches and dots per inch of a picture of README.md.
SMALL, SMALL_DPI = (2.4, 1.9), 268

#: The relative error whose time is shown, {method: its name}.
ERROR, METHODS = 1e-3, {"dynamics": "dynamics", "strips": "strips around the hop"}


def small(title, xlabel, ylabel, **options):
    """Return (figure, axes) of a picture of README.md with a ``title``."""
    figure = style.new_figure(SMALL[1], SMALL[0], layout="constrained")
    axes = figure.subplots()
    axes.set_title(title, loc="left")
    axes.set(xlabel=xlabel, ylabel=ylabel, yscale="log", **options)
    return figure, axes


def draw_hops(results):
    """Draw the mean times between hops against the radius, exact and simulated."""
    names = {f"{hop}_hop_time": f"{hop} hops" for hop in ("vertical", "horizontal")}
    rows = TABLES["mean_times"].read(Path(results, SCENE, "mean_times.csv"))
    rows = [row | {"starts": None} for row in rows]
    radii, series = select_series(BOX, rows, names, {})
    figure, axes = small(
        "Mean time between hops",
        "radius of the discs",
        "time (length/speed)",
        xlim=(0, 0.4),
        ylim=(0.2, 1e12),
    )
    panels.draw_series(axes, None, radii, [*series.values()])
    panels.legend(axes, [*series.values()])
    return figure


def draw_strips(results):
    """Draw the processor time of an error of the time between horizontal hops, near h/4."""
    rows = TABLES["accuracy_cost"].read(Path(results, "accuracy_cost.csv"))
    figure, axes = small(
        f"Time for an error of {100 * ERROR:g} %", "relative distance from $h/4$", "seconds",
        xscale="log", xlim=(1, 5e-7), ylim=(1e-3, 1e11),
    )  # fmt: skip
    for (method, name), look in zip(METHODS.items(), style.SERIES, strict=False):
        own = select(rows, part="radius", quantity="horizontal_hop_time", method=method)
        x, y = ([row[column] for row in own] for column in ("distance", "c"))
        y = [c / ERROR**2 for c in y]
        axes.plot(x, y, lw=0.9, label=name, **panels.open_symbol(*look))
    axes.legend(loc="upper left")
    return figure


def main(results, output):
    """Draw the pictures from the folder ``results`` into the folder ``output``."""
    for picture, draw_small in (("hops", draw_hops), ("strips", draw_strips)):
        path = Path(output, f"{picture}.png")
        draw_small(results).savefig(path, dpi=SMALL_DPI, metadata={"Software": None})
    figures = {picture: draw(name, results) for picture, name in WHOLE.items()}
    for picture, (name, number, abscissa) in PANELS.items():
        figures[picture] = draw(name, results)
        keep_panel(figures[picture], number, abscissa)
    for picture, figure in figures.items():
        figure.savefig(Path(output, f"{picture}.png"), dpi=DPI, metadata={"Software": None})


if __name__ == "__main__":
    with style.context():
        main(*sys.argv[1:])
