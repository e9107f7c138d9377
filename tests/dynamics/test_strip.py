"""Rare hops from initial states in a strip: rates, errors and acceptance.

Without these tests rare hops counted in a strip could have another rate, or an error that does not
cover it.
"""

import math
from itertools import product
from unittest.mock import Mock

import numpy as np
import pytest
from marks import slow

from twodiscs.dynamics import runs
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.dynamics.two import strip
from twodiscs.model.events import EVENT_AXES, HOPS
from twodiscs.model.scene import Scene
from twodiscs.points.estimates import stratified_mean
from twodiscs.sampling.initial_states import STATE_ROWS, draw_states, start_sampler, states
from twodiscs.sampling.streams import open_stream
from twodiscs.theory import exact
from twodiscs_paper.studies.estimates import chi2_p

PAPER = Scene(1.5, 1.0, 0.2)

#: Far from a threshold and close to both of them.
PLACES = [(PAPER.with_radius(r), "horizontal_hop") for r in (0.245, 0.2494, 0.25 * (1 - 1e-9))]
PLACES += [(PAPER.with_radius(0.3747), "vertical_hop")]

#: Necks of scenes with effects: in a field the upper disc hardly gets that high.
NECKS = {
    "unequal": (
        Scene(1.5, 1.0, 0.2, radius_ratio=1.45, mass_ratio=3.0, moment_of_inertia=0.4),
        "horizontal_hop",
    ),
    "field": (Scene(1.5, 1.0, 0.24, field=1.03), "horizontal_hop"),
    "balls": (Scene(1.0, 1.5, 0.24, depth=0.6), "vertical_hop"),
    # With momentum conserved along an axis, and in a field along the axis of the hop.
    "channel": (Scene(1.5, 1.0, 0.3, periodic="x"), "vertical_hop"),
    "tube": (Scene(1.0, 1.5, 0.24, depth=0.6, periodic="z", mass_ratio=2.0), "vertical_hop"),
    "falling": (Scene(1.2, 1.5, 0.24, field=0.3, radius_ratio=1.2, mass_ratio=0.5), "vertical_hop"),
}

#: Each of them has another kernel, which takes seconds to compile.
COUNTED = [slow(*neck, id=name) for name, neck in NECKS.items()]
#: Both discs as the larger and lighter one, at both hops, in a field.
SIDES = [
    (Scene(1.5, 1.0, side / (2 + 2 * ratio), field=0.5, radius_ratio=ratio, mass_ratio=mass), hop)
    for ratio, mass in ((0.6, 3.0), (1.5, 0.4))
    for side, hop in ((0.98, "horizontal_hop"), (1.47, "vertical_hop"))
]
#: The other necks need many draws.
DRAWN = [NECKS["field"], *SIDES, *(COUNTED[k] for k in (0, 3, 4))]


class Endless(strip.Strip):
    """A strip whose paths last for the whole time."""

    fastest = math.inf


def check_rate(scene, hop, band, found):
    """Five sigma."""
    mean, error = stratified_mean(strip.stratum_fractions(scene, hop, band), *found)
    assert error / mean < 0.05
    true = exact.rate(scene, hop) * 2 * band.time / band.fraction
    assert abs(mean - true) < 5 * error


@pytest.mark.parametrize(("scene", "hop"), PLACES)
@pytest.mark.parametrize("shorter", [1, 8])
def test_any_strip_has_the_exact_rate(scene, hop, shorter):
    """A path ends only where no hop can follow, and has about as many events as expected."""
    band = strip.choose_strip(scene, hop)
    band = strip.strip_around(scene, hop, band.time / shorter)
    assert band.within == scene.fastest * band.time
    found, events = strip.run_blocks(scene, hop, band, 1, 0, 24)
    check_rate(scene, hop, band, found)
    the_same, all_events = strip.run_blocks(scene, hop, Endless(*band), 1, 0, 24)
    assert np.array_equal(found, the_same)
    assert 0.5 < events / all_events < 1
    # The choice of T needs no more than that.
    due = 24 * REPLICAS * strip.expected_events(scene, hop, band)
    assert shorter > 1 or all_events == pytest.approx(due, rel=0.2)


