# The studies: one rule makes the first table of each. What each effect does is counted a scene of config/scenes
# at a time, as that is built alone; what it costs is in seconds.

EFFECTS = {path.stem: str(path) for path in sorted(HERE.glob("config/scenes/*.yaml"))}
EFFECT_POINTS = [f"{RESULTS}/points/effects/{name}.json" for name in EFFECTS]

# Those that the scenes allow.
ALLOWED = {
    name: study for name, study in STUDIES.items() if MAIN or not study.about_plain
}


for name, study in ALLOWED.items():

    rule:
        name:
            f"{name}_table"
        input:
            tables=FILES.study_reads(study).values(),
            points=EFFECT_POINTS if name == "effects" else [],
            compiled=[f"{RESULTS}/.compiled/{kernels}" for kernels in study.kernels],
        output:
            table=study_table(study.tables[0]),
        log:
            log_of(f"{name}_table"),
        benchmark:
            benchmark_of(f"{name}_table")
        params:
            about=about(None),
            job=as_json(study.parameters(CONFIGURATION)),
            module=study.code,
            function=study.function,
            tables=lambda w, input, study=study: named_tables(
                FILES.study_reads(study), input.tables
            ),
            code=table_code(study.code, study.tables[0]),
        shell:
            "python -m twodiscs.pipeline.jobs table {params.module} --function {params.function}"
            " --parameters {params.job:q} --table {params.tables:q} --points {input.points:q}"
            " --output {output.table:q}"
            " --about {params.about:q} --code {params.code} > {log:q} 2>&1"


rule effects_point:
    input:
        scene=lambda w: EFFECTS[w.file],
        schema=str(HERE / "src/twodiscs/pipeline/configuration/schema.yaml"),
    output:
        point=f"{RESULTS}/points/effects/{{file}}.json",
    log:
        log_of("effects-{file}"),
    benchmark:
        benchmark_of("effects-{file}")
    wildcard_constraints:
        file="|".join(EFFECTS),
    params:
        about=about(None),
        seed=CONFIGURATION.seed,
        texts=lambda w, input: contents(input.scene, input.schema),
        code=code(
            "studies.effects.measure",
            "pipeline.configuration.scene_file",
            without=NAMES_ALONE,
        ),
    shell:
        "python -m twodiscs.pipeline.configuration.scene_file {input.scene:q} --seed {params.seed}"
        " > {output.point:q}.parameters 2> {log:q}"
        " && python -m twodiscs.pipeline.jobs point studies.effects.measure"
        " --parameters @{output.point:q}.parameters --output {output.point:q}"
        " --about {params.about:q} --code {params.code} > {log:q} 2>&1"
        " && rm {output.point:q}.parameters"


rule effects_cost:
    input:
        scenes=list(EFFECTS.values()),
        # By then the kernels are compiled.
        compiled=[f"{RESULTS}/.compiled/dynamics", *EFFECT_POINTS],
    output:
        table=study_table(STUDIES["effects"].tables[1]),
    log:
        log_of("effects_cost"),
    benchmark:
        benchmark_of("effects_cost")
    params:
        texts=contents(*EFFECTS.values()),
        code=code("benchmark", without=NAMES_ALONE),
    shell:
        "python -m twodiscs.benchmark --table effects_cost --scenes {input.scenes:q}"
        " --output {output.table:q} > {log:q} 2>&1"


# A study's name is a target: its tables and figures.
for name in ALLOWED:

    rule:
        name:
            name
        input:
            FILES.study(name),
