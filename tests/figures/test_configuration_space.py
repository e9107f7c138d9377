"""The prism of configuration space: the edges that it hides, the half of the cylinder in view."""

import math

import numpy as np
import pytest

from twodiscs.figures import configuration_space as drawn
from twodiscs.figures import style
from twodiscs.model.box import Box


@pytest.mark.parametrize(("azimuth", "elevation"), [(-112.0, 24.0), (35.0, 60.0), (170.0, -10.0)])
def test_a_prism_hides_three_edges_and_a_cylinder_its_other_half(monkeypatch, azimuth, elevation):
    monkeypatch.setattr(drawn, "AZIMUTH", azimuth)
    monkeypatch.setattr(drawn, "ELEVATION", elevation)
    with style.context():
        axes = drawn.draw(Box(1.5, 1.0)).axes[0]
    edges = [line for line in axes.lines if len(line.get_xdata()) == 2]
    assert len(edges) == 12
    assert sum(line.is_dashed() for line in edges) == 3
    strips = [patch for patch in axes.patches if len(patch.get_xy()) == 5]
    assert abs(len(strips) - drawn.STRIPS / 2) <= 1
    # An end of the cylinder lies in two faces each; three of the six faces are seen.
    ends = [patch for patch in axes.patches if len(patch.get_xy()) > 5]
    hidden = [line for line in axes.lines if len(line.get_xdata()) > 2]
    assert len(ends) + len(hidden) == 4
    assert len(ends) == 2


def test_the_page_is_at_right_angles_to_the_view():
    """Points along the line of sight coincide, and those on the page keep their distance."""
    sight = np.array([drawn._towards(axis) for axis in np.eye(3)])
    assert sight @ sight == pytest.approx(1)
    assert drawn._seen(0.7 * sight) == pytest.approx((0, 0), abs=1e-12)
    across = np.cross(sight, [0.3, -0.2, 0.9])
    assert math.hypot(*drawn._seen(across)) == pytest.approx(np.linalg.norm(across))


def test_the_ends_of_the_cylinder_lie_in_the_faces():
    half, radius = 0.59, 0.2
    for angle in np.linspace(0, 2 * math.pi, 17):
        across = radius * math.cos(angle)
        for end in (-1, 1):
            one, two = drawn._turned(across, end * (math.sqrt(2) * half - abs(across)))
            assert max(abs(one), abs(two)) == pytest.approx(half)
            normal = drawn._end_normal(end, across > 0)
            if abs(across) > 1e-9:
                assert normal[0] * one + normal[1] * two == pytest.approx(half)
