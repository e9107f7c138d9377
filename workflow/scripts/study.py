"""The table of a study, or a part of it, from parameters and other tables."""

import inspect
from pathlib import Path

from twodiscs.model.box import Box
from twodiscs_paper.catalogue import STUDY_TABLES, read_table
from twodiscs_paper.pipeline.job import start

start(snakemake.log[0])
is_part = snakemake.wildcards.get("part") is not None
output = Path(snakemake.output.table)
table = STUDY_TABLES[snakemake.wildcards.study if is_part else output.stem]
work = table.part if is_part else table.rows
given = dict(snakemake.params.given)
if "box" in given:
    given["box"] = Box(**given["box"])
if "tables" in inspect.signature(work).parameters:
    paths = zip(snakemake.params.names, snakemake.input.get("tables", []), strict=True)
    given["tables"] = {name: read_table(path) for name, path in paths}
table.write(output, work(**given))
