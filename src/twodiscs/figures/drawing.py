"""Drawings to scale: panels, dimension lines, discs.

A panel's coordinates are lengths of the box. Positions on the page are in inches. The distance of a
label from its object is in points.
"""

from itertools import pairwise
from math import sqrt

from matplotlib.patches import Circle, Polygon, Rectangle

from twodiscs.figures.style import BLACK, BLUE, GREY, VERMILLION

#: Fill and outline of disc 1 and disc 2.
DISC_COLOURS = (("#CFE3F1", BLUE), ("#F8DDC8", VERMILLION))


def outline(box, longest=4):
    """Return the sides of a drawn ``Box``, the longer cut to ``longest`` times the shorter.

    A box of 4:1 shows everything that longer boxes show.
    """
    return min(box.width, longest * box.height), min(box.height, longest * box.width)


def scale(width, height, room_x, room_y):
    """Return (inches per unit, inches to the left) of ``width`` × ``height`` in some inches."""
    inches = min(room_x / width, room_y / height)
    return inches, (room_x - inches * width) / 2


def add_axes(figure, left, bottom, inches, extent):
    """Add a panel without frame and ticks and return its axes.

    Its lower left corner is ``left``, ``bottom`` inches from the figure's, one unit is ``inches``
    long, and ``extent`` is (x0, x1, y0, y1). Lines may cross its edges.
    """
    x0, x1, y0, y1 = extent
    across, up = figure.get_size_inches()
    size = inches * (x1 - x0) / across, inches * (y1 - y0) / up
    axes = figure.add_axes((left / across, bottom / up, *size))
    axes.set(xlim=(x0, x1), ylim=(y0, y1))
    axes.set_axis_off()
    return axes


def label(axes, text, at, offset=(0, 0), **options):
    """Write ``text`` centred at ``offset`` points from the point ``at``."""
    settings = {"ha": "center", "va": "center", "annotation_clip": False} | options
    return axes.annotate(text, at, offset, textcoords="offset points", **settings)


def arrow(axes, tail, head, style="-|>", colour=BLACK, width=0.7, size=7, **options):
    """Draw a straight arrow between two points."""
    properties = {"arrowstyle": style, "color": colour, "linewidth": width, "mutation_scale": size}
    properties |= {"shrinkA": 0, "shrinkB": 0}
    axes.annotate("", head, tail, arrowprops=properties, annotation_clip=False, **options)


def line(axes, points, colour=GREY, width=0.5, style="-", **options):
    """Draw a line through ``points``, without clipping."""
    settings = {"color": colour, "linewidth": width, "linestyle": style, "clip_on": False} | options
    axes.plot(*zip(*points, strict=True), **settings)


def rectangle(axes, x0, x1, y0, y1, edge=BLACK, face="none", width=0.8, **options):
    """Draw the rectangle [x0, x1] × [y0, y1]."""
    settings = {"edgecolor": edge, "facecolor": face, "linewidth": width, "clip_on": False}
    axes.add_patch(Rectangle((x0, y0), x1 - x0, y1 - y0, **settings | options))


def band(axes, half, depth, **options):
    """Fill the part of a square of ±``half`` within a distance ``depth`` of its diagonal."""
    d = sqrt(2) * depth
    corners = [(-half, -half), (d - half, -half), (half, half - d)]
    corners += [(-x, -y) for x, y in corners]
    axes.add_patch(Polygon(corners, clip_on=False, **options))


def name_sides(axes, half, name, end, left):
    """Name the coordinates of disc 1 and 2 along a square, and its ends, ±``end``.

    The name on the left is ``left`` points from the square.
    """
    label(axes, f"${name}_1$", (0, -half), (0, -9))
    label(axes, f"${name}_2$", (-half, 0), (left, 0))
    for at, text in ((-half, f"$-{end}$"), (half, f"${end}$")):
        label(axes, text, (at, -half), (0, -8))
        label(axes, text, (-half, at), (-9, 0))


def dimensions(axes, at, stops, texts, offset, marked=True, beyond=0, **options):
    """Draw dimension lines between successive ``stops`` along a side, with their ``texts``.

    ``at(along, away)`` is the point at this distance along the side and away from it. If stops are
    ``marked``, they have thin lines, which go on ``beyond`` the dimension by some points.
    """
    point = points(axes)
    near, far = 4 * point, 11 * point
    for stop in stops if marked else ():
        line(axes, [at(stop, near), at(stop, far + beyond * point)], BLACK, 0.4)
    for (start, stop), text in zip(pairwise(stops), texts, strict=True):
        arrow(axes, at(start, far), at(stop, far), "<|-|>", width=0.5, size=5)
        label(axes, f"${text}$", at((start + stop) / 2, far), offset, **options)


def disc(axes, number, centre, radius):
    """Draw disc 1 or 2 with a dot at its centre."""
    face, edge = DISC_COLOURS[number - 1]
    settings = {"edgecolor": edge, "linewidth": 0.8, "clip_on": False}
    axes.add_patch(Circle(centre, radius, facecolor=face, **settings))
    axes.plot(*centre, ".", color=edge, markersize=3, clip_on=False)


def points(axes):
    """Return the length in the box that corresponds to one point on the page."""
    x0, x1 = axes.get_xlim()
    inches = axes.get_position().width * axes.figure.get_figwidth()
    return (x1 - x0) / (72 * inches)
