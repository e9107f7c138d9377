"""The numbers of the manuscript: how they are rounded, and that they agree with the tables."""

import math
import re
from collections import Counter
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.comparison.tables.mean_times import MeanTimes
from twodiscs.comparison.tables.theory import Theory
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.model.checks import InputError
from twodiscs.model.events import EVENTS
from twodiscs.points.digests import read_json
from twodiscs.points.dynamics import DynamicsPoint
from twodiscs_paper.catalogue import TABLES
from twodiscs_paper.configuration.load import load, read
from twodiscs_paper.pipeline.documents import formats, numbers
from twodiscs_paper.pipeline.documents.formats import FIRST_HOP, MAIN, Cells, Number, Other
from twodiscs_paper.pipeline.documents.manuscript import CONSTANTS

PAPER = Path(__file__).resolve().parents[2] / "paper"
SOURCE = (PAPER / "paper.typ").read_text()
SCENES = [
    {"name": name, "width": width, "height": 1.0, "tables": list(SCENE_TABLES)}
    for name, width in (("paper", 1.5), ("long", 3.0))
]
GIVEN = {MAIN: "paper", FIRST_HOP: "horizontal_hop"}

#: The tables that no build makes.
LONG_RUNS = {
    "long_run": PAPER / "long_run" / "far" / "mean_times.csv",
    "long_passages": PAPER / "long_run" / "passages" / "passages.csv",
    "long_tails": PAPER / "long_run" / "tails" / "tails.csv",
}

#: Tables with seconds in them.
NOT_KEPT = ("cost", "accuracy_cost")

# Rounding -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("number", "shown"),
    [
        (formats.significant(0, 2), "$0$"),
        (formats.significant(3.14159, 3), "$3.14$"),
        (formats.significant(0.0999, 2), "$0.1$"),
        (formats.significant(-1234.0, 3), "$-1230$"),
        (formats.significant(9996.0, 3), "$10^(4)$"),
        (formats.significant(44312345678, 2), "$4.4 times 10^(10)$"),
        (formats.significant(1e-15, 2), "$10^(-15)$"),
        (formats.significant(0.03125, 3), "$0.0313$"),
        (formats.with_error(0.8134, 0.0021), "$0.813 (2)$"),
        (formats.with_error(-0.6098, 0.1141), "$-0.61 (11)$"),
        (formats.with_error(1.0, 0.03), "$1.00 (3)$"),
        (formats.with_error(0.9996, 0.00096), "$0.9996 (10)$"),
        (formats.with_error(0.03, 0.0098), "$0.030 (10)$"),
        (formats.with_error(120.0, 30.0), "$120 (30)$"),
        (formats.at_most([0.3, 3.013]), "$3.1$"),
        (formats.at_most([3.1, 0.0]), "$3.1$"),
        (formats.at_most([1.525e-15]), "$1.6 times 10^(-15)$"),
        (formats.at_most([9.96]), "$10$"),
        (formats.at_most([0.0926], 1), "$0.1$"),
        (formats.at_least([3.19, 9.98]), "$3.1$"),
        (formats.smallest(3, 100).write([0.39689, -0.5]), "$39.6$"),
        (formats.largest(3, 100).write([-0.28, 0.07]), "$28$"),
        (formats.decimals(1).write(1.96), "$2.0$"),
        (formats.span([0.5, 12345, 2.0]), "$0.5$ to $1.2 times 10^(4)$"),
        (formats.span([2.0, 2.0]), "$2$"),
        (formats.in_words(2), "two"),
        (formats.in_words(12), "12"),
        (formats.box_markup(1.5, 1.0), "$1.5 times 1$"),
        (formats.box_markup(3e-6, 1e-5), "$(3 times 10^(-6)) times 10^(-5)$"),
    ],
)
def test_numbers_are_written_as_physicists_do(number, shown):
    assert number.text == shown


def test_bounds_hold_and_are_tight():
    for x in np.random.default_rng(1).lognormal(0, 20, 1000):
        up, down = (float(f(x)) for f in (formats.rounded_up, formats.rounded_down))
        assert down * (1 - 1e-11) <= x <= up * (1 + 1e-11)
        assert up - down <= 0.1001 * down


# Arguments of a number ----------------------------------------------------------------------------

