"""Counts of events of many equal discs: one trajectory at a time, with local updates at events.

The law of one event is the law of ``all_pairs``. Each disc has its own time: it moves straight from
its last event on, and is not updated before its next one. The box is divided into cells whose sides
are longer than σ. Only discs in the same cell or in neighbouring cells can meet. A disc keeps its
soonest contact with them, and the time at which it comes to a border of its cell. The outermost
borders are the walls. A calendar has the first of these times of each disc.

A contact is kept by the disc that looked for it last. If the other disc has an event before, the
contact is out of date. The first disc then looks again at the time of the old contact, because it
cannot meet another disc before.

A hop of two discs is a change of sign of their separation. Both discs are then in the same row of
cells, or in the same column if the hop is along x. ``Bands`` have the discs of each row or column
side by side in memory. A disc moves straight after its last event and its entry into the band. All
its hops are therefore found at its events and where it leaves a band, by one comparison with each
of the other discs of the band. Around a ring this is the order of nearest images. If no hop is
counted, there are no bands.

A ``Log`` has the times of all this, but hops are not in order in it. At the end of a stretch all
discs are advanced to the same time, so no earlier hop is missing.
"""

from typing import NamedTuple

import numpy as np

from twodiscs.dynamics.ensemble import kick_limit, open_kicks
from twodiscs.dynamics.law import (
    INFINITE_GAP,
    VANISHING_SQUARE,
    contact_quotient,
    crosses,
    crossing_time,
)
from twodiscs.dynamics.many import all_pairs
from twodiscs.dynamics.many.all_pairs import COLLISIONS, HORIZONTAL_HOPS, N_CLASSES, VERTICAL_HOPS
from twodiscs.sampling.jit import compiled, inlined, optional
from twodiscs.sampling.many import cell_grid as grids
from twodiscs.sampling.many.insertions import ring_separation
from twodiscs.sampling.many.many_initial_states import spins_in

#: The class of the entries of a log that a kick makes, one for each disc.
KICK_CLASS = N_CLASSES

#: The days of an epoch for each disc, which has about as many first times. The last of all days,
#: for infinite times.
DAYS_PER_DISC, LAST_DAY = 128.0, 2.0**62


class Calendar(NamedTuple):
    """The first times of all discs, in which a search for the next one takes as long for any N.

    Disc i has its first ``time`` on a ``day``, arrays (N,), and is in the list of this day, as in
    ``Places``. Days that differ by a multiple of the number of lists have the same list (R. Brown,
    Commun. ACM 31, 1220 (1988)).
    """

    time: np.ndarray
    day: np.ndarray
    before: np.ndarray
    after: np.ndarray


class Motion(NamedTuple):
    """The state of the discs between events, arrays (N,) except ``calendar`` and ``places``.

    A disc was at (x, y) at its ``time``. At ``contact`` it meets its ``partner``, unless the
    partner's number of ``events`` differs from ``seen``, the number at the search. At ``border`` a
    disc leaves its cell, along y if ``upwards``. ``s`` are the spins of rough discs, (N, 1), or
    None.
    """

    x: np.ndarray
    y: np.ndarray
    u: np.ndarray
    v: np.ndarray
    time: np.ndarray
    contact: np.ndarray
    border: np.ndarray
    upwards: np.ndarray
    partner: np.ndarray
    seen: np.ndarray
    events: np.ndarray
    calendar: Calendar
    places: grids.Places
    s: np.ndarray | None = None


class Bands(NamedTuple):
    """The discs in the order of the rows of cells, or of the columns, for the hops along one axis.

    Band b has the entries ``first[b]`` … ``first[b + 1]`` − 1 of the arrays (N,). The disc of an
    entry was ``at`` a place at the time ``since``, and moves with its ``speed``. Disc i has the
    entry ``entry[i]``. The places ``behind`` are just below the borders of bands.
    """

    behind: np.ndarray
    first: np.ndarray
    entry: np.ndarray
    disc: np.ndarray
    at: np.ndarray
    speed: np.ndarray
    since: np.ndarray


