# Volume and areas by rejection sampling, one job a radius.


rule monte_carlo:
    input:
        code=code("cli.montecarlo"),
        compiled=lambda w: compiled(SCENES[w.scene], "monte_carlo"),
    output:
        point=f"{RESULTS}/{{scene}}/points/monte_carlo/{{key}}.json",
        cost=f"{RESULTS}/{{scene}}/points/cost/monte_carlo-{{key}}.json",
    log:
        f"{RESULTS}/logs/{{scene}}/monte_carlo-{{key}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/monte_carlo-{{key}}.tsv"
    params:
        point=lambda w: SCENES[w.scene].monte_carlo_parameters(w.key),
    shell:
        "python -m twodiscs.cli.montecarlo --parameters {params.point:q}"
        " --output {output.point:q} --cost {output.cost:q} > {log:q} 2>&1"
