# How probable long intervals are, for the box of the first scene.


rule tails_table:
    input:
        code=code("cli.tails"),
    output:
        table=report(
            ensure(f"{RESULTS}/tails.csv", non_empty=True),
            caption="../report/shared_table.rst",
            category="Tables",
            subcategory="all scenes",
            labels={"table": "tails", "what a row says": TABLES["tails"].meaning},
        ),
    log:
        f"{RESULTS}/logs/tails_table.log",
    benchmark:
        f"{RESULTS}/benchmarks/tails_table.tsv"
    params:
        measured=tails_parameters(),
    shell:
        "python -m twodiscs.cli.tails --parameters {params.measured:q}"
        " --output {output.table:q} > {log:q} 2>&1"


rule tails_figure:
    input:
        table=f"{RESULTS}/tails.csv",
        code=code("cli.figure", "figures.tails"),
    output:
        pdf=f"{RESULTS}/figures/tails.pdf",
        png=report(
            f"{RESULTS}/figures/tails.png",
            caption="../report/shared_figure.rst",
            category=SHARED["tails"].category,
            subcategory="all scenes",
            labels=SHARED["tails"].labels,
        ),
    log:
        f"{RESULTS}/logs/figure-tails.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure-tails.tsv"
    params:
        caption=SHARED["tails"].caption,
    shell:
        "python -m twodiscs.cli.figure tails --scene '{{}}'"
        " --table tails={input.table:q} --output {output.pdf:q} {output.png:q}"
        " > {log:q} 2>&1"


rule tails:
    input:
        rules.tails_table.output,
        rules.tails_figure.output,