class Log(NamedTuple):
    """The events in a stretch of time, ``size[0]`` entries.

    An entry has its time after ``origin[0]``'s zero, its class, and its two discs, the same one
    twice at a wall. Its ``states`` (n, 2, 4 or 5) are x, y, u, v and maybe s of both right after an
    event; hops have none. Along periodic axes positions go on beyond the cell. ``pending`` is the
    number of pairs in a band, each of which may have a hop that is not yet entered.
    """

    times: np.ndarray
    classes: np.ndarray
    discs: np.ndarray
    states: np.ndarray
    size: np.ndarray
    origin: np.ndarray
    pending: np.ndarray


def new_log(entries, rough):
    """Return an empty ``Log`` for a number of ``entries`` of discs, smooth or ``rough``."""
    components = 4 if rough is None else 5
    return Log(
        np.empty(entries), np.empty(entries, np.int64), np.empty((entries, 2), np.int64),
        np.empty((entries, 2, components)), np.zeros(1, np.int64), np.zeros(1),
        np.zeros(1, np.int64),
    )  # fmt: skip


@optional(lambda discs, log: False)
def is_full(discs, log):
    """Return whether the log lacks room for one more event, with a kick and all hops before it.

    The event may have a hop of each pair before it, and the end of the stretch has as many.
    """
    return log.size[0] + 2 * log.pending[0] + 2 * discs >= log.times.size


@optional(lambda change, log: None)
def note_pairs(change, log):
    """Change the number of pairs that may have a hop to enter."""
    log.pending[0] += change


@optional(lambda time, kind, i, k, log: None)
def note_hop(time, kind, i, k, log):
    """Enter a hop of a class ``kind`` of discs ``i`` and ``k``."""
    n = log.size[0]
    log.times[n], log.classes[n] = log.origin[0] + time, kind
    log.discs[n, 0], log.discs[n, 1] = i, k
    log.size[0] = n + 1


@optional(lambda time, kind, i, j, motion, laps, law, log: None)
def note_event(time, kind, i, j, motion, laps, law, log):
    """Enter an event of a class ``kind`` of discs ``i`` and ``j``, which have come to it."""
    note_hop(time, kind, i, j, log)
    states = log.states[log.size[0] - 1]
    for k, disc in enumerate((i, j)):
        states[k, 0] = unfold(motion.x[disc], laps[0, disc], law.ring_x)
        states[k, 1] = unfold(motion.y[disc], laps[1, disc], law.ring_y)
        states[k, 2], states[k, 3] = motion.u[disc], motion.v[disc]
        note_spin(states, k, disc, motion.s)


@optional(lambda states, k, disc, s: None)
def note_spin(states, k, disc, s):
    """Enter the spin of a ``disc``."""
    states[k, 4] = s[disc, 0]


@optional(lambda position, laps, ring: position)
def unfold(position, laps, ring):
    """Return a ``position`` after a number of ``laps`` around a ring."""
    return position + laps * ring


@optional(lambda time, log: None)
def go_on(time, log):
    """Move the zero of the times of a log later by ``time``."""
    log.origin[0] += time


@compiled
def new_motion(discs, grid, rough):
    """Return an empty ``Motion`` for a number of ``discs``, smooth or ``rough``."""
    days = 2
    while days < 2 * discs:
        days *= 2
    lists = np.arange(discs + days)
    return Motion(
        np.zeros(discs), np.zeros(discs), np.zeros(discs), np.zeros(discs), np.zeros(discs),
        np.zeros(discs), np.zeros(discs), np.zeros(discs, np.bool_),
        np.zeros(discs, np.int64), np.zeros(discs, np.int64), np.zeros(discs, np.int64),
        Calendar(np.zeros(discs), np.zeros(discs, np.int64), lists, lists.copy()),
        grids.new_places(discs, grid),
        all_pairs.new_spins(1, discs, rough),
    )  # fmt: skip


# Times --------------------------------------------------------------------------------------------


@optional(lambda apart, column, columns, ring: apart)
def image_separation(apart, column, columns, ring):
    """Return the separation to the image in a ``column``, which may be one turn too low or high.

    It need not be the nearest image on a ring of less than four columns. For rows it is the same.
    """
    apart -= ring if column < 0 else 0.0
    return apart + (ring if column >= columns else 0.0)


