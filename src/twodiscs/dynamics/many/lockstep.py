"""Counts of events of N equal discs in a fixed time: the law of one event in lock step.

The law of an event is the law of two discs, in ``law``. Quotients ``gap / speed`` of walls and
contacts are compared by cross-multiplication. Only the direction decides whether discs in contact
collide. A disc is put on its wall exactly, and velocities are exchanged along the line of centres.
The states of all lanes are arrays (N, lanes). The outer loops are over discs and pairs of discs.
The inner loops are over lanes, and become vector instructions. An event costs N(N − 1)/2 contacts.

On a ring of x two images of a disc count, the nearest one and the next on the other side. A flight
ends after half the circumference over the largest relative speed, √2, and the search begins again.
A third image is therefore never reached.

Rough discs have spins s, an array (N, lanes) like the velocities; for smooth discs it is None.
"""

import math
from typing import NamedTuple

import numpy as np

from twodiscs.dynamics.ensemble import (
    LANES,
    SWEEPS,
    Kicks,
    before_kick,
    idle_kicks,
    open_kicks,
    renew_kicks,
)
from twodiscs.dynamics.law import (
    END_OF_TIME,
    NEVER,
    VANISHING,
    contact_quotient,
    crosses,
    divided,
    rough_wall_collision,
    wall_quotient,
)
from twodiscs.sampling.jit import compiled, inlined, optional
from twodiscs.sampling.many.initial import (
    draw_velocities,
    put_spins,
    spin_of,
    spins_in,
    velocity_memory,
)

#: A flight on a ring that ends without an event.
LOOK_AGAIN = -1.0

#: Classes of events, in the order of all counts. Both walls of an axis are in one class.
CLASSES = ("vertical_hop", "horizontal_hop", "disc_collision", "right_wall", "top_wall")
N = len(CLASSES)
VERTICAL, HORIZONTAL, COLLISIONS, BESIDE, ABOVE = range(N)


class ManyLaw(NamedTuple):
    """The constants of the motion: half-ranges of the centres, σ, and those of effects.

    ``ring`` is (circumference, half of it, the longest flight); ``half_x`` is None then. ``rough``
    is that of ``law.Law``, and √(1/κ). Both are None without the effect.
    """

    half_x: float | None
    half_y: float
    sigma: float
    ring: tuple | None = None
    rough: tuple | None = None


def law_of(scene):
    """Return the ``ManyLaw`` of a ``Scene``."""
    half_x, ring, rough = scene.range_x / 2, None, None
    if scene.periodic:
        half_x, half = None, scene.width / 2
        ring = scene.width, half, half / math.sqrt(2)
    if scene.moment_of_inertia is not None:
        rough = *divided(1.0, scene.moment_of_inertia, 1.0), spin_of(scene)
    return ManyLaw(half_x, scene.range_y / 2, scene.contact_distance, ring, rough)


def new_kicks(scene, lanes):
    """Return the ``Kicks`` of some ``lanes``, which ``open_kicks`` begins; None without friction.

    The working memory of a draw has the form that ``draw_velocities`` takes.
    """
    if not scene.friction:
        return None
    velocities, cuts = velocity_memory(scene.discs, scene.moment_of_inertia)
    return idle_kicks(lanes, scene.friction, cuts, velocities)


@optional(lambda u, l, ring: 0.0)
def drift(u, l, ring):
    """Return the mean velocity along a ring in lane ``l``, which is conserved; 0 between walls."""
    return np.sum(u[:, l]) / u.shape[0]


@optional(lambda u, l, ring, rough: drift(u, l, ring))
def conserved_drift(u, l, ring, rough):
    """Return ``drift``, or 0 for rough discs, whose walls take momentum."""
    return 0.0


@optional(lambda rough: None)
def spin_scale(rough):
    """Return √(1/κ) of rough discs, or None."""
    return rough[2]


