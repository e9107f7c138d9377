"""Volumes and pressures could be off in a way that all our programs share: numbers of others."""

import math

import numpy as np
import pytest

from twodiscs.model.scene import Scene
from twodiscs.theory import plain, three
from twodiscs_paper.studies.passages.models.file import limit


def cluster_integrals(side):
    """Return (Q2 − Q1²/2, Q3 − Q1 Q2 + Q1³/3) of discs with σ = 1, centres in a square.

    With Q_N = V_N/N! they are the coefficients of z² and z³ in ln Ξ (Mayer).
    """
    one = side * side
    two = plain.volume_and_areas(Scene(side + 1, side + 1, 0.5))[0] / 2
    three_discs = three.integrals(side, side, 1.0)[0] / 6
    return two - one**2 / 2, three_discs - one * two + one**3 / 3


def test_second_and_third_virial_coefficients():
    """B2 = πσ²/2 and B3/B2² = 4/3 − √3/π (Tonks, Phys. Rev. 50, 955 (1936)): 0.782004….

    In a box longer than a cluster of discs a cluster integral is the sum over points minus terms
    of the sides and the corners: a polynomial of the second degree in the side.
    """
    sides = np.array([2.5, 3.0, 3.5])
    found = np.array([cluster_integrals(side) for side in sides])
    second, third = np.linalg.solve(np.vander(sides, 3), found)[0]
    b2 = -second
    assert b2 == pytest.approx(math.pi / 2, rel=1e-11)
    b3 = 4 * second**2 - 2 * third
    assert b3 / b2**2 == pytest.approx(4 / 3 - math.sqrt(3) / math.pi, rel=1e-9)


@pytest.mark.parametrize("share", [0.3, 0.6, 0.9])
def test_residue_at_close_packing_in_a_channel(share):
    """The force times the length left is 2 kT for each disc in a zigzag at close packing.

    Montero and Santos, arXiv:2212.08932: the equation of state has a simple pole with residue 2
    there, where hard rods on a line have 1. The rest of the expansion is linear in kT/force.
    """
    across = share * math.sqrt(0.75)
    least = math.sqrt((1 - across) * (1 + across))

    def residue(force):
        return force * (limit(1 + across, 0.5, force).length - least)

    extrapolated = 2 * residue(2e5) - residue(1e5)
    assert extrapolated == pytest.approx(2, rel=1e-7)
