"""The explorer, with the points that are built."""

import sys
from pathlib import Path

from twodiscs_paper.pipeline.documents.explorer import explorer

sys.stderr = open(snakemake.log[0], "w")
page = explorer(
    snakemake.input.parts,
    snakemake.input.get("tables", []),
    snakemake.params.scenes,
    snakemake.params.seed,
)
Path(snakemake.output.html).write_text(page, encoding="utf-8")
