"""The source files that a module of these packages imports, and a fingerprint of them.

The workflow passes fingerprints to its jobs, so that an edit reruns only the jobs that it can
change. Fingerprints follow the import statements; they do not depend on comments, docstrings or
time stamps. This module needs only the standard library, because the Snakefile imports it.
"""

import ast
import re
from functools import cache
from hashlib import blake2b
from pathlib import Path

from twodiscs.model.checks import InputError

#: The folder of the packages, and the packages whose sources count.
ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("twodiscs", "twodiscs_paper")

#: A string, which is kept, or a comment.
STRING_OR_COMMENT = re.compile(
    rb"""("{3}(?:\\.|[^\\])*?"{3}|'{3}(?:\\.|[^\\])*?'{3}"""
    rb"""|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*')|#[^\n]*""",
    re.DOTALL,
)


def imported(*modules, without=()):
    """Return the sorted paths of all files of ``PACKAGES`` that an import of ``modules`` may read.

    Modules are dotted names, such as "twodiscs.dynamics.counting". All import statements are
    followed, also in functions, through ``__init__.py`` files and with relative names. A module
    that is imported by a computed name is not followed. Modules in ``without`` are left out, with
    the modules that only they import. Raises ``InputError`` for a name that is no module of
    ``PACKAGES``.
    """
    left_out, queue = {_parts(module) for module in without}, list(map(_parts, modules))
    collected = set()
    while queue:
        name = queue.pop()
        if name not in collected | left_out:
            collected.add(name)
            queue += _imports(name)
    return sorted(_file(name) for name in collected)


def _parts(module):
    """Return the parts of the dotted name of a module."""
    name = tuple(module.split(".")) if isinstance(module, str) else ()
    if not all(part.isidentifier() for part in name) or _file(name) is None:
        raise InputError(f"module must be a module of {' or '.join(PACKAGES)}, not {module!r}")
    return name


def modules():
    """Return all modules of ``PACKAGES``, sorted: the parts of their dotted names, as tuples."""
    found = (path for package in PACKAGES for path in (ROOT / package).rglob("*.py"))
    paths = (path.relative_to(ROOT).with_suffix("") for path in found)
    return sorted(p.parts[:-1] if p.name == "__init__" else p.parts for p in paths)


def imports_of(module):
    """Return the modules that a module imports directly, named as by ``modules``."""
    parents = {module[:depth] for depth in range(1, len(module) + 1)}
    return [name for name in _imports(module) if name not in parents]


@cache
def fingerprint(*modules, without=()):
    """Return 16 hexadecimal digits that change with the code of ``modules`` and of their imports.

    ``without``, a tuple, and errors are as in ``imported``.
    """
    digest = blake2b(digest_size=8)
    for path in imported(*modules, without=without):
        digest.update(f"{path.relative_to(ROOT).as_posix()} {_read(path)[0]}\n".encode())
    return digest.hexdigest()


@cache
def _file(name):
    """Return the file of the module ``name``, a tuple of parts, or None."""
    if not name or name[0] not in PACKAGES:
        return None
    path = ROOT.joinpath(*name)
    files = (path / "__init__.py", path.with_name(path.name + ".py"))
    return next((file for file in files if file.is_file()), None)


@cache
def _read(path):
    """Return (hash of a source without comments, docstrings and blank lines, its imports).

    The hash is of the text, not of the syntax tree, whose form depends on the version of Python.
    Strings that are whole statements are docstrings, also of attributes. Imports are triples
    (dotted module, number of leading dots, names).
    """
    text = path.read_bytes()
    lines, imports = text.splitlines(), []
    queue = [ast.parse(text, filename=str(path))]
    while queue:  # of statements only: a walk through expressions doubles the time
        node = queue.pop()
        for block in ("body", "orelse", "finalbody", "handlers", "cases"):
            queue += getattr(node, block, ())
        if isinstance(node, ast.Expr) and _is_text(node.value):
            _cut(lines, node)
        elif isinstance(node, ast.Import):
            imports += [(alias.name, 0, []) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            imports.append((node.module or "", node.level, [alias.name for alias in node.names]))
    code = STRING_OR_COMMENT.sub(rb"\1", b"\n".join(lines)).splitlines()
    code = b"\n".join(line.rstrip() for line in code if line.strip())
    return blake2b(code, digest_size=8).hexdigest(), imports


def _is_text(node):
    return isinstance(node, ast.Constant) and isinstance(node.value, str | bytes)


def _cut(lines, node):
    """Remove the text of a ``node`` from ``lines``."""
    first, last = node.lineno - 1, node.end_lineno - 1
    before, after = lines[first][: node.col_offset], lines[last][node.end_col_offset :]
    lines[first : last + 1] = [before + after] + [b""] * (last - first)


@cache
def _imports(name):
    """Return the modules of ``PACKAGES`` that the module ``name`` imports, and its parents.

    The packages themselves are left out: every module imports them, and none depends on them.
    """
    path = _file(name)
    here = name if path.name == "__init__.py" else name[:-1]
    imported = {name[:depth] for depth in range(2, len(name))}
    for module, level, names in _read(path)[1]:
        base = tuple(module.split("."))
        if level:
            base = here[: len(here) + 1 - level] + (base if module else ())
        for target in (base, *((*base, name) for name in names)):
            imported.update(target[:depth] for depth in range(2, len(target) + 1))
    return [target for target in imported if _file(target) is not None]
