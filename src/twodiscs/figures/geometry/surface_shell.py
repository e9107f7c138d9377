"""The shells of thickness ε around two surfaces in configuration space: a hop and a collision."""

from math import sqrt

from matplotlib.patches import Arc, Polygon, Wedge

from twodiscs.figures.kit import drawing
from twodiscs.figures.kit.style import BLUE, COLUMN, GREY, VERMILLION, new_figure

#: Radius of the discs and thickness of the shell, over the shorter side.
RADIUS = 0.2
THICKNESS = 0.06

#: Longer boxes are drawn shorter: the shells are at one end of them.
LONGEST = 1.5

LEFT, GAP, RIGHT, BELOW, ABOVE = 0.3, 0.42, 0.08, 0.3, 0.26

#: The largest height of the panels, in inches.
TALLEST = 1.5


def draw(box):
    """Draw the shells in the ``Box``."""
    width, height = drawing.outline(box, LONGEST)
    short = min(width, height)
    radius, epsilon = RADIUS * short, THICKNESS * short
    a, b = width / 2 - radius, height / 2 - radius
    room = COLUMN - LEFT - GAP - RIGHT
    side = min(room / (1 + a / b), TALLEST)
    left = LEFT + (room - side * (1 + a / b)) / 2
    figure = new_figure(BELOW + side + ABOVE)
    square = drawing.add_axes(figure, left, BELOW, side / (2 * b), (-b, b, -b, b))
    _hop(square, b, epsilon)
    extent = (0, sqrt(2) * a, 0, sqrt(2) * b)
    quarter = drawing.add_axes(figure, left + side + GAP, BELOW, side / (sqrt(2) * b), extent)
    _collision(quarter, a, b, radius, epsilon)
    return figure


def _hop(axes, b, epsilon):
    """Draw the square of y1, y2 with the surface y1 = y2 and its shell, which has two sides."""
    d = sqrt(2) * epsilon
    corners = [(-b, -b), (d - b, -b), (b, b - d)]
    corners += [(-x, -y) for x, y in corners]
    axes.add_patch(Polygon(corners, facecolor="#DCEBF5", edgecolor="none"))
    for shift in (-d, d):
        ends = [(max(-b, shift - b), max(-b, -shift - b)), (min(b, b + shift), min(b, b - shift))]
        drawing.line(axes, ends, width=0.5, style=(0, (3, 2)))
    drawing.line(axes, [(-b, -b), (b, b)], colour=BLUE, width=1.3)
    drawing.rectangle(axes, -b, b, -b, b, width=0.9)
    drawing.label(axes, "(a)", (-b, b), (0, 9), ha="left")
    drawing.label(axes, "$y_1=y_2$", (-b, b), (18, 9), ha="left", color=BLUE)
    drawing.label(axes, "$y_1$", (0, -b), (0, -9))
    drawing.label(axes, "$y_2$", (-b, 0), (-9, 0))
    for end, name in ((-b, "$-b$"), (b, "$b$")):
        drawing.label(axes, name, (end, -b), (0, -8))
        drawing.label(axes, name, (-b, end), (-9, 0))

    # ε is a distance in configuration space; along an axis the shell is √2 times wider.
    c, h = -0.3 * b, epsilon / sqrt(2)
    drawing.arrow(axes, (c, c), (c + h, c - h), width=0.8, size=6)
    drawing.label(axes, r"$\varepsilon$", (c + h, c - h), (5, -4))
    y = 0.4 * b
    drawing.arrow(axes, (y, y), (y - d, y), "<|-|>", width=0.6, size=5)
    drawing.label(axes, r"$\sqrt{2}\,\varepsilon$", (y - d, y), (-12, 1))


def _collision(axes, a, b, radius, epsilon):
    """Draw the quarter plane of x, y with the circle of contact and its shell, on one side."""
    wide, high, rim = sqrt(2) * a, sqrt(2) * b, sqrt(2) * radius
    sector = {"facecolor": "white", "edgecolor": GREY, "hatch": "/////", "linewidth": 0}
    axes.add_patch(Wedge((0, 0), rim, 0, 90, **sector))
    shell = {"width": epsilon, "facecolor": "#F8DDC8", "edgecolor": "none"}
    axes.add_patch(Wedge((0, 0), rim + epsilon, 0, 90, **shell))
    dashed = {"linewidth": 0.5, "linestyle": (0, (3, 2)), "edgecolor": GREY}
    for reach, pen in ((rim + epsilon, dashed), (rim, {"linewidth": 1.3, "edgecolor": VERMILLION})):
        axes.add_patch(Arc((0, 0), 2 * reach, 2 * reach, theta2=90, **pen))
    drawing.rectangle(axes, 0, wide, 0, high, width=0.9)
    drawing.label(axes, "(b)", (0, high), (0, 9), ha="left")
    drawing.label(axes, "$x^2+y^2=2r^2$", (0, high), (18, 9), ha="left", color=VERMILLION)
    drawing.label(axes, "$x$", (wide / 2 if a > b / 2 else wide / 4, 0), (0, -9))
    drawing.label(axes, "$y$", (0, high / 2), (-8, 0))
    drawing.label(axes, r"$\sqrt{2}\,a$", (wide, 0), (3, -9), ha="right")
    drawing.label(axes, r"$\sqrt{2}\,b$", (0, high), (-3, 0), ha="right")
    drawing.label(axes, "$0$", (0, 0), (-5, -6))

    c, s = 0.8, 0.6
    drawing.arrow(axes, (0, 0), (c * rim, s * rim), width=0.6, size=5)
    white = {"facecolor": "white", "edgecolor": "none", "pad": 0.3}
    drawing.label(axes, r"$\sqrt{2}\,r$", (c * rim / 2, s * rim / 2), (0, 0), bbox=white)
    c, s = 0.6, 0.8
    tail, head = (c * rim, s * rim), (c * (rim + epsilon), s * (rim + epsilon))
    drawing.arrow(axes, tail, head, width=0.8, size=6)
    drawing.label(axes, r"$\varepsilon$", head, (4, 5))
