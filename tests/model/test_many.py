"""The geometry of more than two discs.

Without it discs that overlap would be a scene, or a jammed channel be ergodic.
"""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from scipy import ndimage
from scipy.sparse import csgraph

from twodiscs.model.many_geometry import arranged, arrangement, can_be_level, is_ordered
from twodiscs.model.many_geometry import largest_known_radius as largest_radius
from twodiscs.model.scene import Box, Scene
from twodiscs.theory import three


@pytest.mark.parametrize("width", [1.0, 1.02, 1.05, 1.1, 1.3, 1.5, 2.0, 2.9, 3.0, 4.0])
def test_three_discs_fit_as_far_as_closed_forms_say(width):
    """A zigzag, the largest equilateral triangle, or a row."""
    total, short = width + 4, 1.0
    zigzag = (total - math.sqrt(total**2 - width**2 - 4)) / 2
    c = 7 - 4 * math.sqrt(3)
    b = (4 - 2 * math.sqrt(3)) * (width + 1)
    triangle = (b - math.sqrt(b * b - 4 * c * (width**2 + 1 - math.sqrt(3) * width))) / (2 * c)
    a, height = width - 2 * triangle, 1 - 2 * triangle
    is_triangle = height > a * math.sqrt(3) / 2
    expected = min(triangle if is_triangle else zigzag, short / 2)
    assert largest_radius(3, width, 1.0) == pytest.approx(expected, rel=1e-13)
    assert not Box(width, 1.0, discs=3).fits(largest_radius(3, width, 1.0))


@pytest.mark.parametrize("discs", [2, 3, 4, 5, 8, 13, 64])
@pytest.mark.parametrize("sides", [(1.0, 1.05), (1.0, 1.0), (1.0, 6.0), (20.0, 1.0)])
@pytest.mark.parametrize("periodic", ["", "x", "y", "xy"])
def test_arrangements_fit(discs, sides, periodic):
    largest = largest_radius(discs, *sides, periodic)
    scene = Scene(*sides, largest * (1 - 1e-9), discs=discs, periodic=periodic)
    centres = arrangement(scene)
    assert len(centres) == discs
    for (x, y), (other_x, other_y) in itertools.combinations(centres, 2):
        dx, dy = abs(x - other_x), abs(y - other_y)
        dx = min(dx, scene.width - dx) if "x" in periodic else dx
        dy = min(dy, scene.height - dy) if "y" in periodic else dy
        assert math.hypot(dx, dy) >= scene.contact_distance
    assert max(abs(x) for x, _ in centres) <= scene.range_x / 2 * (1 + 1e-15)
    assert max(abs(y) for _, y in centres) <= scene.range_y / 2 * (1 + 1e-15)


@pytest.mark.parametrize(
    ("discs", "apart"), [(2, math.sqrt(2)), (4, 1), (5, math.sqrt(1 / 2)), (6, math.sqrt(13) / 6)]
)
def test_the_densest_packings_of_rows_in_a_square_are_found(discs, apart):
    """The centres are in a square of side 1, at the largest distance that there is."""
    assert largest_radius(discs, 1 + apart, 1 + apart) == pytest.approx(apart / 2, rel=1e-14)
    assert largest_radius(4, 2.0, 2.0) == 0.5  # exactly, because all four can touch


@pytest.mark.parametrize("periodic", ["", "x"])
@pytest.mark.parametrize("height", [1e-4, 0.0368, 0.5, 1.0, 2.2, 10.7, 102.0, 1e4])
@pytest.mark.parametrize("discs", [3, 8, 46, 118, 283])
def test_no_other_number_of_rows_is_better(discs, height, periodic):
    """Not even one that differs by more than a factor of two from that of the spacing."""
    best = arranged(discs, 1.0, height, periodic)[1]
    for rows, less in itertools.product(range(1, discs + 1), (0.0, 0.5)):
        each = math.ceil(discs / rows)
        side = 1 / (each if periodic else each - 1 + less or 1)
        down = height / (rows - 1) if rows > 1 else math.inf
        two_down = 2 * down if less else math.inf
        in_row = side if each > 1 else math.inf
        assert min(in_row, math.hypot(less * side, down), two_down) <= best * (1 + 1e-14)


# As a scene --------------------------------------------------------------------------------------


@pytest.mark.parametrize("width", [1.0, 1.05, 1.2, 1.5, 2.5])
@pytest.mark.parametrize("axis", ["x", "y"])
def test_hops_of_three_discs_end_where_two_of_them_cannot_be_level(width, axis):
    """The rate of hops is positive as long as they are possible, and zero beyond."""
    box = Box(width, 1.0, discs=3)
    end = box.threshold({"x": "horizontal_hop", "y": "vertical_hop"}[axis])
    for factor, possible in ((0.9999, True), (1.0001, False)):
        radius = factor * end
        if radius < box.largest_radius:
            scene = Scene(width, 1.0, radius, discs=3)
            assert can_be_level(scene, axis) is possible
            ranges = (scene.range_x, scene.range_y)[:: 1 if axis == "x" else -1]
            assert (three.integrals(*ranges, scene.contact_distance)[4] > 0) is possible