@inlined
def find_contact(i, now, columns, rows, motion, grid, law):
    """Return (time, partner) of the soonest contact of disc ``i`` with a disc in those cells.

    ``columns`` and ``rows`` are the first and the last ones. The time is infinite without any.
    """
    x, y, u, v = motion.x[i], motion.y[i], motion.u[i], motion.v[i]
    lag = now - motion.time[i]
    x, y = x + u * lag, y + v * lag
    gap, speed, partner = INFINITE_GAP, 1.0, -1
    across, up = grid.x.size - 1, grid.y.size - 1
    first, last = grids.columns_within(columns[0], columns[1], across, law.ring_x)
    lowest, highest = grids.columns_within(rows[0], rows[1], up, law.ring_y)
    for column in range(first, last + 1):
        start = motion.x.size + grids.wrap_column(column, across, law.ring_x) * up
        for row in range(lowest, highest + 1):
            k = motion.places.after[start + grids.wrap_column(row, up, law.ring_y)]
            while k < motion.x.size:
                lag = now - motion.time[k]
                dx, dy = motion.x[k] + motion.u[k] * lag - x, motion.y[k] + motion.v[k] * lag - y
                dx = image_separation(dx, column, across, law.ring_x)
                dy = image_separation(dy, row, up, law.ring_y)
                other_gap, other_speed, approach = contact_quotient(
                    dx, dy, None, motion.u[k] - u, motion.v[k] - v, None, law.sigma
                )
                # A disc does not approach itself, and a speed that is not a number is never sooner.
                if approach & (other_gap * speed < gap * other_speed):
                    gap, speed, partner = other_gap, other_speed, k
                k = motion.places.after[k]
    # Discs that overlap by a rounding and approach collide now.
    return now + max(gap / speed, 0.0), partner


@inlined
def time_to(border, position, velocity):
    """Return the time until a disc is at the ``border`` ahead; infinite for one that rests."""
    return abs(border - position) / abs(velocity) if velocity != 0.0 else INFINITE_GAP


@inlined
def find_border(i, motion, grid):
    """Set when disc ``i`` leaves its cell, and along which axis."""
    u, v = motion.u[i], motion.v[i]
    side_x = grid.x[motion.places.column[i] + (1 if u > 0.0 else 0)]
    side_y = grid.y[motion.places.row[i] + (1 if v > 0.0 else 0)]
    until_x, until_y = time_to(side_x, motion.x[i], u), time_to(side_y, motion.y[i], v)
    motion.upwards[i] = until_y < until_x
    motion.border[i] = motion.time[i] + min(until_x, until_y)


@inlined
def look_around(i, now, motion, grid, law):
    """Set the soonest contact of disc ``i`` with any of its neighbours."""
    c, r = motion.places.column[i], motion.places.row[i]
    time, partner = find_contact(i, now, (c - 1, c + 1), (r - 1, r + 1), motion, grid, law)
    motion.contact[i], motion.partner[i] = time, partner
    motion.seen[i] = motion.events[partner] if partner >= 0 else 0


@inlined
def entry_of(day, calendar):
    """Return the entry with which the list of a ``day`` begins."""
    discs = calendar.day.size
    return discs + (day & (calendar.after.size - discs - 1))


@inlined
def enlist(i, rate, motion):
    """Put the first time of disc ``i``, which is in no list, into the calendar.

    The calendar has a ``rate`` of days per time.
    """
    time = min(motion.contact[i], motion.border[i])
    day = np.int64(min(time * rate, LAST_DAY))
    motion.calendar.time[i], motion.calendar.day[i] = time, day
    grids.put(i, entry_of(day, motion.calendar), motion.calendar)


@inlined
def relist(i, rate, motion):
    """Put the first time of disc ``i`` into the calendar, in place of the one that is there."""
    grids.leave(i, motion.calendar)
    enlist(i, rate, motion)


@inlined
def find_first(day, last, calendar):
    """Return (disc, its day, its time) of the first time from a ``day`` to the ``last`` one.

    It is the disc of the least number if several discs have this time. Without any the disc is −1.
    """
    first, time = -1, INFINITE_GAP
    while first < 0 and day <= last:
        i = calendar.after[entry_of(day, calendar)]
        while i < calendar.day.size:
            if calendar.day[i] == day:
                sooner = calendar.time[i] < time
                if sooner | ((calendar.time[i] == time) & (i < first)):
                    first, time = i, calendar.time[i]
            i = calendar.after[i]
        day += 1 if first < 0 else 0
    return first, day, time


