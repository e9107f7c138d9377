# The studies: a rule makes the first table of each.

# Those that the scenes allow.
ALLOWED = {
    name: study for name, study in STUDIES.items() if MAIN or not study.about_plain
}


for name, study in ALLOWED.items():

    rule:
        """The table of a study."""
        name:
            f"{name}_table"
        input:
            tables=FILES.study_reads(study).values(),
        output:
            table=study_table(study.tables[0]),
        log:
            f"{RESULTS}/logs/{name}.log",
        benchmark:
            f"{RESULTS}/benchmarks/{name}.tsv"
        resources:
            runtime=cost.study_minutes(study, CONFIGURATION),
        params:
            table=study.tables[0].name(),
            parameters=json.dumps(study.parameters(CONFIGURATION)),
            tables=lambda w, input, study=study: assigned(
                FILES.study_reads(study), input.tables
            ),
            code=code(
                "twodiscs_paper.pipeline.jobs.study",
                study.tables[0].__module__,
            ),
        shell:
            "python -m twodiscs_paper.pipeline.jobs.study {params.table} --parameters {params.parameters:q}"
            " --tables {params.tables} --output {output.table} > {log} 2>&1"


rule effects_cost:
    """Measure what each effect costs, in seconds for an event."""
    input:
        scenes=EFFECT_FILES,
        # The compiler has run by then.
        tables=FILES.study_reads(STUDIES["effects"]).values(),
    output:
        table=study_table(STUDIES["effects"].tables[1]),
    log:
        f"{RESULTS}/logs/effects_cost.log",
    benchmark:
        f"{RESULTS}/benchmarks/effects_cost.tsv"
    params:
        code=code("twodiscs_paper.benchmark"),
    shell:
        "python -m twodiscs_paper.benchmark --table effects_cost --scenes {input.scenes}"
        " --output {output.table} > {log} 2>&1"


# A study's name is a target: its tables and figures.
for name in ALLOWED:

    rule:
        """The tables and figures of a study."""
        name:
            name
        input:
            FILES.study(name),
        localrule: True
