# What a digit costs by every method, measured in one job: error against processor time. It takes
# seconds for a result, so its table and its figures differ from run to run, and nothing else reads
# them but the manuscript and the report.


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


rule:
    name:
        "accuracy_cost"
    input:
        f"{RESULTS}/accuracy_cost.csv",
        shared_figure_files("accuracy_cost"),
        shared_figure_files("accuracy_cost_by_radius"),
