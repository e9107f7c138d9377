"""Compiled code is kept, and never used for other sources than its own."""

import json
import os
import shutil
import subprocess
import sys
from importlib import import_module
from inspect import iscode
from pathlib import Path
from types import FunctionType

import numpy as np
import pytest

import twodiscs
from twodiscs.dynamics import law
from twodiscs.model.sources import fingerprint, imported, imports_of, modules
from twodiscs.sampling import jit, streams

SCRIPT = """
import numpy as np
from twodiscs.sampling.separations import draw_velocity
from twodiscs.sampling.streams import open_stream
print(draw_velocity(open_stream(np.uint64(1), 0)))
"""


@pytest.fixture
def package(tmp_path):
    """A copy of the package to edit, and an environment that uses it with an empty cache."""
    shutil.copytree(
        Path(twodiscs.__file__).parent, tmp_path / "twodiscs",
        ignore=shutil.ignore_patterns("__pycache__"),
    )  # fmt: skip
    environment = os.environ | {
        "PYTHONPATH": str(tmp_path),
        "NUMBA_CACHE_DIR": str(tmp_path / "cache"),
        "PYTHONDONTWRITEBYTECODE": "1",
    }
    return tmp_path / "twodiscs", environment


def start(environment):
    return subprocess.Popen(
        [sys.executable, "-c", SCRIPT], env=environment, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip


def output(process):
    out, error = process.communicate(timeout=120)
    assert process.returncode == 0, error
    return out


def test_an_edit_of_what_a_kernel_imports_changes_the_result(package):
    """However old the edited file says it is. Numba alone would go on as before."""
    sources, environment = package
    # Two that find the cache empty do not race.
    before, same = map(output, [start(environment), start(environment)])
    assert same == before

    def kernels():
        cache = sources.parent / "cache"
        return {path: path.stat().st_mtime_ns for path in cache.rglob("*.nb?")}

    kept = kernels()
    assert any("draw_velocity" in path.name for path in kept)
    # The same sources elsewhere need no compiling, nor do other words about them.
    moved = shutil.copytree(sources.parent, sources.parents[1] / "elsewhere") / "twodiscs"
    streams = moved / "sampling" / "streams.py"
    text = streams.read_text()
    streams.write_text(text.replace('"""Random numbers', '# A word.\n"""More\n\nrandom numbers'))
    assert streams.read_text() != text
    assert output(start(environment | {"PYTHONPATH": str(moved.parent)})) == before
    assert kernels() == kept

    streams = sources / "sampling" / "streams.py"
    stamp, text = streams.stat().st_mtime, streams.read_text()
    edited = text.replace("UNIT = 2.0**-53", "UNIT = 2.0**-54")
    assert len(edited) == len(text)
    assert edited != text
    streams.write_text(edited)
    os.utime(streams, (stamp - 1000, stamp - 1000))
    assert output(start(environment)) != before


def test_two_processes_give_their_kernels_files_of_their_own(package):
    """Else one of them could find the kernel of the other where it looks for its own."""
    _, environment = package
    script = """
from twodiscs.sampling.streams import uniform
print(uniform._cache._cache_file._data_name(1))
"""
    first, second = (finished(environment, script).stdout for _ in range(2))
    assert first.startswith("streams.uniform")
    assert first != second


DAMAGES = {
    "empty": lambda content: b"",
    "cut short": lambda content: content[: len(content) // 2],
}


@pytest.mark.parametrize("damage", DAMAGES)
@pytest.mark.parametrize("ending", ["nbi", "nbc"])
def test_a_damaged_file_costs_a_line_and_a_compilation(kept_splitmix, ending, damage):
    """A power cut or a full disk leaves such files, and no job may stop because of them."""
    environment, before = kept_splitmix
    files = [*Path(environment["NUMBA_CACHE_DIR"]).glob(f"kernels-*/*splitmix*.{ending}")]
    assert files
    for file in files:
        file.write_bytes(DAMAGES[damage](file.read_bytes()))
    done = finished(environment, SPLITMIX)
    assert done.stdout == before
    assert done.stderr.endswith(".nbi is damaged; the kernel is compiled again\n")
    assert done.stderr.count("\n") == 1
    again = finished(environment, SPLITMIX)  # from what was kept in its place
    assert (again.stdout, again.stderr) == (before, "")


def test_a_kernel_that_cannot_be_kept_is_used(package):
    _, environment = package
    full = "import errno\ndef full(*_): raise OSError(errno.ENOSPC, 'No space left on device')\n"
    full += "from twodiscs.sampling import jit\njit.caching.IndexDataCacheFile.save = full\n"
    done = finished(environment, full + SPLITMIX)
    assert done.stdout == finished(environment, SPLITMIX).stdout
    assert done.stderr.endswith(".nbi cannot be kept: No space left on device\n")
    assert done.stderr.count("\n") == 1


SPLITMIX = "import numpy as np; from twodiscs.sampling import streams\n"
SPLITMIX += "print(hex(streams.splitmix(np.uint64(0x9E3779B97F4A7C15))))"


@pytest.fixture(scope="module")
def kept_splitmix(tmp_path_factory):
    """An environment with one kernel in its cache, and what that prints."""
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path_factory.mktemp("cache"))}
    return environment, finished(environment, SPLITMIX).stdout


