# How the times to the next hop are distributed: at the radii of the hop histograms of every scene without
# effects, and where hops die out in the first one.


rule distributions_table:
    input:
        code=code("cli.distributions"),
        compiled=f"{RESULTS}/.compiled/dynamics",
    output:
        table=report(
            ensure(f"{RESULTS}/distributions.csv", non_empty=True),
            caption="../report/shared_table.rst",
            category="Tables",
            subcategory="all scenes",
            labels={
                "table": "distributions",
                "what a row says": TABLES["distributions"].meaning,
            },
        ),
    log:
        f"{RESULTS}/logs/distributions_table.log",
    benchmark:
        f"{RESULTS}/benchmarks/distributions_table.tsv"
    params:
        measured=distributions_parameters(),
    shell:
        "python -m twodiscs.cli.distributions --parameters {params.measured:q}"
        " --output {output.table:q} > {log:q} 2>&1"


rule distributions:
    input:
        rules.distributions_table.output,
        shared_figure_files("distributions"),
