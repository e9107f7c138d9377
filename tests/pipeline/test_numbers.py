"""The numbers of manuscript and pages, against a second reading of the tables.

Without these tests numbers in paper and pages could differ from the tables, or be misrounded.
"""

import json
import re
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_UP, Context, Decimal
from pathlib import Path

import numpy as np
import pytest
import typst
from factory import of

from twodiscs.analysis.tables import SCENE_TABLES, MeanTimesTable
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.dynamics.stages import STAGES
from twodiscs.model.events import EVENTS
from twodiscs.points.base import reached
from twodiscs_paper.catalogue import STUDY_TABLES, TABLES
from twodiscs_paper.configuration.yaml_files import load, read
from twodiscs_paper.pipeline.documents.manuscript import CONSTANTS
from twodiscs_paper.pipeline.points import read_point, read_shards

PAPER = Path(__file__).resolve().parents[2] / "paper"
SOURCE = (PAPER / "paper.typ").read_text()
SCENES = [
    {"name": name, "width": width, "height": 1.0, "tables": list(SCENE_TABLES)}
    for name, width in (("paper", 1.5), ("long", 3.0))
]

#: The numbers of tables with seconds in them, which are not kept.
TIMED_NUMBERS = {"configurations", "events", "evaluation_seconds"}


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


def test_numbers_are_written_as_physicists_do(tmp_path):
    cases = {
        "digits(44312345678, 2)": "$4.4 times 10^(10)$",
        "with-error(-0.6098, 0.1141)": "$-0.61 (11)$",
        "integer(43)": "43",
        "in-words(2)": "two",
        "in-words(12)": "12",
        "sides(1.5, 1)": "$1.5 times 1$",
        'sides("3e-6", "1e-5")': "$(3 times 10^(-6)) times 10^(-5)$",
    }
    assert evaluated(tmp_path, *(f"{case}.text" for case in cases)) == [*cases.values()]


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


