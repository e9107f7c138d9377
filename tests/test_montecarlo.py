"""Rejection sampling: the exact volume, and the exact expectation of every shell."""

import math

import numpy as np
import pytest
from scipy.special import bdtr

from twodiscs import montecarlo, theory
from twodiscs.scene import EVENTS, HOPS, Scene, largest_radius

PAPER = Scene(1.5, 1.0, 0.2)
EVERYTHING = ["volume", *(f"{event}_area" for event in EVENTS)]
SAMPLES = 8 * montecarlo.BLOCK

#: Five sigma, two-sided: the rate of false alarms of each comparison.
FALSE_ALARM = 5.7e-7


def assert_binomial(hits, samples, probability):
    """``hits`` of ``samples`` are no surprise, by the exact tails of the binomial law."""
    low = bdtr(hits, samples, probability)
    high = 1 - bdtr(hits - 1, samples, probability) if hits else 1.0
    assert 2 * min(low, high) > FALSE_ALARM, (hits, samples * probability)


@pytest.mark.parametrize(
    ("width", "height", "radius"),
    [(1.5, 1.0, r) for r in (0.01, 0.05, 0.2, 0.24, 0.2501, 0.3, 0.36, 0.376, 0.38)]
    + [(3.0, 1.0, 0.4), (1.0, 1.5, 0.3), (1.0, 1.0, 0.1), (1.0, 1.0, 0.28), (2.0, 1.0, 0.4)]
    + [(1e3, 1.0, 0.3), (1.0, 1e3, 0.3)],
)
@pytest.mark.parametrize("shell", [0.02, 0.3])
def test_hits_have_their_exact_probability(width, height, radius, shell):
    """Also for thick shells, whose bias is large: the expectation is that of the shell."""
    scene = Scene(width, height, radius)
    point = montecarlo.sample_point(scene, EVERYTHING, SAMPLES, shell, 21)
    samples, found = point["samples"], point["quantities"]
    volume = found["volume"]
    assert_binomial(volume["hits"], samples, theory.volume(scene) / volume["measure"])
    for event in montecarlo.SHELLS:
        sampled = found[f"{event}_area"]
        expected = theory.shell_expectation(scene, event, sampled["epsilon"])
        assert_binomial(sampled["hits"], samples, expected / sampled["measure"])


def test_estimates_tend_to_the_areas():
    """With a thin shell the estimate is the area itself, gradient factor and sides included."""
    point = montecarlo.sample_point(PAPER, EVERYTHING, 64 * montecarlo.BLOCK, 1e-3, 5)
    areas = theory.areas(PAPER)
    for event in montecarlo.SHELLS:
        sampled = point["quantities"][f"{event}_area"]
        estimate = sampled["measure"] * sampled["hits"] / point["samples"]
        # Five standard errors and the bias, which is of the order of ε over the room.
        assert abs(estimate / areas[event] - 1) <= 5 / math.sqrt(sampled["hits"]) + 2e-3


def test_blocks_add_up_and_are_independent_of_company():
    arguments = (PAPER.range_x, PAPER.range_y, PAPER.contact_distance, (0.01,) * 5, True)
    whole = montecarlo.sample_blocks(np.uint64(3), 0, 4, *arguments)
    parts = [montecarlo.sample_blocks(np.uint64(3), a, b, *arguments) for a, b in ((0, 1), (1, 4))]
    assert np.array_equal(whole, sum(parts))
    only = montecarlo.sample_blocks(np.uint64(3), 0, 4, *arguments[:4], None)
    assert only[0] == whole[0]
    assert not only[1:].any()
    other = montecarlo.sample_blocks(np.uint64(4), 0, 4, *arguments)
    assert not np.array_equal(whole, other)


