# The studies: one rule makes all their tables, from the parameters of a study and the tables that it reads.
# A study that takes long has parts, which are separate jobs; its table joins them.


rule study_table:
    """A table of a study. If it has seconds, no other job runs beside it."""
    input:
        tables=lambda w: study_reads(w).values(),
        code=code("study", "physics", "tables"),
        own_code=lambda w: sums(MADE_BY[w.table].name),
    output:
        table=report(f"{RESULTS}/{{table}}.csv", category="Tables", subcategory="all scenes"),
    log:
        f"{RESULTS}/logs/{{table}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{table}}.tsv"
    wildcard_constraints:
        table="|".join(MADE_BY),
    threads: lambda w: ALL_CORES if w.table in MADE_BY[w.table].timed else 1
    resources:
        runtime=lambda w: job_cost.study_minutes(MADE_BY[w.table], CONFIGURATION),
    params:
        names=lambda w: [*study_reads(w)],
        given=lambda w: MADE_BY[w.table].parameters(CONFIGURATION),
    script:
        "../scripts/study.py"


use rule study_table as study_part with:
    """A part of the table of a study that takes long."""
    input:
        code=code("study", "physics", "tables"),
        own_code=lambda w: sums(w.table),
    output:
        table=f"{RESULTS}/parts/{{table}}/{{part}}.csv",
    log:
        f"{RESULTS}/logs/parts/{{table}}/{{part}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/parts/{{table}}-{{part}}.tsv"
    wildcard_constraints:
        table="|".join(PARTS),
        part="[a-z0-9_-]+",
    threads: 1
    params:
        names=[],
        given=lambda w: PARTS[w.table][w.part],
