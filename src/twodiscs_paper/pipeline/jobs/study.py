"""Make the table of a study from its parameters and other tables.

    python -m twodiscs_paper.pipeline.jobs.study tails --parameters '{"box": …, "seed": 1, …}' \\
        --output results/tails.csv

Parameters are one JSON object; their entry ``box`` becomes a ``Box``.
"""

import inspect
from pathlib import Path

from twodiscs.arguments import Parser, fail, named, parameters, run
from twodiscs.model.box import Box
from twodiscs.model.checks import InputError
from twodiscs_paper.catalogue import STUDY_TABLES, TABLES


class Tables(dict):
    """The tables of a job, {name: rows}; a missing table ends the job with a sentence."""

    def __missing__(self, name):
        fail(f"the table {name} must be given, as --tables {name}=CSV")


def read_tables(texts):
    """Return {name: rows} of arguments NAME=CSV.

    The stem of a file names its table; for a part of a table, the folder of the file does.
    """
    tables = Tables()
    for name, path in named(texts, "--tables").items():
        names = Path(path).stem, Path(path).parent.name
        if not (found := [table for table in names if table in TABLES]):
            raise InputError(f"{path} must be one of the tables {', '.join(TABLES)}")
        tables[name] = TABLES[found[0]].read(path)
    return tables


def main():
    parser = Parser(prog=__spec__.name, description=__doc__.split("\n")[0])
    parser.add_argument("table", choices=STUDY_TABLES)
    parser.add_argument("--parameters", default="{}", metavar="JSON")
    parser.add_argument("--part", action="store_true", help="a part of the table")
    parser.add_argument("--tables", nargs="*", default=[], metavar="NAME=CSV")
    parser.add_argument("--output", required=True, metavar="CSV")
    options = parser.parse_args()
    table, given = STUDY_TABLES[options.table], parameters(options.parameters)
    if "box" in given:
        given["box"] = Box(**given["box"])
    work = table.part if options.part else table.rows
    signature, tables = inspect.signature(work), read_tables(options.tables)
    if "tables" in signature.parameters:
        given["tables"] = tables
    try:
        bound = signature.bind(**given)
    except TypeError as error:
        raise InputError(f"parameters of {options.table}: {error}") from None
    try:
        rows = work(*bound.args, **bound.kwargs)
    except InputError as error:
        # The configuration was accepted, so the mistake is in the study; the traceback shows it.
        raise RuntimeError(f"the study of {options.table} uses a value out of range") from error
    table.write(options.output, rows)


if __name__ == "__main__":
    run(main)
