# How every method behaves where arithmetic has it hard, for the box of the first scene. The long runs
# are the same measurement of the dynamics with ten times the events; nothing else asks for them.


rule stability_table:
    input:
        code=code("cli.stability"),
        compiled=expand(
            f"{RESULTS}/.compiled/{{kernels}}", kernels=["montecarlo", "dynamics"]
        ),
    output:
        table=report(
            ensure(f"{RESULTS}/stability.csv", non_empty=True),
            caption="../report/shared_table.rst",
            category="Tables",
            subcategory="all scenes",
            labels={
                "table": "stability",
                "what a row says": TABLES["stability"].meaning,
            },
        ),
    log:
        f"{RESULTS}/logs/stability_table.log",
    benchmark:
        f"{RESULTS}/benchmarks/stability_table.tsv"
    params:
        measured=stability_parameters(ordinary=10**9, hard=10**8),
    shell:
        "python -m twodiscs.cli.stability stability --parameters {params.measured:q}"
        " --output {output.table:q} > {log:q} 2>&1"


rule stability:
    input:
        rules.stability_table.output,
        shared_figure_files("stability"),


rule long_runs:
    input:
        code=code("cli.stability"),
        compiled=expand(
            f"{RESULTS}/.compiled/{{kernels}}", kernels=["montecarlo", "dynamics"]
        ),
    output:
        table=ensure(f"{RESULTS}/long_runs.csv", non_empty=True),
    log:
        f"{RESULTS}/logs/long_runs.log",
    benchmark:
        f"{RESULTS}/benchmarks/long_runs.tsv"
    params:
        measured=stability_parameters(ordinary=10**10, hard=10**9),
    shell:
        "python -m twodiscs.cli.stability long_runs --parameters {params.measured:q}"
        " --output {output.table:q} > {log:q} 2>&1"