@compiled
def redraw(u, v, spins, l, lane, law, kicks):
    """Draw the velocities in column ``l`` of ``u`` and ``v`` anew, in a kick of a ``lane``.

    They are uniform on the sphere of the energy 1/2 and, along a ring, of the same momentum. The
    ``spins`` of rough discs are drawn with them.
    """
    discs, mean = u.shape[0], conserved_drift(u, l, law.ring, law.rough)
    draw_velocities(
        kicks.streams[lane], kicks.velocity, kicks.direction, law.ring, spin_scale(law.rough)
    )  # fmt: skip
    put_spins(kicks.velocity, spins, l, law.rough)
    scale = math.sqrt(max(1.0 - discs * mean * mean, 0.0))
    for i in range(discs):
        u[i, l], v[i, l] = mean + scale * kicks.velocity[0, i], scale * kicks.velocity[1, i]
    renew_kicks(lane, kicks)


@optional(lambda u, v, spins, times, law, kicks: None)
def kick_lanes(u, v, spins, times, law, kicks):
    """Kick the lanes whose kick is due after flights of ``times`` (lanes,)."""
    for l in range(times.size):
        kicks.waits[l] -= times[l]
        if kicks.waits[l] <= 0.0:
            redraw(u, v, spins, l, l, law, kicks)


# Rough discs: without them nothing is compiled ----------------------------------------------------


@optional(lambda lanes, discs, rough: None)
def new_spins(lanes, discs, rough):
    """Return an array (N, lanes) for spins."""
    return np.zeros((discs, lanes))


