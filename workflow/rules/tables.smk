# Tables of the points of a scene, beside the exact values; and the verdict: exact theory = Monte Carlo =
# molecular dynamics?


rule table:
    """The points of a scene in a table, beside the exact values."""
    input:
        theory=f"{RESULTS}/{{scene}}/theory.csv",
        monte_carlo=lambda w: FILES.points(w.scene, w.table, "monte_carlo"),
        dynamics=lambda w: FILES.points(w.scene, w.table, "dynamics"),
        intervals=lambda w: FILES.points(w.scene, w.table, "intervals"),
        forecast=lambda w: FORECAST if w.table == "cost" else [],
    output:
        table=report(
            f"{RESULTS}/{{scene}}/{{table}}.csv",
            caption="../report/table.rst",
            category="Tables",
            subcategory="{scene}",
            labels=lambda w: says(SCENE_TABLES[w.table]),
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
        areas=lambda w: SCENES[w.scene].quantities.areas,
        monte_carlo=lambda w, input: braced(input.monte_carlo),
        dynamics=lambda w, input: braced(input.dynamics),
        intervals=lambda w, input: braced(input.intervals),
        code=lambda w: code(
            "twodiscs_paper.pipeline.jobs.table",
            SCENE_TABLES[w.table].__module__,
            *family_modules("theory", SCENES[w.scene].box.family),
        ),
    shell:
        "python -P -m twodiscs_paper.pipeline.jobs.table {wildcards.table} {params.box:q} --areas {params.areas}"
        " --theory {input.theory:q} --monte_carlo {params.monte_carlo} --dynamics {params.dynamics}"
        " --intervals {params.intervals} --forecast {input.forecast:q} --output {output.table:q} > {log:q} 2>&1"


rule check:
    """Do exact theory, Monte Carlo and dynamics agree? If not, it fails and names the comparisons."""
    input:
        tables=[
            FILES.table("check", scene)
            for scene in CONFIGURED
            if "check" in SCENES[scene].tables
        ],
        studies=[
            FILES.table(study.tables[0].name())
            for study in STUDIES.values()
            if study.due and study.name in CONFIGURATION.shared
        ],
        configuration=f"{RESULTS}/configuration.json",
    output:
        passed=f"{RESULTS}/check.passed",
    log:
        f"{RESULTS}/logs/check.log",
    benchmark:
        f"{RESULTS}/benchmarks/check.tsv"
    localrule: True
    params:
        code=code("twodiscs_paper.pipeline.results.verdict"),
    shell:
        "python -P -m twodiscs_paper.pipeline.results.verdict {input.tables:q} --studies {input.studies:q}"
        " --configuration @{input.configuration:q} --output {output.passed:q} > {log:q} 2>&1"
