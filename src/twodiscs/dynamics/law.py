"""One event: its time and the state after it. All arguments and results are plain floats.

A state is the tuple (x1, y1, x2, y2, u1, v1, u2, v2): centres, then velocities, with the origin at
the centre of the box. Balls append (z1, z2, w1, w2); rough discs append (s1, s2), their spins as
the speeds rω of their surfaces. The ``Law`` has the constants of a scene, and None for absent
effects. Each effect is one short function here. For None it does nothing, and numba compiles it to
nothing, so the law of a scene has only the effects of that scene.

Every function is compiled into the lock-step ensemble, into the audit and into single trajectories,
so the law is only in this file. There are no branches at run time, only selections, so that an
ensemble advances in vector instructions.

A time is kept as a quotient ``gap / speed`` and quotients are compared by cross-multiplication: one
division per event instead of five.
"""

import math
from typing import NamedTuple

from twodiscs.sampling.jit import inlined, optional
from twodiscs.sampling.rejection import RejectionSampler, draw_velocities, rejection_sampler

#: The event that ended a free flight. Codes are floats because they travel in the same registers as
#: the state. Negative codes are no events: a disc leaves its periodic cell and comes back on the
#: other side.
END_OF_TIME, WALL_X1, WALL_Y1, WALL_X2, WALL_Y2, DISC = 0.0, 1.0, 2.0, 3.0, 4.0, 5.0
WALL_Z1, WALL_Z2 = 6.0, 7.0
WRAP_X, WRAP_Y, WRAP_Z = -1.0, -2.0, -3.0

#: Normal speeds of approach below this (four roundings of the speed scale, 1) are rest. A collision
#: at such a speed would be lost in the rounding of the velocities, and happen again and again.
RESTING_SPEED = 4 * 2.0**-52

#: The centres of discs smaller than the spacing of coordinates may coincide, or almost. Below this
#: square of their distance there is no line of centres, and their velocities do not change.
VANISHING_SQUARE = 1e-280

#: The gap of discs that separate.
INFINITE_GAP = math.inf


class KickSampler(NamedTuple):
    """A kick draws with these: masses m, moments of inertia κm (0 if smooth), and a sampler."""

    masses: tuple
    inertias: tuple
    prism: RejectionSampler


class Law(NamedTuple):
    """The constants of the motion in a scene, lengths; None for absent effects.

    The centre of disc i keeps within ±half_xi. The half-ranges of disc 2 are None if they are the
    same as for disc 1. On a periodic axis both discs have None. ``wrap_x`` is (half the period, the
    parts of the period by which disc 1 and disc 2 move when the separation leaves ±half of it).
    """

    half_x1: float | None
    half_y1: float | None
    sigma: float
    half_x2: float | None = None
    half_y2: float | None = None
    half_z1: float | None = None
    half_z2: float | None = None
    wrap_x: tuple | None = None
    wrap_y: tuple | None = None
    wrap_z: tuple | None = None
    depth: bool | None = None
    field: float | None = None
    weights: tuple | None = None  # 2 m2/M, 2 m1/M of unequal masses
    rough: tuple | None = None  # κ/(1 + κ), 1/(1 + κ) with κ = I/(m r²)


def divided(whole, first, second):
    """Return ``whole`` divided as ``first`` to ``second``, in two parts with exactly this sum.

    If two bodies share a change of velocity, the sum of their parts determines the energy. A
    rounding of this sum would be the same in every event, and add up.
    """
    larger = whole * (max(first, second) / (first + second))
    return (larger, whole - larger) if first > second else (whole - larger, larger)


