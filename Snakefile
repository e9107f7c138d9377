# `snakemake` in this folder builds everything; the workflow itself stands in workflow/Snakefile.
include: "workflow/Snakefile"


rule default:
    """What is built without a target: everything that the configuration asks for."""
    default_target: True
    input:
        rules.all.input,
    localrule: True
