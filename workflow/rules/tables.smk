# What the jobs of a scene found, gathered into tables and set against the exact values.


rule table:
    input:
        theory=f"{RESULTS}/{{scene}}/theory.csv",
        points=lambda w: table_points(SCENES[w.scene], w.table),
        forecast=lambda w: forecast_file(w.table),
        code=code("cli.tables"),
    output:
        table=report(
            ensure(f"{RESULTS}/{{scene}}/{{table}}.csv", non_empty=True),
            caption="../report/table.rst",
            category="Tables",
            subcategory="{scene}",
            labels=lambda w: {
                "table": w.table,
                "what a row says": TABLES[w.table].meaning,
            },
        ),
    log:
        f"{RESULTS}/logs/{{scene}}/{{table}}_table.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/{{table}}_table.tsv"
    wildcard_constraints:
        table="volume|areas|mean_times|hop_histogram|cost",
    params:
        scene=lambda w: table_parameters(SCENES[w.scene]),
        forecast=lambda w, input: (
            f"--forecast {input.forecast}" if input.forecast else ""
        ),
    shell:
        "python -m twodiscs.cli.tables {wildcards.table} --scene {params.scene:q}"
        " --theory {input.theory:q} --points {input.points:q} {params.forecast}"
        " --output {output.table:q} > {log:q} 2>&1"