def two_disc_law(scene):
    """Return the ``Law`` of a ``Scene``."""
    m1, m2 = scene.masses
    fractions = divided(1.0, m2, m1)
    halves = {
        f"half_{axis}{disc}": (scene.side(axis) - 2 * radius) / 2
        for axis in scene.walled
        for disc, radius in enumerate(scene.radii[: 1 if scene.radius_ratio == 1 else 2], 1)
    }
    wraps = {
        f"wrap_{axis}": (side / 2, *(side * fraction for fraction in fractions))
        for axis, side in ((axis, scene.side(axis)) for axis in scene.periodic)
    }
    inertia = scene.moment_of_inertia
    return Law(
        sigma=scene.contact_distance,
        depth=None if scene.depth is None else True,
        field=scene.field or None,
        weights=None if m1 == m2 else divided(2.0, m2, m1),
        rough=None if inertia is None else divided(1.0, inertia, 1.0),
        **{"half_x1": None, "half_y1": None} | halves | wraps,
    )


def kick_sampler(scene):
    """Return the ``KickSampler`` of a ``Scene``."""
    inertias = tuple((scene.moment_of_inertia or 0.0) * mass for mass in scene.masses)
    return KickSampler(scene.masses, inertias, rejection_sampler(scene))


# Effects: an absent effect (None, the last argument) is compiled to nothing ----------------------


@optional(lambda other, own: other)
def value_or(other, own):
    """Return ``own``, or ``other`` if ``own`` is None."""
    return own


@optional(lambda a, b: None)
def difference(a, b):
    """Return a − b, or None without this coordinate."""
    return a - b


@optional(lambda a, b: None)
def product(a, b):
    """Return a b, or None without b."""
    return a * b


@optional(lambda x, y, z, u, v, w: x * u + y * v)
def dot(x, y, z, u, v, w):
    """Return the scalar product of (x, y, z) and (u, v, w), in the plane without z and w."""
    return x * u + y * v + z * w


def _cross_square(x, y, z, u, v, w):
    cross = x * v - y * u
    return cross * cross


@optional(_cross_square)
def cross_square(x, y, z, u, v, w):
    """Return the square of the vector product of (x, y, z) and (u, v, w)."""
    c_x, c_y, c_z = y * w - z * v, z * u - x * w, x * v - y * u
    return c_x * c_x + c_y * c_y + c_z * c_z


@optional(lambda state, depth: (None, None, None, None))
def depth_part(state, depth):
    """Return (z1, z2, w1, w2), in the plane four times None."""
    return state[8], state[9], state[10], state[11]


@optional(lambda state, rough: ())
def spins(state, rough):
    """Return (s1, s2), or nothing for smooth discs."""
    return state[8], state[9]


@optional(lambda position, velocity, time, field: (position + velocity * time, velocity))
def free_flight(position, velocity, time, field):
    """Return position and velocity after a flight, parabolic in a field."""
    gained = field * time
    return position + (velocity - 0.5 * gained) * time, velocity - gained


@optional(lambda position, time, velocity: None)
def moved(position, time, velocity):
    """Return the position after a straight flight, or None without this coordinate."""
    return position + velocity * time


@optional(lambda exchange, disc, weights: exchange)
def scaled(exchange, disc, weights):
    """Return the exchange of velocities times the weight of a disc, if masses differ."""
    return exchange * weights[disc]


@optional(lambda q1, q2, relative, hit, wrap: (q1, q2))
def wrapped(q1, q2, relative, hit, wrap):
    """Return coordinates whose separation has left ±half a period, moved to its other end.

    The discs share the move so that their centre of mass stays.
    """
    q1 -= math.copysign(wrap[1], relative) if hit else 0.0
    q2 += math.copysign(wrap[2], relative) if hit else 0.0
    return q1, q2


@optional(lambda position, hit, half: position)
def snap_to_wall(position, hit, half):
    """Return the position, put on the wall at ±``half`` exactly if it is ``hit``."""
    return math.copysign(half, position) if hit else position


@optional(lambda gap, speed, code, state, law, depth: (gap, speed, code))
def deep_event(gap, speed, code, state, law, depth):
    """Return (gap, speed, code) of what comes first: the event given, or one along z."""
    z1, z2, w1, w2 = depth_part(state, depth)
    gap_z, speed_z, code_z = axis_quotient(
        z1, z2, w1, w2, law.half_z1, law.half_z2, None, WALL_Z1, WALL_Z2, WRAP_Z, law.wrap_z
    )
    sooner = gap_z * speed < gap * speed_z
    return gap_z if sooner else gap, speed_z if sooner else speed, code_z if sooner else code