ROWS = {
    "tails": [
        {"event": "hop", "time": 2.0, "estimate": -6.0, "stderr": 0.25, "law": 3.0},
        {"event": "hop", "time": 4.0, "estimate": 5.0, "stderr": 0.5, "law": None},
        {"event": "wall", "time": 2.0, "estimate": 8.0, "stderr": 1.0, "law": 2.0},
        {"event": "wall", "time": 1.0, "estimate": None, "stderr": None, "law": None},
    ],
    "cost": [{"event": "wall", "seconds": 7.0}],
}
HOP, WALL = {"event": "hop"}, {"event": "wall"}
make = partial(Number, "n", "tails")
FIRST = make({"law": 3.0}, "time", formats.INTEGER)


@pytest.mark.parametrize(
    ("one", "text"),
    [
        (make(WALL, "estimate", formats.digits(2)), "$8$"),  # an empty cell is no row
        (make(HOP | {"law": ...}, "estimate", formats.digits(2)), "$-6$"),
        (make({"law": None}, "estimate", formats.digits(2)), "$5$"),
        (make({"event": Other("hop")}, "estimate", formats.digits(2)), "$8$"),
        (make({"event": Other(MAIN)}, "estimate", formats.largest()), "$8$"),
        (make({"event": MAIN, "law": ...}, "time", formats.INTEGER), "2"),  # MAIN is the hop here
        (make({"time": (2.0, 4.0)}, "estimate", formats.COUNTED), "3"),
        (make({}, "event", formats.DISTINCT_IN_WORDS), "two"),
        (make({}, "estimate", formats.total(2)), "$7$"),
        (make({}, "estimate", formats.smallest()), "$5$"),
        (make({}, "estimate", formats.RANGE), "$-6$ to $8$"),
        (make(WALL, "estimate/law", formats.digits(2)), "$4$"),
        (make(WALL, "estimate*law", formats.digits(2)), "$16$"),
        (make(HOP, ("estimate/law", "stderr"), formats.WITH_ERROR), "$-2.0 (2)$"),
        (make(HOP, ("estimate", "stderr"), formats.WITH_ERROR, ("first",)), "$-6.0 (2)$"),
        (make(HOP, "time", formats.AS_TYPED, ("last",)), "4.0"),
        (make(HOP, "estimate", formats.digits(1), ("largest", "estimate")), "$-6$"),
        (make({}, "estimate", formats.digits(1), ("smallest", "time", "estimate")), "$-6$"),
        (
            make(WALL, "estimate", formats.digits(1), same=(FIRST, "time")),
            "$8$",
        ),
        (make({}, ("estimate", "event"), formats.COUNTED), "3"),
        (make(HOP, ("estimate", "law"), formats.WITH_ERROR), "$-6 (3)$"),
    ],
)  # fmt: skip
def test_a_number_takes_its_rows(one, text):
    assert one.printed(ROWS, {MAIN: "hop"}).text == text


@pytest.mark.parametrize(
    ("where", "error", "sentence"),
    [
        (
            {"event": "door", "law": ..., "time": (1.0, 2.0)},
            formats.NoRow,
            "the number n must have one row of tails.csv with event = 'door' and any law and time "
            "among (1.0, 2.0), but there are 0",
        ),
        (
            {"event": Other("wall")},
            InputError,
            "the number n must have one row of tails.csv with event other than 'wall', "
            "but there are 2",
        ),
        ({}, InputError, "one row of tails.csv with values in its columns, but there are 3"),
    ],
)
def test_a_filter_of_no_row_or_of_two_is_one_sentence(where, error, sentence):
    with pytest.raises(error, match=re.escape(sentence)) as raised:
        make(where, "estimate", formats.digits(2)).printed(ROWS, GIVEN)
    assert type(raised.value) is error


def test_a_number_without_a_row_is_left_out_and_named(monkeypatch, capsys):
    monkeypatch.setattr(
        numbers,
        "NUMBERS",
        (make(HOP, "law", formats.INTEGER), make({"law": 9.0}, "law", formats.INTEGER)),
    )
    monkeypatch.setattr(numbers, "CELLS", ())
    assert numbers.printed(ROWS, SCENES) == {"n": formats.Printed(3.0, "3")}
    assert capsys.readouterr().err.startswith(
        "the number n must have one row of tails.csv with law"
    )
    monkeypatch.setattr(numbers, "NUMBERS", (make({}, "estimate", formats.INTEGER),))
    with pytest.raises(InputError, match="but there are 3"):
        numbers.printed(ROWS, SCENES)


