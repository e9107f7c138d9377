"""The pressure of many discs, against published values.

Without these tests many discs could have another pressure than published: an error that all our
programs share.

The discs have the diameter 1. The force on the walls over kT is ∂lnV/∂B, from the rate of wall
hits. The pressure of the bulk follows without any theory of the walls. At equal chemical potential
each wall adds discs in proportion to its length. Walls that are some σ apart do not know of each
other. Differences between sizes therefore contain the bulk alone.
"""

import math

import numpy as np
import pytest

from twodiscs.dynamics.many import class_counts, many_rates
from twodiscs.model.events import SHELL_EVENTS
from twodiscs.model.scene import Scene
from twodiscs.theory.flux import flux_constant

#: B_k/B_2^(k−1) for k = 1 … 10: Tonks (1936) and Rowlinson (1964) for 3 and 4, above them Clisby
#: and McCoy, J. Stat. Phys. 122, 15 (2006), Table 1.
VIRIAL = (
    1.0, 1.0, 4 / 3 - math.sqrt(3) / math.pi,
    2 - 9 * math.sqrt(3) / (2 * math.pi) + 10 / math.pi**2, 0.33355604,
    0.1988425, 0.1148728, 0.0649930, 0.0362193, 0.0199537,
)  # fmt: skip


def published(packing):
    """Return P/kT of discs with σ = 1, and what is left out.

    The coefficients beyond the tenth are taken to fall by the same ratio as the tenth does; half of
    their sum is the error.
    """
    density, k = 4 * packing / math.pi, np.arange(60)
    falling = VIRIAL[-1] * (VIRIAL[-1] / VIRIAL[-2]) ** (k[len(VIRIAL) :] - len(VIRIAL) + 1)
    terms = np.concatenate([VIRIAL, falling]) * (2 * packing) ** k
    return density * terms.sum(), density * terms[len(VIRIAL) :].sum() / 2


def force(discs, width, height, events, seed, replicas=64):
    """Return (force on a wall of y over its length, standard error), on a ring in units of σ."""
    scene = Scene(width, height, 0.5, discs=discs, periodic="x")
    duration = many_rates.expected_duration(scene, events / replicas)
    sums, products = class_counts.run_classes(
        scene, seed, 0, 1, duration, replicas=replicas, hops=False
    )
    wall = [*SHELL_EVENTS].index("top_wall")
    mean = sums[wall] / replicas
    error = math.sqrt((products[wall, wall] / replicas - mean**2) / (replicas - 1))
    unit = duration * flux_constant(scene.velocity_components) * width
    return mean / unit, error / unit


@pytest.mark.slow
@pytest.mark.parametrize(
    ("packing", "around", "more"), [(0.15, 24.0, 0.74), (0.3, 24.0, 0.54), (0.45, 16.0, 0.38)]
)
def test_pressure_on_a_ring_to_some_thousandths(packing, around, more):
    """From 64 and 256 discs on rings of the same length; ``more`` room is needed than in the bulk.

    Heights are such that 256 − 64 discs are in their difference. The pressure differs from that of
    the bulk by as many discs in both rings, hence in proportion to 1/N.
    """
    (small, its_error), (large, error) = (
        force(discs, around, discs / (4 * packing / math.pi * around) + more, 1.2e7, 2 + discs)
        for discs in (64, 256)
    )
    found, error = large + (large - small) / 3, math.hypot(4 * error, its_error) / 3
    due, rest = published(packing)
    print(f"packing {packing}: {found:.5f} ± {error:.5f}, published {due:.5f} ± {rest:.5f}")
    assert abs(found - due) < 5 * math.hypot(error, rest)
    assert error < 0.003 * due
