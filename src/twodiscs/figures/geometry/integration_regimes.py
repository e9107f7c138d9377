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

#: Inches around a panel: labels on the left, below and above, and the heading beside it.
LEFT, BELOW, ABOVE, BESIDE = 0.3, 0.22, 0.14, 1.3

#: Longer boxes are drawn shorter.
LONGEST = 2.5

#: The largest height of all panels together, in inches.
TALLEST = 4.5


def draw(box):
    """Draw one panel for each regime of the ``Box``."""
    shown = Box(*drawing.outline(box, LONGEST))
    panels = []
    for (low, below), (high, above) in pairwise([(0, "0"), *limits(shown)]):
        regime = shown.scene((low + high) / 2).regime
        here = shown.scene(low + FRACTION[regime] * (high - low))
        panels.append((here, f"${below}<r<{above}$"))
    ratios = [here.range_y / here.range_x for here, _ in panels]
    side = min(COLUMN - LEFT - BESIDE, TALLEST / sum(ratios))
    left = (COLUMN - LEFT - BESIDE - side) / 2 + LEFT
    heights = [BELOW + side * ratio + ABOVE for ratio in ratios]
    figure = new_figure(sum(heights))
    bottom = sum(heights)
    for i, ((here, between), height) in enumerate(zip(panels, heights, strict=True)):
        bottom -= height
        inches, extent = side / here.range_x, (0, here.range_x, 0, here.range_y)
        axes = drawing.add_axes(figure, left, bottom + BELOW, inches, extent)
        _panel(axes, here, 72 * inches)
        if i == 0:
            drawing.label(axes, "$u$", ((here.range_x + here.contact_distance) / 2, 0), (0, -7))
            drawing.label(axes, "$v$", (0, (here.range_y + here.contact_distance) / 2), (-8, 0))
        heading = f"({'abc'[i]}) {HEADINGS[here.regime]}\n{between}"
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
