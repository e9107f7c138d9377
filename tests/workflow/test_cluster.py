"""Without these tests a queue or a Slurm could run other jobs, or give other bytes."""

import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from importlib.util import find_spec

import psutil
import pytest
import yaml
from checkout import REPOSITORY, Checkout
from slurm import missing, running

#: Points that are small enough for one job; and one with effects, in shards.
SCENES = {
    "walls": {"radii": [0.1, 0.2], "watch": {"mean_times": ["top_wall"]}, "accuracy": 0.1},
    "field": {
        "radii": [0.1],
        "effects": {"field": 0.3},
        "watch": {"mean_times": ["top_wall"]},
        "accuracy": 2e-3,
        "event_budget": 1e9,
    },
}
BOX = {"box": {"width": 1.5, "height": 1.0}, "event_budget": 1e7}
TABLES = [f"results/{name}/mean_times.csv" for name in SCENES]


def place_at(path, home):
    """Return a folder with a configuration to be built by the sources of ``home``."""
    place = Checkout(path, home)
    place.configuration.parent.mkdir(parents=True)
    scenes = [{"name": name} | BOX | scene for name, scene in SCENES.items()]
    configuration = {"shared": [], "shard_events": 1e7, "scenes": scenes}
    place.configuration.write_text(yaml.safe_dump(configuration))
    return place


def build(place, *arguments):
    """Return the tables of a build."""
    place.snakemake(*arguments, "--", *TABLES)
    return [(place.path / name).read_bytes() for name in TABLES]


def counted(home, folder):
    """Return how many jobs of a build take time: points and shards."""
    jobs = place_at(folder / "planned", home).jobs(*TABLES)
    assert {"dynamics", "shard"} <= {rule for rule, _ in jobs}
    return sum(rule in ("dynamics", "shard") for rule, _ in jobs)


needs_queue = pytest.mark.skipif(
    find_spec("snakemake_executor_plugin_cluster_generic") is None,
    reason="the extra `cluster` is not installed",
)


@pytest.fixture(scope="module")
def local(unbuilt, tmp_path_factory):
    place = place_at(tmp_path_factory.mktemp("local") / "here", unbuilt)
    return build(place, "--cores", "2")


def profile(home, name, **other):
    """Return the arguments for a profile with ``other`` settings, kept beside it."""
    settings = yaml.safe_load((REPOSITORY / "profiles" / name / "config.yaml").read_text())
    folder = home / f"{name}-here"
    folder.mkdir()
    (folder / "config.yaml").write_text(yaml.safe_dump(settings | other))
    return "--profile", str(folder)


def queue(home):
    """Return the arguments for the profile of a queue of this machine."""
    script = REPOSITORY / "profiles" / "queue" / "queue.sh"
    settings = {"latency-wait": 5, "seconds-between-status-checks": 1}
    settings |= {f"cluster-generic-{do}-cmd": f"sh {script} {do}" for do in ("submit", "status")}
    return profile(home, "queue", **settings)


def is_point(words):
    """Return whether a command runs the script of a point."""
    return any(word.endswith(".point.py") for word in words)


def kill_a_job(jobs):
    """Kill the first job below the folder ``jobs`` that counts events, and all that started it."""
    ends = time.monotonic() + 120
    while time.monotonic() < ends:
        for file in jobs.glob("*/process"):
            with suppress(psutil.NoSuchProcess, ValueError):
                job = psutil.Process(int(file.read_text()))
                processes = [job, *job.children(recursive=True)]
                if any(is_point(one.cmdline()) for one in processes):
                    for one in processes:
                        with suppress(psutil.NoSuchProcess):
                            one.kill()
                    return
        time.sleep(0.05)
    raise AssertionError("no job counted events")


@needs_queue
@pytest.mark.slow
def test_a_queue_of_scripts(local, unbuilt, tmp_path, monkeypatch):
    """A job of it that is killed is submitted once more."""
    jobs = tmp_path / "jobs"
    jobs.mkdir()
    monkeypatch.setenv("TMPDIR", str(jobs))
    with ThreadPoolExecutor() as threads:
        killed = threads.submit(kill_a_job, jobs)
        assert build(place_at(tmp_path / "queue", unbuilt), *queue(tmp_path)) == local
        killed.result()
    assert len([*jobs.glob("*/process")]) == counted(unbuilt, tmp_path) + 1


@pytest.fixture
def slurm(tmp_path, monkeypatch):
    """A Slurm that runs, (its folder, its environment), and arguments for its profile."""
    if missing() is not None:
        pytest.skip(missing())
    settings = {"slurm-status-command": "squeue", "latency-wait": 5}
    settings |= {"slurm-init-seconds-before-status-checks": 2, "seconds-between-status-checks": 1}
    settings["default-resources"] = {"mem_mb": 500, "runtime": 10}
    with running(tmp_path / "slurm") as environment:
        for name in ("PATH", "SLURM_CONF"):
            monkeypatch.setenv(name, environment[name])
        yield tmp_path / "slurm", environment, profile(tmp_path, "slurm", **settings)


def submitted(folder):
    """Return how many jobs Slurm was given."""
    return (folder / "slurmctld.log").read_text().count("submit_batch_job: JobId=")


@pytest.mark.slow
def test_slurm(local, unbuilt, tmp_path, slurm):
    folder, _, arguments = slurm
    assert build(place_at(tmp_path / "jobs", unbuilt), *arguments) == local
    assert submitted(folder) == counted(unbuilt, tmp_path)
