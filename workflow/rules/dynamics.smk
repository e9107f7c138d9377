# Event-driven molecular dynamics: counts of events and intervals between hops, one job a radius, and
# one trajectory to look at.


rule dynamics:
    input:
        code=code("cli.dynamics"),
        compiled=lambda w: compiled(SCENES[w.scene], "dynamics"),
    output:
        point=f"{RESULTS}/{{scene}}/points/dynamics/{{key}}.json",
        cost=f"{RESULTS}/{{scene}}/points/cost/dynamics-{{key}}.json",
    log:
        f"{RESULTS}/logs/{{scene}}/dynamics-{{key}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/dynamics-{{key}}.tsv"
    params:
        point=lambda w: SCENES[w.scene].dynamics_parameters(w.key),
    shell:
        "python -m twodiscs.cli.dynamics --parameters {params.point:q}"
        " --output {output.point:q} --cost {output.cost:q} > {log:q} 2>&1"


rule intervals:
    input:
        code=code("cli.intervals"),
        compiled=lambda w: compiled(SCENES[w.scene], "intervals"),
    output:
        point=f"{RESULTS}/{{scene}}/points/intervals/{{key}}.json",
        cost=f"{RESULTS}/{{scene}}/points/cost/intervals-{{key}}.json",
    log:
        f"{RESULTS}/logs/{{scene}}/intervals-{{key}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/intervals-{{key}}.tsv"
    params:
        point=lambda w: SCENES[w.scene].intervals_parameters(w.key),
    shell:
        "python -m twodiscs.cli.intervals --parameters {params.point:q}"
        " --output {output.point:q} --cost {output.cost:q} > {log:q} 2>&1"


rule trajectory:
    input:
        code=code("cli.trajectory"),
    output:
        table=ensure(f"{RESULTS}/{{scene}}/trajectory.csv", non_empty=True),
    log:
        f"{RESULTS}/logs/{{scene}}/trajectory.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/trajectory.tsv"
    params:
        point=lambda w: SCENES[w.scene].trajectory_parameters(),
    shell:
        "python -m twodiscs.cli.trajectory --parameters {params.point:q}"
        " --output {output.table:q} > {log:q} 2>&1"
