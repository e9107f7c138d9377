"""The files a module is made of, and the hash of all of them."""

import subprocess
import sys
from pathlib import Path

import pytest

from twodiscs.pipeline import sources

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
def package(tmp_path, monkeypatch):
    root = tmp_path / "twodiscs"
    for name, text in MODULES.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    monkeypatch.setattr(sources, "PACKAGE", root)
    sources._imports.cache_clear()
    yield root
    sources._imports.cache_clear()


@pytest.mark.parametrize("module", CASES)
def test_imports_are_followed(package, module):
    expected = {"__init__.py"} | {f"{name}.py" for name in CASES[module]}
    found = sources.imported(module)
    assert {path.relative_to(package).as_posix() for path in found} == expected
    assert found == sorted(found)


@pytest.mark.parametrize("module", ["", "nothing", "pack.nothing", "..alone", "alone.py", None, 3])
def test_unknown_module_is_an_error(package, module):
    with pytest.raises(ValueError, match="module must be a module of twodiscs"):
        sources.imported(module)


def test_hash_sees_every_edit(package):
    seen = {sources.package_hash()}
    assert sources.package_hash() in seen
    (package / "alone.py").touch()
    assert sources.package_hash() in seen
    for edit in (
        lambda: (package / "alone.py").write_text(MODULES["alone.py"] + "# a comment\n"),
        lambda: (package / "pack" / "more.py").write_text(""),
        lambda: (package / "helper.py").rename(package / "pack" / "helper.py"),
    ):
        edit()
        assert sources.package_hash() not in seen
        seen.add(sources.package_hash())
    (package / "notes.txt").write_text("no source")
    assert sources.package_hash() in seen


def test_what_python_really_imports_is_listed():
    """A second method: import a module in a fresh interpreter and look at what was loaded."""
    code = (
        "import sys, twodiscs.dynamics\n"
        "print(*(m.__file__ for n, m in sys.modules.items() if n.split('.')[0] == 'twodiscs'))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = {Path(name).resolve() for name in run.stdout.split()}
    assert loaded <= set(sources.imported("dynamics"))


def test_standard_library_only():
    code = "import sys, twodiscs.sources; print(*sys.modules)"
    run = subprocess.run(
        [
            sys.executable,
            "-S",
            "-c",
            f"import sys; sys.path.insert(0, {str(sources.PACKAGE.parent)!r}); {code}",
        ],
        capture_output=True,
        text=True,
        check=True,
    )
    assert "twodiscs.sources" in run.stdout.split()
