"""Exact laws of the distributions of times: at time zero, and which long tails there are."""

import math

import numpy as np
import pytest
from theory.antiderivatives import TURNED

from twodiscs.model.events import HOPS
from twodiscs.model.scene import Scene
from twodiscs.theory import exact
from twodiscs.theory.laws import density_at_zero, tail_constant

BOUND = 1e-13
PAPER = (1.5, 1.0)
GOOD = Scene(*PAPER, 0.3)


@pytest.mark.parametrize("box", [PAPER, (1.0, 1.7)])
def test_density_at_zero_is_that_of_one_bounce(box):
    """Five sigma: crossings by Gaussian velocities weighted by the flux, and the first hop back.

    With d uniform the density at 0 is the mean of 1/(2B) times |v1 + v2|, here taken from the share
    of returns within a short time with disc 1 or 2 followed to the wall.
    """
    scene, rng, n, short = Scene(*box, 0.1), np.random.default_rng(1), 1_000_000, 0.02
    for hop, side in (("vertical_hop", scene.range_y), ("horizontal_hop", scene.range_x)):
        velocity = rng.normal(size=(n, 4))
        velocity /= np.linalg.norm(velocity, axis=1)[:, None]
        v1, v2 = velocity[:, 0], velocity[:, 1]
        y = rng.uniform(-side / 2, side / 2, n)
        places = [y + v * short for v in (v1, v2)]
        folded = [np.clip(q, -side / 2, side / 2) * 2 - q for q in places]
        # Back on the sides from which they came: disc 1 beneath disc 2 though it was faster.
        back = (folded[0] - folded[1]) * (v1 - v2) < 0
        weight = np.abs(v1 - v2) / np.abs(v1 - v2).mean()
        share, error = np.mean(weight * back), np.std(weight * back) / math.sqrt(n)
        density = density_at_zero(scene, hop)
        assert abs(share - density * short) <= 5 * error
    assert density_at_zero(GOOD, "horizontal_hop") is None


def test_tail_constants_of_blocked_drifts():
    """The study of tails measures their size; here are the symmetries and blocked events."""
    assert tail_constant(GOOD, "horizontal_hop") is None
    assert tail_constant(GOOD, "vertical_hop") == 0.0
    assert tail_constant(Scene(*PAPER, 0.38), "disc_collision") == 0.0
    for event in (*HOPS, "disc_collision"):
        scene, turned = Scene(*PAPER, 0.1), Scene(*PAPER[::-1], 0.1)
        other = TURNED[event]
        constants = tail_constant(scene, event), tail_constant(turned, other)
        assert constants[0] == pytest.approx(constants[1], rel=BOUND)


@pytest.mark.parametrize(
    "function",
    [
        lambda scene: density_at_zero(scene, "vertical_hop"),
        lambda scene: tail_constant(scene, "disc_collision"),
    ],
)
def test_only_plain_scenes_have_known_distributions(function):
    with pytest.raises(ValueError, match=r"must be plain .* it has radius_ratio, field"):
        function(Scene(*PAPER, 0.2, radius_ratio=0.5, field=0.1))


def rows_apart(rng, height, sigma, time, n):
    """Return how many of ``n`` starts keep |y1 − y2| ≥ σ for a time, by reflecting both discs.

    Heights are uniform in [0, ``height``] and velocities in the unit disc, as the invariant measure
    has them. Between reflections the distance is linear, so its least is at one of them or an end.
    """
    y = rng.uniform(0, height, (2, n))
    speed, angle = np.sqrt(rng.uniform(0, 1, n)), rng.uniform(0, 2 * math.pi, n)
    v = speed * np.array([np.cos(angle), np.sin(angle)])
    with np.errstate(divide="ignore"):
        hits = (np.arange(-9, 10)[:, None, None] * height - y) / v
    times = np.clip(hits.reshape(-1, n), 0, time)
    times = np.concatenate([times, np.full((1, n), time)])
    folded = np.abs((y[:, None] + v[:, None] * times + height) % (2 * height) - height)
    apart = folded[0] - folded[1]
    return int(np.sum(np.all(apart >= sigma, axis=0) | np.all(apart <= -sigma, axis=0)))


def chance(scene, hop, time):
    """Return the probability of drifts in separate rows that avoid a ``hop``, from its tail C/t³.

    By Palm's relation P(none within t) = C/(2 τ t²), where τ is 3πV/(4A) for a hop of the area A.
    """
    area, volume = exact.areas(scene)[hop], exact.volume(scene)
    return 2 * tail_constant(scene, hop) * area / (3 * math.pi * volume * time**2)


@pytest.mark.parametrize(
    ("hop", "radius", "factor"),
    [
        ("vertical_hop", 0.05, 1.05), ("vertical_hop", 0.15, 1.05), ("horizontal_hop", 0.1, 1.05),
        ("horizontal_hop", 0.2, 1.05), ("vertical_hop", 0.1, 1.0),
    ],
)  # fmt: skip
def test_drifts_last_with_the_probability_of_the_tail(hop, radius, factor):
    """From the time on at which a drift in its square ends, the law is exact.

    One standard error is some half a per cent; five tests at five of them.
    """
    scene, n = Scene(1.5, 1.0, radius), 2 * 10**5
    ranges = scene.range_x, scene.range_y
    along, height = ranges if hop == "vertical_hop" else ranges[::-1]
    time = factor * 2 * (height - scene.contact_distance)
    found = rows_apart(np.random.default_rng(3), height, scene.contact_distance, time, n)
    # Free along the axis, and none of these starts overlaps.
    share = (along * height) ** 2 / exact.volume(scene)
    due = chance(scene, hop, time) / share
    assert abs(found / n - due) < 5 * math.sqrt(due * (1 - due) / n)


def test_drifts_make_the_bound_of_the_tail():
    scene, time = Scene(1.5, 1.0, 0.1), 50.0
    both = sum(chance(scene, hop, time) for hop in HOPS)
    tau = exact.mean_times(scene)["disc_collision"]
    assert 2 * tau * both / time == pytest.approx(
        tail_constant(scene, "disc_collision") / time**3, rel=1e-13
    )