# Events -------------------------------------------------------------------------------------------


@optional(lambda discs, borders, hops: None)
def new_bands(discs, borders, hops):
    """Return the ``Bands`` of a number of ``discs`` between ``borders``; None without ``hops``."""
    whole, real = np.zeros((2, discs), np.int64), np.zeros((3, discs))
    first = np.zeros(borders.size, np.int64)
    behind = np.nextafter(borders, -INFINITE_GAP)
    return Bands(behind, first, whole[0], whole[1], real[0], real[1], real[2])


@optional(lambda cells, at, speeds, bands: None)
def fill_bands(cells, at, speeds, bands):
    """Put the discs, which are in these ``cells`` (N,) along an axis, into their ``bands``."""
    bands.first[:] = 0
    for i in range(cells.size):
        bands.first[cells[i]] += 1
    for band in range(1, bands.first.size):
        bands.first[band] += bands.first[band - 1]
    # They are the ends of bands until these are filled, from behind.
    for i in range(cells.size - 1, -1, -1):
        bands.first[cells[i]] -= 1
        n = bands.first[cells[i]]
        bands.entry[i], bands.disc[n] = n, i
        bands.at[n], bands.speed[n], bands.since[n] = at[i], speeds[i], 0.0


@inlined
def exchange_entries(n, m, bands):
    """Exchange two entries of a band."""
    i, j = bands.disc[n], bands.disc[m]
    bands.entry[i], bands.entry[j], bands.disc[n], bands.disc[m] = m, n, j, i
    for values in (bands.at, bands.speed, bands.since):
        values[n], values[m] = values[m], values[n]


@optional(lambda i, at, now, band, kind, log, bands: 0)
def count_hops(i, at, now, band, kind, log, bands):
    """Return how many discs of its ``band`` disc ``i``, now ``at`` a place, has come past."""
    own, count = bands.entry[i], 0
    start, speed, since = bands.at[own], bands.speed[own], bands.since[own]
    # A disc has not changed order with itself.
    bands.at[own] = INFINITE_GAP
    # Indices that cannot be negative make vector instructions.
    for n in range(np.uint64(bands.first[band]), np.uint64(bands.first[band + 1])):
        place, other, then = bands.at[n], bands.speed[n], bands.since[n]
        last = max(since, then)
        apart = start + speed * (last - since) - (place + other * (last - then))
        if crosses(apart, at - (place + other * (now - then))):
            count += 1
            note_hop(last + crossing_time(apart, speed - other), kind, i, bands.disc[n], log)
    bands.at[own], bands.since[own] = at, now
    return count


@optional(lambda i, now, band, target, ahead, borders, kind, log, bands: 0)
def leave_band(i, now, band, target, ahead, borders, kind, log, bands):
    """Move disc ``i`` from its ``band`` to another one and return its hops.

    It is at the upper border of its band if ``ahead`` is 1, at the lower one if it is 0. Discs that
    rest on a border are in the band above it, and the disc is behind them while it is there.
    """
    border = borders[band + 1] if ahead else bands.behind[band]
    count = count_hops(i, border, now, band, kind, log, bands)
    while band != target:
        up = 1 if target > band else 0
        others = bands.first[band + 1] - bands.first[band] - 1
        beyond = band + 2 * up - 1
        note_pairs(bands.first[beyond + 1] - bands.first[beyond] - others, log)
        # The disc comes to the end of a band, which then ends before it or begins behind it.
        end = bands.first[band + up] - up
        exchange_entries(bands.entry[i], end, bands)
        bands.first[band + up] = end + 1 - up
        band += 2 * up - 1
    bands.at[bands.entry[i]] = bands.behind[band] if ahead else borders[band + 1]
    return count


@optional(lambda time, bands: None)
def begin_again(time, bands):
    """Make a ``time`` the zero of all times."""
    for n in range(bands.since.size):
        bands.since[n] -= time


@optional(lambda i, speed, bands: None)
def set_speed(i, speed, bands):
    """Set the ``speed`` of disc ``i`` after an event."""
    bands.speed[bands.entry[i]] = speed


