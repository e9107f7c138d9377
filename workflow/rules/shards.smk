# Points that may take more than one job should do. Their work is cut into pieces of an absolute grid; a shard
# does one of them, whatever accuracy is asked for. A plan says which shards all points of a scene need, as far as
# those of the plan before it can tell; plans go on until one of them needs nothing more. A merge adds up the
# shards of its own point: another radius is of no consequence to it.
checkpoint plan:
    input:
        shards=lambda w: shard_files(w.scene, w.stage, needed_before(w)),
    output:
        plan=f"{SHARDS}/plan-{{round}}.json",
    log:
        log_of("{scene}/plan-{stage}-{round}"),
    benchmark:
        benchmark_of("{scene}/plan-{stage}-{round}")
    params:
        about=lambda w: about(w.scene),
        job=lambda w: as_json(SCENES[w.scene].plan_job(w.stage, needed_before(w))),
        points=lambda w, output: os.path.dirname(output.plan),
        module=lambda w: STAGES[w.stage],
        code=lambda w: code(STAGES[w.stage]),
    shell:
        "python -m twodiscs.pipeline.jobs plan {params.module} --parameters {params.job:q}"
        " --points {params.points:q} --output {output.plan:q}"
        " --about {params.about:q} --code {params.code} > {log:q} 2>&1"


rule shard:
    input:
        compiled=lambda w: FILES.compiled(SCENES[w.scene], w.stage),
    output:
        shard=f"{SHARDS}/{{key}}/{{part}}-{{first}}-{{stop}}.json",
        cost=f"{SHARDS}/{{key}}/cost/{{part}}-{{first}}-{{stop}}.json",
    log:
        log_of("{scene}/shard-{stage}-{key}-{part}-{first}-{stop}"),
    benchmark:
        benchmark_of("{scene}/shard-{stage}-{key}-{part}-{first}-{stop}")
    resources:
        runtime=minutes(),
    params:
        about=lambda w: about(w.scene),
        job=lambda w: as_json(
            SCENES[w.scene].shard_job(
                w.stage, w.key, w.part, int(w.first), int(w.stop)
            )
        ),
        module=lambda w: STAGES[w.stage],
        code=lambda w: code(STAGES[w.stage]),
    shell:
        "python -m twodiscs.pipeline.jobs shard {params.module} --parameters {params.job:q}"
        " --output {output.shard:q} --cost {output.cost:q}"
        " --about {params.about:q} --code {params.code} > {log:q} 2>&1"


# What waits for a checkpoint is not made again when its own parameters change. So a merge does not wait: it reads
# the names of its shards from a file that is called after the parameters, and is of no consequence later.


rule shards:
    input:
        shards=lambda w: shard_files(w.scene, w.stage, needed(w)),
    output:
        names=f"{SHARDS}/{{key}}/needed/{{name}}.json",
    log:
        log_of("{scene}/shards-{stage}-{key}-{name}"),
    benchmark:
        benchmark_of("{scene}/shards-{stage}-{key}-{name}")
    params:
        names=lambda w: kept(json.dumps({"keys": needed(w)})),
    shell:
        "cp {params.names:q} {output.names:q} 2> {log:q}"


for stage, module in STAGES.items():

    rule:
        name:
            f"{stage}_merge"
        input:
            names=ancient(lambda w, stage=stage: names_of(w.scene, stage, w.key)),
        output:
            bundle=f"{RESULTS}/{{scene}}/points/{stage}/bundles/{{key}}.json",
        log:
            log_of(f"{{scene}}/{stage}_merge-{{key}}"),
        benchmark:
            benchmark_of(f"{{scene}}/{stage}_merge-{{key}}")
        wildcard_constraints:
            scene=one_of(s.name for s in SCENES.values() if s.is_sharded(stage)),
        params:
            about=lambda w: about(w.scene),
            job=lambda w, stage=stage: as_json(SCENES[w.scene].job(stage, w.key)),
            points=lambda w, input: str(Path(input.names).parents[2]),
            module=module,
            code=code(module),
        shell:
            "python -m twodiscs.pipeline.jobs merge {params.module} --parameters {params.job:q}"
            " --keys {input.names:q} --points {params.points:q}"
            " --output {output.bundle:q}"
            " --about {params.about:q} --code {params.code} > {log:q} 2>&1"
