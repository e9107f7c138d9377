"""The pages that are made from declarations: tables, configuration, targets.

    python docs/make/pages.py

renews config/README.md, config/schema.json for editors, docs/reference.md, the end of
results/README.md, the rows of studies in README.md, and what `twodiscs` prints in the pages of
docs, in the folder where it is called.
"""

import ast
import json
import math
import re
import shlex
from contextlib import redirect_stdout
from inspect import cleandoc
from io import StringIO
from pathlib import Path
from unittest.mock import patch

import twodiscs
from twodiscs import cli
from twodiscs.arguments import Parser, run
from twodiscs.comparison import check
from twodiscs.model.checks import InputError
from twodiscs_paper.catalogue import STUDIES, TABLES
from twodiscs_paper.pipeline.configuration.schema import document, schema
from twodiscs_paper.pipeline.documents.numbers.table import PaperNumbers

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


#: The reference by what one wants, and the objects that its functions return.
REFERENCE = {
    "Scenes": ("Scene", "Box", "EVENTS", "EFFECTS", "InputError"),
    "Exact numbers": ("volume", "areas", "rate", "mean_times", "exact", "exact_table"),
    "Measurements": ("simulate", "scan", "sample", "intervals", "transmission"),
    "States and trajectories": ("starts", "trajectory", "observe"),
    "Figures and files": ("plot", "animate", "load", "load_result"),
    "What they return": (
        *("Measurement", "Measurements", "Scan", "Intervals"),
        *("Transmission", "Trajectory", "Observed"),
    ),
}

REFERENCE_INTRODUCTION = """\
# Reference

Every public name of `import twodiscs as td`. [At a Python prompt](python.md) shows them at work.
Lengths are in any one unit; disc 1 has mass 1 and the total energy is 1/2, so times are lengths
over a speed of 1. What is wrong with an argument is said by an `InputError`, a `ValueError`.
Examples go on from

```python
import twodiscs as td

scene = td.Scene(1.5, 1.0, 0.2)
```
"""


def _source(module):
    """Return (the text, the statements by name) of a module of the package, "" for the face."""
    path = Path(twodiscs.__file__).parent / f"{module.replace('.', '/') or '__init__'}.py"
    text = path.read_text(encoding="utf-8")
    kinds = ast.ClassDef, ast.FunctionDef
    return text, {part.name: part for part in ast.parse(text).body if isinstance(part, kinds)}


def _signature(text, function):
    """Return the head of a function as its module, a ``text``, has it."""
    lines = text.splitlines()[function.lineno - 1 : function.body[0].lineno - 1]
    head = cleandoc("\n" + "\n".join(lines)).removeprefix("def ").removesuffix(":")
    return re.sub(r"(?<=\()(\s*)(self|cls)(, |,\s*|(?=\)))", r"\1", head)


def _prose(statement):
    """Return a docstring as Markdown, its example as a block of Python."""
    text, _, example = ast.get_docstring(statement).partition("\nExample:\n")
    text = _plain(text).replace("``", "`").strip()
    example = cleandoc(example)
    return text + (f"\n\n```python\n{example}\n```" if example else "")


def _members(text, statement):
    """Return what a class says of its fields and its public methods, line by line."""
    for part in statement.body:
        if isinstance(part, ast.AnnAssign) and part.target.id != "kept":
            yield f"{part.target.id}: {ast.unparse(part.annotation)}"
    for part in statement.body:
        if not isinstance(part, ast.FunctionDef) or part.name[0] == "_" or not part.returns:
            continue
        if said := (ast.get_docstring(part) or "").partition("\n\n")[0].replace("``", ""):
            said = said.replace("\n", " ")
            if any("property" in ast.unparse(d) for d in part.decorator_list):
                yield f"{part.name}: {ast.unparse(part.returns)}"
            else:
                yield _signature(text, part)
            yield f"    # {said}"


def _described(name):
    """Return the entry of a public name, as Markdown."""
    head = f"### td.{name}\n\n"
    text, statements = _source(twodiscs._HOMES.get(name, ""))
    if name not in statements:
        known = ", ".join(f"`{value}`" for value in getattr(twodiscs, name))
        return f"{head}The names that are known, in their order: {known}."
    statement = statements[name]
    if isinstance(statement, ast.FunctionDef):
        signature = f"td.{_signature(text, statement)}"
        return f"{head}```text\n{signature}\n```\n\n{_prose(statement)}"
    lines = [*_members(text, statement)]
    if "Result" in map(ast.unparse, statement.bases):
        shared, results = _source("comparison.measured.result")
        save = [*_members(shared, results["Result"])]
        lines += save[next(i for i, line in enumerate(save) if line.startswith("save(")) :]
    shown = "\n".join(lines)
    return head + _prose(statement) + (f"\n\n```text\n{shown}\n```" if lines else "")


def reference():
    """Return docs/reference.md: every public name, from signatures and docstrings."""
    parts = [REFERENCE_INTRODUCTION]
    for title, names in REFERENCE.items():
        parts += [f"## {title}\n", *(f"{_described(name)}\n" for name in names)]
    return "\n".join(parts)


def renewed(text, new, start, end=None):
    """Return ``text`` with ``new`` from ``start`` on, or between ``start`` and ``end``."""
    before, mark, rest = text.partition(start)
    if not mark:
        raise InputError(f"the page must have a line {start.strip()!r}")
    if end is None:
        return before + new
    return before + start + new + end + rest.partition(end)[2]


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
    results, readme = (
        Path(folder, name).read_text(encoding="utf-8")
        for name in ("results/README.md", "README.md")
    )
    shown = {
        f"docs/{path.name}": path.read_text(encoding="utf-8")
        for path in sorted(Path(folder, "docs").glob("*.md"))
    }
    return {
        **{name: COMMAND.sub(_tried, text) for name, text in shown.items() if COMMAND.search(text)},
        "config/README.md": document(),
        "docs/reference.md": reference(),
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
