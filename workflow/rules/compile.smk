# Kernels are compiled once, before the jobs that share them start side by side: those of the box without
# effects for every choice of what is watched, those of a scene with effects for what it watches. The
# stamps depend on the very code that those jobs depend on; no job runs because a stamp is new.


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
        code=lambda w: code(w.kernels),
    output:
        stamp=f"{RESULTS}/.compiled/{{scene}}/{{kernels}}",
    log:
        f"{RESULTS}/logs/{{scene}}/compile-{{kernels}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/{{scene}}/compile-{{kernels}}.tsv"
    wildcard_constraints:
        kernels="montecarlo|dynamics",
    params:
        scene=lambda w: SCENES[w.scene].kernels_parameters(),
    shell:
        "python -m twodiscs.cli.compile {wildcards.kernels} --parameters {params.scene:q}"
        " --output {output.stamp:q} > {log:q} 2>&1"
