"""The lock-step ensemble: the same bits everywhere, and the exact rates."""

import json
import math
import os
import subprocess
import sys

import mpmath
import numpy as np
import pytest

from twodiscs.dynamics import counting, intervals, trajectory
from twodiscs.dynamics.law import DISC, WALL_X1, WALL_X2, WALL_Y1, WALL_Y2, law_of
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene
from twodiscs.sampling.separations import draw_configuration, draw_constants, draw_velocity
from twodiscs.sampling.streams import open_stream
from twodiscs.studies.accuracy_cost import scalar
from twodiscs.theory import exact

PAPER = Scene(1.5, 1.0, 0.2)

#: A radius in each regime, both sides of the thresholds, and where the discs hardly fit.
RADII = (0.01, 0.05, 0.2, 0.24, 0.2499, 0.2501, 0.3, 0.36, 0.376, 0.38, 0.3839)


def start(scene, seed):
    stream = open_stream(np.uint64(seed), 0)
    return (*draw_configuration(stream, draw_constants(scene), 0, 0), *draw_velocity(stream))


def same(left, right):
    return all(np.array_equal(a, b) for a, b in zip(left, right, strict=True))


@pytest.mark.parametrize("lanes", [1, 8, 37, 256])
def test_lanes_do_not_matter(lanes):
    reference = counting.run_blocks(PAPER, EVENTS, 7, 0, 2, 32.0)
    assert same(reference, counting.run_blocks(PAPER, EVENTS, 7, 0, 2, 32.0, lanes=lanes))


def test_shards_add_up():
    whole = counting.run_blocks(PAPER, EVENTS, 7, 0, 5, 8.0)
    parts = [counting.run_blocks(PAPER, EVENTS, 7, a, b, 8.0) for a, b in ((0, 1), (1, 4), (4, 5))]
    assert same(whole, [sum(part) for part in zip(*parts, strict=True)])


@pytest.mark.parametrize("radius", [0.05, 0.2, 0.24, 0.3, 0.38])
def test_the_scalar_engine_counts_the_same(radius):
    """Written with branches and divisions, the same law has the same counts, replica for replica.

    Chaos would turn a difference in the last bit into other counts after some tens of events.
    """
    scene = PAPER.with_radius(radius)
    duration = counting.replica_duration(scene)
    arguments = (duration, scene.contact_distance, draw_constants(scene), (0, 0))
    usual = scalar.count_blocks(np.uint64(3), 0, 1, 1024, *arguments, scene.confined)
    lockstep = counting.run_blocks(scene, EVENTS, 3, 0, 1, duration)
    assert same(usual, lockstep)


def exact_events(scene, state, events):
    """Yield (time, code) of the first ``events`` events: 50 digits, textbook formulas."""
    x = [mpmath.mpf(float(q)) for q in state]
    w, h, r = map(mpmath.mpf, (scene.width, scene.height, scene.radius))
    limits = [w / 2 - r, h / 2 - r] * 2
    now = mpmath.mpf(0)
    for _ in range(events):
        times = {
            code: ((limits[i] if x[4 + i] > 0 else -limits[i]) - x[i]) / x[4 + i]
            for i, code in enumerate((WALL_X1, WALL_Y1, WALL_X2, WALL_Y2))
        }
        dx, dy, du, dv = (x[i] - x[i + 2] for i in (0, 1, 4, 5))
        a, b, c = du**2 + dv**2, dx * du + dy * dv, dx**2 + dy**2 - 4 * r**2
        if b < 0 and b**2 > a * c:
            times[DISC] = (-b - mpmath.sqrt(b**2 - a * c)) / a
        code = min(times, key=times.get)
        time = times[code]
        x[:4] = [q + v * time for q, v in zip(x[:4], x[4:], strict=True)]
        now += time
        if code == DISC:
            dx, dy = x[0] - x[2], x[1] - x[3]
            exchange = (dx * du + dy * dv) / (dx**2 + dy**2)
            for i, sign in ((4, -1), (6, 1)):
                x[i] += sign * exchange * dx
                x[i + 1] += sign * exchange * dy
        else:
            x[3 + int(code)] *= -1
        yield now, code