def test_squares_are_those_of_the_counts_of_a_start():
    given = *PLACES[0], strip.choose_strip(*PLACES[0]), 1
    found = [strip.run_blocks(*given, k, k + 1, replicas=1)[0] for k in range(100)]
    starts, counts, squares = np.swapaxes(found, 0, 1)
    assert np.array_equal(squares, starts * counts**2)
    assert (starts.sum(axis=(1, 2)) == 1).all()
    assert {*counts.flat} >= {0, 1, 2}


@pytest.mark.parametrize(("scene", "hop"), [(PAPER, "vertical_hop"), *COUNTED])
def test_starts_fill_the_strata_as_their_exact_shares_say_and_hops_have_the_exact_rate(scene, hop):
    """χ² of the numbers of starts in all strata; one false alarm in 10⁶."""
    band = strip.choose_strip(scene, hop)
    shares = strip.stratum_fractions(scene, hop, band)
    found, _ = strip.run_blocks(scene, hop, band, 4, 0, 100)
    check_rate(scene, hop, band, found)
    assert strip.constants(scene, hop)["duration"] == 2 * band.time
    starts, *_ = found
    assert starts.sum() == 100 * REPLICAS
    expected = starts.sum() * shares
    assert shares.shape == starts.shape
    assert expected.min() > 100
    chi2 = np.sum((starts - expected) ** 2 / expected)
    assert chi2_p(chi2, starts.size - 1) > 1e-6


def test_strata_in_a_field_compare_a_speed_with_the_energy_that_is_left():
    (scene, hop), lanes = NECKS["field"], np.zeros(1)
    sampler, shape = start_sampler(scene, hop, 0.1), (3, strip.MOST_STRATA, strip.MOST_STRATA)
    hops = strip.HopsInStrip(
        1.0, 1.0, 0.1 / strip.MOST_STRATA, scene.fastest / strip.MOST_STRATA, sampler.prism, True,
        lanes, np.zeros((2, 1)), np.zeros(shape), lanes,
    )  # fmt: skip
    for x1, y1, x2, y2, u1, v1, u2, v2 in states(scene, 20, 1)[:8].T:
        hops.begin(0, (x1, y1, x2, y2, u1, v1, u2, v2))
        most = math.sqrt(2 * (u1**2 + v1**2 + u2**2 + v2**2))  # u1 = −u2, and v1 = v2 = 0
        assert hops.stratum[1, 0] == int(strip.MOST_STRATA * abs(u1 - u2) / most)


@pytest.mark.parametrize(("scene", "hop"), [(PAPER, "vertical_hop"), *NECKS.values()])
def test_the_share_is_that_of_draws_from_everywhere(scene, hop):
    """Five sigma of a binomial count."""
    k, n = "xy".index(EVENT_AXES[hop]), 100_000
    found = states(scene, n, 3)
    apart = np.abs(found[k] - found[k + 2])
    for part in (0.3, 0.9):
        distance = part * math.sqrt(2) * min(scene.radii)
        share = exact.fraction_near(scene, hop, distance)
        inside = np.count_nonzero(apart <= distance)
        assert abs(inside - n * share) <= 5 * math.sqrt(n * share * (1 - share))


@pytest.mark.parametrize(("scene", "hop"), [(PAPER, "horizontal_hop"), *DRAWN])
def test_starts_in_a_strip_are_those_from_everywhere_that_are_in_it(scene, hop):
    """First two moments of every coordinate and its square, five sigma of both."""
    k = "xy".index(EVENT_AXES[hop])
    distance = math.sqrt(2) * min(scene.radii)
    # Some 35 000 in the strip, or as many as a few seconds allow.
    number = min(35_000 / exact.fraction_near(scene, hop, distance), 800_000)
    everywhere = states(scene, round(number), 5)
    seen = everywhere[:, np.abs(everywhere[k] - everywhere[k + 2]) <= distance]
    drawn = np.zeros((STATE_ROWS, 40_000))
    draw_states(open_stream(np.uint64(6), 0), start_sampler(scene, hop, distance), drawn)
    assert np.max(np.abs(drawn[k] - drawn[k + 2])) <= distance
    both = [np.vstack((x, x**2, (x[0] - x[2]) ** 2, (x[1] - x[3]) ** 2)) for x in (seen, drawn)]
    found = ((x.mean(axis=1), x.std(axis=1) / math.sqrt(x.shape[1])) for x in both)
    means, errors = zip(*found, strict=True)
    assert np.all(np.abs(means[0] - means[1]) <= 5 * np.hypot(*errors) + 1e-15)


