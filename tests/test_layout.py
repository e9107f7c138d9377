"""The order of imports, and the drawing of it.

Without these tests imports could point upwards, and the drawing of it could be wrong.
"""

import ast
import re
from functools import cache
from graphlib import TopologicalSorter
from itertools import takewhile

from checkout import REPOSITORY

ROOT, PACKAGES = REPOSITORY / "src", ("twodiscs", "twodiscs_paper")


def name_of(path):
    """Return the parts of the dotted name of the module in a file, as a tuple."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return parts[:-1] if parts[-1] == "__init__" else parts


#: {module: its file}.
FILES = {name_of(path): path for name in PACKAGES for path in sorted((ROOT / name).rglob("*.py"))}


def imported_modules(path):
    """Return the modules of the packages that a file imports directly, also in functions."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {tuple(alias.name.split(".")) for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            base = tuple(node.module.split("."))
            found |= {base, *((*base, alias.name) for alias in node.names)}
    return (found & FILES.keys()) - {(package,) for package in PACKAGES}


@cache
def imports_of(module):
    """Return the modules that a module imports, without the packages that it is in."""
    return imported_modules(FILES[module]) - {module[:depth] for depth in range(len(module))}


def test_the_drawing_shows_which_room_uses_which():
    """A room is a folder or module of a package, an arrow of the page reads "is used by"."""
    used = {module[1]: set() for module in FILES if len(module) > 1}
    for module in FILES:
        if len(module) > 1:
            used[module[1]] |= {other[1] for other in imports_of(module)} - {module[1]}
    used["cli"] |= used.pop("__main__") - {"cli"}  # which calls it
    page = (REPOSITORY / "docs/architecture.md").read_text(encoding="utf-8")
    (drawing,) = re.findall(r"```mermaid\n(.*?)```", page, re.DOTALL)
    arrows = re.findall(r"(\w+)(?:\[.*?\])? --> (\w+)", drawing)
    drawn = {room: {one for one, other in arrows if other == room} for room in used}
    assert {room for arrow in arrows for room in arrow} == used.keys()
    below = {}
    for room in TopologicalSorter(drawn).static_order():
        below[room] = drawn[room].union(*(below[other] for other in drawn[room]))
    assert [(other, room) for room in used for other in used[room] - below[room]] == []
    assert [(other, room) for room in drawn for other in drawn[room] - used[room]] == []


def test_what_stands_in_a_folder_imports_one_way():
    """Neither do two packages, two folders or a folder and a module import each other."""
    graph = {}
    for module in FILES:
        for target in imports_of(module):
            same = takewhile(lambda pair: pair[0] == pair[1], zip(module, target, strict=False))
            depth = len([*same]) + 1
            if len(module) >= depth:
                graph.setdefault(module[:depth], set()).add(target[:depth])
    TopologicalSorter(graph).prepare()


def test_what_is_kept_cannot_be_set():
    """Scenes, points, results and the tables of studies, with all their parts, are frozen."""
    text = "\n".join(path.read_text(encoding="utf-8") for path in FILES.values())
    assert {"frozen=True" in line for line in re.findall(r"@dataclass.*", text)} == {True}


def test_initial_files_hold_a_docstring_only():
    """An ``__init__`` that imports would make every edit rerun every job."""
    for path in ROOT.rglob("__init__.py"):
        if path.parent.parent != ROOT:  # the packages themselves, on which nothing depends
            (docstring,) = ast.parse(path.read_text(encoding="utf-8")).body
            assert isinstance(docstring, ast.Expr), path
