"""The neck of a hop in a field: how much kinetic energy there can be in it."""

import math

import pytest

from twodiscs.model.scene import Scene
from twodiscs.sampling.prism import neck_of


@pytest.mark.parametrize("mass_ratio", [0.25, 1.0, 4.0])
@pytest.mark.parametrize("radius_ratio", [1.0, 1.3])
def test_the_lighter_disc_on_top_has_the_most_energy_left(mass_ratio, radius_ratio):
    """The lower disc lies on the bottom and the other one on it, as far aside as the neck allows.

    Whatever disc is on top, that is no more than the neck has; for equal radii it is as much.
    """
    scene = Scene(1.5, 1.0, 0.2, field=0.4, mass_ratio=mass_ratio, radius_ratio=radius_ratio)
    within = 0.05
    apart = math.sqrt(scene.contact_distance**2 - within**2)
    (r1, r2), (m1, m2) = scene.radii, scene.masses
    # Potential energies are 0 where a disc lies on the bottom; the total energy is 1/2.
    left = [
        1 - 2 * scene.field * m * (apart + lower - upper)
        for m, lower, upper in ((m1, r2, r1), (m2, r1, r2))
    ]
    most = neck_of(scene, "horizontal_hop", within).most
    assert max(left) <= most + 1e-12
    if radius_ratio == 1:
        assert most == pytest.approx(max(left), rel=1e-12)
