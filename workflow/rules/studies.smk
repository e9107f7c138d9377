# The studies: one rule makes the first table of each study, from its parameters and the tables that it reads.
# A study that takes long has parts, which are separate jobs; its table joins them.


rule study_table:
    """The table of a study."""
    input:
        tables=lambda w: study_reads(w).values(),
        code=code("study", "physics", "tables"),
        own_code=lambda w: sums(w.study),
    output:
        table=report(
            f"{RESULTS}/{{study}}.csv",
            category="Tables",
            subcategory="all scenes",
        ),
    log:
        f"{RESULTS}/logs/{{study}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{study}}.tsv"
    wildcard_constraints:
        study="|".join(ALLOWED),
    threads: lambda w: ALL_CORES if w.study in ALLOWED[w.study].timed else 1
    resources:
        runtime=lambda w: cost.study_minutes(ALLOWED[w.study], CONFIGURATION),
    params:
        names=lambda w: [*study_reads(w)],
        given=lambda w: ALLOWED[w.study].parameters(CONFIGURATION),
    script:
        "../scripts/study.py"


use rule study_table as study_part with:
    """A part of the table of a study that takes long."""
    input:
        code=code("study", "physics", "tables"),
        own_code=lambda w: sums(w.study),
    output:
        table=f"{RESULTS}/parts/{{study}}/{{part}}.csv",
    log:
        f"{RESULTS}/logs/parts/{{study}}-{{part}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/parts/{{study}}-{{part}}.tsv"
    wildcard_constraints:
        study="|".join(PARTS),
        part="[a-z0-9_-]+",
    threads: 1
    params:
        names=[],
        given=lambda w: PARTS[w.study][w.part],


use rule study_table as effects_curves with:
    """The exact curves of the study of effects."""
    input:
        code=code("study", "physics", "tables", "effects"),
    output:
        table=report(
            f"{RESULTS}/effects_curves.csv",
            category="Tables",
            subcategory="all scenes",
        ),
    log:
        f"{RESULTS}/logs/effects_curves.log",
    benchmark:
        f"{RESULTS}/benchmarks/effects_curves.tsv"
    threads: 1
    resources:
        runtime=cost.study_minutes(STUDIES["effects"], CONFIGURATION),
    params:
        names=[],
        given={"scenes": boxes(CONFIGURATION)},


rule effects_cost:
    """The cost of each effect, in seconds per event. It measures speed, so no other job runs beside it."""
    input:
        scenes=EFFECT_FILES,
        # Then all kernels are compiled.
        tables=CONFIGURATION.study_reads(STUDIES["effects"]).values(),
        code=code("benchmark", "physics", "tables", "effects", "benchmark"),
    output:
        table=report(
            f"{RESULTS}/effects_cost.csv",
            category="Tables",
            subcategory="all scenes",
        ),
    log:
        f"{RESULTS}/logs/effects_cost.log",
    benchmark:
        f"{RESULTS}/benchmarks/effects_cost.tsv"
    threads: ALL_CORES
    script:
        "../scripts/benchmark.py"
