# The points of a scene, gathered into tables and set against the exact values; and the verdict: exact
# theory = Monte Carlo = molecular dynamics?


rule table:
    """Gather the points of a scene into a table, beside the exact values."""
    input:
        theory=f"{RESULTS}/{{scene}}/theory.csv",
        monte_carlo=lambda w: FILES.points(w.scene, w.table, "monte_carlo"),
        dynamics=lambda w: FILES.points(w.scene, w.table, "dynamics"),
        intervals=lambda w: FILES.points(w.scene, w.table, "intervals"),
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
        f"{RESULTS}/logs/{{scene}}/{{table}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/{{table}}.tsv"
    wildcard_constraints:
        table="|".join(GATHERED),
    localrule: True
    params:
        box=box,
        areas=lambda w: word(SCENES[w.scene].quantities.areas),
        monte_carlo=lambda w, input: braced(input.monte_carlo),
        dynamics=lambda w, input: braced(input.dynamics),
        intervals=lambda w, input: braced(input.intervals),
        code=lambda w: code(
            "twodiscs_paper.pipeline.jobs.table",
            SCENE_TABLES[w.table].__module__,
        ),
    shell:
        "python -m twodiscs_paper.pipeline.jobs.table {wildcards.table} {params.box} --areas {params.areas}"
        " --theory {input.theory} --monte_carlo {params.monte_carlo} --dynamics {params.dynamics}"
        " --intervals {params.intervals} --results $(dirname $(dirname {output.table})) --output {output.table}"
        " > {log} 2>&1"


rule check:
    """Say whether exact theory, Monte Carlo and dynamics agree; fail and name where they do not."""
    input:
        tables=[
            FILES.table("check", scene)
            for scene in CONFIGURED
            if "check" in SCENES[scene].tables
        ],
        studies=[
            FILES.table(study.tables[0].name())
            for study in STUDIES.values()
            if study.checked and study.name in CONFIGURATION.shared
        ],
    output:
        passed=f"{RESULTS}/check.passed",
    log:
        f"{RESULTS}/logs/check.log",
    benchmark:
        f"{RESULTS}/benchmarks/check.tsv"
    localrule: True
    params:
        configuration=json.dumps(config, sort_keys=True),
        code=code("twodiscs_paper.pipeline.results.verdict"),
    shell:
        "python -m twodiscs_paper.pipeline.results.verdict {input.tables} --studies {input.studies}"
        " --configuration {params.configuration:q} --output {output.passed} > {log} 2>&1"
