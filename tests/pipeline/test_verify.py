"""Verification: it finds every difference from the committed results, and nothing else."""

import hashlib
import json
import math
import shutil
from pathlib import Path

import pytest
from factory import bins_point, hits_point

from twodiscs.comparison.tables.monte_carlo import Areas
from twodiscs.points.digests import read_json, write_json
from twodiscs_paper.catalogue import STUDIES
from twodiscs_paper.configuration.load import load, read
from twodiscs_paper.configuration.request import STAGES
from twodiscs_paper.pipeline.results import verify
from twodiscs_paper.pipeline.results.manifest import is_reproducible, manifest
from twodiscs_paper.studies.stability.study import Stability
from twodiscs_paper.studies.thresholds.study import Thresholds

REPOSITORY = Path(__file__).resolve().parents[2]

CONFIGURATION = {
    "results": "results",
    "scenes": [
        {
            "name": "small",
            "box": {"width": 1.5, "height": 1.0},
            "radii": [0.1, 0.24],
            "watch": {
                **{"volume": True, "areas": ["right_wall"], "mean_times": False},
                **{"hop_histogram": {"radii": [0.1], "intervals": 1e3}, "trajectory": False},
            },
        }
    ],
}


def area(radius, **changes):
    """Return a row of areas.csv with plausible values."""
    return Areas.empty(
        **{"radius": radius, "quantity": "right_wall_area", "method": "monte_carlo"},
        **{"samples": 1 << 20, "hits": 4321, "epsilon": 0.1, "status": "sampled", "test": "normal"},
    ) | {
        **{"exact": 0.4 - radius, "estimate": 0.41 - radius, "stderr": 1e-4, "z": 0.0123},
        **{"expectation": 0.40001 - radius, "bias": 1e-5, **changes},
    }


@pytest.fixture
def results(tmp_path):
    """Results of ``CONFIGURATION``, as far as they are compared, with their manifest."""
    folder = tmp_path / "results"
    points = folder / "small" / "points"
    for method, found in {
        "monte_carlo": [hits_point(r, 1 << 20, right_wall_area=4321) for r in (0.1, 0.24)],
        "intervals": [bins_point(0.1)],
    }.items():
        (points / method).mkdir(parents=True)
        for point in found:
            point.write(points / method / f"{point.radius}.json")
    path = folder / "small" / "areas.csv"
    Areas.write(path, [area(0.1), area(0.24)])
    text = manifest(folder, [path])
    (folder / "manifest.sha256").write_text(text)
    return folder


@pytest.fixture
def expected(results, tmp_path):
    """The expected results."""
    verify.write(results, tmp_path / "expected", CONFIGURATION)
    return tmp_path / "expected"


def edit_point(folder, change, path="small/points/monte_carlo/0.24.json"):
    point = read_json(folder / path)
    change(point)
    write_json(folder / path, point)


def test_the_same_is_the_same(results, expected):
    sentences, compared = verify.verify(results, expected)
    assert sentences == []
    assert (compared["points"], compared["tables"]) == (3, 1)
    # Two hits and samples among the points; three bins twice, their squares, four edges and three
    # sums; samples and hits in two rows.
    assert compared["integers"] == 2 * 2 + (4 * 3 + 4 + 3) + 2 * 2


def test_a_changed_count_is_found_to_the_last_digit(results, expected):
    edit_point(results, lambda p: p.update(samples=(1 << 20) + 1))
    assert verify.verify(results, expected)[0] == [
        "small/points/monte_carlo, radius 0.24: samples is 1048577, expected 1048576"
    ]


def test_counts_that_no_float_could_tell_apart_differ():
    big = 2**62
    found, expected = ({"radius 0.1": verify.point_cells({"n": n})} for n in (big + 1, big))
    assert float(big) == float(big + 1)
    assert len(verify.compare("a", found, expected)) == 1


def test_a_bin_of_a_histogram_is_found(results, expected):
    path = "small/points/intervals/0.1.json"
    edit_point(results, lambda p: p["counts"].__setitem__(1, 6), path)
    assert verify.verify(results, expected)[0] == [
        "small/points/intervals, radius 0.1: counts 1 is 6, expected 5"
    ]


@pytest.mark.parametrize(("relative", "found"), [(0.9e-12, 0), (1.1e-12, 1)])
def test_floats_may_differ_in_the_last_digits_only(results, expected, relative, found):
    exact = (0.4 - 0.24) * (1 + relative)
    Areas.write(results / "small" / "areas.csv", [area(0.1), area(0.24, exact=exact)])
    edit_point(results, lambda p: p["quantities"]["right_wall_area"].update(measure=1 + 1e-13))
    sentences = verify.verify(results, expected)[0]
    assert len(sentences) == found
    for sentence in sentences:
        assert sentence.startswith(
            "small/areas.csv, radius 0.24: right_wall_area monte_carlo exact"
        )


