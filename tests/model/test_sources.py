"""The files a module is made of, and their fingerprint: code counts, and nothing else."""

import io
import json
import os
import shutil
import subprocess
import sys
import tokenize
from pathlib import Path

import pytest

from twodiscs.model import sources

MODULES = {
    "__init__.py": "",
    "alone.py": "import math\nimport numpy.linalg\nfrom os import path\n",
    "absolute.py": "import twodiscs.alone\n",
    "renamed.py": "import twodiscs.pack.inner as i\n",
    "member.py": "from twodiscs import alone, VERSION\n",
    "name.py": "from twodiscs.alone import path\n",
    "relative.py": "from . import alone\n",
    "dotted.py": "from .pack.inner import x\n",
    "late.py": "def f():\n    from twodiscs import alone\n",
    "typed.py": "if TYPE_CHECKING:\n    from twodiscs import alone\n",
    "chain.py": "from twodiscs import absolute\n",
    "circle_a.py": "from twodiscs import circle_b\n",
    "circle_b.py": "from twodiscs import circle_a\n",
    "computed.py": "import importlib\nimportlib.import_module('twodiscs.' + 'alone')\n",
    "text.py": "'''import twodiscs.alone'''  # from twodiscs import alone\n",
    "pack/__init__.py": "from twodiscs.helper import h\n",
    "pack/inner.py": "from ..alone import path\nfrom . import sibling\n",
    "pack/sibling.py": "",
    "pack/up.py": "from .. import absolute\n",
    "helper.py": "",
}

CASES = {
    "alone": {"alone"},
    "absolute": {"absolute", "alone"},
    "renamed": {"renamed", "alone", "pack/__init__", "pack/inner", "pack/sibling", "helper"},
    "member": {"member", "alone"},
    "name": {"name", "alone"},
    "relative": {"relative", "alone"},
    "dotted": {"dotted", "alone", "pack/__init__", "pack/inner", "pack/sibling", "helper"},
    "late": {"late", "alone"},
    "typed": {"typed", "alone"},
    "chain": {"chain", "absolute", "alone"},
    "circle_a": {"circle_a", "circle_b"},
    "computed": {"computed"},
    "text": {"text"},
    "pack": {"pack/__init__", "helper"},
    "pack.sibling": {"pack/__init__", "pack/sibling", "helper"},
    "pack.up": {"pack/__init__", "pack/up", "helper", "absolute", "alone"},
}


@pytest.fixture
def place(monkeypatch):
    """Return a function that reads packages from a folder, or clears its cache."""

    def look_at(folder):
        monkeypatch.setattr(sources, "ROOT", folder)
        for known in (sources._file, sources._imports, sources._read, sources.fingerprint):
            known.cache_clear()

    real = sources.ROOT
    yield look_at
    look_at(real)


@pytest.fixture
def package(tmp_path, place):
    root = tmp_path / "twodiscs"
    for name, text in MODULES.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    place(tmp_path)
    return root


@pytest.mark.parametrize("module", CASES)
def test_imports_are_followed(package, module):
    expected = {f"{name}.py" for name in CASES[module]}
    found = sources.imported(f"twodiscs.{module}")
    assert {path.relative_to(package).as_posix() for path in found} == expected
    assert found == sorted(found)


@pytest.mark.parametrize(
    "module",
    [
        "",
        "alone",
        "twodiscs.nothing",
        "twodiscs.pack.nothing",
        "..alone",
        "twodiscs.alone.py",
        "os",
        None,
        3,
    ],
)
def test_unknown_module_is_an_error(package, module):
    for function in (sources.imported, sources.fingerprint):
        with pytest.raises(
            ValueError, match="module must be a module of twodiscs or twodiscs_paper"
        ):
            function(module)


