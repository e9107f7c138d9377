"""The face of the theory: functions of all scenes, and plain or fetched ones."""

import json
import math
import subprocess
import sys

import numpy as np
import pytest
from mpmath import mp, mpf
from theory.antiderivatives import DIGITS, Profile, lengths, reference, relative_error

from twodiscs.model.events import AXIS, EVENTS, HOPS, WALLS
from twodiscs.model.scene import Scene
from twodiscs.theory import exact, virial, weighted

BOUND = 1e-13

PAPER = (1.5, 1.0)
GOOD = Scene(*PAPER, 0.3)


# Regimes ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("box", [PAPER, (1.0, 1.7), (1.0, 1.0)])
def test_nothing_jumps_at_a_threshold_but_the_wall_times(box):
    """From one double to the next but one, numbers move by up to 4 parts in the room left."""
    for threshold, axis in ((box[0] / 4, "y"), (box[1] / 4, "x")):
        below = Scene(*box, math.nextafter(threshold, 0))
        above = Scene(*box, math.nextafter(threshold, 1))
        rel = BOUND + 5 * (above.radius - below.radius) / (below.largest_radius - threshold)
        assert exact.volume(above) == pytest.approx(exact.volume(below), rel=rel)
        before, after = exact.areas(below), exact.areas(above)
        for event in EVENTS:
            assert after[event] == pytest.approx(before[event], rel=rel, abs=1e-30)
        before, after = exact.mean_times(below), exact.mean_times(above)
        walls = {wall for wall in WALLS if box[0] == box[1] or AXIS[wall] == axis}
        for event in {*EVENTS} - {*HOPS}:
            factor = 0.5 if event in walls else 1
            assert after[event] == pytest.approx(factor * before[event], rel=rel)


@pytest.mark.parametrize("radius", [0.25, 0.3, 0.375, 0.38])
def test_a_blocked_hop_has_no_area_and_no_time(radius):
    scene = Scene(*PAPER, radius)
    for hop, open_ in (("vertical_hop", radius < 0.375), ("horizontal_hop", False)):
        assert (exact.areas(scene)[hop] > 0) == (exact.rate(scene, hop) > 0) == open_
        assert (exact.mean_times(scene)[hop] is not None) == open_
    assert exact.areas(scene)["horizontal_hop"] == 0.0


@pytest.mark.parametrize(
    ("radius", "right", "top"), [(0.2, 1, 1), (0.3, 0.5, 1), (0.375, 0.5, 0.5), (0.38, 0.5, 0.5)]
)
def test_rates_average_over_all_components_and_times_over_those_that_meet(radius, right, top):
    scene = Scene(*PAPER, radius)
    share = {wall: {"x": right, "y": top}[AXIS[wall]] for wall in WALLS}
    for event, time in exact.mean_times(scene).items():
        if time is not None:
            assert time * exact.rate(scene, event) == pytest.approx(share.get(event, 1), rel=1e-15)


def test_exact_is_ready_for_json():
    numbers = exact.exact(Scene(*PAPER, 0.3))
    assert json.loads(json.dumps(numbers)) == numbers
    assert list(numbers) == [
        "regime", "ergodic_components", "largest_radius", "volume", "areas", "mean_times"
    ]  # fmt: skip


def test_results_can_be_changed_without_changing_the_next():
    scene = Scene(*PAPER, 0.3)
    exact.areas(scene)["top_wall"] = 0
    assert exact.areas(scene)["top_wall"] > 0


@pytest.mark.parametrize("scene", [GOOD, Scene(*PAPER, 0.2, periodic="x", field=0.4)], ids=repr)
def test_events_are_wall_hits_and_collisions(scene):
    """Half of the walls are confined to one part of configuration space: rates do not care."""
    wall, collision = (exact.mean_times(scene)[e] for e in ("any_wall", "disc_collision"))
    assert exact.event_rate(scene) == pytest.approx(1 / wall + 1 / collision, rel=1e-15)
    torus = Scene(*PAPER, 0.2, periodic="xy")
    assert exact.event_rate(torus) == exact.rate(torus, "disc_collision")


@pytest.mark.parametrize("radius", [0.05, 0.2, 0.3])
def test_share_of_discs_that_are_almost_level(radius):
    """By antiderivatives: the separations along the axis of a hop up to a distance."""
    scene = Scene(*PAPER, radius)
    with mp.workdps(DIGITS):
        a, b, sigma = lengths(scene)
        volume = reference(scene)["volume"]
        for distance in (1e-3 * radius, radius, 1.4 * radius):
            upright = 2 * Profile(a, sigma).weighted(b, min(mpf(distance), b), 2) / volume
            found = exact.fraction_near(scene, "vertical_hop", distance)
            assert relative_error(found, upright) < BOUND
            turned = exact.fraction_near(Scene(*PAPER[::-1], radius), "horizontal_hop", distance)
            assert turned == pytest.approx(found, rel=BOUND)


# Hand-over --------------------------------------------------------------------------------------


def test_scenes_with_effects_are_handed_over_to_the_weighted_theory():
    scene = Scene(*PAPER, 0.2, radius_ratio=0.5)
    assert exact.volume(scene) == weighted.volume(scene)
    assert exact.areas(scene) == weighted.areas(scene)
    assert list(exact.areas(scene)) == list(EVENTS)
    times = exact.exact(scene)["mean_times"]
    per_area = virial.flux_constant(4) / weighted.volume(scene)
    for event, area in weighted.areas(scene).items():
        expected = area * per_area / (1 if event in HOPS else 2)
        assert exact.rate(scene, event) == pytest.approx(expected, rel=1e-15)
        assert times[event] == 1 / exact.rate(scene, event)
    shell = weighted.shell_expectation(scene, "any_wall", 0.01)
    assert exact.shell_expectation(scene, "any_wall", 0.01) == shell


def test_plain_scenes_need_the_standard_library_only():
    """The exact numbers of a plain scene are there before NumPy would be imported."""
    code = (
        "import sys; from twodiscs.theory.exact import exact;"
        "from twodiscs.model.scene import Scene;"
        "exact(Scene(1.5, 1.0, 0.2));"
        "print(*sys.modules)"
    )
    run = subprocess.run(
        [sys.executable, "-c", code], check=True, timeout=60, text=True, capture_output=True
    )
    assert not {"numpy", "mpmath", "scipy", "numba"} & set(run.stdout.split())


@pytest.mark.parametrize(
    "effects", [{"radius_ratio": 0.4}, {"periodic": "x", "radius_ratio": 1.5}, {"depth": 0.8}]
)
def test_the_free_fraction_is_that_of_draws_in_the_prism(effects):
    """Centres between the walls of each disc, at 5 sigma."""
    scene, rng, draws = Scene(1.5, 1.0, 0.15, **effects), np.random.default_rng(1), 200_000
    square = np.zeros(draws)
    for axis in scene.axes:
        side = scene.side(axis)
        ring = axis in scene.periodic
        first, second = (
            rng.uniform(0.0 if ring else r, side - (0.0 if ring else r), draws) for r in scene.radii
        )
        apart = np.abs(first - second)
        square += np.minimum(apart, side - apart if ring else apart) ** 2
    free = np.mean(square > scene.contact_distance**2)
    expected = exact.free_fraction(scene)
    assert abs(free - expected) < 5 * math.sqrt(expected * (1 - expected) / draws)
