"""The points: sums as files and their estimates.

Without it a file that was edited could be read, or a correlation be forgotten.
"""

import json
import math
import re
from dataclasses import replace
from itertools import combinations, combinations_with_replacement

import numpy as np
import pytest
from factory import BOX, counts_point, hits_point

import twodiscs as td
from twodiscs.analysis.check import flux_time
from twodiscs.analysis.tables import CostTable
from twodiscs.dynamics.stages import STAGES
from twodiscs.model.checks import InputError
from twodiscs.points.base import digest_line, file_content, read_json, require_logged, write_json
from twodiscs.points.intervals_point import TIME_GRAIN, IntervalsPoint
from twodiscs.points.monte_carlo_point import Hits, InsertionPoint, MonteCarloPoint, Weights
from twodiscs.theory.clusters import corner_variance
from twodiscs_paper.pipeline.points import read_point

RNG = np.random.default_rng(6)
NEAR, THREE = td.Scene(1.5, 1.0, 0.249), td.Scene(1.5, 1.0, 0.2, discs=3)


@pytest.mark.parametrize(
    ("stage", "make"),
    [
        # The hop is counted in a strip as well.
        ("dynamics", lambda: td.simulate(NEAR, 0.3, seed=5)),
        ("monte_carlo", lambda: td.sample(THREE, 1, seed=5)),
        ("intervals", lambda: td.intervals(NEAR, "vertical_hop", 1, seed=5)),
    ],
)
def test_a_saved_result_is_a_point_and_no_other_point(tmp_path, stage, make):
    result, path = make(), tmp_path / "a.json"
    result.save(path)
    point = read_point(path, STAGES[stage], result.scene, result.settings)
    assert point.scene == result.scene
    assert point == type(point).of(point.scene, result.components)
    assert point.components.keys() == result.components.keys()
    for other in STAGES.keys() - {stage}:
        with pytest.raises(InputError, match=r"has kind '\w+', but its job asks for '\w+'; delete"):
            read_point(path, STAGES[other], result.scene, result.settings)
    with pytest.raises(InputError, match="must be a file, not a folder; delete it"):
        read_point(tmp_path, STAGES[stage], result.scene, result.settings)


def test_bursts_of_rough_discs_are_in_the_squares_and_products_of_counts():
    """Bursts of two walls are the same, so their product has the geometric mean of variances."""
    walls = "right_wall", "top_wall"
    pairs = [f"{a}*{b}" for a, b in combinations_with_replacement(walls, 2)]
    point = counts_point(
        scene=td.Scene(1.5, 1.0, 0.2, moment_of_inertia=0.5), replicas=10**6,
        counts=dict.fromkeys(walls, 0), products=dict.fromkeys(pairs, 7),
    )  # fmt: skip
    right, top = (10**6 * corner_variance(point.scene, wall, 10.0) for wall in walls)
    due = [round(x) + 7 for x in (right, math.sqrt(right * top), top)]
    assert [*point.spread_products.values()] == due
    assert point.everywhere("top_wall").squares == due[2]


def inserted(samples, unit, weights, products):
    """Return the point of insertions with ``weights``, {quantity: (Σ w, Σ w², factor)}."""
    quantities = {name: Weights(*sums) for name, sums in weights.items()}
    return InsertionPoint(THREE, "insertion", samples, unit, quantities, products)