# Parts of configuration space ---------------------------------------------------------------------


def channel(discs, height, length):
    """Return a channel with the ranges A = ``length`` and B = ``height`` in units of σ."""
    return Scene(0.2 * (length + 1), 0.2 * (height + 1), 0.1, discs=discs)


def total_of(heights, axis=0):
    """Return Σ √(1 − Δ²) of neighbours along an ``axis``."""
    return np.sqrt(1 - np.diff(heights, axis=axis) ** 2).sum(axis=axis)


#: Discs, B and A in σ: two zigzags alone, a level pair that is stuck at an end, all that can move.
CHANNELS = [
    (2, 0.8, 0.9), (2, 0.8, 1.1), (3, 0.8, 1.5), (3, 0.8, 1.7), (3, 0.8, 1.9), (3, 0.8, 2.1),
    (4, 0.85, 2.0), (4, 0.85, 2.2), (4, 0.85, 2.5), (4, 0.85, 2.8), (4, 0.85, 3.5),
]  # fmt: skip


@pytest.mark.parametrize(("discs", "height", "length"), CHANNELS)
def test_parts_of_a_channel_are_those_of_its_heights(discs, height, length):
    """All heights on a lattice with room for them, and which of them hang together.

    A channel on its side has the same parts.
    """
    scene, lattice = channel(discs, height, length), np.linspace(0, height, 25)
    assert is_ordered(scene)
    longest = (2 + math.sqrt(3)) * scene.radius
    assert is_ordered(replace(scene, height=longest * (1 - 1e-9)))
    assert not is_ordered(replace(scene, height=longest * (1 + 1e-9)))
    assert not is_ordered(replace(scene, periodic="x"))
    fitting = total_of(np.array(np.meshgrid(*[lattice] * discs, sparse=False))) < length
    parts = ndimage.label(fitting)[1]
    assert scene.ergodic_components == math.factorial(discs) * parts
    assert scene.turned().ergodic_components == scene.ergodic_components
    if length > discs - 1:
        assert parts == 1


@pytest.mark.parametrize(("discs", "height"), [(5, 0.5), (5, 0.86), (6, 0.8), (7, 0.86), (9, 0.8)])
def test_parts_of_a_long_channel_are_those_of_its_corners(discs, height):
    """Each disc on a wall, and paths on which one of them crosses, at every length of a box."""
    corners = np.array(list(itertools.product([0, height], repeat=discs))).T
    index = np.arange(corners.shape[1])
    highest, found = [], set()
    for disc in range(discs):
        paths = np.repeat(corners[:, :, None], 31, axis=2)
        paths[disc] = np.linspace(0, height, 31)
        highest.append(total_of(paths).max(axis=1))
    totals = total_of(corners)
    for length in np.linspace(totals.min() + 0.003, discs - 0.9, 60):
        graph = np.zeros((index.size, index.size), bool)
        for disc in range(discs):
            crosses = highest[disc] < length
            graph[index, index ^ (1 << (discs - 1 - disc))] = crosses
        inside = totals < length
        parts = csgraph.connected_components(graph[np.ix_(inside, inside)])[0]
        scene = channel(discs, height, length)
        assert scene.ergodic_components == math.factorial(discs) * parts, length
        found.add(parts)
    assert {1, 2} < found


@pytest.mark.parametrize(
    ("scene", "parts"),
    [
        (Scene(4.8, 0.6, 0.155, discs=8), math.factorial(8)),  # next neighbours may touch here
        (Scene(40.0, 0.6, 0.2, discs=64), math.factorial(64)),
        (Scene(0.6, 2.5, 0.2, discs=4), 24),
        (Scene(3.0, 0.6, 0.2, discs=4, periodic="x"), 6),
        (Scene(1.0, 1.9, 0.2, discs=4, periodic="x"), 1),
        (Scene(1.5, 1.0, 0.28, discs=3), 12),  # two zigzags of each order
        (Scene(0.7, 0.5, 0.1, discs=3), 1),
        (Scene(1.5, 1.0, 0.26, discs=3), None),
        (Scene(1.5, 0.6, 0.195, discs=4, periodic="x"), None),
        (Scene(1.5, 1.25, 0.25, discs=3, periodic="x"), None),  # they fill the ring in a row
        (Scene(0.6, 3.0, 0.2, discs=4, periodic="y"), 6),
        (Scene(1.7, 1.0, 0.2, discs=4, periodic="xy"), 1),
        (Scene(1.0, 1.0, 0.2, discs=4, periodic="xy"), None),
        # They just cannot pass, or just do not fit in a row.
        (Scene(1.5, 0.5, 0.125, discs=4), 24),
        (Scene(0.5, 1.5, 0.125, discs=4), 24),
        (Scene(1.5, 0.5, 0.125, discs=4, periodic="x"), 6),
        (Scene(1.0, 0.625, 0.125, discs=4), None),
        (Scene(1.0, 1.0, 0.125, discs=4, periodic="xy"), None),
    ],
    ids=repr,
)
def test_parts_that_are_known(scene, parts):
    assert scene.ergodic_components == parts
