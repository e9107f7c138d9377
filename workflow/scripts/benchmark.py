"""The speed of the engines on this machine."""

from twodiscs_paper.benchmark import benchmarks
from twodiscs_paper.pipeline.job import start
from twodiscs_paper.studies.effects.study import Benchmark

start(snakemake.log[0])
Benchmark.write_and_log(snakemake.output.table, benchmarks(snakemake.params.scenes))
