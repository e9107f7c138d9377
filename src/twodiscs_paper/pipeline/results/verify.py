"""Compare the results of this machine with the committed ones: counts and tables, point by point.

Counts by Monte Carlo and dynamics depend only on + − × / and √: their integers must be the same on
every processor. Exact values, scores and all that follows from them use math libraries, whose last
digits differ between processors: these floats must agree to ``RELATIVE``.

The folder of expected results mirrors the folder of results. ``S/points/<method>.json`` holds the
points of a scene S, one line per radius, and ``S/<table>.csv`` a table. Nothing is built here.
"""

import json
import math
import sys
from collections import Counter
from pathlib import Path
from typing import NamedTuple

from twodiscs.arguments import Parser, parameters, run
from twodiscs.model.checks import InputError
from twodiscs.points.digests import digest
from twodiscs_paper.catalogue import TABLES
from twodiscs_paper.configuration.load import load
from twodiscs_paper.configuration.request import STAGES
from twodiscs_paper.pipeline.jobs.table import POINTS

#: The largest difference of floats, relative to their size.
RELATIVE = 1e-12

#: The largest difference of scores. A score is a difference of two numbers over its standard error,
#: which is 1e-4 of the numbers at best. At that error this is as strict as ``RELATIVE``. For χ², a
#: sum of squares of scores, it is relative from 1 on.
SCORE = RELATIVE / 1e-4

#: The columns whose text identifies a row; all other columns hold results.
NAMING = ("comparison", "part", "quantity", "event", "bins", "method", "case", "label", "place")

#: The rows of check.csv and of agreement.csv whose estimates are made of scores.
OF_SCORES = {"z_mean", "z_spread", "mean_square", "correlation", "effects"}

#: The parts of stability.csv whose values are rounding errors; there only verdicts are compared.
OF_ROUNDINGS = ("theory", "times")

#: A trajectory is compared at every 64th row: no difference stays small until the next one.
STRIDE = 64


class Cell(NamedTuple):
    """A value, and the largest difference of a number from it."""

    value: object
    tolerance: float


# Sheets: {place: {name: Cell}}, the place being "radius …" or "" ----------------------------------


def point_cells(point):
    """Return {name: Cell} of all values of a point, at any depth; integers must be equal."""
    cells = {}
    for name, value in point.items():
        if isinstance(value, list):
            value = {str(i): item for i, item in enumerate(value)}
        if isinstance(value, dict):
            cells |= {f"{name} {below}": cell for below, cell in point_cells(value).items()}
        else:
            cells[name] = Cell(value, RELATIVE * abs(value) if isinstance(value, float) else 0.0)
    return cells


def thinned(table, rows):
    """Return the rows of a ``table`` that are compared: all rows, except for two long tables.

    For a histogram it is the first bin, because the points have the counts of all bins. For a
    trajectory it is the first row, the last row, and every ``STRIDE``-th row.
    """
    if table == "hop_histogram":
        return [row for row in rows if row["left"] == 0]
    if table == "trajectory":
        return [row for i, row in enumerate(rows) if i % STRIDE == 0 or i == len(rows) - 1]
    return rows


def _tolerance(column, row):
    """Return the tolerance of a cell of a table."""
    if not isinstance(row[column], float):
        return 0.0
    if column == "value" and row.get("part") in OF_ROUNDINGS:
        return math.inf
    if column in ("z", "monte_carlo_z", "p"):
        return SCORE
    if column == "estimate" and OF_SCORES & {row.get("comparison"), row.get("quantity")}:
        return SCORE
    if column == "chi2":
        return SCORE * max(1.0, row[column])
    if column == "bias" and "expectation" in row:  # the expectation minus the exact value
        return RELATIVE * abs(row["expectation"])
    return RELATIVE * abs(row[column])


