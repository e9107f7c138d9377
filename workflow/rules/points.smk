# What is found at each radius: exact values, Monte Carlo, molecular dynamics. The radii follow from the
# configuration alone, so they are known before any job runs.


for name in ("grid", "theory"):

    rule:
        name:
            name
        output:
            table=ensure(f"{RESULTS}/{{scene}}/{name}.csv", non_empty=True),
        log:
            log_of(f"{{scene}}/{name}"),
        benchmark:
            benchmark_of(f"{{scene}}/{name}")
        params:
            about=lambda w: about(w.scene, None),
            job=lambda w, name=name: as_json(SCENES[w.scene].exact_job(name)),
            function=f"{name}_rows",
            code=table_code("theory.exact", SCENE_TABLES[name]),
        shell:
            "python -m twodiscs.pipeline.jobs table theory.exact --function {params.function}"
            " --parameters {params.job:q} --output {output.table:q}"
            " --about {params.about:q} --code {params.code} > {log:q} 2>&1"


# Kernels are compiled once, before the jobs that share them start side by side: those of the box without
# effects for every choice of what is watched, those of a scene with effects for what it watches.


rule compile:
    output:
        stamp=f"{RESULTS}/.compiled/{{kernels}}",
    log:
        log_of("compile-{kernels}"),
    benchmark:
        benchmark_of("compile-{kernels}")
    params:
        modules=lambda w: ",".join(KERNELS[w.kernels]),
        code=lambda w: code(*KERNELS[w.kernels]),
    shell:
        "python -m twodiscs.pipeline.jobs kernels {params.modules} --output {output.stamp:q}"
        " > {log:q} 2>&1"


rule compile_effects:
    output:
        stamp=f"{RESULTS}/.compiled/{{scene}}/{{stage}}",
    log:
        log_of("{scene}/compile-{stage}"),
    benchmark:
        benchmark_of("{scene}/compile-{stage}")
    params:
        job=lambda w: as_json(SCENES[w.scene].kernels(w.stage)),
        module=lambda w: STAGES[w.stage],
        code=lambda w: code(STAGES[w.stage]),
    shell:
        "python -m twodiscs.pipeline.jobs kernels {params.module} --parameters {params.job:q}"
        " --output {output.stamp:q} > {log:q} 2>&1"


# A job does a bundle of points, or a single one. Points are no outputs, which Snakemake would remove before the
# job starts: those that are there stay, unless the job is forced.


for stage, module in STAGES.items():

    rule:
        name:
            stage
        input:
            compiled=lambda w, stage=stage: FILES.compiled(SCENES[w.scene], stage),
        output:
            bundle=f"{RESULTS}/{{scene}}/points/{stage}/bundles/{{bundle}}.json",
        log:
            log_of(f"{{scene}}/{stage}-{{bundle}}"),
        benchmark:
            benchmark_of(f"{{scene}}/{stage}-{{bundle}}")
        wildcard_constraints:
            scene=one_of(s.name for s in SCENES.values() if not s.is_sharded(stage)),
        resources:
            runtime=minutes(stage),
        params:
            about=lambda w: about(w.scene),
            job=lambda w, stage=stage: as_json(
                SCENES[w.scene].bundle_job(stage, w.bundle)
            ),
            module=module,
            code=code(module),
        shell:
            "python -m twodiscs.pipeline.jobs bundle {params.module} --parameters {params.job:q}"
            " --output {output.bundle:q}"
            " --about {params.about:q} --code {params.code} > {log:q} 2>&1"


rule trajectory:
    output:
        table=ensure(f"{RESULTS}/{{scene}}/trajectory.csv", non_empty=True),
    log:
        log_of("{scene}/trajectory"),
    benchmark:
        benchmark_of("{scene}/trajectory")
    params:
        about=lambda w: about(w.scene),
        job=lambda w: as_json(SCENES[w.scene].trajectory_job()),
        code=table_code("dynamics.trajectory", SCENE_TABLES["trajectory"]),
    shell:
        "python -m twodiscs.pipeline.jobs table dynamics.trajectory --parameters {params.job:q}"
        " --output {output.table:q}"
        " --about {params.about:q} --code {params.code} > {log:q} 2>&1"
