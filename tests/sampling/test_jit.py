"""Compiled kernels: which are kept, and what compilation leaves as it was.

Without these tests compiled code could be that of other sources, or change a user's process.
"""

import compileall
import errno
import os
import shutil
from pathlib import Path
from unittest.mock import Mock

import pytest
from commands import python

from twodiscs.dynamics import law
from twodiscs.sampling import jit

SCRIPT = """
import numpy as np
from twodiscs.sampling.conditioned import draw_in_disc
print(draw_in_disc(np.array([1, 2, 3, 1 << 60], np.uint64)))
"""


def output(environment, script=SCRIPT):
    return python("-c", script, env=environment, check=True).stdout


def test_an_edit_of_what_a_kernel_imports_changes_the_result(tmp_path):
    """Numba alone would go on as before: the file of the kernel is the same.

    The edited file has the size and the time of the old one, as from an archive with fixed times.
    A user's choice of where Numba keeps code is kept.
    """
    sources, cache = tmp_path / "twodiscs", tmp_path / "cache"
    ignore = shutil.ignore_patterns("__pycache__")
    shutil.copytree(Path(law.__file__).parents[1], sources, ignore=ignore)
    environment = os.environ | {
        "PYTHONPATH": str(tmp_path),
        "NUMBA_CACHE_DIR": str(cache),
        "NUMBA_CACHE_LOCATOR_CLASSES": "InTreeCacheLocator",
        "PYTHONDONTWRITEBYTECODE": "1",
    }
    before = output(environment)

    def kernels():
        return {path: path.stat().st_mtime_ns for path in cache.rglob("*.nb?")}

    kept = kernels()
    assert any("draw_in_disc" in path.name for path in kept)
    # What Python compiles beside the sources, and stubs, are no part of them.
    (sources / "sampling/__pycache__").mkdir()
    for name in ("sampling/__pycache__/jit.pyc", "sampling/jit.pyi"):
        (sources / name).touch()
    assert output(environment) == before
    assert kernels() == kept

    streams = sources / "sampling" / "streams.py"
    status, text = streams.stat(), streams.read_text()
    edited = text.replace("UNIT = 2.0**-53", "UNIT = 2.0**-54")
    assert len(edited) == len(text)
    streams.write_text(edited)
    os.utime(streams, ns=(status.st_atime_ns, status.st_mtime_ns))
    after = output(environment)
    assert after != before

    # In a small image only compiled modules lie.
    for version, result in ((edited, after), (text, before)):
        streams.write_text(version)
        compileall.compile_dir(sources, quiet=2, legacy=True, force=True)
        for path in sources.rglob("*.py"):
            path.rename(path.with_suffix(".was"))
        assert output(environment) == result
        for path in sources.rglob("*.was"):
            path.rename(path.with_suffix(".py"))


def test_if_no_code_can_be_kept_one_sentence_says_so(tmp_path, monkeypatch, capsys):
    """A file is in the way of the folder, the disk is full, or files were cut."""

    def said():
        jit._warn_not_kept.cache_clear()
        kernels = map(jit.compiled, (law.crosses.py_func, law.crossing_time.py_func))
        assert [kernel(0.5, -0.5) for kernel in kernels] == [True, 1.0]
        return capsys.readouterr().err

    (blocked := tmp_path / "file").touch()
    with monkeypatch.context() as patch:
        patch.setattr(jit.numba.config, "CACHE_DIR", str(blocked))
        patch.setattr(jit, "cache_folder", jit.cache_folder.__wrapped__)
        found = [said()]
    monkeypatch.setattr(jit, "cache_folder", lambda package: str(tmp_path))
    with monkeypatch.context() as patch:
        full = Mock(side_effect=OSError(errno.ENOSPC, "No space left on device"))
        patch.setattr(jit.caching.IndexDataCacheFile, "_save_data", full)
        found.append(said())
    assert said() == ""
    for path in tmp_path.rglob("*.nb?"):
        os.truncate(path, 9)
    for sentence in (*found, said()):
        assert sentence.startswith("Compiled code cannot be kept, so every process compiles again")
        assert sentence.count("\n") == 1


