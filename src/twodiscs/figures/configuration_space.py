"""Configuration space: a section in three dimensions, and the whole as a product of two squares."""

from itertools import pairwise, product
from math import cos, pi, radians, sin, sqrt

import numpy as np
from matplotlib.patches import Polygon

from twodiscs.figures import drawing
from twodiscs.figures.style import BLACK, BLUE, COLUMN_WIDTH, GREY, VERMILLION, new_figure

#: The direction of view of the prism, in degrees around the vertical and above the horizon.
AZIMUTH, ELEVATION = -112.0, 24.0

#: Strips of the cylinder.
CYLINDER_STRIPS = 60


def draw(box):
    """Draw the two squares of the ``Box``."""
    width, height = drawing.outline(box)
    radius = 0.16 * min(width, height)
    # Inches: around and between the squares, and between them and the prism.
    margin, gap, bottom, top, between = 0.27, 0.42, 0.3, 0.28, 0.42
    side = (COLUMN_WIDTH - margin - 0.1 - gap) / 2
    halves = (width / 2 - radius, height / 2 - radius)
    corners = [_seen(corner) for corner in product(*((-n, n) for n in _sizes(halves)))]
    x, y = zip(*corners, strict=True)
    extent = (min(x), max(x), min(y), max(y))
    wide, high = max(x) - min(x), max(y) - min(y)
    inches, spare = drawing.scale(wide, high, COLUMN_WIDTH - 2 * margin, 1.7)
    squares = bottom + side + top
    figure = new_figure(squares + between + inches * high)
    floor = squares + between - top / 2
    axes = drawing.add_axes(figure, margin + spare, floor, inches, extent)
    _prism(axes, halves, sqrt(2) * radius)
    for text, at in (("(a)", squares + between + inches * high - 0.08), ("(b)", squares)):
        figure.text(0.01, (at - 0.02) / figure.get_figheight(), text, va="top")
    # x and y of the point over √2 r: neither excluded band vanishes there.
    point = (0.88, 0.72)
    for i, (half, colour) in enumerate(zip(halves, (BLUE, VERMILLION), strict=True)):
        left = margin + i * (side + gap)
        axes = drawing.add_axes(figure, left, bottom, side / (2 * half), (-half, half, -half, half))
        name, other = ("x", "y") if i == 0 else ("y", "x")
        band = sqrt(2) * radius * sqrt(1 - point[1 - i] ** 2)
        _square(axes, half, band, sqrt(2) * radius, (name, other), "ab"[i])
        depth = point[i] * sqrt(2) * radius
        # X and Y of the point, its positions along the diagonals, over their largest values.
        _point(axes, depth, (0.28, 0.45)[i] * (sqrt(2) * half - depth), colour)
    cross = (margin + side + 0.13) / COLUMN_WIDTH
    middle = (bottom + side / 2) / figure.get_figheight()
    figure.text(cross, middle, r"$\times$", fontsize=12, ha="center", va="center")
    return figure


def _sizes(halves):
    """Return half of the sides of the prism, along x1, x2 and y."""
    return halves[0], halves[0], sqrt(2) * halves[1]


def _seen(point):
    """Return where a point (x1, x2, y) is on the page."""
    a, e = radians(AZIMUTH), radians(ELEVATION)
    forward = cos(a) * point[0] + sin(a) * point[1]
    return cos(a) * point[1] - sin(a) * point[0], cos(e) * point[2] - sin(e) * forward


def _towards(direction):
    """Return the component of a ``direction`` towards the viewer."""
    a, e = radians(AZIMUTH), radians(ELEVATION)
    return cos(e) * (cos(a) * direction[0] + sin(a) * direction[1]) + sin(e) * direction[2]


def _prism(axes, halves, radius):
    """Draw the prism, with edges that it hides dashed, and the cylinder of a ``radius`` in it."""
    sizes = _sizes(halves)
    _cylinder(axes, sqrt(2) * halves[0], radius)
    for corner, axis in product(product((-1, 1), repeat=3), (2, 1, 0)):
        if corner[axis] > 0:  # the other end of an edge
            continue
        ends = corner, (*corner[:axis], 1, *corner[axis + 1 :])
        edge = [_seen(np.multiply(end, sizes)) for end in ends]
        # An edge is hidden if both faces that meet in it look away.
        faces = [np.eye(3)[k] * corner[k] for k in range(3) if k != axis]
        if max(map(_towards, faces)) < 0:
            drawing.line(axes, edge, style=(0, (3, 2)), zorder=0)
        else:
            drawing.line(axes, edge, colour=BLACK, width=0.8)
    # Along the lower edges that are nearest, and the upright one on the left.
    drawing.label(axes, "$x_1$", _seen((0, -sizes[1], -sizes[2])), (0, -8))
    side = 1 if _towards((1, 0, 0)) > 0 else -1
    drawing.label(axes, "$x_2$", _seen((side * sizes[0], 0, -sizes[2])), (-9, -5))
    drawing.label(axes, "$y$", _seen((-side * sizes[0], -sizes[1], 0)), (8, 0))


