# `snakemake` in this folder builds everything; the workflow itself is workflow/Snakefile.
include: "workflow/Snakefile"


# Rules of an included file are not built without a target.
rule default:
    """The build without a target: all targets of the configuration."""
    input:
        lambda w: ASKED_FOR,
    localrule: True
