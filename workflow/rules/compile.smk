# Kernels are compiled once, before the jobs that share them start side by side: those of the box without
# effects for every choice of what is watched, those of a scene with effects for what it watches. A stamp
# depends on nothing that those jobs do not depend on, so it makes none of them run that would not run
# anyway.


rule compile:
    input:
        code=lambda w: code(w.kernels),
    output:
        stamp=f"{RESULTS}/.compiled/{{kernels}}",
    log:
        f"{RESULTS}/logs/compile-{{kernels}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/compile-{{kernels}}.tsv"
    wildcard_constraints:
        kernels="montecarlo|dynamics",
    shell:
        "python -m twodiscs.cli.compile {wildcards.kernels} --output {output.stamp:q}"
        " > {log:q} 2>&1"


rule compile_effects:
    input:
        code=lambda w: code(KERNELS[w.method]),
    output:
        stamp=f"{RESULTS}/.compiled/{{scene}}/{{method}}",
    log:
        f"{RESULTS}/logs/{{scene}}/compile-{{method}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/compile-{{method}}.tsv"
    wildcard_constraints:
        method="|".join(METHODS),
    params:
        scene=lambda w: SCENES[w.scene].kernels_parameters(w.method),
    shell:
        "python -m twodiscs.cli.compile {wildcards.method} --parameters {params.scene:q}"
        " --output {output.stamp:q} > {log:q} 2>&1"
