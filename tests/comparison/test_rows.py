"""Rows of scenes with effects: the same tables, from points of their own kind."""

import math

import numpy as np
import pytest
from effect_scenes import SCENES
from fabricated import BOX, Laws

from twodiscs.comparison import check, rows, scores, tables
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene
from twodiscs.sampling import montecarlo
from twodiscs.theory import exact


def exact_of(*scenes):
    """Return the exact values as theory.csv has them: of all events, whatever has a place."""
    found = {}
    for scene in scenes:
        exact = exact.exact(scene)
        found[scene.radius, "volume"] = exact["volume"]
        for event in EVENTS:
            found[scene.radius, f"{event}_area"] = exact["areas"][event]
            found[scene.radius, f"{event}_time"] = exact["mean_times"][event]
    return found


@pytest.mark.parametrize("name", SCENES)
def test_monte_carlo_becomes_rows_that_agree(name, tmp_path):
    scene = SCENES[name]
    quantities = ["volume", *(f"{event}_area" for event in scene.events)]
    scenes = [scene.with_radius(radius) for radius in (0.1, scene.radius)]
    points = [montecarlo.better_point(s, quantities, 1, 0.1, 7) for s in scenes]
    exact = exact_of(*scenes)
    volume = rows.volume_rows(exact, points[::-1])
    areas = rows.area_rows(scene, exact, points[::-1])
    tables.write(tmp_path / "volume.csv", "volume", volume)
    tables.write(tmp_path / "areas.csv", "areas", areas)
    assert [row["radius"] for row in volume] == [s.radius for s in scenes]
    assert [(row["radius"], row["quantity"]) for row in areas] == [
        (s.radius, f"{event}_area") for s in scenes for event in scene.events
    ]
    for row in volume + areas:
        possible = row["exact"] != 0
        assert row["status"] == ("sampled" if possible else "impossible")
        # Five sigma, two-sided: a false alarm in 1.7 million comparisons.
        assert abs(row["z"]) <= 5
        if possible:
            assert abs(row["estimate"] - row["expectation"]) <= 6 * row["stderr"]


def test_all_walls_have_counts_of_their_own():
    scene = SCENES["unequal"]
    point = montecarlo.better_point(scene, ["any_wall_area"], 1, 0.1, 7)
    (row,) = rows.area_rows(scene, exact_of(scene), [point], ("any_wall",))
    part = point["quantities"]["any_wall_area"]
    assert (row["hits"], row["epsilon"]) == (part["hits"], part["epsilon"])
    assert row["estimate"] == part["measure"] * part["hits"] / point["samples"]
    watched = rows.area_rows(scene, exact_of(scene), [point], ("right_wall",))
    assert watched == []


@pytest.mark.parametrize("name", SCENES)
def test_mean_times_of_what_is_counted(name, tmp_path):
    scene = SCENES[name]
    point = Laws(scene).dynamics(np.random.default_rng(3), events=scene.events)
    rows = rows.mean_time_rows(scene, exact_of(scene), [point])
    tables.write(tmp_path / "mean_times.csv", "mean_times", rows)
    assert [row["event"] for row in rows] == list(scene.events)
    for row in rows:
        assert row["ergodic_components"] == scene.ergodic_components
        if row["exact"] is None:
            assert (row["status"], row["z"], row["estimate"]) == ("impossible", 0.0, None)
        else:
            assert row["status"] == "reached"
            assert abs(row["z"]) <= 5


def test_an_event_out_of_reach_must_not_be_seen():
    """In this field no disc has the energy to touch the top."""
    scene = Scene(1.5, 1.0, 0.1, field=1.0)
    events = ("top_wall", "right_wall")
    point = Laws(scene).dynamics(np.random.default_rng(3), events=events)
    exact = exact_of(scene)
    rows = {row["event"]: row for row in rows.mean_time_rows(scene, exact, [point])}
    assert (rows["top_wall"]["status"], rows["top_wall"]["z"]) == ("impossible", 0.0)
    point["counts"]["top_wall"] = point["products"]["top_wall*top_wall"] = 1
    rows = {row["event"]: row for row in rows.mean_time_rows(scene, exact, [point])}
    assert rows["top_wall"]["z"] == -math.inf


def test_the_sum_rule_is_for_plain_scenes():
    plain = Scene(**BOX, radius=0.2)
    for scene, expected in ((plain, ["sum_rule"]), (SCENES["rough"], [])):
        point = Laws(scene).dynamics(np.random.default_rng(3), events=check.SUM_RULE)
        rows = check.comparisons(scene, [], [], [], [], [point])
        assert [row["comparison"] for row in rows] == expected


def test_the_check_takes_all_rows_of_a_scene_with_effects(tmp_path):
    scene = SCENES["balls"]
    exact = exact_of(scene)
    quantities = ["volume", *(f"{event}_area" for event in scene.events)]
    sampled = montecarlo.better_point(scene, quantities, 1, 0.1, 7)
    counted = Laws(scene).dynamics(np.random.default_rng(3), events=scene.events)
    rows = check.comparisons(
        scene,
        rows.volume_rows(exact, [sampled]),
        rows.area_rows(scene, exact, [sampled]),
        rows.mean_time_rows(scene, exact, [counted]),
        [],
        [counted],
    )
    assert len(rows) == 1 + 2 * len(scene.events)
    judged = check.check_rows(rows)
    tables.write(tmp_path / "check.csv", "check", judged)
    bound = scores.bonferroni_bound(len(rows), scores.FALSE_ALARM / 2)
    assert all(row["passed"] and row["bound"] == bound for row in judged)


def test_plain_points_keep_to_right_and_top():
    """All walls of a plain scene join two shells, which its point holds."""
    plain = Scene(**BOX, radius=0.2)
    point = montecarlo.better_point(plain, ["any_wall_area"], 1, 0.1, 7)
    assert "any_wall_area" not in point["quantities"]
    (row,) = rows.area_rows(plain, exact_of(plain), [point], ("any_wall",))
    assert row["epsilon"] is None
