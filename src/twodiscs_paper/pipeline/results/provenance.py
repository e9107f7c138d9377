"""The origin of results: commit, versions, machine, times."""

import os
import platform
import subprocess
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path

#: The packages whose versions are recorded, beside Python.
PACKAGES = ("snakemake", "numpy", "numba", "scipy", "matplotlib", "typst")

#: Variables by which a hook of git, or its user, names another repository.
REPOSITORY = {"GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE", "GIT_COMMON_DIR"}


def commit(folder):
    """Return the commit of the repository that tracks the files in ``folder``, or "unknown".

    If a tracked file was changed since, " with changes" follows.
    """
    environment = {name: value for name, value in os.environ.items() if name not in REPOSITORY}

    def git(*words):
        command = ("git", "-C", folder, *words)
        return subprocess.run(
            command, env=environment, capture_output=True, text=True, check=True
        ).stdout

    try:
        # A folder of packages may lie in the repository of somebody else, who does not track it.
        git("ls-files", "--error-unmatch", ".")
        words = ("--always", "--abbrev=12", "--exclude=*", "--dirty= with changes")
        return git("describe", *words).strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def versions():
    """Return {name: version} of Python and of the packages that do the work."""
    return {"python": platform.python_version()} | {name: version(name) for name in PACKAGES}


def provenance(sources, paths):
    """Return a dict on the origin of the files at ``paths``, made by the ``sources``.

    If the commit is unknown, it is None, and so is whether a file was changed since.
    """
    known = commit(sources)
    is_known = known != "unknown"
    times = [Path(path).stat().st_mtime for path in paths]
    first, last = (
        datetime.fromtimestamp(moment, UTC).isoformat(timespec="seconds")
        for moment in (min(times), max(times))
    )
    return {
        "commit": known.removesuffix(" with changes") if is_known else None,
        "changed_since_the_commit": known.endswith(" with changes") if is_known else None,
        "versions": versions(),
        "machine": {
            "cores": os.cpu_count(),
            "processor": platform.machine(),
            "system": platform.platform(),
        },
        "first_file": first,
        "last_file": last,
    }