def table_cells(table, rows):
    """Return {place: {name: Cell}} of the ``rows`` of a ``table``; a name has row and column."""
    naming = () if table == "trajectory" else NAMING  # there events are results
    sheet, numbers = {}, Counter()
    for row in rows:
        radius = row.get("radius")
        part = "" if radius is None else f"radius {radius!r}"
        words = [row[column] for column in naming if row.get(column)]
        numbers[part, *words] += 1
        if not words or numbers[part, *words] > 1:
            words.append(f"row {numbers[part, *words]}")
        cells = sheet.setdefault(part, {})
        for column, value in row.items():
            if column != "radius" and column not in naming:
                name = " ".join((*words, column))
                cells[name] = Cell(value, _tolerance(column, row))
    return sheet


def _points_sheet(points):
    return {f"radius {key}": point_cells(point) for key, point in points.items()}


def read_points(folder):
    """Return {key: dict of a point} of the files in a ``folder`` of a stage, by radius.

    Raises ``InputError`` for a file without a point of this stage.
    """
    try:
        paths = sorted(Path(folder).glob("*.json"), key=lambda path: float(path.stem))
    except ValueError as error:
        raise InputError(f"{folder} must hold points alone: {error}") from None
    return {path.stem: POINTS[path.parent.name].read(path).content() for path in paths}


# Comparison -----------------------------------------------------------------------------------


def _same(observed, expected):
    if observed.value == expected.value:
        return True
    numbers = isinstance(observed.value, float) and isinstance(expected.value, float)
    return numbers and abs(observed.value - expected.value) <= expected.tolerance


def _difference(name, observed, expected):
    """Return a sentence on the difference of one cell, None without a difference."""
    if observed is None:
        return f"{name} is missing"
    if expected is None:
        return f"{name} is not expected"
    if _same(observed, expected):
        return None
    return f"{name} is {observed.value!r}, expected {expected.value!r}"


def compare(where, observed, expected):
    """Return a sentence for each place at which the sheet ``observed`` differs from ``expected``.

    ``where`` is the name of the sheet. A sentence names the first difference and the number of
    further ones. Missing and additional places and cells are differences.
    """
    sentences = []
    for part in {**expected, **observed}:
        here = f"{where}, {part}" if part else where
        if part not in observed:
            sentences.append(f"{here}: missing")
        elif part not in expected:
            sentences.append(f"{here}: not expected")
        else:
            names = {**expected[part], **observed[part]}
            found = (_difference(n, observed[part].get(n), expected[part].get(n)) for n in names)
            found = list(filter(None, found))
            if found:
                more = f", and {len(found) - 1} more" if len(found) > 1 else ""
                sentences.append(f"{here}: {found[0]}{more}")
    return sentences


def other_configuration(observed, expected):
    """Return how the mapping ``observed`` differs from ``expected``, "" if it does not.

    Both are configurations as ``load`` takes them, compared after all defaults are filled in. Only
    keys that change the compared results count.
    """
    here, there = load(observed), load(expected)
    for name in ("results", "seed"):
        if getattr(here, name) != getattr(there, name):
            return f"{name} is {getattr(here, name)!r}, not {getattr(there, name)!r}"
    names = [[scene.name for scene in c.scenes] for c in (here, there)]
    if names[0] != names[1]:
        return f"the scenes are {', '.join(names[0])}, not {', '.join(names[1])}"
    other = [a.name for a, b in zip(here.scenes, there.scenes, strict=True) if a != b]
    return f"the scene {other[0]} differs" if other else ""


def verify(results, expected):
    """Compare the folder ``results`` with the folder ``expected``.

    Returns (sentences, Counter of compared points, integers, tables and floats). Raises
    ``InputError`` if a folder holds nothing to compare, or if a file is not what its name says.
    """
    results, expected = Path(results), Path(expected)
    paths = sorted(p for p in expected.rglob("*.*") if p.suffix in (".csv", ".json"))
    names = [p.relative_to(expected) for p in paths if p.name != "configuration.json"]
    if not names:
        raise InputError(f"{expected} must hold expected results, but holds no table or point")
    sentences, compared = [], Counter()
    for name in names:
        here, there = results / name, expected / name
        if name.suffix == ".json":
            sheet = _points_sheet(json.loads(there.read_text(encoding="utf-8")))
            name, here = name.with_suffix(""), here.with_suffix("")
            compared["points"] += len(sheet)
        else:
            table = name.stem
            sheet = table_cells(table, TABLES[table].read(there))
            compared["tables"] += 1
        cells = [cell.value for part in sheet.values() for cell in part.values()]
        compared["integers"] += sum(type(value) is int for value in cells)
        compared["floats"] += sum(type(value) is float for value in cells)
        if not here.exists():
            sentences.append(f"{name}: missing")
            continue
        if here.is_dir():
            observed = _points_sheet(read_points(here))
        else:
            observed = table_cells(table, thinned(table, TABLES[table].read(here)))
        sentences += compare(name, observed, sheet)
    return sentences, compared


