"""What all tests share: one thread for each product of matrices, and who runs beside whom."""

import os

import pytest

# Threads of OpenBLAS wait for each other by spinning: small products take ten times as long where
# other processes have work for the cores. Only what is not imported yet hears of it.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


def pytest_collection_modifyitems(items):
    """Keep the tests of a file, and those of the one build, in one process; the build begins."""
    items.sort(key=lambda item: "complete" not in item.fixturenames)
    for item in items:
        group = "build" if "complete" in item.fixturenames else item.nodeid.partition("::")[0]
        item.add_marker(pytest.mark.xdist_group(group))