@pytest.mark.parametrize("radius", [0.05, 0.2, 0.24, 0.3, 0.38])
@pytest.mark.parametrize("seed", range(3))
def test_events_are_those_of_50_digits(radius, seed):
    """Event by event until the errors, which grow exponentially, have eaten all but six digits."""
    scene = PAPER.with_radius(radius)
    state = start(scene, seed)
    law, now, compared = law_of(scene), 0.0, 0
    with mpmath.workdps(50):
        for true_time, true_code in exact_events(scene, state, 60):
            time, code = counting.next_event(state, math.inf, law)
            state = counting.after_event(state, time, code, law)
            now += time
            if abs(now - true_time) > 1e-6:
                break
            assert code == true_code
            compared += 1
    assert compared >= 15


def test_following_one_trajectory_is_the_kernel_in_slow_motion():
    rows = list(trajectory.follow(PAPER, start(PAPER, 5), 64.0))
    names = [row[5] for row in rows]
    times = [row[0] for row in rows]
    assert times == sorted(times)
    assert names[0] == "start"
    assert names[-1] == "end"
    assert times[-1] == pytest.approx(64.0)
    counts = scalar.count_replica(
        *start(PAPER, 5), 64.0, PAPER.range_x / 2, PAPER.range_y / 2, PAPER.contact_distance
    )
    assert names.count("vertical_hop") == counts[0]
    assert names.count("horizontal_hop") == counts[1]
    assert names.count("disc_collision") == counts[2]
    for row in rows:
        if row[5] == "vertical_hop":
            assert abs(row[2] - row[4]) < 1e-14
        if row[5] == "horizontal_hop":
            assert abs(row[1] - row[3]) < 1e-14


GENERIC = """
import json, sys
from twodiscs import dynamics, montecarlo
from twodiscs.scene import EVENTS, Scene
from twodiscs.jit import numba
scene = Scene(1.5, 1.0, 0.24)
counts = dynamics.count_events(scene, {event: 0.02 for event in EVENTS}, 10**6, 11)
intervals = dynamics.hop_intervals(scene, "vertical_hop", 1, 11)
areas = ["volume", *(event + "_area" for event in EVENTS)]
samples = montecarlo.sample_point(scene, areas, 1, 0.02, 11)
effects = {"periodic": "x", "field": 0.3, "radius_ratio": 1.2, "mass_ratio": 2.0}
scene = Scene(1.5, 1.0, 0.2, moment_of_inertia=0.4, **effects)
bent = dynamics.count_events(scene, {"vertical_hop": 0.02, "any_wall": 0.02}, 10**6, 11)
json.dump([counts, intervals, samples, bent], sys.stdout, sort_keys=True)
"""


@pytest.fixture(scope="module")
def generic_output(tmp_path_factory):
    """What a processor without AVX computes."""
    environment = os.environ | {
        "NUMBA_CPU_NAME": "generic",
        "NUMBA_CPU_FEATURES": "",
        "NUMBA_CACHE_DIR": str(tmp_path_factory.mktemp("generic")),
    }
    command = [sys.executable, "-c", GENERIC]
    return subprocess.run(command, env=environment, check=True, capture_output=True).stdout


def test_the_bits_do_not_depend_on_the_processor(generic_output):
    here = subprocess.run([sys.executable, "-c", GENERIC], check=True, capture_output=True).stdout
    assert generic_output == here
    assert len(json.loads(here)) == 4


@pytest.mark.parametrize("radius", RADII)
def test_counts_have_the_exact_rates(radius):
    """Five sigma on every event: with some 60 comparisons a false alarm in 3e-5 of all seeds."""
    scene = PAPER.with_radius(radius)
    duration = counting.replica_duration(scene)
    sums, products, eligible = counting.run_blocks(scene, EVENTS, 1, 0, 24, duration)
    times = exact.mean_times(scene)
    for e, event in enumerate(EVENTS):
        if times[event] is None:
            assert sums[e] == 0
            continue
        mean = sums[e] / eligible[e]
        if sums[e] < 1000:
            continue
        error = math.sqrt((products[e, e] / eligible[e] - mean**2) / eligible[e])
        assert abs(mean - duration / times[event]) <= 5 * error, event