def write(results, expected, configuration):
    """Replace the folder ``expected`` by these ``results`` of a ``configuration``, a mapping.

    It takes all points of the configuration and the tables of ``manifest.sha256``. Raises
    ``InputError`` if a table has changed since the manifest was written, ``OSError`` for a missing
    file.
    """
    results, expected = Path(results), Path(expected)
    rows, points = {}, {}
    for line in (results / "manifest.sha256").read_text(encoding="utf-8").splitlines():
        known, name = line.split(maxsplit=1)
        path = results / name
        if digest(path) != known:
            raise InputError(f"{path} must be as in manifest.sha256, but has changed since")
        if path.suffix == ".csv":
            rows[name] = thinned(path.stem, TABLES[path.stem].read(path))
    for scene in load(configuration).scenes:
        for method in STAGES:
            folder = results / scene.name / "points" / method
            if keys := scene.keys[method]:
                observed = read_points(folder)
                missing = [key for key in keys if key not in observed]
                if missing:
                    raise InputError(f"{folder} must have a point at {missing[0]}, but has none")
                points[f"{scene.name}/points/{method}.json"] = {key: observed[key] for key in keys}

    for old in (*expected.rglob("*.csv"), *expected.rglob("*.json")):
        old.unlink()
    for name in (*rows, *points):
        (expected / name).parent.mkdir(parents=True, exist_ok=True)
    for name, content in rows.items():
        TABLES[Path(name).stem].write(expected / name, content)
    for name, content in points.items():
        lines = (f'"{key}": {json.dumps(p, sort_keys=True)}' for key, p in content.items())
        _write_text(expected / name, "{\n" + ",\n".join(lines) + "\n}\n")
    text = json.dumps(configuration, indent=1, sort_keys=True)
    _write_text(expected / "configuration.json", text + "\n")


def _write_text(path, text):
    path.write_text(text, encoding="utf-8", newline="\n")


def main():
    parser = Parser(
        prog=__spec__.name,
        description="Compare results with the expected.",
    )
    parser.add_argument("--expected", type=Path, default=Path("paper/expected"), metavar="FOLDER")
    parser.add_argument(
        "--configuration",
        type=Path,
        default=Path("results/configuration.json"),
        help="the file in the folder of results",
    )
    parser.add_argument("--write", action="store_true", help="renew the expected results instead")
    options = parser.parse_args()

    results, expected = options.configuration.parent, options.expected
    if not any(path.is_dir() for path in results.glob("*/points")):
        raise InputError(f"{results} holds no results to verify: they are built by make")
    configuration = parameters(f"@{options.configuration}")
    if options.write:
        write(results, expected, configuration)
        print(f"{expected} now holds the results of {results}")
        return 0

    if not (expected / "configuration.json").exists():
        raise InputError(f"{expected} holds no results to compare with: --write puts them there")
    other = other_configuration(configuration, parameters(f"@{expected / 'configuration.json'}"))
    if other:
        raise InputError(
            f"{expected} holds the results of the default configuration, which differs from this "
            f"one: {other}"
        )
    differences, compared = verify(results, expected)
    print(
        f"compared {compared['points']} points and {compared['tables']} tables: "
        f"{compared['integers']} integers, and {compared['floats']} floats to {RELATIVE:g}"
    )
    if differences:
        print(*differences, f"differences: {len(differences)}", sep="\n", file=sys.stderr)
        return 1
    print("no differences")
    return 0


if __name__ == "__main__":
    run(main)