@optional(lambda state, time, code, kick, law, depth: ())
def deep_after(state, time, code, kick, law, depth):
    """Return what balls append to the state after an event with this ``kick`` along z."""
    z1, z2, w1, w2 = depth_part(state, depth)
    relative = w1 - w2
    z1 = snap_to_wall(z1 + w1 * time, code == WALL_Z1, law.half_z1)
    z2 = snap_to_wall(z2 + w2 * time, code == WALL_Z2, value_or(law.half_z1, law.half_z2))
    z1, z2 = wrapped(z1, z2, relative, code == WRAP_Z, law.wrap_z)
    w1 = (-w1 if code == WALL_Z1 else w1) - scaled(kick, 0, law.weights)
    w2 = (-w2 if code == WALL_Z2 else w2) + scaled(kick, 1, law.weights)
    return z1, z2, w1, w2


@optional(lambda state, before, dx, dy, code, weights, rough: state)
def rough_collision(state, before, dx, dy, code, weights, rough):
    """Return ``state`` with what rough surfaces do at the event: their velocities are reversed.

    ``before`` is the state just before the event and (dx, dy) the separation. At the contact the
    surface of disc 1 moves along t = (−dy, dx)/|Δx| against disc 2 at g = Δv·t − (s1 + s2). An
    impulse along t changes velocities and spins so that g becomes −g. At a wall the velocity of the
    disc's surface against the wall is reversed.
    """
    x1, y1, x2, y2, u1, v1, u2, v2 = state
    s1, s2 = before[8], before[9]
    turn, spin = rough
    square = dx * dx + dy * dy
    meets = (code == DISC) & (square > VANISHING_SQUARE)
    distance = math.sqrt(square)
    slip = (dx * (before[5] - before[7]) - dy * (before[4] - before[6])) / distance - (s1 + s2)
    slip = slip if meets else 0.0
    push = slip * turn / distance if meets else 0.0
    push_x, push_y = -dy * push, dx * push
    u1, v1 = u1 - scaled(push_x, 0, weights), v1 - scaled(push_y, 0, weights)
    u2, v2 = u2 + scaled(push_x, 1, weights), v2 + scaled(push_y, 1, weights)
    s1, s2 = s1 + scaled(slip * spin, 0, weights), s2 + scaled(slip * spin, 1, weights)
    u1, v1, s1 = rough_wall_collision(
        u1, v1, s1, before[4], before[5], code == WALL_X1, code == WALL_Y1, turn, spin
    )
    u2, v2, s2 = rough_wall_collision(
        u2, v2, s2, before[6], before[7], code == WALL_X2, code == WALL_Y2, turn, spin
    )
    return x1, y1, x2, y2, u1, v1, u2, v2, s1, s2


@inlined
def rough_wall_collision(u, v, s, u_before, v_before, on_x, on_y, turn, spin):
    """Return (u, v, s) of a rough disc that may be on a wall of x or of y."""
    side_x, side_y = math.copysign(1.0, u_before), math.copysign(1.0, v_before)
    slip_y, slip_x = v_before + side_x * s, u_before - side_y * s
    v -= 2.0 * turn * slip_y if on_x else 0.0
    u -= 2.0 * turn * slip_x if on_y else 0.0
    s -= 2.0 * spin * side_x * slip_y if on_x else 0.0
    s += 2.0 * spin * side_y * slip_x if on_y else 0.0
    return u, v, s


@optional(lambda state, velocity, depth: None)
def put_deep_velocities(state, velocity, depth):
    """Put w1 and w2 into ``velocity``."""
    velocity[2], velocity[6] = state[10], state[11]