@pytest.mark.parametrize(
    ("change", "found"),
    [
        # 1e-12 of the terms of the differences z and bias, not of the differences.
        ({"z": 0.0123 + 0.9e-8}, 0),
        ({"z": 0.0123 + 1.1e-8}, 1),
        ({"bias": 1e-5 + 0.9e-12 * 0.16001}, 0),
        ({"bias": 1e-5 + 1.1e-12 * 0.16001}, 1),
        ({"stderr": None}, 1),
        ({"status": "too-few"}, 1),
    ],
)
def test_differences_are_as_exact_as_what_they_are_made_of(results, expected, change, found):
    Areas.write(results / "small" / "areas.csv", [area(0.1), area(0.24, **change)])
    assert len(verify.verify(results, expected)[0]) == found


@pytest.mark.parametrize(("chi2", "near"), [(0.01, 1e-8), (100.0, 1e-6)])
def test_a_sum_of_squares_of_scores_is_as_exact_as_they_are(chi2, near):
    sheet, close, far = (
        verify.table_cells("thresholds", [Thresholds.empty(chi2=chi2 + off * near)])
        for off in (0.0, 0.9, 1.1)
    )
    assert verify.compare("thresholds.csv", close, sheet) == []
    assert len(verify.compare("thresholds.csv", far, sheet)) == 1


def test_of_rounding_errors_only_the_verdict_counts():
    row = Stability.empty(part="theory", quantity="volume", value=1e-16, passed=True)
    sheet = verify.table_cells("stability", [row])
    other = verify.table_cells("stability", [row | {"value": 3e-16}])
    worse = verify.table_cells("stability", [row | {"value": 3e-10, "passed": False}])
    assert verify.compare("stability.csv", other, sheet) == []
    assert verify.compare("stability.csv", worse, sheet) == [
        "stability.csv: theory volume passed is False, expected True"
    ]


def test_missing_and_additional_points_are_found(results, expected):
    folder = results / "small" / "points" / "monte_carlo"
    (folder / "0.24.json").rename(folder / "0.25.json")
    Areas.write(results / "small" / "areas.csv", [area(0.1), area(0.1), area(0.25)])
    row = "right_wall_area monte_carlo row 2"
    assert verify.verify(results, expected)[0] == [
        f"small/areas.csv, radius 0.1: {row} exact is not expected, and 10 more",
        "small/areas.csv, radius 0.24: missing",
        "small/areas.csv, radius 0.25: not expected",
        "small/points/monte_carlo, radius 0.24: missing",
        "small/points/monte_carlo, radius 0.25: not expected",
    ]


def test_a_missing_table_is_found(results, expected):
    (results / "small" / "areas.csv").unlink()
    shutil.rmtree(results / "small" / "points" / "intervals")
    assert verify.verify(results, expected)[0] == [
        "small/areas.csv: missing",
        "small/points/intervals: missing",
    ]


def test_long_tables_are_compared_at_some_rows():
    rows = [{"time": float(i), "x1": 0.1, "event": "wall_x1"} for i in range(200)]
    kept = verify.thinned("trajectory", rows)
    assert [row["time"] for row in kept] == [0, 64, 128, 192, 199]
    bins = [{"radius": r, "left": i / 8} for r in (0.1, 0.2) for i in range(3)]
    assert verify.thinned("hop_histogram", bins) == [bins[0], bins[3]]
    assert verify.thinned("areas", bins) == bins


def test_writing_takes_what_the_configuration_asks_for_and_nothing_stale(results, tmp_path):
    folder = results / "small" / "points" / "monte_carlo"
    shutil.copy(folder / "0.24.json", folder / "0.3.json")  # of an earlier configuration
    stale = tmp_path / "expected" / "gone" / "volume.csv"
    stale.parent.mkdir(parents=True)
    stale.touch()
    verify.write(results, tmp_path / "expected", CONFIGURATION)
    assert not stale.exists()
    assert verify.verify(results, tmp_path / "expected")[0] == [
        "small/points/monte_carlo, radius 0.3: not expected"
    ]

    (results / "small" / "areas.csv").write_text("changed\n")
    with pytest.raises(ValueError, match="changed since"):
        verify.write(results, tmp_path / "expected", CONFIGURATION)
    (folder / "0.1.json").unlink()
    (results / "manifest.sha256").write_text("")
    with pytest.raises(ValueError, match=r"must have a point at 0\.1"):
        verify.write(results, tmp_path / "expected", CONFIGURATION)


def test_nothing_expected_is_a_mistake(results, tmp_path):
    with pytest.raises(ValueError, match="holds no table or point"):
        verify.verify(results, tmp_path / "empty")


