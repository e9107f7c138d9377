"""The regimes of the integration: the sides at which the contact circle leaves the rectangle."""

from itertools import pairwise
from math import acos, asin, cos, degrees, pi, sin

from matplotlib.patches import Arc, Polygon, Wedge
from matplotlib.patheffects import withStroke

from twodiscs.figures.kit import drawing
from twodiscs.figures.kit.limits import limits
from twodiscs.figures.kit.style import BLACK, BLUE, COLUMN, GREY, VERMILLION, new_figure
from twodiscs.model.box import Box

#: The radius drawn for a regime, as a fraction of the way between the regime's limits.
FRACTION = {"all-hops": 0.55, "vertical-hops": 0.5, "horizontal-hops": 0.5, "no-hops": 0.3}

HEADINGS = {
    "all-hops": "both hops",
    "vertical-hops": "vertical hops",
    "horizontal-hops": "horizontal hops",
    "no-hops": "no hops",
}

#: Inches around a panel: labels on the left, below and above, and the heading beside or beneath.
LEFT, BELOW, ABOVE, BESIDE, BENEATH = 0.3, 0.22, 0.14, 1.0, 0.5


def draw(box, tables):
    """Draw one panel for each regime of the ``Box``; ``tables`` is not used."""
    shown = Box(*drawing.outline(box))
    width, height = shown.width, shown.height
    panels = []
    for (low, below), (high, above) in pairwise([(0, "0"), *limits(shown)]):
        regime = shown.scene((low + high) / 2).regime
        here = shown.scene(low + FRACTION[regime] * (high - low))
        panels.append((here, f"${below}<r<{above}$"))
    ratios = [here.range_y / here.range_x for here, _ in panels]
    wide = width > 1.2 * height
    if wide:
        side = COLUMN - LEFT - BESIDE
        tall = [BELOW + ABOVE + side * ratio for ratio in ratios]
        figure = new_figure(sum(tall))
        corners = [(LEFT, sum(tall[i + 1 :]) + BELOW) for i in range(len(tall))]
        scales = [side / here.range_x for here, _ in panels]
    else:
        room = COLUMN - (LEFT + 0.1) * len(panels)
        side = min(room / sum(1 / ratio for ratio in ratios), 2.2)
        broad = [max(LEFT + 0.1 + side / ratio, 1.1) for ratio in ratios]
        spare = (COLUMN - sum(broad)) / 2
        figure = new_figure(BENEATH + BELOW + side + ABOVE)
        corners = [(spare + LEFT + sum(broad[:i]), BENEATH + BELOW) for i in range(len(broad))]
        scales = [side / here.range_y for here, _ in panels]
    for i, ((here, between), corner, inches) in enumerate(
        zip(panels, corners, scales, strict=True)
    ):
        extent = (0, here.range_x, 0, here.range_y)
        axes = drawing.add_axes(figure, *corner, inches, extent)
        _panel(axes, here, 72 * inches)
        if i == 0:
            drawing.label(axes, "$u$", ((here.range_x + here.contact_distance) / 2, 0), (0, -7))
            drawing.label(axes, "$v$", (0, (here.range_y + here.contact_distance) / 2), (-8, 0))
        heading = f"({'abc'[i]}) {HEADINGS[here.regime]}\n{between}"
        if wide:
            at, offset, align = (here.range_x, here.range_y), (12, 2), {"ha": "left", "va": "top"}
        else:
            at, offset, align = (here.range_x / 2, 0), (0, -20), {"ha": "center", "va": "top"}
        drawing.label(axes, heading, at, offset, linespacing=1.5, **align)
    return figure


def caption(shown):
    """Return the caption."""
    return """
    The separations u = |x1 − x2| and v = |y1 − y2| fill a rectangle of sides A = w − 2r and B = h −
    2r. The discs overlap in the quarter circle of radius σ = 2r, which is left out. The arc is the
    surface of collisions; the coloured parts of the axes are the surfaces of vertical hops (below)
    and horizontal hops (on the left). If σ exceeds B, horizontal hops are blocked; if it exceeds A,
    vertical hops are. The overlaps are then a sector (hatched) and triangles (dotted).
    """


def _panel(axes, scene, points):
    """Draw the rectangle of one scene; ``points`` is the length of one unit in points."""
    wide, high, sigma = scene.range_x, scene.range_y, scene.contact_distance
    alpha = asin(high / sigma) if high < sigma else pi / 2
    beta = acos(wide / sigma) if wide < sigma else 0
    rise, run = (sigma * cos(alpha), high), (wide, sigma * sin(beta))

    drawing.rectangle(axes, 0, wide, 0, high, face="#DCEBF5", edge="none")
    sector = {"facecolor": "white", "edgecolor": GREY, "hatch": "/////", "linewidth": 0}
    axes.add_patch(Wedge((0, 0), sigma, degrees(beta), degrees(alpha), clip_on=False, **sector))
    dotted = {"facecolor": "#F3E3B5", "edgecolor": "#8C6A00", "hatch": ".....", "linewidth": 0}
    if alpha < pi / 2:
        axes.add_patch(Polygon([(0, 0), (0, high), rise], clip_on=False, **dotted))
        drawing.line(axes, [(0, 0), rise], colour=BLACK, width=0.5)
    if beta > 0:
        axes.add_patch(Polygon([(0, 0), (wide, 0), run], clip_on=False, **dotted))
        drawing.line(axes, [(0, 0), run], colour=BLACK, width=0.5)
    drawing.rectangle(axes, 0, wide, 0, high)
    angles = {"theta1": degrees(beta), "theta2": degrees(alpha)}
    axes.add_patch(Arc((0, 0), 2 * sigma, 2 * sigma, linewidth=1.3, clip_on=False, **angles))
    thick = {"width": 2.2, "solid_capstyle": "butt", "zorder": 4}
    if scene.vertical_hops:
        drawing.line(axes, [(sigma, 0), (wide, 0)], colour=BLUE, **thick)
    if scene.horizontal_hops:
        drawing.line(axes, [(0, sigma), (0, high)], colour=VERMILLION, **thick)

    reach = min(sigma, 1.3 * wide)
    if alpha < pi / 2:
        _angle(axes, r"$\alpha$", alpha, 0.5 * reach, beta)
    if beta > 0:
        _angle(axes, r"$\beta$", beta, 0.75 * reach)
    _ends(axes, "$A$", wide, sigma, points, lambda x: (x, 0), lambda d: (d, -7))
    _ends(axes, "$B$", high, sigma, points, lambda y: (0, y), lambda d: (-8, d))
    drawing.label(axes, "$0$", (0, 0), (-5, -5))


def _angle(axes, name, angle, radius, above=0.0):
    """Mark an angle at the origin, measured from the horizontal axis; its name is ``above`` one."""
    size, middle = 2 * radius, (angle + above) / 2
    axes.add_patch(Arc((0, 0), size, size, theta2=degrees(angle), lw=0.7, clip_on=False))
    at = (radius * cos(middle), radius * sin(middle))
    drawing.label(axes, name, at, (6, 0), path_effects=[withStroke(linewidth=2, foreground="w")])


def _ends(axes, name, end, sigma, points, at, offset):
    """Name the end of an axis and, if the contact circle crosses the axis, the crossing."""
    meets = sigma < end
    apart = max(0, 10 - (end - sigma) * points) / 2 if meets else 0
    drawing.label(axes, name, at(end), offset(apart))
    if meets:
        drawing.label(axes, r"$\sigma$", at(sigma), offset(-apart))
