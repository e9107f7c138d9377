"""The settings of all tests: threads, garbage collection, order of the files; pilots of runs."""

import gc
import os

import pytest

# Threads of OpenBLAS wait for each other by spinning: small products take ten times as long where
# other processes have work for the cores. Only modules that are imported later use the setting.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# Compiled functions and figures are millions of objects that stay. With the usual thresholds,
# collections that read them take a tenth of the time.
gc.set_threshold(100_000, 50, 1000)


def pytest_configure(config):
    """Tests ask for more than their small budgets give; pytest.warns still sees the warning."""
    # The name is not in pyproject.toml: pytest would import NumPy for it before the lines above.
    config.addinivalue_line("filterwarnings", "ignore::twodiscs.AccuracyWarning")


def pytest_collection_modifyitems(items):
    """Workers begin with the file of the one build, because the build takes longest."""
    if "PYTEST_XDIST_WORKER" not in os.environ:
        return
    built = {item.path for item in items if "complete" in item.fixturenames}
    first = min(built, key=lambda file: (file.stem != "test_build", file), default=None)
    items.sort(key=lambda item: item.path != first)


@pytest.fixture
def blocks(monkeypatch):
    """Let a pilot have 32 blocks, the first round of a run, each of a millisecond."""
    for module in ("twodiscs.measure.cost", "twodiscs_paper.pipeline.forecast"):
        monkeypatch.setattr(f"{module}.timed", lambda work, *_: (work(0, 32), 32, 1e-3))