def test_cells_are_those_of_lines():
    cells = (
        make(HOP, "estimate", formats.digits(1), ("first",)),
        Number("seconds", "cost", {}, "seconds", formats.INTEGER),
    )
    lines = Cells("t", "tails", {}, ("event",), cells)
    assert {name: one.text for name, one in lines.printed(ROWS, GIVEN).items()} == {
        "t/hop/n": "$-6$", "t/hop/seconds": "--", "t/wall/n": "--", "t/wall/seconds": "7",
    }  # fmt: skip
    (one,) = [make({}, "time", formats.INTEGER)]
    lines = Cells("t", "tails", {"law": ...}, ("time", "event"), (one,), True, True)
    assert {name: one.text for name, one in lines.printed(ROWS, GIVEN).items()} == {
        "t/01/n": "2", "t/02/n": "2",
    }  # fmt: skip
    assert [*Cells("t", "tails", WALL, (), (one,)).printed(ROWS, GIVEN)] == ["t/2/n", "t/3/n"]


@pytest.mark.parametrize(
    ("form", "values", "text"),
    [
        (formats.CASES,
         [[("vertical_hop", 0.25), ("horizontal_hop", 0.1), ("vertical_hop", 0.375)]],
         "vertical hops at $r =$ $0.25$, $0.375$; horizontal hops at $r =$ $0.1$"),
        (formats.STEP_FLOORS, [[(0.0625, 0.1), (0.25, 0.4)]],
         "$0.4$ at $Delta t =$ $0.25$, $0.1$ at $Delta t =$ $0.063$"),
        (formats.PLURALS, [["vertical_hop", "horizontal_hop"]],
         "vertical hops and horizontal hops"),
        (formats.NUMBER_WORDS, [[8, 4, 4]], "four and eight"),
        (formats.QUOTIENT, [[0.1, 0.0125]], "$8$"),
        (formats.SPREAD, [[(0.1, 2.0), (0.2, 5.0), (0.1, 2.1), (0.2, 5.0)]], "$5$"),
        (formats.OTHERS, [[-3.3, 1.0, 2.01]], "$2.1$"),
        (formats.OVERLAP, [[-3e-16, 1e-3]], "$3 times 10^(-16)$"),
        (formats.FAILED, [[True, False, True]], "1"),
        (formats.POWER_OF_TWO, [2.0**-14], "$2^(-14)$"),
        (formats.SHARE, [1, 10**6], "a share of $10^(-6)$"),
        (formats.SHARE, [0, 10**6], "none"),
        (formats.CHANCE, [0.034], "$0.03$"),
        (formats.CHANCE, [1e-3], "$0$"),
        (formats.EXACT_OR_MEASURED, [0.5195, 0.0005, 0.519907], "$0.51991$"),
        (formats.EXACT_OR_MEASURED, [0.25271, 0.00025271, None], "$0.2527 (3)$"),
        (formats.FIRST_LETTER, ["vertical_hop"], "v"),
        (formats.SHORT_EVENT, ["disc_collision"], "disc coll."),
        (formats.THEORY, ["none"], "--"),
        (formats.PLAIN, ["hop_tau"], r"hop\_tau"),
        (formats.SEVERITY, ["slip", "in range"], "slip, in range"),
        (formats.SEVERITY, ["major", "wrong"], "major"),
        (formats.RATIO, [0.5, 0.2], "$0.5$ at $0.2$"),
        (formats.RATIO, [0.5, None], "$0.5$"),
        (formats.METHODS, ["theory; Monte Carlo 2.0(1); dynamics 2.00(1)"], "C D"),
        (formats.METHODS, ["theory"], "--"),
        (formats.CORRECTION, ["`8√2 b√(a² − r²)`, with `√2` once"],
         "$8 sqrt(2)  b  sqrt( a ^2 -  r ^2)$, with $sqrt(2)$ once"),
    ],
)  # fmt: skip
def test_formats_of_one_number(form, values, text):
    assert form.write(*values).text == text


# The numbers of the manuscript --------------------------------------------------------------------


def test_every_number_of_the_prose_is_declared_and_every_declared_one_is_used():
    used = {*re.findall(r'(?:number|has)\("(\w+)"\)', SOURCE)}
    used |= {*re.findall(r"\bours: (\w+)", (PAPER / "published.yaml").read_text())}
    names = Counter(one.name for one in numbers.NUMBERS)
    assert {*names} | {*CONSTANTS, "seed"} == used
    assert max(names.values()) == 1
    assert {*re.findall(r'cells\("(\w+)"\)', SOURCE)} == {cells.name for cells in numbers.CELLS}