@optional(lambda states, rough: states.shape[0] // 4)
def discs_in(states, rough):
    """Return the number of discs in ``states``."""
    return states.shape[0] // 5


@optional(lambda states, k, l, spins: None)
def take_spins(states, k, l, spins):
    """Copy the spins in column ``k`` of ``states`` (5N, …) to column ``l`` of ``spins``."""
    for i in range(spins.shape[0]):
        spins[i, l] = states[4 * spins.shape[0] + i, k]


@optional(lambda i, spins: None)
def row(i, spins):
    """Return the spins of disc ``i``."""
    return spins[i]


@inlined
def rub(dx, dy, du, dv, spin, meets, rough):
    """Return the changes (of u and v of the first disc, of both spins) of discs that meet.

    (dx, dy) and (du, dv) are the first minus the second, ``spin`` is the sum. The law is that of
    ``law.rough_collision``. The impulse along the line of centres changes nothing here.
    """
    distance = math.sqrt(dx * dx + dy * dy)
    slip = (dx * dv - dy * du) / distance - spin
    push = slip * rough[0] / distance if meets else 0.0
    return dy * push, -dx * push, slip * rough[1] if meets else 0.0


@optional(lambda u, v, other_u, other_v, l, dx, dy, meets, s, other_s, rough: None)
def rub_discs(u, v, other_u, other_v, l, dx, dy, meets, s, other_s, rough):
    """Reverse the velocity of the surfaces of two discs against each other in a lane ``l``."""
    change_u, change_v, change_s = rub(
        dx, dy, u[l] - other_u[l], v[l] - other_v[l], s[l] + other_s[l], meets, rough
    )
    u[l] += change_u
    v[l] += change_v
    other_u[l] -= change_u
    other_v[l] -= change_v
    s[l] += change_s
    other_s[l] += change_s


@optional(lambda u, v, l, on_x, on_y, s, rough: None)
def rub_walls(u, v, l, on_x, on_y, s, rough):
    """Reverse the velocity of a disc's surface along a wall, in a lane ``l``, before it rebounds.

    ``on_x`` and ``on_y`` say whether it is on a wall of x or y.
    """
    u[l], v[l], s[l] = rough_wall_collision(
        u[l], v[l], s[l], u[l], v[l], on_x, on_y, rough[0], rough[1]
    )


# One event ----------------------------------------------------------------------------------------


@optional(lambda gap, speed, code, sooner_gap, sooner_speed, number, half: (gap, speed, code))
def first_of(gap, speed, code, other_gap, other_speed, number, half):
    """Return (gap, speed, code) of the earlier event; without ``half`` (None) of the first one."""
    sooner = other_gap * speed < gap * other_speed
    return (
        other_gap if sooner else gap,
        other_speed if sooner else speed,
        number if sooner else code,
    )


@optional(lambda position, velocity, half: (NEVER, 1.0))
def walled_quotient(position, velocity, half):
    """Return (gap, speed) to the wall ahead; without walls (``half`` None) the gap is infinite."""
    return wall_quotient(position, velocity, half)


@optional(lambda separation, ring: separation)
def nearest(separation, ring):
    """Return the separation of the nearest image on a ring."""
    period, half, _ = ring
    separation -= period if separation > half else 0.0
    separation += period if separation < -half else 0.0
    return separation


@optional(lambda before, after, ring: crosses(before, after))
def changes_order(before, after, ring):
    """Return whether a separation along x changes sign in a flight; on a ring, the nearest image.

    A flight on a ring changes a separation by less than half of the circumference. If the change is
    larger, another image has become the nearest one.
    """
    before, after = nearest(before, ring), nearest(after, ring)
    return crosses(before, after) & (abs(after - before) < ring[1])


@optional(lambda dx, dy, du, dv, sigma, ring: contact_of(dx, dy, du, dv, sigma))
def meeting_of(dx, dy, du, dv, sigma, ring):
    """Return (gap, speed) of two discs; on a ring, of the image that is met first."""
    gap, speed = contact_of(dx, dy, du, dv, sigma)
    other_gap, other_speed = contact_of(dx - math.copysign(ring[0], dx), dy, du, dv, sigma)
    # If one speed is not a number, the other image is met.
    other = (other_gap * speed < gap * other_speed) | (speed != speed)
    return other_gap if other else gap, other_speed if other else speed


@inlined
def contact_of(dx, dy, du, dv, sigma):
    """Return (gap, speed) of two discs; the gap is infinite if they separate."""
    gap, speed, approach = contact_quotient(dx, dy, None, du, dv, None, sigma)
    return gap if approach else NEVER, speed


@optional(lambda limit, code, ring: (limit, code))
def soonest(limit, code, ring):
    """Return (time, code) of the end of a flight without an event."""
    again = ring[2] < limit
    return ring[2] if again else limit, LOOK_AGAIN if again else code


@optional(lambda position, hit, half: position)
def on_wall(position, hit, half):
    """Return the position, put on the wall at ±``half`` exactly if it is ``hit``."""
    return math.copysign(half, position) if hit else position


@compiled
def find_events(x, y, u, v, remaining, times, codes, speeds, law, kicks=None):
    """Fill ``times`` and ``codes`` (lanes,) with the first event of each lane within its time.

    A flight that a kick ends has the code of the end of time, and ``kick_lanes`` has to follow.
    """
    discs, lanes = x.shape
    for l in range(lanes):
        left = before_kick(remaining[l], l, kicks)
        times[l], codes[l] = soonest(left, END_OF_TIME, law.ring)
        speeds[l] = 1.0
    number = 1.0
    for i in range(discs):
        xi, yi, ui, vi = x[i], y[i], u[i], v[i]
        for l in range(lanes):
            gap, speed = walled_quotient(xi[l], ui[l], law.half_x)
            gap, speed, code = first_of(
                times[l], speeds[l], codes[l], gap, speed, number, law.half_x
            )
            gap_y, speed_y = wall_quotient(yi[l], vi[l], law.half_y)
            times[l], speeds[l], codes[l] = first_of(
                gap, speed, code, gap_y, speed_y, number + 1.0, law.half_y
            )
        number += 2.0
    for i in range(discs):
        xi, yi, ui, vi = x[i], y[i], u[i], v[i]
        for j in range(i):
            xj, yj, uj, vj = x[j], y[j], u[j], v[j]
            for l in range(lanes):
                gap, speed = meeting_of(
                    nearest(xi[l] - xj[l], law.ring), yi[l] - yj[l], ui[l] - uj[l], vi[l] - vj[l],
                    law.sigma, law.ring,
                )  # fmt: skip
                times[l], speeds[l], codes[l] = first_of(
                    times[l], speeds[l], codes[l], gap, speed, number, law.half_y
                )
            number += 1.0
    for l in range(lanes):
        time = times[l] / speeds[l]
        # Discs that overlap by a rounding and approach collide now.
        times[l] = time if time > 0.0 else 0.0


@compiled
def advance(x, y, u, v, old_x, old_y, remaining, times, codes, counts, law, hops_x, spins=None):
    """Advance every lane by its event and count it in ``counts`` (n, lanes), doubles.

    Rough discs have ``spins``.
    """
    discs, lanes = x.shape
    pairs = 1.0 + 2.0 * discs
    hops, across, hits, beside, above = counts[0], counts[1], counts[2], counts[3], counts[4]
    for l in range(lanes):
        remaining[l] -= times[l]
        hits[l] += 1.0 if codes[l] >= pairs else 0.0
    for i in range(discs):
        xi, yi, ui, vi, oxi, oyi = x[i], y[i], u[i], v[i], old_x[i], old_y[i]
        si, number = row(i, spins), 1.0 + 2.0 * i
        for l in range(lanes):
            on_x, on_y = codes[l] == number, codes[l] == number + 1.0
            oxi[l], oyi[l] = xi[l], yi[l]
            xi[l] = nearest(on_wall(xi[l] + ui[l] * times[l], on_x, law.half_x), law.ring)
            yi[l] = on_wall(yi[l] + vi[l] * times[l], on_y, law.half_y)
            rub_walls(ui, vi, l, on_x, on_y, si, law.rough)
            ui[l] = -ui[l] if on_x else ui[l]
            vi[l] = -vi[l] if on_y else vi[l]
            beside[l] += 1.0 if on_x else 0.0
            above[l] += 1.0 if on_y else 0.0
    number = pairs
    for i in range(discs):
        xi, yi, ui, vi, oxi, oyi = x[i], y[i], u[i], v[i], old_x[i], old_y[i]
        si = row(i, spins)
        for j in range(i):
            xj, yj, uj, vj, oxj, oyj = x[j], y[j], u[j], v[j], old_x[j], old_y[j]
            sj = row(j, spins)
            for l in range(lanes):
                dx, dy = xi[l] - xj[l], yi[l] - yj[l]
                hops[l] += 1.0 if crosses(oyi[l] - oyj[l], dy) else 0.0
                if hops_x is not None:
                    across[l] += 1.0 if changes_order(oxi[l] - oxj[l], dx, law.ring) else 0.0
                dx = nearest(dx, law.ring)
                square = dx * dx + dy * dy
                exchange = (dx * (ui[l] - uj[l]) + dy * (vi[l] - vj[l])) / square
                meets = (codes[l] == number) & (square > VANISHING)
                exchange = exchange if meets else 0.0
                ui[l] -= exchange * dx
                vi[l] -= exchange * dy
                uj[l] += exchange * dx
                vj[l] += exchange * dy
                rub_discs(ui, vi, uj, vj, l, dx, dy, meets, si, sj, law.rough)
            number += 1.0


@compiled
def count_events(states, seed, first, lanes, duration, law, hops_x, kicks):
    """Follow the columns of ``states`` (rows, replicas) for a ``duration`` and add up their counts.

    Returns (sums, products): Σ N_e (n) and Σ N_e N_f for e ≤ f (n, n) over all replicas, int64, in
    the order of ``CLASSES``. ``hops_x`` is None if hops in x are not counted. ``kicks`` are those
    of the lanes, None without friction: the column k has the stream of ``seed`` for the replica
    ``first`` + k.
    """
    discs, replicas = discs_in(states, law.rough), states.shape[1]
    x, y = np.zeros((discs, lanes)), np.zeros((discs, lanes))
    u, v = np.zeros((discs, lanes)), np.zeros((discs, lanes))
    old_x, old_y = np.zeros((discs, lanes)), np.zeros((discs, lanes))
    spins = new_spins(lanes, discs, law.rough)
    remaining, times = np.zeros(lanes), np.zeros(lanes)
    codes, speeds = np.zeros(lanes), np.zeros(lanes)
    counts, busy = np.zeros((N, lanes)), np.zeros(lanes, np.bool_)
    sums, products = np.zeros(N, np.int64), np.zeros((N, N), np.int64)
    count = np.zeros(N, np.int64)
    used, running = 0, 0
    while True:
        for l in range(lanes):
            if remaining[l] > 0.0:
                continue
            if busy[l]:
                for e in range(N):
                    count[e] = np.int64(counts[e, l])
                    counts[e, l] = 0.0
                for e in range(N):
                    sums[e] += count[e]
                    for f in range(e, N):
                        products[e, f] += count[e] * count[f]
                busy[l] = False
                running -= 1
            if used < replicas:
                for i in range(discs):
                    x[i, l], y[i, l] = states[i, used], states[discs + i, used]
                    u[i, l], v[i, l] = states[2 * discs + i, used], states[3 * discs + i, used]
                take_spins(states, used, l, spins)
                open_kicks(l, seed, first + used, kicks)
                remaining[l] = duration
                busy[l] = True
                running += 1
                used += 1
        if running == 0:
            return sums, products
        for _ in range(SWEEPS):
            find_events(x, y, u, v, remaining, times, codes, speeds, law, kicks)
            advance(
                x, y, u, v, old_x, old_y, remaining, times, codes, counts, law, hops_x, spins
            )  # fmt: skip
            kick_lanes(u, v, spins, times, law, kicks)


@optional(lambda laps, x, u, times, ring: None)
def count_laps(laps, x, u, times, ring):
    """Add to ``laps`` (N, lanes) the rounds that flights complete, as ``nearest`` undoes them."""
    for i in range(laps.shape[0]):
        for l in range(laps.shape[1]):
            then = x[i, l] + u[i, l] * times[l]
            laps[i, l] += (1.0 if then > ring[1] else 0.0) - (1.0 if then < -ring[1] else 0.0)


@optional(lambda first, stop, kicks: None)
def of_lanes(first, stop, kicks):
    """Return the ``Kicks`` of the lanes ``first`` … ``stop`` − 1, which share their memory."""
    waits, streams = kicks.waits[first:stop], kicks.streams[first:stop]
    return Kicks(
        kicks.rate, waits, streams, kicks.stream, kicks.direction, kicks.velocity, kicks.sampler
    )  # fmt: skip


@optional(lambda counts, first, hops: None)
def add_hops(counts, first, hops):
    """Add the hops in x in ``counts`` (n, lanes) to ``hops``, from the replica ``first`` on."""
    hops[first : first + counts.shape[1]] += counts[HORIZONTAL]


@compiled
def advance_states(states, laps, time, law, kicks, hops, lanes=LANES):
    """Advance the columns of ``states`` (rows, replicas) by a ``time`` > 0.

    On a ring the rounds of discs are added to ``laps`` (N, replicas). ``kicks`` are those of the
    columns, None without friction. The hops in x are added to ``hops`` (replicas,) unless it is
    None.
    """
    discs, replicas = laps.shape
    for first in range(0, replicas, lanes):
        stop = min(first + lanes, replicas)
        some = states[:, first:stop].copy()
        x, y = some[:discs], some[discs : 2 * discs]
        u, v = some[2 * discs : 3 * discs], some[3 * discs : 4 * discs]
        spins = spins_in(some, discs, law.rough)
        old_x, old_y, rounds = np.zeros_like(x), np.zeros_like(y), np.zeros_like(x)
        remaining, times = np.full(stop - first, time), np.zeros(stop - first)
        codes, speeds = np.zeros(stop - first), np.zeros(stop - first)
        counts, some_kicks = np.zeros((N, stop - first)), of_lanes(first, stop, kicks)
        while np.max(remaining) > 0.0:
            find_events(x, y, u, v, remaining, times, codes, speeds, law, some_kicks)
            count_laps(rounds, x, u, times, law.ring)
            advance(x, y, u, v, old_x, old_y, remaining, times, codes, counts, law, hops, spins)
            kick_lanes(u, v, spins, times, law, some_kicks)
        states[:, first:stop] = some
        laps[:, first:stop] += rounds
        add_hops(counts, first, hops)


@compiled
def hops_in_flight(before, after, l, time, when):
    """Fill ``when`` with the times at which two discs came to be level, and return how many.

    ``before`` and ``after`` (N, lanes) are coordinates at the ends of a flight of lane ``l``.
    """
    n = 0
    for i in range(before.shape[0]):
        for j in range(i):
            start, end = before[i, l] - before[j, l], after[i, l] - after[j, l]
            if crosses(start, end):
                # The list is short, and stays in the order of time.
                at, k = time * (start / (start - end)), n
                while k > 0 and when[k - 1] > at:
                    when[k] = when[k - 1]
                    k -= 1
                when[k] = at
                n += 1
    return n


@compiled
def record_intervals(states, seed, first, window, law, hops_x, bins, sums, going, kicks):
    """Record the intervals between hops of any pair, from the columns of ``states`` on.

    The hops are vertical ones, or horizontal ones if ``hops_x`` is True instead of None. All
    intervals that begin within a ``window`` of time are followed to their end. ``bins`` are
    (width, wide) as in ``two.returns``. A replica has n intervals, c of them in a bin. Σ c, Σ c²
    and Σ c n are added to ``sums`` (3, bins; int64). Returns their total time and number,
    (2, replicas) doubles. ``kicks`` are those of ``LANES`` lanes, with the streams of
    ``count_events``.
    """
    discs, width, wide = discs_in(states, law.rough), bins[0], bins[1]
    totals, per_width = np.zeros((2, states.shape[1])), 1.0 / width
    when = np.zeros(discs * (discs - 1) // 2)
    for start in range(0, states.shape[1], LANES):
        some = states[:, start : start + LANES].copy()
        x, y = some[:discs], some[discs : 2 * discs]
        u, v = some[2 * discs : 3 * discs], some[3 * discs : 4 * discs]
        spins = spins_in(some, discs, law.rough)
        lanes, own = some.shape[1], totals[:, start:]
        old_x, old_y, hits = np.zeros_like(x), np.zeros_like(y), np.zeros((N, lanes))
        endless, times = np.full(lanes, np.inf), np.zeros(lanes)
        codes, speeds, seen = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
        for l in range(lanes):
            open_kicks(l, seed, first + start + l, kicks)
        # The time of the last hop, negative before the first one, and the time since then.
        elapsed, last, age = np.zeros(lanes), np.full(lanes, -1.0), np.zeros(lanes)
        counts, busy = np.zeros((lanes, sums.shape[1]), np.int64), True
        vertical = VERTICAL, old_y, y
        hop, before, after = vertical if hops_x is None else (HORIZONTAL, old_x, x)
        while busy and going[0]:
            busy = False
            for _ in range(SWEEPS):
                find_events(x, y, u, v, endless, times, codes, speeds, law, kicks)
                advance(
                    x, y, u, v, old_x, old_y, endless, times, codes, hits, law, hops_x, spins
                )  # fmt: skip
                kick_lanes(u, v, spins, times, law, kicks)
                for l in range(lanes):
                    at = 0.0
                    if hits[hop, l] > seen[l]:
                        seen[l] = hits[hop, l]
                        for k in range(hops_in_flight(before, after, l, times[l], when)):
                            interval = age[l] + (when[k] - at)
                            if 0.0 <= last[l] < window:
                                index = min(np.int64(interval * per_width), wide.size - 1)
                                counts[l, index] += 1
                                counts[l, wide[index]] += 1
                                own[0, l] += interval
                                own[1, l] += 1.0
                            age[l], at = 0.0, when[k]
                            last[l] = elapsed[l] + at
                    age[l] += times[l] - at
                    elapsed[l] += times[l]
                    busy |= (elapsed[l] < window) | ((last[l] >= 0.0) & (last[l] < window))
        for l in range(lanes):
            for k in range(sums.shape[1]):
                sums[0, k] += counts[l, k]
                sums[1, k] += counts[l, k] * counts[l, k]
                sums[2, k] += counts[l, k] * np.int64(own[1, l])
    return totals
