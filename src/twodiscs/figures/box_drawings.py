"""Drawings of the box, of its largest radius and of surfaces in configuration space."""

from itertools import pairwise
from math import acos, asin, copysign, cos, degrees, hypot, pi, sin, sqrt

from matplotlib.lines import Line2D
from matplotlib.patches import Arc, Polygon, Wedge
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MultipleLocator

from twodiscs.figures import drawing, panels
from twodiscs.figures.curves import limits
from twodiscs.figures.style import BLACK, BLUE, COLUMN_WIDTH, GREY, VERMILLION, new_figure
from twodiscs.model.scene import Box

#: The white rim of a label that may stand on a line.
LABEL_RIM = {"path_effects": [withStroke(linewidth=2, foreground="w")]}

#: The look of a sector of discs that overlap.
OVERLAP_LOOK = {"facecolor": "white", "edgecolor": GREY, "hatch": "/////", "linewidth": 0}

# The billiard -------------------------------------------------------------------------------------


def draw_model(box):
    """Draw two discs in the ``Box``."""
    width, height = drawing.outline(box)
    radius = 0.13 * min(width, height)
    a, b = width / 2 - radius, height / 2 - radius
    right, top = width / 2, height / 2
    # Inches: margins of 0.3, and 0.34 on the right.
    inches, spare = drawing.scale(width, height, COLUMN_WIDTH - 0.3 - 0.34, 3.6 - 0.3 - 0.3)
    figure = new_figure(0.3 + 0.3 + inches * height)
    axes = drawing.add_axes(figure, 0.3 + spare, 0.3, inches, (-right, right, -top, top))

    drawing.rectangle(axes, -right, right, -top, top, width=1.2)
    drawing.rectangle(axes, -a, a, -b, b, edge=GREY, width=0.6, linestyle=(0, (4, 2.5)))
    # The axes x and y at the centre of the box.
    length = 0.14 * min(width, height)
    for head, name, offset in (((length, 0), "$x$", (4, -3)), ((0, length), "$y$", (-4, 2))):
        drawing.arrow(axes, (0, 0), head, width=0.6, size=6)
        drawing.label(axes, name, head, offset)
    drawing.label(axes, "$0$", (0, 0), (-4, -4))
    # Centres over a and b, velocities in radii: clear of each other and of the origin in any box.
    for number, x, y, u, v in ((1, -0.45, -0.52, 0.7, 1.6), (2, 0.45, 0.5, 0.95, -1.3)):
        _disc(axes, number, (x * a, y * b), radius, (radius * u, radius * v))

    tall = height > width / 2
    for at, stops, text, offset, turn in (
        (lambda x, away: (x, -top - away), (-right, right), "w", (0, -6), 0),
        (lambda y, away: (-right - away, y), (-top, top), "h", (-6, 0), 0),
        (lambda x, away: (x, top + away), (0, a), "a=w/2-r", (0, 6), 0),
        (lambda y, away: (right + away, y), (0, b), "b=h/2-r" if tall else "b", (7, 0), 90 * tall),
    ):
        drawing.dimensions(axes, at, stops, [text], offset, beyond=4, rotation=turn, **LABEL_RIM)
    return figure


def _disc(axes, number, centre, radius, velocity):
    """Draw a disc with its radius and its velocity, their names beside it."""
    x, y = centre
    colour = drawing.DISC_COLOURS[number - 1][1]
    drawing.disc(axes, number, centre, radius)
    drawing.arrow(axes, centre, (x - radius, y), width=0.5, size=5)
    drawing.label(axes, "$r$", (x - radius, y), (-5, 0), **LABEL_RIM)
    head = (x + velocity[0], y + velocity[1])
    size = hypot(*velocity) / 6
    drawing.arrow(axes, centre, head, colour=colour, width=1)
    beyond = (velocity[0] / size, velocity[1] / size)
    drawing.label(axes, rf"$\mathbf{{v}}_{number}$", head, beyond, **LABEL_RIM)
    # On the side towards the middle of the box, which is empty.
    rim = (x - 0.6 * radius, y + copysign(0.8 * radius, velocity[1]))
    offset = (-4, copysign(5, velocity[1]))
    drawing.label(axes, rf"$\mathbf{{x}}_{number}$", rim, offset, **LABEL_RIM)


