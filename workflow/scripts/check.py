"""Do exact theory, Monte Carlo and dynamics agree? If not, it fails and names the comparisons."""

import sys
from pathlib import Path

from twodiscs_paper.catalogue import read_table
from twodiscs_paper.pipeline.job import start
from twodiscs_paper.pipeline.results.verdict import verdict

start(snakemake.log[0])
paths = [Path(path) for path in snakemake.input.tables]
tables = [
    (path.parent.name if path.stem == "check" else path.stem, read_table(path)) for path in paths
]
failures, summary = verdict(tables)
if failures:
    sys.exit("\n".join(failures))
Path(snakemake.output.passed).write_text(summary, encoding="utf-8")
