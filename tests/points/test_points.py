"""Points as objects and as files: a written point is read unchanged, other files are errors."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from factory import BOX, POINTS, Laws, bins_point, counts_point, hits_point, theory_rows

from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.model.checks import InputError
from twodiscs.model.events import EVENTS
from twodiscs.points.base import by_radius
from twodiscs.points.digests import read_json, write_json
from twodiscs.points.dynamics import Strata, StripCount
from twodiscs.points.intervals import WideBins
from twodiscs.points.monte_carlo import Hits, InsertionPoint, MonteCarloPoint, Weights

LAW = Laws(BOX.scene(0.1))
RNG = np.random.default_rng(6)
STRIP = StripCount(
    duration=0.1, share=0.5, replicas=18, count=3, squares=5, status="reached", rounds=1, events=9,
    strata=Strata([[0.5, 0.5]], [[9, 9]], [[1, 2]], [[1, 4]]),
)  # fmt: skip
INSERTED = InsertionPoint(
    radius=0.1, method="insertion", samples=10**6, unit=2**20,
    quantities={
        "volume": Weights(10**12, 2 * 10**12, 3.0), "top_wall_area": Weights(10**11, 10**11, 4.0),
    },
    products={"volume*top_wall_area": 3 * 10**11},
)  # fmt: skip
HALF = {"counts": [7, 5], "squares": [9, 7], "products": [20, 15]}
GOOD = {
    "monte_carlo": LAW.monte_carlo(RNG, 10**5),
    "insertion": INSERTED,
    "dynamics": replace(
        LAW.dynamics(RNG, 256, 1e-2, ("vertical_hop", "any_wall")),
        strips={"vertical_hop": STRIP},
    ),
    "intervals": bins_point(
        0.1, (7, 5), chains=12, intervals=36, intervals_squared=120, products=HALF["products"],
        squares=HALF["squares"], wide=WideBins(edges=[0, 1, 2], **HALF),
    ),
}  # fmt: skip


def places(content, above=()):
    """Yield the keys of all that a dict holds, at any depth, and of one item of each list."""
    items = content.items() if isinstance(content, dict) else enumerate(content[:1])
    for name, value in items:
        yield (*above, name)
        if isinstance(value, dict | list):
            yield from places(value, (*above, name))


def changed(content, place, *value):
    """Return a copy of a dict with another ``value`` at a ``place``, or with none."""
    content = json.loads(json.dumps(content))
    block = content
    for name in place[:-1]:
        block = block[name]
    if value:
        block[place[-1]] = value[0]
    else:
        del block[place[-1]]
    return content


def read(tmp_path, stage, content):
    """Return the point of a file that has the right digest of some ``content``."""
    path = tmp_path / "0.1.json"
    write_json(path, content)
    return POINTS[stage].read(path)


def refusal(tmp_path, stage, content):
    with pytest.raises(InputError) as caught:
        read(tmp_path, stage, content)
    start = f"{tmp_path / '0.1.json'} must be a point of {stage}, but was made by another version: "
    end = "; delete it, and it is made again"
    said = str(caught.value)
    assert said.startswith(start)
    assert said.endswith(end)
    return said.removeprefix(start).removesuffix(end)


@pytest.mark.parametrize("name", GOOD)
def test_a_point_is_read_as_it_was_written(tmp_path, name):
    point = GOOD[name]
    point.write(tmp_path / "a.json", seconds=1.5)
    assert type(point).read(tmp_path / "a.json") == POINTS[point.stage].read(tmp_path / "a.json")
    assert POINTS[point.stage].read(tmp_path / "a.json") == point
    assert type(point).of(read_json(tmp_path / "a.json")) == point


@pytest.mark.parametrize("stage", POINTS)
@pytest.mark.parametrize("name", GOOD)
def test_a_point_of_another_stage_is_refused(tmp_path, stage, name):
    if GOOD[name].stage != stage:
        refusal(tmp_path, stage, GOOD[name].content())


@pytest.mark.parametrize("name", GOOD)
def test_what_is_missing_or_not_known_is_named(tmp_path, name):
    """Lists are shorter, and keys gone: either may leave a point, of which there are tables."""
    point, kept = GOOD[name], []
    content = point.content()
    for place in places(content):
        try:
            read(tmp_path, point.stage, changed(content, place))
        except InputError:
            said = refusal(tmp_path, point.stage, changed(content, place))
            assert said.count("\n") == 0
        else:
            kept.append(".".join(map(str, place)))
    # A point without these is a point, too.
    assert {*kept} <= {"right_and_top", "strips.vertical_hop"} | {
        f"quantities.{quantity}" for quantity in ("volume", *(f"{e}_area" for e in EVENTS))
    }
    assert refusal(tmp_path, point.stage, content | {"colour": 1}) == "colour is not known"


DEEP = []
for _ in range(400):
    DEEP = [DEEP]


VALUES = (None, True, -1, 0, 0.5, 1.7e308, 2**127, 10**400, "x", [], {}, DEEP)


@pytest.mark.parametrize("value", VALUES, ids=range(len(VALUES)))
@pytest.mark.parametrize("name", GOOD)
def test_whatever_stands_at_whatever_place_is_refused_or_has_rows(tmp_path, name, value):
    """Nothing but one sentence comes of a file of the right digest and another shape."""
    point, theory = GOOD[name], theory_rows([0.1])
    content = point.content()
    assert refusal(tmp_path, point.stage, {"radius": value})
    for place in places(content):
        try:
            other = read(tmp_path, point.stage, changed(content, place, value))
            points = {point.stage: [other]}
            SCENE_TABLES["check"].rows(BOX, theory, points)
        except InputError:
            continue


@pytest.mark.parametrize(
    ("place", "value", "said"),
    [
        (("radius",), [0.1], "radius must be a finite number, not of type list"),
        (("counts",), [], "counts must be an object, not of type list"),
        (("counts", "any_wall"), DEEP, "counts.any_wall must be an integer from 0 to 2**127, not"),
        (("counts", "any_wall"), True, "counts.any_wall must be an integer"),
        (("counts", "colour"), 1, "counts.colour is not known"),
        (("products", "any_wall*any_wall"), None, "products.any_wall*any_wall must be an integer"),
        (("replicas",), 0, "replicas must be larger than 0, not 0"),
        (("strips", "top_wall"), None, "strips.top_wall must be an object"),
        (("strips", "vertical_hop", "strata", "shares"), [[0.5, 0.6]], "shares of strata must add"),
        (("strips", "vertical_hop", "strata", "starts"), [[9]], "strata must be in arrays"),
        (
            ("strips", "vertical_hop", "replicas"),
            19,
            "replicas of a strip is 19, but in its strata",
        ),
        (("strips", "vertical_hop", "count"), 4, "count of a strip is 4, but in its strata 3"),
        (("strips", "vertical_hop", "squares"), 4, "squares of a strip is 4, but in its strata 5"),
    ],
)
def test_another_shape_is_said(tmp_path, place, value, said):
    content = changed(GOOD["dynamics"].content(), place, value)
    assert refusal(tmp_path, "dynamics", content).startswith(said)


def test_a_point_gives_estimates_by_name():
    hits = hits_point(samples=1000, volume=250, top_wall_area=0)
    assert hits.estimate("volume").value == 0.25
    assert hits.estimate("top_wall_area") is None
    assert INSERTED.estimate("volume").value == 3.0 * 10**6 / 2**20
    counts = counts_point(total=400, squares=800)
    assert counts.estimate("vertical_hop").value == 2048 * 10.0 / 400
    assert counts.estimate("vertical_hop", copies=2).value == 2 * 2048 * 10.0 / 400
    assert counts_point().estimate("vertical_hop") is None
    assert GOOD["dynamics"].estimate("vertical_hop") == STRIP.estimate()
    assert STRIP.estimate().value == pytest.approx(0.1 / 0.5 / (3 / 18))
    bins = bins_point(counts=(7, 5, 0))
    assert bins.estimate("mean").stderr == 0.1
    assert bins.estimate("density_at_zero").value == pytest.approx((7 * 7 - 5) / 6 / 12 / 0.125)
    named = (hits, "quantity"), (INSERTED, "quantity"), (counts, "event"), (bins, "name")
    for point, what in named:
        with pytest.raises(InputError, match=f"{what} must be .*, not 'median'"):
            point.estimate("median")


def test_points_are_sorted_and_a_radius_must_not_come_twice():
    points = [counts_point(radius) for radius in (0.2, 0.1, 0.3)]
    assert [point.radius for point in by_radius(points)] == [0.1, 0.2, 0.3]
    with pytest.raises(ValueError, match=r"points must not contain radius 0\.02 twice"):
        by_radius([counts_point(0.02)] * 2)


def test_the_error_of_a_density_is_that_of_a_ratio_of_two_numbers_of_each_chain():
    """Chains with more intervals have more of them in a bin: the residuals have the error."""
    chains, width = 200, 0.25
    intervals = RNG.poisson(30, chains)
    counts = [RNG.binomial(intervals, 0.4), RNG.binomial(intervals, 0.1)]
    bins = {
        "counts": [int(c.sum()) for c in counts],
        "squares": [int((c * c).sum()) for c in counts],
        "products": [int((c * intervals).sum()) for c in counts],
    }
    total = int(intervals.sum())
    point = bins_point(
        0.1, chains=chains, intervals=total, bin_width=width,
        intervals_squared=int((intervals**2).sum()), wide=WideBins(edges=[0, 1, 2], **bins), **bins,
    )  # fmt: skip
    for found, c in zip(point.bins(), counts, strict=False):
        density = c.sum() / total
        residuals = (c - density * intervals).std(ddof=1) * math.sqrt(chains) / total
        assert found.density.value == pytest.approx(density / width)
        assert found.density.stderr == pytest.approx(residuals / width)


def test_the_error_of_a_ratio_of_insertions_is_that_of_its_samples():
    samples, unit = 5000, 1
    common = RNG.poisson(100, samples)
    volume, area = common + RNG.poisson(50, samples), common + RNG.poisson(20, samples)
    point = InsertionPoint(
        radius=0.1, method="insertion", samples=samples, unit=unit,
        quantities={
            "volume": Weights(int(volume.sum()), int((volume**2).sum()), 3.0),
            "top_wall_area": Weights(int(area.sum()), int((area**2).sum()), 4.0),
        },
        products={"volume*top_wall_area": int((volume * area).sum())},
    )  # fmt: skip
    found = point.ratio({"top_wall_area": 2.0})
    ratio = 2 * 4 * area.mean() / (3 * volume.mean())
    relative = (area / area.mean() - volume / volume.mean()).std() / math.sqrt(samples)
    assert found.value == pytest.approx(ratio)
    assert found.relative_stderr == pytest.approx(relative)


def test_the_area_of_all_walls_is_as_sure_as_that_of_the_rarer_wall():
    hits = {"right_wall_area": Hits(5000, 1.0, 0.1), "top_wall_area": Hits(50, 1.0, 0.1)}
    point = MonteCarloPoint(0.1, "monte_carlo", 10**6, hits, right_and_top=1)
    assert point.all_walls(BOX.scene(0.1)).enough == 50
