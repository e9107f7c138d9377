"""The manuscript, and the table of the numbers that it prints."""

import sys
from pathlib import Path

from twodiscs_paper.pipeline.documents.manuscript import PaperNumbers, typeset

sys.stderr = open(snakemake.log[0], "w")
numbers = typeset(
    snakemake.input.template,
    snakemake.output.pdf,
    [scene for scene in snakemake.params.scenes if not scene["effects"]],
    [Path(path).stem for path in snakemake.input.drawn],
    snakemake.params.seed,
    snakemake.params.configuration,
)
PaperNumbers.write(snakemake.output.numbers, numbers)
