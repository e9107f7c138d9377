"""Compiled code is kept, and never used for other sources than its own."""

import json
import math
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import twodiscs
from twodiscs.sampling import jit
from twodiscs.sampling.jit import numba

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
    """However old the edited file says it is, and where a process inherits the cache of another.

    Numba alone would go on as before, for the edited file is not the kernel's own.
    """
    sources, environment = package
    # Two that find the cache empty do not race.
    before, same = map(output, [start(environment), start(environment)])
    assert same == before
    (cache,) = (sources.parent / "cache").iterdir()
    kernels = [path for path in cache.iterdir() if path.name != jit.MARK]
    assert any("draw_velocity" in path.name for path in kernels)
    # The same text elsewhere needs no compiling, and what was cut short is compiled again.
    moved = shutil.copytree(sources.parent, sources.parents[1] / "elsewhere") / "twodiscs"
    for path in kernels:
        path.write_bytes(path.read_bytes()[: 0 if "splitmix" in path.name else 1000])
    assert output(start(environment)) == before
    again = {path: path.stat().st_mtime_ns for path in kernels}
    assert output(start(environment | {"PYTHONPATH": str(moved.parent)})) == before
    assert again == {path: path.stat().st_mtime_ns for path in kernels}

    streams = sources / "sampling" / "streams.py"
    stamp, text = streams.stat().st_mtime, streams.read_text()
    edited = text.replace("UNIT = 2.0**-53", "UNIT = 2.0**-54")
    assert len(edited) == len(text)
    assert edited != text
    streams.write_text(edited)
    os.utime(streams, (stamp - 1000, stamp - 1000))
    assert output(start(environment | {"NUMBA_CACHE_DIR": str(cache)})) != before


def test_old_caches_of_this_package_go_and_nothing_else(package):
    sources, environment = package
    home = sources.parent / "cache"
    for i in range(9):
        folder = home / f"kernels-{i:016x}"
        folder.mkdir(parents=True)
        (folder / jit.MARK).touch()
        os.utime(folder, (i, i))
    others = "something else", "sources-project1", "kernels-project1", f"kernels-{10:016x}"
    for name in others:
        (home / name).mkdir()
        os.utime(home / name, (0, 0))
    assert cache_folder(environment).parent == home
    assert {path.name for path in home.iterdir()} >= set(others)
    assert len(list(home.iterdir())) == 4 + len(others)


def finished(environment, script):
    return subprocess.run(
        [sys.executable, "-c", script], env=environment, text=True, capture_output=True, check=True
    )


def cache_folder(environment):
    """Return where a process keeps the kernels of the dynamics, None where nowhere."""
    script = "from twodiscs.sampling import jit; print(jit.cache_folder('dynamics'))"
    done = finished(environment, script)
    assert (done.stderr != "") == (done.stdout == "None\n")
    return None if done.stdout == "None\n" else Path(done.stdout.rstrip())


def test_where_one_folder_cannot_be_made_another_is_taken_or_a_sentence_says_so(package):
    sources, environment = package
    blocked = sources.parent / "file"
    blocked.touch()
    environment |= {"NUMBA_CACHE_DIR": str(blocked / "below")}
    name = f"kernels-{jit.sources_hash('dynamics')}"
    assert cache_folder(environment) == sources / "__pycache__" / name
    shutil.rmtree(sources / "__pycache__")
    (sources / "__pycache__").touch()
    assert cache_folder(environment) is None


def test_a_users_choice_of_processor_wins(package):
    _, environment = package
    script = "import twodiscs.sampling.jit, os; print(os.environ['NUMBA_CPU_FEATURES'])"
    done = finished(environment | {"NUMBA_CPU_FEATURES": "+sse2"}, script)
    assert done.stdout.strip() == "+sse2"


def test_without_a_compiler_a_kernel_is_its_function(package):
    _, environment = package
    script = "from twodiscs.sampling.jit import compiled; print(compiled(lambda x: x + 1)(2))"
    done = finished(environment | {"NUMBA_DISABLE_JIT": "1"}, script)
    assert done.stdout == "3\n"


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


