"""Tables as files: columns, digits, empty cells, truth values.

Without it a digit, an empty cell or a truth value could change in a file.
"""

import numpy as np
import pytest
from commands import python
from factory import BOX, LAWS, empty

from twodiscs.analysis import tables
from twodiscs.analysis.columns import Table
from twodiscs.measure import load
from twodiscs.model.scene import Box


def test_every_table_of_a_scene_is_known():
    declared = [table for table in Table.__subclasses__() if table.__module__ == tables.__name__]
    assert {table.name(): table for table in declared} == tables.SCENE_TABLES


# Files ----------------------------------------------------------------------------------------

CHECK_ROW = empty(tables.CheckTable, 
    comparison="area", quantity="right_wall_area", radius=0.1, method="monte_carlo", exact=1 / 3,
    z=-np.inf, p=0.0, bound=5, passed=False, independent=True, status="none-seen",
    test="exact-tail",
)  # fmt: skip
RNG = np.random.default_rng(1)
COST_ROW = {"stage": "dynamics", "radius": 1e-05, "events": 2**53 + 1, "seconds": 0.1 + 0.2}


@pytest.mark.parametrize(
    ("table", "rows"),
    [
        (tables.CostTable, lambda: []),
        (tables.CostTable, lambda: [COST_ROW, COST_ROW | {"events": 2**63}]),
        (tables.CostTable, lambda: [COST_ROW | {"events": 2**63 - 1}]),
        (tables.CheckTable, lambda: [CHECK_ROW]),
        (tables.TheoryTable, lambda: tables.TheoryTable.rows(BOX, [0.3, 0.1])),
        (tables.GridTable, lambda: tables.GridTable.rows(Box(40.0, 0.6, discs=64), [0.1, 0.2])),
        (tables.TrajectoryTable, lambda: tables.TrajectoryTable.rows(Box(1.5, 1), 0.1, 1)),
        (tables.TrajectoryTable, lambda: tables.TrajectoryTable.rows(Box(1.5, 1, discs=4), 0.1, 1)),
        (tables.MeanTimesTable, lambda: tables.MeanTimesTable.rows([LAWS[2].dynamics(RNG)])),
        (tables.AreasTable, lambda: tables.AreasTable.rows([LAWS[2].monte_carlo(RNG, 10**7)])),
        (tables.HopHistogramTable, lambda: tables.HopHistogramTable.rows([LAWS[2].intervals(RNG)])),
    ],
)
def test_a_table_is_read_as_it_was_written(tmp_path, table, rows):
    """Whatever the order of the cells in a row."""
    rows = rows()
    table.write(tmp_path / "x.csv", [dict(reversed(row.items())) for row in rows])
    assert table.read(tmp_path / "x.csv") == rows
    frame = load.read(tmp_path / "x.csv", table)
    for name in ("ergodic_components", "x4", "events"):
        if name in frame:
            assert frame[name].tolist() == [row[name] for row in rows]
    if table is tables.CostTable:  # as objects where a number has more than 63 bits
        wide = any(row["events"] >= 2**63 for row in rows)
        assert frame["events"].dtype == ("object" if wide else "Int64")


