# What each effect does to the mean times: the scenes of config/scenes, each as it is built alone, beside
# plain discs. The cost of an effect is in seconds, so its table and the figure differ from run to run.
from glob import glob

EFFECTS = sorted(Path(path).stem for path in glob("config/scenes/*.yaml"))
POINTS = expand(f"{RESULTS}/points/effects/{{file}}.json", file=EFFECTS)


rule effects_point:
    input:
        scene="config/scenes/{file}.yaml",
        code=code("cli.effects"),
        schema="src/twodiscs/config.schema.yaml",
    output:
        point=f"{RESULTS}/points/effects/{{file}}.json",
    log:
        f"{RESULTS}/logs/effects-{{file}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/effects-{{file}}.tsv"
    wildcard_constraints:
        file="|".join(EFFECTS),
    params:
        seed=CONFIGURATION.seed,
    shell:
        "python -m twodiscs.cli.effects count {input.scene:q} --seed {params.seed}"
        " --output {output.point:q} > {log:q} 2>&1"


rule effects_table:
    input:
        points=POINTS,
        code=code("cli.effects"),
    output:
        table=report(
            ensure(f"{RESULTS}/effects.csv", non_empty=True),
            caption="../report/shared_table.rst",
            category="Tables",
            subcategory="all scenes",
            labels={
                "table": "effects",
                "what a row says": TABLES["effects"].meaning,
            },
        ),
    log:
        f"{RESULTS}/logs/effects_table.log",
    benchmark:
        f"{RESULTS}/benchmarks/effects_table.tsv"
    shell:
        "python -m twodiscs.cli.effects table {input.points:q} --output {output.table:q}"
        " > {log:q} 2>&1"


rule effects_cost:
    input:
        scenes=expand("config/scenes/{file}.yaml", file=EFFECTS),
        # By then the kernels are compiled.
        compiled=[f"{RESULTS}/.compiled/dynamics", *POINTS],
        code=code("benchmark"),
    output:
        table=report(
            ensure(f"{RESULTS}/effects_cost.csv", non_empty=True),
            caption="../report/shared_table.rst",
            category="Tables",
            subcategory="all scenes",
            labels={
                "table": "effects_cost",
                "what a row says": TABLES["effects_cost"].meaning,
            },
        ),
    log:
        f"{RESULTS}/logs/effects_cost.log",
    benchmark:
        f"{RESULTS}/benchmarks/effects_cost.tsv"
    shell:
        "python -m twodiscs.benchmark --table effects_cost --scenes {input.scenes:q}"
        " --output {output.table:q} > {log:q} 2>&1"


rule effects:
    input:
        rules.effects_table.output,
        rules.effects_cost.output,
        shared_figure_files("effects"),