@optional(lambda state, velocity, depth: ())
def redrawn_deep(state, velocity, depth):
    """Return what balls append to a state with a new ``velocity``."""
    return state[8], state[9], velocity[2], velocity[6]


@optional(lambda state, velocity, inertia: None)
def put_spins(state, velocity, inertia):
    """Put the spins into ``velocity``."""
    velocity[3], velocity[7] = state[8], state[9]


@optional(lambda velocity, inertia: ())
def redrawn_spins(velocity, inertia):
    """Return what rough discs append to a state with a new ``velocity``."""
    return velocity[3], velocity[7]


@inlined
def redrawn(state, stream, direction, velocity, sampler):
    """Return a ``state`` after a kick: its velocities and spins are drawn anew from a ``stream``.

    In velocities scaled by the roots of masses and moments of inertia, they are uniform on a
    sphere. Its points have the kinetic energy of this moment and the conserved momenta.
    ``direction`` (6) and ``velocity`` (8) are overwritten.
    """
    prism, (m1, m2) = sampler.prism, sampler.masses
    velocity[:] = 0.0
    velocity[0], velocity[1], velocity[4], velocity[5] = state[4], state[5], state[6], state[7]
    put_deep_velocities(state, velocity, prism.depth)
    put_spins(state, velocity, prism.inertia)
    s1, s2 = velocity[3], velocity[7]
    square = sampler.inertias[0] * s1 * s1 + sampler.inertias[1] * s2 * s2
    drift_x = drift_y = drift_z = 0.0
    for axis in range(3):
        p1, p2 = velocity[axis], velocity[axis + 4]
        square += m1 * p1 * p1 + m2 * p2 * p2
        if prism.conserved[axis]:
            drift = (m1 * p1 + m2 * p2) / (m1 + m2)
            square -= (m1 + m2) * drift * drift
            drift_x = drift if axis == 0 else drift_x
            drift_y = drift if axis == 1 else drift_y
            drift_z = drift if axis == 2 else drift_z
    draw_velocities(stream, prism, math.sqrt(max(square, 0.0)), -1, direction, velocity)
    for disc in (0, 4):
        velocity[disc] += drift_x
        velocity[disc + 1] += drift_y
        velocity[disc + 2] += drift_z
    plain = (
        state[0], state[1], state[2], state[3],
        velocity[0], velocity[1], velocity[4], velocity[5],
    )  # fmt: skip
    deep = redrawn_deep(state, velocity, prism.depth)
    return plain + deep + redrawn_spins(velocity, prism.inertia)


# The law ----------------------------------------------------------------------------------------


@inlined
def wall_quotient(position, velocity, limit):
    """Return (gap, speed) towards the wall ahead, at ±``limit``; the time to it is gap / speed.

    ``speed`` is 0 for a disc that never gets there. A disc that a rounding has put behind the wall
    it moves to reaches it after a rounding of time.
    """
    return abs(math.copysign(limit, velocity) - position), abs(velocity)


@optional(lambda position, velocity, limit, field: wall_quotient(position, velocity, limit))
def fall_quotient(position, velocity, limit, field):
    """Return (gap, speed) towards the wall that a disc in a field hits first, at ±``limit``.

    Without a field (None) that is ``wall_quotient``. A disc that rises fast enough, v² > 2 g (limit
    − y), hits the upper wall; every other one falls on the lower one. The roots of y + v t − g t²/2
    = ±limit are taken in the forms that do not cancel.
    """
    above, below = abs(limit - position), abs(limit + position)
    square = velocity * velocity
    left = square - 2.0 * field * above
    at_top, at_bottom = math.sqrt(left), math.sqrt(square + 2.0 * field * below)
    rises = velocity > 0.0
    hits = rises & (left > 0.0)
    # Downwards the time is (v + root)/g, which is 2 below/(root − v).
    gap = velocity + at_bottom if rises else 2.0 * below
    speed = field if rises else at_bottom - velocity
    return 2.0 * above if hits else gap, velocity + at_top if hits else speed