def test_cells_have_all_digits_one_truth_value_and_lines_that_end_alike(tmp_path):
    tables.CostTable.write(tmp_path / "x.csv", [COST_ROW])
    due = b"stage,radius,events,seconds\ndynamics,1e-05,9007199254740993,0.30000000000000004\n"
    assert (tmp_path / "x.csv").read_bytes() == due
    row = {"stage": "dynamics", "events": np.int64(7), "radius": np.float64(0.1)}
    tables.CostTable.write(tmp_path / "x.csv", [row])
    assert (tmp_path / "x.csv").read_text().endswith("dynamics,0.1,7,\n")
    tables.CheckTable.write(tmp_path / "x.csv", [CHECK_ROW])
    text = (tmp_path / "x.csv").read_text()
    assert text.splitlines()[1] == (
        "area,right_wall_area,0.1,monte_carlo,0.3333333333333333,,,-inf,0.0,5.0,false,"
        "true,none-seen,exact-tail"
    )
    (tmp_path / "x.csv").write_text(text.replace(",false,", ",False,"))
    with pytest.raises(ValueError, match="passed has 'False', which is no bool"):
        tables.CheckTable.read(tmp_path / "x.csv")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"seconds": np.nan}, "seconds must be a float"),
        ({"seconds": "1.0"}, "seconds must be a float"),
        ({"seconds": True}, "seconds must be a float"),
        ({"events": 1.0}, "events must be a int"),
        ({"stage": ""}, "stage must be a str"),
        ({"stage": 3}, "stage must be a str"),
        ({"colour": 1}, r"columns of cost\.csv, but see colour"),
    ],
)
def test_a_wrong_cell_writes_nothing(tmp_path, change, message):
    with pytest.raises(ValueError, match=message):
        tables.CostTable.write(tmp_path / "x.csv", [COST_ROW, {**COST_ROW, **change}])
    with pytest.raises(ValueError, match="passed must be a bool"):
        tables.CheckTable.write(tmp_path / "x.csv", [{**CHECK_ROW, "passed": 1}])
    assert not (tmp_path / "x.csv").exists()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("\xff", "can't decode byte"),
        ("", "has no column 'radius'"),
        ("radius,quantity\n", "has no column 'exact'"),
        ("radius,quantity,exact\n0.1,volume,1.0\n0.1,volume\n", "has 2 cells for 3 columns"),
        ("radius,quantity,exact\n0.1,volume,1.0\n1,volume,1,2\n", "has 4 cells for 3 columns"),
        ("radius,quantity,exact\nr,volume,1.0\n", "could not convert string to float: 'r'"),
        ("radius,quantity,exact\n0.1,volume,nan\n", "exact has 'nan', which is no float"),
    ],
)
def test_a_wrong_file_is_named(tmp_path, text, message):
    (tmp_path / "theory.csv").write_bytes(text.encode("latin-1"))
    with pytest.raises(ValueError, match=rf"theory\.csv must be a table theory, but .*{message}"):
        tables.TheoryTable.read(tmp_path / "theory.csv")


def test_columns_that_the_table_does_not_know_are_left_out(tmp_path):
    """A later version may have one more, at any place; and empty lines."""
    path, known = tmp_path / "theory.csv", {"radius": 0.1, "quantity": "volume", "exact": 1.0}
    path.write_text("radius,colour,quantity,exact,more\n\n0.1,red,volume,1.0,\n")
    assert tables.TheoryTable.read(path) == [known]
    assert list(load.read(path, tables.TheoryTable)) == [*known]


def test_the_box_of_a_configuration_has_its_effects():
    """As YAML reads them: 2e0 is a text."""
    effects = {"periodic": "xy", "mass_ratio": 2}
    scene = {"name": "a", "box": {"width": "2e0", "height": 1}, "effects": effects}
    assert load.read_box({"scenes": [scene]}) == Box(2.0, 1.0, **effects)
    assert load.read_box({"scenes": [scene, scene]}) is None


#: Packages that take long to import: the Snakefile and the shell do without them.
SLOW = ("numba", "pandas", "matplotlib")


@pytest.mark.parametrize(
    ("code", "absent"),
    [
        ("import twodiscs as t; t.exact(t.Scene(1.5, 1, 0.2))", ("scipy.special", "mpmath", *SLOW)),
        (
            "import tempfile, twodiscs as t; from twodiscs.analysis.tables import GridTable as T; "
            "p = tempfile.mkdtemp() + '/x.csv'; T.write(p, T.rows(t.Box(2, 1), [0.1])); T.read(p)",
            ("scipy.special", *SLOW),
        ),
        (
            "import twodiscs.dynamics.runs, twodiscs_paper.pipeline.points",
            ("scipy.special", "mpmath", "pydantic", *SLOW[1:]),
        ),
    ],
)
def test_imports_stay_light(code, absent):
    code = f"{code}; import sys; print(*(m for m in {absent!r} if m in sys.modules))"
    assert python("-c", code, check=True).stdout.strip() == ""
