"""Tables: a written table is read again unchanged, and every column has a meaning."""

import math
import subprocess
import sys
from inspect import isclass

import numpy as np
import pytest
from made import described_table

from twodiscs.comparison import load, scene_tables
from twodiscs.comparison.load import plugin
from twodiscs.comparison.scene_tables import SCENE_TABLES, Check, Cost, Theory
from twodiscs.comparison.table import RADIUS, TEXT, TIME, Column, Table, Z

EVERY_TABLE = plugin("tables")

# A table as a class ---------------------------------------------------------------------------


class Measured(Table):
    """
    What is measured,
    row by row.
    """

    columns = {"radius": RADIUS, "event": TEXT("the event"), "estimate": TIME("the estimate")}


class BetterMeasured(Measured):
    """With an error."""

    columns = Measured.columns | {"stderr": Column(float, "as estimate", "its error"), "z": Z}


def test_a_table_is_called_as_its_class():
    assert Measured.name() == "measured"
    assert BetterMeasured.name() == "better_measured"
    assert Measured.meaning() == "What is measured, row by row."
    assert {name: table.__name__ for name, table in SCENE_TABLES.items()}["hop_histogram"] == (
        "HopHistogram"
    )


def test_an_empty_row_has_every_column_and_nothing_in_it(tmp_path):
    row = BetterMeasured.empty(radius=0.1, z=-1.5)
    assert row == {"radius": 0.1, "event": None, "estimate": None, "stderr": None, "z": -1.5}
    BetterMeasured.write(tmp_path / "x.csv", [row])
    assert (tmp_path / "x.csv").read_text() == "radius,event,estimate,stderr,z\n0.1,,,,-1.5\n"
    with pytest.raises(ValueError, match=r"columns of measured\.csv, but see colour"):
        Measured.write(tmp_path / "y.csv", [Measured.empty(colour="red")])


@pytest.mark.parametrize("table", EVERY_TABLE.values(), ids=EVERY_TABLE)
def test_every_table_and_every_column_say_what_they_mean(table):
    assert table.meaning()[-1] in ".?"
    assert len(table.columns) > 3 or table is Theory
    for name, column in table.columns.items():
        assert len(column.meaning) > 6, name
        assert "\n" not in column.meaning
        assert "  " not in column.meaning
        assert not column.meaning.endswith("."), name
        assert column.type in (str, int, bool, float), name
        assert column.type is float or not column.unit, name


def test_every_column_is_described_on_a_line_of_its_own():
    for name, table in EVERY_TABLE.items():
        assert table.name() == name
        head, *lines = described_table(table).strip().splitlines()
        assert head == f"### {name}.csv"
        rows = [line for line in lines if line.startswith("|")][2:]
        assert len(rows) == len(table.columns)
        for row, (column, kind) in zip(rows, table.columns.items(), strict=True):
            meaning = kind.meaning.replace("|", "\\|").replace("<", "&lt;")
            assert row == f"| `{column}` | {kind.unit or '–'} | {meaning} |"
            assert row.replace("\\|", "").count("|") == 4


def test_every_table_of_a_scene_is_known_and_makes_its_rows():
    declared = {
        table.name()
        for table in vars(scene_tables).values()
        if isclass(table) and issubclass(table, Table)
    }
    assert declared - {"table"} == {*SCENE_TABLES}
    assert all(
        callable(table.rows)
        for name, table in EVERY_TABLE.items()
        if name not in ("effects_cost", "benchmark")
    )


def test_contract_columns_are_there():
    contract = {
        "mean_times": "radius,event,exact,estimate,stderr,z,count,ergodic_components",
        "volume": "radius,quantity,method,exact,estimate,stderr,z,samples",
        "areas": "radius,quantity,method,exact,estimate,stderr,z,samples",
        "cost": "stage,radius,events,seconds",
    }
    for name, columns in contract.items():
        assert set(columns.split(",")) <= set(SCENE_TABLES[name].columns)


# Files ----------------------------------------------------------------------------------------

CHECK_ROW = {
    "comparison": "area",
    "quantity": "right_wall_area",
    "radius": 0.1,
    "method": "monte_carlo",
    "exact": 1 / 3,
    "estimate": None,
    "stderr": None,
    "z": -math.inf,
    "p": 0.0,
    "bound": 5,
    "passed": False,
    "independent": True,
    "status": "none-seen",
    "test": "exact-tail",
}
COST_ROW = {"stage": "dynamics", "radius": 1e-05, "events": 2**53 + 1, "seconds": 0.1 + 0.2}


@pytest.mark.parametrize(("table", "row"), [(Check, CHECK_ROW), (Cost, COST_ROW)])
def test_a_table_is_read_as_it_was_written(tmp_path, table, row):
    for rows in ([], [row, row]):
        table.write(tmp_path / "x.csv", rows)
        assert table.read(tmp_path / "x.csv") == rows