def test_joint_hits_of_two_walls():
    """Disc 1 in the corner, where the shells of two walls overlap, and disc 2 out of its way."""
    point = montecarlo.sample_point(PAPER, ["any_wall_area"], SAMPLES, 0.3, 1)
    assert point["quantities"].keys() == {"right_wall_area", "top_wall_area"}
    epsilon = point["quantities"]["right_wall_area"]["epsilon"]
    assert epsilon == point["quantities"]["top_wall_area"]["epsilon"]
    rng = np.random.default_rng(1)
    n = 2_000_000
    x1 = PAPER.range_x / 2 - epsilon * rng.random(n)
    y1 = PAPER.range_y / 2 - epsilon * rng.random(n)
    x2 = PAPER.range_x * (rng.random(n) - 0.5)
    y2 = PAPER.range_y * (rng.random(n) - 0.5)
    free = np.mean((x1 - x2) ** 2 + (y1 - y2) ** 2 >= PAPER.contact_distance**2)
    probability = free * epsilon**2 / (PAPER.range_x * PAPER.range_y)
    error = math.sqrt(probability / point["samples"] + probability**2 * (1 - free) / (free * n))
    assert abs(point["right_and_top"] / point["samples"] - probability) <= 5 * error


def test_only_what_is_asked_for_is_sampled():
    point = montecarlo.sample_point(PAPER, ["volume"], 1, 0.02, 1)
    assert point["quantities"].keys() == {"volume"}
    assert point["samples"] == montecarlo.BLOCK
    assert "right_and_top" not in point
    point = montecarlo.sample_point(PAPER, ["vertical_hop_area"], 1, 0.02, 1)
    assert point["quantities"].keys() == {"vertical_hop_area"}


@pytest.mark.parametrize("share", [0.1, 0.6, 0.9, 1 - 1e-3, 1 - 1e-9])
def test_shells_scale_with_the_room(share):
    scene = PAPER.with_radius(share * largest_radius(1.5, 1.0))
    room = scene.largest_radius - scene.radius
    epsilon = montecarlo.shell_thickness(scene, "disc_collision", 0.02)
    assert epsilon == 0.02 * min(scene.radius, room)
    for hop, limit in zip(HOPS, (0.375, 0.25), strict=True):
        epsilon = montecarlo.shell_thickness(scene, hop, 0.02)
        assert epsilon == 0.02 * min(scene.radius, abs(limit - scene.radius))


def test_a_blocked_hop_has_no_hits():
    for radius in (0.2501, 0.3, 0.38):
        scene = PAPER.with_radius(radius)
        point = montecarlo.sample_point(scene, ["horizontal_hop_area"], SAMPLES, 0.5, 1)
        assert point["quantities"]["horizontal_hop_area"]["hits"] == 0
        assert point["quantities"]["horizontal_hop_area"]["epsilon"] > 0


def test_a_radius_on_the_threshold_has_a_shell():
    point = montecarlo.sample_point(PAPER.with_radius(0.25), ["horizontal_hop_area"], 1, 0.02, 1)
    assert point["quantities"]["horizontal_hop_area"]["epsilon"] == 0.02 * 0.25


def test_no_hits_where_rejection_is_hopeless():
    """At r_max (1 − 1e-3) one sample in 1e11 is accepted: no hit, and no complaint."""
    scene = PAPER.with_radius(PAPER.largest_radius * (1 - 1e-3))
    point = montecarlo.sample_point(scene, EVERYTHING, 1, 0.02, 1)
    assert point["quantities"]["volume"]["hits"] == 0


@pytest.mark.parametrize(
    ("quantities", "samples", "shell", "seed"),
    [
        ([], 1, 0.02, 1),
        (["mass"], 1, 0.02, 1),
        (["volume"], 0, 0.02, 1),
        (["volume"], 1.5, 0.02, 1),
        (["volume"], "1e6", 0.02, 1),
        (["volume"], True, 0.02, 1),
        (["volume"], 1, 0.0, 1),
        (["volume"], 1, 1.0, 1),
        (["volume"], 1, math.nan, 1),
        (["volume"], 1, "thin", 1),
        (["volume"], 1, 0.02, -1),
        (["volume"], 1, 0.02, 2**64),
    ],
)
def test_bad_requests_are_refused(quantities, samples, shell, seed):
    with pytest.raises(ValueError, match="must"):
        montecarlo.sample_point(PAPER, quantities, samples, shell, seed)
