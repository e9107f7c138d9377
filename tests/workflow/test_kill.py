"""Builds that are killed.

Without these tests jobs could outlive a killed run, or the next one trust what it left.
"""

import os
import signal
import subprocess
import sys
import time

import psutil
import pytest
from checkout import folder, fresh, one_scene
from marks import slow

JOB = "results/one/points/monte_carlo/0.2.json"
ENDLESS = one_scene("one", radii=[0.2], watch={"volume": True}, monte_carlo={"samples": 1e11})


def jobs(folder):
    """Return the processes of the jobs that work in a folder."""
    every = (one.info for one in psutil.process_iter(["cwd", "cmdline", "num_threads"]))
    own = (one for one in every if one["cwd"] == str(folder))
    return [one for one in own if ".snakemake/scripts/" in " ".join(one["cmdline"] or ())]


def wait_until(condition, seconds=300):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.1)


def begun(checkout, *words):
    """Return a process of a Python module, as of a terminal, when a job of it is at work.

    A job that is at work has a second thread, which ends it with the workflow.
    """
    run = subprocess.Popen(
        [sys.executable, "-m", *words],
        cwd=checkout.path,
        env=os.environ | {"PYTHONPATH": str(checkout.path / "src")},
        stdout=subprocess.DEVNULL,
        stderr=(checkout.path / "said").open("w"),
        start_new_session=True,
    )
    wait_until(lambda: any(job["num_threads"] > 1 for job in jobs(checkout.path)))
    return run


@pytest.mark.skipif(not os.path.isdir("/proc/self"), reason="processes are found in /proc")
@pytest.mark.parametrize(
    ("command", "name"),
    [
        slow("snakemake", "SIGKILL"),
        slow("snakemake", "SIGINT"),
        slow("snakemake", "SIGTERM"),
        ("twodiscs run config/config.yaml", "SIGINT"),
        ("twodiscs run config/config.yaml", "SIGKILL"),
    ],
)
def test_a_killed_run_leaves_no_job_and_the_next_one_resumes(tmp_path, command, name):
    checkout = fresh(tmp_path / "checkout")
    folder(checkout.path, None, ENDLESS)
    run = begun(checkout, *command.split(), "--cores", "1", JOB)
    if name == "SIGKILL":
        run.kill()
    else:  # as Ctrl-C in a terminal; alone, Snakemake waits for its jobs
        os.killpg(run.pid, getattr(signal, name))
    status = run.wait(60)
    if command != "snakemake" and name == "SIGINT":
        assert status not in (0, -signal.SIGINT)  # Snakemake has cleaned up
        assert not jobs(checkout.path)
        said = (checkout.path / "said").read_text()
        assert said.splitlines()[-1].startswith("Stopped; the same command goes on")
    wait_until(lambda: not jobs(checkout.path))

    if name == "SIGKILL":
        (checkout.path / JOB).write_text("{")  # as far as the job had come
        locked = checkout.twodiscs_run("config/config.yaml", JOB, passes=False)
        assert "run the command once with --unlock" in locked.stderr.splitlines()[-1]
        checkout.twodiscs_run("config/config.yaml", "--unlock")
    assert ("monte_carlo", ("scene=one", "stage=monte_carlo", "radius=0.2")) in checkout.jobs(JOB)
