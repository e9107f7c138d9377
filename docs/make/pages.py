"""The pages that are made from declarations: tables, configuration, targets.

    python docs/make/pages.py

renews config/README.md, config/schema.json for editors, the end of results/README.md and the rows
of studies in README.md, in the folder where it is called.
"""

import json
from pathlib import Path

from twodiscs.comparison import check
from twodiscs.model.checks import InputError
from twodiscs.pipeline.arguments import Parser, run
from twodiscs.pipeline.configuration.schema import document, schema
from twodiscs.pipeline.documents.numbers.table import PaperNumbers
from twodiscs.studies.catalogue import STUDIES, TABLES

INTRODUCTION = """\
Tables are CSV files with one row per statement. Floats are written with all their digits,
integers as integers, truth values as `true` and `false`; an empty cell is a value that does not
exist. Lengths are in the unit of the box, and the time unit is that in which the speed √(v1² + v2²)
is one.\
"""

#: What stands before and after the rows of studies in README.md; on lines of their own, comments
#: would end the table.
MARKS = "<!-- studies --> |\n", "| <!-- end of studies -->"


def _plain(text):
    """Return ``text`` with what Markdown would take for a column or a tag escaped."""
    return text.replace("|", "\\|").replace("<", "&lt;")


def described_tables():
    """Return the description of every table, and how to read check.csv, as Markdown."""
    parts = [f"# Tables\n\n{INTRODUCTION}\n"]
    for name, table in (TABLES | {"paper_numbers": PaperNumbers}).items():
        meanings = table.meanings()
        lines = [
            f"| `{column}` | {kind.unit or '–'} | {_plain(meanings[column])} |\n"
            for column, kind in table.columns().items()
        ]
        parts.append(
            f"## {name}.csv\n\n{table.meaning()}\n\n| column | unit | meaning |\n|---|---|---|\n"
            + "".join(lines)
        )
    return "\n".join([*parts, f"## How to read check.csv\n\n{check.__doc__}"])


def described_studies():
    """Return the rows of the studies in the README's table of targets."""
    shared = (study for study in STUDIES.values() if study.shared)
    return "".join(f"| `{study.name}` | {study.builds} |\n" for study in shared)


def renewed(text, new, start, end=None):
    """Return ``text`` with ``new`` from ``start`` on, or between ``start`` and ``end``."""
    before, mark, rest = text.partition(start)
    if not mark:
        raise InputError(f"the page must have a line {start.strip()!r}")
    if end is None:
        return before + new
    return before + start + new + end + rest.partition(end)[2]


def pages(folder):
    """Return {path below ``folder``: text} of the pages as they should be."""
    results, readme = (
        Path(folder, name).read_text(encoding="utf-8")
        for name in ("results/README.md", "README.md")
    )
    return {
        "config/README.md": document(),
        "config/schema.json": json.dumps(schema(), ensure_ascii=False, indent=1) + "\n",
        "results/README.md": renewed(results, described_tables(), "# Tables\n"),
        "README.md": renewed(readme, described_studies(), *MARKS),
    }


def main():
    parser = Parser(description=__doc__.split("\n")[0])
    parser.parse_args()
    for name, text in pages(".").items():
        Path(name).write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    run(main)
