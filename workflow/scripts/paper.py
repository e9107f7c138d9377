"""The manuscript, and the table of the numbers that it prints."""

from pathlib import Path

from twodiscs.points.base import digest_line, require_logged
from twodiscs_paper.pipeline.documents.manuscript import PaperNumbersTable, typeset
from twodiscs_paper.pipeline.job import start

start(snakemake.log[0])
params = snakemake.params
for path in snakemake.input.results:
    require_logged(path)  # Typst reads the tables
numbers = typeset(
    snakemake.input.template,
    snakemake.output.pdf,
    [scene for scene in params.scenes if not scene["effects"]],
    [Path(path).stem for path in snakemake.input.drawn],
    params.seed,
    params.configuration,
)
PaperNumbersTable.write(snakemake.output.numbers, numbers)
Path(snakemake.log.numbers).write_text(f"{digest_line(snakemake.output.numbers)}\n", "utf-8")
