"""The picture of docs/engine.md: events per second against the number of discs.

    python docs/make/speed.py results/benchmark.csv docs/speed.png

draws it from the table of ``snakemake benchmark``.
"""

import re
from pathlib import Path

from pictures import DPI, HEIGHT, TOP

from twodiscs.arguments import Parser, run
from twodiscs.figures.kit import panels, style
from twodiscs_paper.studies.effects.study import Benchmark

#: {end of a variant's name: (colour, marker, name in the legend)}.
LOOKS = {
    "": (style.BLUE, "o", "all hops counted"),
    "_without_hops": (style.VERMILLION, "s", "no hop counted"),
}

#: Number of discs and collisions per second of F. Smallenburg's program for hard spheres.
PUBLISHED = 256, 5.3e5


def draw(rows):
    """Draw ``rows`` of benchmark.csv."""
    figure = style.new_figure(HEIGHT)
    axes = panels.add_panel(figure, panels.BOTTOM, HEIGHT - panels.BOTTOM - TOP)
    own = [row for row in rows if row["benchmark"] == "md_events_per_second_by_number"]
    (two,) = (row["value"] for row in own if row["variant"] == "lockstep")
    axes.plot(
        [2], [two], ls="", label="engine of two discs", **panels.open_symbol(style.GREEN, "D")
    )
    for end, (colour, marker, name) in LOOKS.items():
        found = [(re.fullmatch(rf"discs_(\d+){end}", row["variant"]), row["value"]) for row in own]
        points = [(int(match[1]), value) for match, value in found if match]
        axes.plot(*zip(*points, strict=True), label=name, **panels.open_symbol(colour, marker))
    axes.plot(
        *([value] for value in PUBLISHED), ls="", color=style.BLACK, marker="x",
        label="published, 3 dimensions, no hops",
    )  # fmt: skip
    axes.set(xscale="log", yscale="log", xlim=(1.5, 1500), ylim=(2e5, 1e9))
    numbers = [2, 3, 8, 16, 64, 256, 1024]
    axes.set_xticks(numbers, [str(number) for number in numbers])
    axes.minorticks_off()
    axes.set(xlabel="number of discs $N$", ylabel="events per second")
    axes.legend(loc="upper right")
    return figure


def main():
    parser = Parser(description=__doc__.split("\n")[0])
    parser.add_argument("table", type=Path, help="benchmark.csv")
    parser.add_argument("output", type=Path, help="the picture")
    options = parser.parse_args()
    with style.context():
        figure = draw(Benchmark.read(options.table))
        figure.savefig(options.output, dpi=DPI, metadata={"Software": None})


if __name__ == "__main__":
    run(main)
