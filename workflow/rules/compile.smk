# Kernels are compiled once, before the jobs that share them start side by side. The stamp depends on
# the very code that those jobs depend on, so it makes none of them run that would not run anyway.


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
