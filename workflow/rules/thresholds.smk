# Power laws of mean times where an event dies out, in every scene without effects.


rule thresholds_table:
    input:
        distributions=f"{RESULTS}/distributions.csv",
        times=list(mean_time_tables().values()),
        code=code("cli.thresholds"),
    output:
        table=report(
            ensure(f"{RESULTS}/thresholds.csv", non_empty=True),
            caption="../report/shared_table.rst",
            category="Tables",
            subcategory="all scenes",
            labels={
                "table": "thresholds",
                "what a row says": TABLES["thresholds"].meaning,
            },
        ),
    log:
        f"{RESULTS}/logs/thresholds_table.log",
    benchmark:
        f"{RESULTS}/benchmarks/thresholds_table.tsv"
    params:
        scenes={s.name: (s.width, s.height) for s in PLAIN},
        times=" ".join(f"--times {n}={t}" for n, t in mean_time_tables().items()),
    shell:
        "python -m twodiscs.cli.thresholds --scenes {params.scenes:q} {params.times}"
        " --distributions {input.distributions:q} --output {output.table:q} > {log:q} 2>&1"


rule thresholds:
    input:
        rules.thresholds_table.output,
        shared_figure_files("thresholds"),
