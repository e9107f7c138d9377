# The results of a scene: at each radius (exact values, Monte Carlo, molecular dynamics), their tables, and the
# verdict: exact theory = Monte Carlo = molecular dynamics? A radius is a job. If it is too much work for one job,
# it is the sum of shards, which are jobs, too.


rule code:
    """The checksums of some sources. Jobs have them as an input, so an edit reruns those that run the code."""
    input:
        sources=lambda w: CODE[w.group],
    output:
        sums=f"{RESULTS}/code/{{group}}.sha256",
    log:
        f"{RESULTS}/logs/code/{{group}}.log",
    localrule: True
    shell:
        "sha256sum {input.sources:q} | sed 's|  .*/|  |' > {output.sums:q} 2> {log:q}"


rule monte_carlo:
    """Volume and areas at one radius, by Monte Carlo."""
    input:
        shards=shards,
        code=code("point", "physics"),
    output:
        point=f"{RESULTS}/{{scene}}/points/{{stage}}/{{radius}}.json",
    log:
        f"{RESULTS}/logs/{{scene}}/{{stage}}/{{radius}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/{{stage}}/{{radius}}.tsv"
    wildcard_constraints:
        stage="monte_carlo",
    resources:
        runtime=minutes,
    params:
        box=box,
        work=lambda w: SCENES[w.scene].arguments(w.stage),
        shard_work=lambda w: SCENES[w.scene].shard_arguments(w.stage),
    script:
        "../scripts/point.py"


use rule monte_carlo as dynamics with:
    """Mean times at one radius: events counted by molecular dynamics."""
    wildcard_constraints:
        stage="dynamics",


use rule monte_carlo as intervals with:
    """The histogram of intervals between hops at one radius, by molecular dynamics."""
    wildcard_constraints:
        stage="intervals",


use rule monte_carlo as shard with:
    """Some blocks of the work of a point of any stage, which do not depend on the accuracy."""
    input:
        code=code("point", "physics"),
    output:
        point=f"{RESULTS}/{{scene}}/shards/{{stage}}/{{radius}}/{{component}}-{{first}}-{{stop}}.json",
    log:
        f"{RESULTS}/logs/{{scene}}/{{stage}}/{{radius}}_{{component}}-{{first}}-{{stop}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/{{stage}}/{{radius}}_{{component}}-{{first}}-{{stop}}.tsv"
    wildcard_constraints:
        stage="|".join(STAGES),
    params:
        work=lambda w: SCENES[w.scene].shard_arguments(w.stage),


rule trajectory:
    """One trajectory, event by event."""
    input:
        code=code("table", "physics", "tables"),
    output:
        table=f"{RESULTS}/{{scene}}/{{table}}.csv",
    log:
        f"{RESULTS}/logs/{{scene}}/{{table}}.log",
    wildcard_constraints:
        table="trajectory",
    params:
        box=box,
        given=lambda w: {
            "radius": SCENES[w.scene].quantities.trajectory,
            "seed": SCENES[w.scene].trajectory_seed,
        },
    script:
        "../scripts/table.py"


use rule trajectory as exact with:
    """Exact values at all radii of a scene: the regime, volume, areas, mean times."""
    wildcard_constraints:
        table="grid|theory",
    localrule: True
    params:
        given=lambda w: {"radii": SCENES[w.scene].exact_radii(w.table)},


use rule exact as table with:
    """The points of a scene in a table, beside the exact values."""
    input:
        unpack(lambda w: CONFIGURATION.points(w.scene, w.table)),
        code=code("table", "physics", "tables"),
    output:
        table=report(f"{RESULTS}/{{scene}}/{{table}}.csv", category="Tables", subcategory="{scene}"),
    wildcard_constraints:
        table="|".join(POINT_TABLES),
    localrule: True
    params:
        given=lambda w: {"events": SCENES[w.scene].quantities.areas},
        work=lambda w: {
            stage: SCENES[w.scene].arguments(stage)
            for stage in CONFIGURATION.points(w.scene, w.table)
        },


rule check:
    """Do exact theory, Monte Carlo and dynamics agree? If not, it fails and names the comparisons."""
    input:
        tables=CONFIGURATION.checked(),
        code=code("check", "physics", "tables", "documents"),
    output:
        passed=f"{RESULTS}/check.passed",
    log:
        f"{RESULTS}/logs/check.log",
    localrule: True
    script:
        "../scripts/check.py"