# The largest radius -------------------------------------------------------------------------------


#: Inches to the left of the map.
MAP_MARGIN = 0.48


def draw_largest_radius(box):
    """Draw the ``Box`` with discs that just fit, and the map."""
    width, height = drawing.outline(box)
    # Inches: the largest drawing of the box, and its floor above the map.
    inches, spare = drawing.scale(width, height, COLUMN_WIDTH - 0.34 - 0.58, 1.75)
    floor = 0.36 + 1.5 + 0.42
    figure = new_figure(floor + inches * height + 0.08)
    extent = (-width / 2, width / 2, -height / 2, height / 2)
    axes = drawing.add_axes(figure, 0.34 + spare, floor, inches, extent)
    _jammed(axes, width, height)
    _map(panels.add_panel(figure, 0.36, 1.5, MAP_MARGIN, COLUMN_WIDTH - MAP_MARGIN - 0.1), box)
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
    stops, names = (-end, end), (f"{name}=2r",)
    if centre > 0:
        stops, names = (-end, -centre, centre, end), ("r", f"{name}-2r", "r")
    drawing.dimensions(axes, at, stops, names, offset, marked=centre > 0, **align)


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
        axes.plot(shape, end, "o", color=BLACK, clip_on=False, zorder=5, label="this box")
        axes.legend(loc="lower left" if shape > 2.5 else "lower right", handlelength=1)
    else:
        drawing.arrow(axes, (last - 0.25, 0.46), (last, 0.46))
        drawing.label(axes, f"${long}/{short}={shape:g}$", (last - 0.25, 0.46), (-4, 0), ha="right")
    axes.set(xlim=(1, last), ylim=(0, 0.6), xlabel=f"${long}/{short}$", ylabel=f"$r/{short}$")
    axes.xaxis.set_major_locator(MultipleLocator(0.5))
    corner = {"xycoords": "axes fraction", "ha": "left", "va": "top"}
    drawing.label(axes, "(b)", (0, 1), (2 - 72 * MAP_MARGIN, 3), **corner)
    clear = 2.3 if shape > 2.45 else 2.9
    drawing.label(axes, "both hops", (clear, 0.125))
    drawing.label(axes, f"{hops} hops", (clear, 0.375))
    drawing.label(axes, f"$r={short}/4$", (1, 0.25), (5, -7), ha="left")
    drawing.label(axes, rf"$r_{{\mathrm{{max}}}}={short}/2$", (last, 0.5), (-4, 7), ha="right")
    drawing.arrow(axes, (1.16, 0.47), (1.12, 0.302), "-", width=0.5)
    drawing.label(axes, "no hops", (1, 0.47), (5, 5), ha="left")
    drawing.label(axes, f"$r={long}/4$", (1.6, 0.4), (3, -9), ha="left")


# The regimes of the integration -------------------------------------------------------------------


#: {regime: (its name, the radius drawn as a fraction of the way between the regime's limits)}
REGIME_PANELS = {
    "all-hops": ("both hops", 0.55),
    "vertical-hops": ("vertical hops", 0.5),
    "horizontal-hops": ("horizontal hops", 0.5),
    "no-hops": ("no hops", 0.3),
}


