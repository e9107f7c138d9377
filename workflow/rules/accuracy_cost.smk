# What a digit costs by every method, measured in one job: error against processor time. It takes
# seconds for a result, so its table and its figures differ from run to run, and nothing else reads
# them but the manuscript and the report.

COST_FIGURES = ("accuracy_cost", "accuracy_cost_by_radius")


rule accuracy_cost_table:
    input:
        code=code("cli.accuracy_cost"),
        compiled=expand(
            f"{RESULTS}/.compiled/{{kernels}}", kernels=["montecarlo", "dynamics"]
        ),
    output:
        table=report(
            ensure(f"{RESULTS}/accuracy_cost.csv", non_empty=True),
            caption="../report/shared_table.rst",
            category="Tables",
            subcategory="all scenes",
            labels={
                "table": "accuracy_cost",
                "what a row says": TABLES["accuracy_cost"].meaning,
            },
        ),
    log:
        f"{RESULTS}/logs/accuracy_cost_table.log",
    benchmark:
        f"{RESULTS}/benchmarks/accuracy_cost_table.tsv"
    params:
        seconds=CONFIGURATION.accuracy_cost_seconds,
    shell:
        "python -m twodiscs.cli.accuracy_cost --seconds {params.seconds}"
        " --output {output.table:q} > {log:q} 2>&1"


rule accuracy_cost_figure:
    input:
        table=f"{RESULTS}/accuracy_cost.csv",
        code=lambda w: code("cli.figure", f"figures.{w.figure}"),
    output:
        pdf=f"{RESULTS}/figures/{{figure}}.pdf",
        png=report(
            f"{RESULTS}/figures/{{figure}}.png",
            caption="../report/shared_figure.rst",
            category=lambda w: SHARED[w.figure].category,
            subcategory="all scenes",
            labels=lambda w: SHARED[w.figure].labels,
        ),
    log:
        f"{RESULTS}/logs/figure-{{figure}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure-{{figure}}.tsv"
    wildcard_constraints:
        figure="|".join(COST_FIGURES),
    params:
        caption=lambda w: SHARED[w.figure].caption,
    shell:
        "python -m twodiscs.cli.figure {wildcards.figure} --scene '{{}}'"
        " --table accuracy_cost={input.table:q} --output {output.pdf:q} {output.png:q}"
        " > {log:q} 2>&1"


rule:
    name:
        "accuracy_cost"
    input:
        f"{RESULTS}/accuracy_cost.csv",
        expand(
            f"{RESULTS}/figures/{{figure}}.{{kind}}",
            figure=COST_FIGURES,
            kind=["pdf", "png"],
        ),
