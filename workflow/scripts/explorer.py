"""The explorer, with the points that are built."""

from pathlib import Path

from twodiscs_paper.pipeline.job import start  # isort: split

from twodiscs_paper.pipeline.documents.explorer import explorer

start(snakemake.log[0])
page = explorer(
    snakemake.input.parts,
    snakemake.input.get("tables", []),
    snakemake.params.scenes,
    snakemake.params.seed,
)
Path(snakemake.output.html).write_text(page, encoding="utf-8")
