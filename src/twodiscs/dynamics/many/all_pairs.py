"""Counts of events of N equal discs in a fixed time: the law of one event in lock step.

The law of an event is the law of two discs, in ``law``. Quotients ``gap / speed`` of walls and
contacts are compared by cross-multiplication. Only the direction decides whether discs in contact
collide. A disc is put on its wall exactly, and velocities are exchanged along the line of centres.
The states of all lanes are arrays (N, lanes). The outer loops are over discs and pairs of discs.
The inner loops are over lanes, and become vector instructions. An event costs N(N − 1)/2 contacts.

Along a periodic axis two images of a disc count, the nearest one and the next on the other side; on
a torus there are four. A flight ends after half the circumference over the largest relative speed,
√2, and the search begins again. A third image along an axis is therefore never reached.

Rough discs have spins s, an array (N, lanes) like the velocities; for smooth discs it is None.
"""

import math
from typing import NamedTuple

import numpy as np

from twodiscs.dynamics import ensemble
from twodiscs.dynamics.law import (
    END_OF_TIME,
    INFINITE_GAP,
    VANISHING_SQUARE,
    contact_quotient,
    crosses,
    divided,
    rough_wall_collision,
    snap_to_wall,
    wall_quotient,
)
from twodiscs.model.events import by_kind
from twodiscs.sampling.jit import compiled, inlined, optional
from twodiscs.sampling.many import many_initial_states
from twodiscs.sampling.many.insertions import periods, ring_separation

#: A flight on a ring that ends without an event.
LOOK_AGAIN = -1.0

#: The largest relative speed of two discs.
SQRT_2 = math.sqrt(2)

#: Classes of events, in the order of all counts. Both walls of an axis are in one class.
CLASSES = ("vertical_hop", "horizontal_hop", "disc_collision", "right_wall", "top_wall")
N_CLASSES = len(CLASSES)
VERTICAL_HOPS, HORIZONTAL_HOPS, COLLISIONS, X_WALLS, Y_WALLS = range(N_CLASSES)

#: The classes whose counts are those of an event, in the order of ``EVENTS``.
EVENT_CLASSES = by_kind(
    "dynamics/many/all_pairs.py",
    {
        "hop": lambda event: ("vertical_hop" if event.axis == "y" else "horizontal_hop",),
        "collision": lambda event: ("disc_collision",),
        "wall": lambda event: ("right_wall" if event.axis == "x" else "top_wall",),
        "walls": lambda event: ("right_wall", "top_wall"),
    },
)


class ManyLaw(NamedTuple):
    """The constants of the motion: half-ranges of the centres, σ, and those of effects.

    ``ring_x`` is the circumference if x is periodic; ``half_x`` is None then. So it is for y.
    ``rough`` is that of ``law.Law``, ``spin`` is √(1/κ). They are None without the effect.
    """

    half_x: float | None
    half_y: float | None
    sigma: float
    ring_x: float | None = None
    ring_y: float | None = None
    rough: tuple | None = None
    spin: float | None = None


class Lanes(NamedTuple):
    """The discs of all lanes, arrays (N, lanes), and their flights, arrays (lanes,).

    Flights began at (old_x, old_y). ``spins`` are None for smooth discs. ``counts`` (n, lanes) are
    doubles, in the order of ``CLASSES``.
    """

    x: np.ndarray
    y: np.ndarray
    u: np.ndarray
    v: np.ndarray
    spins: np.ndarray | None
    old_x: np.ndarray
    old_y: np.ndarray
    remaining: np.ndarray
    times: np.ndarray
    codes: np.ndarray
    speeds: np.ndarray
    counts: np.ndarray


@compiled
def new_lanes(states, remaining, law):
    """Return the ``Lanes`` that move the columns of ``states`` (rows, lanes) for these times."""
    n, lanes = discs_in(states, law.rough), remaining.size
    return Lanes(
        states[:n], states[n : 2 * n], states[2 * n : 3 * n], states[3 * n : 4 * n],
        many_initial_states.spins_in(states, n, law.rough),
        np.zeros((n, lanes)), np.zeros((n, lanes)),
        remaining, np.zeros(lanes), np.zeros(lanes), np.zeros(lanes), np.zeros((N_CLASSES, lanes)),
    )  # fmt: skip


def many_disc_law(scene):
    """Return the ``ManyLaw`` of a ``Scene``."""
    half_x = None if "x" in scene.periodic else scene.range_x / 2
    half_y = None if "y" in scene.periodic else scene.range_y / 2
    spin = many_initial_states.spin_factor(scene)
    rough = None if spin is None else divided(1.0, scene.moment_of_inertia, 1.0)
    return ManyLaw(half_x, half_y, scene.contact_distance, *periods(scene), rough, spin)


