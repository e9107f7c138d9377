"""Tables of the default configuration for tests of the manuscript."""

import shutil

import pytest
from factory import EXPECTED

from twodiscs_paper.catalogue import STUDY_TABLES, TABLES


@pytest.fixture(scope="session")
def tables_of():
    """Return a function that writes the tables of a build to a folder.

    ``scenes`` are {name in the folder: name in the expected results}. Tables that are not expected
    because of their seconds, and the ``empty`` ones, {name}, have no rows.
    """

    def write(folder, scenes, empty=()):
        for own, kept in scenes.items() | {(".", ".")}:
            (folder / own).mkdir(parents=True, exist_ok=True)
            for path in (EXPECTED / kept).glob("*.csv"):
                if path.stem not in empty:
                    shutil.copy(path, folder / own)
            for name in {*empty, "cost", "accuracy_cost"} & TABLES.keys():
                if (name in STUDY_TABLES) == (own == "."):
                    TABLES[name].write(folder / own / f"{name}.csv", [])

    return write
