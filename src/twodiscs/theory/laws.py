"""Laws of plain scenes in closed form: mean times near the limits, short and long intervals."""

import math

from twodiscs.model.events import EVENT_AXES, by_kind
from twodiscs.model.scene import Scene
from twodiscs.theory.exact import volume
from twodiscs.theory.plain import Arc

#: The mean time between hits of a wall by a point, per length of the side along its axis.
WALL_TIME = 1.5 * math.pi


def _hops(event):
    def time(sides, r):
        along, across = sides[event.axis], sides["xy".replace(event.axis, "")]
        return WALL_TIME / math.sqrt(8) * (along + (4 * along / across - 2) * r)

    return time


def _collisions(sides, r):
    if r == 0:
        return math.inf
    w, h = sides.values()
    return 3 / (8 * math.sqrt(2)) * (w * h / r - (2 - 4 / math.pi) * (w + h))


def _all_walls(sides, r):
    w, h = sides.values()
    return WALL_TIME / 4 * (w * h - 2 * r * (w * w + h * h) / (w + h)) / (w + h)


#: {event: mean time to first order in the radius}, functions of {axis: side} and of the radius
SMALL_RADIUS_LAWS = by_kind(
    "theory/laws.py",
    {
        "hop": _hops,
        "collision": lambda event: _collisions,
        "wall": lambda event: lambda sides, r: WALL_TIME * (sides[event.axis] - 2 * r),
        "walls": lambda event: _all_walls,
    },
)


def small_radius_time(box, event, radius=0.0):
    """Return the mean time between events for small discs, to first order in ``radius``.

    With the default radius it is the limit r → 0: 3πh/(4√2) for vertical hops, 3πw/2 for the right
    wall, and infinite for disc collisions, which go like 3wh/(8√2 r).
    """
    return SMALL_RADIUS_LAWS[event]({"x": box.width, "y": box.height}, radius)


def threshold_time(scene, event):
    """Return the leading law of the mean time of a possible event at the radius at which it ends.

    If a hop becomes blocked before the discs jam, its time diverges like (w/4 − r)⁻² (vertical) or
    (h/4 − r)⁻² (horizontal). All other times depend on the distance from the largest radius r_max:
    they vanish like r_max − r. If one side is more than twice the other, the times of disc
    collisions and of the walls at the far ends stay finite.
    """
    return THRESHOLD_LAWS[event](scene)


def _last_hops(event):
    def time(scene):
        w, h = scene.sides
        along, across = (w, h) if event.axis == "y" else (h, w)
        arc = Arc.of(Scene(along, across, scene.radius))
        if along >= 2 * across:  # open to the end
            return WALL_TIME / math.sqrt(8) * arc.range_y
        critical = volume(Scene(along, across, along / 4))
        return WALL_TIME / math.sqrt(8) * critical / ((across - along / 2) * arc.beyond_x**2)

    return time


def _times_at_jam(scene):
    """Return {"collision", "x" and "y" of walls, "walls": leading law of the time}."""
    w, h, r = *scene.sides, scene.radius
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
    times = {"collision": collision, "walls": any_wall, **walls}
    return {name: WALL_TIME * time for name, time in times.items()}


#: {event: leading law of its time}, functions of a ``Scene``
THRESHOLD_LAWS = by_kind(
    "theory/laws.py",
    {
        "hop": _last_hops,
        "collision": lambda event: lambda scene: _times_at_jam(scene)["collision"],
        "wall": lambda event: lambda scene: _times_at_jam(scene)[event.axis],
        "walls": lambda event: lambda scene: _times_at_jam(scene)["walls"],
    },
)


# Intervals ----------------------------------------------------------------------------------------


def density_at_zero(scene, hop):
    """Return the density at 0⁺ of the interval between open hops of one kind, in 1/time.

    An interval t → 0 is a hop, one bounce and the hop back. At a vertical hop both centres are at a
    distance d from the wall that their mean y moves to. It is uniform on [0, B] and independent of
    the velocities. The disc that is ahead bounces, and both have the same y again after
    t = 2d/|v1 + v2|. The density of t at 0 is therefore the mean of |v1 + v2|/(2B), weighted by the
    flux ∝ |v1 − v2|. The components n, m = (v1 ∓ v2)/√2 are uniform in the unit disc, so that
    ⟨|n m|⟩/⟨|n|⟩ is (1/2π)/(4/3π) and

        p(0⁺) = 3√2/(16 B) for vertical hops, 3√2/(16 A) for horizontal ones.

    No other way back is as short: a collision of the discs moves them farther from the surface that
    they crossed.
    """
    side = {"x": scene.range_x, "y": scene.range_y}[EVENT_AXES[hop]]
    return 3 * math.sqrt(2) / (16 * side)
