# What the jobs of a scene found, gathered into tables and set against the exact values; and the verdict:
# exact theory = Monte Carlo = molecular dynamics? Its table always comes to be.

GATHERED = {
    "volume": ["monte_carlo"],
    "areas": ["monte_carlo"],
    "mean_times": ["dynamics"],
    "hop_histogram": ["intervals"],
    "check": [*STAGES],
    "cost": [*STAGES],
}


def gathered_points(scene, table):
    """Return the files that a table of a scene is gathered from."""
    if table == "cost":
        return cost_files(scene)
    return point_files(scene, GATHERED[table])


def tables_beside(scene, table):
    """Return {name: path} of the tables that another one needs; of a forecast, if there is one."""
    if table != "cost":
        return {"theory": f"{RESULTS}/{scene}/theory.csv"}
    path = f"{RESULTS}/forecast.csv"
    return {"forecast": path} if os.path.exists(path) else {}


rule table:
    input:
        tables=lambda w: tables_beside(w.scene, w.table).values(),
        points=lambda w: gathered_points(SCENES[w.scene], w.table),
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
    wildcard_constraints:
        table="|".join(GATHERED),
    params:
        job=lambda w: as_json(SCENES[w.scene].table_job(GATHERED[w.table])),
        tables=lambda w: named_tables(tables_beside(w.scene, w.table)),
        points=f"{RESULTS}/{{scene}}/points",
        code=lambda w: table_code("comparison.gather", SCENE_TABLES[w.table]),
    shell:
        "{JOB} table comparison.gather --function {wildcards.table}_rows --parameters {params.job:q}"
        " --table {params.tables:q} --points {params.points:q} --output {output.table:q}"
        " > {log:q} 2>&1"


rule check:
    input:
        tables=[
            files["check"]
            for files in map(table_files, SCENES.values())
            if "check" in files
        ],
    output:
        passed=f"{RESULTS}/check.passed",
    log:
        log_of("check"),
    benchmark:
        benchmark_of("check")
    params:
        tables=named_tables(
            {
                name: table_files(scene)["check"]
                for name, scene in SCENES.items()
                if "check" in scene.tables
            }
        ),
        code=table_code("comparison.check", SCENE_TABLES["check"]),
    shell:
        "{JOB} verdict comparison.check --table {params.tables:q} --output {output.passed:q}"
        " > {log:q} 2>&1"