@pytest.mark.parametrize(("ratio", "hop"), [*product((0.6, 1.5), HOPS)])
def test_the_widest_strip_is_within_the_smaller_disc(ratio, hop):
    """Beyond √2 of its radius the share of a strip is not known; times are powers of two."""
    for radius in (0.06, 0.08, 0.1, 0.13):
        scene = Scene(1.5, 1.0, radius, radius_ratio=ratio)
        limit = math.sqrt(2) * min(scene.radii)
        assert 0.49 < scene.fastest * strip.widest(scene, hop) / limit < 1


def test_only_rare_hops_of_a_neck_have_strips():
    for radius, hops in ((0.1, ()), (0.24, HOPS[1:]), (0.3, ()), (0.374, HOPS[:1])):
        assert strip.rare_hops(PAPER.with_radius(radius)) == hops
    # Walls are hit often in a low box, but its discs pass freely: in a straight flight.
    assert strip.rare_hops(Scene(100.0, 1.0, 0.01)) == ()
    for scene, hop in NECKS.values():
        assert set(strip.rare_hops(scene)) <= {hop}
    # A hop that is all but impossible is waited for: its strip would take for ever to fill.
    for width, radius, field in (
        (0.9313773251626372, 0.09311188377144873, 2.6849301205525116),
        (2.851903922399709, 0.045663183366862564, 5.474870133112426),
    ):
        assert strip.rare_hops(Scene(width, 1.0, radius, field=field)) == ()


ROUGH = {"moment_of_inertia": 0.1}


@pytest.mark.parametrize(
    ("effects", "product"),
    [
        ({}, None),
        (ROUGH, 0.6),
        slow(ROUGH, None),
        ({"friction": 30}, 0.6),
        ({"friction": 300}, 2.43),
        slow({"friction": 30}, None),
        slow({"friction": 300}, None),
    ],
    ids=str,
)
def test_planned_blocks_are_enough_and_not_far_too_many(effects, product):
    """Shards do these and no more: fewer would miss the error that was asked for.

    Slow tests count hops of rough and of kicked discs, fast ones those that are planned, for the
    ``product``.
    """
    scene, hop = Scene(1.5, 1.0, 0.2475, **effects), "horizontal_hop"
    if product:
        band, fine = strip.choose_strip(scene, hop), strip.strip_run(scene, hop, 1e-4, 10**9, 1)
        hops = fine.planned * REPLICAS * 2 * band.time * exact.rate(scene, hop) / band.fraction
        assert product <= hops * 1e-8 <= product * (1 + 1 / 16)
        return
    run = strip.strip_run(scene, hop, 0.01, 10**9, 1)
    assert strip.relative_error(np.ones((1, 1)), np.array([[[9]], [[0]], [[0]]])) == math.inf
    (excess,) = run.error_over_target(run.work(0, run.planned), run.planned)
    assert 0.5 < excess <= 1


@pytest.mark.parametrize(("scene", "hop"), NECKS.values())
def test_a_budget_is_one_of_events_or_of_64_proposals_for_each(scene, hop):
    run = strip.strip_run(scene, hop, 0.01, 10**9, 1)
    starts = run.budget / run.block_events * REPLICAS
    proposals = starts / strip.acceptance(scene, hop, strip.choose_strip(scene, hop))
    assert max(run.budget, proposals / 64) == pytest.approx(10**9)


def test_every_rare_hop_has_random_numbers_of_its_own(monkeypatch):
    """In a square both hops are rare together, and the same numbers would give the same counts."""
    run_blocks = Mock(return_value=(np.zeros(2), 0))
    monkeypatch.setattr(strip, "run_blocks", run_blocks)
    for radius, root in product((0.2499, 0.24999), (1, 2)):
        run = runs.DynamicsRun(Scene(1.0, 1.0, radius), dict.fromkeys(HOPS, 0.1), 10**6, root)
        assert {*HOPS} < {*run.components}
        for hop in HOPS:
            run.components[hop].work(0, 1)
    seeds = [one.args[3] for one in run_blocks.mock_calls]
    assert len({*seeds, 1, 2}) == len(seeds) + 2 == 10
