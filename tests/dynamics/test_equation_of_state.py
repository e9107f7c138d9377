"""Many discs against published equations of state of hard discs, and an exact long channel.

The discs have the diameter 1. Forces on walls over kT are ∂lnV/∂A and ∂lnV/∂B, from rates of wall
hits. The pressure of the bulk follows without any theory of the walls. At equal chemical potential
each wall adds discs in proportion to its length. A corner adds a constant, and so does the
difference of N discs from a number that fluctuates. Walls that are some σ apart do not know of each
other. Differences between sizes therefore contain the bulk alone.

Every comparison allows five standard errors. They come from 32 replicas or more, so that a false
alarm has a probability below 3e-5 for each.
"""

import math

import numpy as np
import pytest

from twodiscs.dynamics.many import engine
from twodiscs.model.events import SHELLS
from twodiscs.model.scene import Scene
from twodiscs.theory import channel
from twodiscs.theory.virial import flux_constant, rates

#: B_k/B_2^(k−1) for k = 1 … 10: Tonks (1936) and Rowlinson (1964) for 3 and 4, above them Clisby
#: and McCoy, J. Stat. Phys. 122, 15 (2006), Table 1.
VIRIAL = (
    1.0, 1.0, 4 / 3 - math.sqrt(3) / math.pi,
    2 - 9 * math.sqrt(3) / (2 * math.pi) + 10 / math.pi**2, 0.33355604,
    0.1988425, 0.1148728, 0.0649930, 0.0362193, 0.0199537,
)  # fmt: skip


def published(packing):
    """Return (P/kT, its derivative by the density) of discs with σ = 1, and what is left out.

    The coefficients beyond the tenth are taken to fall by the same ratio as the tenth does; half of
    their sum is the error.
    """
    density, y, k = 4 * packing / math.pi, 2 * packing, np.arange(60)
    falling = VIRIAL[-1] * (VIRIAL[-1] / VIRIAL[-2]) ** (k[len(VIRIAL) :] - len(VIRIAL) + 1)
    terms = np.concatenate([VIRIAL, falling]) * y**k
    rest = density * terms[len(VIRIAL) :].sum() / 2
    return density * terms.sum(), ((k + 1) * terms).sum(), rest


def forces(discs, width, height, events, seed, periodic="", replicas=64):
    """Return the forces on the walls of x and y and their covariance (2, 2), in a box over σ."""
    # A scene needs a unit of length in which a volume to the power N is a double.
    size = math.sqrt(width * height)
    scene = Scene(width / size, height / size, 0.5 / size, discs=discs, periodic=periodic)
    duration = engine.duration_of(scene, events / replicas)
    sums, products = engine.run_classes(scene, seed, 0, 1, duration, replicas=replicas, hops=False)
    walls = [[*SHELLS].index(wall) for wall in ("right_wall", "top_wall")]
    mean = sums[walls] / replicas
    second = np.triu(products) + np.triu(products, 1).T
    covariance = (second[np.ix_(walls, walls)] / replicas - np.outer(mean, mean)) / (replicas - 1)
    unit = duration * flux_constant(scene.velocity_components) * size
    return mean / unit, covariance / unit**2


def compare(name, found, error, packing):
    """Assert that a pressure is the published one."""
    due, _, rest = published(packing)
    print(f"{name}, packing {packing}: {found:.5f} ± {error:.5f}, published {due:.5f} ± {rest:.5f}")
    assert abs(found - due) < 5 * math.hypot(error, rest)
    return error / due


#: {packing fraction: (length of the rings, by how much more room is needed than in the bulk)}.
ROOM = {0.15: (24.0, 0.74), 0.3: (24.0, 0.54), 0.45: (16.0, 0.38)}


