"""`verify`: results against those expected, and on any processor.

Without these tests verification could miss a difference, or find one that is none.
"""

import json
import os
import signal

import pandas as pd
import pytest
from checkout import REPOSITORY, Checkout
from commands import python
from factory import EXPECTED, empty

from twodiscs.analysis.tables import GridTable
from twodiscs_paper.configuration.yaml_files import load, read
from twodiscs_paper.pipeline.results import verify

POINT = {"counts": {"vertical_hop": 2**62, "bins": [3, 4]}, "duration": 0.5, "status": "ended"}
TABLES = {
    "agreement.csv": "quantity,estimate,count\nmean_square,1.0,7\n",
    "stability.csv": (
        "part,value,passed,exact,distance\ntheory,1e-16,true,,\nruns,1e-4,true,,\n"
        "extremes,0.3,true,0.25,-1e-6\n"
    ),
    "small/areas.csv": (
        "radius,method,hits,estimate,bias,z,chi2,stderr\n"
        "0.1,conditioned,9007199254740993,0.3,1e-5,0.0123,100.0,1e-4\n"
        "0.24,,,0.16,1e-5,0.0123,0.01,1e-4\n"
    ),
    "small/trajectory.csv": "x1,event\n" + "".join(f"0.{i},hop\n" for i in range(1, 201)),
    "small/hop_histogram.csv": "radius,left,count\n0.1,0.0,5\n0.1,0.125,6\n0.2,0.0,7\n",
}


@pytest.fixture
def results(tmp_path):
    """Results as far as they are compared."""
    place = Checkout(tmp_path / "results")
    for name, text in TABLES.items():
        place.edit(name, text)
    for radius in ("0.1", "0.24"):
        content = POINT | {"radius": float(radius), "seconds": 3.25, "sha256": "0"}
        place.edit(f"small/points/dynamics/{radius}.json", json.dumps(content))
    keys = {"seed": 1, "scenes": [{"name": "small"}], "accuracy_cost": {"seconds": 5}}
    place.edit("configuration.json", json.dumps(keys))
    return place.path


@pytest.fixture
def expected(results, tmp_path, monkeypatch):
    """The expected results, renewed from the results, with the table of a long run beside them."""
    folder, rows = tmp_path / "expected", [empty(GridTable, radius=0.125)]
    (tmp_path / "long_run").mkdir()
    table = GridTable, rows
    monkeypatch.setattr(verify, "long_run_tables", lambda kept: [(kept / "grid.csv", *table)])
    Checkout(folder).edit("gone/volume.csv", "of an earlier configuration\n")
    points = sorted((results / "small/points/dynamics").glob("*.json"))
    verify.renew(results, folder, [results / name for name in TABLES], points)
    return folder


def found(results, expected):
    """Return {file: sentence} of the files that differ."""
    sentences = verify.differences(results, expected)
    return {name.as_posix(): sentence for name, sentence in sentences.items() if sentence}


def replace(path, old, new):
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


def test_renewed_results_are_as_expected(results, expected):
    assert found(results, expected) == {}
    files = len(TABLES) + 2 + 1  # with two points and the configuration
    assert len(verify.differences(results, expected)) == files
    assert not (expected / "gone" / "volume.csv").exists()
    assert "0.125" in (expected.parent / "long_run" / "grid.csv").read_text()
    points = json.loads((expected / "small/points/dynamics.json").read_text())
    assert points == {r: POINT | {"radius": float(r)} for r in ("0.1", "0.24")}
    # Long tables are kept at some rows.
    trajectory = pd.read_csv(expected / "small/trajectory.csv", dtype=str)
    assert [*trajectory["x1"]] == [f"0.{i}" for i in (1, 65, 129, 193, 200)]
    assert [*pd.read_csv(expected / "small/hop_histogram.csv")["count"]] == [5, 7]


@pytest.mark.parametrize(
    ("name", "old", "new", "sentence"),
    [
        # Integers and texts exactly, also beside empty cells and beyond the digits of a float.
        ("areas", "9007199254740993", "9007199254740992", "hits in row 1 is 9007199254740992"),
        ("areas", "0.24,,", "0.24,,7", "hits in row 2 is 7, expected <NA>; 1 rows differ"),
        # Floats to 1e-12 of their size, also the estimates of a table without scores.
        ("areas", "0.3,", f"{0.3 * (1 + 0.9e-12)!r},", ""),
        ("areas", "0.3,", f"{0.3 * (1 + 1.1e-12)!r},", "estimate in row 1"),
        ("areas", "1e-4", "", "stderr in row 1 is <NA>"),
        ("areas", "0.0123", "none", "z in row 1 is none, expected 0.0123"),
        # Columns that lose digits.
        ("areas", "0.0123", f"{0.0123 + 0.9e-8!r}", ""),
        ("areas", "0.0123", f"{0.0123 + 1.2e-8!r}", "z in row 1"),
        ("areas", "100.0", f"{100 + 1.0e-6!r}", ""),
        ("areas", "100.0", f"{100 + 1.2e-6!r}", "chi2 in row 1"),
        ("trajectory", "0.65,hop", "0.65,wall", "event in row 2 is wall"),
        ("hop_histogram", "0.2,0.0,7", "0.2,0.0,8", "count in row 2 is 8"),
        ("areas", "chi2", "chi", "the columns are"),
        # Estimates of scores, and rounding errors within their bound.
        ("../agreement", "1.0", f"{1 + 0.9e-8!r}", ""),
        ("../agreement", "1.0", f"{1 + 3e-8!r}", "estimate in row 1"),
        ("../stability", "1e-16", "3e-16", ""),
        ("../stability", "1e-4", "1.1e-4", "value in row 2"),
        ("../stability", "0.25", f"{0.25 * (1 + 2e-10)!r}", ""),
        ("../stability", "0.25", f"{0.25 * (1 + 3e-10)!r}", "exact in row 3"),
        ("hop_histogram", "0.2,0.0,7\n", "", "1 rows, expected 2"),
    ],
)
def test_a_table_is_compared_cell_by_cell(results, expected, name, old, new, sentence):
    path = os.path.normpath(f"small/{name}.csv")
    replace(results / path, old, new)
    differences = found(results, expected)
    assert [*differences] == ([path] if sentence else [])
    assert differences.get(path, "").startswith(sentence)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        (str(2**62), str(2**62 + 1), f"counts vertical_hop is {2**62 + 1}, expected {2**62}"),
        ("[3, 4]", "[3, 5]", "counts bins 1 is 5, expected 4"),
        ("[3, 4]", "[3, 4, 0]", "counts bins 2 is 0, expected None"),
        ("0.5", f"{0.5 + 0.4e-12!r}", ""),
        ("0.5", f"{0.5 + 0.6e-12!r}", "duration is 0.5000000000006, expected 0.5"),
        ("ended", "budget", "status is 'budget', expected 'ended'"),
        ("3.25", "3.5", ""),  # processor time
    ],
)
def test_a_point_is_compared_value_by_value(results, expected, old, new, sentence):
    name = "small/points/dynamics/0.24.json"
    replace(results / name, old, new)
    assert found(results, expected) == ({name: sentence} if sentence else {})