def new_kicks(scene, lanes):
    """Return the ``Kicks`` of some ``lanes``, which ``open_kicks`` begins; None without friction.

    The working memory of a draw has the form that ``draw_velocities`` takes.
    """
    velocities, cuts = many_initial_states.velocity_memory(scene.discs, scene.moment_of_inertia)
    return ensemble.idle_kicks(scene, lanes, cuts, velocities)


@optional(lambda u, l, spin, ring: 0.0)
def drift(u, l, spin, ring):
    """Return the conserved mean of velocities ``u`` along a periodic axis in lane ``l``.

    It is 0 between walls, and for rough discs, whose walls take momentum.
    """
    return np.sum(u[:, l]) / u.shape[0] if spin is None else 0.0


@compiled
def redraw(u, v, spins, l, lane, law, kicks):
    """Draw the velocities in column ``l`` of ``u`` and ``v`` anew, in a kick of a ``lane``.

    They are uniform on the sphere of the energy 1/2 and, along periodic axes, of the same momentum.
    The ``spins`` of rough discs are drawn with them.
    """
    discs, velocity = u.shape[0], kicks.velocity
    mean_u, mean_v = drift(u, l, law.spin, law.ring_x), drift(v, l, law.spin, law.ring_y)
    many_initial_states.draw_velocities(
        kicks.streams[lane], velocity, kicks.direction, law.ring_x, law.ring_y, law.spin
    )
    many_initial_states.put_spins(velocity, spins, l, law.rough)
    scale = math.sqrt(max(1.0 - discs * mean_u * mean_u - discs * mean_v * mean_v, 0.0))
    for i in range(discs):
        u[i, l], v[i, l] = mean_u + scale * velocity[0, i], mean_v + scale * velocity[1, i]
    ensemble.renew_kicks(lane, kicks)


@optional(lambda lanes, law, kicks: None)
def kick_lanes(lanes, law, kicks):
    """Kick the lanes whose kick is due after their flights."""
    for l in range(lanes.times.size):
        kicks.waits[l] -= lanes.times[l]
        if kicks.waits[l] <= 0.0:
            redraw(lanes.u, lanes.v, lanes.spins, l, l, law, kicks)


# Rough discs: without them nothing is compiled ----------------------------------------------------


@optional(lambda lanes, discs, rough: None)
def new_spins(lanes, discs, rough):
    """Return an array (N, lanes) for spins."""
    return np.zeros((discs, lanes))


