"""The origin of results: commit, versions, machine, times.

    python -m twodiscs_paper.pipeline.results.provenance results/paper.pdf … --sources . \\
        --output results/provenance.json
"""

import json
import os
import platform
import subprocess
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path

from twodiscs.arguments import Parser, run

#: The packages whose versions are recorded, beside Python.
PACKAGES = ("snakemake", "numpy", "numba", "scipy", "matplotlib", "typst")


def commit(folder):
    """Return the commit of ``folder``, marked if files differ from it, or "unknown"."""
    words = ("git", "-C", folder, "describe", "--always", "--abbrev=12", "--exclude=*")
    try:
        run = subprocess.run(
            [*words, "--dirty= with changes"], capture_output=True, text=True, check=True
        )
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return run.stdout.strip()


def versions():
    """Return {name: version} of Python and of the packages that do the work."""
    return {"python": platform.python_version()} | {name: version(name) for name in PACKAGES}


def provenance(sources, paths):
    """Return a dict on the origin of the files at ``paths``, made by the ``sources``."""
    times = sorted(Path(path).stat().st_mtime for path in paths)
    first, last = (
        datetime.fromtimestamp(moment, UTC).isoformat(timespec="seconds")
        for moment in (times[0], times[-1])
    )
    known = commit(sources)
    return {
        "commit": known.removesuffix(" with changes"),
        "changed_since_the_commit": known.endswith(" with changes"),
        "versions": versions(),
        "machine": {
            "cores": os.cpu_count(),
            "processor": platform.machine(),
            "system": platform.platform(),
        },
        "first_file": first,
        "last_file": last,
    }


def main():
    parser = Parser(prog=__spec__.name, description=__doc__.split("\n")[0])
    parser.add_argument("files", nargs="+", metavar="FILE", help="the results")
    parser.add_argument("--sources", required=True, help="the checkout that made the results")
    parser.add_argument("--output", required=True, type=Path, metavar="FILE")
    options = parser.parse_args()
    known = provenance(options.sources, options.files)
    options.output.write_text(json.dumps(known, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    run(main)