def test_the_error_of_a_density_is_that_of_a_ratio_of_two_numbers_of_each_chain():
    """Chains with more intervals have more of them in a bin: the residuals have the error."""
    chains, width = 200, 0.25
    intervals = RNG.poisson(30, chains)
    counts = [RNG.binomial(intervals, 0.4), RNG.binomial(intervals, 0.1)]
    beyond, times = intervals - sum(counts), RNG.integers(2**20, size=chains) * intervals
    all_ = np.array([*counts, beyond])
    bins = np.array([all_.sum(1), (all_ * all_).sum(1), (all_ * intervals).sum(1)])
    total = int(intervals.sum())
    moments = [int((a * b).sum()) for a, b in ((times, 1), (times, times), (times, intervals))]
    moments += [total, int((intervals**2).sum())]
    component = {"event": "vertical_hop", "chains": chains // 2, "bin_width": width}
    component |= {"edges": [0.0, width, 2 * width]}
    component["sums"] = {(0, 2): [bins, np.array(moments)]}
    point = IntervalsPoint.of(BOX.scene(0.1), {"all": component})
    assert point.overflow == beyond.sum()
    grain, mean = width * TIME_GRAIN, times.sum() / total
    residuals = (times - mean * intervals).std(ddof=1) * math.sqrt(chains) / total
    found = point.mean / grain, point.stderr / grain
    assert found == pytest.approx((mean, residuals), rel=1e-12)
    for found, c in zip(point.bins(), counts, strict=False):
        density = c.sum() / total
        residuals = (c - density * intervals).std(ddof=1) * math.sqrt(chains) / total
        due = pytest.approx((density / width, residuals / width))
        assert (found.density.value, found.density.stderr) == due
    # Chains of two discs have as many intervals each, and the sums of their times alone.
    component |= {"returns": 256, "sums": {(0, 2): [bins[:2], np.array(moments[:2])]}}
    point, unit = IntervalsPoint.of(BOX.scene(0.1), {"all": component}), grain / 256
    due = pytest.approx([times.mean(), times.std(ddof=1) / math.sqrt(chains)], rel=1e-12)
    assert [point.mean / unit, point.stderr / unit] == due
    for found, c in zip(point.bins(), counts, strict=False):
        spread = c.std(ddof=1) / math.sqrt(chains) / (256 * width)
        assert found.density.stderr == pytest.approx(spread)


def test_the_error_of_a_ratio_of_insertions_is_that_of_its_samples():
    samples = 5000
    common = RNG.poisson(100, samples)
    volume, area = common + RNG.poisson(50, samples), common + RNG.poisson(20, samples)
    weights = {"volume": (int(volume.sum()), int((volume**2).sum()), 3e-3)}
    weights |= {"top_wall_area": (int(area.sum()), int((area**2).sum()), 4e-3)}
    joint = {"volume*top_wall_area": int((volume * area).sum())}
    point = inserted(samples, 1, weights, joint)
    found = point.ratio({"top_wall_area": 2.0})
    ratio = 2 * 4 * area.mean() / (3 * volume.mean())
    relative = (area / area.mean() - volume / volume.mean()).std() / math.sqrt(samples)
    assert (found.value, found.relative_stderr) == pytest.approx((ratio, relative))
    found, _ = point.total({"volume": 1.0, "top_wall_area": 2.0})
    each = (3 * volume + 2 * 4 * area) / 1000
    assert (found.value, found.n) == (pytest.approx(each.mean()), samples)
    assert found.stderr == pytest.approx(each.std() / math.sqrt(samples))


@pytest.mark.parametrize("coarse", ["volume", "right_wall_area", "top_wall_area", None])
def test_a_ratio_has_an_error_if_none_of_its_parts_is_coarse(coarse):
    """A hundred samples of one weight each; the areas of two walls are one area, too."""
    walls = "right_wall_area", "top_wall_area"
    names = ("volume", *walls)
    number = {name: (99 if name == coarse else 100) << 20 for name in names}
    joint = {f"{a}*{b}": 9 << 20 for a, b in combinations(names, 2)}
    point = inserted(10**6, 2**20, {name: (n, n, 1.0) for name, n in number.items()}, joint)
    assert (point.ratio(dict.fromkeys(walls, 1.0)) is None) == (coarse is not None)
    assert point.all_walls().enough == (99 if coarse in walls else 100)
    for wall in walls:
        assert (point.ratio({wall: 1.0}) is None) == (coarse in ("volume", wall))
        assert (flux_time(wall[:-5], point) is None) == (coarse in ("volume", wall))
    assert flux_time("disc_collision", point) is None  # whose area it lacks
    # As many misses, and one fewer.
    misses = {name: ((301 << 20) - n, (301 << 20) - n, 1.0) for name, n in number.items()}
    most = inserted(301, 2**20, misses, joint)
    assert most.all_walls().enough == pytest.approx(100 if coarse in (None, "volume") else 99)


def test_all_samples_in_a_shell_are_samples_of_the_volume():
    """Two shells are taken as independent if their overlap was not counted."""
    point = hits_point(samples=1000, volume=500, top_wall_area=50, vertical_hop_area=100)
    assert point.mean_product("top_wall_area", "volume") == 0.05
    assert point.mean_product("top_wall_area", "vertical_hop_area") == pytest.approx(0.005)


def test_the_area_of_all_walls_is_as_sure_as_that_of_the_rarer_wall():
    hits = {"right_wall_area": Hits(5000, 1.0, 0.1), "top_wall_area": Hits(50, 1.0, 0.1)}
    point = MonteCarloPoint(BOX.scene(0.1), "monte_carlo", 10**6, hits, right_and_top=1)
    assert (point.all_walls().enough, point.all_walls().hits) == (50, 5050)
    for wall in hits:
        unseen = hits | {wall: Hits(0, 1.0, 0.1)}
        assert replace(point, quantities=unseen, right_and_top=0).all_walls().estimate is None
    # If all hits are of both shells, they are those of one shell of twice the area.
    hits["right_wall_area"] = hits["top_wall_area"]
    point = replace(point, quantities=hits, right_and_top=50)
    area, top = point.all_walls().estimate, point.sampled("top_wall_area").estimate
    assert area.relative_stderr == pytest.approx(top.relative_stderr)


PART = {"mean": 0.1 + 0.2, "sums": {(0, 1): [[2**62 + 1], [3]]}}
CONTENT = file_content("simulate", {"radius": 0.1}, {"name": "a", "seed": 1}, {"all": PART})
SENTENCE = "is not what its job wrote; delete it, and it is made again"


def test_what_is_written_is_read_unless_it_was_edited(tmp_path):
    path = tmp_path / "a.json"
    write_json(path, CONTENT)
    assert read_json(path) == CONTENT
    first = path.read_bytes()
    lines = first.decode().splitlines()[1:-1]  # one for each key, in order
    assert [line.split('"')[1] for line in lines] == sorted({*CONTENT, "sha256"})
    settings = dict(reversed(CONTENT["settings"].items()))
    write_json(path, dict(reversed(CONTENT.items())) | {"settings": settings})
    assert path.read_bytes() == first
    with pytest.raises(ValueError, match="not JSON compliant"):
        write_json(path, CONTENT | {"components": math.nan})
    assert path.read_bytes() == first
    edited = [json.dumps(json.loads(first) | {key: -1}) for key in CONTENT]
    others = "", "{", "[]", "1", "{}", '{"sha256": "0"}', '{"sha256": null}', "[" * 10**5
    for text in (*edited, *others, json.dumps(CONTENT)):
        path.write_text(text)
        with pytest.raises(InputError, match=re.escape(SENTENCE)):
            read_json(path)


def test_a_file_is_what_the_last_line_of_its_log_says(tmp_path):
    """A log also has what the job printed, other files, and maybe an earlier content."""
    path, log = tmp_path / "small" / "a.csv", tmp_path / "logs" / "small" / "a.log"
    for folder in (path.parent, log.parent):
        folder.mkdir(parents=True)
    lines = []
    for text in ("old", "new"):
        path.write_text(text)
        require_logged(path)
        lines.append(digest_line(path))
    for earlier in ([], [lines[0]]):
        log.write_text("\n".join([*earlier, "0 rows", lines[1], f"{lines[0][:-5]}b.csv"]))
        require_logged(path)
    path.write_text("old")
    for read in (require_logged, CostTable.read):
        with pytest.raises(InputError, match=re.escape(SENTENCE)):
            read(path)
    # Without its log a table is believed, unless it is one of a build.
    log.unlink()
    require_logged(path)
    (tmp_path / "configuration.json").touch()
    with pytest.raises(InputError, match=re.escape(SENTENCE)):
        require_logged(path)