#: Exact values, computed again and compared with those expected: of scenes, extremes and files.
EXACT_AGAIN = """
import math
import pandas as pd
from twodiscs.analysis.tables import TheoryTable
from twodiscs.model.scene import Scene
from twodiscs.theory import exact
from twodiscs_paper.configuration.yaml_files import load, read
from twodiscs_paper.pipeline.results.verify import read as table, table_difference
from twodiscs_paper.studies.passages.models import file
from twodiscs_paper.studies.passages.parts.with_friction import diffusive_limit
from twodiscs_paper.studies.stability.measure import EXTREMES

for scene in load(read("config/config.yaml")).scenes:
    expected = table(f"paper/expected/{scene.name}/theory.csv")
    rows = TheoryTable.rows(scene.box, scene.exact_radii("theory"))
    observed = pd.DataFrame(rows)[[*expected]].convert_dtypes()
    assert table_difference("theory", observed, expected) == ""
extremes = "part == 'extremes' and quantity.str.endswith('_time') and exact.notna()"
times = table("paper/expected/stability.csv").query(extremes).reset_index(drop=True)
known = {case: exact.mean_times(scene) for case, scene in EXTREMES.items()}
found = [known[row.case][row.quantity.removesuffix("_time")] for row in times.itertuples()]
assert table_difference("stability", times.assign(exact=found), times) == ""
files = "quantity == 'file' and moment_of_inertia.isna() and distance < 0"
rows = table("paper/expected/passages.csv").query(files)
assert len(rows) > 10
for row in rows.astype(object).where(rows.notna(), None).itertuples():
    scene = Scene(row.width, row.height, row.radius, discs=row.discs, periodic="x")
    assert math.isclose(file.law(scene, row.friction, row.time), row.reference, rel_tol=1e-12)
of_necks = "quantity == 'scaled_coefficient' and scene != 'pore'"
necks = table("paper/expected/passages.csv").query(of_necks)
assert len(necks) > 2
for row in necks.itertuples():
    limit = diffusive_limit(Scene(row.width, row.height, row.radius), row.event)
    assert math.isclose(limit, row.reference, rel_tol=1e-12)
"""


@pytest.mark.slow
@pytest.mark.parametrize("threads", ["1", "2"])
@pytest.mark.parametrize("kernel", ["Nehalem", "Haswell", "Zen", "SkylakeX"])
def test_exact_values_are_as_expected_with_every_kernel_of_the_linear_algebra(kernel, threads):
    """A kernel that the processor lacks is replaced by OpenBLAS, or ends the process."""
    chosen = {"OPENBLAS_CORETYPE": kernel, "OPENBLAS_NUM_THREADS": threads}
    done = python("-c", EXACT_AGAIN, env=os.environ | chosen, cwd=REPOSITORY)
    if done.returncode == -signal.SIGILL:
        pytest.skip(f"this processor lacks instructions of {kernel}")
    assert done.returncode == 0, done.stderr


def test_missing_files_and_another_configuration_are_named(results, expected):
    names = "agreement.csv", "small/points/dynamics/0.1.json"
    for name in names:
        (results / name).unlink()
    replace(results / "configuration.json", '"seconds": 5', '"seconds": 20')
    assert found(results, expected) == dict.fromkeys(names, "is missing")
    replace(results / "configuration.json", "small", "large")
    sentence = found(results, expected)["configuration.json"]
    assert sentence == "scenes 0 name is 'large', expected 'small'"


def test_nothing_expected_is_no_pass(results, tmp_path):
    Checkout(tmp_path / "empty").edit("configuration.json", "{}")
    with pytest.raises(ValueError, match="holds no expected results"):
        verify.differences(results, tmp_path / "empty")


def test_the_expected_results_are_those_of_the_default_configuration():
    default = read(REPOSITORY / "config" / "config.yaml")
    kept = json.loads((EXPECTED / "configuration.json").read_text())
    assert all(kept[key] == default[key] for key in ("seed", "scenes"))
    assert max(file.stat().st_size for file in EXPECTED.rglob("*.*")) < 1_000_000
    for scene in load(default).scenes:
        for stage, keys in scene.keys.items():
            points = EXPECTED / scene.name / "points" / f"{stage}.json"
            assert [*(json.loads(points.read_text()) if points.exists() else {})] == [*keys]