def test_cells_have_all_digits_and_lines_end_alike(tmp_path):
    Cost.write(tmp_path / "x.csv", [COST_ROW])
    assert (tmp_path / "x.csv").read_bytes() == (
        b"stage,radius,events,seconds\ndynamics,1e-05,9007199254740993,0.30000000000000004\n"
    )
    Check.write(tmp_path / "x.csv", [CHECK_ROW])
    assert (tmp_path / "x.csv").read_text().splitlines()[1] == (
        "area,right_wall_area,0.1,monte_carlo,0.3333333333333333,,,-inf,0.0,5.0,false,"
        "true,none-seen,exact-tail"
    )


def test_columns_are_written_in_the_order_of_the_table(tmp_path):
    Cost.write(tmp_path / "x.csv", [dict(reversed(COST_ROW.items()))])
    assert Cost.read(tmp_path / "x.csv") == [COST_ROW]


def test_a_cell_that_a_row_does_not_name_is_empty(tmp_path):
    Cost.write(tmp_path / "x.csv", [{k: COST_ROW[k] for k in COST_ROW if k != "seconds"}])
    assert Cost.read(tmp_path / "x.csv") == [{**COST_ROW, "seconds": None}]


def test_numpy_scalars_are_written_as_plain_numbers(tmp_path):
    row = {**COST_ROW, "events": np.int64(7), "seconds": np.float64(0.1)}
    Cost.write(tmp_path / "x.csv", [row])
    assert (tmp_path / "x.csv").read_text().endswith("dynamics,1e-05,7,0.1\n")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"seconds": math.nan}, "seconds must be a float"),
        ({"seconds": "1.0"}, "seconds must be a float"),
        ({"seconds": True}, "seconds must be a float"),
        ({"events": 1.0}, "events must be a int"),
        ({"stage": ""}, "stage must be a str"),
        ({"stage": 3}, "stage must be a str"),
        ({"colour": 1}, "see colour"),
    ],
)
def test_a_wrong_cell_writes_nothing(tmp_path, change, message):
    with pytest.raises(ValueError, match=message):
        Cost.write(tmp_path / "x.csv", [COST_ROW, {**COST_ROW, **change}])
    with pytest.raises(ValueError, match="passed must be a bool"):
        Check.write(tmp_path / "x.csv", [{**CHECK_ROW, "passed": 1}])
    assert not (tmp_path / "x.csv").exists()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("\xff", "can't decode byte"),
        ("", "No columns to parse"),
        ("radius,quantity\n", "has no column 'exact'"),
        ("radius,quantity,exact\n0.1,volume,1.0\n0.1,volume\n", "exact has nan, which is no float"),
        ("radius,quantity,exact\n0.1,volume,1.0\n0.1,volume,1,2\n", "Expected 3 fields in line 3"),
        ("radius,quantity,exact\nr,volume,1.0\n", "could not convert string to float: 'r'"),
        ("radius,quantity,exact\n0.1,volume,nan\n", "exact has 'nan', which is no float"),
    ],
)
def test_a_wrong_file_is_named(tmp_path, text, message):
    (tmp_path / "theory.csv").write_bytes(text.encode("latin-1"))
    with pytest.raises(ValueError, match=rf"theory\.csv must be a table theory, but .*{message}"):
        Theory.read(tmp_path / "theory.csv")


def test_columns_that_the_table_does_not_know_are_left_out(tmp_path):
    """A later version may have one more, at any place."""
    text = "radius,colour,quantity,exact,more\n0.1,red,volume,1.0,\n"
    (tmp_path / "theory.csv").write_text(text)
    assert Theory.read(tmp_path / "theory.csv") == [
        {"radius": 0.1, "quantity": "volume", "exact": 1.0}
    ]
    assert list(load.read(tmp_path / "theory.csv", Theory)) == ["radius", "quantity", "exact"]


def test_a_truth_value_is_spelled_in_one_way(tmp_path):
    Check.write(tmp_path / "x.csv", [CHECK_ROW])
    text = (tmp_path / "x.csv").read_text()
    (tmp_path / "x.csv").write_text(text.replace(",false,", ",False,"))
    with pytest.raises(ValueError, match="passed has 'False', which is no bool"):
        Check.read(tmp_path / "x.csv")


@pytest.mark.parametrize(
    ("module", "absent"),
    [
        ("twodiscs.comparison.scene_tables", ("numpy", "scipy", "pandas")),
        ("twodiscs.theory.exact", ("numpy", "scipy", "pandas")),
        ("twodiscs.comparison.check", ("scipy.stats", "pandas", "numba", "matplotlib")),
    ],
)
def test_imports_stay_light(module, absent):
    code = f"import sys, {module}; print(*(m for m in {absent!r} if m in sys.modules))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == ""
