"""One trajectory of two discs, event by event, and the tail of the times between its events."""

import math

from twodiscs.dynamics.law import DISC, after_event, crosses, crossing_time, next_event
from twodiscs.dynamics.two.follow import relative_motion
from twodiscs.sampling.jit import compiled
from twodiscs.theory.exact import areas
from twodiscs.theory.plain import Arc


@compiled
def advance(state, law):
    """Return the state after the next event, and the time and code of that event, without kicks."""
    time, code = next_event(state, math.inf, law)
    return after_event(state, time, code, law), time, code


@compiled
def advance_to(state, law, hop):
    """Return the state, time and code of ``advance``, and the time of a vertical hop on the way.

    It is the time of a disc collision if not ``hop``, and −1 if the event did not come.
    """
    before, rising = relative_motion(state, None)
    state, time, code = advance(state, law)
    if hop:
        met = (
            crossing_time(before, rising)
            if crosses(before, relative_motion(state, None)[0])
            else -1.0
        )
    else:
        met = time if code == DISC else -1.0
    return state, time, code, met


@compiled
def time_to_next(state, law, hop, longest):
    """Return the time to the next vertical hop, or to the next disc collision if not ``hop``.

    If it is more than ``longest``, the returned time is only known to be longer than that. There
    are no kicks.
    """
    elapsed = 0.0
    while elapsed <= longest:
        state, time, _, met = advance_to(state, law, hop)
        if met >= 0.0:
            return elapsed + met
        elapsed += time
    return elapsed


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
    arc, area = Arc.of(scene), areas(scene)[event]
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
