"""Where and when results came to be: commit, versions, machine, times.

    python -m twodiscs.pipeline.results.provenance --sources . --output results/provenance.json

What is the same on every run is in the records of the jobs (``record``).
"""

import json
import os
import platform
from datetime import UTC, datetime
from pathlib import Path

from twodiscs.pipeline.arguments import Parser, run
from twodiscs.pipeline.documents.manuscript import commit, versions
from twodiscs.pipeline.results.record import FOLDER


def provenance(sources, folder):
    """Return a dict of what is known of the results in ``folder``, made by the ``sources``."""
    times = [path.stat().st_mtime for path in Path(folder).rglob(f"{FOLDER}/*.json")]
    first, last = (
        datetime.fromtimestamp(moment, UTC).isoformat(timespec="seconds")
        for moment in (min(times, default=0), max(times, default=0))
    )
    found = commit(sources)
    return {
        "commit": found.removesuffix(" with changes"),
        "changed_since_the_commit": found.endswith(" with changes"),
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
    parser = Parser(prog="twodiscs.pipeline.results.provenance", description=__doc__.split("\n")[0])
    parser.add_argument("--sources", required=True, help="the checkout that made the results")
    parser.add_argument("--output", required=True, type=Path, metavar="FILE")
    options = parser.parse_args()
    found = provenance(options.sources, options.output.parent)
    options.output.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    run(main)
