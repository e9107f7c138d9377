"""The picture of docs/architecture.md: the folders of both packages and what they import.

python docs/make/architecture.py docs/architecture.svg
"""

import ast
from pathlib import Path
from textwrap import fill

from rules import direct

from twodiscs.arguments import Parser, run
from twodiscs.model.sources import ROOT, imports_of, modules

#: The rooms of the packages from the lowest floor up; one may import those before it, and itself.
LIBRARY = (
    "model", "theory", "points", "sampling", "dynamics", "comparison", "figures", "arguments",
    "cli",
)  # fmt: skip
PAPER = ("study", "errata", "studies", "catalogue", "configuration", "pipeline", "benchmark")
ROOMS = (
    *(f"twodiscs.{room}" for room in LIBRARY), *(f"twodiscs_paper.{room}" for room in PAPER),
)  # fmt: skip

#: Inches: width of the picture and of a room, height of a floor, the gap beneath it, margins.
WIDTH, WIDE, FLOOR, GAP, MARGIN = 7.4, 2.3, 0.86, 0.22, 0.06


def arrows():
    """Return {room: rooms that its modules import, without itself}, in the order of ``ROOMS``."""
    found = {room: set() for room in ROOMS}
    for module in modules():
        if len(module) > 1 and module[1] != "__main__":  # which is the cli
            room = ".".join(module[:2])
            found[room] |= {".".join(target[:2]) for target in imports_of(module)} - {room}
    return {room: [other for other in ROOMS if other in found[room]] for room in ROOMS}


def floors(found):
    """Return {room: number of its floor}: one above the highest room that it imports."""
    height = {}
    for room in ROOMS:
        height[room] = max((height[below] + 1 for below in found[room]), default=0)
    return height


def purpose(room):
    """Return what a room is for, the first sentence of its docstring, and the names in it.

    A room with a catalogue has rooms for its entries, which the catalogue names.
    """
    folder = ROOT.joinpath(*room.split("."))
    path = folder / "__init__.py" if folder.is_dir() else folder.with_suffix(".py")
    text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8")))
    inside = sorted(
        p.stem for p in folder.glob("*") if p.stem != "__init__" and p.suffix in ("", ".py")
    )
    names = [name for name in inside if not name.startswith("__")]
    names = ["catalogue", "…"] if "catalogue" in names else names
    first = text.split("\n")[0].split(". ")[0].rstrip(".").replace("``", "")
    return first, names


def centres(found):
    """Return {room: abscissa}: near the middle of what it imports, clear of others of its floor."""
    from twodiscs.figures.kit.panels import spread

    height, below = floors(found), direct(found)
    middle = {}
    for level in range(max(height.values()) + 1):
        wanted = {}
        for room in (room for room in ROOMS if height[room] == level):
            under = [middle[other] for other in below[room]] or [WIDTH / 2]
            wanted[room] = sum(under) / len(under)
        here = sorted(wanted, key=wanted.get)
        widths = [WIDE] * len(here)
        places = spread([wanted[room] for room in here], widths, GAP / 2, WIDTH - MARGIN)
        inside = max(0, MARGIN + WIDE / 2 - places[0])
        middle |= {room: x + inside for room, x in zip(here, places, strict=True)}
    return middle


def draw():
    """Return the picture as a matplotlib figure."""
    from matplotlib.patches import FancyBboxPatch

    from twodiscs.figures.kit.style import BLUE, GREY, new_figure

    found = arrows()
    height, middle = floors(found), centres(found)
    levels = max(height.values()) + 1
    figure = new_figure(levels * (FLOOR + GAP) + 2 * MARGIN - GAP, WIDTH)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(0, WIDTH), ylim=(0, figure.get_figheight()))
    axes.set_axis_off()
    bottom = {room: MARGIN + height[room] * (FLOOR + GAP) for room in ROOMS}
    for room, below in direct(found).items():
        for other in below:
            ends = [(middle[other], bottom[other] + FLOOR), (middle[room], bottom[room])]
            line = {"arrowstyle": "-|>", "color": GREY, "lw": 0.7, "shrinkA": 0, "shrinkB": 0}
            axes.annotate("", *ends, arrowprops=line, zorder=0)  # behind rooms that it passes
    for room in ROOMS:
        x, y = middle[room], bottom[room]
        axes.add_patch(
            FancyBboxPatch(
                (x - WIDE / 2, y), WIDE, FLOOR, boxstyle="round,pad=0,rounding_size=0.06",
                facecolor="#EAF2F8", edgecolor=BLUE, linewidth=0.8,
            )
        )  # fmt: skip
        says, names = purpose(room)
        text = {"ha": "center", "va": "center", "family": "sans-serif"}
        name = room.removeprefix("twodiscs.")
        axes.text(x, y + FLOOR - 0.12, name, fontsize=9, color=BLUE, **text)
        axes.text(x, y + FLOOR - 0.38, fill(says, 44), fontsize=6.5, **text)
        axes.text(x, y + 0.19, fill("  ".join(names), 50), fontsize=6, color=GREY, **text)
    return figure


def main():
    parser = Parser(description=__doc__.split("\n")[0])
    parser.add_argument("output", type=Path, metavar="SVG")
    options = parser.parse_args()
    import matplotlib

    from twodiscs.figures.kit import style

    with style.context():
        # Text that stays text: small, and searched like the rest of a page.
        matplotlib.rcParams["svg.fonttype"] = "none"
        style.save(draw(), options.output)


if __name__ == "__main__":
    run(main)