def draw_regimes(box):
    """Draw one panel for each regime of the ``Box``."""
    shown = Box(*drawing.outline(box, 2.5))  # longer boxes are drawn shorter
    regimes = []
    for (low, below), (high, above) in pairwise([(0, "0"), *limits(shown)]):
        regime = shown.scene((low + high) / 2).regime
        here = shown.scene(low + REGIME_PANELS[regime][1] * (high - low))
        regimes.append((here, f"${below}<r<{above}$"))
    ratios = [here.range_y / here.range_x for here, _ in regimes]
    # Inches: labels on the left of a panel, below and above, the heading beside it, all panels.
    margin, below, beside = 0.3, 0.22, 1.3
    side = min(COLUMN_WIDTH - margin - beside, 4.5 / sum(ratios))
    left = (COLUMN_WIDTH - margin - beside - side) / 2 + margin
    heights = [below + side * ratio + 0.14 for ratio in ratios]
    figure = new_figure(sum(heights))
    bottom = sum(heights)
    for i, ((here, between), height) in enumerate(zip(regimes, heights, strict=True)):
        bottom -= height
        inches, extent = side / here.range_x, (0, here.range_x, 0, here.range_y)
        axes = drawing.add_axes(figure, left, bottom + below, inches, extent)
        _panel(axes, here, 72 * inches)
        if i == 0:
            drawing.label(axes, "$u$", ((here.range_x + here.contact_distance) / 2, 0), (0, -7))
            drawing.label(axes, "$v$", (0, (here.range_y + here.contact_distance) / 2), (-8, 0))
        heading = f"({'abc'[i]}) {REGIME_PANELS[here.regime][0]}\n{between}"
        corner = (here.range_x, here.range_y)
        drawing.label(axes, heading, corner, (12, 2), linespacing=1.5, ha="left", va="top")
    return figure


def _panel(axes, scene, points):
    """Draw the rectangle of one scene; ``points`` is the length of one unit in points."""
    wide, high, sigma = scene.range_x, scene.range_y, scene.contact_distance
    alpha = asin(high / sigma) if high < sigma else pi / 2
    beta = acos(wide / sigma) if wide < sigma else 0
    rise, run = (sigma * cos(alpha), high), (wide, sigma * sin(beta))

    drawing.rectangle(axes, 0, wide, 0, high, face="#DCEBF5", edge="none")
    sector = {"theta1": degrees(beta), "theta2": degrees(alpha), "clip_on": False}
    axes.add_patch(Wedge((0, 0), sigma, **sector, **OVERLAP_LOOK))
    dotted = {"facecolor": "#F3E3B5", "edgecolor": "#8C6A00", "hatch": ".....", "linewidth": 0}
    for is_cut, corner, tip in ((high < sigma, (0, high), rise), (wide < sigma, (wide, 0), run)):
        if is_cut:
            axes.add_patch(Polygon([(0, 0), corner, tip], clip_on=False, **dotted))
            drawing.line(axes, [(0, 0), tip], colour=BLACK)
    drawing.rectangle(axes, 0, wide, 0, high)
    axes.add_patch(Arc((0, 0), 2 * sigma, 2 * sigma, linewidth=1.3, **sector))
    thick = {"width": 2.2, "solid_capstyle": "butt", "zorder": 4}
    if scene.vertical_hops:
        drawing.line(axes, [(sigma, 0), (wide, 0)], colour=BLUE, **thick)
    if scene.horizontal_hops:
        drawing.line(axes, [(0, sigma), (0, high)], colour=VERMILLION, **thick)

    size = min(sigma, 1.3 * wide)
    if alpha < pi / 2:
        _angle(axes, r"$\alpha$", alpha, 0.5 * size, beta)
    if beta > 0:
        _angle(axes, r"$\beta$", beta, 0.75 * size)
    _ends(axes, "$A$", wide, sigma, points, lambda x: (x, 0), lambda d: (d, -7))
    _ends(axes, "$B$", high, sigma, points, lambda y: (0, y), lambda d: (-8, d))
    drawing.label(axes, "$0$", (0, 0), (-5, -5))


def _angle(axes, name, angle, radius, above=0.0):
    """Mark an angle at the origin, measured from the horizontal axis; its name is ``above`` one."""
    size, middle = 2 * radius, (angle + above) / 2
    axes.add_patch(Arc((0, 0), size, size, theta2=degrees(angle), lw=0.7, clip_on=False))
    at = (radius * cos(middle), radius * sin(middle))
    drawing.label(axes, name, at, (6, 0), **LABEL_RIM)


def _ends(axes, name, end, sigma, points, at, offset):
    """Name the end of an axis and, if the contact circle crosses the axis, the crossing."""
    meets = sigma < end
    apart = max(0, 10 - (end - sigma) * points) / 2 if meets else 0
    drawing.label(axes, name, at(end), offset(apart))
    if meets:
        drawing.label(axes, r"$\sigma$", at(sigma), offset(-apart))