@pytest.mark.parametrize(
    "one",
    [*numbers.NUMBERS, *(c for t in numbers.CELLS for c in t.cells)],
    ids=lambda one: one.name,
)
def test_a_number_is_of_a_table_and_of_columns_that_there_are(one):
    kept = (TABLES | numbers.LONG_RUNS)[one.table].columns.keys()
    if one.table in SCENE_TABLES:
        kept |= {"scene", "width", "height"}
    columns = {one.columns} if isinstance(one.columns, str) else {*one.columns}
    columns = {part for column in columns for part in re.split("[/*]", column)}
    assert columns | one.where.keys() | {*one.pick[1:], *one.same[1:]} <= kept


@pytest.fixture(scope="module")
def expected():
    """Return the tables of the default configuration, as far as they are kept."""
    tables = {name: [] for name in (*numbers.OF_SCENES, *numbers.OF_STUDIES)}
    for name in tables.keys() - {*NOT_KEPT}:
        if name in SCENE_TABLES:
            for scene in SCENES:
                start = {"scene": scene["name"], "width": scene["width"], "height": scene["height"]}
                path = PAPER / "expected" / scene["name"] / f"{name}.csv"
                tables[name] += [start | row for row in TABLES[name].read(path)]
        else:
            tables[name] = TABLES[name].read(PAPER / "expected" / f"{name}.csv")
    paths = LONG_RUNS.items()
    return tables | {name: numbers.LONG_RUNS[name].read(path) for name, path in paths}


@pytest.mark.parametrize("one", numbers.NUMBERS, ids=lambda one: one.name)
def test_every_number_has_rows_in_the_expected_tables(expected, one):
    if one.table not in NOT_KEPT:
        assert one.printed(expected, GIVEN).text


@pytest.mark.parametrize("cells", numbers.CELLS, ids=lambda cells: cells.name)
def test_every_column_of_cells_has_rows_in_the_expected_tables(expected, cells):
    found = cells.printed(expected, GIVEN)
    filled = {name.split("/")[2] for name, one in found.items() if one.text != "--"}
    assert filled == {cell.name for cell in cells.cells if cell.table not in NOT_KEPT}


def of(rows, **where):
    """Return those of ``rows`` that have these values."""
    return [row for row in rows if where.items() <= row.items()]


def scores(rows):
    """Return the sizes of the scores of ``rows``."""
    return [abs(row["z"]) for row in rows if row["z"] is not None]


def exponent(tables):
    """Return the slope of ln(1 − κ) against ln δ by the normal equations."""
    rows = of(tables["passages"], scene="paper", event="horizontal_hop", quantity="coefficient")
    rows = of(rows, moment_of_inertia=None, friction=None)[-5:]
    x, y, error = (
        np.array([f(row) for row in rows])
        for f in (
            lambda row: math.log(row["distance"]),
            lambda row: math.log(1 - row["estimate"]),
            lambda row: row["stderr"] / (1 - row["estimate"]),
        )
    )
    return np.polyfit(x, y, 1, w=1 / error)[0]


#: Numbers by a second method, from {name: rows}.
BY_HAND = {
    "tests": lambda t: sum(bool(r["passed"] is not None and r["independent"]) for r in t["check"]),
    "tests_largest": lambda t: max(scores(of(t["check"], independent=True))),
    "mean_time_largest": lambda t: max(scores(of(t["check"], comparison="mean_time"))),
    "mean_scores_largest": lambda t: max(scores(of(t["check"], comparison="z_mean"))),
    "strips_longest": lambda t: max(r["estimate"] for r in of(t["mean_times"], starts="strip")),
    "densities_others": lambda t: sorted(
        scores(of(t["distributions"], quantity="density_at_zero"))
    )[-2],
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
        for r in of(t["passages"], scene="paper", quantity="coefficient", event="horizontal_hop")
    ),
    "passages_files_error": lambda t: max(
        r["stderr"] for n in (4, 8) for r in of(t["passages"], quantity="diffusion", discs=n)
    ),
    "more_discs_exact": lambda t: sum(
        r["exact"] is not None and r["z"] is not None and r["event"] != "virial"
        for r in t["more_discs"]
    ),
    "longest_run": lambda t: max(r["count"] for r in of(t["stability"], part="dynamics")),
    "overlap": lambda t: -min(r["value"] for r in of(t["stability"], quantity="smallest_gap")),
    "coverage_least": lambda t: 100 * min(
        r["value"] for r in of(t["stability"], part="coverage") if r["value"] is not None
    ),
    "long_run_events": lambda t: sum(
        r["count"] for r in t["long_run"] if r["event"] in ("any_wall", "disc_collision")
    ),
    "long_run_rare": lambda t: max(r["exact"] for r in t["long_run"]),
}  # fmt: skip


