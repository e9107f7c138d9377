"""The table of all numbers that the manuscript prints, and the tables with their values."""

import sys
from pathlib import Path

from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.comparison.tables.base import NUMBER, TEXT, Table
from twodiscs_paper.catalogue import STUDY_TABLES
from twodiscs_paper.pipeline.documents.numbers.declared import CELLS, NUMBERS
from twodiscs_paper.pipeline.documents.numbers.number import FIRST_HOP, MAIN, NoRow

#: The tables of scenes and of studies that numbers are taken from.
READ = {number.table for number in (*NUMBERS, *(cell for table in CELLS for cell in table.cells))}
OF_SCENES = sorted(READ & SCENE_TABLES.keys())
OF_STUDIES = sorted(READ & STUDY_TABLES.keys())

#: Tables of the long runs, which are kept: no build makes them.
LONG_RUNS = {
    "long_run": SCENE_TABLES["mean_times"],
    "long_passages": STUDY_TABLES["passages"],
    "long_tails": STUDY_TABLES["tails"],
}


class PaperNumbers(Table):
    """One row per number that the manuscript prints."""

    name: TEXT
    """its name in the manuscript; table/row/column for a cell of a table"""
    value: NUMBER
    """the number itself, if the text shows one number"""
    text: TEXT
    """the printed text, as markup of Typst; empty for an empty cell"""


def read(results, scenes, long_runs=None):
    """Return {name: rows} of the tables in the folder ``results`` that numbers are taken from.

    ``long_runs`` are {name: path} of tables among ``LONG_RUNS``. ``scenes`` have a "name", "width"
    and "height" each, which are added to the rows of a scene, and the names of their "tables".
    Raises ``OSError`` for a table that is missing, ``InputError`` for a file that
    is no table.
    """
    tables = {name: [] for name in (*OF_SCENES, *OF_STUDIES)}
    for scene in scenes:
        start = {"scene": scene["name"], "width": scene["width"], "height": scene["height"]}
        for name in set(OF_SCENES).intersection(scene["tables"]):
            path = Path(results, scene["name"], f"{name}.csv")
            tables[name] += [start | row for row in SCENE_TABLES[name].read(path)]
    for name in OF_STUDIES:
        tables[name] = STUDY_TABLES[name].read(Path(results, f"{name}.csv"))
    paths = long_runs or {}
    return tables | {
        name: kind.read(paths[name]) if name in paths else [] for name, kind in LONG_RUNS.items()
    }


def printed(tables, scenes):
    """Return {name: ``Printed``} of all that the manuscript prints.

    ``tables`` are as ``read`` returns them; the manuscript is about the first of the ``scenes``. A
    number without a row is left out, because a configuration may have less; its sentence goes to
    the standard error. Raises ``InputError`` for a number with several rows instead of one.
    """
    main = scenes[0]
    hop = "horizontal_hop" if main["width"] > main["height"] else "vertical_hop"
    given, found = {MAIN: main["name"], FIRST_HOP: hop}, {}
    for number in NUMBERS:
        try:
            found[number.name] = number.printed(tables, given)
        except NoRow as error:
            print(error, file=sys.stderr)
    for cells in CELLS:
        found |= cells.printed(tables, given)
    return {name: number for name, number in found.items() if number is not None}


def table_rows(values):
    """Return the rows of paper_numbers.csv for the numbers ``values``."""
    return [
        {"name": name, "value": None if value is None else float(value), "text": text or None}
        for name, (value, text) in values.items()
    ]
