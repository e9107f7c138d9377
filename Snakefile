# `snakemake` in this folder builds everything; the workflow itself stands in workflow/Snakefile.
include: "workflow/Snakefile"


# Rules of an included file are not built without a target.
rule default:
    """What is built without a target: everything that the configuration asks for."""
    input:
        lambda w: ASKED_FOR,
    localrule: True
