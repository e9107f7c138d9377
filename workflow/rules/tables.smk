# What the jobs of a scene found, gathered into tables and set against the exact values; and the verdict:
# exact theory = Monte Carlo = molecular dynamics? Its table always comes to be.


rule table:
    input:
        tables=lambda w: FILES.tables_beside(SCENES[w.scene], w.table).values(),
        points=lambda w: FILES.points(SCENES[w.scene], w.table),
    output:
        table=report(
            ensure(f"{RESULTS}/{{scene}}/{{table}}.csv", non_empty=True),
            caption="../report/table.rst",
            category="Tables",
            subcategory="{scene}",
            labels=lambda w: {
                "table": w.table,
                "what a row says": SCENE_TABLES[w.table].meaning(),
            },
        ),
    log:
        log_of("{scene}/{table}_table"),
    benchmark:
        benchmark_of("{scene}/{table}_table")
    params:
        about=lambda w: about(w.scene),
        job=lambda w: as_json(SCENES[w.scene].table_job(GATHERED[w.table])),
        tables=lambda w, input: named_tables(
            FILES.tables_beside(SCENES[w.scene], w.table), input.tables
        ),
        points=lambda w, input: str(Path(input.points[0]).parents[2]),
        code=lambda w: table_code("comparison.gather", SCENE_TABLES[w.table]),
    shell:
        "python -m twodiscs.pipeline.jobs table comparison.gather --function {wildcards.table}_rows"
        " --parameters {params.job:q} --table {params.tables:q} --points {params.points:q}"
        " --output {output.table:q}"
        " --about {params.about:q} --code {params.code} > {log:q} 2>&1"


CHECKED = [scene for scene in SCENES.values() if "check" in scene.tables]


rule check:
    input:
        tables=[FILES.tables(scene)["check"] for scene in CHECKED],
    output:
        passed=f"{RESULTS}/check.passed",
    log:
        log_of("check"),
    benchmark:
        benchmark_of("check")
    params:
        about=about(None),
        tables=lambda w, input: named_tables(
            [scene.name for scene in CHECKED], input.tables
        ),
        code=table_code("pipeline.results.verdict", SCENE_TABLES["check"]),
    shell:
        "python -m twodiscs.pipeline.jobs verdict pipeline.results.verdict --table {params.tables:q}"
        " --output {output.passed:q}"
        " --about {params.about:q} --code {params.code} > {log:q} 2>&1"
