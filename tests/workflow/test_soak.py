"""A small build is killed and damaged, again and again: the next run ends in the same bytes.

SOAK_SECONDS and SOAK_SEED in the environment say how long it goes on (60) and from which seed (1).
"""

import os
import random
import shutil
import signal
import subprocess
import sys
import time
from contextlib import suppress

import psutil
import pytest
import yaml
from checkout import Checkout

from twodiscs.model.checks import InputError
from twodiscs.points.base import read_json
from twodiscs_paper.catalogue import is_reproducible

BUILD = {
    "shared": [],
    "shard_events": 1e7,
    "scenes": [
        {
            "name": "plain",
            "box": {"width": 1.5, "height": 1.0},
            "radii": [0.2, 0.24],
            "watch": {"volume": True, "mean_times": ["vertical_hop"]},
            "accuracy": 3e-3,
            "event_budget": 1e9,
            "monte_carlo": {"samples": 3e7},
        }
    ],
}

SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
COMMAND = [sys.executable, "-m", "snakemake", "--cores", "2"]


def compared(place):
    """Return {name: content} of the results that are the same on every run: tables, figures, JSON.

    A point has its processor time beside its content.
    """
    return {
        name: content if is_reproducible(name) else read_json(place.path / "results" / name)
        for name, content in place.results().items()
        if is_reproducible(name) or "/points/" in name
    }


def processes(folder):
    """Return the processes that work in a folder."""
    found = []
    for process in psutil.process_iter():
        with suppress(psutil.Error):
            if process.cwd() == str(folder):
                found.append(process)
    return found


def run(place, *words):
    snakefile = str(place.home.path / "Snakefile")
    return subprocess.Popen(
        [*COMMAND, "--snakefile", snakefile, *words],
        cwd=place.path,
        env=os.environ | {"PYTHONPATH": str(place.home.path / "src")},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )


def kill(place, chance, duration):
    """Kill a build of random parts at a random moment; return a description."""
    for path in sorted((place.path / "results").rglob("*.*")):
        if path.is_file() and chance.random() < 0.5:
            path.unlink()
    process, moment = run(place), chance.uniform(0, duration)
    time.sleep(moment)
    victims = {
        "parent": [process.pid],
        "session": [process.pid, *(p.pid for p in processes(place.path))],
        "job": [p.pid for p in processes(place.path) if p.pid != process.pid][:1],
    }
    who, which = chance.choice([*victims]), chance.choice(SIGNALS)
    for pid in victims[who]:
        with suppress(ProcessLookupError):
            os.kill(pid, which)
    process.wait(300)
    _, left = psutil.wait_procs(processes(place.path), timeout=60)
    assert not left, f"{which.name} of {who} after {moment:.1f} s: {left} stayed"
    return f"{which.name} of {who} after {moment:.1f} s"


def damage(place, chance):
    """Delete, truncate or edit a point or a shard; return a description."""
    files = [p for p in sorted((place.path / "results").rglob("*.json")) if "plain" in p.parts]
    path, how = chance.choice(files), chance.choice(("deleted", "truncated", "edited"))
    content = path.read_bytes()
    if how == "deleted":
        path.unlink()
    elif how == "truncated":
        path.write_bytes(content[: chance.randrange(len(content))])
    else:
        i = content.index(b"1")
        path.write_bytes(content[:i] + b"2" + content[i + 1 :])
    return f"{how} {path.relative_to(place.path)}"


@pytest.mark.slow
def test_what_is_killed_or_damaged_ends_in_the_same_bytes(unbuilt, tmp_path):
    place = Checkout(tmp_path / "build", unbuilt)
    place.configuration.parent.mkdir(parents=True)
    place.configuration.write_text(yaml.safe_dump(BUILD))
    for _ in range(2):  # the second time nothing is compiled
        shutil.rmtree(place.path / "results", ignore_errors=True)
        start = time.monotonic()
        assert run(place).wait(600) == 0
        duration = time.monotonic() - start
    expected = compared(place)
    assert any("/points/" in name for name in expected)
    chance = random.Random(int(os.environ.get("SOAK_SEED", "1")))
    end, told = time.monotonic() + float(os.environ.get("SOAK_SECONDS", "60")), []
    while time.monotonic() < end:
        if chance.random() < 0.5:
            told.append(kill(place, chance, duration))
            run(place, "--unlock").wait(60)
        else:
            told.append(damage(place, chance))
            for file in (place.path / "results" / "plain").rglob("*.json"):
                try:
                    read_json(file)
                except InputError:  # a job says so, and its reader deletes the file
                    file.unlink()
        assert run(place).wait(600) == 0, told
        # A point that nothing asks for again may be missing.
        found = compared(place)
        assert found.items() <= expected.items(), told
        assert all("/points/" in name for name in expected.keys() - found.keys()), told
    print(*told, sep="\n")
