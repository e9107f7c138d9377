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


rule tails:
    input:
        rules.tails_table.output,
        shared_figure_files("tails"),
