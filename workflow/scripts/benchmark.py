"""The speed of the engines on this machine, or the cost of each effect."""

from pathlib import Path

from twodiscs_paper import benchmark
from twodiscs_paper.catalogue import TABLES
from twodiscs_paper.pipeline.job import start

start(snakemake.log[0])
effects = benchmark.effects_of(snakemake.input.scenes)
path = Path(snakemake.output.table)
if path.stem == "effects_cost":
    rows = benchmark.effects_rows(effects, **benchmark.QUICK)
else:
    rows = benchmark.benchmarks(effects)
TABLES[path.stem].write(path, [TABLES[path.stem].empty(**row) for row in rows])
