"""Checkouts for the tests: one without results, one with all of them, and copies of that one."""

import fcntl
import os
import re
import shutil
import sys
from pathlib import Path

import pytest
from checkout import Checkout, fresh

# Jobs start as `python`, as where the environment of the tests is activated.
os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])

#: The scene with effects that is built, at this radius: other tests compile its engine.
EFFECTS = {"field": [0.3]}


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
            checkout = fresh(path)
            scenes = '("balls", "channel", "field", "rough", "torus", "unequal")'
            study = "src/twodiscs_paper/studies/effects/study.py"
            checkout.replace(study, scenes, repr((*EFFECTS,)))
            for name, radii in EFFECTS.items():
                file = path / "config" / "scenes" / f"{name}.yaml"
                text = re.sub(r"^( +radii: )\[.*\]", rf"\1{radii}", file.read_text(), flags=re.M)
                file.write_text(text)
            checkout.snakemake("--cores", "2")
            done.touch()
    return Checkout(path)


@pytest.fixture
def built(complete, tmp_path):
    """A copy of the complete checkout, to be changed at will."""
    shutil.copytree(complete.path, tmp_path / "checkout")
    return Checkout(tmp_path / "checkout")
