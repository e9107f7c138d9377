"""One event: when it happens and what it does. Plain floats in, plain floats out.

The state of the two discs is (x1, y1, x2, y2, u1, v1, u2, v2): centres, then velocities, with the
origin at the centre of the box; centres stay within ±half_x and ±half_y. Every function here is
compiled into the lock-step ensemble, into the audit and into the trajectories for people, so the
law stands in this file only. There are no branches, only selections, so that an ensemble advances
in vector instructions.

A time is kept as a quotient ``gap / speed`` and quotients are compared by cross-multiplication: one
division an event instead of five.
"""

import math

from twodiscs.jit import compiled

#: What ended a free flight. Codes are floats because they travel in the same registers as the
#: state.
END_OF_TIME, WALL_X1, WALL_Y1, WALL_X2, WALL_Y2, DISC = 0.0, 1.0, 2.0, 3.0, 4.0, 5.0

#: Normal speeds of approach below this (four roundings of the speed scale, 1) are rest. A collision
#: at such a speed would be lost in the rounding of the velocities, and happen again and again.
RESTING_SPEED = 4 * 2.0**-52

#: Where discs are smaller than the spacing of coordinates their centres may coincide, or all but
#: do. Below this square of their distance there is no line of centres, and they go on as they are.
VANISHING = 1e-280


@compiled
def wall_quotient(position, velocity, limit):
    """Return (gap, speed) towards the wall ahead, at ±``limit``; the time to it is gap / speed.

    ``speed`` is 0 for a disc that never gets there. A disc that a rounding has put behind the wall
    it moves to reaches it after a rounding of time.
    """
    return abs(math.copysign(limit, velocity) - position), abs(velocity)


@compiled
def contact_quotient(dx, dy, du, dv, sigma):
    """Return (gap, speed, approach) for a separation (dx, dy) and relative velocity (du, dv).

    They touch after gap / speed, if the approach counts and ``speed`` is a number. The equation is
    a t² + 2 b t + c = 0 with c = |Δx|² − σ², b = Δx·Δv, a = |Δv|². Its discriminant b² − a c is
    taken as a σ² − (Δx ∧ Δv)², which does not cancel where discs graze; it is negative, and
    ``speed`` NaN, where they miss. The root is taken as c / (√disc − b), which does not cancel
    near contact.

    Whether there is a contact at all is a matter of direction, b < 0, not of a tolerance on the
    distance: discs that touch and part are left alone, discs that touch and approach collide now.
    """
    b = dx * du + dy * dv
    c = dx * dx + dy * dy - sigma * sigma
    cross = dx * dv - dy * du
    discriminant = (du * du + dv * dv) * (sigma * sigma) - cross * cross
    return c, math.sqrt(discriminant) - b, b < -RESTING_SPEED * sigma


@compiled
def next_event(x1, y1, x2, y2, u1, v1, u2, v2, remaining, half_x, half_y, sigma):
    """Return (time, code) of the first event within the ``remaining`` time.

    A wall wins over a disc that is tied with it, and of several tied walls one comes now and the
    others after a time of zero: the outcome is the same, and none is lost.
    """
    gap_x1, speed_x1 = wall_quotient(x1, u1, half_x)
    gap_y1, speed_y1 = wall_quotient(y1, v1, half_y)
    gap_x2, speed_x2 = wall_quotient(x2, u2, half_x)
    gap_y2, speed_y2 = wall_quotient(y2, v2, half_y)
    gap_d, speed_d, approach = contact_quotient(x1 - x2, y1 - y2, u1 - u2, v1 - v2, sigma)

    # A tree of comparisons rather than a chain: shorter for the processor to wait for. A speed of 0
    # never wins, because 0 · gap < gap · speed is false; nor does NaN. Disc 1 at rest on its wall
    # is 0/0, against which disc 2 would not win either, and is set aside.
    second = (gap_x2 * speed_x1 < gap_x1 * speed_x2) | (speed_x1 == 0.0)
    gap_x = gap_x2 if second else gap_x1
    speed_x = speed_x2 if second else speed_x1
    code_x = WALL_X2 if second else WALL_X1

    second = (gap_y2 * speed_y1 < gap_y1 * speed_y2) | (speed_y1 == 0.0)
    gap_y = gap_y2 if second else gap_y1
    speed_y = speed_y2 if second else speed_y1
    code_y = WALL_Y2 if second else WALL_Y1

    sooner = gap_x < remaining * speed_x
    gap = gap_x if sooner else remaining
    speed = speed_x if sooner else 1.0
    code = code_x if sooner else END_OF_TIME

    sooner = gap_y * speed < gap * speed_y
    gap = gap_y if sooner else gap
    speed = speed_y if sooner else speed
    code = code_y if sooner else code

    sooner = approach & (gap_d * speed < gap * speed_d)
    gap = gap_d if sooner else gap
    speed = speed_d if sooner else speed
    code = DISC if sooner else code

    time = gap / speed
    # Discs that overlap by a rounding and approach collide now.
    return time if time > 0.0 else 0.0, code


@compiled
def after_event(x1, y1, x2, y2, u1, v1, u2, v2, time, code, half_x, half_y):
    """Return the state after a free flight of ``time`` and the event ``code`` that ends it.

    A disc that hits a wall is put on the wall exactly. Discs that collide exchange the components
    of their velocities along the line of centres; dividing by the |Δx|² of this very moment, not
    by σ², keeps the energy to a rounding whose sign is random.
    """
    du, dv = u1 - u2, v1 - v2
    x1, y1, x2, y2 = x1 + u1 * time, y1 + v1 * time, x2 + u2 * time, y2 + v2 * time
    dx, dy = x1 - x2, y1 - y2
    square = dx * dx + dy * dy
    exchange = (dx * du + dy * dv) / square
    exchange = exchange if (code == DISC) & (square > VANISHING) else 0.0
    kick_x, kick_y = exchange * dx, exchange * dy

    x1 = math.copysign(half_x, x1) if code == WALL_X1 else x1
    y1 = math.copysign(half_y, y1) if code == WALL_Y1 else y1
    x2 = math.copysign(half_x, x2) if code == WALL_X2 else x2
    y2 = math.copysign(half_y, y2) if code == WALL_Y2 else y2
    u1 = (-u1 if code == WALL_X1 else u1) - kick_x
    v1 = (-v1 if code == WALL_Y1 else v1) - kick_y
    u2 = (-u2 if code == WALL_X2 else u2) + kick_x
    v2 = (-v2 if code == WALL_Y2 else v2) + kick_y
    return x1, y1, x2, y2, u1, v1, u2, v2


@compiled
def crosses(before, after):
    """Say whether a difference of coordinates changed sign; zero counts as positive."""
    return (before < 0.0) != (after < 0.0)


@compiled
def crossing_time(before, relative_velocity):
    """Return when in the flight the difference ``before`` becomes zero: −Δ/Δv, not interpolated."""
    return -before / relative_velocity
