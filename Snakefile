# `snakemake` in this folder builds everything; the workflow itself stands in workflow/Snakefile.
include: "workflow/Snakefile"
