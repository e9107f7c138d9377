"""Published numbers of others, from exact volumes and pressures, of two and three discs."""

import math

import numpy as np
import pytest

from twodiscs.model.scene import Scene
from twodiscs.theory import exact, plain
from twodiscs.theory.many import three


def cluster_integrals(side):
    """Return (Q2 − Q1²/2, Q3 − Q1 Q2 + Q1³/3) of discs with σ = 1, centres in a square.

    With Q_N = V_N/N! they are the coefficients of z² and z³ in ln Ξ (Mayer).
    """
    one = side * side
    two = plain.exact(Scene(side + 1, side + 1, 0.5))[0] / 2
    three_discs = three.integrals(side, side, 1.0)[0] / 6
    return two - one**2 / 2, three_discs - one * two + one**3 / 3


def test_second_and_third_virial_coefficients():
    """B2 = πσ²/2 and B3/B2² = 4/3 − √3/π (Tonks, Phys. Rev. 50, 955 (1936)): 0.782004….

    In a box longer than a cluster of discs a cluster integral is that of each point, less what the
    sides and the corners take: a polynomial of the second degree in the side.
    """
    sides = np.array([2.5, 3.0, 3.5])
    found = np.array([cluster_integrals(side) for side in sides])
    second, third = np.linalg.solve(np.vander(sides, 3), found)[0]
    b2 = -second
    assert b2 == pytest.approx(math.pi / 2, rel=1e-11)
    b3 = 4 * second**2 - 2 * third
    assert b3 / b2**2 == pytest.approx(4 / 3 - math.sqrt(3) / math.pi, rel=1e-9)


def test_pressures_on_the_walls_have_the_third_virial_coefficient():
    """B3/B2² by Tonks (1936), as above, from the areas that pressures are made of.

    Of σ = 1, centres in a square of side L, the cluster of three is 3! b3 L² but for terms of the
    walls, linear in L; so its derivative by one of the sides is linear in L, of slope 3! b3.
    """

    def scene_of(discs, side):
        return Scene(side + 1, side + 1, 0.5, discs=discs)

    def moved(discs, side):
        # ∂V/∂A: each of N discs at the wall that moves.
        return discs * exact.areas(scene_of(discs, side))["right_wall"]

    pairs, triples, sides = [], [], (3.0, 6.0)
    for side in sides:
        one, two = side**2, exact.volume(scene_of(2, side))
        pair = moved(2, side)
        pairs.append(pair - 2 * one * side)
        triples.append(moved(3, side) - 3 * (pair * one + two * side) + 6 * one**2 * side)
    b2, b3 = (
        (values[1] - values[0]) / (sides[1] - sides[0]) / factor
        for values, factor in ((pairs, 2), (triples, 6))
    )
    assert -b2 == pytest.approx(math.pi / 2, rel=1e-11)
    known = 4 / 3 - math.sqrt(3) / math.pi
    assert (4 * b2**2 - 2 * b3) / b2**2 == pytest.approx(known, rel=1e-9)