@inlined
def set_speeds(i, motion, hops, hops_x):
    """Set the speeds of disc ``i`` along both axes."""
    set_speed(i, motion.v[i], hops)
    set_speed(i, motion.u[i], hops_x)


@inlined
def put(i, x, y, now, motion, counts, log, hops, hops_x):
    """Put disc ``i`` at (x, y), where it has come by now, and count its hops."""
    places = motion.places
    counts[VERTICAL_HOPS] += count_hops(i, y, now, places.row[i], VERTICAL_HOPS, log, hops)
    counts[HORIZONTAL_HOPS] += count_hops(i, x, now, places.column[i], HORIZONTAL_HOPS, log, hops_x)
    motion.x[i], motion.y[i], motion.time[i] = x, y, now


@inlined
def fly(i, now, motion, counts, log, hops, hops_x):
    """Advance disc ``i`` to the time ``now``."""
    lag = now - motion.time[i]
    x, y = motion.x[i] + motion.u[i] * lag, motion.y[i] + motion.v[i] * lag
    put(i, x, y, now, motion, counts, log, hops, hops_x)


@inlined
def collide(i, j, motion, law):
    """Exchange the velocities of two discs along the line of their centres."""
    dx = ring_separation(motion.x[i] - motion.x[j], law.ring_x)
    dy = ring_separation(motion.y[i] - motion.y[j], law.ring_y)
    du, dv = motion.u[i] - motion.u[j], motion.v[i] - motion.v[j]
    square = dx * dx + dy * dy
    exchange = (dx * du + dy * dv) / square if square > VANISHING_SQUARE else 0.0
    motion.u[i] -= exchange * dx
    motion.v[i] -= exchange * dy
    motion.u[j] += exchange * dx
    motion.v[j] += exchange * dy
    discs = motion.u, motion.v, all_pairs.only_lane(motion.s)
    all_pairs.rub_discs(discs, i, discs, j, dx, dy, square > VANISHING_SQUARE, law.rough)


@optional(lambda i, column, columns, positions, laps, ring: column)
def pass_seam(i, column, columns, positions, laps, ring):
    """Return the number of a column or row; a disc past the seam of a ring is put back."""
    step = 1.0 if column == columns else (-1.0 if column < 0 else 0.0)
    positions[i] -= step * ring
    laps[i] += step
    return grids.wrap_column(column, columns, ring)


@optional(lambda ahead, columns, ring: ahead < 0 or ahead == columns)
def is_wall(ahead, columns, ring):
    """Say whether there is a wall before the column or row ``ahead``."""
    return False


@compiled
def start_from(states, replica, motion, grid, law, hops, hops_x):
    """Begin with a column of ``states`` (rows, replicas); see ``follow_discs``."""
    discs = motion.x.size
    grids.clear(discs, motion.places)
    motion.events[:] = 0
    for i in range(discs):
        motion.x[i], motion.y[i] = states[i, replica], states[discs + i, replica]
        motion.u[i], motion.v[i] = states[2 * discs + i, replica], states[3 * discs + i, replica]
        motion.time[i] = 0.0
        column = grids.find_interval(motion.x[i], grid.x)
        grids.enter(i, column, grids.find_interval(motion.y[i], grid.y), motion.places, grid)
    all_pairs.copy_spins(spins_in(states, discs, law.rough), replica, 0, motion.s)
    fill_bands(motion.places.row, motion.y, motion.v, hops)
    fill_bands(motion.places.column, motion.x, motion.u, hops_x)
    look_for_all(motion, grid, law)


@inlined
def end_in(states, replica, motion, law):
    """Put the discs, which have come to the same time, into a column of ``states``."""
    discs = motion.x.size
    for i in range(discs):
        states[i, replica], states[discs + i, replica] = motion.x[i], motion.y[i]
        states[2 * discs + i, replica] = motion.u[i]
        states[3 * discs + i, replica] = motion.v[i]
    all_pairs.copy_spins(motion.s, 0, replica, spins_in(states, discs, law.rough))


@compiled
def look_for_all(motion, grid, law):
    """Find the contacts and borders of all discs, at the time 0 that all have come to."""
    for i in range(motion.x.size):
        look_around(i, 0.0, motion, grid, law)
        find_border(i, motion, grid)


