"""Laws of plain scenes in closed form: mean times near the limits, short and long intervals."""

import math

from twodiscs.model.checks import InputError, check_choice
from twodiscs.model.events import DECLARED, EVENTS, HOPS
from twodiscs.model.scene import Scene, check_scene
from twodiscs.theory.exact import areas, volume
from twodiscs.theory.plain import Arc


def check_plain_scene(scene):
    """Return ``scene``; raise ``InputError`` unless it is a plain ``Scene``."""
    if not check_scene(scene).is_plain:
        raise InputError(
            "scene must be plain for closed forms, limits and distributions, but it has "
            f"{', '.join(scene.calls_for)}"
        )
    return scene


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


# Intervals ----------------------------------------------------------------------------------------


def density_at_zero(scene, hop):
    """Return the density at 0⁺ of the interval between hops of one kind, in 1/time.

    It is None if the hop is blocked.

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
    check_choice("hop", hop, HOPS)
    if not check_plain_scene(scene).is_possible(hop):
        return None
    side = scene.range_y if hop == "vertical_hop" else scene.range_x
    return 3 * math.sqrt(2) / (16 * side)


def tail_constant(scene, event):
    """Return C of the tail P(T > t) → C/t³ of the time between events, in time³.

    ``event`` is a disc collision or a hop. C is 0.0 if there is no neutral motion; the tail then
    falls faster than any power, as far as is known. It is None if the event is impossible.

    Discs that move along x, with slow drifts v1, v2, do not touch as long as |y1 − y2| ≥ σ. With
    wall hits unfolded, the distances between discs and walls move on a straight line in the square
    |p| + |q| ≤ B − σ. They do not leave it within t for a drift in an area 2 (B − σ)²/t². Both
    orders of the discs count, (v1, v2) has the density 1/π at 0, and motion along y adds the same.
    The invariant measure therefore gives

        P(no collision within t) → 2 [A² (B − σ)₊⁴ + B² (A − σ)₊⁴] / (π V t²),

    and Palm's relation P(T > t) = −τ d/dt P(none within t) gives

        C = 6 [A² (B − σ)₊⁴ + B² (A − σ)₊⁴] / A_coll,    3 A² (B − σ)₊⁴ / A_hop,v,

    and A ↔ B for horizontal hops: a vertical hop is avoided by drifting motions along x only.

    Two statements are proved. First, P(none within t) is at least this for t ≥ 2√((A − σ)₊² + (B −
    σ)₊²), for which the drifts of both axes have exactly this probability;
    for hops it is at least the hop's term. Second, no other family of directions of two or more
    dimensions avoids collisions. Unfolded flights are straight lines on a torus of four dimensions,
    on which the centres coincide on the four planes x1 = ±x2, y1 = ±y2. A plane of directions that
    is transversal to one of these intersects it, and only (u1, u2) and (v1, v2) are transversal to
    none. Two statements are argued, not proved. The other motions (neighbourhoods of periodic
    motions, each of order t⁻³ in P(none within t)) add up to less. For hops, the motion before and
    after the drift, with disc collisions, decorrelates exponentially fast.
    """
    check_choice("event", event, (*HOPS, "disc_collision"))
    arc, area = Arc.of(check_plain_scene(scene)), areas(scene)[event]
    if not scene.is_possible(event):
        return None
    along_x = arc.range_x**2 * arc.beyond_y**4
    along_y = arc.range_y**2 * arc.beyond_x**4
    motions = {
        "disc_collision": 6 * (along_x + along_y),
        "vertical_hop": 3 * along_x,
        "horizontal_hop": 3 * along_y,
    }
    return motions[event] / area
