"""The numbers of manuscript and pages, against a second reading of the tables.

Without these tests numbers in paper and pages could differ from the tables, or be misrounded.
"""

import json
import re
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_UP, Context, Decimal

import numpy as np
import pandas as pd
import pytest
import typst
from checkout import copy_tables
from factory import EXPECTED, LONG_RUNS, of

from twodiscs.analysis.tables import SCENE_TABLES, MeanTimesTable
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.dynamics.stages import STAGES
from twodiscs.points.base import reached
from twodiscs_paper.catalogue import read_table
from twodiscs_paper.configuration.yaml_files import load, read
from twodiscs_paper.pipeline.documents.manuscript import CONSTANTS
from twodiscs_paper.pipeline.points import read_point, read_shards

PAPER = EXPECTED.parent
SOURCE = (PAPER / "paper.typ").read_text()
SCENES = [
    {"name": name, "width": width, "height": 1.0, "tables": list(SCENE_TABLES)}
    for name, width in (("paper", 1.5), ("long", 3.0))
]


def queried(path, label, **contents):
    """Return the value at the ``label`` of the Typst file at ``path``, which reads ``contents``."""
    given = {"sys_inputs": {"contents": json.dumps(contents)}, "ignore_system_fonts": True}
    return json.loads(typst.query(path, f"<{label}>", field="value", one=True, root="/", **given))


def evaluated(folder, *expressions, **contents):
    """Return the values of Typst ``expressions`` with the functions of read.typ."""
    path = folder / "expressions.typ"
    lines = [f'#import "{PAPER}/read.typ": *', "#metadata((", *(f"{e}," for e in expressions)]
    path.write_text("\n".join([*lines, ")) <values>"]), encoding="utf-8")
    return queried(path, "values", **{"results": str(folder), "scenes": [{}]} | contents)


# Rounding -----------------------------------------------------------------------------------------


def significant(x, n, rounding=ROUND_HALF_UP):
    """Return ``x`` to ``n`` digits as a formula, by ``decimal``."""
    d = Context(prec=n, rounding=rounding).create_decimal(f"{x:.12g}").normalize()
    power = d.adjusted()
    if not d or -2 <= power <= 3:
        return f"${d:f}$"
    mantissa = d.scaleb(-power)
    return f"$10^({power})$" if mantissa == 1 else f"${mantissa:f} times 10^({power})$"


def with_error(value, error):
    """Return 0.813 (2) or 0.81 (12), by ``decimal``."""
    value, error = Decimal(repr(value)), Decimal(repr(error))
    places = -error.adjusted()
    places = max(0, places + (error.scaleb(places) < Decimal("1.95")))
    shown = value.quantize(Decimal(1).scaleb(-places), ROUND_HALF_UP)
    return f"${shown:f} ({error.scaleb(places).quantize(Decimal(1), ROUND_HALF_UP):f})$"


def test_thousands_of_numbers_are_formatted_as_by_decimal(tmp_path):
    rng = np.random.default_rng(1)
    drawn = rng.lognormal(0, 15, 1000) * rng.choice([-1, 1], 1000)
    # Also ties, floats that are no decimals, and numbers that round to a power of ten.
    others = 0.1 + 0.2, 3.000000000004, 9.9951, 0.0099996, 1e22
    numbers = [*drawn, *(k / 40 for k in range(-100, 400)), *others]
    cases = [(float(x), 1 + i % 6) for i, x in enumerate(numbers)]
    errors = [(x, float(abs(x) * 10 ** rng.uniform(-6, 2))) for x, _ in cases if x]
    *found, measured = evaluated(
        tmp_path,
        "contents.cases.map(((x, n)) => digits(x, n).text)",
        "contents.cases.map(((x, n)) => up(x, n).text)",
        "contents.cases.map(((x, n)) => down(x, n).text)",
        "contents.errors.map(((x, error)) => with-error(x, error).text)",
        cases=cases,
        errors=errors,
    )
    for texts, rounding in zip(found, (ROUND_HALF_UP, ROUND_CEILING, ROUND_FLOOR), strict=True):
        assert texts == [significant(x, n, rounding) for x, n in cases]
    assert measured == [with_error(x, error) for x, error in errors]


# Rows ---------------------------------------------------------------------------------------------

TAILS = """\
event,time,estimate,stderr,law
hop,2.0,-6.0,0.25,3.0
hop,4.0,5.0,0.5,
wall,2.0,8.0,1.0,2.0
wall,1.0,,,
"""


