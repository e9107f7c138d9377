"""Without these tests jobs could outlive a killed run, or the next one trust what it left."""

import os
import signal
import subprocess
import sys
import time

import pytest
from checkout import folder, fresh

JOB = "results/one/points/monte_carlo/0.2.json"
ENDLESS = {
    "name": "one",
    "box": {"width": 1.5, "height": 1},
    "radii": [0.2],
    "watch": {"volume": True},
    "monte_carlo": {"samples": 1e11},
}


def processes(folder):
    """Return {pid: command line} of the jobs that work in a folder."""
    found = {}
    for entry in os.scandir("/proc"):
        try:
            if entry.name.isdecimal() and os.readlink(f"{entry.path}/cwd") == str(folder):
                with open(f"{entry.path}/cmdline", encoding="utf-8") as file:
                    found[int(entry.name)] = file.read().replace("\0", " ")
        except OSError:
            continue
    return {pid: line for pid, line in found.items() if ".snakemake/scripts/" in line}


def threads(pid):
    """Return the number of threads of a process, 0 if it has ended."""
    try:
        return len(os.listdir(f"/proc/{pid}/task"))
    except OSError:
        return 0


def wait_until(condition, seconds=300):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.1)


def begun(checkout, *words):
    """Return a process of a Python module, as of a terminal, when a job of it is at work.

    A job that is at work has a second thread, which ends it with the workflow.
    The file ``printed`` of the checkout has what it prints.
    """
    with open(checkout.path / "printed", "w", encoding="utf-8") as printed:
        run = subprocess.Popen(
            [sys.executable, "-m", *words],
            cwd=checkout.path,
            env=os.environ | {"PYTHONPATH": str(checkout.path / "src")},
            stdout=printed,
            stderr=printed,
            start_new_session=True,
        )
    wait_until(lambda: any(threads(pid) > 1 for pid in processes(checkout.path)))
    return run


def slow(*case):
    return pytest.param(*case, marks=pytest.mark.slow)


@pytest.mark.skipif(not os.path.isdir("/proc/self"), reason="processes are found in /proc")
@pytest.mark.parametrize(
    ("command", "name"),
    [
        ("snakemake", "SIGKILL"),
        slow("snakemake", "SIGINT"),
        slow("snakemake", "SIGTERM"),
        ("twodiscs run config/config.yaml", "SIGINT"),
        slow("twodiscs run config/config.yaml", "SIGKILL"),
    ],
)
def test_a_killed_run_leaves_no_job_and_the_next_one_resumes(tmp_path, command, name):
    checkout = fresh(tmp_path / "checkout")
    folder(checkout.path, None, {"shared": [], "scenes": [ENDLESS]})
    run = begun(checkout, *command.split(), "--cores", "1", JOB)
    if name == "SIGKILL":
        run.kill()
    else:  # as Ctrl-C in a terminal; alone, Snakemake waits for its jobs
        os.killpg(run.pid, getattr(signal, name))
    status = run.wait(60)
    if command != "snakemake" and name == "SIGINT":
        assert status not in (0, -signal.SIGINT)  # Snakemake has cleaned up
        assert not processes(checkout.path)
    wait_until(lambda: not processes(checkout.path))

    if name == "SIGKILL":
        (checkout.path / JOB).write_text("{")  # as far as the job had come
        checkout.snakemake("--unlock")
    assert ("monte_carlo", ("scene=one", "stage=monte_carlo", "radius=0.2")) in checkout.jobs(JOB)