@pytest.mark.parametrize("box", [(3.0, 1.0), (1.0, 1.5), (1.0, 1.0), (2.0, 1.0)])
@pytest.mark.parametrize("share", [0.1, 0.45, 0.55, 0.9, 0.99])
def test_other_boxes_have_the_exact_rates(box, share):
    scene = Scene(*box, share * Scene(*box, 1e-3).largest_radius)
    duration = counting.replica_duration(scene)
    sums, products, eligible = counting.run_blocks(scene, EVENTS, 2, 0, 8, duration)
    times = exact.mean_times(scene)
    for e, event in enumerate(EVENTS):
        if times[event] is None:
            assert sums[e] == 0
        elif sums[e] >= 1000:
            mean = sums[e] / eligible[e]
            error = math.sqrt((products[e, e] / eligible[e] - mean**2) / eligible[e])
            assert abs(mean - duration / times[event]) <= 5 * error, event


def test_any_duration_is_unbiased():
    """The mean count is rate × T for every T, even when almost all replicas see nothing."""
    rate = 1 / exact.mean_times(PAPER)["vertical_hop"]
    for duration in (0.05, 0.5, 5.0):
        sums, products, eligible = counting.run_blocks(PAPER, EVENTS, 4, 0, 40, duration)
        mean = sums[0] / eligible[0]
        error = math.sqrt((products[0, 0] / eligible[0] - mean**2) / eligible[0])
        assert abs(mean - rate * duration) <= 5 * error


def test_components_see_their_own_walls():
    """Beyond h/4 only half of the starts reach the right wall, and those at twice the rate."""
    scene = PAPER.with_radius(0.3)
    _, _, eligible = counting.run_blocks(scene, EVENTS, 1, 0, 4, 32.0)
    assert abs(eligible[3] - eligible[0] / 2) <= 5 * math.sqrt(eligible[0]) / 2
    assert eligible[4] == eligible[0]
    left = counting.run_blocks(scene, EVENTS, 1, 0, 1, 32.0, sides=(-1, 0))
    assert left[0][3] == 0
    assert left[2][3] == 0
    assert left[0][4] > 0


def test_what_is_not_watched_is_not_detected():
    walls = counting.run_blocks(PAPER, ("right_wall", "any_wall"), 7, 0, 1, 32.0)
    everything = counting.run_blocks(PAPER, EVENTS, 7, 0, 1, 32.0)
    assert np.array_equal(walls[0][2:], everything[0][2:])
    assert np.array_equal(walls[0][:2], [0, 0])
    bare = counting.run_blocks(PAPER, ("disc_collision",), 7, 0, 1, 32.0)
    assert bare[0][2] == everything[0][2]
    assert np.array_equal(bare[0][[0, 1, 3, 4]], [0] * 4)


@pytest.mark.parametrize("event", ["vertical_hop", "horizontal_hop"])
@pytest.mark.parametrize("radius", [0.05, 0.2])
def test_hop_intervals_have_the_exact_mean(event, radius):
    scene = PAPER.with_radius(radius)
    found = intervals.hop_intervals(scene, event, 2_000_000, 9)
    exact = exact.mean_times(scene)[event]
    assert abs(found["mean"] - exact) <= 5 * found["stderr"]
    assert sum(found["counts"]) + found["overflow"] == found["intervals"]


