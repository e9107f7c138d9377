"""The order of the house: which room may import which, and how much stands in each."""

import ast
import re
from functools import cache
from graphlib import CycleError, TopologicalSorter
from itertools import pairwise
from pathlib import Path

import pytest

import twodiscs

REPOSITORY = Path(__file__).parents[1]

#: The folder of the packages, and the packages.
ROOT = Path(twodiscs.__file__).parents[1]
PACKAGES = ("twodiscs", "twodiscs_paper")


def name_of(path):
    """Return the parts of the dotted name of the module in a file, as a tuple."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return parts[:-1] if parts[-1] == "__init__" else parts


#: {module: its file}.
FILES = {name_of(path): path for name in PACKAGES for path in sorted((ROOT / name).rglob("*.py"))}


@cache
def imports_of(module):
    """Return the modules of the packages that a module imports directly, also in functions."""
    found = set()
    for node in ast.walk(ast.parse(FILES[module].read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {tuple(alias.name.split(".")) for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            base = tuple(node.module.split("."))
            found |= {base, *((*base, alias.name) for alias in node.names)}
    packages = {(package,) for package in PACKAGES}
    return (found & FILES.keys()) - packages - {module[:depth] for depth in range(len(module))}


def entries(folder):
    """Return what stands in a folder of the packages, without what Python and tools put there."""
    return [
        path.name
        for path in folder.iterdir()
        if path.name not in ("__pycache__", "__init__.py") and not path.name.endswith(".egg-info")
    ]


def circle(graph):
    """Return a circle of imports in {name: names that it imports}, or nothing."""
    try:
        tuple(TopologicalSorter(graph).static_order())
    except CycleError as error:
        return tuple(reversed(error.args[1]))
    return ()


def imported_rooms():
    """Return {room: rooms that its modules import}; a room is a folder or module of a package."""
    found = {module[1]: set() for module in FILES if len(module) > 1}
    for module in FILES:
        if len(module) > 1:
            found[module[1]] |= {other[1] for other in imports_of(module)} - {module[1]}
    found["cli"] |= found.pop("__main__") - {"cli"}  # which calls it
    return found


def drawn_rooms():
    """Return {room: rooms with an arrow to it} in the drawing of docs/architecture.md."""
    page = (REPOSITORY / "docs" / "architecture.md").read_text(encoding="utf-8")
    (drawing,) = re.findall(r"```mermaid\n(.*?)```", page, re.DOTALL)
    arrows = re.findall(r"(\w+)(?:\[.*?\])? --> (\w+)", drawing)
    drawn = {room: set() for arrow in arrows for room in arrow}
    for source, target in arrows:
        drawn[target].add(source)
    return drawn


def test_the_drawing_shows_which_room_uses_which():
    used, drawn = imported_rooms(), drawn_rooms()
    assert drawn.keys() == used.keys()
    below = {}
    for room in TopologicalSorter(drawn).static_order():
        below[room] = drawn[room].union(*(below[other] for other in drawn[room]))
    assert [(other, room) for room in used for other in used[room] - below[room]] == []
    assert [(other, room) for room in drawn for other in drawn[room] - used[room]] == []


def test_the_library_imports_nothing_of_the_paper():
    upwards = [
        ".".join(module)
        for module in FILES
        if module[0] == "twodiscs" and any(t[0] != "twodiscs" for t in imports_of(module))
    ]
    assert upwards == []


def test_no_module_imports_itself_by_a_detour():
    graph = {module: set(imports_of(module)) - {module} for module in FILES}
    assert circle(graph) == ()


FOLDERS = sorted({module[:depth] for module in FILES for depth in range(1, len(module))})


@pytest.mark.parametrize("folder", FOLDERS, ids="/".join)
def test_what_stands_in_a_folder_imports_one_way(folder):
    """Two folders in it, or a folder and a module, do not import each other either."""
    depth, graph, said = len(folder) + 1, {}, {}
    for module in FILES:
        for target in imports_of(module):
            one, other = module[:depth], target[:depth]
            if one != other and one[:-1] == other[:-1] == folder:
                graph.setdefault(one, set()).add(other)
                said[one, other] = f"{'.'.join(module)} imports {'.'.join(target)}"
    found = [said[pair] for pair in pairwise(circle(graph))]
    assert not found, ", ".join(found)


def test_initial_files_hold_a_docstring_only():
    """An ``__init__`` that imports would make every edit rerun every job."""
    for path in ROOT.rglob("__init__.py"):
        if path.parent.parent != ROOT:  # the packages themselves, on which nothing depends
            body = ast.parse(path.read_text(encoding="utf-8")).body
            assert len(body) == 1, path
            assert isinstance(body[0], ast.Expr), path


def test_the_model_is_quick_to_import():
    """It takes the standard library alone: the Snakefile reads it, and so does the command line."""
    for path in (ROOT / "twodiscs/model").glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom):
                assert node.module.split(".")[0] not in ("numpy", "scipy", "numba"), path
            elif isinstance(node, ast.Import):
                assert {alias.name for alias in node.names}.isdisjoint(("numpy", "scipy", "numba"))


def test_tests_mirror_the_rooms():
    tests = REPOSITORY / "tests"
    folders = {path.parent.relative_to(tests).parts[0] for path in tests.glob("*/**/*.py")}
    packages = [ROOT / package for package in PACKAGES]
    rooms = {name for folder in packages for name in entries(folder) if (folder / name).is_dir()}
    assert rooms <= folders
    assert folders - rooms == {"workflow"}