def test_modules_are_left_out_with_what_only_they_import(package):
    found = sources.imported("twodiscs.chain", "twodiscs.pack.inner", without=["twodiscs.pack"])
    assert {path.relative_to(package).as_posix() for path in found} == {
        *("chain.py", "absolute.py", "alone.py", "pack/inner.py", "pack/sibling.py"),
    }
    both = sources.imported("twodiscs.chain", without=["twodiscs.alone", "twodiscs.helper"])
    assert both == sources.imported("twodiscs.chain", without=["twodiscs.alone"])
    with pytest.raises(ValueError, match=r"module must be a module of .*, not 'nothing'"):
        sources.imported("twodiscs.chain", without=["nothing"])


def test_modules_and_what_the_code_of_one_imports(package):
    assert sources.modules()[:2] == [("twodiscs",), ("twodiscs", "absolute")]
    assert {("twodiscs", "pack"), ("twodiscs", "pack", "inner")} < {*sources.modules()}
    assert len(sources.modules()) == len(MODULES)
    # Its parents are imported too, but not by its code.
    assert sorted(sources.imports_of(("twodiscs", "pack", "inner"))) == [
        ("twodiscs", "alone"),
        ("twodiscs", "pack", "sibling"),
    ]


# Fingerprints -------------------------------------------------------------------------------------

TEXT = '''
"""About # this module."""
from dataclasses import dataclass

LIMIT = 3  # at most
MARK = "#" + '#' + f"# {LIMIT} #" + """two # lines
# of them"""
"""What LIMIT and MARK are."""

# A remark, é.
@dataclass
class Table:
    'A table.'

    radius: float
    """radius of the discs"""

    def write(self):
        """Write # it.

        Over lines.
        """
        return "é", "#"  # both


def empty(): "Nothing."
'''

#: Edits of ``TEXT``: the old text and the new one.
NO_CODE = [
    ("# at most", ""),
    ("# at most", "# at least 'this'"),
    ("# A remark, é.\n", ""),
    ("3  # at", "3# at"),
    ("\n\ndef", "\n\n\n\n# new\ndef"),
    ('"""About # this module."""\n', ""),
    ("'A table.'", '"""Another table, over\n    two lines."""'),
    ('"""radius of the discs"""', "'radius of disc 1'"),
    ('    """radius of the discs"""\n', ""),
    ('"""What LIMIT and MARK are."""\n', ""),
    ("Over lines.", "Over more\n\n        lines."),
    ("# both", "# both, é"),
    ('"Nothing."', '"Nothing at all."'),
]
CODE = [
    ("LIMIT = 3", "LIMIT = 4"),
    ('"#" +', '"" +'),
    ("'#' +", "'# ' +"),
    ("# {LIMIT} #", "# {LIMIT}"),
    ("two # lines", "two # line"),
    ("# of them", "# of us"),
    ('"é", "#"', '"é", "# both"'),
    ("radius: float", "radius: int"),
    ("@dataclass\n", ""),
    ("return", "yield"),
]


@pytest.fixture
def print_of(package, place):
    """Return a function: the fingerprint of ``chain``, in which ``alone`` has a text."""

    def fingerprint(text):
        (package / "alone.py").write_text(text, encoding="utf-8")
        place(package.parent)
        return sources.fingerprint("twodiscs.chain")

    return fingerprint


@pytest.mark.parametrize(("old", "new"), NO_CODE)
def test_what_is_no_code_leaves_the_fingerprint(print_of, old, new):
    assert TEXT.count(old) == 1
    assert print_of(TEXT.replace(old, new)) == print_of(TEXT)


@pytest.mark.parametrize(("old", "new"), CODE)
def test_what_is_code_changes_the_fingerprint(print_of, old, new):
    assert TEXT.count(old) == 1
    assert print_of(TEXT.replace(old, new)) != print_of(TEXT)