def _walls_quotient(q1, q2, p1, p2, half1, half2, field, code1, code2, code_wrap, wrap):
    gap1, speed1 = fall_quotient(q1, p1, half1, field)
    gap2, speed2 = fall_quotient(q2, p2, value_or(half1, half2), field)
    # A speed of 0 or NaN never comes first, because 0 · gap < gap · speed is false. If disc 1 rests
    # on its wall, its time is 0/0. Disc 2 would not come before that, so disc 1 is left out.
    second = (gap2 * speed1 < gap1 * speed2) | (speed1 == 0.0)
    return gap2 if second else gap1, speed2 if second else speed1, code2 if second else code1


@optional(_walls_quotient)
def axis_quotient(q1, q2, p1, p2, half1, half2, field, code1, code2, code_wrap, wrap):
    """Return (gap, speed, code) of the first thing that happens along one axis.

    Between walls that is a disc at a wall; on a periodic axis it is the separation at half a
    period.
    """
    gap, speed = wall_quotient(q1 - q2, p1 - p2, wrap[0])
    return gap, speed, code_wrap


@inlined
def contact_quotient(dx, dy, dz, du, dv, dw, sigma):
    """Return (gap, speed, approach) for a separation (dx, dy, dz) and relative velocity.

    In the plane dz and dw are None. They touch after gap / speed, if the approach counts and
    ``speed`` is a number. The equation is a t² + 2 b t + c = 0 with c = |Δx|² − σ², b = Δx·Δv, a =
    |Δv|². Its discriminant b² − a c is computed as a σ² − (Δx ∧ Δv)², which does not cancel if
    discs graze. If they miss, it is negative and ``speed`` is NaN. The root is taken as c / (√disc
    − b), which does not cancel near contact. In a uniform field the relative motion is as straight.

    Only the direction, b < 0, decides whether there is a contact; there is no tolerance on the
    distance. Discs that touch and separate do not collide, and discs that touch and approach
    collide now.
    """
    b = dot(dx, dy, dz, du, dv, dw)
    c = dot(dx, dy, dz, dx, dy, dz) - sigma * sigma
    square = dot(du, dv, dw, du, dv, dw) * (sigma * sigma)
    discriminant = square - cross_square(dx, dy, dz, du, dv, dw)
    return c, math.sqrt(discriminant) - b, b < -RESTING_SPEED * sigma


@inlined
def meeting(state, law):
    """Return (gap, speed) of the discs; they touch after gap / speed, if that is a number.

    ``gap`` is infinite if they separate or rest, and ``speed`` is NaN if they miss.
    """
    x1, y1, x2, y2, u1, v1, u2, v2 = state[:8]
    z1, z2, w1, w2 = depth_part(state, law.depth)
    gap, speed, approach = contact_quotient(
        x1 - x2, y1 - y2, difference(z1, z2), u1 - u2, v1 - v2, difference(w1, w2), law.sigma
    )
    return gap if approach else INFINITE_GAP, speed


@inlined
def next_event(state, remaining, law):
    """Return (time, code) of the first event within the ``remaining`` time."""
    gap, speed = meeting(state, law)
    return first_event(state, remaining, gap, speed, law)