def test_a_file_that_is_no_point_is_a_mistake(results, expected):
    (results / "small" / "points" / "monte_carlo" / "0.24.json").write_text("{")
    with pytest.raises(ValueError, match="is not what its job wrote"):
        verify.verify(results, expected)


def test_the_command_writes_compares_and_says_what_differs(results, tmp_path, monkeypatch, capsys):
    expected, path = tmp_path / "expected", results / "configuration.json"
    path.write_text(json.dumps(CONFIGURATION))
    argv = ["verify", "--expected", expected, "--configuration", path]
    monkeypatch.setattr("sys.argv", list(map(str, argv)))
    with pytest.raises(ValueError, match="no results to compare with"):
        verify.main()
    monkeypatch.setattr("sys.argv", list(map(str, [*argv, "--write"])))
    assert verify.main() == 0
    monkeypatch.setattr("sys.argv", list(map(str, argv)))
    assert verify.main() == 0
    assert "compared 3 points and 1 tables: 27 integers" in capsys.readouterr().out
    edit_point(results, lambda p: p.update(samples=7))
    assert verify.main() == 1
    assert capsys.readouterr().err == (
        "small/points/monte_carlo, radius 0.24: samples is 7, expected 1048576\ndifferences: 1\n"
    )
    shutil.rmtree(results)
    with pytest.raises(ValueError, match="holds no results to verify"):
        verify.main()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({}, ""),
        ({"seed": 1908.0, "accuracy_cost": {"seconds": 20}}, ""),
        ({"seed": 7}, "seed is 7, not 1908"),
        ({"results": "elsewhere"}, "results is 'elsewhere', not 'results'"),
        ({"scenes": [CONFIGURATION["scenes"][0] | {"accuracy": 1e-2}]}, ""),
        ({"scenes": [CONFIGURATION["scenes"][0] | {"radii": [0.1]}]}, "the scene small differs"),
        ({"scenes": [CONFIGURATION["scenes"][0] | {"name": "b"}]}, "the scenes are b, not small"),
    ],
)
def test_another_configuration_is_told(change, said):
    default = CONFIGURATION | {"seed": 1908}
    other = verify.other_configuration(default | change, default)
    assert other.startswith(said) if said else other == ""


def test_the_manifest_is_that_of_sha256sum(tmp_path):
    for name in ("b/two.csv", "a.csv"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(name)
    text = manifest(tmp_path, [tmp_path / "b" / "two.csv", tmp_path / "a.csv"])
    digests = [hashlib.sha256(name.encode()).hexdigest() for name in ("a.csv", "b/two.csv")]
    assert text == f"{digests[0]}  a.csv\n{digests[1]}  b/two.csv\n"
    with pytest.raises(ValueError, match="subpath"):
        manifest(tmp_path / "b", [tmp_path / "a.csv"])


def test_only_what_holds_no_seconds_is_reproducible():
    same = (
        "a/areas.csv",
        "a/figures/volume.pdf",
        "figures/stability.png",
        "errata.csv",
        "effects.csv",
    )
    timed = (
        "a/cost.csv",
        "effects_cost.csv",
        "figures/effects.png",
        "accuracy_cost.csv",
        "figures/accuracy_cost_by_radius.pdf",
        "paper.pdf",
    )
    assert all(map(is_reproducible, same))
    assert not any(map(is_reproducible, (*timed, "report.html", "forecast.csv")))
    for study in STUDIES.values():
        drawn = [f"figures/{name}.png" for name, e in study.figures.items() if e.tables]
        seconds = [not {*study.timed}.isdisjoint(e.tables) for e in study.figures.values()]
        assert [is_reproducible(path) for path in drawn] == [not timed for timed in seconds]


def test_tolerances_are_finite_but_for_rounding_errors():
    """No column of any table escapes: a float of 1 may be off by 1e-8 at most."""
    for table, declared in verify.TABLES.items():
        columns = declared.columns().items()
        row = {name: 1.0 if column.kind is float else None for name, column in columns}
        for place in verify.table_cells(table, [row]).values():
            assert all(math.isfinite(c.tolerance) and c.tolerance <= 1e-8 for c in place.values())


def test_what_is_committed_is_small_and_of_the_default_configuration():
    folder = REPOSITORY / "paper" / "expected"
    path = folder / "configuration.json"
    if not path.exists():
        pytest.skip("nothing is committed")
    default = read(REPOSITORY / "config" / "config.yaml")
    assert verify.other_configuration(default, json.loads(path.read_text())) == ""
    assert max(file.stat().st_size for file in folder.rglob("*.*")) < 1_000_000
    for scene in load(default).scenes:
        for stage in STAGES:
            points = folder / scene.name / "points" / f"{stage}.json"
            found = json.loads(points.read_text()) if scene.keys[stage] else {}
            assert [*found] == [*scene.keys[stage]]
