# The results of a scene: at each radius (exact values, Monte Carlo, molecular dynamics), their tables, and the
# verdict: exact theory = Monte Carlo = molecular dynamics? A radius is a job. If it is too much work for one job,
# it is the sum of shards, which are jobs, too.


rule exact:
    """Exact values at all radii of a scene: the regime, volume, areas, mean times."""
    output:
        table=f"{RESULTS}/{{scene}}/{{table}}.csv",
    log:
        f"{RESULTS}/logs/{{scene}}/{{table}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/{{table}}.tsv"
    wildcard_constraints:
        table="grid|theory",
    localrule: True
    params:
        box=box,
        radii=lambda w: SCENES[w.scene].exact_radii(w.table),
        code=lambda w: code(
            "twodiscs_paper.pipeline.jobs.table",
            "twodiscs.comparison.tables.theory",
        ),
    shell:
        "python -P -m twodiscs_paper.pipeline.jobs.table {wildcards.table} {params.box:q} --radii {params.radii}"
        " --output {output.table:q} > {log:q} 2>&1"


rule monte_carlo:
    """Volume and areas at one radius, by Monte Carlo."""
    input:
        shards=shards_of("monte_carlo"),
    output:
        point=f"{RESULTS}/{{scene}}/points/monte_carlo/{{radius}}.json",
    log:
        f"{RESULTS}/logs/{{scene}}/monte_carlo/{{radius}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/monte_carlo/{{radius}}.tsv"
    resources:
        runtime=minutes("monte_carlo"),
    params:
        box=box,
        work=work_of("monte_carlo"),
        shards=lambda w, input: braced(input.shards),
        code=point_code("monte_carlo"),
    shell:
        "python -P -m twodiscs_paper.pipeline.jobs.point monte_carlo {params.box:q} --radius {wildcards.radius}"
        " {params.work:q} --shards {params.shards} --output {output.point:q} > {log:q} 2>&1"


rule dynamics:
    """Mean times at one radius: events counted by molecular dynamics."""
    input:
        shards=shards_of("dynamics"),
    output:
        point=f"{RESULTS}/{{scene}}/points/dynamics/{{radius}}.json",
    log:
        f"{RESULTS}/logs/{{scene}}/dynamics/{{radius}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/dynamics/{{radius}}.tsv"
    resources:
        runtime=minutes("dynamics"),
    params:
        box=box,
        work=work_of("dynamics"),
        shards=lambda w, input: braced(input.shards),
        code=point_code("dynamics"),
    shell:
        "python -P -m twodiscs_paper.pipeline.jobs.point dynamics {params.box:q} --radius {wildcards.radius}"
        " {params.work:q} --shards {params.shards} --output {output.point:q} > {log:q} 2>&1"


rule intervals:
    """The histogram of intervals between hops at one radius, by molecular dynamics."""
    input:
        shards=shards_of("intervals"),
    output:
        point=f"{RESULTS}/{{scene}}/points/intervals/{{radius}}.json",
    log:
        f"{RESULTS}/logs/{{scene}}/intervals/{{radius}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/intervals/{{radius}}.tsv"
    resources:
        runtime=minutes("intervals"),
    params:
        box=box,
        work=work_of("intervals"),
        shards=lambda w, input: braced(input.shards),
        code=point_code("intervals"),
    shell:
        "python -P -m twodiscs_paper.pipeline.jobs.point intervals {params.box:q} --radius {wildcards.radius}"
        " {params.work:q} --shards {params.shards} --output {output.point:q} > {log:q} 2>&1"


rule shard:
    """Some blocks of the work of a point of any stage, which do not depend on the accuracy."""
    output:
        shard=f"{RESULTS}/{{scene}}/shards/{{stage}}/{{radius}}/{{part}}-{{first}}-{{stop}}.json",
    log:
        f"{RESULTS}/logs/{{scene}}/{{stage}}/{{radius}}_{{part}}-{{first}}-{{stop}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/{{stage}}/{{radius}}_{{part}}-{{first}}-{{stop}}.tsv"
    resources:
        runtime=minutes(),
    params:
        box=box,
        work=lambda w: words(SCENES[w.scene].shard_arguments(w.stage, w.radius)),
        code=point_code(),
    shell:
        "python -P -m twodiscs_paper.pipeline.jobs.point {wildcards.stage} {params.box:q} --radius {wildcards.radius}"
        " {params.work:q} --part {wildcards.part} --blocks {wildcards.first} {wildcards.stop}"
        " --output {output.shard:q} > {log:q} 2>&1"


rule trajectory:
    """One trajectory, event by event."""
    output:
        table=f"{RESULTS}/{{scene}}/trajectory.csv",
    log:
        f"{RESULTS}/logs/{{scene}}/trajectory.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/trajectory.tsv"
    params:
        box=box,
        radius=lambda w: SCENES[w.scene].quantities.trajectory,
        seed=lambda w: SCENES[w.scene].trajectory_seed,
        code=lambda w: code(
            "twodiscs_paper.pipeline.jobs.table",
            "twodiscs.comparison.tables.trajectory",
        ),
    shell:
        "python -P -m twodiscs_paper.pipeline.jobs.table trajectory {params.box:q} --radius {params.radius}"
        " --seed {params.seed} --output {output.table:q} > {log:q} 2>&1"


rule table:
    """The points of a scene in a table, beside the exact values."""
    input:
        theory=f"{RESULTS}/{{scene}}/theory.csv",
        monte_carlo=lambda w: CONFIGURATION.points(w.scene, w.table, "monte_carlo"),
        dynamics=lambda w: CONFIGURATION.points(w.scene, w.table, "dynamics"),
        intervals=lambda w: CONFIGURATION.points(w.scene, w.table, "intervals"),
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
        ),
    shell:
        "python -P -m twodiscs_paper.pipeline.jobs.table {wildcards.table} {params.box:q} --areas {params.areas}"
        " --theory {input.theory:q} --monte_carlo {params.monte_carlo} --dynamics {params.dynamics}"
        " --intervals {params.intervals} --forecast {input.forecast:q} --output {output.table:q} > {log:q} 2>&1"


rule check:
    """Do exact theory, Monte Carlo and dynamics agree? If not, it fails and names the comparisons."""
    input:
        tables=[
            CONFIGURATION.table("check", scene)
            for scene in CONFIGURED
            if "check" in SCENES[scene].tables
        ],
        studies=[
            CONFIGURATION.table(study.tables[0].name())
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
