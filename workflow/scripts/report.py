"""The report on all results."""

from pathlib import Path

from twodiscs_paper.pipeline.documents.report import contents, page
from twodiscs_paper.pipeline.job import start

start(snakemake.log[0])
folder = Path(snakemake.output.html).parent
files = [Path(path).relative_to(folder).as_posix() for path in snakemake.input.results]
template = Path(snakemake.input.front).read_text(encoding="utf-8")
shown = contents(folder, files, snakemake.params.scenes, snakemake.params.run)
Path(snakemake.output.html).write_text(page(template, shown), encoding="utf-8")