@pytest.mark.parametrize("name", BY_HAND)
def test_numbers_are_those_of_a_second_method(expected, name):
    (one,) = [one for one in numbers.NUMBERS if one.name == name]
    value = one.printed(expected, GIVEN).value
    assert value == pytest.approx(BY_HAND[name](expected), rel=1e-9)


# The table ----------------------------------------------------------------------------------------


def test_tables_are_read_from_the_folders_of_scenes_and_from_that_of_all(tmp_path):
    (tmp_path / "paper").mkdir()
    for name in (*numbers.OF_SCENES, *numbers.OF_STUDIES):
        own = tmp_path / "paper" if name in SCENE_TABLES else tmp_path
        rows = [TABLES[name].empty(radius=0.1)] if name == "grid" else []
        TABLES[name].write(own / f"{name}.csv", rows)
    found = numbers.read(tmp_path, SCENES[:1])
    assert found.keys() == {*numbers.OF_SCENES, *numbers.OF_STUDIES, *numbers.LONG_RUNS}
    assert not any(found[name] for name in numbers.LONG_RUNS)
    assert all(numbers.read(tmp_path, SCENES[:1], LONG_RUNS)[name] for name in numbers.LONG_RUNS)
    (row,) = found["grid"]
    assert (row["scene"], row["width"], row["radius"]) == ("paper", 1.5, 0.1)
    (tmp_path / "errata.csv").write_text("nothing\n")
    with pytest.raises(InputError, match=r"errata\.csv must be a table errata"):
        numbers.read(tmp_path, SCENES[:1])


def test_numbers_become_rows_of_a_table(expected, tmp_path):
    found = numbers.printed(expected, SCENES)
    path = tmp_path / "paper_numbers.csv"
    numbers.PaperNumbers.write(path, numbers.table_rows(found))
    rows = numbers.PaperNumbers.read(path)
    assert [row["name"] for row in rows] == list(found)
    by_name = {row["name"]: row for row in rows}
    assert by_name["statements"]["value"] == len(expected["errata"])
    assert by_name["agreement/paper/box"]["value"] is None
    assert by_name["errata/01/number"]["text"] is None


def test_the_long_run_is_what_its_shards_counted_and_agrees():
    folder = PAPER / "long_run" / "far"
    scene = load(read(folder / "config.yaml")).scenes[0]
    point = DynamicsPoint.read(folder / "dynamics.json")
    assert point.radius == scene.radii[0]
    theory = list(Theory.rows(scene.box, scene.radii))
    made = MeanTimes.rows(scene.box, theory, {"dynamics": [point]})
    kept = MeanTimes.read(folder / "mean_times.csv")
    assert [row["event"] for row in made] == [row["event"] for row in kept]
    for ours, theirs in zip(made, kept, strict=True):
        assert ours["count"] == theirs["count"]
        assert ours["estimate"] == pytest.approx(theirs["estimate"], rel=1e-12)
        assert abs(ours["z"]) < 5  # ten scores: a false alarm in 2e5 seeds
    shards = [read_json(path) for path in folder.glob("shards/all-*.json")]
    used = [shard for shard in shards if shard["stop"] * REPLICAS <= point.replicas]
    assert sum(shard["stop"] - shard["first"] for shard in used) * REPLICAS == point.replicas
    counted = [sum(counts) for counts in zip(*(shard["sums"][0] for shard in used), strict=True)]
    # Events that were declared later were not counted.
    assert counted == [point.counts[event] for event in EVENTS if event in point.counts]


def test_the_page_on_passages_has_the_numbers_of_the_build_and_of_the_long_run():
    """Every value with an error is that of a row, rounded as in the manuscript."""
    folders = PAPER / "expected", PAPER / "long_run" / "passages"
    rows = [row for folder in folders for row in TABLES["passages"].read(folder / "passages.csv")]
    printed = (formats.with_error(r["estimate"], r["stderr"]).text for r in rows if r["stderr"])
    known = {re.sub("[$ -]", "", text) for text in printed}
    page = (PAPER.parent / "docs" / "passages.md").read_text()
    found = {*re.findall(r"\d+\.\d+\(\d+\)", page)}
    assert len(found) > 50
    assert found <= known
