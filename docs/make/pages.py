"""Renew what other files repeat of declarations.

    python docs/make/pages.py

writes, in the folder where it is called: config/schema.json, the keywords and names that editors
complete in src/twodiscs/__init__.pyi, and in the pages of docs the output of `twodiscs`, the
targets of studies, the lists that 1.x promises, the costs of changes and the table of agreement of
the expected results. It ends with a sentence if the code lacks a name that is promised.
"""

import json
import re
import shlex
import sys
from collections import Counter
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from textwrap import fill
from unittest.mock import patch

import twodiscs
from twodiscs import cli
from twodiscs.analysis.tables import SCENE_TABLES
from twodiscs.model.events import EVENTS, HOPS
from twodiscs.model.scene import USUAL_VALUES, Box
from twodiscs.points.base import restore_arrays
from twodiscs.points.dynamics_point import DynamicsPoint
from twodiscs_paper.catalogue import STUDIES
from twodiscs_paper.configuration.schema import keys, schema
from twodiscs_paper.configuration.yaml_files import load, read
from twodiscs_paper.pipeline.build import TARGETS

#: The keywords and names for checkers of types in the face, between their marks.
NAMES = re.compile(
    r"(?<=python docs/make/pages.py renews them.\n).*?(?=# end of names\n)", re.DOTALL
)

#: A command that a page shows, and beneath it what it prints.
COMMAND = re.compile(r"^\$ (twodiscs .+)\n(?:(?!```|\$ ).*\n)+", re.MULTILINE)


def literals():
    """Return the types of keywords, and of the names of events, hops and quantities, for the face.

    Keywords are the fields of ``Box``. Where ``scan`` takes a number, it takes several.
    """
    kinds = {
        name: Box.__annotations__[name].replace("Sequence", "collections.abc.Sequence")
        for name in USUAL_VALUES
    }
    lists = {
        name: re.sub("float|int", r"\g<0> | collections.abc.Iterable[\g<0>]", kind)
        for name, kind in kinds.items()
    }
    text = ""
    for title, meaning, keywords in (
        ("Effects", "The effects and ``discs`` as optional keywords.", kinds),
        ("Scanned", "The same for ``scan``, which takes lists of numbers.", lists),
    ):
        lines = "".join(f"    {name}: {kind}\n" for name, kind in keywords.items())
        text += f'class {title}(typing.TypedDict, total=False):\n    """{meaning}"""\n\n{lines}\n'
    quantities = ("volume", *(f"{event}_area" for event in EVENTS))
    for name, values in {"Event": EVENTS, "Hop": HOPS, "Quantity": quantities}.items():
        names, indent = "".join(f'"{value}", ' for value in values), " " * 4
        lines = fill(names, 100, initial_indent=indent, subsequent_indent=indent)
        text += f"{name} = typing.Literal[\n{lines}\n]  # fmt: skip\n"
    return text


def described_targets(text):
    """Return the page of targets with a row for each study."""
    rows = "".join(f"| `{name}` | {study.builds} |\n" for name, study in STUDIES.items())
    return re.sub(r"(^\| `volume`.*\n)(?:.*\n)*?(?=\| `manifest`)", rf"\1{rows}", text, flags=re.M)


def _agreement(folder, scene):
    """Return the row of the table of agreement for a ``SceneRequest``, as text."""
    rows = SCENE_TABLES["check"].read(folder / scene.name / "check.csv")
    compared = [abs(row["z"]) for row in rows if row["passed"] is not None]
    points = json.loads((folder / scene.name / "points" / "dynamics.json").read_text())
    parts = [restore_arrays(point["parts"]) for point in points.values()]
    events = sum(DynamicsPoint.of(None, part).events for part in parts)
    independent = sum(row["independent"] for row in rows)
    largest = f"{max(compared):.3g}"  # as in check.passed
    counts = f"{len(points)} | {len(compared)} | {independent} | {largest} | {events:.1e}"
    counts = counts.replace("e+0", "e").replace("e+", "e")
    return f"| {scene.box.width:g} × {scene.box.height:g} | {counts} |\n"


def agreements(text, folder):
    """Return the page with the table of agreement of the results that ``folder`` expects."""
    scenes = load(read(Path(folder, "config/config.yaml"))).scenes
    expected = Path(folder, "paper/expected")
    rows = "".join(_agreement(expected, s) for s in scenes if (expected / s.name).is_dir())
    return re.sub(r"(^\| box \|.*\n\|[-|]+\n)(?:\|.*\n)+", rf"\1{rows}", text, flags=re.MULTILINE)


