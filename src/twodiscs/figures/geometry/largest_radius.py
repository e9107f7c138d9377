"""The largest radius: the jammed discs, and the possible hops at any radius in any box."""

from itertools import pairwise
from math import hypot

from matplotlib.ticker import MultipleLocator

from twodiscs.figures.kit import drawing, panels
from twodiscs.figures.kit.style import BLACK, COLUMN, GREY, new_figure
from twodiscs.model.box import Box

#: Inches: the tallest drawing of the box, the space around it, the map beneath and its margins.
TALLEST, LEFT, RIGHT, ABOVE, BENEATH = 1.75, 0.34, 0.58, 0.08, 0.42
MAP_LEFT, MAP_RIGHT, MAP_BOTTOM, MAP_HEIGHT = 0.48, 0.1, 0.36, 1.5


def draw(box):
    """Draw the ``Box`` with discs that just fit, and the map."""
    width, height = drawing.outline(box)
    inches = drawing.scale(width, height, COLUMN - LEFT - RIGHT, TALLEST)
    floor = MAP_BOTTOM + MAP_HEIGHT + BENEATH
    figure = new_figure(floor + inches * height + ABOVE)
    extent = (-width / 2, width / 2, -height / 2, height / 2)
    left = LEFT + (COLUMN - LEFT - RIGHT - inches * width) / 2
    _jammed(drawing.add_axes(figure, left, floor, inches, extent), width, height)
    across = COLUMN - MAP_LEFT - MAP_RIGHT
    _map(panels.add_panel(figure, MAP_BOTTOM, MAP_HEIGHT, MAP_LEFT, across), box)
    return figure


def _jammed(axes, width, height):
    """Draw the discs at the largest radius, disc 1 in the lower left corner."""
    radius = Box(width, height).largest_radius
    a, b = width / 2 - radius, height / 2 - radius
    right, top = width / 2, height / 2
    drawing.disc(axes, 1, (-a, -b), radius)
    drawing.disc(axes, 2, (a, b), radius)
    drawing.rectangle(axes, -right, right, -top, top, width=1.2)
    drawing.label(axes, "(a)", (-right, top), (-5, 0), ha="right", va="top")

    _side(axes, "w", right, a, lambda x, away: (x, -top - away), (0, -7))
    _side(axes, "h", top, b, lambda y, away: (right + away, y), (4, 0), ha="left")
    if a > 0 and b > 0:
        legs = [(-a, -b), (a, -b), (a, b)]
        drawing.line(axes, legs, BLACK, 0.6, (0, (3, 2)))
        drawing.line(axes, [(-a, -b), (a, b)], BLACK, 0.9)
        away = 6 / hypot(a, b)
        drawing.label(axes, "$2r$", (-a / 2, -b / 2), (-away * b, away * a))


def _side(axes, name, end, centre, at, offset, **align):
    """Draw the dimension lines of a side from −``end`` to ``end``, with centres at ±``centre``.

    ``at(along, away)`` returns the point at this distance along the side and away from it.
    """
    point = drawing.points(axes)
    near, far = 4 * point, 11 * point
    stops, names = (-end, end), (f"{name}=2r",)
    if centre > 0:
        stops, names = (-end, -centre, centre, end), ("r", f"{name}-2r", "r")
        for stop in stops:
            drawing.line(axes, [at(stop, near), at(stop, far)], BLACK, 0.4)
    for (start, stop), text in zip(pairwise(stops), names, strict=True):
        drawing.dimension(axes, at(start, far), at(stop, far), f"${text}$", offset, **align)


def _map(axes, box):
    """Draw the regimes over the shape of the box, lengths in its short side, and mark this box."""
    width, height = box.width, box.height
    wide = width >= height
    long, short, hops = ("w", "h", "vertical") if wide else ("h", "w", "horizontal")
    shape = max(width, height) / min(width, height)
    last = 3.4

    # Up to the aspect ratio 2 the discs jam along a diagonal, beyond it they span the short side.
    bent = [1 + i / 100 for i in range(101)]
    passing = [x / 4 for x in bent]
    largest = [Box(x, 1).largest_radius for x in bent]
    pieces = ([*bent, last], [*passing, 0.5])
    axes.fill_between([1, last], 0.25, color="#DCEBF5", lw=0)
    axes.fill_between(*pieces, 0.25, color="#F3E3B5", lw=0)
    axes.fill_between(bent, passing, largest, color="#F8DDC8", lw=0)
    axes.plot([1, last], [0.25, 0.25], color=BLACK, lw=0.6)
    axes.plot(bent, passing, color=BLACK, lw=0.6)
    axes.plot([*bent, last], [*largest, 0.5], color=BLACK, lw=1.2)

    end = box.largest_radius / box.shortest
    if shape < last:
        axes.plot([shape, shape], [0, end], color=GREY, lw=0.8, ls=(0, (3, 2)), clip_on=False)
        axes.plot(shape, end, "o", color=BLACK, clip_on=False, zorder=5)
    else:
        drawing.arrow(axes, (last - 0.25, 0.46), (last, 0.46))
        drawing.label(axes, f"${long}/{short}={shape:g}$", (last - 0.25, 0.46), (-4, 0), ha="right")
    axes.set(xlim=(1, last), ylim=(0, 0.6), xlabel=f"${long}/{short}$", ylabel=f"$r/{short}$")
    axes.xaxis.set_major_locator(MultipleLocator(0.5))
    drawing.label(
        axes, "(b)", (0, 1), (2 - 72 * MAP_LEFT, 3), ha="left", va="top", xycoords="axes fraction"
    )
    clear = 2.3 if shape > 2.45 else 2.9
    drawing.label(axes, "both hops", (clear, 0.125))
    drawing.label(axes, f"{hops} hops", (clear, 0.375))
    drawing.label(axes, f"$r={short}/4$", (1, 0.25), (5, -7), ha="left")
    drawing.label(axes, rf"$r_{{\mathrm{{max}}}}={short}/2$", (last, 0.5), (-4, 7), ha="right")
    drawing.arrow(axes, (1.16, 0.47), (1.12, 0.302), "-", width=0.5)
    drawing.label(axes, "no hops", (1, 0.47), (5, 5), ha="left")
    drawing.label(axes, f"$r={long}/4$", (1.6, 0.4), (3, -9), ha="left")