def kernels():
    """Return {name: function} of all functions of the library that are compiled and kept."""
    found = {}
    for parts in modules():
        if parts[0] == "twodiscs" and ("twodiscs", "sampling", "jit") in imports_of(parts):
            for value in vars(import_module(".".join(parts))).values():
                if getattr(value, "_cache", None) and value.__module__ == ".".join(parts):
                    found[f"{value.__module__}.{value.__name__}"] = value.py_func
    return found


def modules_in(function):
    """Return the modules of all functions that are compiled into a ``function``, at any depth."""
    known, queue = set(), [function]
    while queue:
        function = queue.pop()
        if function not in known and isinstance(function, FunctionType):
            known.add(function)
            codes = [function.__code__, *filter(iscode, function.__code__.co_consts)]
            named = (function.__globals__.get(name) for code in codes for name in code.co_names)
            within = (cell.cell_contents for cell in function.__closure__ or ())
            queue += [getattr(part, "py_func", part) for part in (*named, *within)]
    return {part.__module__ for part in known if part.__module__.startswith("twodiscs.")}


def test_a_kernel_is_kept_by_all_that_is_compiled_into_it():
    """Otherwise an edit of the event law would leave old kernels in use."""
    with_law = 0
    for name, function in kernels().items():
        within = modules_in(function)
        with_law += "twodiscs.dynamics.law" in within
        files = {*imported(function.__module__)}
        for module in within:
            assert {*imported(module)} <= files, f"{name} has {module} in it"
        folder = jit.cache_folder(function.__module__).name
        assert folder == f"kernels-{fingerprint(function.__module__)}", name
    assert with_law >= 6


def test_old_caches_of_this_package_go_and_nothing_else(package):
    sources, environment = package
    home = sources.parent / "cache"
    names = [f"kernels-{i:016x}" for i in range(3)]
    for name in (*names, others := "kernels-project1"):
        (home / name).mkdir(parents=True)
        os.utime(home / name, (0, 0))
    os.utime(home / names[0])
    assert cache_folder(environment).parent == home
    left = {path.name for path in home.iterdir()}
    assert {names[0], others} < left
    assert left.isdisjoint(names[1:])


def finished(environment, script):
    return subprocess.run(
        [sys.executable, "-c", script], env=environment, text=True, capture_output=True, check=True
    )


def cache_folder(environment):
    """Return where a process keeps the kernels of the streams, None where nowhere."""
    script = """
from twodiscs.sampling import jit, streams
print(streams.uniform._cache.cache_path if jit.cache_home() else None)
"""
    done = finished(environment, script)
    assert (done.stderr != "") == (done.stdout == "None\n")
    return None if done.stdout == "None\n" else Path(done.stdout.rstrip())


def test_where_one_folder_cannot_be_made_another_is_taken_or_a_sentence_says_so(package):
    sources, environment = package
    blocked = sources.parent / "file"
    blocked.touch()
    environment |= {"NUMBA_CACHE_DIR": str(blocked / "below")}
    name = f"kernels-{fingerprint('twodiscs.sampling.streams')}"
    assert cache_folder(environment) == sources / "__pycache__" / name
    shutil.rmtree(sources / "__pycache__")
    (sources / "__pycache__").touch()
    assert cache_folder(environment) is None
    assert output(start(environment)).startswith("(")  # compiled all the same


def test_a_users_choice_of_processor_wins(package):
    _, environment = package
    script = "import twodiscs.sampling.jit, os; print(os.environ['NUMBA_CPU_FEATURES'])"
    done = finished(environment | {"NUMBA_CPU_FEATURES": "+sse2"}, script)
    assert done.stdout.strip() == "+sse2"


def test_without_a_compiler_there_are_no_kernels_and_a_sentence_says_so():
    words = ["twodiscs.cli", "simulate", "--width=1.5", "--height=1", "--radius=.2", "--error=.1"]
    done = subprocess.run(
        [sys.executable, "-m", *words], env=os.environ | {"NUMBA_DISABLE_JIT": "1"},
        text=True, capture_output=True,
    )  # fmt: skip
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("error: NUMBA_DISABLE_JIT must not be set: ")
    assert done.stderr.count("\n") == 1


