"""Volume and areas of a plain scene in closed form, which show how closed forms fail."""

import math

from twodiscs.model.events import by_kind


def closed_form(scene):
    """Return {"volume": V, "areas": {event: area}} from closed forms, in plain doubles.

    These are for reading and for comparisons, and show how closed forms fail. Just above a
    threshold they can lose half of the digits or more. Near the largest radius, at r = (1 − δ)
    r_max, they lose all of them (the volume like 1e-16/δ⁴). Use ``volume`` and ``areas`` for
    numbers.
    """
    r = scene.radius
    a, b = scene.range_x / 2, scene.range_y / 2
    # The angle of the quarter circle within [0, a] × [0, b].
    angle = math.asin(min(b / r, 1.0)) - math.acos(min(a / r, 1.0))

    def side(a, b):
        """Return the terms of V, A_coll and two wall areas that appear if discs can pass."""
        if a >= r:
            return 64 / 3 * a * r**3 - 8 * r**4, r * r - 2 * a * r, 16 / 3 * r**3, 0.0
        k = math.sqrt(r * r - a * a)
        cubic = 8 / 3 * k * (2 * r * r + a * a)
        return (
            16 * (a * r) ** 2 - 8 / 3 * a**4 - 4 * b * cubic,
            2 * b * k - a * a,
            8 * a * r * r - 8 / 3 * a**3 - 8 * a * b * k,
            -cubic,
        )

    (v_x, c_x, own_x, other_x), (v_y, c_y, own_y, other_y) = side(a, b), side(b, a)
    right = 8 * a * b * b - 8 * b * r * r * angle + own_x + other_y
    top = 8 * a * a * b - 8 * a * r * r * angle + own_y + other_x
    sides = {"x": (a, b), "y": (b, a)}

    def hop(event):
        across, along = sides[event.axis]
        return 8 * math.sqrt(2) * across * max(along - r, 0.0) ** 2

    areas = {
        "hop": hop,
        "collision": lambda event: 16 * math.sqrt(2) * r * (2 * a * b * angle - r * r + c_x + c_y),
        "wall": lambda event: right if event.axis == "x" else top,
        "walls": lambda event: 4 * (right + top),
    }
    return {
        "volume": 16 * (a * b) ** 2 - 32 * a * b * r * r * angle + 8 * r**4 + v_x + v_y,
        "areas": by_kind("studies/stability/closed_form.py", areas),
    }