def test_a_number_takes_its_rows(rows):
    cases = {
        'value(of(rows, event: "wall"), "estimate", 2)': "$8$",  # an empty cell is no row
        'value(of(rows, event: "hop", law: given), "estimate", 2)': "$-6$",
        'value(of(rows, law: none, estimate: given), "estimate", 2)': "$5$",
        'value(of(rows, event: other-than("hop")), "estimate", 2)': "$8$",
        'count(of(rows, time: ("2.0", "4.0")))': "3",
        "count(of(rows, time: 2))": "2",
        "count(of(rows, time: 3))": None,
        'total(rows, "estimate")': "$7$",
        'at-most(rows, "estimate")': "$8$",
        'at-least(rows, "estimate")': "$5$",
        'at-least(rows, "estimate", n: 3, scale: 100)': "$500$",
        'at-most(rows, "stderr", n: 1, scale: 0.31)': "$0.4$",
        'at-least(rows, "stderr", n: 1)': "$0.2$",
        'span(rows, "estimate")': "$-6$ to $8$",
        'span(first(rows), "time")': "$2$",
        'value(of(rows, event: "wall"), "estimate/law", 2)': "$4$",
        'value(of(rows, event: "wall"), "estimate*law", 2)': "$16$",
        "estimate(first(rows))": "$-6.0 (3)$",
        'estimate(of(rows, event: "wall"), by: "*law")': "$16 (2)$",
        'estimate(of(rows, event: "hop"), columns: ("estimate", "law"))': "$-6 (3)$",
        'typed(last(of(rows, event: "hop")), "time")': "4.0",
        'whole(largest(of(rows, event: "hop"), "estimate"), "time")': "2",
        'value(smallest(of(rows, estimate: given), "time", "estimate"), "estimate", 1)': "$-6$",
        'value(largest(of(rows, event: "hop"), "time"), "law", 1)': None,
        'whole(largest(of(rows, time: 2), "time"), "law")': "3",  # the first of several
        'whole(largest(rows, "law"), "time")': "2",  # among rows that have one
        'value(of(rows, event: "door"), "law", 1)': None,
        'power-of-two(first(rows), "stderr")': "$2^(-2)$",
        'shown(repr(grouped(rows, "event", "time").keys()))':
            '("hop_2.0", "hop_4.0", "wall_2.0", "wall_1.0")',
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
def results(tmp_path_factory, tables_of):
    """Return a folder with the tables of the default configuration; those with times are empty."""
    folder = tmp_path_factory.mktemp("results")
    tables_of(folder, {scene["name"]: scene["name"] for scene in SCENES})
    return folder


@pytest.fixture(scope="module")
def printed(results):
    """Return {name: {"value", "text"} or None} of all numbers and cells."""
    constants = CONSTANTS | {"seed": 1908}
    contents = {"results": str(results), "scenes": SCENES, "constants": constants}
    return queried(PAPER / "numbers.typ", "numbers", **contents)


def test_every_number_of_the_prose_is_declared_and_every_declared_one_is_used(printed):
    used = {*re.findall(r'(?:number|has)\("(\w+)"\)', SOURCE)}
    used |= {*re.findall(r"\bours: (\w+)", (PAPER / "published.yaml").read_text())}
    assert {name for name in printed if "/" not in name} == used
    assert {name.split("/")[0] for name in printed if "/" in name} == {
        *re.findall(r'cells\("(\w+)"\)', SOURCE)
    }


def test_every_number_has_rows_in_the_expected_tables(printed):
    assert {name for name, number in printed.items() if number is None} == TIMED_NUMBERS


def test_every_column_of_cells_has_rows_in_the_expected_tables(printed):
    cells = [(*name.split("/"), cell["text"]) for name, cell in printed.items() if "/" in name]
    columns = {(table, column) for table, _, column, _ in cells}
    filled = {(table, column) for table, _, column, text in cells if text not in ("", "--")}
    assert columns - filled == {("agreement", "events")}  # of a table with times
    assert printed["agreement/paper/failed"]["text"] == "0"
    assert printed["errata/01/number"]["text"] == ""


@pytest.fixture(scope="module")
def expected(results):
    """Return {name: rows} of the same tables and of the long runs."""
    paths = {name: results / f"{name}.csv" for name in STUDY_TABLES}
    tables = {name: TABLES[name].read(path) for name, path in paths.items() if path.exists()}
    for name in SCENE_TABLES:
        paths = [results / scene["name"] / f"{name}.csv" for scene in SCENES]
        tables[name] = [row for path in paths for row in TABLES[name].read(path)]
    kept = PAPER / "long_run"
    for name in ("files", "displacements"):
        tables[name] = TABLES["passages"].read(kept / name / "passages.csv")
    tables["kept"] = TABLES["passages"].read(kept / "passages" / "passages.csv")
    path = kept / "calibration" / "calibration.csv"
    tables["calibration"] = TABLES["calibration"].read(path)
    return tables | {"long_run": MeanTimesTable.read(kept / "far" / "mean_times.csv")}


def scores(rows):
    """Return the sizes of the scores of ``rows``."""
    return [abs(row["z"]) for row in rows if row["z"] is not None]


def exponent(tables):
    """Return the slope of ln(1 − κ) against ln δ by the normal equations."""
    rows = of(tables["passages"], scene="paper", event="horizontal_hop", quantity="coefficient")
    rows = of(rows, moment_of_inertia=None, friction=None)[-5:]
    columns = [[row[name] for row in rows] for name in ("distance", "estimate", "stderr")]
    x, kappa, error = map(np.array, columns)
    return np.polyfit(np.log(x), np.log(1 - kappa), 1, w=(1 - kappa) / error)[0]


def reach(tables):
    """Return the last time over the one at which 2Dt of hops, with friction, is as large as F√t."""
    rows = of(tables["displacements"], distance=2.0**-5)
    rows = [row for row in rows if row["friction"] is not None]
    share, rate, single = (
        of(rows, quantity=name)[0]["estimate"] for name in ("diffusion", "rate", "single_file")
    )
    time = max(row["time"] for row in of(rows, quantity="displacement"))
    return (share * rate * time / (single * np.sqrt(time))) ** 2


#: Numbers by a second method, from {name: rows}.
BY_HAND = {
    "tests": lambda t: sum(bool(r["passed"] is not None and r["independent"]) for r in t["check"]),
    "tests_largest": lambda t: max(scores(of(t["check"], independent=True))),
    "mean_time_largest": lambda t: max(scores(of(t["check"], comparison="mean_time"))),
    "strips_longest": lambda t: max(r["estimate"] for r in of(t["mean_times"], starts="strip")),
    "hazards": lambda t: len(of(t["distributions"], scene="paper", quantity="rate")),
    "rates_nearest": lambda t: min(
        scores(of(t["distributions"], scene="paper", quantity="rate"))
    ),
    "decay_rate": lambda t: next(
        r["estimate"] * r["exact_mean"] for r in of(t["tails"], quantity="rate")
    ),
    "tail_hops_probability": lambda t: of(t["tails"], event="vertical_hop", method="weighted")[-1][
        "estimate"
    ],
    "reduced_largest": lambda t: max(
        scores(of(t["thresholds"], scene="paper", quantity="mean_time", form="reduced"))
    ),
    "never_met_rough": lambda t: max(
        r["estimate"] for r in of(t["effects"], quantity="never_met_share", duration=1e4)
        if r["estimate"] is not None
    ),
    "passages_exponent": exponent,
    "passages_last": lambda t: max(
        r["estimate"]
        for r in of(t["kept"], scene="h/4", quantity="coefficient")
        if r["distance"] >= 2.0**-14
    ),
    "passages_files_error": lambda t: max(
        r["stderr"] for n in (4, 8) for r in of(t["files"], quantity="diffusion", discs=n)
    ),
    "long_files_law_error": lambda t: 100 * max(
        r["stderr"] / r["estimate"] for r in of(t["displacements"], quantity="single_file")
    ),
    "long_files_last_reach": reach,
    "more_discs_exact": lambda t: sum(
        r["exact"] is not None and r["z"] is not None and r["event"] != "virial"
        for r in t["more_discs"]
    ),
    "longest_run": lambda t: max(r["count"] for r in of(t["stability"], part="dynamics")),
    "overlap": lambda t: -min(r["value"] for r in of(t["stability"], quantity="smallest_gap")),
    "calibrated_square": lambda t: np.mean([
        r["mean_square"] for r in of(t["calibration"], size="usual", test="normal")
    ]),
    "long_run_events": lambda t: sum(
        r["count"] for r in t["long_run"] if r["event"] in ("any_wall", "disc_collision")
    ),
    "long_run_rare": lambda t: max(r["exact"] for r in t["long_run"]),
}  # fmt: skip


@pytest.mark.parametrize("name", BY_HAND)
def test_numbers_are_those_of_a_second_method(printed, expected, name):
    assert printed[name]["value"] == pytest.approx(BY_HAND[name](expected), rel=1e-9)


# Long runs ----------------------------------------------------------------------------------------


def test_the_long_run_is_what_its_shards_counted_and_agrees():
    folder = PAPER / "long_run" / "far"
    request = load(read(folder / "config.yaml")).scenes[0]
    job = STAGES["dynamics"], request.box.scene(request.radii[0])
    point = read_point(folder / "dynamics.json", *job, request.arguments("dynamics"))
    made = MeanTimesTable.rows([point])
    kept = MeanTimesTable.read(folder / "mean_times.csv")
    assert [row["event"] for row in made] == [row["event"] for row in kept]
    for ours, theirs in zip(made, kept, strict=True):
        assert ours["count"] == theirs["count"]
        assert ours["estimate"] == pytest.approx(theirs["estimate"], rel=1e-12)
        assert abs(ours["z"]) < 5  # ten scores: a false alarm in 2e5 seeds
    settings = request.shard_arguments("dynamics")
    ranges = read_shards(folder.glob("shards/*.json"), *job, settings)
    (counts, _), blocks = reached(ranges["all"], point.replicas // REPLICAS)
    assert blocks * REPLICAS == point.replicas
    assert counts.tolist() == [point.counts[event] for event in EVENTS]


def test_the_page_on_passages_has_the_numbers_of_the_build_and_of_the_long_run():
    """Every value with an error is that of a row, rounded as in the manuscript."""
    paths = PAPER / "expected" / "passages.csv", *PAPER.glob("long_run/*/passages.csv")
    rows = [row for path in paths for row in TABLES["passages"].read(path)]
    rows = [row for row in rows if row["stderr"]]
    printed = [with_error(row["estimate"], row["stderr"]) for row in rows]
    rows_of_steps = TABLES["brownian"].read(PAPER / "long_run" / "brownian" / "brownian.csv")
    printed += [with_error(r["estimate"], r["stderr"]) for r in rows_of_steps]
    for row in of(rows, quantity="rate", periodic="x"):  # in files per h/v_th, h = 1
        unit = (2 * row["discs"] - 1) ** 0.5
        printed.append(with_error(unit * row["estimate"], unit * row["stderr"]))
    known = {re.sub("[$ -]", "", text) for text in printed}
    page = (PAPER.parent / "docs" / "passages.md").read_text()
    found = {*re.findall(r"\d+\.\d+\(\d+\)", page)}
    assert len(found) > 50
    assert found <= known
