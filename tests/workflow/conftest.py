"""Checkouts for the tests: one without results, one with all of them, and copies of that one."""

import fcntl
import os
import shutil
import sys
from pathlib import Path

import pytest
from checkout import ONE_SCENE, QUICKER, Checkout, fresh

# Jobs start as `python`, as where the environment of the tests is activated.
os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])


@pytest.fixture(scope="session")
def unbuilt(tmp_path_factory):
    """A checkout without results, for dry runs only."""
    return fresh(tmp_path_factory.mktemp("unbuilt") / "checkout")


@pytest.fixture(scope="session")
def planned(unbuilt):
    """The jobs of a checkout without results."""
    return unbuilt.jobs()


@pytest.fixture(scope="session")
def complete(tmp_path_factory):
    """A checkout in which everything is built, once for all workers, not to be changed."""
    shared = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        shared = shared.parent
    path, done = shared / "complete", shared / "complete.done"
    with open(shared / "complete.lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # the worker that comes second waits
        if not done.exists():
            shutil.rmtree(path, ignore_errors=True)  # of a build that failed
            run = fresh(path, QUICKER | ONE_SCENE).snakemake("--cores", "2", "--verbose")
            done.write_text(run.stdout + run.stderr)
    return Checkout(path)


@pytest.fixture
def built(complete, tmp_path):
    """A copy of the complete checkout, to be changed at will."""
    shutil.copytree(complete.path, tmp_path / "checkout")
    return Checkout(tmp_path / "checkout")