@pytest.fixture
def rows(tmp_path):
    """Return a function: the texts of Typst expressions about the rows of a small table."""
    (tmp_path / "tails.csv").write_text(TAILS)

    def texts(*expressions):
        given = '(rows => ({}))(of-study("tails"))'
        found = evaluated(tmp_path, *(given.format(expression) for expression in expressions))
        return [number and number["text"] for number in found]

    return texts


def test_a_number_takes_its_rows_and_is_written_as_by_physicists(rows):
    cases = {
        'value(of(rows, event: "wall"), "estimate", 2)': "$8$",  # an empty cell is no row
        'value(of(rows, law: none, estimate: given), "estimate", 2)': "$5$",
        'value(of(rows, event: other-than("hop")), "estimate", 2)': "$8$",
        "count(of(rows, time: 2))": "2",
        "count(of(rows, time: 3))": None,
        'total(rows, "estimate")': "$7$",
        'at-most(rows, "estimate")': "$8$",
        'at-least(rows, "estimate")': "$5$",
        'at-least(rows, "estimate", n: 3, scale: 100)': "$500$",
        'at-most(rows, "stderr", n: 1, scale: 0.31)': "$0.4$",
        'span(rows, "estimate")': "$-6$ to $8$",
        'value(of(rows, event: "wall"), "estimate/law", 2)': "$4$",
        "estimate(first(rows))": "$-6.0 (3)$",
        'estimate(of(rows, event: "wall"), by: "*law")': "$16 (2)$",
        'estimate(of(rows, event: "hop"), columns: ("estimate", "law"))': "$-6 (3)$",
        'typed(last(of(rows, event: "hop")), "time")': "4.0",
        'whole(largest(of(rows, event: "hop"), "estimate"), "time")': "2",
        'value(smallest(of(rows, estimate: given), "time", "estimate"), "estimate", 1)': "$-6$",
        'value(largest(of(rows, event: "hop"), "time"), "law", 1)': None,
        'whole(largest(of(rows, time: 2), "time"), "law")': "3",  # the first of several
        'value(of(rows, event: "door"), "law", 1)': None,
        'power-of-two(first(rows), "stderr")': "$2^(-2)$",
        'shown(repr(grouped(rows, "event", "time").keys()))':
            '("hop_2.0", "hop_4.0", "wall_2.0", "wall_1.0")',
        "integer(43)": "43",
        "in-words(2)": "two",
        "sides(1.5, 1)": "$1.5 times 1$",
        'sides("3e-6", "1e-5")': "$(3 times 10^(-6)) times 10^(-5)$",
    }  # fmt: skip
    assert rows(*cases) == [*cases.values()]


@pytest.mark.parametrize(
    ("expression", "sentence"),
    [
        ('value(of(rows, event: "hop"), "estimate", 2)', "this must be one row, not"),
        ("estimate(rows)", "this must be one row, not"),
        ('count(of(rows, evnt: "hop"))', 'does not contain key "evnt"'),
        ('total(rows, "estimates")', 'does not contain key "estimates"'),
    ],
)
def test_two_rows_in_place_of_one_and_unknown_columns_stop_the_compiler(rows, expression, sentence):
    with pytest.raises(RuntimeError, match=sentence):
        rows(expression)


