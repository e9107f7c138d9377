# The studies: one rule makes the first table of each study, from its parameters and the tables that it reads.
# A study that takes long has parts, which are separate jobs; its table joins them.


rule study_table:
    """The table of a study."""
    input:
        tables=lambda w: CONFIGURATION.study_reads(of_study(w)).values(),
    output:
        table=report(
            f"{RESULTS}/{{study}}.csv",
            caption="../report/shared_table.rst",
            category="Tables",
            subcategory="all scenes",
            labels=lambda w: says(of_study(w).tables[0]),
        ),
    log:
        f"{RESULTS}/logs/{{study}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{study}}.tsv"
    wildcard_constraints:
        study="|".join(ALLOWED),
    threads: lambda w: ALL_CORES if w.study in of_study(w).timed else 1
    resources:
        runtime=lambda w: cost.study_minutes(of_study(w), CONFIGURATION),
    params:
        parameters=lambda w: json.dumps(of_study(w).parameters(CONFIGURATION)),
        tables=lambda w, input: assigned(
            CONFIGURATION.study_reads(of_study(w)), input.tables
        ),
        code=study_code,
    shell:
        "python -P -m twodiscs_paper.pipeline.jobs.study {wildcards.study} --parameters {params.parameters:q}"
        " --tables {params.tables:q} --output {output.table:q} > {log:q} 2>&1"


rule study_part:
    """A part of the table of a study that takes long."""
    output:
        table=f"{RESULTS}/parts/{{study}}/{{part}}.csv",
    log:
        f"{RESULTS}/logs/parts/{{study}}-{{part}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/parts/{{study}}-{{part}}.tsv"
    wildcard_constraints:
        study="|".join(PARTS),
        part="[a-z0-9_-]+",
    resources:
        runtime=lambda w: cost.study_minutes(of_study(w), CONFIGURATION),
    params:
        parameters=lambda w: json.dumps(PARTS[w.study][w.part]),
        code=study_code,
    shell:
        "python -P -m twodiscs_paper.pipeline.jobs.study {wildcards.study} --part --parameters {params.parameters:q}"
        " --output {output.table:q} > {log:q} 2>&1"


rule effects_curves:
    """The exact curves of the study of effects."""
    output:
        table=report(
            f"{RESULTS}/effects_curves.csv",
            caption="../report/shared_table.rst",
            category="Tables",
            subcategory="all scenes",
            labels=says(STUDIES["effects"].tables[2]),
        ),
    log:
        f"{RESULTS}/logs/effects_curves.log",
    benchmark:
        f"{RESULTS}/benchmarks/effects_curves.tsv"
    params:
        parameters=json.dumps({"scenes": boxes(CONFIGURATION)}),
        code=code(
            "twodiscs_paper.pipeline.jobs.study",
            "twodiscs_paper.studies.effects.study",
        ),
    shell:
        "python -P -m twodiscs_paper.pipeline.jobs.study effects_curves --parameters {params.parameters:q}"
        " --output {output.table:q} > {log:q} 2>&1"


rule effects_cost:
    """The cost of each effect, in seconds per event. It measures speed, so no other job runs beside it."""
    input:
        scenes=EFFECT_FILES,
        # Then all kernels are compiled.
        tables=CONFIGURATION.study_reads(STUDIES["effects"]).values(),
    output:
        table=report(
            f"{RESULTS}/effects_cost.csv",
            caption="../report/shared_table.rst",
            category="Tables",
            subcategory="all scenes",
            labels=says(STUDIES["effects"].tables[1]),
        ),
    log:
        f"{RESULTS}/logs/effects_cost.log",
    benchmark:
        f"{RESULTS}/benchmarks/effects_cost.tsv"
    threads: ALL_CORES
    params:
        # The benchmarks of many discs are not part of it.
        code=code(
            "twodiscs_paper.benchmark",
            without=(
                "twodiscs.dynamics.many.kernels",
                "twodiscs.dynamics.many.lockstep",
            ),
        ),
    shell:
        "python -P -m twodiscs_paper.benchmark --table effects_cost --scenes {input.scenes:q}"
        " --output {output.table:q} > {log:q} 2>&1"
