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
        code=code("pipeline.jobs.table", "comparison.tables.exact"),
    shell:
        "python -m twodiscs.pipeline.jobs.table {wildcards.table} {params.box} --radii {params.radii}"
        " --output {output.table} > {log} 2>&1"


def shards_of(stage):
    """Return an input function: the shards of a point of a stage, none where one job does it all."""

    def files(w):
        folder = f"{RESULTS}/{w.scene}/shards/{stage}/{w.radius}"
        pieces = cost.shards(SCENES[w.scene], stage, float(w.radius))
        return [f"{folder}/{part}-{first}-{stop}.json" for part, first, stop in pieces]

    return files


def argument(stage, name):
    """Return a function of the wildcards: an argument of the job of a stage at a radius."""
    return lambda w: word(SCENES[w.scene].arguments(stage, w.radius)[name])


# The module of each stage is imported by its own jobs alone.
POINT = {
    stage: code("pipeline.jobs.point", without=tuple({*STAGES.values()} - {module}))
    for stage, module in STAGES.items()
}

for stage, does, names in (
    ("monte_carlo", "Sample volume and areas", ("quantities", "samples", "shell")),
    ("dynamics", "Count events by molecular dynamics", ("target", "budget")),
    ("intervals", "Record intervals between hops", ("event", "intervals", "budget")),
):

    rule:
        name:
            stage
        message:
            does + " at the radius {wildcards.radius} of {wildcards.scene}."
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
            box=box,
            **{name: argument(stage, name) for name in names},
            seed=argument(stage, "seed"),
            shards=lambda w, input: braced(input.shards),
            code=POINT[stage],
        shell:
            f"python -m twodiscs.pipeline.jobs.point {stage} {{params.box}} --radius {{wildcards.radius}}"
            + "".join(f" --{name} {{params.{name}}}" for name in (*names, "seed"))
            + " --shards {params.shards} --output {output.point} > {log} 2>&1"


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
        "python -m twodiscs.pipeline.jobs.point {wildcards.stage} {params.box} --radius {wildcards.radius}"
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
        radius=lambda w: SCENES[w.scene].watch.trajectory,
        seed=lambda w: SCENES[w.scene].trajectory_seed,
        code=code("pipeline.jobs.table", "comparison.tables.trajectory"),
    shell:
        "python -m twodiscs.pipeline.jobs.table trajectory {params.box} --radius {params.radius}"
        " --seed {params.seed} --output {output.table} > {log} 2>&1"
