"""A real Slurm of one node, in a folder: three daemons, started as root and ended by their ids."""

import os
import shutil
import signal
import socket
import subprocess
import time
from contextlib import contextmanager, suppress
from importlib.util import find_spec

DAEMONS = "munged", "slurmctld", "slurmd"
COMMANDS = *DAEMONS, "sbatch", "srun", "squeue", "scancel"

CONFIGURATION = """
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
SlurmUser=root
AuthInfo=socket={folder}/munge.socket
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
ReturnToService=2
SlurmdTimeout=10
SchedulerParameters=batch_sched_delay=0,sched_min_interval=100000
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=2000
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE
"""

#: The plugin keeps SLURM_CONF from srun, which then looks into /etc.
SRUN = '#!/bin/sh\nSLURM_CONF={folder}/slurm.conf exec {srun} "$@"\n'


def missing():
    """Return what keeps a Slurm from being started here, or None."""
    if os.geteuid() != 0:
        return "Slurm is started by root only"
    if absent := [name for name in COMMANDS if not shutil.which(name)]:
        return f"there is no {', '.join(absent)}"
    if find_spec("snakemake_executor_plugin_slurm") is None:
        return "the extra `cluster` is not installed"
    return None


@contextmanager
def running(folder):
    """Start a Slurm in ``folder``; yield the environment that its commands need."""
    host = socket.gethostname().partition(".")[0]
    with socket.socket() as one, socket.socket() as other:
        for free in (one, other):
            free.bind(("127.0.0.1", 0))
        ports = [free.getsockname()[1] for free in (one, other)]
    for name in ("state", "spool", "bin"):
        (folder / name).mkdir(parents=True)
    folder.chmod(0o755)
    key = folder / "munge.key"
    key.write_bytes(os.urandom(128))
    key.chmod(0o600)
    text = CONFIGURATION.format(host=host, folder=folder, ports=ports)
    (folder / "slurm.conf").write_text(text)
    srun = folder / "bin" / "srun"
    srun.write_text(SRUN.format(folder=folder, srun=shutil.which("srun")))
    srun.chmod(0o755)
    path = os.pathsep.join((str(folder / "bin"), os.environ["PATH"]))
    environment = os.environ | {"SLURM_CONF": str(folder / "slurm.conf"), "PATH": path}

    def run(*command):
        return subprocess.run(command, env=environment, capture_output=True, text=True)

    files = {"socket": "socket", "key-file": "key", "pid-file": "pid", "seed-file": "seed"}
    places = [f"--{name}={folder}/munge.{end}" for name, end in files.items()]
    try:
        for command in (
            ["munged", "--force", f"--log-file={folder}/munged.log", *places],
            ["slurmctld"],
            ["slurmd"],
        ):
            started = run(*command)
            assert started.returncode == 0, started.stderr
        ends = time.monotonic() + 60
        while "idle" not in run("sinfo", "--noheader", "--format=%t").stdout:
            assert time.monotonic() < ends, (folder / "slurmctld.log").read_text()
            time.sleep(0.1)
        yield environment
    finally:
        run("scancel", "--state=RUNNING")
        for name in ("slurmd", "slurmctld", "munge"):
            with suppress(OSError, ValueError):
                os.kill(int((folder / f"{name}.pid").read_text()), signal.SIGTERM)
