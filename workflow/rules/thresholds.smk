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


rule thresholds_figure:
    input:
        tables=[
            rules.thresholds_table.output.table,
            f"{RESULTS}/distributions.csv",
            *[mean_time_tables()[n] for n in [MAIN.name] if n in mean_time_tables()],
        ],
        code=code("cli.figure", "figures.thresholds"),
    output:
        pdf=f"{RESULTS}/figures/thresholds.pdf",
        png=report(
            f"{RESULTS}/figures/thresholds.png",
            caption="../report/shared_figure.rst",
            category=SHARED["thresholds"].category,
            subcategory="all scenes",
            labels=SHARED["thresholds"].labels,
        ),
    log:
        f"{RESULTS}/logs/figure-thresholds.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure-thresholds.tsv"
    params:
        scene={"height": MAIN.height, "width": MAIN.width},
        tables=lambda w, input: " ".join(
            f"--table {Path(t).stem}={t}" for t in input.tables
        ),
        caption=SHARED["thresholds"].caption,
    shell:
        "python -m twodiscs.cli.figure thresholds --scene {params.scene:q} {params.tables}"
        " --output {output.pdf:q} {output.png:q} > {log:q} 2>&1"


rule thresholds:
    input:
        rules.thresholds_table.output,
        rules.thresholds_figure.output,
