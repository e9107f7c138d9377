"""Event chains: moves without rejection that bring many discs into a new arrangement.

A chain picks a disc and one of the four directions, all with the same probability. The disc moves
until it touches another disc, which then moves on in its place, or a wall, where it turns back. The
chain ends when all moves together have a length that was drawn at its begin (Bernard, Krauth and
Wilson, Phys. Rev. E 80, 056704 (2009)). A state of the chain has the centres, the disc that moves
and its direction. For a given length the chain maps such states one to one onto each other, and it
keeps their volume: a move is a translation, and at a contact or at a wall the disc that arrives and
the disc that leaves have the same flux. Centres that are uniform among all allowed ones therefore
stay uniform. The number of the chains and their lengths do not depend on the centres.
"""

import math

import numpy as np

from twodiscs.sampling.jit import compiled, inlined, optional
from twodiscs.sampling.many.cell_grid import enter, find_interval, leave, new_places, wrap_column
from twodiscs.sampling.many.insertions import ring_separation
from twodiscs.sampling.streams import next_bits, uniform

#: The approximate numbers of contacts of each disc, and of a chain.
CONTACTS_PER_DISC, CONTACTS_PER_CHAIN = 512, 16

#: Below this room of discs, relative to their radius, contacts are more in proportion: each moves a
#: disc by less. They are at most ``MOST_CROWDING`` times as many: closer to the largest radius all
#: free lengths shrink by the same factor, and as many moves, which shrink with them, mix the
#: centres as well.
AMPLE_ROOM, MOST_CROWDING = 1 / 3, 16


def crowding(scene):
    """Return the contacts of a ``Scene`` over those of a roomy one, 1 to ``MOST_CROWDING``."""
    room = (scene.largest_radius - scene.radius) / scene.radius
    return min(max(1.0, AMPLE_ROOM / room), MOST_CROWDING)


def plan(scene):
    """Return (number, mean length) of the chains for a new arrangement of a ``Scene``.

    If the discs fill the box at the radius r_max, Z − 1 ≈ r/(r_max − r), with the compressibility
    factor Z. This is also the number of contacts in a length (π/4) σ of chain.
    """
    room = (scene.largest_radius - scene.radius) / scene.radius
    length = CONTACTS_PER_CHAIN * math.pi / 4 * scene.contact_distance * room
    contacts = CONTACTS_PER_DISC * crowding(scene)
    return math.ceil(contacts * scene.discs / CONTACTS_PER_CHAIN), length


@optional(lambda column, columns, ring: column if 0 <= column < columns else -1)
def find_column(column, columns, ring):
    """Return the number of a column or row, −1 if there is none."""
    return wrap_column(column, columns, ring)


@optional(lambda dx, sign, ring: dx)
def image_ahead(dx, sign, ring):
    """Return the separation to the image ahead on a ring, given that to the nearest image."""
    return dx + sign * ring if sign * dx < 0.0 else dx


@inlined
def first_contact(i, axis, sign, left, centres, places, grid, initial):
    """Return (distance, disc) of the first contact of disc ``i``; (``left``, −1) without one."""
    sigma, ring_x, ring_y = initial.sigma, initial.ring_x, initial.ring_y
    columns, rows = grid.x.size - 1, grid.y.size - 1
    borders = grid.x if axis == 0 else grid.y
    along, across = (places.column[i], places.row[i])
    if axis == 1:
        along, across = across, along
    at_x, at_y = centres[0, i], centres[1, i]
    side = borders[1] - borders[0]
    beyond = abs(borders[along + (1 if sign > 0.0 else 0)] - centres[axis, i]) - sigma
    distance, disc = left, -1
    for step in range(columns + rows):
        # The next cells have no contact that is nearer.
        if step > 0 and beyond + (step - 1) * side >= distance:
            break
        a = along + (step if sign > 0.0 else -step)
        for b in range(across - 1, across + 2):
            column = find_column(a if axis == 0 else b, columns, ring_x)
            row = find_column(b if axis == 0 else a, rows, ring_y)
            if column < 0 or row < 0:
                continue
            k = places.after[places.row.size + column * rows + row]
            while k < places.row.size:
                dx = ring_separation(centres[0, k] - at_x, ring_x)
                dy = ring_separation(centres[1, k] - at_y, ring_y)
                if axis == 0:
                    ahead, apart = image_ahead(dx, sign, ring_x), dy
                else:
                    ahead, apart = image_ahead(dy, sign, ring_y), dx
                square = (sigma - apart) * (sigma + apart)
                if square > 0.0 and sign * ahead > 0.0:
                    gap = sign * ahead - math.sqrt(square)
                    if gap < distance:
                        distance, disc = max(gap, 0.0), k
                k = places.after[k]
    return distance, disc


@optional(lambda left, ring: left)
def short_of_half(left, ring):
    """Return the length of a disc's next move on a ring, at most ``left``."""
    return min(left, ring / 4)


@optional(lambda position, sign, half, ring: half - sign * position)
def wall_distance(position, sign, half, ring):
    """Return the distance to the wall ahead, infinite along a ring."""
    return math.inf


@compiled
def run_chains(state, initial, centres, number, length, grid):
    """Move the discs of ``centres`` (2, N) by a ``number`` of chains of a mean ``length``."""
    discs, places = initial.discs, new_places(initial.discs, grid)
    for i in range(discs):
        column, row = find_interval(centres[0, i], grid.x), find_interval(centres[1, i], grid.y)
        enter(i, column, row, places, grid)
    for _ in range(number):
        axis = np.int64(next_bits(state) % np.uint64(2))
        sign = 1.0 if next_bits(state) % np.uint64(2) == 0 else -1.0
        i = np.int64(next_bits(state) % np.uint64(discs))
        half = initial.half_x if axis == 0 else initial.half_y
        left = 2 * length * uniform(state)
        while left > 0.0:
            position = centres[axis, i]
            if axis == 0:
                wall = wall_distance(position, sign, half, initial.ring_x)
            else:
                wall = wall_distance(position, sign, half, initial.ring_y)
            limit = short_of_half(min(left, wall), initial.ring_x)
            limit = short_of_half(limit, initial.ring_y)
            step, k = first_contact(i, axis, sign, limit, centres, places, grid, initial)
            left -= step
            bounces = k < 0 and limit == wall
            centres[axis, i] = position + sign * step
            centres[0, i] = ring_separation(centres[0, i], initial.ring_x)
            centres[1, i] = ring_separation(centres[1, i], initial.ring_y)
            if bounces:
                centres[axis, i], sign = sign * half, -sign
            column, row = find_interval(centres[0, i], grid.x), find_interval(centres[1, i], grid.y)
            if column != places.column[i] or row != places.row[i]:
                leave(i, places)
                enter(i, column, row, places, grid)
            if k >= 0:
                i = k
