"""The table of a study, or a part of it, from parameters and other tables."""

import inspect

from twodiscs_paper.pipeline.job import start  # isort: split

from twodiscs.model.scene import Box
from twodiscs_paper.catalogue import STUDY_TABLES, read_table

start(snakemake.log[0])
is_part = snakemake.wildcards.get("part") is not None
table = STUDY_TABLES[snakemake.wildcards.table]
work = table.part if is_part else table.rows
taken = inspect.signature(work).parameters
given = {name: value for name, value in snakemake.params.given.items() if is_part or name in taken}
if "box" in given:
    given["box"] = Box(**given["box"])
if "tables" in taken:
    paths = zip(snakemake.params.names, snakemake.input.get("tables", []), strict=True)
    given["tables"] = {name: read_table(path) for name, path in paths}
table.write_and_log(snakemake.output.table, work(**given))