@optional(lambda time, lane, kicks: False)
def is_kicked(time, lane, kicks):
    """Return whether the kick of a ``lane`` is due after another ``time``."""
    kicks.waits[lane] -= time
    return kicks.waits[lane] <= 0.0


@optional(lambda motion, laps, grid, law, log, hops, hops_x, lane, kicks: None)
def kick_discs(motion, laps, grid, law, log, hops, hops_x, lane, kicks):
    """Draw the velocities of all discs anew, at the time 0 that all have come to."""
    discs = motion.x.size
    u, v = motion.u.reshape((discs, 1)), motion.v.reshape((discs, 1))
    all_pairs.redraw(u, v, motion.s, 0, lane, law, kicks)
    look_for_all(motion, grid, law)
    for i in range(discs):
        set_speeds(i, motion, hops, hops_x)
        note_event(0.0, KICK_CLASS, i, i, motion, laps, law, log)


@compiled
def follow_discs(duration, epoch, motion, laps, grid, law, counts, lane, kicks, log, hops, hops_x):
    """Follow the discs for a ``duration`` and add to ``counts`` (n,) what happens.

    The rounds of the discs along periodic axes are added to ``laps`` (2, N). A ``log``, which may
    be None, gets all events and counted hops; the discs stop when it is full. Returns the time that
    is left. All discs have come to the same time, from which they can be followed on. ``kicks`` are
    those of a ``lane``, None without friction. ``hops`` and ``hops_x`` are the ``Bands`` of the
    rows and of the columns, None where hops in y or in x are not counted.
    """
    discs, calendar = motion.x.size, motion.calendar
    columns, rows = grid.x.size - 1, grid.y.size - 1
    while True:
        end = kick_limit(min(duration, epoch), lane, kicks)
        rate = DAYS_PER_DISC * discs / epoch
        grids.clear(discs, calendar)
        for i in range(discs):
            enlist(i, rate, motion)
        day, last = 0, np.int64(end * rate)
        while True:
            i, day, now = find_first(day, last, calendar)
            full = is_full(discs, log)
            end = min(end, now) if full else end
            if not now < end:
                break
            j = i
            if motion.border[i] <= motion.contact[i]:
                upwards = motion.upwards[i]
                step = 1 if (motion.v[i] if upwards else motion.u[i]) > 0.0 else -1
                c, r = motion.places.column[i], motion.places.row[i]
                ahead = (r if upwards else c) + step
                if upwards:
                    stops = is_wall(ahead, rows, law.ring_y)
                else:
                    stops = is_wall(ahead, columns, law.ring_x)
                if not stops:
                    grids.leave(i, motion.places)
                    side = 1 if step > 0 else 0
                    if upwards:
                        left, r = r, pass_seam(i, ahead, rows, motion.y, laps[1], law.ring_y)
                        counts[VERTICAL_HOPS] += leave_band(
                            i, now, left, r, side, grid.y, VERTICAL_HOPS, log, hops
                        )
                        wide, high = (c - 1, c + 1), (r + step, r + step)
                    else:
                        left, c = c, pass_seam(i, ahead, columns, motion.x, laps[0], law.ring_x)
                        counts[HORIZONTAL_HOPS] += leave_band(
                            i, now, left, c, side, grid.x, HORIZONTAL_HOPS, log, hops_x
                        )
                        wide, high = (c + step, c + step), (r - 1, r + 1)
                    grids.enter(i, c, r, motion.places, grid)
                    time, partner = find_contact(i, now, wide, high, motion, grid, law)
                    if time < motion.contact[i]:
                        motion.contact[i], motion.partner[i] = time, partner
                        motion.seen[i] = motion.events[partner]
                    find_border(i, motion, grid)
                    relist(i, rate, motion)
                    continue
                lag = now - motion.time[i]
                x, y = motion.x[i] + motion.u[i] * lag, motion.y[i] + motion.v[i] * lag
                if upwards:
                    y = grid.y[rows if step > 0 else 0]
                else:
                    x = grid.x[columns if step > 0 else 0]
                put(i, x, y, now, motion, counts, log, hops, hops_x)
                s = all_pairs.only_lane(motion.s)
                all_pairs.rub_walls(motion.u, motion.v, i, not upwards, upwards, s, law.rough)
                kind = all_pairs.Y_WALLS if upwards else all_pairs.X_WALLS
                motion.u[i] *= 1.0 if upwards else -1.0
                motion.v[i] *= -1.0 if upwards else 1.0
                set_speeds(i, motion, hops, hops_x)
                counts[kind] += 1
                note_event(now, kind, i, i, motion, laps, law, log)
                motion.events[i] += 1
            else:
                j = motion.partner[i]
                if motion.events[j] == motion.seen[i]:
                    fly(i, now, motion, counts, log, hops, hops_x)
                    fly(j, now, motion, counts, log, hops, hops_x)
                    collide(i, j, motion, law)
                    set_speeds(i, motion, hops, hops_x)
                    set_speeds(j, motion, hops, hops_x)
                    motion.events[i] += 1
                    motion.events[j] += 1
                    counts[COLLISIONS] += 1
                    note_event(now, COLLISIONS, i, j, motion, laps, law, log)
                else:
                    j = i
            while True:
                look_around(i, now, motion, grid, law)
                find_border(i, motion, grid)
                relist(i, rate, motion)
                if i == j:
                    break
                i = j
        done, kicked = full | (end == duration), is_kicked(end, lane, kicks)
        if done | kicked:
            for i in range(discs):
                fly(i, end, motion, counts, log, hops, hops_x)
        for i in range(discs):
            motion.time[i] -= end
            motion.contact[i] -= end
            motion.border[i] -= end
        begin_again(end, hops)
        begin_again(end, hops_x)
        duration -= end
        go_on(end, log)
        if kicked:
            kick_discs(motion, laps, grid, law, log, hops, hops_x, lane, kicks)
        if done:
            return duration