# The numbers of the manuscript --------------------------------------------------------------------


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Return a folder with the tables of the default configuration; those with times are empty."""
    folder = tmp_path_factory.mktemp("results")
    copy_tables(folder, {scene["name"]: scene["name"] for scene in SCENES})
    return folder


@pytest.fixture(scope="module")
def printed(results):
    """Return {name: {"value", "text"} or None} of all numbers and cells."""
    contents = {"results": str(results), "constants": CONSTANTS | {"seed": 1908}}
    return queried(PAPER / "numbers.typ", "numbers", **contents, scenes=SCENES)


def test_every_number_of_the_prose_is_declared_and_every_declared_one_is_used(printed):
    used = {*re.findall(r'(?:number|has)\("(\w+)"\)', SOURCE)}
    used |= {*re.findall(r"\bours: (\w+)", (PAPER / "published.yaml").read_text())}
    assert {name for name in printed if "/" not in name} == used
    tables = {name.split("/")[0] for name in printed if "/" in name}
    assert tables == {*re.findall(r'cells\("(\w+)"\)', SOURCE)}


def test_every_number_and_column_of_cells_has_rows_in_the_expected_tables(printed):
    """Except those of tables with seconds in them, which are not kept."""
    assert {name for name, number in printed.items() if number is None} == {"configurations"}
    cells = [(*name.split("/"), cell["text"]) for name, cell in printed.items() if "/" in name]
    columns = {(table, column) for table, _, column, _ in cells}
    filled = {(table, column) for table, _, column, text in cells if text not in ("", "--")}
    assert columns - filled == {("agreement", "events")}  # of a table with times
    assert printed["agreement/paper/failed"]["text"] == "0"
    assert printed["errata/01/number"]["text"] == ""


@pytest.fixture(scope="module")
def expected(results):
    """Return {name: frame} of some of the same tables and of long runs."""
    paths = {name: [results / f"{name}.csv"] for name in ("tails", "more_discs")}
    paths["check"] = [results / scene["name"] / "check.csv" for scene in SCENES]
    paths["calibration"] = [LONG_RUNS / "calibration" / "calibration.csv"]
    paths["long_displacements"] = [LONG_RUNS / "displacements" / "passages.csv"]
    paths["long_run"] = [LONG_RUNS / "far" / "mean_times.csv"]
    return {
        name: pd.DataFrame([row for path in some for row in read_table(path)])
        for name, some in paths.items()
    }


def reach(tables):
    """Return the last time over the one at which 2Dt of hops, with friction, is as large as F√t."""
    rows = tables["long_displacements"].query("distance == 2**-5 and friction.notna()")
    first = rows.groupby("quantity").first().estimate
    time = rows.query("quantity == 'displacement'").time.max()
    return (first.diffusion * first.rate * time / (first.single_file * np.sqrt(time))) ** 2


SINGLE = "quantity == 'single_file'"

#: Numbers by a second method, from {name: frame}.
BY_HAND = {
    "tests": lambda t: t["check"].query("independent").passed.count(),
    "tests_largest": lambda t: t["check"].query("independent").z.abs().max(),
    "tail_hops_probability": lambda t: (
        t["tails"].query("event == 'vertical_hop' and method == 'weighted'").estimate.iloc[-1]
    ),
    "long_files_law_error": lambda t: (
        t["long_displacements"].query(SINGLE).eval("100 * stderr / estimate").max()
    ),
    "long_files_last_reach": reach,
    "more_discs_exact": lambda t: len(
        t["more_discs"].query("periodic != 'xy' and event != 'virial'")[["exact", "z"]].dropna()
    ),
    "calibrated_square": lambda t: (
        t["calibration"].query("size == 'usual' and test == 'normal'").mean_square.mean()
    ),
    "long_run_events": lambda t: (
        t["long_run"].query("event in ('any_wall', 'disc_collision')")["count"].sum()
    ),
}


@pytest.mark.parametrize("name", BY_HAND)
def test_numbers_are_those_of_a_second_method(printed, expected, name):
    assert printed[name]["value"] == pytest.approx(BY_HAND[name](expected), rel=1e-9)


# Long runs ----------------------------------------------------------------------------------------


def test_the_long_run_is_what_its_shards_counted_and_agrees():
    folder = LONG_RUNS / "far"
    request = load(read(folder / "config.yaml")).scenes[0]
    job = STAGES["dynamics"], request.box.scene(request.radii[0])
    point = read_point(folder / "dynamics.json", *job, request.arguments("dynamics"))
    # Six scores: a false alarm in 3e5 seeds.
    assert all(abs(row["z"]) < 5 for row in MeanTimesTable.rows([point]))
    ranges = read_shards(folder.glob("shards/*.json"), *job, request.shard_arguments("dynamics"))
    (counts, _), blocks = reached(ranges["all"], point.replicas // REPLICAS)
    assert blocks * REPLICAS == point.replicas
    assert counts.tolist() == [point.counts[event] for event in request.quantities.mean_times]


def test_the_page_on_passages_has_the_numbers_of_the_build_and_of_the_long_run():
    """Every value with an error is that of a row, rounded as in the manuscript."""
    paths = EXPECTED / "passages.csv", *LONG_RUNS.glob("*/passages.csv")
    rows = [row for path in paths for row in read_table(path)]
    rows = [row for row in rows if row["stderr"]]
    printed = [with_error(row["estimate"], row["stderr"]) for row in rows]
    rows_of_steps = read_table(LONG_RUNS / "brownian" / "brownian.csv")
    printed += [with_error(r["estimate"], r["stderr"]) for r in rows_of_steps]
    for row in of(rows, quantity="rate", periodic="x"):  # in files per h/v_th, h = 1
        unit = (2 * row["discs"] - 1) ** 0.5
        printed.append(with_error(unit * row["estimate"], unit * row["stderr"]))
    known = {re.sub("[$ -]", "", text) for text in printed}
    page = (PAPER.parent / "docs" / "passages.md").read_text()
    found = {*re.findall(r"\d+\.\d+\(\d+\)", page)}
    assert len(found) > 50
    assert found <= known
