"""Configuration space as a product: a square of x1, x2 and a square of y1, y2."""

from math import sqrt

from matplotlib.patches import Polygon

from twodiscs.figures.kit import drawing
from twodiscs.figures.kit.style import BLACK, BLUE, COLUMN, GREY, VERMILLION, new_figure

#: Radius of the discs, over the shorter side, and x and y of the point shown, over √2 r: each lies
#: where the other one's excluded band does not vanish.
RADIUS = 0.16
POINT = (0.88, 0.72)

#: The place of the point along the diagonal, X or Y, over its largest value at that x or y.
ALONG = (0.28, 0.45)

LEFT, RIGHT, GAP, BOTTOM, TOP = 0.27, 0.1, 0.42, 0.3, 0.28


def draw(box, tables):
    """Draw the two squares of the ``Box``; ``tables`` is not used."""
    width, height = drawing.outline(box)
    radius = RADIUS * min(width, height)
    side = (COLUMN - LEFT - RIGHT - GAP) / 2
    figure = new_figure(BOTTOM + side + TOP)
    halves = (width / 2 - radius, height / 2 - radius)
    for i, (half, colour) in enumerate(zip(halves, (BLUE, VERMILLION), strict=True)):
        left = LEFT + i * (side + GAP)
        axes = drawing.add_axes(figure, left, BOTTOM, side / (2 * half), (-half, half, -half, half))
        name, other = ("x", "y") if i == 0 else ("y", "x")
        band = sqrt(2) * radius * sqrt(1 - POINT[1 - i] ** 2)
        _square(axes, half, band, sqrt(2) * radius, (name, other), "ab"[i])
        depth = POINT[i] * sqrt(2) * radius
        _point(axes, depth, ALONG[i] * (sqrt(2) * half - depth), colour)
    cross = (LEFT + side + 0.13) / COLUMN
    middle = (BOTTOM + side / 2) / figure.get_figheight()
    figure.text(cross, middle, r"$\times$", fontsize=12, ha="center", va="center")
    return figure


def caption(shown):
    """Return the caption."""
    return """
    Configuration space is a product of two squares, one for x1 and x2 and one for y1 and y2,
    without the overlaps of the discs. With x = (x1 − x2)/√2, X = (x1 + x2)/√2 and likewise y and
    Y, discs overlap if x² + y² < 2r². The dotted band of each square is excluded by the point
    shown in the other one; dashed lines are its widest bounds, at ±√2 r. The hatched quarters, in
    which all four coordinates are positive, hold a sixteenth of the volume. Each square is drawn
    to its own scale.
    """


def _turned(across, along):
    """Return (x1, x2) where (x1 − x2)/√2 = ``across`` and (x1 + x2)/√2 = ``along``."""
    return (along + across) / sqrt(2), (along - across) / sqrt(2)


def _strip(axes, half, depth, **options):
    """Fill the part of the square where |x1 − x2|/√2 < ``depth``."""
    d = sqrt(2) * depth
    corners = [(-half, -half), (d - half, -half), (half, half - d)]
    corners += [(-x, -y) for x, y in corners]
    axes.add_patch(Polygon(corners, clip_on=False, **options))


def _square(axes, half, band, widest, names, letter):
    name, other = names
    quarter = [(0, 0), (half, half), (half, -half)]
    axes.add_patch(Polygon(quarter, facecolor="none", edgecolor="#B8B8B8", hatch="////", lw=0))
    _strip(axes, half, band, facecolor="#F3E3B5", edgecolor="none")
    _strip(axes, half, band, facecolor="none", edgecolor="#8C6A00", hatch="....", lw=0)
    _strip(axes, half, widest, facecolor="none", edgecolor=GREY, lw=0.5, ls=(0, (3, 2)))
    drawing.rectangle(axes, -half, half, -half, half, width=0.9)

    tip = sqrt(2) * half
    capital = name.upper()
    drawing.arrow(axes, (0, 0), _turned(0, 0.93 * tip), width=0.6, size=6)
    drawing.arrow(axes, (0, 0), _turned(0.93 * tip, 0), width=0.6, size=6)
    white = {"facecolor": "white", "edgecolor": "none", "pad": 0.6}
    drawing.label(axes, f"${capital}$", _turned(0, 0.66 * tip), (6, -4), bbox=white)
    drawing.label(axes, f"${name}$", _turned(0.8 * tip, 0), (3, 6), bbox=white)

    drawing.label(axes, f"${name}_1$", (0, -half), (0, -9))
    drawing.label(axes, f"${name}_2$", (-half, 0), (-10, 0))
    for end, text in ((-half, f"$-{letter}$"), (half, f"${letter}$")):
        drawing.label(axes, text, (end, -half), (0, -8))
        drawing.label(axes, text, (-half, end), (-9, 0))
    inside = rf"$|{name}|<\sqrt{{2r^2-{other}^2}}$"
    drawing.label(axes, inside, (0.3 * half, half), (0, 10))
    at = _turned(-0.5 * band, 0.8 * tip)
    drawing.line(axes, [(0.3 * half, 1.07 * half), at], colour=BLACK, width=0.5)


def _point(axes, depth, along, colour):
    """Mark a point and its distance ``depth`` from the diagonal."""
    point, foot = _turned(depth, along), _turned(0, along)
    drawing.arrow(axes, foot, point, "-", colour=colour, width=1)
    axes.plot(*point, "o", color=colour, markersize=3.4, clip_on=False)
