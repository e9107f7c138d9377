"""Cells of a box of N discs: only discs in the same cell or in neighbouring ones can touch.

Their sides are longer than σ. Each disc has the numbers of its column and row; the discs of a cell
form a linked list.
"""

import math
from typing import NamedTuple

import numpy as np

from twodiscs.model.many_geometry import LEAST_CELL_SIDE
from twodiscs.sampling.jit import compiled, inlined, optional


class CellGrid(NamedTuple):
    """Borders of the columns and rows of cells; the outermost are walls, or the ends of a ring."""

    x: np.ndarray
    y: np.ndarray


class Places(NamedTuple):
    """The cell of each disc, ``column`` and ``row`` (N,), and the list of the discs of each cell.

    The list of cell c is a ring. From N + c it goes on to the disc ``after[N + c]``, from disc to
    disc, and returns to N + c. ``after`` and ``before`` are (N + cells,).
    """

    column: np.ndarray
    row: np.ndarray
    before: np.ndarray
    after: np.ndarray


def make_grid(scene):
    """Return the ``CellGrid`` of a ``Scene`` that can be followed: up to 4 N columns or rows."""
    a, b, least = scene.range_x, scene.range_y, LEAST_CELL_SIDE * scene.contact_distance
    # Along a very long box there would be far more cells of this area than discs.
    side = max(least, 1.25 * math.sqrt(a * b / scene.discs), max(a, b) / scene.discs / 4)
    numbers = {"x": max(1, int(a / side)), "y": max(1, int(b / side))}
    for axis in scene.periodic:
        # Along it there are four cells if there is room, otherwise two or three. With two each is
        # the neighbour of the other on both sides, by another image.
        numbers[axis] = max(numbers[axis], min(4, int(scene.side(axis) / least)))
    return CellGrid(_borders(a, numbers["x"]), _borders(b, numbers["y"]))


def _borders(length, number):
    # Symmetric, and the last ones are the walls exactly.
    return np.array([(2 * k - number) / number * (length / 2) for k in range(number + 1)])


@compiled
def new_places(discs, grid):
    """Return ``Places`` for a number of ``discs``, which are in no cell yet."""
    lists = np.arange(discs + (grid.x.size - 1) * (grid.y.size - 1))
    return Places(np.zeros(discs, np.int64), np.zeros(discs, np.int64), lists, lists.copy())


@inlined
def find_interval(position, borders):
    """Return the number of the interval between ``borders`` that holds a ``position``."""
    number = borders.size - 1
    # Truncation puts what a rounding has moved before the first border into the first interval.
    k = np.int64((position - borders[0]) / (borders[number] - borders[0]) * number)
    return min(k, number - 1)


@inlined
def clear(discs, lists):
    """Empty all lists of a number of ``discs``."""
    for entry in range(discs, lists.after.size):
        lists.before[entry] = lists.after[entry] = entry


@inlined
def put(i, entry, lists):
    """Put disc ``i`` at the head of the list with an ``entry``."""
    after = lists.after[entry]
    lists.before[i], lists.after[i] = entry, after
    lists.after[entry] = lists.before[after] = i


@inlined
def leave(i, lists):
    """Take disc ``i`` out of its list."""
    before, after = lists.before[i], lists.after[i]
    lists.after[before], lists.before[after] = after, before


@inlined
def enter(i, column, row, places, grid):
    """Put disc ``i`` at the head of the list of a cell."""
    places.column[i], places.row[i] = column, row
    put(i, places.row.size + column * (grid.y.size - 1) + row, places)


@optional(lambda column, columns, ring: column)
def wrap_column(column, columns, ring):
    """Return the number of a column or row on a ring; it may be one turn too low or high."""
    column -= columns if column >= columns else 0
    return column + (columns if column < 0 else 0)


@optional(lambda low, high, columns, ring: (max(low, 0), min(high, columns - 1)))
def columns_within(low, high, columns, ring):
    """Return the numbers of the first and last column or row; on a ring they may be a turn off."""
    return low, high