@inlined
def first_event(state, remaining, gap_d, speed_d, law):
    """Return (time, code) of the first event within the ``remaining`` time.

    ``gap_d`` and ``speed_d`` are the result of ``meeting`` for this state.

    If a disc reaches a wall and the other disc at the same time, the wall comes first. If discs
    reach several walls at the same time, one wall comes now and the others after a time of zero.
    The outcome is the same, and no event is lost.
    """
    x1, y1, x2, y2, u1, v1, u2, v2 = state[:8]
    gap_x, speed_x, code_x = axis_quotient(
        x1, x2, u1, u2, law.half_x1, law.half_x2, None, WALL_X1, WALL_X2, WRAP_X, law.wrap_x
    )
    gap_y, speed_y, code_y = axis_quotient(
        y1, y2, v1, v2, law.half_y1, law.half_y2, law.field, WALL_Y1, WALL_Y2, WRAP_Y, law.wrap_y
    )

    # A tree of comparisons has a shorter latency than a chain.
    sooner = gap_x < remaining * speed_x
    gap = gap_x if sooner else remaining
    speed = speed_x if sooner else 1.0
    code = code_x if sooner else END_OF_TIME

    sooner = gap_y * speed < gap * speed_y
    gap = gap_y if sooner else gap
    speed = speed_y if sooner else speed
    code = code_y if sooner else code

    gap, speed, code = deep_event(gap, speed, code, state, law, law.depth)

    sooner = gap_d * speed < gap * speed_d
    gap = gap_d if sooner else gap
    speed = speed_d if sooner else speed
    code = DISC if sooner else code

    time = gap / speed
    # Discs that overlap by a rounding and approach collide now.
    return time if time > 0.0 else 0.0, code


@inlined
def after_event(state, time, code, law):
    """Return the state after a free flight of ``time`` and the event ``code`` that ends it.

    A disc that hits a wall is put on the wall exactly. Discs that collide exchange the components
    of their velocities along the line of centres, weighted by 2 m/M of the other disc. The exchange
    is divided by the |Δx|² of this moment, not by σ². The energy then has an error of one rounding,
    with a random sign.
    """
    x1, y1, x2, y2, u1, v1, u2, v2 = state[:8]
    z1, z2, w1, w2 = depth_part(state, law.depth)
    du, dv, dw = u1 - u2, v1 - v2, difference(w1, w2)
    x1, x2 = x1 + u1 * time, x2 + u2 * time
    y1, v1 = free_flight(y1, v1, time, law.field)
    y2, v2 = free_flight(y2, v2, time, law.field)
    dx, dy, dz = x1 - x2, y1 - y2, difference(moved(z1, time, w1), moved(z2, time, w2))
    square = dot(dx, dy, dz, dx, dy, dz)
    exchange = dot(dx, dy, dz, du, dv, dw) / square
    exchange = exchange if (code == DISC) & (square > VANISHING_SQUARE) else 0.0
    kick_x, kick_y, kick_z = exchange * dx, exchange * dy, product(exchange, dz)
    before = (x1, y1, x2, y2, u1, v1, u2, v2)

    x1 = snap_to_wall(x1, code == WALL_X1, law.half_x1)
    y1 = snap_to_wall(y1, code == WALL_Y1, law.half_y1)
    x2 = snap_to_wall(x2, code == WALL_X2, value_or(law.half_x1, law.half_x2))
    y2 = snap_to_wall(y2, code == WALL_Y2, value_or(law.half_y1, law.half_y2))
    x1, x2 = wrapped(x1, x2, du, code == WRAP_X, law.wrap_x)
    y1, y2 = wrapped(y1, y2, dv, code == WRAP_Y, law.wrap_y)
    u1 = (-u1 if code == WALL_X1 else u1) - scaled(kick_x, 0, law.weights)
    v1 = (-v1 if code == WALL_Y1 else v1) - scaled(kick_y, 0, law.weights)
    u2 = (-u2 if code == WALL_X2 else u2) + scaled(kick_x, 1, law.weights)
    v2 = (-v2 if code == WALL_Y2 else v2) + scaled(kick_y, 1, law.weights)
    after = (x1, y1, x2, y2, u1, v1, u2, v2)
    after = rough_collision(
        after, before + spins(state, law.rough), dx, dy, code, law.weights, law.rough
    )
    return after + deep_after(state, time, code, kick_z, law, law.depth)


@inlined
def crosses(before, after):
    """Say whether a difference of coordinates changed sign; zero counts as positive."""
    return (before < 0.0) != (after < 0.0)


@inlined
def crossing_time(before, relative_velocity):
    """Return when in the flight the difference ``before`` becomes zero: −Δ/Δv, not interpolated."""
    return -before / relative_velocity
