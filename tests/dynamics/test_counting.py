"""Counts of the ensemble: the same bits everywhere, and the exact rates."""

import json
import math
import os
import subprocess
import sys

import numpy as np
import pytest
from dynamics.rates import check_rates
from factory import all_reached

from twodiscs.dynamics import runs
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.dynamics.runs import relative_errors
from twodiscs.dynamics.two import lockstep
from twodiscs.model.box import Box
from twodiscs.model.events import AXIS, EVENTS, HOPS, WALLS
from twodiscs.model.scene import Scene
from twodiscs.theory.exact import mean_times

PAPER = Scene(1.5, 1.0, 0.2)

#: A radius in each regime, both sides of the thresholds, and where the discs hardly fit.
RADII = (0.01, 0.05, 0.2, 0.24, 0.2499, 0.2501, 0.3, 0.36, 0.376, 0.38, 0.3839)


def same(left, right):
    return all(np.array_equal(a, b) for a, b in zip(left, right, strict=True))


@pytest.mark.parametrize("lanes", [1, 8, 37, 256])
def test_lanes_do_not_matter(lanes):
    reference = runs.run_blocks(PAPER, EVENTS, 7, 0, 2, 32.0)
    assert same(reference, runs.run_blocks(PAPER, EVENTS, 7, 0, 2, 32.0, lanes=lanes))


def test_shards_add_up():
    whole = runs.run_blocks(PAPER, EVENTS, 7, 0, 5, 8.0)
    parts = [runs.run_blocks(PAPER, EVENTS, 7, a, b, 8.0) for a, b in ((0, 1), (1, 4), (4, 5))]
    assert same(whole, [sum(part) for part in zip(*parts, strict=True)])


GENERIC = """
import json, sys
from twodiscs.dynamics import runs
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene
from twodiscs.points.base import content_of
from twodiscs.sampling import montecarlo
scene = Scene(1.5, 1.0, 0.24)
counts = runs.count_events(scene, {event: 0.02 for event in EVENTS}, 10**6, 11)
times = runs.hop_intervals(scene, "vertical_hop", 1, 11)
areas = ["volume", *(event + "_area" for event in EVENTS)]
samples = montecarlo.sample_point(scene, areas, 1, 0.02, 11)
effects = {"periodic": "x", "field": 0.3, "radius_ratio": 1.2, "mass_ratio": 2.0}
scene = Scene(1.5, 1.0, 0.2, moment_of_inertia=0.4, **effects)
bent = runs.count_events(scene, {"vertical_hop": 0.02, "any_wall": 0.02}, 10**6, 11)
points = [content_of("", {}, {}, point.parts) for point in (counts, times, samples, bent)]
json.dump(points, sys.stdout, sort_keys=True)
"""


@pytest.fixture(scope="module")
def generic_output(tmp_path_factory):
    """The counts on a processor without AVX."""
    environment = os.environ | {
        "NUMBA_CPU_NAME": "generic",
        "NUMBA_CPU_FEATURES": "",
        "NUMBA_CACHE_DIR": str(tmp_path_factory.mktemp("generic")),
    }
    command = [sys.executable, "-c", GENERIC]
    return subprocess.run(command, env=environment, check=True, capture_output=True).stdout


@pytest.mark.slow
def test_the_bits_do_not_depend_on_the_processor(generic_output):
    here = subprocess.run([sys.executable, "-c", GENERIC], check=True, capture_output=True).stdout
    assert generic_output == here
    assert len(json.loads(here)) == 4


def test_packed_counts_do_not_run_over():
    """A lane sees an event once in a pass at most, and a field has eight bits."""
    assert lockstep.UNPACKED < 2**8


@pytest.mark.parametrize("radius", RADII)
def test_counts_have_the_exact_rates(radius):
    check_rates(PAPER.with_radius(radius), seed=1, blocks=24)


@pytest.mark.parametrize("sides", [(3.0, 1.0), (1.0, 1.5), (1.0, 1.0), (2.0, 1.0)])
@pytest.mark.parametrize("share", [0.1, 0.45, 0.55, 0.9, 0.99])
def test_other_boxes_have_the_exact_rates(sides, share):
    box = Box(*sides)
    check_rates(box.scene(share * box.largest_radius), seed=2, blocks=8)


