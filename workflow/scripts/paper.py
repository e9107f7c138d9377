"""The manuscript, and the table of the numbers that it prints."""

import sys

from twodiscs_paper.pipeline.documents.manuscript import PaperNumbers, typeset

sys.stderr = open(snakemake.log[0], "w")
numbers = typeset(snakemake.input.template, snakemake.output.pdf, **snakemake.params.contents)
PaperNumbers.write(snakemake.output.numbers, numbers)
