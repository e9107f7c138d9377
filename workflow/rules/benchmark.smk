# How fast the engines are on this machine. Not part of `all`: it measures, so it must run alone.


rule:
    name:
        "benchmark"
    input:
        scenes=rules.effects_cost.input.scenes,
        code=code("benchmark"),
    output:
        table=ensure(f"{RESULTS}/benchmark.csv", non_empty=True),
    log:
        f"{RESULTS}/logs/benchmark.log",
    benchmark:
        f"{RESULTS}/benchmarks/benchmark.tsv"
    threads: 64  # all that there are
    shell:
        "python -m twodiscs.benchmark --scenes {input.scenes:q} --output {output.table:q} > {log:q} 2>&1"
