# Exact volumes, areas and mean times at every radius of a scene.


rule theory:
    input:
        code=code("cli.theory"),
    output:
        table=ensure(f"{RESULTS}/{{scene}}/theory.csv", non_empty=True),
    log:
        f"{RESULTS}/logs/{{scene}}/theory.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/theory.tsv"
    params:
        scene=lambda w: SCENES[w.scene].theory_parameters(),
    shell:
        "python -m twodiscs.cli.theory --parameters {params.scene:q}"
        " --output {output.table:q} > {log:q} 2>&1"
