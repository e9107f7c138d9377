"""The neck of a hop in a field: how much kinetic energy there can be in it."""

import math

import numpy as np
import pytest

from twodiscs.model.scene import Scene
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.prism import (
    fraction_if_accepted,
    neck_of,
    prism_of,
    propose_anywhere,
    proposed_measure,
)
from twodiscs.sampling.streams import open_stream
from twodiscs.theory import weighted


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


@compiled
def accepted(state, prism, proposals):
    """Return how many of some proposals in a neck are accepted."""
    count = 0
    for _ in range(proposals):
        _, y1, _, dx, dy, dz = propose_anywhere(state, prism, prism.neck)
        fraction = fraction_if_accepted(state, prism, y1, dx, dy, dz, prism.components - 2)
        count += fraction >= 0.0
    return count


@pytest.mark.parametrize(
    ("scene", "hop", "within"),
    [
        (Scene(1.5, 1.0, 0.24, field=0.4), "horizontal_hop", 0.02),
        # Wide necks: some proposals have the opposite order.
        (Scene(1.5, 1.0, 0.1, mass_ratio=2.0), "horizontal_hop", 0.1),
        (Scene(1.5, 1.0, 0.05, radius_ratio=2.0), "vertical_hop", 0.05),
    ],
    ids=["in a field", "wide", "unequal"],
)
def test_proposals_in_a_neck_are_accepted_as_their_measure_says(scene, hop, within):
    """In a field the energy of the lower places of a neck counts in the measure; at 5 sigma."""
    proposals, prism = 200_000, prism_of(scene, hop, within)
    assert prism.neck.most < 0.7 or not scene.field
    expected = weighted.volume_near(scene, hop, within) / proposed_measure(prism)
    found = accepted(open_stream(np.uint64(1), 0), prism, proposals) / proposals
    assert abs(found - expected) < 5 * math.sqrt(expected * (1 - expected) / proposals)