def test_fingerprints_follow_imports_and_names_and_see_no_time_stamps(package, place):
    def now(*modules):
        place(package.parent)
        return sources.fingerprint(*(f"twodiscs.{module}" for module in modules))

    before = {name: now(name) for name in CASES}
    assert len(before["chain"]) == 16
    assert sources.fingerprint("twodiscs.chain", without=("twodiscs.alone",)) != before["chain"]
    assert now("chain", "absolute") == now("absolute", "chain") == before["chain"]
    os.utime(package / "alone.py", (1, 1))
    assert {name: now(name) for name in CASES} == before
    # Nothing depends on the face, though it is imported with every module.
    (package / "__init__.py").write_text("from twodiscs import alone\n")
    assert {name: now(name) for name in CASES} == before
    (package / "alone.py").write_text("import math\n")
    os.utime(package / "alone.py", (1, 1))
    changed = {name for name in CASES if now(name) != before[name]}
    assert changed == {name for name, files in CASES.items() if "alone" in files}
    # The same text under another name is another program.
    (package / "pack" / "sibling.py").rename(package / "pack" / "brother.py")
    assert now("pack.brother") != before["pack.sibling"]


def without_comments(text):
    """Return Python source without its comments."""
    lines = text.splitlines(keepends=True)
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            row, column = token.start
            lines[row - 1] = lines[row - 1][:column] + "\n"
    return "".join(lines)


def all_modules():
    return [".".join(name) for name in sources.modules()]


@pytest.mark.slow
def test_no_comment_of_this_package_is_taken_for_code(tmp_path, place):
    """A second method: here the tokenizer finds the comments, there it is the syntax tree."""
    before = sources.fingerprint(*all_modules())
    for name in sources.PACKAGES:
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(sources.ROOT / name, tmp_path / name, ignore=ignored)
    cut = 0
    for path in tmp_path.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        path.write_text(without_comments(text), encoding="utf-8")
        cut += without_comments(text) != text
    place(tmp_path)
    assert cut > 20
    assert sources.fingerprint(*all_modules()) == before


def other_python():
    """Return the path of another version of Python that is new enough, None if none is found."""
    own, question = sys.version_info[:2], "import sys; print(*sys.version_info[:2])"
    for minor in range(11, 20):
        found = Path.home().glob(f".pyenv/versions/3.{minor}.*/bin/python")
        for path in filter(None, [shutil.which(f"python3.{minor}"), *found]):
            run = subprocess.run([path, "-c", question], capture_output=True, check=False)
            if run.returncode == 0 and tuple(map(int, run.stdout.split())) != own:
                return path
    return None


def test_fingerprints_are_the_same_for_another_version_of_python():
    python = other_python()
    if python is None:
        pytest.skip("there is no other version of Python")
    code = (
        "import json, sys; from twodiscs.model import sources\n"
        "print(json.dumps({name: sources.fingerprint(name) for name in sys.argv[1:]}))"
    )
    run = subprocess.run(
        [python, "-c", code, *all_modules()],
        env=os.environ | {"PYTHONPATH": str(sources.ROOT)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert json.loads(run.stdout) == {name: sources.fingerprint(name) for name in all_modules()}


def test_what_python_really_imports_is_listed():
    """A second method: import a module in a new interpreter and list the loaded modules."""
    code = (
        "import sys, twodiscs.dynamics.counting\n"
        "print(*(m.__file__ for n, m in sys.modules.items() if n.split('.')[0] == 'twodiscs'))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = {Path(name).resolve() for name in run.stdout.split()}
    face = sources.ROOT / "twodiscs" / "__init__.py"
    assert loaded <= {face, *sources.imported("twodiscs.dynamics.counting")}


def test_standard_library_only():
    code = "import sys, twodiscs.model.sources; print(*sys.modules)"
    run = subprocess.run(
        [
            sys.executable,
            "-S",
            "-c",
            f"import sys; sys.path.insert(0, {str(sources.ROOT)!r}); {code}",
        ],
        capture_output=True,
        text=True,
        check=True,
    )
    assert "twodiscs.model.sources" in run.stdout.split()