def test_one_kernel_runs_in_python_for_who_steps_through_it():
    state = streams.open_stream(np.uint64(1), 0)
    assert streams.uniform.py_func(state.copy()) == streams.uniform(state)


def test_kernels_start_without_linear_algebra_which_is_there_for_others():
    script = """
import sys, numba
from twodiscs.model.box import Box
from twodiscs.dynamics import counting
scene = Box(1.5, 1.0).scene(0.2)
counting.run_blocks(scene, ("any_wall",), 1, 0, 0, 1.0)
print("scipy.linalg" in sys.modules)
import numpy as np
import scipy.linalg.cython_blas
a = np.arange(12.0).reshape(3, 4) ** 1.5
product = lambda a: np.dot(a, a.T)
print(np.allclose(numba.njit(product)(a), product(a), rtol=1e-9, atol=0))
"""
    done = finished(os.environ, script)
    assert done.stdout.split() == ["False", "True"], done.stderr


# Effects that are absent ---------------------------------------------------------------------


@jit.optional(lambda x, bonus: x)
def with_bonus(x, bonus):
    """Return x and a bonus, a tuple of one number: there is no such thing as ``None[0]``."""
    return x + bonus[0]


@jit.compiled
def total_with_bonus(values, bonus):
    total = 0.0
    for x in values:
        total += with_bonus(x, bonus)
    return total


def test_the_type_of_the_last_argument_chooses_between_present_and_absent():
    values = np.array([1.0, 2.0, 4.0])
    assert total_with_bonus(values, None) == 7.0
    assert total_with_bonus(values, (10.0,)) == 37.0
    # The same outside of a kernel.
    assert with_bonus(1.0, None) == 1.0
    assert with_bonus(1.0, (10.0,)) == 11.0
    assert with_bonus.__doc__.startswith("Return x and a bonus")


# Absent effects are not compiled ----------------------------------------------------------------

#: Print how often each machine instruction stands in the kernel that counts all events of a scene.
INSTRUCTIONS = """
import collections, json, re, sys
from twodiscs.dynamics.two.lockstep import count_blocks, run_blocks
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene
scene = Scene(1.5, 1.0, 0.2, **json.loads(sys.argv[1]))
run_blocks(scene, EVENTS, 1, 0, 1, 1.0, replicas=1)
(assembly,) = count_blocks.inspect_asm().values()
names = re.findall(r"^\\t([a-z]\\w+)", assembly, re.MULTILINE)
json.dump(collections.Counter(names), sys.stdout)
"""


def instructions(environment, **effects):
    done = subprocess.run(
        [sys.executable, "-c", INSTRUCTIONS, json.dumps(effects)],
        env=environment, text=True, capture_output=True, check=True, timeout=300,
    )  # fmt: skip
    return json.loads(done.stdout)


@pytest.mark.slow
def test_absent_effects_leave_no_instruction(package):
    """The kernel of the plain scene is the same if the package has no effects.

    In the copy every optional function is what stands in for it, but for those that put discs on
    walls and see either disc there, and counters; the compiler never sees the code of the effects.
    """
    sources, environment = package
    present = instructions(environment)  # in an empty cache, because kept code has no assembly
    assert present["vsqrtpd" if "vsqrtpd" in present else "sqrtpd"] > 0

    module = sources / "sampling" / "jit.py"
    text = module.read_text(encoding="utf-8")
    mark = "    def decorate(present):"
    assert text.count(mark) == 1
    without = (
        "        if present.__name__ != 'add_one':\n"
        "            kept = present.__name__ in ('snap_to_wall', 'hit')\n"
        "            return inlined(present if kept else absent)\n"
    )
    module.write_text(text.replace(mark, f"{mark}\n{without}"), encoding="utf-8")
    assert instructions(environment) == present
    failed = subprocess.run(
        [sys.executable, "-c", INSTRUCTIONS, '{"moment_of_inertia": 0.5}'],
        env=environment, capture_output=True, check=False,
    )  # fmt: skip
    assert failed.returncode != 0


def test_inlined_functions_are_kept_but_those_within_a_function():
    """Several kernels have them. Two lambdas have one name, and bytecode that may be the same."""
    once, again = (jit.inlined(law.crosses.py_func) for _ in range(2))
    assert once(-1.0, 1.0)
    assert again(-1.0, 1.0)
    assert again.stats.cache_hits

    first, second = (lambda x: x + 1.0), (lambda x: x + 2.0)
    for function in (first, second):
        function.__module__ = law.__name__
    assert [jit.inlined(function)(1.0) for function in (first, second)] == [2.0, 3.0]