def test_the_hash_knows_every_source_by_its_text_and_its_place(tmp_path, monkeypatch):
    monkeypatch.setattr(jit, "PACKAGE", tmp_path)
    sources = {"model/a.py": "x = 1", "dynamics/b.py": "y = 2", "figures/c.py": "z = 3"}

    def hashed(room, **changes):
        for path in tmp_path.rglob("*.py"):
            path.unlink()
        for name, text in (sources | changes).items():
            (tmp_path / name).parent.mkdir(exist_ok=True)
            (tmp_path / name).write_text(text)
        return jit.sources_hash.__wrapped__(room)

    first = hashed("dynamics")
    assert re.fullmatch("[0-9a-f]{16}", first)
    assert hashed("sampling") == first
    changes = [{"model/a.py": "x = 3"}, {"dynamics/b.py": "y = 2 "}, {"sampling/b.py": ""}]
    assert len({first, *(hashed("dynamics", **change) for change in changes)}) == 4
    # What imports kernels changes none of them, but those that stand there themselves.
    elsewhere = {"figures/c.py": "z = 4"}
    assert hashed("dynamics", **elsewhere) == first
    assert hashed("studies", **elsewhere) != hashed("studies")
    (tmp_path / "model" / "notes.txt").write_text("no source")
    assert hashed("dynamics") == first


# Functions that are made --------------------------------------------------------------------


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


def test_lines_are_written_out_with_the_names_they_use():
    doubled = jit.inlined_closure(lambda x: 2 * x)
    lines = [f"out[{i}] = step_{i}(x) + y" for i in range(3)]
    names = {"step_0": doubled, "step_1": abs, "step_2": math.sqrt}
    fill = jit.written_out("out, x, y", lines, names)
    out = np.zeros(3)
    numba.njit(lambda out: fill(out, 4.0, 0.5))(out)
    assert out.tolist() == [8.5, 4.5, 2.5]


def test_a_tally_adds_the_unit_of_each_counter_that_says_yes():
    count = jit.tally(
        (
            (1, lambda x: x > 0, None),
            (256, lambda x, y: x > y, None),
            (256**2, lambda x, y: y == 0, "extra"),
        ),
        "x, y, extra",
    )
    run = numba.njit(lambda start, x, y, extra: count(start, x, y, extra))
    for x, y, expected in ((1, 2, 1), (2, 1, 1 + 256), (-1, -2, 256), (-1, 0, 256**2), (-2, -1, 0)):
        assert run(0, x, y, True) == expected
        assert run(5, x, y, True) == expected + 5
        # Without its argument a counter is left out.
        assert run(0, x, y, None) == expected % 256**2


def test_a_counter_without_its_argument_need_not_make_sense():
    """It is not even looked at: None has no items."""
    count = jit.tally([(1, lambda x, items: x > items[0], "items")], "x, items")
    run = numba.njit(lambda x, items: count(0, x, items))
    assert run(3, None) == 0
    assert run(3, (2, 4)) == 1


def test_the_type_of_a_tally_is_that_of_its_units():
    count = jit.tally([(np.uint64(1) << np.uint64(63), lambda x: x > 0, None)], "x")
    run = numba.njit(lambda start, x: count(start, x))
    assert run(np.uint64(1), 1.0) == 2**63 + 1
    assert run(np.uint64(1), -1.0) == 1


# What is absent is not compiled -----------------------------------------------------------------

#: Print how often each machine instruction stands in the kernel that counts all events of a scene.
INSTRUCTIONS = """
import collections, json, re, sys
from twodiscs.dynamics.counting import count_blocks, run_blocks
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
    """The kernel of the plain scene is the same where the package knows no effect at all.

    In the copy every optional function is what stands in for it, but for those that put discs on
    walls and see either disc there; the compiler never sees the code of the effects.
    """
    sources, environment = package
    present = instructions(environment)  # in an empty cache: what is kept has no assembly
    assert present["vsqrtpd" if "vsqrtpd" in present else "sqrtpd"] > 0

    module = sources / "sampling" / "jit.py"
    text = module.read_text(encoding="utf-8")
    mark = "    def decorate(present):"
    assert text.count(mark) == 1
    kept = "present.__name__ in ('on_wall', 'hit')"
    without = f"return lambda present: inlined(present if {kept} else absent)"
    module.write_text(text.replace(mark, f"    {without}\n\n{mark}"), encoding="utf-8")
    assert instructions(environment) == present
    failed = subprocess.run(
        [sys.executable, "-c", INSTRUCTIONS, '{"moment_of_inertia": 0.5}'],
        env=environment, capture_output=True, check=False,
    )  # fmt: skip
    assert failed.returncode != 0