def _cylinder(axes, half_length, radius):
    """Draw the cylinder around the diagonal, ``half_length`` long to either side."""
    angles = np.linspace(0, 2 * pi, CYLINDER_STRIPS + 1)

    def rim(angle, end):
        across = radius * cos(angle)
        along = end * (half_length - abs(across))
        return _seen((*_turned(across, along), radius * sin(angle)))

    # Colours of the side in the shade and of the side in the light.
    dark, light = np.array((0.72, 0.60, 0.32)), np.array((0.99, 0.95, 0.82))
    for angle, later in pairwise(angles):
        middle = (angle + later) / 2
        facing = _towards((*_turned(cos(middle), 0), sin(middle)))
        if facing > 0:
            corners = [rim(angle, -1), rim(later, -1), rim(later, 1), rim(angle, 1)]
            colour = tuple(dark + (light - dark) * facing)
            axes.add_patch(Polygon(corners, color=colour, lw=0.3, clip_on=False))
    # The two halves of an end lie in two faces of the prism: x1 > x2 on the right.
    for end, is_right in product((-1, 1), (True, False)):
        first = -pi / 2 if is_right else pi / 2
        half = [rim(angle, end) for angle in np.linspace(first, first + pi, CYLINDER_STRIPS)]
        if _towards((end, 0, 0) if is_right == (end > 0) else (0, end, 0)) > 0:
            axes.add_patch(Polygon(half, fc="#E2CF95", ec=BLACK, lw=0.6, clip_on=False))
        else:
            drawing.line(axes, half, colour=GREY, width=0.4, style=(0, (3, 2)))


def _turned(across, along):
    """Return (x1, x2) with (x1 − x2)/√2 = ``across`` and (x1 + x2)/√2 = ``along``."""
    return (along + across) / sqrt(2), (along - across) / sqrt(2)


def _square(axes, half, band, widest, names, letter):
    name, other = names
    quarter = [(0, 0), (half, half), (half, -half)]
    axes.add_patch(Polygon(quarter, facecolor="none", edgecolor="#B8B8B8", hatch="////", lw=0))
    drawing.band(axes, half, band, facecolor="#F3E3B5", edgecolor="none")
    drawing.band(axes, half, band, facecolor="none", edgecolor="#8C6A00", hatch="....", lw=0)
    drawing.band(axes, half, widest, facecolor="none", edgecolor=GREY, lw=0.5, ls=(0, (3, 2)))
    drawing.rectangle(axes, -half, half, -half, half, width=0.9)

    tip = sqrt(2) * half
    capital = name.upper()
    drawing.arrow(axes, (0, 0), _turned(0, 0.93 * tip), width=0.6, size=6)
    drawing.arrow(axes, (0, 0), _turned(0.93 * tip, 0), width=0.6, size=6)
    white = {"facecolor": "white", "edgecolor": "none", "pad": 0.6}
    drawing.label(axes, f"${capital}$", _turned(0, 0.66 * tip), (6, -4), bbox=white)
    drawing.label(axes, f"${name}$", _turned(0.8 * tip, 0), (3, 6), bbox=white)

    drawing.name_sides(axes, half, name, letter, -10)
    inside = rf"$|{name}|<\sqrt{{2r^2-{other}^2}}$"
    drawing.label(axes, inside, (0.3 * half, half), (0, 10))
    at = _turned(-0.5 * band, 0.8 * tip)
    drawing.line(axes, [(0.3 * half, 1.07 * half), at], colour=BLACK, width=0.5)


def _point(axes, depth, along, colour):
    """Mark a point and its distance ``depth`` from the diagonal."""
    point, foot = _turned(depth, along), _turned(0, along)
    drawing.arrow(axes, foot, point, "-", colour=colour, width=1)
    axes.plot(*point, "o", color=colour, markersize=3.4, clip_on=False)
