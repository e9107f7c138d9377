"""What the file of a point must hold: a mistake names the file, and what is wrong with it."""

import numpy as np
import pytest
from fabricated import Laws, scenes

from twodiscs.comparison.points import FIELDS, OBJECTS, STRIP, by_radius, checked_point

LAW = Laws(scenes()[1])
RNG = np.random.default_rng(6)
POINTS = {
    "monte_carlo": LAW.monte_carlo(RNG, 10**5),
    "dynamics": LAW.dynamics(RNG, replicas=256, relative=1e-2),
    "intervals": LAW.intervals(RNG),
}
STRATA = {"shares": [[0.5, 0.5]], "starts": [[9, 9]], "counts": [[1, 2]], "squares": [[1, 4]]}
GOOD = {
    "duration": 0.1, "share": 0.5, "replicas": 18, "count": 3, "squares": 5, "status": "reached",
    "strata": STRATA,
}  # fmt: skip


@pytest.mark.parametrize("stage", FIELDS)
def test_a_point_of_its_stage_passes_and_no_other(stage):
    for other, point in POINTS.items():
        if other == stage:
            assert checked_point(stage, point, "0.1.json") is point
        else:
            with pytest.raises(ValueError, match=rf"^0\.1\.json is not a point of {stage}: "):
                checked_point(stage, point, "0.1.json")


@pytest.mark.parametrize("stage", FIELDS)
def test_every_field_is_needed(stage):
    point = POINTS[stage]
    for name in FIELDS[stage]:
        without = {key: value for key, value in point.items() if key != name}
        with pytest.raises(ValueError, match=rf"it has no {name}$"):
            checked_point(stage, without, "x")
    for name in OBJECTS[stage]:
        with pytest.raises(ValueError, match=f"{name} is not an object"):
            checked_point(stage, point | {name: [1]}, "x")


def test_what_is_no_object_or_of_no_stage_is_named():
    with pytest.raises(ValueError, match="x is not a point of dynamics: it is not a JSON object"):
        checked_point("dynamics", [1], "x")
    with pytest.raises(ValueError, match="stage must be one of monte_carlo, dynamics, intervals"):
        checked_point("sampling", {}, "x")


@pytest.mark.parametrize(
    ("strip", "message"),
    [
        (1, "is not an object"),
        (GOOD | {"strata": None}, "has wrong strata: "),
        (GOOD | {"strata": {}}, "has wrong strata: "),
        (GOOD | {"strata": STRATA | {"starts": [[9]]}}, "has wrong strata: strata must be"),
        (GOOD | {"strata": STRATA | {"shares": [[0.5, 0.6]]}}, "has wrong strata: shares"),
        (GOOD | {"replicas": 19}, "has replicas 19, but in its strata 18"),
        (GOOD | {"count": 4}, "has count 4, but in its strata 3"),
        (GOOD | {"squares": 4}, "has squares 4, but in its strata 5"),
        *(({key: GOOD[key] for key in GOOD if key != name}, f"has no {name}") for name in STRIP),
    ],
)
def test_a_damaged_strip_is_named(strip, message):
    point = POINTS["dynamics"] | {"strips": {"vertical_hop": GOOD}}
    assert checked_point("dynamics", point, "x") is point
    point["strips"]["horizontal_hop"] = strip
    with pytest.raises(ValueError, match=f"x is not .*: its strip of horizontal_hop {message}"):
        checked_point("dynamics", point, "x")


def test_points_are_sorted_and_a_radius_must_not_come_twice():
    points = [{"radius": radius} for radius in (0.2, 0.1, 0.3)]
    assert [point["radius"] for point in by_radius(points)] == [0.1, 0.2, 0.3]
    with pytest.raises(ValueError, match=r"points must not contain radius 0\.02 twice"):
        by_radius([{"radius": 0.02}] * 2)