@pytest.mark.parametrize(("event", "side"), [("vertical_hop", 1.0), ("horizontal_hop", 1.5)])
def test_hop_intervals_have_the_exact_density_at_zero(event, side):
    """p(0⁺) = 3√2 / (16 (side − 2r)); the slope within the bin is taken out by a line fit."""
    scene = PAPER.with_radius(0.1)
    found = intervals.hop_intervals(scene, event, 8_000_000, 10)
    width, n = found["bin_width"], found["intervals"]
    counts = np.array(found["counts"][:3])
    density, error = counts / (n * width), np.sqrt(counts) / (n * width)
    # A parabola through the first three bins, at 0: its coefficients follow from the bin means.
    at_zero = np.array([11.0, -7.0, 2.0]) / 6
    exact = 3 * math.sqrt(2) / (16 * (side - 0.2))
    # Correlated intervals within a chain widen the binomial error; twice is generous.
    assert abs(density @ at_zero - exact) <= 10 * math.sqrt(np.sum((error * at_zero) ** 2))


def test_hop_chains_do_not_depend_on_lanes():
    draw = draw_constants(PAPER)
    results = []
    for lanes in (5, 64):
        histogram = np.zeros(65, np.int64)
        totals = intervals.record_returns(
            np.uint64(1), 0, 2, 64, lanes, 16, law_of(PAPER), draw, None, None, 0.25, histogram
        )
        results.append((totals, histogram))
    assert same(*results)


def test_accuracy_is_reached_or_the_budget_is_spent():
    exact = exact.mean_times(PAPER)
    point = counting.count_events(PAPER, {"vertical_hop": 2e-3, "any_wall": 0.01}, 10**9, 1)
    assert point["status"] == {"vertical_hop": "reached", "any_wall": "reached"}
    assert point["products"].keys() == {
        "vertical_hop*vertical_hop", "vertical_hop*any_wall", "any_wall*any_wall"
    }  # fmt: skip
    mean = point["duration"] * point["eligible"]["vertical_hop"] / point["counts"]["vertical_hop"]
    assert abs(mean / exact["vertical_hop"] - 1) <= 5 * 2e-3
    spent = counting.count_events(PAPER, {"horizontal_hop": 1e-6}, 2 * 10**7, 1)
    assert spent["status"] == {"horizontal_hop": "budget"}
    # The last round may run over the budget by the scatter of the events in it, not by more.
    assert 1.8e7 < spent["events"] < 2.02e7
    assert spent == counting.count_events(PAPER, {"horizontal_hop": 1e-6}, 2 * 10**7, 1)


def test_a_blocked_hop_is_not_waited_for():
    scene = PAPER.with_radius(0.3)
    point = counting.count_events(scene, {"horizontal_hop": 1e-9}, 10**9, 1)
    assert point["status"] == {"horizontal_hop": "impossible"}
    assert point["counts"] == {"horizontal_hop": 0}
    assert point["rounds"] == 1


@pytest.mark.parametrize(
    ("target", "budget", "seed"),
    [
        ({}, 10, 1),
        ({"hop": 0.1}, 10, 1),
        ({"any_wall": 0.0}, 10, 1),
        ({"any_wall": 1.0}, 10, 1),
        ({"any_wall": math.nan}, 10, 1),
        ({"any_wall": "0.1"}, 10, 1),
        ({"any_wall": True}, 10, 1),
        ({"any_wall": 0.1}, 0, 1),
        ({"any_wall": 0.1}, 1e6, 1),
        ({"any_wall": 0.1}, "many", 1),
        ({"any_wall": 0.1}, 2**70, 1),
        ({"any_wall": 0.1}, 10, -1),
        ({"any_wall": 0.1}, 10, 0.5),
    ],
)
def test_bad_requests_are_refused(target, budget, seed):
    with pytest.raises(ValueError, match=r"must|name"):
        counting.count_events(PAPER, target, budget, seed)


def test_bad_intervals_are_refused():
    for event, number, seed in (("wall", 1, 1), ("vertical_hop", 0, 1), ("vertical_hop", 1, None)):
        with pytest.raises(ValueError, match="must"):
            intervals.hop_intervals(PAPER, event, number, seed)
    with pytest.raises(ValueError, match="blocked"):
        intervals.hop_intervals(PAPER.with_radius(0.3), "horizontal_hop", 1, 1)
