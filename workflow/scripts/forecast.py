"""Print how long the jobs of the configuration take, and the accuracy that they reach."""

from pathlib import Path

from twodiscs_paper.configuration.yaml_files import load
from twodiscs_paper.pipeline.job_cost import table

text = table(load(snakemake.config))
Path(snakemake.log[0]).write_text(f"{text}\n", "utf-8")
print(text)
