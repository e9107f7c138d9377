"""The reference of 50 digits, against antiderivatives of 150.

Without these tests the fifty digits of the paper could be wrong: antiderivatives give the same,
with 150 of them.
"""

import math

import pytest
from theory.antiderivatives import reference, reference_times, relative_error

from twodiscs import EVENTS, Box, Scene
from twodiscs_paper.reference import exact_numbers

BOXES = [(1.5, 1.0), (1.0, 1.0), (2.0, 1.0), (1.0, 2.0), (3.0, 1.0), (1.0, 1.7), (1e6, 1), (1, 1e6)]


@pytest.mark.parametrize("box", BOXES)
def test_exact_numbers_have_the_digits_of_the_antiderivatives(box):
    """In all regimes, on both sides of the thresholds, and where discs hardly fit."""
    largest = Box(*box).largest_radius
    radii = [1e-9 * min(box), 0.1 * largest, 0.6 * largest, 0.9 * largest]
    for limit in (box[0] / 4, box[1] / 4):
        radii += [limit * (1 - 1e-9), limit, math.nextafter(limit, math.inf)]
    radii += [largest * (1 - room) for room in (1e-3, 1e-6, 1e-9)]
    for scene in (Scene(*box, radius) for radius in radii if Box(*box).fits(radius)):
        volume, areas, times = exact_numbers(scene)
        assert tuple(areas) == EVENTS
        expected, found = reference(scene), volume | areas
        assert found.keys() == expected.keys()
        due = {event: time for event, time in reference_times(scene).items() if time is not None}
        assert times.keys() == due.keys()
        for some, values in ((found, expected), (times, due)):
            for name, value in values.items():
                assert relative_error(some[name], value) < 1e-50, (scene, name)
