"""The table of all numbers that the manuscript prints."""

from pathlib import Path

from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.comparison.tables.base import NUMBER, TEXT, Table
from twodiscs_paper.catalogue import STUDY_TABLES
from twodiscs_paper.pipeline.documents.numbers import (
    agreement,
    costs,
    distributions,
    laws,
    more_discs,
    passages,
)
from twodiscs_paper.pipeline.documents.numbers.rounding import Number

#: The tables that numbers are taken from: those of scenes, and those of studies.
OF_SCENES = ("grid", "volume", "areas", "mean_times", "hop_histogram", "check", "cost")
OF_STUDIES = (
    "errata",
    "accuracy_cost",
    "stability",
    "tails",
    "distributions",
    "thresholds",
    "effects",
    "passages",
    "more_discs",
)


class PaperNumbers(Table):
    """One row per number that the manuscript prints."""

    name: TEXT
    """what the manuscript calls it; table/row/column for a cell of a table"""
    value: NUMBER
    """the number itself, if the text is of one"""
    text: TEXT
    """what is printed, as markup of Typst; empty for an empty cell"""


def read(results, scenes, long_run=None):
    """Return {name: rows} of the tables in the folder ``results`` that numbers are taken from.

    ``long_run`` is the mean_times.csv of the long run, which no build makes. ``scenes`` have a
    "name" each and the names of their "tables"; rows of a scene get a "scene". Raises ``OSError``
    for a table that is missing, ``InputError`` for a file that is none.
    """
    tables = {name: [] for name in (*OF_SCENES, *OF_STUDIES)}
    for scene in scenes:
        for name in set(OF_SCENES).intersection(scene["tables"]):
            path = Path(results, scene["name"], f"{name}.csv")
            for row in SCENE_TABLES[name].read(path):
                tables[name].append({"scene": scene["name"], **row})
    for name in OF_STUDIES:
        tables[name] = STUDY_TABLES[name].read(Path(results, f"{name}.csv"))
    tables["long_run"] = SCENE_TABLES["mean_times"].read(long_run) if long_run else []
    return tables


def numbers(tables, scenes):
    """Return {name: ``Number``} of all that the manuscript prints, as far as tables have rows.

    ``tables`` are as ``read`` returns them; ``scenes`` have a "name", "width" and "height", and the
    first one is what the manuscript is about.
    """
    main = scenes[0]["name"]
    prose = {
        **agreement.agreement(tables, scenes),
        **agreement.correlations(tables["check"]),
        **agreement.mean_scores(tables["check"], scenes),
        **agreement.effort(tables),
        **agreement.long_run(tables["long_run"]),
        **distributions.chains(tables["hop_histogram"]),
        **distributions.densities(tables["distributions"], tables["hop_histogram"]),
        **distributions.tails(tables["tails"]),
        **distributions.hazards(tables["distributions"], main),
        **laws.powers(tables["thresholds"], main, tables["mean_times"]),
        **laws.effects(tables["effects"]),
        **laws.errata(tables["errata"]),
        **passages.passages(tables["passages"], main),
        **more_discs.more_discs(tables["more_discs"]),
        **costs.accuracy_cost(tables["accuracy_cost"]),
        **costs.stability(tables["stability"]),
    }
    cells = {
        "agreement": agreement.agreement_table(tables, scenes),
        "rates": distributions.rates_table(tables["distributions"], main),
        "powers": laws.powers_table(tables["thresholds"], main, tables["check"]),
        "errata": laws.errata_table(tables["errata"]),
        "more": more_discs.more_discs_table(tables["more_discs"]),
    }
    for table, rows in cells.items():
        for row, columns in rows.items():
            for column, cell in columns.items():
                prose[f"{table}/{row}/{column}"] = cell or Number(None, "--")
    return {name: number for name, number in prose.items() if number is not None}


def table_rows(values):
    """Return the rows of paper_numbers.csv for the numbers ``values``."""
    return [
        {"name": name, "value": None if value is None else float(value), "text": text or None}
        for name, (value, text) in values.items()
    ]
