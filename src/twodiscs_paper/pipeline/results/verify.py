"""Compare results with the expected results that are committed in ``paper/expected``.

Counts depend only on + − × / and √, so integers and texts must be the same on every processor.
Floats also depend on math libraries, whose last digits differ: they are compared to
``FLOAT_ERROR``.
"""

import json
import operator
from pathlib import Path

import numpy as np
import pandas as pd

from twodiscs.dynamics.stages import STAGES
from twodiscs.points.base import DIGEST_KEY, SECONDS_KEY, read_json, require_logged
from twodiscs_paper.configuration import yaml_files
from twodiscs_paper.pipeline.points import read_point

#: The largest difference of floats, relative to their size.
FLOAT_ERROR = 1e-12

#: The largest absolute difference in columns that lose digits. A score is a difference of two
#: numbers over its standard error, which is 1e-4 of them at best; a bias is a difference of areas.
COLUMN_ERRORS = dict.fromkeys(("z", "monte_carlo_z", "p", "chi2"), 1e-8) | {"bias": FLOAT_ERROR}

#: The exact theory of discs that hardly fit is the more sensitive to the rounding of the radius the
#: closer they are to the largest radius. Its last digits then differ by this over the distance.
ROUNDING = np.finfo(float).eps

#: The tables in which ``estimate`` may be the mean or the spread of scores.
TABLES_OF_SCORES = ("check", "agreement")

#: A trajectory is compared at every 64th row: it is chaotic, so a difference grows until then.
STRIDE = 64


def read(path):
    """Return the table of a CSV file; integers stay integers beside empty cells."""
    return pd.read_csv(path, dtype_backend="numpy_nullable")


def compared_rows(name, table):
    """Return the rows of the table ``name`` that are compared: all, except in two long tables."""
    if name == "hop_histogram":  # the points have the counts of all bins
        return table[table["left"] == 0]
    if name == "trajectory":
        return table[(table.index % STRIDE == 0) | (table.index == len(table) - 1)]
    return table


def same(name, column, observed, expected):
    """Return for each row whether a column of the table ``name`` is as expected."""
    if not all(pd.api.types.is_float_dtype(values) for values in (observed, expected)):
        texts = (values.astype("string").fillna("") for values in (observed, expected))
        return operator.eq(*texts)
    tolerance = COLUMN_ERRORS.get(column, 0.0)
    if name in TABLES_OF_SCORES and column == "estimate":
        tolerance = COLUMN_ERRORS["z"]
    pair = (values.to_numpy(float, na_value=np.nan) for values in (observed, expected))
    return np.isclose(*pair, rtol=max(FLOAT_ERROR, tolerance), atol=tolerance, equal_nan=True)


def well_conditioned(observed, expected):
    """Return whether exact values of extremes agree as far as the distance in their row allows."""
    names = ["exact", "distance"]
    (a, _), (b, distance) = (
        t[names].to_numpy(float, na_value=np.nan).T for t in (observed, expected)
    )
    close = np.abs(a - b) * np.abs(distance) <= ROUNDING * np.abs(b)  # False beside an empty cell
    return (expected["part"] == "extremes").to_numpy(bool) & close


def table_difference(name, observed, expected):
    """Return a sentence on the first row in which the table ``name`` is not as expected, or ""."""
    if list(observed) != list(expected):
        return f"the columns are {list(observed)}, expected {list(expected)}"
    if len(observed) != len(expected):
        return f"{len(observed)} rows, expected {len(expected)}"
    equal = pd.DataFrame({c: same(name, c, observed[c], expected[c]) for c in expected})
    if name == "stability":  # the values of these parts are rounding errors
        equal["value"] |= expected["part"].isin(["theory", "times"])
        equal["exact"] |= well_conditioned(observed, expected)
    wrong = np.flatnonzero(~equal.all(axis="columns"))
    if not wrong.size:
        return ""
    row = wrong[0]
    column = equal.columns[~equal.iloc[row]][0]
    values = f"{observed[column][row]}, expected {expected[column][row]}"
    return f"{column} in row {row + 1} is {values}; {wrong.size} rows differ"


def flat(value, name=""):
    """Return {name: value} of all plain values in nested dicts and lists; names are joined."""
    if isinstance(value, dict | list):
        items = value.items() if isinstance(value, dict) else enumerate(value)
        return {n: v for key, one in items for n, v in flat(one, f"{name} {key}").items()}
    return {name.strip(): value}


def json_difference(observed, expected):
    """Return a sentence on the first value of a JSON file that is not as expected, or ""."""
    found, asked = flat(observed), flat(expected)
    for name in asked | found:
        a, b = found.get(name), asked.get(name)
        floats = isinstance(a, float)
        if type(a) is not type(b) or not (np.isclose(a, b, FLOAT_ERROR, 0) if floats else a == b):
            return f"{name} is {a!r}, expected {b!r}"
    return ""


