# What is found at each radius: exact values, Monte Carlo, molecular dynamics. A radius is a job; where
# it is more work than one job should do it is the sum of shards, which are jobs too.


rule exact:
    """Exact values at all radii of a scene: which regime each is in, volume, areas, mean times."""
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
        radii=lambda w: word(SCENES[w.scene].exact_radii(w.table)),
        code=code(
            "twodiscs_paper.pipeline.jobs.table", "twodiscs.comparison.tables.exact"
        ),
    shell:
        "python -m twodiscs_paper.pipeline.jobs.table {wildcards.table} {params.box} --radii {params.radii}"
        " --output {output.table} > {log} 2>&1"


# What the loop sets is not known any more when a shell starts, so it is among the parameters.
for stage in STAGES:

    rule:
        """One radius: volume and areas by Monte Carlo, events counted, or intervals between hops."""
        name:
            stage
        input:
            shards=shards_of(stage),
        output:
            point=f"{RESULTS}/{{scene}}/points/{stage}/{{radius}}.json",
        log:
            f"{RESULTS}/logs/{{scene}}/{stage}/{{radius}}.log",
        benchmark:
            f"{RESULTS}/benchmarks/{{scene}}/{stage}/{{radius}}.tsv"
        resources:
            runtime=minutes(stage),
        params:
            stage=stage,
            box=box,
            work=work_of(stage),
            shards=lambda w, input: braced(input.shards),
            code=POINT[stage],
        shell:
            "python -m twodiscs_paper.pipeline.jobs.point {params.stage} {params.box} --radius {wildcards.radius}"
            " {params.work} --shards {params.shards} --output {output.point} > {log} 2>&1"


rule shard:
    """Do some blocks of the work of a point. Which accuracy is asked for is of no consequence to it."""
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
        code=lambda w: POINT[w.stage],
    shell:
        "python -m twodiscs_paper.pipeline.jobs.point {wildcards.stage} {params.box} --radius {wildcards.radius}"
        " {params.work} --part {wildcards.part} --blocks {wildcards.first} {wildcards.stop}"
        " --output {output.shard} > {log} 2>&1"


rule trajectory:
    """Follow one trajectory, event by event."""
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
        code=code(
            "twodiscs_paper.pipeline.jobs.table",
            "twodiscs.comparison.tables.trajectory",
        ),
    shell:
        "python -m twodiscs_paper.pipeline.jobs.table trajectory {params.box} --radius {params.radius}"
        " --seed {params.seed} --output {output.table} > {log} 2>&1"
