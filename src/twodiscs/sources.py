"""Which source files of this package a module is made of, read off its import statements.

The workflow lists them as inputs of its jobs, so that an edit reruns what it can change and nothing
else; compiled code is kept under their hash. Standard library only: the Snakefile imports this.
"""

import ast
from functools import cache
from hashlib import blake2b
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent


def imported(module):
    """Return the sorted paths of all files of this package that importing ``module`` may read.

    ``module`` is a dotted name below the package, "cli.dynamics" say. Imports are followed wherever
    they stand, in functions too, through ``__init__.py`` files and relative names; a module that is
    imported by a computed name is not seen. Raises ``ValueError`` for a name that is no module of
    this package.
    """
    name = tuple(module.split(".")) if isinstance(module, str) else ()
    if not name or not all(part.isidentifier() for part in name) or _file(name) is None:
        raise ValueError(f"module must be a module of {PACKAGE.name}, not {module!r}")
    found, queue = set(), [name]
    while queue:
        name = queue.pop()
        if name not in found:
            found.add(name)
            queue += _imports(name)
    return sorted(_file(name) for name in found)


def package_hash():
    """Return 32 hexadecimal digits that change with any edit of the sources of this package."""
    digest = blake2b(digest_size=16)
    for path in sorted(PACKAGE.rglob("*.py")):
        text = path.read_bytes()
        digest.update(f"{path.relative_to(PACKAGE).as_posix()} {len(text)}\n".encode() + text)
    return digest.hexdigest()


def _file(name):
    """Return the file of the module ``name``, a tuple of the parts below the package, or None."""
    path = PACKAGE.joinpath(*name)
    for candidate in (path / "__init__.py", path.with_name(path.name + ".py")):
        if path.is_relative_to(PACKAGE) and candidate.is_file():
            return candidate
    return None


@cache
def _imports(name):
    """Return the modules of this package that the module ``name`` imports, its parents included."""
    path = _file(name)
    parents = [name[:depth] for depth in range(len(name))]
    here = name if path.name == "__init__.py" else name[:-1]
    found = set(parents)
    for node in ast.walk(ast.parse(path.read_bytes(), filename=str(path))):
        if isinstance(node, ast.Import):
            targets = [_below_package(alias.name) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = _below_package(node.module or "")
            if node.level:
                base = here[: len(here) + 1 - node.level]
                base += tuple(node.module.split(".")) if node.module else ()
            targets = [] if base is None else [base, *((*base, a.name) for a in node.names)]
        else:
            continue
        for target in filter(None, targets):
            found.update(target[:depth] for depth in range(len(target) + 1))
    return [target for target in found if _file(target) is not None]


def _below_package(dotted):
    """Return the parts of an absolute module name below this package, None if it lies outside."""
    package, *parts = dotted.split(".")
    return tuple(parts) if package == PACKAGE.name else None
