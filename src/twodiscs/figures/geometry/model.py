"""The billiard and its parameters."""

from math import copysign, hypot

from twodiscs.figures.kit import drawing
from twodiscs.figures.kit.style import GREY

#: Radius of the discs drawn, over the shorter side.
RADIUS = 0.13

#: Centres over a and b, and velocities in radii: clear of each other and of the origin in any box.
CENTRES = ((-0.45, -0.52), (0.45, 0.5))
VELOCITIES = ((0.7, 1.6), (0.95, -1.3))


def draw(box):
    """Draw two discs in the ``Box``."""
    width, height = drawing.outline(box)
    radius = RADIUS * min(width, height)
    a, b = width / 2 - radius, height / 2 - radius
    right, top = width / 2, height / 2
    figure, axes = drawing.single((-right, right, -top, top), 0.3, 0.34, 0.3, 0.3)

    drawing.rectangle(axes, -right, right, -top, top, width=1.2)
    drawing.rectangle(axes, -a, a, -b, b, edge=GREY, width=0.6, linestyle=(0, (4, 2.5)))
    _origin(axes, 0.14 * min(width, height))
    for number, position, speed in zip((1, 2), CENTRES, VELOCITIES, strict=True):
        centre = (position[0] * a, position[1] * b)
        _disc(axes, number, centre, radius, (radius * speed[0], radius * speed[1]))

    point = drawing.points(axes)
    near, far = 4 * point, 11 * point
    for x, y, across, up in (
        *((x, -top, 0, -1) for x in (-right, right)),
        *((-right, y, -1, 0) for y in (-top, top)),
        *((x, top, 0, 1) for x in (0, a)),
        *((right, y, 1, 0) for y in (0, b)),
    ):
        ends = [(x + across * d, y + up * d) for d in (near, far + near)]
        drawing.line(axes, ends, colour="black", width=0.4)
    drawing.dimension(axes, (-right, -top - far), (right, -top - far), "$w$", (0, -6))
    drawing.dimension(axes, (-right - far, -top), (-right - far, top), "$h$", (-6, 0))
    drawing.dimension(axes, (0, top + far), (a, top + far), "$a=w/2-r$", (0, 6))
    turned = {"rotation": 90 if height > width / 2 else 0}
    text = "$b=h/2-r$" if height > width / 2 else "$b$"
    drawing.dimension(axes, (right + far, 0), (right + far, b), text, (7, 0), **turned)
    return figure


def _origin(axes, reach):
    """Draw the axes x and y at the centre of the box."""
    for head, name, offset in (((reach, 0), "$x$", (4, -3)), ((0, reach), "$y$", (-4, 2))):
        drawing.arrow(axes, (0, 0), head, width=0.6, size=6)
        drawing.label(axes, name, head, offset)
    drawing.label(axes, "$0$", (0, 0), (-4, -4))


def _disc(axes, number, centre, radius, velocity):
    """Draw a disc with its radius and its velocity, their names beside it."""
    x, y = centre
    colour = drawing.DISCS[number - 1][1]
    drawing.disc(axes, number, centre, radius)
    drawing.arrow(axes, centre, (x - radius, y), width=0.5, size=5)
    drawing.label(axes, "$r$", (x - radius, y), (-5, 0))
    head = (x + velocity[0], y + velocity[1])
    size = hypot(*velocity) / 6
    drawing.arrow(axes, centre, head, colour=colour, width=1)
    beyond = (velocity[0] / size, velocity[1] / size)
    drawing.label(axes, rf"$\mathbf{{v}}_{number}$", head, beyond, color=colour)
    # On the side towards the middle of the box, which is empty.
    rim = (x - 0.6 * radius, y + copysign(0.8 * radius, velocity[1]))
    offset = (-4, copysign(5, velocity[1]))
    drawing.label(axes, rf"$\mathbf{{x}}_{number}$", rim, offset, color=colour)