@optional(lambda states, rough: states.shape[0] // 4)
def discs_in(states, rough):
    """Return the number of discs in ``states``."""
    return states.shape[0] // 5


@optional(lambda source, k, l, spins: None)
def copy_spins(source, k, l, spins):
    """Copy the spins in column ``k`` of ``source`` to column ``l`` of ``spins``."""
    for i in range(spins.shape[0]):
        spins[i, l] = source[i, k]


@optional(lambda i, spins: None)
def row(i, spins):
    """Return the spins of disc ``i`` in all lanes."""
    return spins[i]


@optional(lambda spins: None)
def only_lane(spins):
    """Return the ``spins`` (N, 1) of all discs in the only lane."""
    return spins[:, 0]


@optional(lambda first, i, second, j, dx, dy, meets, rough: None)
def rub_discs(first, i, second, j, dx, dy, meets, rough):
    """Reverse the velocity of the surfaces of two discs against each other.

    ``first`` and ``second`` are arrays (u, v, s), in which the discs have the entries i and j. (dx,
    dy) is the first centre minus the second. The law is that of ``law.rough_collision``. The
    impulse along the line of centres changes nothing here.
    """
    (u, v, s), (other_u, other_v, other_s) = first, second
    distance = math.sqrt(dx * dx + dy * dy)
    turn = dx * (v[i] - other_v[j]) - dy * (u[i] - other_u[j])
    slip = turn / distance - (s[i] + other_s[j])
    push, spin = slip * rough[0] / distance if meets else 0.0, slip * rough[1] if meets else 0.0
    u[i] += dy * push
    v[i] -= dx * push
    other_u[j] -= dy * push
    other_v[j] += dx * push
    s[i] += spin
    other_s[j] += spin


@optional(lambda u, v, l, on_x, on_y, s, rough: None)
def rub_walls(u, v, l, on_x, on_y, s, rough):
    """Reverse the velocity of a disc's surface along a wall, in a lane ``l``, before it rebounds.

    ``on_x`` and ``on_y`` say whether it is on a wall of x or y.
    """
    u[l], v[l], s[l] = rough_wall_collision(u[l], v[l], s[l], u[l], v[l], on_x, on_y, *rough)


# One event ----------------------------------------------------------------------------------------


@optional(lambda gap, speed, code, sooner_gap, sooner_speed, number, half: (gap, speed, code))
def earlier_event(gap, speed, code, other_gap, other_speed, number, half):
    """Return (gap, speed, code) of the earlier event; without ``half`` (None) of the first one."""
    sooner = other_gap * speed < gap * other_speed
    gap, speed = other_gap if sooner else gap, other_speed if sooner else speed
    return gap, speed, number if sooner else code


@optional(lambda position, velocity, half: (INFINITE_GAP, 1.0))
def walled_quotient(position, velocity, half):
    """Return (gap, speed) to the wall ahead; without walls (``half`` None) the gap is infinite."""
    return wall_quotient(position, velocity, half)


@optional(lambda before, after, ring: crosses(before, after))
def changes_order(before, after, ring):
    """Return whether a separation changes sign in a flight; on a ring, that of the nearest image.

    A flight on a ring changes a separation by less than half of the circumference. If the change is
    larger, another image has become the nearest one.
    """
    before, after = ring_separation(before, ring), ring_separation(after, ring)
    return crosses(before, after) & (abs(after - before) < ring / 2)


@optional(lambda before, after, ring: crosses(before, after))
def hops_vertically(before, after, ring):
    """Return whether a separation along y changes sign; along a periodic axis that is no hop."""
    return False


@inlined
def first_image(gap, speed, other_gap, other_speed):
    """Return (gap, speed) of the image of a disc that is met first."""
    # If one speed is not a number, the other image is met.
    other = (other_gap * speed < gap * other_speed) | (speed != speed)
    return other_gap if other else gap, other_speed if other else speed


@optional(lambda dx, dy, du, dv, sigma, ring: pair_contact(dx, dy, du, dv, sigma))
def meeting_along_x(dx, dy, du, dv, sigma, ring):
    """Return (gap, speed) of two discs; on a ring of x, of the image that is met first."""
    gap, speed = pair_contact(dx, dy, du, dv, sigma)
    other_gap, other_speed = pair_contact(dx - math.copysign(ring, dx), dy, du, dv, sigma)
    return first_image(gap, speed, other_gap, other_speed)


@optional(lambda dx, dy, du, dv, sigma, x, ring: meeting_along_x(dx, dy, du, dv, sigma, x))
def pair_meeting(dx, dy, du, dv, sigma, ring_x, ring):
    """Return (gap, speed) of two discs; along periodic axes, of the image that is met first."""
    gap, speed = meeting_along_x(dx, dy, du, dv, sigma, ring_x)
    dy -= math.copysign(ring, dy)
    other_gap, other_speed = meeting_along_x(dx, dy, du, dv, sigma, ring_x)
    return first_image(gap, speed, other_gap, other_speed)


@inlined
def pair_contact(dx, dy, du, dv, sigma):
    """Return (gap, speed) of two discs; the gap is infinite if they separate."""
    gap, speed, approach = contact_quotient(dx, dy, None, du, dv, None, sigma)
    return gap if approach else INFINITE_GAP, speed


@optional(lambda limit, code, ring: (limit, code))
def soonest(limit, code, ring):
    """Return (time, code) of the end of a flight without an event."""
    longest = ring / 2 / SQRT_2
    again = longest < limit
    return longest if again else limit, LOOK_AGAIN if again else code


@compiled
def find_events(all_lanes, law, kicks):
    """Fill ``times`` and ``codes`` with the first event of each lane within its time.

    A flight that a kick ends has the code of the end of time, and ``kick_lanes`` has to follow.
    """
    x, y, u, v = all_lanes.x, all_lanes.y, all_lanes.u, all_lanes.v
    times, codes, speeds = all_lanes.times, all_lanes.codes, all_lanes.speeds
    discs, lanes = x.shape
    for l in range(lanes):
        left = ensemble.kick_limit(all_lanes.remaining[l], l, kicks)
        left, code = soonest(left, END_OF_TIME, law.ring_x)
        times[l], codes[l] = soonest(left, code, law.ring_y)
        speeds[l] = 1.0
    number = 1.0
    for i in range(discs):
        xi, yi, ui, vi = x[i], y[i], u[i], v[i]
        for l in range(lanes):
            gap, speed = walled_quotient(xi[l], ui[l], law.half_x)
            gap, speed, code = earlier_event(
                times[l], speeds[l], codes[l], gap, speed, number, law.half_x
            )
            gap_y, speed_y = walled_quotient(yi[l], vi[l], law.half_y)
            times[l], speeds[l], codes[l] = earlier_event(
                gap, speed, code, gap_y, speed_y, number + 1.0, law.half_y
            )
        number += 2.0
    for i in range(discs):
        xi, yi, ui, vi = x[i], y[i], u[i], v[i]
        for j in range(i):
            xj, yj, uj, vj = x[j], y[j], u[j], v[j]
            for l in range(lanes):
                gap, speed = pair_meeting(
                    ring_separation(xi[l] - xj[l], law.ring_x),
                    ring_separation(yi[l] - yj[l], law.ring_y),
                    ui[l] - uj[l], vi[l] - vj[l], law.sigma, law.ring_x, law.ring_y,
                )  # fmt: skip
                times[l], speeds[l], codes[l] = earlier_event(
                    times[l], speeds[l], codes[l], gap, speed, number, law.sigma
                )
            number += 1.0
    for l in range(lanes):
        time = times[l] / speeds[l]
        # Discs that overlap by a rounding and approach collide now.
        times[l] = time if time > 0.0 else 0.0


@compiled
def advance(all_lanes, law, hops_x):
    """Advance every lane by its event and count it; hops in x unless ``hops_x`` is None."""
    x, y, u, v, spins, old_x, old_y, remaining, times, codes, _, counts = all_lanes
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
            at_x = snap_to_wall(xi[l] + ui[l] * times[l], on_x, law.half_x)
            at_y = snap_to_wall(yi[l] + vi[l] * times[l], on_y, law.half_y)
            xi[l], yi[l] = ring_separation(at_x, law.ring_x), ring_separation(at_y, law.ring_y)
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
                hops[l] += 1.0 if hops_vertically(oyi[l] - oyj[l], dy, law.ring_y) else 0.0
                if hops_x is not None:
                    across[l] += 1.0 if changes_order(oxi[l] - oxj[l], dx, law.ring_x) else 0.0
                dx, dy = ring_separation(dx, law.ring_x), ring_separation(dy, law.ring_y)
                square = dx * dx + dy * dy
                exchange = (dx * (ui[l] - uj[l]) + dy * (vi[l] - vj[l])) / square
                meets = (codes[l] == number) & (square > VANISHING_SQUARE)
                exchange = exchange if meets else 0.0
                ui[l] -= exchange * dx
                vi[l] -= exchange * dy
                uj[l] += exchange * dx
                vj[l] += exchange * dy
                rub_discs((ui, vi, si), l, (uj, vj, sj), l, dx, dy, meets, law.rough)
            number += 1.0


@inlined
def sweep(lanes, law, hops_x, kicks):
    """Advance every lane by one event, and kick it if that is due."""
    find_events(lanes, law, kicks)
    advance(lanes, law, hops_x)
    kick_lanes(lanes, law, kicks)


@inlined
def add_counts(count, sums, products):
    """Add the counts (n,) of a replica and their products, for e ≤ f."""
    for e in range(N_CLASSES):
        sums[e] += count[e]
        for f in range(e, N_CLASSES):
            products[e, f] += count[e] * count[f]


@compiled
def count_events(states, seed, first, lanes, duration, law, hops_x, kicks):
    """Follow the columns of ``states`` (rows, replicas) for a ``duration`` and add up their counts.

    Returns (sums, products): Σ N_e (n) and Σ N_e N_f for e ≤ f (n, n) over all replicas, int64, in
    the order of ``CLASSES``. ``hops_x`` is None if hops in x are not counted. ``kicks`` are those
    of the lanes, None without friction: the column k has the stream of ``seed`` for the replica
    ``first`` + k.
    """
    rows, replicas = states.shape
    now, remaining, busy = np.zeros((rows, lanes)), np.zeros(lanes), np.zeros(lanes, np.bool_)
    moving = new_lanes(now, remaining, law)
    sums, products = np.zeros(N_CLASSES, np.int64), np.zeros((N_CLASSES, N_CLASSES), np.int64)
    count = np.zeros(N_CLASSES, np.int64)
    used, running = 0, 0
    while True:
        for l in range(lanes):
            if remaining[l] > 0.0:
                continue
            if busy[l]:
                for e in range(N_CLASSES):
                    count[e] = np.int64(moving.counts[e, l])
                    moving.counts[e, l] = 0.0
                add_counts(count, sums, products)
                busy[l] = False
                running -= 1
            if used < replicas:
                for k in range(rows):
                    now[k, l] = states[k, used]
                ensemble.open_kicks(l, seed, first + used, kicks)
                remaining[l] = duration
                busy[l] = True
                running += 1
                used += 1
        if running == 0:
            return sums, products
        for _ in range(ensemble.SWEEPS):
            sweep(moving, law, hops_x, kicks)


@optional(lambda laps, positions, velocities, times, ring: None)
def count_laps(laps, positions, velocities, times, ring):
    """Add to ``laps`` (N, lanes) the rounds that flights complete."""
    for i in range(laps.shape[0]):
        for l in range(laps.shape[1]):
            then = positions[i, l] + velocities[i, l] * times[l]
            laps[i, l] += (1.0 if then > ring / 2 else 0.0) - (1.0 if then < -ring / 2 else 0.0)


@optional(lambda first, stop, kicks: None)
def lane_kicks(first, stop, kicks):
    """Return the ``Kicks`` of the lanes ``first`` … ``stop`` − 1, which share their memory."""
    waits, streams = kicks.waits[first:stop], kicks.streams[first:stop]
    return ensemble.Kicks(
        kicks.rate, waits, streams, kicks.stream, kicks.direction, kicks.velocity, kicks.sampler
    )  # fmt: skip


@optional(lambda counts, first, hops: None)
def add_hops(counts, first, hops):
    """Add the hops in x in ``counts`` (n, lanes) to ``hops``, from the replica ``first`` on."""
    hops[first : first + counts.shape[1]] += counts[HORIZONTAL_HOPS]


@compiled
def advance_states(states, laps, time, law, kicks, hops):
    """Advance the columns of ``states`` (rows, replicas) by a ``time`` > 0.

    The rounds of discs along periodic axes are added to ``laps`` (2N, replicas), those along x
    first. ``kicks`` are those of the columns, None without friction. The hops in x are added to
    ``hops`` (replicas,) unless it is None.
    """
    discs, replicas = laps.shape[0] // 2, laps.shape[1]
    for first in range(0, replicas, ensemble.LANES):
        stop = min(first + ensemble.LANES, replicas)
        some, rounds = states[:, first:stop].copy(), np.zeros((2 * discs, stop - first))
        moving = new_lanes(some, np.full(stop - first, time), law)
        some_kicks = lane_kicks(first, stop, kicks)
        while np.max(moving.remaining) > 0.0:
            find_events(moving, law, some_kicks)
            count_laps(rounds[:discs], moving.x, moving.u, moving.times, law.ring_x)
            count_laps(rounds[discs:], moving.y, moving.v, moving.times, law.ring_y)
            advance(moving, law, hops)
            kick_lanes(moving, law, some_kicks)
        states[:, first:stop] = some
        laps[:, first:stop] += rounds
        add_hops(moving.counts, first, hops)


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
    (width, edges, wide) as in ``returns``. A replica has n intervals, c of them in a bin. Σ c, Σ c²
    and Σ c n are added to ``sums`` (3, bins; int64). Returns their total time and number,
    (2, replicas) doubles. ``kicks`` are those of ``LANES`` lanes, with the streams of
    ``count_events``.
    """
    discs, (width, edges, wide) = discs_in(states, law.rough), bins
    totals = np.zeros((2, states.shape[1]))
    when = np.zeros(discs * (discs - 1) // 2)
    for start in range(0, states.shape[1], ensemble.LANES):
        some, own = states[:, start : start + ensemble.LANES].copy(), totals[:, start:]
        lanes = some.shape[1]
        moving, counted = new_lanes(some, np.full(lanes, np.inf), law), np.zeros(lanes)
        times = moving.times
        for l in range(lanes):
            ensemble.open_kicks(l, seed, first + start + l, kicks)
        # The time of the last hop, negative before the first one, and the time since then.
        elapsed, last, age = np.zeros(lanes), np.full(lanes, -1.0), np.zeros(lanes)
        counts, busy = np.zeros((lanes, sums.shape[1]), np.int64), True
        vertical = moving.counts[VERTICAL_HOPS], moving.old_y, moving.y
        horizontal = moving.counts[HORIZONTAL_HOPS], moving.old_x, moving.x
        hops, before, after = vertical if hops_x is None else horizontal
        while busy and going[0]:
            busy = False
            for _ in range(ensemble.SWEEPS):
                sweep(moving, law, hops_x, kicks)
                for l in range(lanes):
                    at = 0.0
                    if hops[l] > counted[l]:
                        counted[l] = hops[l]
                        for k in range(hops_in_flight(before, after, l, times[l], when)):
                            interval = age[l] + (when[k] - at)
                            if 0.0 <= last[l] < window:
                                index = ensemble.find_bin(interval, width, wide.size - 1, edges)
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
