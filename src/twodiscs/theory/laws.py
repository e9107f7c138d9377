"""Closed forms of volume and areas, and the laws of mean times near the limits, of plain scenes."""

import math
from typing import NamedTuple

from twodiscs.model.checks import InputError, check_choice
from twodiscs.model.events import DECLARED, EVENTS, by_kind
from twodiscs.model.scene import Scene, check_scene
from twodiscs.theory.exact import volume
from twodiscs.theory.plain import Arc


def check_plain_scene(scene):
    """Return ``scene``; raise ``InputError`` unless it is a plain ``Scene``."""
    if not check_scene(scene).is_plain:
        raise InputError(
            "scene must be plain for closed forms, limits and distributions, but it has "
            f"{', '.join(scene.calls_for)}"
        )
    return scene


def closed_form(scene):
    """Return {"volume": V, "areas": {event: area}} from closed forms, in plain doubles.

    These are for reading and for comparisons, and show how closed forms fail. Just above a
    threshold they can lose half of the digits or more. Near the largest radius, at r = (1 − δ)
    r_max, they lose all of them (the volume like 1e-16/δ⁴). Use ``volume`` and ``areas`` for
    numbers.
    """
    r = check_plain_scene(scene).radius
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
        "areas": by_kind("theory/laws.py", areas),
    }


def small_radius_time(box, event, radius=0.0):
    """Return the mean time between events for small discs, to first order in ``radius``.

    With the default radius it is the limit r → 0: 3πh/(4√2) for vertical hops, 3πw/2 for the right
    wall, and infinite for disc collisions, which go like 3wh/(8√2 r).
    """
    check_plain_scene(box.tiny)
    w, h, r = box.width, box.height, 0.0
    if isinstance(radius, bool) or radius != 0:
        r = box.scene(radius).radius
    declared = DECLARED[check_choice("event", event, EVENTS)]
    # The side along the axis of the event, and the other one.
    along, across = (w, h) if declared.axis == "x" else (h, w)
    one_sided = 1.5 * math.pi
    if declared.kind == "collision":
        if r == 0:
            return math.inf
        return 3 / (8 * math.sqrt(2)) * (w * h / r - (2 - 4 / math.pi) * (w + h))
    if declared.kind == "hop":
        return one_sided / math.sqrt(8) * (along + (4 * along / across - 2) * r)
    if declared.kind == "wall":
        return one_sided * (along - 2 * r)
    return one_sided / 4 * (w * h - 2 * r * (w * w + h * h) / (w + h)) / (w + h)


def threshold_time(scene, event):
    """Return the leading law of a mean time at the radius at which its event ends.

    It is None if the event is impossible. If a hop becomes blocked before the discs jam, its time
    diverges like (w/4 − r)⁻² (vertical) or (h/4 − r)⁻² (horizontal). All other times depend on the
    distance from the largest radius r_max: they vanish like r_max − r. If one side is more than
    twice the other, the times of disc collisions and of the walls at the far ends stay finite.
    """
    w, h, r = check_plain_scene(scene).width, scene.height, scene.radius
    declared = DECLARED[check_choice("event", event, EVENTS)]
    if not scene.is_possible(event):
        return None
    one_sided = 1.5 * math.pi
    if declared.kind == "hop":
        along, across = (w, h) if declared.axis == "y" else (h, w)
        arc = Arc.of(Scene(along, across, r))
        if along >= 2 * across:  # open to the end
            return one_sided / math.sqrt(8) * arc.range_y
        critical = volume(Scene(along, across, along / 4))
        return one_sided / math.sqrt(8) * critical / ((across - along / 2) * arc.beyond_x**2)
    # The axes along and across the box; in a box higher than wide they are exchanged.
    long, short = "xy" if w >= h else "yx"
    w, h = max(w, h), min(w, h)
    arc = Arc.of(Scene(w, h, r))
    if w >= 2 * h:
        # The arc is straight on the scale of the free lengths: V = x² y², x = A − σ, y = B.
        x, y = arc.beyond_x, arc.range_y
        collision, walls = x / math.sqrt(8), {long: x / 2, short: y}
        any_wall = x * y / (x + y) / 4
    else:
        # Between the arc and the far corner a triangle is left: V ∝ S⁴/(AB)² and its derivatives,
        # with S = A² + B² − σ² = 4 (r_max − r)(r₊ − r) and 2 (r₊ − r_max) = 2 √(2wh).
        range_x, range_y, sigma = arc.exact
        root = math.sqrt(2 * w * h)
        left = float(range_x**2 + range_y**2 - sigma**2) / (2 * (w + h + root - 2 * r))
        last_x, last_y = root - h, w * (2 * h - w) / (root + w)
        collision = root * left / (math.sqrt(8) * (w + h - root))
        walls = {long: root * left / (2 * last_x), short: root * left / (2 * last_y)}
        any_wall = root * left / (4 * (last_x + last_y))
    times = {"collision": collision, "wall": walls.get(declared.axis), "walls": any_wall}
    return one_sided * times[declared.kind]


class Law(NamedTuple):
    """C δ^p with δ the distance below a limiting radius: the leading law of a mean time."""

    limit: float
    power: int
    coefficient: float

    def __call__(self, radius):
        return self.coefficient * (self.limit - radius) ** self.power


def leading_law(box, event):
    """Return the ``Law`` of a mean time in a plain ``Box``, or None if it stays finite."""
    limit = box.threshold(check_choice("event", event, EVENTS))
    near, far = (box.scene(limit * (1 - 2.0**-k)) for k in (21, 20))
    times = [threshold_time(scene, event) for scene in (near, far)]
    power = round(math.log2(times[1] / times[0]))
    if not power:
        return None
    return Law(limit, power, times[0] / (limit - near.radius) ** power)