# What 1.x promises --------------------------------------------------------------------------------


def _keys_below(node, path=""):
    """Yield the keys of a configuration with those above them: "scenes.box.width"."""
    for name, child in node.get("properties", {}).items():
        yield path + name
        yield from _keys_below(child, f"{path}{name}.")
        yield from _keys_below(child.get("items", {}), f"{path}{name}.")


def promises(text):
    """Return the page of promises with the names, keys, columns and targets of the code.

    Raises ``LookupError`` if one is promised that the code has no more.
    """
    names = sorted(twodiscs.__all__, key=lambda name: (name.lower(), name))
    columns = [[f"{name}.csv:", *table.columns] for name, table in SCENE_TABLES.items()]
    parts = iter([[names], [[*dict.fromkeys(_keys_below(keys()))]], columns, [[*TARGETS]]])

    def renewed(block):
        lists = next(parts)
        if lost := Counter(block[1].split()) - Counter(word for one in lists for word in one):
            raise LookupError(f"{', '.join(sorted(lost))}: promised, and not in the code")
        lines = (
            fill(" ".join(one), 110, subsequent_indent="  " * (len(lists) > 1)) for one in lists
        )
        return "```text\n" + "\n".join(lines) + "\n```\n"

    return re.sub(r"^```text\n(.*?)```\n", renewed, text, flags=re.DOTALL | re.MULTILINE)


# The costs of changes -----------------------------------------------------------------------------

#: A table of the files of a change: what it is for, and its rows.
CHANGE = re.compile(r"^\| for (.+) \| content \|\n\|---\|---\|\n((?:\|.*\n)+)", re.MULTILINE)


def changes(page):
    """Return {change: (edited files, {command: files that it renews})} of the tables of a page."""
    found = {}
    for change, rows in CHANGE.findall(page):
        edited, renewed = [], {}
        for row in rows.splitlines():
            names, content = row.strip("|").split("|", 1)
            command = re.match(r" renewed by `(.+?)`", content)
            files = renewed.setdefault(command[1], []) if command else edited
            files += re.findall(r"`([^`]+)`", names)
        found[change] = edited, renewed
    return found


def costs(text, page):
    """Return the page with the table of the costs of the changes of another ``page``."""
    rows = (
        f"| {change} | {len(edited)} | {sum(map(len, renewed.values()))} |\n"
        for change, (edited, renewed) in changes(page).items()
    )
    head = "| change | edited | renewed |\n|---|---|---|\n"
    return re.sub(rf"(?<={re.escape(head)})(?:\|.*\n)+", lambda _: "".join(rows), text)


# Pages --------------------------------------------------------------------------------------------


def _tried(example):
    """Return a command with what it prints."""
    with patch("sys.argv", shlex.split(example[1])), redirect_stdout(StringIO()) as printed:
        cli._main()
    return f"$ {example[1]}\n{printed.getvalue()}"


def pages(folder):
    """Return {path below ``folder``: text} of the files as they should be."""
    face = Path(folder, "src/twodiscs/__init__.pyi").read_text(encoding="utf-8")
    renewed = {
        "src/twodiscs/__init__.pyi": NAMES.sub(lambda _: literals(), face),
        "config/schema.json": json.dumps(schema(), ensure_ascii=False, indent=1) + "\n",
    }
    paths = Path(folder, "README.md"), *sorted(Path(folder, "docs").glob("*.md"))
    known = {p.relative_to(folder).as_posix(): p.read_text(encoding="utf-8") for p in paths}
    made = {
        "README.md": lambda text: agreements(text, folder),
        "docs/architecture.md": lambda text: costs(text, known["docs/change-it.md"]),
        "docs/pipeline.md": described_targets,
        "docs/promises.md": promises,
    }
    renewed |= {name: COMMAND.sub(_tried, text) for name, text in known.items()}
    return renewed | {name: make(renewed[name]) for name, make in made.items()}


if __name__ == "__main__":
    try:
        for name, text in pages(".").items():
            Path(name).write_text(text, encoding="utf-8", newline="\n")
    except LookupError as error:
        sys.exit(str(error))
