# Which formulas of the source are right: theory decides, and so does what was measured in the first
# scene, if that is the source's box.


rule errata:
    input:
        tables=[
            path
            for name, path in table_files(MAIN).items()
            if name in ("theory", "volume", "areas", "mean_times")
        ],
        code=code("cli.errata"),
    output:
        table=report(
            ensure(f"{RESULTS}/errata.csv", non_empty=True),
            caption="../report/errata.rst",
            category="Tables",
            subcategory="all scenes",
            labels={"table": "errata", "what a row says": TABLES["errata"].meaning},
        ),
    log:
        f"{RESULTS}/logs/errata.log",
    benchmark:
        f"{RESULTS}/benchmarks/errata.tsv"
    params:
        scene={"height": MAIN.height, "width": MAIN.width},
        tables=lambda w, input: " ".join(
            f"--table {Path(t).stem}={t}" for t in input.tables
        ),
    shell:
        "python -m twodiscs.cli.errata --scene {params.scene:q} {params.tables}"
        " --output {output.table:q} > {log:q} 2>&1"
