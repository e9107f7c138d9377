"""The pages that are made from declarations: tables, configuration, targets.

    python docs/make/pages.py

renews, in the folder where it is called: config/README.md, config/schema.json for editors, the end
of results/README.md, the rows of studies in docs/pipeline.md, the names that editors complete in
src/twodiscs/__init__.py, and the output of `twodiscs` in the pages of docs.
"""

import json
import math
import re
import shlex
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from unittest.mock import patch

from twodiscs import cli
from twodiscs.arguments import Parser, run
from twodiscs.model.checks import InputError
from twodiscs.model.events import EVENTS, HOPS
from twodiscs_paper.catalogue import STUDIES, TABLES
from twodiscs_paper.configuration.schema import document, schema
from twodiscs_paper.pipeline.documents.manuscript import PaperNumbers

INTRODUCTION = """\
Tables are CSV files with one row per statement. Floats are written with all their digits,
integers as integers, truth values as `true` and `false`; an empty cell is a value that does not
exist. Lengths are in the unit of the box, and the time unit is that in which the speed √(v1² + v2²)
is one. The site has a page for each table with its columns; in Python, `attrs["meanings"]` and
`attrs["units"]` of a table that `td.load("results/paper")` returns say the same.\
"""

#: Letters of a line of code.
LINE = 100

#: Marks before and after the rows of studies in docs/pipeline.md. Comments on lines of their own
#: would end the table.
MARKS = "<!-- studies --> |\n", "| <!-- end of studies -->"


def _plain(text):
    """Return ``text`` with what Markdown would take for a column or a tag escaped."""
    return text.replace("|", "\\|").replace("<", "&lt;")


def every_table():
    """Return {name: table} of all tables, that of the manuscript's numbers among them."""
    return TABLES | {"paper_numbers": PaperNumbers}


def described_tables(cell="`{}.csv`"):
    """Return the list of all tables as Markdown; ``cell`` is how a name is written there."""
    rows = (f"| {cell.format(n)} | {_plain(t.meaning())} |" for n, t in every_table().items())
    return "\n".join([f"{INTRODUCTION}\n\n| table | its rows |\n|---|---|", *rows, ""])


def described_table(name, table):
    """Return the description of a table, its columns among it, as Markdown."""
    rows = (
        f"| `{column}` | {kind.unit or '–'} | {_plain(kind.meaning)} |\n"
        for column, kind in table.columns.items()
    )
    head = f"# {name}.csv\n\n{table.meaning()}\n\n| column | unit | meaning |\n|---|---|---|\n"
    return head + "".join(rows)


def described_studies():
    """Return the rows of the studies in the table of targets."""
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


#: Marks before and after the names for checkers of types in the face.
NAMES = (
    "    # Names that an editor completes; python docs/make/pages.py renews them.\n",
    "    # end of names\n",
)


def literals():
    """Return the types of the names of events, hops, quantities and axes, for the face."""
    named = {
        "Event": EVENTS,
        "Hop": HOPS,
        "Quantity": ("volume", *(f"{event}_area" for event in EVENTS)),
        "Axis": ("x", "y", "z"),
    }
    lines = []
    for name, values in named.items():
        quoted = [f'"{value}"' for value in values]
        line = f"    {name} = Literal[{', '.join(quoted)}]"
        if len(line) > LINE:
            inner = "".join(f"        {value},\n" for value in quoted)
            line = f"    {name} = Literal[\n{inner}    ]"
        lines.append(f"{line}\n")
    return "".join(lines)


#: A command that a page shows, and beneath it what it prints.
COMMAND = re.compile(r"^\$ (twodiscs .+)\n((?:(?!```|\$ ).*\n)+)", re.MULTILINE)


def same(shown, found):
    """Say whether two texts are equal, numbers up to a few roundings.

    The exact theory is right to 1e-13 on any machine, but its last digits depend on the math
    library.
    """
    shown, found = shown.split(), found.split()
    return len(shown) == len(found) and all(map(_same_word, shown, found))


def _same_word(shown, found):
    try:
        return math.isclose(float(shown), float(found), rel_tol=1e-13)
    except ValueError:
        return shown == found


def _tried(example):
    """Return a command with what it prints, as it was if that is the ``same``."""
    command, shown = example.groups()
    with patch("sys.argv", shlex.split(command)), redirect_stdout(StringIO()) as printed:
        cli._main()
    found = printed.getvalue()
    return example[0] if same(shown, found) else f"$ {command}\n{found}"


def pages(folder):
    """Return {path below ``folder``: text} of the pages as they should be."""
    results = Path(folder, "results/README.md").read_text(encoding="utf-8")
    face = Path(folder, "src/twodiscs/__init__.py").read_text(encoding="utf-8")
    shown = {
        f"docs/{path.name}": path.read_text(encoding="utf-8")
        for path in sorted(Path(folder, "docs").glob("*.md"))
    }
    return {
        **{name: COMMAND.sub(_tried, text) for name, text in shown.items() if COMMAND.search(text)},
        "src/twodiscs/__init__.py": renewed(face, literals(), *NAMES),
        "config/README.md": document(),
        "config/schema.json": json.dumps(schema(), ensure_ascii=False, indent=1) + "\n",
        "results/README.md": renewed(results, f"## Tables\n\n{described_tables()}", "## Tables\n"),
        "docs/pipeline.md": renewed(shown["docs/pipeline.md"], described_studies(), *MARKS),
    }


def main():
    parser = Parser(description=__doc__.split("\n")[0])
    parser.parse_args()
    for name, text in pages(".").items():
        Path(name).write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    run(main)