def settings(path):
    """Return the keys of a configuration's file that decide about the compared results."""
    configuration = json.loads(path.read_text("utf-8"))
    return {key: configuration.get(key) for key in ("seed", "scenes")}


def differences(results, expected):
    """Return {file: sentence} for all expected files; the sentence is "" without a difference.

    ``results`` and ``expected`` are folders. In ``expected``, ``S/points/<stage>.json`` holds the
    points of a scene S by radius. Raises ``ValueError`` if no file is expected.
    """
    name = Path("configuration.json")
    found = {name: json_difference(*(settings(folder / name) for folder in (results, expected)))}
    for path in sorted(expected.rglob("*.csv")):
        name = path.relative_to(expected)
        found[name] = "is missing"
        if (results / name).exists():
            table = compared_rows(path.stem, read(results / name))
            found[name] = table_difference(path.stem, table.reset_index(drop=True), read(path))
    for path in sorted(expected.rglob("points/*.json")):
        for key, point in json.loads(path.read_text("utf-8")).items():
            name = path.relative_to(expected).with_suffix("") / f"{key}.json"
            found[name] = "is missing"
            if (results / name).exists():
                observed = json.loads((results / name).read_text("utf-8"))
                kept = {n: value for n, value in observed.items() if n in point}
                found[name] = json_difference(kept, point)
    if len(found) == 1:
        raise ValueError(f"{expected} holds no expected results")
    return found


def long_run_tables(folder):
    """Yield (path, table, rows) of the long runs in a ``folder`` whose counts are kept."""
    from twodiscs.analysis.tables import MeanTimesTable
    from twodiscs_paper.studies.more_discs import tori
    from twodiscs_paper.studies.more_discs.study import ToriTable
    from twodiscs_paper.studies.passages import brownian
    from twodiscs_paper.studies.passages.parts import long_files, long_run
    from twodiscs_paper.studies.passages.study import BrownianTable, PassagesTable

    far = yaml_files.load(yaml_files.read(folder / "far/config.yaml")).scenes[0]
    job = STAGES["dynamics"], far.box.scene(far.radii[0]), far.arguments("dynamics")
    point = read_point(folder / "far/dynamics.json", *job)
    yield folder / "far/mean_times.csv", MeanTimesTable, MeanTimesTable.rows([point])
    given = yaml_files.read(folder / "passages/config.yaml")
    given = given["thresholds"], given["limit"]
    rows = long_run.long_run_rows(*given, read_json(folder / "passages/clusters.json"))
    yield folder / "passages/passages.csv", PassagesTable, rows
    given = yaml_files.read(folder / "files/config.yaml")
    counts = zip(given["files"], read_json(folder / "files/counts.json")["files"], strict=True)
    rows = (row for one, count in counts for row in long_files.file_rows(one, given, count))
    yield folder / "files/passages.csv", PassagesTable, rows
    rows = brownian.rows(read_json(folder / "brownian/counts.json"))
    yield folder / "brownian/brownian.csv", BrownianTable, rows
    rows = tori.rows(read_json(folder / "tori/counts.json")["counts"])
    yield folder / "tori/tori.csv", ToriTable, rows


def renew(results, expected, tables, points):
    """Replace the folder ``expected`` by results: the files of ``tables`` and of ``points``.

    Digests, processor times and versions of points are left out. Tables of long runs beside the
    folder are made again from their counts.
    """
    by_stage = {}
    for path in map(Path, points):
        point = json.loads(path.read_text("utf-8"))
        kept = {
            n: value for n, value in point.items() if n not in (DIGEST_KEY, SECONDS_KEY, "twodiscs")
        }
        line = f'"{path.stem}": {json.dumps(kept, sort_keys=True)}'
        by_stage.setdefault(path.parent.relative_to(results), []).append(line)
    texts = {f"{stage}.json": "{\n" + ",\n".join(p) + "\n}\n" for stage, p in by_stage.items()}
    for path in map(Path, tables):
        require_logged(path)
        header, *lines = path.read_text("utf-8").splitlines(keepends=True)
        rows = [lines[i] for i in compared_rows(path.stem, read(path)).index]
        texts[path.relative_to(results)] = "".join((header, *rows))
    texts["configuration.json"] = (results / "configuration.json").read_text("utf-8")
    for old in (*expected.rglob("*.csv"), *expected.rglob("*.json")):
        old.unlink()
    for name, text in texts.items():
        (expected / name).parent.mkdir(parents=True, exist_ok=True)
        (expected / name).write_text(text, "utf-8", newline="\n")
    if (kept := expected.parent / "long_run").is_dir():
        for path, table, rows in long_run_tables(kept):
            table.write(path, rows)
