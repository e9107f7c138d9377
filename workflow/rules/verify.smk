# The fingerprints of all that is the same bytes on every run, and the comparison of what there is
# with what is committed. That one builds nothing: it has no input that could be out of date, and no
# output, so that it is done whenever it is asked for.
import json

from twodiscs.verify import is_reproducible


rule manifest:
    input:
        files=[path for path in rules.report.input.results if is_reproducible(path)],
        code=code("cli.manifest"),
    output:
        manifest=f"{RESULTS}/manifest.sha256",
    log:
        f"{RESULTS}/logs/manifest.log",
    benchmark:
        f"{RESULTS}/benchmarks/manifest.tsv"
    shell:
        "python -m twodiscs.cli.manifest {input.files:q} --output {output.manifest:q}"
        " > {log:q} 2>&1"


rule:
    name:
        "verify"
    log:
        f"{RESULTS}/logs/verify.log",
    params:
        configuration=json.dumps(config, sort_keys=True),
        results=RESULTS,
    shell:
        "python -m twodiscs.cli.verify --results {params.results:q}"
        " --configuration {params.configuration:q} 2> {log:q}"