def test_two_processes_that_save_together_keep_their_kernels_apart(tmp_path, monkeypatch):
    """The second one reads the index before the first one writes it, and saves its kernel first."""
    monkeypatch.setattr(jit, "cache_folder", lambda package: str(tmp_path))
    first, second, found = (jit.inlined(law.crosses.py_func)._cache._cache_file for _ in range(3))
    save = first._save_data

    def save_later(name, data):
        second.save("another signature", "another kernel")
        save(name, data)

    monkeypatch.setattr(second, "_load_index", dict)
    monkeypatch.setattr(first, "_save_data", save_later)
    first.save("one signature", "one kernel")
    assert found.load("another signature") == "another kernel"
    assert found.load("one signature") in (None, "one kernel")


@pytest.mark.parametrize(("given", "folder"), [("kept", ".cache"), ("~/kept", "kept")])
def test_a_relative_cache_folder_is_ignored(given, folder, tmp_path, monkeypatch):
    """As the XDG standard says; ~ is the home."""
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("XDG_CACHE_HOME", given)
    monkeypatch.setattr(jit.numba.config, "CACHE_DIR", "")
    assert Path(jit.cache_folder.__wrapped__("twodiscs")).parent == tmp_path / folder / "twodiscs"


def test_vectors_are_as_wide_as_the_processor_has_them_unless_a_user_chooses():
    script = "from twodiscs.sampling import jit; print(jit.numba.config.CPU_FEATURES)"
    script += "; print('-prefer-256' in jit.cpu_target.target_context.codegen()._tm_features)"
    assert output(os.environ | {"NUMBA_CPU_FEATURES": "+sse2"}, script) == "+sse2\nFalse\n"
    assert output(os.environ, script) == f"None\n{jit.features.get('avx512f', False)}\n"


def test_without_a_compiler_there_are_no_kernels_and_a_sentence_says_so():
    words = ["twodiscs.cli", "simulate", "--width=1.5", "--height=1", "--radius=.2", "--error=.1"]
    done = python("-m", *words, env=os.environ | {"NUMBA_DISABLE_JIT": "1"})
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("error: NUMBA_DISABLE_JIT must not be set: ")
    assert done.stderr.count("\n") == 1


def test_kernels_start_without_linear_algebra_and_those_of_a_user_are_as_before(tmp_path):
    """A user's own kernel has linear algebra, and is kept in the folder of its module."""
    own = "import numba, numpy\n@numba.njit(cache=True)\ndef f(a): return numpy.dot(a, a.T)\n"
    (tmp_path / "own.py").write_text(own)
    script = f"""
import sys
from twodiscs.model.scene import Box
from twodiscs.dynamics.engine import find_engine
scene = Box(1.5, 1.0).scene(0.2)
find_engine(scene).counts.run_blocks(scene, ("any_wall",), 1, 0, 0, 1.0)
print("scipy.linalg" in sys.modules)
import numpy as np
import scipy.linalg.cython_blas
sys.path.insert(0, {str(tmp_path)!r})
import own
a = np.arange(12.0).reshape(3, 4) ** 1.5
print(np.allclose(own.f(a), own.f.py_func(a), rtol=1e-9, atol=0), own.f._cache.cache_path)
"""
    environment = {name: value for name, value in os.environ.items() if "NUMBA" not in name}
    assert output(environment, script).split() == ["False", "True", str(tmp_path / "__pycache__")]


def test_inlined_functions_are_kept_but_those_within_a_function():
    """Several kernels have them. Two lambdas have one name, and bytecode that may be the same.

    A call from Python would crash with the code that is kept for kernels.
    """
    once, again = (jit.inlined(law.crosses.py_func) for _ in range(2))
    assert jit.compiled(lambda: once(-1.0, 1.0))()
    assert jit.compiled(lambda: again(-1.0, 1.0))()
    assert again.stats.cache_hits
    assert again(-1.0, 1.0)

    first, second = (lambda x: x + 1.0), (lambda x: x + 2.0)
    for function in (first, second):
        function.__module__ = law.__name__
    one, other = jit.inlined(first), jit.inlined(second)
    assert jit.compiled(lambda x: (one(x), other(x)))(1.0) == (2.0, 3.0)