def test_any_duration_is_unbiased():
    """The mean count is rate × T for every T, even when almost all replicas see nothing."""
    for duration in (0.05, 0.5, 5.0):
        check_rates(PAPER, seed=4, blocks=40, duration=duration)


def test_walls_that_symmetry_makes_equal_are_counted_together():
    """Beyond h/4 a component has two of the four pairs of a disc and a wall of x, and one rate."""
    scene = PAPER.with_radius(0.3)
    left, right = (
        runs.run_blocks(scene, EVENTS, 1, 0, 4, 32.0, order=(side, 0)) for side in (-1, 1)
    )
    expected = scene.copies("right_wall") * 32.0 / mean_times(scene)["right_wall"]
    assert scene.copies("right_wall") == 2
    at = {event: e for e, event in enumerate(EVENTS)}
    for sums, products in (left, right):
        error = relative_errors(sums, products, 4 * REPLICAS)[at["right_wall"]]
        beside, above = sums[at["right_wall"]], sums[at["top_wall"]]
        assert abs(beside / (4 * REPLICAS) - expected) <= 5 * error * expected
        assert beside + above == sums[at["any_wall"]]
        for wall in WALLS:
            assert sums[at[wall]] == (beside if AXIS[wall] == "x" else above)


def test_what_is_not_watched_is_not_detected():
    walls = runs.run_blocks(PAPER, ("right_wall", "any_wall"), 7, 0, 1, 32.0)
    everything = runs.run_blocks(PAPER, EVENTS, 7, 0, 1, 32.0)
    hop = np.isin(EVENTS, HOPS)
    assert np.array_equal(walls[0][~hop], everything[0][~hop])
    assert not walls[0][hop].any()
    bare = runs.run_blocks(PAPER, ("disc_collision",), 7, 0, 1, 32.0)
    assert bare[0][EVENTS.index("disc_collision")] == everything[0][EVENTS.index("disc_collision")]
    assert not bare[0][np.isin(EVENTS, (*HOPS, *WALLS))].any()


def test_accuracy_is_reached_or_the_budget_is_spent():
    point = runs.count_events(PAPER, {"vertical_hop": 2e-3, "any_wall": 0.01}, 10**9, 1)
    assert all_reached(point)
    assert point.products.keys() == {
        "vertical_hop*vertical_hop", "vertical_hop*any_wall", "any_wall*any_wall"
    }  # fmt: skip
    mean = point.duration * point.replicas / point.counts["vertical_hop"]
    assert abs(mean / mean_times(PAPER)["vertical_hop"] - 1) <= 5 * 2e-3
    spent = runs.count_events(PAPER, {"horizontal_hop": 1e-6}, 2 * 10**7, 1)
    assert not all_reached(spent)
    # The last round may run over the budget by the scatter of the events in it, not by more.
    assert 1.8e7 < spent.events < 2.02e7
    assert spent == runs.count_events(PAPER, {"horizontal_hop": 1e-6}, 2 * 10**7, 1)


def test_who_watches_sees_what_is_done_and_how_much_there_is():
    seen = []
    run = runs.CountingRun(PAPER, {"horizontal_hop": 1e-6}, 2 * 10**7, 1)
    point = run.run(lambda *given: seen.append(given))
    done, everything = zip(*(pair for pair in seen if pair[0] is not None), strict=True)
    assert list(done) == sorted(done)
    assert done[-1] == pytest.approx(point.events, rel=0.05)
    assert done[-1] <= everything[-1] <= 1.05 * 2 * 10**7


def test_relative_errors_are_those_of_the_replicas():
    counts = np.random.default_rng(1).poisson([3.0, 5.0], (400, 2))
    counts = np.column_stack([counts, np.zeros(400, int)])
    found = runs.relative_errors(counts.sum(0), counts.T @ counts, np.full(3, 400))
    expected = counts.std(0)[:2] / math.sqrt(400) / counts.mean(0)[:2]
    assert found[:2] == pytest.approx(expected, rel=1e-12)
    assert found[2] == math.inf


def test_a_blocked_hop_is_not_waited_for():
    scene = PAPER.with_radius(0.3)
    point = runs.count_events(scene, {"horizontal_hop": 1e-9}, 10**9, 1)
    assert point.counts == {"horizontal_hop": 0}
    assert [*point.parts["all"]["sums"]] == [(0, 32)]
