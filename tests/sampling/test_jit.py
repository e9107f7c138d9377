"""Compiled code is kept, and never used for other sources than its own."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import twodiscs

SCRIPT = """
from twodiscs import dynamics
from twodiscs.scene import EVENTS, Scene
print(dynamics.run_blocks(Scene(1.5, 1.0, 0.2), EVENTS, 1, 0, 1, 4.0, replicas=64)[0].tolist())
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


def test_an_edit_of_the_event_law_changes_the_result(package):
    """Numba alone would go on with the old law, for the edited file is not the kernel's own."""
    sources, environment = package
    before = output(start(environment))
    caches = sorted((sources.parent / "cache").iterdir())
    assert len(caches) == 1
    assert any(caches[0].rglob("*.nbc"))
    law = sources / "events.py"
    text = law.read_text()
    edited = text.replace("exchange = exchange if", "exchange = 0.9 * exchange if")
    assert edited != text
    law.write_text(edited)
    after = output(start(environment))
    assert after != before
    law.write_text(text)
    assert output(start(environment)) == before


def test_parallel_first_runs_do_not_race(package):
    _, environment = package
    results = {output(process) for process in [start(environment) for _ in range(3)]}
    assert len(results) == 1


def test_old_caches_go(package):
    sources, environment = package
    home = sources.parent / "cache"
    for i in range(9):
        (home / f"sources-{i:016x}").mkdir(parents=True)
        os.utime(home / f"sources-{i:016x}", (i, i))
    (home / "something else").mkdir()
    script = "import twodiscs.jit, os; print(os.environ['NUMBA_CACHE_DIR'])"
    done = subprocess.run(
        [sys.executable, "-c", script], env=environment, text=True, capture_output=True, check=True
    )
    assert Path(done.stdout.strip()).parent == home
    assert (home / "something else").is_dir()
    assert len(list(home.glob("sources-*"))) == 4


def test_a_users_choice_of_processor_wins(package):
    _, environment = package
    script = "import twodiscs.jit, os; print(os.environ['NUMBA_CPU_FEATURES'])"
    done = subprocess.run(
        [sys.executable, "-c", script], env=environment | {"NUMBA_CPU_FEATURES": "+sse2"},
        text=True, capture_output=True, check=True,
    )  # fmt: skip
    assert done.stdout.strip() == "+sse2"


# What is absent is not compiled -----------------------------------------------------------------

#: Print how often each machine instruction stands in the kernel that counts all events of a scene.
INSTRUCTIONS = """
import collections, json, re, sys
from twodiscs import dynamics
from twodiscs.scene import EVENTS, Scene
scene = Scene(1.5, 1.0, 0.2, **json.loads(sys.argv[1]))
dynamics.run_blocks(scene, EVENTS, 1, 0, 1, 1.0, replicas=1)
(assembly,) = dynamics.count_blocks.inspect_asm().values()
names = re.findall(r"^\\t([a-z]\\w+)", assembly, re.MULTILINE)
json.dump(collections.Counter(names), sys.stdout)
"""


def instructions(environment, **effects):
    done = subprocess.run(
        [sys.executable, "-c", INSTRUCTIONS, json.dumps(effects)],
        env=environment, text=True, capture_output=True, check=True, timeout=300,
    )  # fmt: skip
    return json.loads(done.stdout)


def test_absent_effects_leave_no_instruction(package):
    """The kernel of the plain scene is the same where the package knows no effect at all.

    In the copy every optional function is what stands in for it, but for the one that puts discs on
    walls; the compiler never sees the code of the effects.
    """
    sources, environment = package
    present = instructions(environment)
    assert instructions(environment, moment_of_inertia=0.5) != present

    jit = sources / "jit.py"
    text = jit.read_text(encoding="utf-8")
    head, mark, _ = text.partition("    def decorate(present):")
    assert mark
    without = "return lambda present: inlined(present if present.__name__ == 'on_wall' else absent)"
    jit.write_text(f"{head}    {without}\n", encoding="utf-8")
    assert instructions(environment) == present
    failed = subprocess.run(
        [sys.executable, "-c", INSTRUCTIONS, '{"moment_of_inertia": 0.5}'],
        env=environment, capture_output=True, check=False,
    )  # fmt: skip
    assert failed.returncode != 0