# The shells of surfaces ---------------------------------------------------------------------------


def draw_shells(box):
    """Draw the shells in the ``Box``."""
    width, height = drawing.outline(box, 1.5)  # the shells are at one end of longer boxes
    short = min(width, height)
    radius, epsilon = 0.2 * short, 0.06 * short
    a, b = width / 2 - radius, height / 2 - radius
    margin, gap, below = 0.3, 0.42, 0.3  # inches
    across = COLUMN_WIDTH - margin - gap - 0.08
    side = min(across / (1 + a / b), 1.5)
    left = margin + (across - side * (1 + a / b)) / 2
    figure = new_figure(below + side + 0.26)
    square = drawing.add_axes(figure, left, below, side / (2 * b), (-b, b, -b, b))
    _hop(square, b, epsilon)
    extent = (0, sqrt(2) * a, 0, sqrt(2) * b)
    left, inches = left + side + gap, side / (sqrt(2) * b)
    quarter = drawing.add_axes(figure, left, below, inches, extent)
    _collision(quarter, a, b, radius, epsilon)
    return figure


def _hop(axes, b, epsilon):
    """Draw the square of y1, y2 with the surface y1 = y2 and its shell, which has two sides."""
    d = sqrt(2) * epsilon
    drawing.band(axes, b, epsilon, facecolor="#DCEBF5", edgecolor="none")
    for shift in (-d, d):
        ends = [(max(-b, shift - b), max(-b, -shift - b)), (min(b, b + shift), min(b, b - shift))]
        drawing.line(axes, ends, width=0.5, style=(0, (3, 2)))
    drawing.line(axes, [(-b, -b), (b, b)], colour=BLUE, width=1.3)
    drawing.rectangle(axes, -b, b, -b, b, width=0.9)
    drawing.label(axes, "(a)", (-b, b), (0, 9), ha="left")
    _name(axes, "$y_1=y_2$", BLUE)
    drawing.name_sides(axes, b, "y", "b", -9)

    # ε is a distance in configuration space; along an axis the shell is √2 times wider.
    c, h = -0.3 * b, epsilon / sqrt(2)
    drawing.arrow(axes, (c, c), (c + h, c - h), width=0.8, size=6)
    drawing.label(axes, r"$\varepsilon$", (c + h, c - h), (5, -4))
    y = 0.4 * b
    drawing.arrow(axes, (y, y), (y - d, y), "<|-|>", width=0.6, size=5)
    drawing.label(axes, r"$\sqrt{2}\,\varepsilon$", (y - d, y), (-12, 1))


def _name(axes, name, colour):
    """Write the ``name`` of the surface of a ``colour`` above its panel, beside a line of it."""
    line = Line2D([], [], color=colour, lw=1.3)
    place = {"loc": "lower right", "bbox_to_anchor": (1, 1), "borderaxespad": 0.3, "borderpad": 0}
    axes.legend([line], [name], **place)


def _collision(axes, a, b, radius, epsilon):
    """Draw the quarter plane of x, y with the circle of contact and its shell, on one side."""
    wide, high, rim = sqrt(2) * a, sqrt(2) * b, sqrt(2) * radius
    axes.add_patch(Wedge((0, 0), rim, 0, 90, **OVERLAP_LOOK))
    shell = {"width": epsilon, "facecolor": "#F8DDC8", "edgecolor": "none"}
    axes.add_patch(Wedge((0, 0), rim + epsilon, 0, 90, **shell))
    dashed = {"linewidth": 0.5, "linestyle": (0, (3, 2)), "edgecolor": GREY}
    thick = {"linewidth": 1.3, "edgecolor": VERMILLION}
    for distance, pen in ((rim + epsilon, dashed), (rim, thick)):
        axes.add_patch(Arc((0, 0), 2 * distance, 2 * distance, theta2=90, **pen))
    drawing.rectangle(axes, 0, wide, 0, high, width=0.9)
    drawing.label(axes, "(b)", (0, high), (0, 9), ha="left")
    _name(axes, "$x^2+y^2=2r^2$", VERMILLION)
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
