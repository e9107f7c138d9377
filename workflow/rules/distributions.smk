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


rule distributions_figure:
    input:
        table=f"{RESULTS}/distributions.csv",
        code=code("cli.figure", "figures.distributions"),
    output:
        pdf=f"{RESULTS}/figures/distributions.pdf",
        png=report(
            f"{RESULTS}/figures/distributions.png",
            caption="../report/shared_figure.rst",
            category=SHARED["distributions"].category,
            subcategory="all scenes",
            labels=SHARED["distributions"].labels,
        ),
    log:
        f"{RESULTS}/logs/figure-distributions.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure-distributions.tsv"
    params:
        caption=SHARED["distributions"].caption,
    shell:
        "python -m twodiscs.cli.figure distributions --scene '{{}}'"
        " --table distributions={input.table:q} --output {output.pdf:q} {output.png:q}"
        " > {log:q} 2>&1"


rule distributions:
    input:
        rules.distributions_table.output,
        rules.distributions_figure.output,