def pressure_on_a_ring(packing, events, seed):
    """Return (P/kT, standard error) of the bulk, from 64 and 256 discs on rings of the same length.

    Heights are such that 256 − 64 discs are in their difference. The pressure differs from that of
    the bulk by as many discs in both rings, hence in proportion to 1/N.
    """
    (around, more), found = ROOM[packing], []
    for discs in (64, 256):
        height = discs / (4 * packing / math.pi * around) + more
        (_, force), covariance = forces(discs, around, height, events, seed + discs, "x")
        found.append((force / around, math.sqrt(covariance[1, 1]) / around))
    (small, its_error), (large, error) = found
    return large + (large - small) / 3, math.hypot(4 * error, its_error) / 3


@pytest.mark.slow
def test_pressure_of_64_and_256_discs_on_a_ring():
    value, error = pressure_on_a_ring(0.3, 1.5e6, 1)
    assert compare("ring", value, error, 0.3) < 0.01


@pytest.mark.slow
@pytest.mark.parametrize("packing", ROOM)
def test_pressure_on_a_ring_to_some_thousandths(packing):
    value, error = pressure_on_a_ring(packing, 1.2e7, 2)
    assert compare("ring", value, error, packing) < 0.003


def pressure_in_boxes(packing, events, seed):
    """Return (P/kT, standard error) of the bulk, from boxes of 64, 128 and 256 discs.

    The sides are ℓ or ℓ′. N = ρ ℓ₁ ℓ₂ + 2 Γ (ℓ₁ + ℓ₂) + K, so that 64 − 2 · 128 + 256 discs are in
    (ℓ′ − ℓ)². The force on a wall of a length ℓ₁ is P ℓ₁ − 2γ. If a box has ν discs more than that
    chemical potential needs, it is larger by (dP/dρ) ν/ℓ₂. The sum of ν is zero as that of N is.
    """
    density, slope = 4 * packing / math.pi, published(packing)[1]
    short = math.sqrt(64 / density) + ROOM[packing][1]
    long = short + math.sqrt(64 / density)
    squares = [forces(n, a, a, events, seed + n) for n, a in ((64, short), (256, long))]
    middle, spread = forces(128, long, short, events, seed + 128)
    # In a square both forces are the same. Walls of x have the length of y.
    values = [squares[0][0].mean(), squares[1][0].mean(), *middle]
    covariance = np.zeros((4, 4))
    covariance[0, 0], covariance[1, 1] = (square[1].mean() for square in squares)
    covariance[2:, 2:] = spread
    # Unknown: P, 2γ, and ν of 64, 256 and 128 discs.
    equations = np.array(
        [
            [short, -1, slope / short, 0, 0],
            [long, -1, 0, slope / long, 0],
            [short, -1, 0, 0, slope / long],
            [long, -1, 0, 0, slope / short],
            [0, 0, 1, 1, -2],
        ]
    )
    weights = np.linalg.inv(equations)[0, :4]
    return weights @ values, math.sqrt(weights @ covariance @ weights)


@pytest.mark.slow
@pytest.mark.parametrize("packing", [0.3, 0.45])
def test_pressure_of_64_128_and_256_discs_in_a_box(packing):
    value, error = pressure_in_boxes(packing, 1.2e7, 3)
    assert compare("boxes", value, error, packing) < 0.01


@pytest.mark.slow
def test_rates_of_256_discs_in_a_channel_are_exact():
    """By the transfer operator: five sigma on each class."""
    scene, replicas = Scene(130.0, 0.6, 0.18, discs=256), 32
    duration = engine.duration_of(scene, 1e6 / replicas)
    sums, products = engine.run_classes(scene, 4, 0, 1, duration, replicas=replicas, hops=False)
    found = sums / replicas / duration
    errors = np.sqrt((np.diag(products) / replicas - (sums / replicas) ** 2) / (replicas - 1))
    for event, rate in rates(scene, channel.derivatives(scene, hops=False)).items():
        if rate > 0:
            k = [*SHELLS].index(event)
            error = errors[k] / duration
            print(f"{event}: {found[k]:.5f} ± {error:.5f}, exact {rate:.5f}")
            assert abs(found[k] - rate) <= 5 * error
            assert error < 0.05 * rate
