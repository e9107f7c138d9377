"""Volumes and pressures could be off in a way that all our programs share: numbers of others."""

import math

import numpy as np
import pytest

from twodiscs.model.scene import Scene
from twodiscs.sampling.many.insertions import BLOCK, UNITS, box_of, run_blocks
from twodiscs.theory import channel, plain, three


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


def test_pressure_on_a_ring_has_the_fourth_virial_coefficient():
    """B4/B2³ = 2 − 9√3/(2π) + 10/π² (Rowlinson, Mol. Phys. 7, 593 (1964)): 0.532231….

    For σ = 1 no cluster of four reaches around a ring of circumference 4 or from wall to wall of
    B = 3. A cluster integral of k discs is therefore K_k = L (b_k B + w_k), with the walls, and its
    derivative by B is L b_k. Those of two and three are exact, from squares; that of four has
    the sampled area of a disc at a wall beside three others, at 5 of its standard errors.
    """
    sides = np.array([2.5, 3.0, 3.5])
    squares = np.array([cluster_integrals(side) for side in sides])
    (second, third), walls, _ = np.linalg.solve(np.vander(sides, 3), squares)
    around, across = 4.0, 3.0
    one, one_moved = around * across, around
    # Q_k = V_k/k! and their derivatives by B, from K_k.
    two = around * (second * across + walls[0] / 2) + one**2 / 2
    two_moved = around * second + one * one_moved
    three_discs = around * (third * across + walls[1] / 2) + one * two - one**3 / 3
    three_moved = around * third + one_moved * two + one * two_moved - one**2 * one_moved

    scene, blocks = Scene(around, across + 1, 0.5, discs=4, periodic="x"), 1024
    sums, products = run_blocks(scene, 4, 0, blocks)
    samples = blocks * BLOCK
    mean = sums[2] / UNITS / samples
    error = math.sqrt((products[2, 2] / UNITS / samples - mean**2) / samples)
    # ∂V/∂B = (N/B) (AB)^N ⟨W [free at a wall]⟩.
    area = (
        scene.discs
        / across
        * one**scene.discs
        * box_of(scene).typical
        / math.factorial(scene.discs)
    )
    fourth = area * mean - (
        one_moved * three_discs + one * three_moved + two * two_moved
        - 2 * one * one_moved * two - one**2 * two_moved + one**3 * one_moved
    )  # fmt: skip
    cube = -(second**3)
    b4 = (-20 * second**3 + 18 * second * third - 3 * fourth / around) / cube
    error *= 3 * area / around / cube
    known = 2 - 9 * math.sqrt(3) / (2 * math.pi) + 10 / math.pi**2
    print(f"B4/B2³: {b4:.4f} ± {error:.4f}, published {known:.4f}")
    assert abs(b4 - known) < 5 * error
    # An error bar that would let anything pass is no test.
    assert error < known / 20


@pytest.mark.parametrize("share", [0.3, 0.6, 0.9])
def test_residue_at_close_packing_in_a_channel(share):
    """The force times the length left is 2 kT for each disc in a zigzag at close packing.

    Montero and Santos, arXiv:2212.08932: the equation of state has a simple pole with residue 2
    there, where hard rods on a line have 1. The rest of the expansion is linear in kT/force.
    """
    across = share * math.sqrt(0.75)
    least = math.sqrt((1 - across) * (1 + across))

    def residue(force):
        return force * (channel.limit(1 + across, 0.5, force).length - least)

    extrapolated = 2 * residue(2e5) - residue(1e5)
    assert extrapolated == pytest.approx(2, rel=1e-7)
