# The radii of each scene. They follow from the configuration alone, so they are known before any job
# runs; the table is their record.


rule grid:
    input:
        code=code("cli.grid"),
    output:
        table=ensure(f"{RESULTS}/{{scene}}/grid.csv", non_empty=True),
    log:
        f"{RESULTS}/logs/{{scene}}/grid.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/grid.tsv"
    params:
        scene=lambda w: SCENES[w.scene].scene_parameters(),
    shell:
        "python -m twodiscs.cli.grid --parameters {params.scene:q}"
        " --output {output.table:q} > {log:q} 2>&1"
