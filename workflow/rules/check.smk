# Exact theory = Monte Carlo = molecular dynamics? The table always comes to be; the verdict only if
# every comparison passes, and otherwise its job fails and names those that do not.


rule check_table:
    input:
        theory=f"{RESULTS}/{{scene}}/theory.csv",
        points=lambda w: point_files(SCENES[w.scene], *METHODS),
        code=code("cli.tables"),
    output:
        table=report(
            ensure(f"{RESULTS}/{{scene}}/check.csv", non_empty=True),
            caption="../report/table.rst",
            category="Tables",
            subcategory="{scene}",
            labels={"table": "check", "what a row says": TABLES["check"].meaning},
        ),
    log:
        f"{RESULTS}/logs/{{scene}}/check_table.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/check_table.tsv"
    params:
        scene=lambda w: table_parameters(SCENES[w.scene]),
    shell:
        "python -m twodiscs.cli.tables check --scene {params.scene:q} --theory {input.theory:q}"
        " --points {input.points:q} --output {output.table:q} > {log:q} 2>&1"


rule check:
    input:
        tables=[
            files["check"]
            for files in map(table_files, SCENES.values())
            if "check" in files
        ],
        code=code("cli.check"),
    output:
        passed=f"{RESULTS}/check.passed",
    log:
        f"{RESULTS}/logs/check.log",
    benchmark:
        f"{RESULTS}/benchmarks/check.tsv"
    shell:
        "python -m twodiscs.cli.check {input.tables:q} --output {output.passed:q} > {log:q} 2>&1"