@compiled
def count_events(states, seed, first, duration, epoch, law, grid, hops, hops_x, kicks):
    """Follow the columns of ``states`` (rows, replicas) for a ``duration`` and add up their counts.

    The states become those at the end. Returns (sums, products) as ``all_pairs.count_events`` does.
    ``hops`` and ``hops_x`` are None where hops in y or in x are not counted. ``kicks`` are those of
    one lane, None without friction.
    """
    discs = all_pairs.discs_in(states, law.rough)
    laps = np.zeros((2, discs))
    motion, count = new_motion(discs, grid, law.rough), np.zeros(N_CLASSES, np.int64)
    sums, products = np.zeros(N_CLASSES, np.int64), np.zeros((N_CLASSES, N_CLASSES), np.int64)
    bands, bands_x = new_bands(discs, grid.y, hops), new_bands(discs, grid.x, hops_x)
    lane = np.int64(0)  # for a literal 0 numba would compile ``follow_discs`` once more
    for replica in range(states.shape[1]):
        count[:] = 0
        start_from(states, replica, motion, grid, law, bands, bands_x)
        open_kicks(lane, seed, first + replica, kicks)
        follow_discs(
            duration, epoch, motion, laps, grid, law, count, lane, kicks, None, bands, bands_x
        )
        end_in(states, replica, motion, law)
        all_pairs.add_counts(count, sums, products)
    return sums, products


@compiled
def advance_all(states, laps, time, epoch, law, grid, kicks, hops_x):
    """Advance the columns of ``states`` (rows, replicas) by a ``time`` > 0.

    The rounds of discs along periodic axes are added to ``laps`` (2N, replicas), those along x
    first. ``kicks`` are those of the columns, None without friction. The hops in x are added to
    ``hops_x`` (replicas,) unless it is None.
    """
    discs, replicas = laps.shape[0] // 2, laps.shape[1]
    motion, rounds = new_motion(discs, grid, law.rough), np.zeros((2, discs))
    counts = np.zeros((N_CLASSES, 1), np.int64)
    bands_x = new_bands(discs, grid.x, hops_x)
    for replica in range(replicas):
        rounds[:], counts[:] = 0.0, 0
        start_from(states, replica, motion, grid, law, None, bands_x)
        follow_discs(
            time, epoch, motion, rounds, grid, law, counts[:, 0], replica, kicks, None, None,
            bands_x,
        )  # fmt: skip
        all_pairs.add_hops(counts, replica, hops_x)
        end_in(states, replica, motion, law)
        for i in range(discs):
            laps[i, replica] += rounds[0, i]
            laps[discs + i, replica] += rounds[1, i]
