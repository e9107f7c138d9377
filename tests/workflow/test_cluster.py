"""The workflow on a queue and on Slurm.

Without these tests a queue or a Slurm could run other jobs, or give other bytes.
"""

import os
import subprocess
import time
from pathlib import Path

import psutil
import pytest
import yaml
from checkout import REPOSITORY, Checkout, folder

#: Points that are small enough for one job; and one with effects, in shards.
BLOCK = {"box": {"width": 1.5, "height": 1.0}, "watch": {"mean_times": ["top_wall"]}}
SCENES = [
    BLOCK | {"name": "walls", "radii": [0.1, 0.2], "accuracy": 0.1, "event_budget": 1e7},
    BLOCK
    | {"name": "field", "radii": [0.1], "effects": {"field": 0.3}}
    | {"accuracy": 2e-3, "event_budget": 1e9},
]
CONFIGURATION = {"shared": [], "shard_events": 1e7, "scenes": SCENES}
QUEUE = REPOSITORY / "profiles" / "queue" / "queue.sh"
ABSENT = "the extra `cluster` is absent"
TABLES = [f"results/{scene['name']}/mean_times.csv" for scene in SCENES]


def build(path, home, *arguments):
    """Return the tables of a build at ``path`` by the sources of ``home``."""
    place = folder(path, home, CONFIGURATION)
    place.snakemake(*arguments, "--", *TABLES)
    return [(place.path / name).read_bytes() for name in TABLES]


def counted(home, path):
    """Return how many jobs of a build take time: points and shards."""
    jobs = folder(path / "planned", home, CONFIGURATION).jobs(*TABLES)
    assert {"dynamics", "shard"} <= {rule for rule, _ in jobs}
    return sum(rule in ("dynamics", "shard") for rule, _ in jobs)


@pytest.fixture(scope="module")
def local(unbuilt, tmp_path_factory):
    return build(tmp_path_factory.mktemp("local"), unbuilt, "--cores", "2")


def profile(home, name, **other):
    """Return the arguments for a profile with ``other`` settings, kept beside it."""
    settings = yaml.safe_load((REPOSITORY / "profiles" / name / "config.yaml").read_text())
    place = Checkout(home / f"{name}-here")
    place.edit("config.yaml", yaml.safe_dump(settings | other))
    return "--profile", str(place.path)


def test_a_queue_knows_how_a_job_ended(tmp_path, monkeypatch):
    """A job that is killed at its limit has failed, and is tried three times more."""
    for name in ("queue", "slurm"):
        profile = (REPOSITORY / "profiles" / name / "config.yaml").read_text()
        assert yaml.safe_load(profile)["retries"] == 3
    monkeypatch.setenv("TMPDIR", str(tmp_path))

    def asked(*words):
        return subprocess.check_output(["sh", QUEUE, *words], text=True).strip()

    jobs = {}
    for number, line in enumerate(("true", "exit 3", "sleep 600")):
        (tmp_path / f"{number}.sh").write_text(f"{line}\n")
        jobs[line] = asked("submit", tmp_path / f"{number}.sh")
    sleeping = psutil.Process(int(Path(jobs["sleep 600"], "process").read_text()))
    assert asked("status", jobs["sleep 600"]) == "running"
    for one in (sleeping, *sleeping.children(recursive=True)):
        one.kill()
    for job in jobs.values():
        while psutil.pid_exists(int(Path(job, "process").read_text())):
            time.sleep(0.05)
    found = {line: asked("status", job) for line, job in jobs.items()}
    assert found == {"true": "success", "exit 3": "failed", "sleep 600": "failed"}


@pytest.mark.slow
def test_a_queue_of_scripts(local, unbuilt, tmp_path, monkeypatch):
    pytest.importorskip("snakemake_executor_plugin_cluster_generic", reason=ABSENT)
    jobs = tmp_path / "jobs"
    jobs.mkdir()
    monkeypatch.setenv("TMPDIR", str(jobs))
    settings = {f"cluster-generic-{do}-cmd": f"sh {QUEUE} {do}" for do in ("submit", "status")}
    settings |= {"latency-wait": 5, "seconds-between-status-checks": 1}
    queue = profile(tmp_path, "queue", **settings)
    assert build(tmp_path / "queue", unbuilt, *queue) == local
    assert len([*jobs.glob("*/process")]) == counted(unbuilt, tmp_path)


#: The commands of Slurm that its plugin calls, for jobs of this machine: {name: script}.
SLURM = {
    "sbatch": 'for last; do :; done; echo RUNNING > {jobs}/$$; echo "$@" >> {jobs}/calls; echo $$\n'
    '(sh -c "${{last#--wrap=}}" && echo COMPLETED > {jobs}/$$ || echo FAILED > {jobs}/$$) '
    "> {jobs}/log 2>&1 &",
    "squeue": 'cd {jobs}; for job in [0-9]*; do echo "$job|$(cat $job)"; done',
    "srun": 'while [ "${{1#-}}" != "$1" ]; do shift; done; exec "$@"',
    "sinfo": "echo main*",
    "scontrol": "echo MinJobAge = 300 sec",
    "sacct": "",
    "scancel": "",
}


@pytest.mark.slow
def test_slurm(local, unbuilt, tmp_path, monkeypatch):
    pytest.importorskip("snakemake_executor_plugin_slurm", reason=ABSENT)
    jobs, tools = tmp_path / "jobs", tmp_path / "tools"
    jobs.mkdir()
    tools.mkdir()
    for name, script in SLURM.items():
        (tools / name).write_text(f"#!/bin/sh\n{script.format(jobs=jobs)}\n")
        (tools / name).chmod(0o755)
    monkeypatch.setenv("PATH", f"{tools}{os.pathsep}{os.environ['PATH']}")
    settings = {"slurm-init-seconds-before-status-checks": 1, "seconds-between-status-checks": 1}
    settings |= {"slurm-status-command": "squeue", "latency-wait": 5, "jobs": 2}
    assert build(tmp_path / "built", unbuilt, *profile(tmp_path, "slurm", **settings)) == local
    calls = (jobs / "calls").read_text().splitlines()
    assert len(calls) == counted(unbuilt, tmp_path)
    assert all("--mem 1000" in call and " -t " in call for call in calls)
