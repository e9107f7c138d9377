"""Exact laws of the distribution of times between events: at time zero, and of long intervals."""

import math

from twodiscs.model.checks import InputError, check_choice
from twodiscs.model.events import HOPS
from twodiscs.theory.exact import areas, volume
from twodiscs.theory.laws import check_plain_scene
from twodiscs.theory.plain import Arc


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


def drift_probability(scene, time, axis="x"):
    """Return the exact probability that discs drift along an ``axis`` in separate rows for a time.

    For "x" it is P(|y1 − y2| ≥ σ throughout ``time``) = 2 A² (B − σ)₊⁴/(π V time²) from the
    invariant measure, for "y" the same with A ↔ B. It holds for time ≥ 2 (B − σ)₊, the diameter of
    the square in which the distances between discs and walls move. All drifts that stay in it have
    |(v1, v2)| ≤ 1, and the density of two components of a unit vector in four dimensions is 1/π
    there.
    """
    check_choice("axis", axis, ("x", "y"))
    arc = Arc.of(check_plain_scene(scene))
    along, beyond = arc.range_x, arc.beyond_y
    if axis == "y":
        along, beyond = arc.range_y, arc.beyond_x
    if not time >= 2 * beyond:
        raise InputError(f"time must be at least {2 * beyond!r}, not {time!r}")
    return 2 * along**2 * beyond**4 / (math.pi * volume(scene) * time**2)


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
    σ)₊²), for which the drifts of both axes have exactly this probability (``drift_probability``);
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
