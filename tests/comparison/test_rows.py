"""Rows of points that a run hardly ever has: nothing counted, few chains, equal weights."""

import math
from dataclasses import replace

import numpy as np
import pytest
from factory import BOX, Laws, counts_point, rows_of, theory_rows
from scipy.special import ndtri, stdtr

import twodiscs as td
from twodiscs.comparison.scene_tables import HopHistogram, MeanTimes
from twodiscs.dynamics.many import engine
from twodiscs.model.box import Box
from twodiscs.model.scene import Scene
from twodiscs.theory.exact import replicas_needed


def test_the_bound_of_a_wall_never_hit_counts_no_copy_twice():
    """The walls that are one by symmetry are hit together: no more is known than of one event.

    Without an event in R replicas of length T the bound is R T/(4 ln 20).
    """
    scene = BOX.scene(0.3)
    point = Laws(scene).dynamics(np.random.default_rng(1))
    none = {name: dict.fromkeys(getattr(point, name), 0) for name in ("counts", "products")}
    point = replace(point, **none)
    rows = MeanTimes.rows(BOX, theory_rows([0.3]), {"dynamics": [point]})
    possible = [row for row in rows if row["status"] != "impossible"]
    assert {row["copies"] for row in possible} == {1, 2, 4}
    due = point.replicas * point.duration / (4 * math.log(20))
    for row in possible:
        assert row["status"] == "none-seen"
        assert row["bound"] == pytest.approx(due, rel=1e-12), row["event"]


@pytest.mark.parametrize(("replicas", "status"), [(2**15, "too-few"), (2**16, "reached")])
def test_an_error_smaller_than_asked_needs_its_own_initial_states(replicas, status):
    """Half of the mean time needs 119 states of rough discs, the error of these counts 45411."""
    scene, event = Scene(1.5, 1.0, 0.245, moment_of_inertia=0.5), "disc_collision"
    assert replicas_needed(scene, event, 0.5) < replicas
    total = 1000 * replicas
    point = counts_point(
        scene.radius, event, total, 1010 * total,
        replicas=replicas, target={event: 0.5},
    )  # fmt: skip
    theory = rows_of({(scene.radius, f"{event}_time"): 1.0})
    (row,) = MeanTimes.rows(Box.of(scene), theory, {"dynamics": [point]})
    assert row["status"] == status
    assert (row["stderr"] is None) == (status == "too-few")


@pytest.mark.parametrize("chains", [100, 150])
def test_the_mean_of_a_histogram_is_tested_over_chains(chains):
    """Student's t with as many degrees of freedom as chains less one, whatever their intervals."""
    laws = Laws(BOX.scene(0.2))
    point = laws.intervals(np.random.default_rng(2), chains)
    exact = laws.times["vertical_hop"]
    point = replace(point, mean=exact - 5 * point.stderr)
    (z,) = {row["z"] for row in HopHistogram.rows(theory_rows([0.2]), {"intervals": [point]})}
    assert z == pytest.approx(ndtri(stdtr(chains - 1, -5.0)), abs=2e-3)
    assert abs(z - ndtri(stdtr(point.intervals - 1, -5.0))) > 0.1


CORNERS = [
    (td.Scene(1.5, 1, 1e-4, discs=3), 2**16, 1908),
    (td.Scene(1.5, 1, 1e-4, discs=4), 2**16, 1908),
    (td.Scene(5.8658211593466785, 1.0, 0.48719834881192786, discs=6, periodic="x"), 2**17, 23),
]


@pytest.mark.parametrize(("scene", "samples", "seed"), CORNERS)
def test_insertions_that_all_fit_or_hardly_ever_have_no_error(scene, samples, seed):
    """As two discs have it: too few hits, or too few misses."""
    for row in td.sample(scene, samples, seed=seed).values():
        assert row.status in ("too-few", "none-seen")
        assert row.stderr is None
        assert row.interval() is None
        assert row.z is None
        assert (row.value is None) == (row.status == "none-seen")


@pytest.mark.slow
def test_insertions_where_a_channel_hardly_fits():
    scene = td.Scene(16.08952807319141, 1.0, 0.4514421527425866, discs=16)
    sample = td.sample(scene, 2**17, seed=16)
    assert {row.status for row in sample.values()} <= {"too-few", "none-seen", "impossible"}


DENSE = [
    (td.Scene(5.8658211593466785, 1.0, 0.48719834881192786, discs=6, periodic="x"), 22),
    (td.Scene(1.0, 1.4280527786758892, 0.15449468266455402, discs=10), 17),
    (td.Scene(3.6810167765300044, 1.0, 0.20987490024520206, discs=14, periodic="x"), 17),
]


@pytest.mark.parametrize(("scene", "seed"), DENSE)
def test_rates_that_insertions_do_not_see_are_guessed(scene, seed):
    assert 0 < engine.expected_event_rate(scene) < math.inf
    assert engine.expected_rates(scene)["disc_collision"] > 0


@pytest.mark.slow
@pytest.mark.parametrize(("scene", "seed"), DENSE)
def test_dense_discs_of_which_insertions_see_no_collision_are_followed(scene, seed):
    found = td.simulate(scene, error=3e-2, budget=1.5e6, seed=seed)
    assert all(row.count > 0 for row in found.values() if row.status != "impossible")
    assert found["disc_collision_time"].status in ("reached", "budget", "too-few")
